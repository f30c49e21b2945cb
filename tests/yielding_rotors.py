"""Rotors in compliant walls, and their equations written down a second time, in the co-rotating frame.

Nothing here shares a formula with the package: forces are physical ones on the coordinates, and a general integrator follows the
motion from one change of contact to the next.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from carom.models import HuntCrossley, KelvinVoigt, Rotor, from_matrices
from carom.models.touchdown import Touchdown

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
        return from_matrices(
            mass=[[1.0]],
            damping=[[self.gamma]],
            stiffness=[[self.omega**2]],
            forcing=[self.rho * np.exp(1j * self.phi)],
            touchdowns=[Touchdown([1.0], self.law, self.mu, self.surface_speed)],
        )

    def force(self, depth, rate):
        """Normal force of the law, without regard to whether it pulls."""
        if isinstance(self.law, KelvinVoigt):
            return self.law.stiffness * depth + self.law.damping * rate
        return self.law.stiffness * max(depth, 0.0) ** self.law.exponent * (1.0 + self.law.dissipation * rate)

    def parts(self, depth, rate):
        """What vanishes with the force."""
        if isinstance(self.law, KelvinVoigt):
            return self.law.stiffness * depth + self.law.damping * rate
        return 1.0 + self.law.dissipation * rate

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

    def follow(self, state, time, contact=""):
        """State after a time in one kind of contact."""
        flown = solve_ivp(
            lambda _, y: self.rates(y, contact), (0.0, time), state, "DOP853", rtol=1e-13, atol=1e-14, max_step=0.02
        )
        return flown.y[:, -1]

    def motion(self, state, time, longest=0.05):
        """State after a time that begins in flight, through forward slip in the wall and parting from it; with the events."""
        kind, gone, events = "", 0.0, []
        while gone < time:
            flown = solve_ivp(
                lambda _, y, kind=kind: self.rates(y, "+" if kind == "contact" else ""),
                (gone, time),
                state,
                "DOP853",
                rtol=1e-13,
                atol=1e-14,
                events=self._ends(kind),
                max_step=longest if kind == "" else 0.002,
            )
            gone, state = flown.t[-1], flown.y[:, -1]
            if flown.status != 1:
                break
            first = next(place for place, times in enumerate(flown.t_events) if len(times))
            kind = {"": ("contact",), "contact": ("", "free"), "free": ("", "contact")}[kind][first]
            events.append((gone, kind))
        return state, events

    def _ends(self, kind):
        """Events that end flight, contact and the way out of the wall, in the order of :meth:`motion`."""

        def depth(_, y):
            return np.hypot(y[0], y[1]) - 1.0

        def pressed(_, y):
            return self.parts(depth(0.0, y), (y[0] * y[2] + y[1] * y[3]) / np.hypot(y[0], y[1]))

        wanted = {
            "": [(depth, 1.0)],
            "contact": [(depth, -1.0), (pressed, -1.0)],
            "free": [(depth, -1.0), (pressed, 1.0)],
        }
        ends = []
        for function, direction in wanted[kind]:

            def end(time, y, function=function):
                return function(time, y)

            end.terminal, end.direction = True, direction
            ends.append(end)
        return ends


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
