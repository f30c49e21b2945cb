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
# On the left in the frame that turns with the shaft, where the final motion closes; on the right as seen from outside.  Of a long
# motion the last turns of the shaft are drawn, and the first ones pale.
figure = cm.plots.motion(motion)
