"""Flights in double precision: they say where a proof looks, and no claim rests on them."""

from __future__ import annotations

import cmath
from dataclasses import dataclass

from flint import arb

from carom.proofs.sides import Side

PlainWave = tuple[complex, complex, complex]


@dataclass(frozen=True)
class PlainRotor:
    """A rotor in doubles: ``γ``, ``ω²`` and ``ℓ`` of :mod:`carom.proofs.patches`."""

    gamma: float
    stiff: float
    radius: float

    @classmethod
    def of(cls, *balls: arb) -> PlainRotor:
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

    def responses(self, time: float) -> tuple[PlainWave, PlainWave]:
        """``h₀`` and ``h₁`` with their first two derivatives."""
        half, stiff = self.gamma / 2, self.stiff
        root = cmath.sqrt(half * half - stiff) or 1e-9
        fade = cmath.exp(-half * time).real
        h = fade * (cmath.sinh(root * time) / root).real
        dh = fade * cmath.cosh(root * time).real - half * h
        return (dh + 2 * half * h, -stiff * h, -stiff * dh), (h, dh, -2 * half * dh - stiff * h)

    def flight(self, time: float, from_wall: bool, velocity: complex, turn: complex) -> tuple[complex, complex]:
        """Place and rate on the flight with a velocity at the start and a direction of ``Λ``."""
        (c, dc, _), (h, dh, _) = self.responses(time)
        lift, turned = self.radius * turn, cmath.exp(1j * time)
        if not from_wall:
            return velocity * h + lift * turned, velocity * dh + lift * 1j * turned
        place, rate = turned - c - 1j * h, 1j * turned - dc - 1j * dh
        return c + velocity * h + lift * place, dc + velocity * dh + lift * rate
