"""
2. A kick that comes back
=========================

A kick is a sudden change of the velocity of the levitating rotor.  :func:`carom.simulate` computes the motion after it to rounding accuracy; with ``settle=True``
until its outcome is certain.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
motion = cm.simulate(machine, cm.kick("210 mm/s", "26 deg"), settle=True)
print(motion.outcome.meaning)
print(len(motion.contacts), "impacts")

# %%
# What to see: the distance from the bearing centre over time.  The rotor hits the wall three times, at the triangles, narrowly misses it
# at 77 ms, and the curve decays to the radius of levitation.
figure = cm.plots.radius(motion)
