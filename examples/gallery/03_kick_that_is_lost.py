"""
3. A kick that is lost
======================

The same kick in another direction does not come back: the rotor goes on bouncing, one impact a period, for ever.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
motion = cm.simulate(machine, cm.kick("210 mm/s", "90 deg"), settle=True)
print(motion.outcome.meaning)
print(len(motion.contacts), "impacts until it has settled,", motion.multiplicity, "in each period afterwards")

# %%
# What to see: on the left, in the frame that turns with the shaft, the last eight turns are one small loop that touches the wall once: that is
# regular bouncing.  The points say where the rotor was once a turn before.  On the right the same loop as seen from outside, its impacts all
# round the bearing.
figure = cm.plots.motion(motion)
