"""
25. A basin of kicks
====================

Each point is a kick: outward to the right, in the sense of rotation upward.  Its colour says where the rotor ends.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
kicks = cm.disturbances.KickPlane.of(machine, "300 mm/s")
basin = cm.map_basins(machine, cm.Grid(kicks, (100, 100)))
print(basin.share_recovered.words)
figure = basin.plot()
