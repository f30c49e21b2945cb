"""
4. How hard the bearing is hit
==============================

Every motion has a log of its impacts: :attr:`carom.motions.Trajectory.contacts`.  As a dataset it has units.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
motion = cm.simulate(machine, cm.kick("100 mm/s"), until="300 ms")
log = motion.contacts.to_dataset()
hardest = log.isel(impact=int(log.normal_impulse.argmax("impact")))
print(f"{log.sizes['impact']} impacts, the hardest {float(hardest.normal_impulse):.3g} {log.normal_impulse.units}")

# %%
# Impulses are drawn as stems over time; the colours tell forward from backward whirl.
figure = cm.plots.forces(motion)
