"""
28. Levitation switched on at the bearing
=========================================

The rotor rests on the touchdown bearing, at any angle, and the magnetic bearings are switched on.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
basin = cm.map_basins(machine, cm.Grid(cm.disturbances.ContactRelease("fixed"), (360,)))
print(basin.share_recovered.words)

# %%
# What to see: each point on the ring is a position at which the rotor may lie when it is lifted.  From those at the left it levitates, from those at the
# right it keeps bouncing: the unbalance decides, not gravity.
figure = basin.plot()
