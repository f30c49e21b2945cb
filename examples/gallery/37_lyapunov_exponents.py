"""
37. Irregular bouncing
======================

At this damping the orbit of twice the period is unstable and the rotor bounces without repeating itself.  A positive Lyapunov exponent
is the rate at which neighbouring motions separate; it does not mean that the motion persists.
"""

import carom as cm

machine = cm.load("../source-paper.toml", ["gamma=0.082"])
motion = cm.simulate(machine, cm.State(0.3, 0.5j), settle=True, patience=2000)
print(motion.outcome.meaning, len(motion.contacts), "impacts")
exponents = cm.orbits.lyapunov_exponents(machine, motion.final, impacts=2000, transient=200)
print(exponents.values.round(4), "+-", exponents.errors.round(4))

# %%
# What to see: the last five turns of the shaft.  The loops on the left resemble each other, but none repeats exactly.
figure = cm.plots.motion(motion, since=motion.time - 30.0)
