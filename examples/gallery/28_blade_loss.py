"""
28. A sudden unbalance
======================

A lost blade, or a sleeve that shifts, changes the unbalance at once.  The coordinates are the unbalance before the step.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
step = cm.disturbances.UnbalanceStep.in_si(machine.parameters.scales, 0.4e-3)
basin = cm.map_basins(machine, cm.Grid(step, (40, 60)))
print(basin.share_recovered.words)
figure = basin.plot()
