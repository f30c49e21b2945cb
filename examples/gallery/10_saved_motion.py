"""
10. Save a motion and read it again
===================================

A motion is saved to the last bit, together with its rotor.
"""

import tempfile
from pathlib import Path

import carom as cm

machine = cm.load("../keogh-cole.toml")
motion = cm.simulate(machine, cm.kick("40 mm/s"), until="150 ms")
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "motion.nc"
    motion.save(file)
    again = cm.motions.Trajectory.load(file)
print(again.final == motion.final, len(again.contacts))

# %%
# For other programs, its course at any times is a dataset with units.
#
# What to see: the motion as read back.  The rotor hops along the wall from levitation at the left to the place of regular bouncing at the right.
print(list(motion.to_dataset().data_vars))
figure = again.plot()
