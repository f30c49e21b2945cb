"""
2. A kick that comes back
=========================

A blow changes the velocity of the levitating rotor at once.  :func:`carom.simulate` follows it exactly; with ``settle=True`` until it is
known where the motion ends.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
motion = cm.simulate(machine, cm.kick("210 mm/s", "26 deg"), settle=True)
print(motion.outcome.meaning)
print(len(motion.contacts), "impacts")

# %%
# The distance from the centre of the bearing, with the wall at one clearance.
figure = cm.plots.radius(motion)
