"""
8. A touchdown in four panels
=============================

Distance, forces, slip and energies of one motion over the same time axis.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["restitution=0.6"])
motion = cm.simulate(machine, cm.kick("100 mm/s", "60 deg"), until="100 ms")

# %%
# What to see: from top to bottom, the bounces decay to lasting contact at 41 ms; the impulses shrink, and a force of about
# 1 kN replaces them; slip persists, because the rotor slides and does not roll; friction dissipates energy that the drive supplies.
figure = cm.plots.touchdown(motion, cm.motions.energy_ledger(motion))
