"""
3. A kick that does not come back
=================================

After the same kick in another direction the rotor does not come back: it keeps bouncing periodically, with one impact a period.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
motion = cm.simulate(machine, cm.kick("210 mm/s", "90 deg"), settle=True)
print(motion.outcome.meaning)
print(len(motion.contacts), "impacts until it has settled,", motion.multiplicity, "in each period afterwards")

# %%
# What to see: on the left, in the frame that turns with the shaft, the last eight turns are one small loop that touches the wall once: that is
# regular bouncing.  The points are positions once a turn before that.  On the right is the same motion in the fixed frame, with its impacts all
# round the bearing.
figure = cm.plots.motion(motion)
