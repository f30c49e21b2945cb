"""
8. A touchdown in four panels
=============================

Distance, regime, forces and energies of one motion over the same time axis.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["restitution=0.6"])
motion = cm.simulate(machine, cm.kick("100 mm/s", "60 deg"), until="100 ms")

# %%
# What to see: from top to bottom, the bounces fade to lasting contact at 41 ms; the ribbons change from flight to sliding, always in forward
# whirl; the impulses shrink, and a force of about 1 kN takes their place; friction takes energy that the drive supplies.
figure = cm.plots.touchdown(motion, cm.motions.energy_ledger(motion))
