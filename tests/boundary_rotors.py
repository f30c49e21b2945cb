"""Rotors of two coordinates and two planes whose levitation is at a given distance from the wall at one of them."""

import numpy as np

from carom.models import Touchdown, from_matrices

SURFACE_SPEED = 40.0


def touching(law, seed, gap=0.0, friction=0.12, damping=(0.03, 0.12)):
    """A rigid body on two springs with polar inertia, by its displacements at two discs; its largest response is at one of the planes."""
    random = np.random.default_rng(seed)
    first, second = random.uniform(0.4, 1.5, 2)
    mass = np.array([[1.0, 0.2], [0.2, random.uniform(0.6, 1.2)]])
    rotor = {
        "mass": mass,
        "damping": np.diag(random.uniform(*damping, 2)),
        "stiffness": np.array([[first**2 + 0.2, -0.2], [-0.2, second**2 + 0.2]]),
        "gyroscopic": random.uniform(0.05, 0.4) * np.array([[1.0, -1.0], [-1.0, 1.0]]),
        "touchdowns": [
            Touchdown(row, law, friction, SURFACE_SPEED) for row in ([1.0, random.uniform(-0.2, 0.2)], [0.1, 1.0])
        ],
    }
    forcing = random.normal(size=2) + 1j * random.normal(size=2)
    unit = np.abs(from_matrices(**rotor, forcing=forcing).system.arrays.offsets).max()
    return from_matrices(**rotor, forcing=forcing * (1.0 + gap) / unit)
