"""
27. The loss of a blade
=======================

The unbalance of the levitating rotor changes at once by that of the lost blade.  Only the phase of this change is left to chance: the picture is a ring.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.1 mm"])
loss = cm.disturbances.BladeLoss.of(machine, "9000 g mm")
basin = cm.map_basins(machine, cm.Grid(loss, (360,)))
print(basin.share_recovered.words)

# %%
# What to see: some phases of the change, relative to the unbalance before at the right, come back; at the others the rotor rubs.  Where a blade is lost is chance, so the share of green is the chance to come back.
figure = basin.plot()
