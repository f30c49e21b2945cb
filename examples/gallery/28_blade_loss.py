"""
28. The loss of a blade
=======================

The unbalance of the levitating rotor becomes larger at once.  Only the phase of the new unbalance is left to chance: the picture is a ring.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.1 mm"])
loss = cm.disturbances.BladeLoss.of(machine, "0.22 mm")
basin = cm.map_basins(machine, cm.Grid(loss, (360,)))
print(basin.share_recovered.words)

# %%
# What to see: with the new unbalance in about the direction of the old one, at the right, the rotor comes back; with the opposite one it bounces
# or rubs.  Where a blade is lost is chance, so the share of green is the chance to come back.
figure = basin.plot()
