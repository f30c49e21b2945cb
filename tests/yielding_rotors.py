"""Rotors in compliant walls, and their equations written down a second time, in the co-rotating frame.

Nothing here shares a formula with the package: forces are physical ones on the coordinates, and a general integrator follows the
motion from one change of contact to the next.
"""

from dataclasses import dataclass

import numpy as np
from linear_rotors import planar_rotor

from carom.models import HuntCrossley, KelvinVoigt, Rotor, Touchdown, from_matrices

SURFACE_SPEED = 57.14


@dataclass(frozen=True)
class Yielding:
    """A planar rotor ``Ü + (γ + 2i) U̇ + (ω² − 1 + iγ) U = ρe^{iφ}`` in a compliant wall."""

    law: KelvinVoigt | HuntCrossley
    gamma: float = 0.1
    omega: float = 0.76
    rho: float = 3.0 / 7.0
    phi: float = 0.21
    mu: float = 0.15
    surface_speed: float = SURFACE_SPEED

    @property
    def model(self) -> Rotor:
        return planar_rotor(
            self.gamma,
            self.omega**2,
            self.rho * np.exp(1j * self.phi),
            [Touchdown([1.0], self.law, self.mu, self.surface_speed)],
        )

    def force(self, depth, rate):
        """Normal force of the law, without regard to whether it pulls."""
        if isinstance(self.law, KelvinVoigt):
            return self.law.stiffness * depth + self.law.damping * rate
        return self.law.stiffness * max(depth, 0.0) ** self.law.exponent * (1.0 + self.law.dissipation * rate)

    def rates(self, state, contact=""):
        """Rate of ``(Re U, Im U, Re U̇, Im U̇)``: in flight, or in contact with slip of the sense ``+`` or ``-``, or rolling, ``0``."""
        u, v = complex(state[0], state[1]), complex(state[2], state[3])
        free = self.rho * np.exp(1j * self.phi) - (self.gamma + 2j) * v - (self.omega**2 - 1.0 + 1j * self.gamma) * u
        if contact:
            radius = abs(u)
            outward, local = u / radius, (u / radius).conjugate() * v
            normal = self.force(radius - 1.0, local.real)
            if contact == "0":
                # d/dt of (surface speed + r − 1 + Im(n̄v)) vanishes.
                turning = local.imag / radius
                along = -local.real + turning * local.real - (outward.conjugate() * free).imag
            else:
                along = -self.mu * normal * (1.0 if contact == "+" else -1.0)
            free += complex(-normal, along) * outward
        return [v.real, v.imag, free.real, free.imag]


def packed(position, velocity):
    """State as four numbers."""
    return np.array([position.real, position.imag, velocity.real, velocity.imag])


def two_planes(first, second, friction=(0.1, 0.2), damping=0.3, speeds=(40.0, 40.0), unbalance=1.0):
    """A rotor of two coordinates with two contact planes."""
    return from_matrices(
        mass=np.diag([1.0, 1.4]),
        damping=damping * np.eye(2),
        stiffness=[[0.8, -0.1], [-0.1, 0.9]],
        forcing=[1.1 * unbalance, (1.4 + 0.2j) * unbalance],
        touchdowns=[
            Touchdown(plane, law, mu, speed)
            for plane, law, mu, speed in zip(([1.0, 0.3], [0.4, 1.0]), (first, second), friction, speeds, strict=True)
        ],
    )
