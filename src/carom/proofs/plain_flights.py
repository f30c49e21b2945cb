"""Flights in double precision: they say where a proof looks, and no claim rests on them."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import Any

from carom.proofs.sides import Side

PlainWave = tuple[complex, complex, complex]


@dataclass(frozen=True)
class PlainRotor:
    """A rotor in doubles: ``γ``, ``ω²`` and ``ℓ`` of :mod:`carom.proofs.patches`."""

    gamma: float
    stiff: float
    radius: float

    @classmethod
    def of(cls, *balls: Any) -> PlainRotor:
        """The rotor in the middle of balls."""
        return cls(*(float(ball.mid()) for ball in balls))

    def ends(self, side: Side) -> tuple[PlainRotor, PlainRotor]:
        """The rotors at both ends of a parameter, the upper one first."""
        by = [float(ball.mid()) for ball in (side.gamma, side.omega_squared, side.radius)]
        one, other = (
            PlainRotor(self.gamma + sign * by[0], self.stiff + sign * by[1], self.radius + sign * by[2])
            for sign in (1, -1)
        )
        return one, other

    def waves(self, time: float, from_wall: bool) -> tuple[PlainWave, PlainWave, PlainWave]:
        """``c``, ``h₁`` and ``k`` of a flight with their first two derivatives."""
        half, stiff = self.gamma / 2, self.stiff
        root = cmath.sqrt(half * half - stiff) or 1e-9
        fade = cmath.exp(-half * time).real
        h = fade * (cmath.sinh(root * time) / root).real
        dh = fade * cmath.cosh(root * time).real - half * h
        d2h = -2 * half * dh - stiff * h
        turn = cmath.exp(1j * time)
        if not from_wall:
            return (0, h, turn), (0, dh, 1j * turn), (0, d2h, -turn)
        c, dc, d2c = dh + 2 * half * h, -stiff * h, -stiff * dh
        return (
            (c, h, turn - c - 1j * h),
            (dc, dh, 1j * turn - dc - 1j * dh),
            (d2c, d2h, -turn - d2c - 1j * d2h),
        )

    def flight(self, time: float, from_wall: bool, velocity: complex, turn: complex) -> tuple[complex, complex]:
        """Place and rate on the flight with a velocity at the start and a direction of ``Λ``."""
        place, rate, _ = self.waves(time, from_wall)
        lift = self.radius * turn
        return place[0] + velocity * place[1] + lift * place[2], rate[0] + velocity * rate[1] + lift * rate[2]
