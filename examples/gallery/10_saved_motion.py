"""
10. Save a motion and read it again
===================================

A motion is stored exactly, to the last bit, with the rotor it belongs to.
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
# What to see: the motion as it was read back.  It hops along the wall from levitation at the left to where it will bounce, at the right.
print(list(motion.to_dataset().data_vars))
figure = again.plot()
