"""
4. How hard the bearing is hit
==============================

Every motion has a log of its impacts: :attr:`carom.motions.Trajectory.contacts`.  As a dataset it has units.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
motion = cm.simulate(machine, cm.kick("100 mm/s"), until="300 ms")
log = motion.contacts.to_dataset()
impulse = log.normal_impulse
print(f"{log.sizes['contact']} impacts, the hardest {float(impulse.max()):.3g} {impulse.units}")

# %%
# What to see: in the middle each stem is an impact, its height the impulse.  The fourth impact is the hardest; later impulses settle at 9 N s, which the
# bearing has to carry in regular bouncing.
figure = cm.plots.touchdown(motion)
