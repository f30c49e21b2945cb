"""Single flights in the frame of proofs about patches of them, by the exponential of a matrix and the impact law in polar coordinates."""

import cmath

import numpy as np
from machines import fly, path, strike

from carom.parameters import Parameters


class Single:
    """One flight of a patch, in the frame in which it begins on the real axis."""

    def __init__(self, numbers, state):
        *velocity, self.psi = state
        stiffness = complex(numbers["omega"] ** 2 - 1, numbers["gamma"])
        self.parameters = Parameters(**numbers, phi=self.psi + cmath.phase(stiffness))
        levitation = numbers["rho"] / abs(stiffness) * cmath.exp(1j * self.psi)
        from_wall = len(velocity) > 1
        self.start = 1.0 if from_wall else levitation
        self.velocity = complex(*velocity) - 1j if from_wall else complex(velocity[0])

    def at(self, time):
        """Position and velocity in the fixed frame."""
        place, speed = fly(self.parameters, self.start, self.velocity, time)
        turned = cmath.exp(1j * time)
        return place * turned, (speed + 1j * place) * turned

    def height(self, time):
        return abs(self.at(time)[0]) ** 2

    def heights(self, times):
        return abs(path(self.parameters, self.start, self.velocity, times)) ** 2

    def after(self, time):
        """``a``, ``b`` and ``ψ`` after an impact at a time."""
        z, dz = self.at(time)
        local = dz * (z / abs(z)).conjugate()
        a, b = strike(self.parameters, local.real, local.imag - 1)
        return np.array([a, b + 1, self.psi + time - cmath.phase(z)])
