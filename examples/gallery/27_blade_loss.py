"""
27. Blade loss
==============

The unbalance of the levitating rotor changes suddenly by that of the lost blade.  Only the phase of this change is random: the picture is a ring.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.1 mm"])
loss = cm.disturbances.BladeLoss.of(machine, "9000 g mm")
basin = cm.map_basins(machine, cm.Grid(loss, (360,)))
print(basin.share_recovered.words)

# %%
# What to see: at some phases of the change, measured from the previous unbalance at the right, the rotor comes back; at the others it rubs.  The phase is random, so the green share is the probability of recovery.
figure = basin.plot()
