"""
24. A basin of kicks
====================

Each point is a kick: outward to the right, in the sense of rotation upward.  Its colour is the outcome.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
kicks = cm.disturbances.KickPlane.of(machine, "300 mm/s")
basin = cm.map_basins(machine, cm.Grid(kicks, (100, 100)))
print(basin.share_recovered.words)

# %%
# What to see: kicks in the green core come back in every direction.  Further out green arms curl through the blue of regular bouncing:
# there the direction decides.  At the lower right fast kicks start backward whirl.
figure = basin.plot()
