"""
2. A kick that comes back
=========================

A kick changes the velocity of the levitating rotor at once.  :func:`carom.simulate` follows it exactly; with ``settle=True`` until it is
known where the motion ends.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
motion = cm.simulate(machine, cm.kick("210 mm/s", "26 deg"), settle=True)
print(motion.outcome.meaning)
print(len(motion.contacts), "impacts")

# %%
# What to see: the distance from the centre of the bearing over time.  The curve strikes the wall three times, at the triangles, misses it
# narrowly at 77 ms, and dies out to the radius of levitation.
figure = cm.plots.radius(motion)
