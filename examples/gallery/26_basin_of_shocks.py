"""
26. A basin of base shocks
==========================

The housing is shaken by a half-sine pulse of 5 ms.  Kept by size and direction, the picture is a disc.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
shocks = cm.BaseShock.of(machine, "8 g", "5 ms")
basin = cm.map_basins(machine, cm.Grid(shocks, (40, 60)))
print(basin.share_recovered.words)
figure = basin.plot()
