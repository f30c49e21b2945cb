"""
33. A rotor with two bearings
=============================

A rotor given by its matrices: displacement and tilt, with a touchdown bearing at each end.  All functions take it; the documentation lists what
each of them guarantees.
"""

import numpy as np

import carom as cm

ends = np.array([[1.0, 0.8], [1.0, -0.7]])  # displacement at each bearing per displacement and tilt
rotor = cm.models.from_matrices(
    mass=np.diag([1.0, 0.4]),
    damping=0.05 * ends.T @ ends,
    stiffness=0.3 * ends.T @ ends,
    gyroscopic=np.diag([0.0, 0.3]),
    forcing=[0.25, 0.05],
    touchdowns=[cm.models.Touchdown(end, cm.models.Rigid(0.9), friction=0.15, surface_speed=21.0) for end in ends],
    translation=[1.0, 0.0],
)
motion = cm.simulate(rotor, cm.kick(1.2, angle=1.3), until=12)
print([len(motion.seen_at(plane).contacts) for plane in (0, 1)], "impacts at the two bearings")

# %%
# What to see: the motion at the second bearing, in both frames.  The rotor hits this bearing four times.  The kinks inside the circle are impacts at the
# first bearing, which act here through the tilt.
figure = motion.seen_at(1).plot()
