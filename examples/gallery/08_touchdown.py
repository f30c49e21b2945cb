"""
8. A touchdown in four panels
=============================

Distance, regime, forces and energies of one motion over the same time axis.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["restitution=0.6"])
motion = cm.simulate(machine, cm.kick("100 mm/s", "60 deg"), until="100 ms")
figure = cm.plots.touchdown(motion, cm.motions.energy_ledger(motion))
