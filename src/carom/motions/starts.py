"""Where motions start: states, and kicks out of levitation."""

from __future__ import annotations

import cmath
from dataclasses import dataclass

import numpy as np

from carom.core.advance import INSIDE_ALL
from carom.core.impact import set_on_wall
from carom.models import Jeffcott
from carom.outcome import InputError
from carom.parameters import Scales, read_size

__all__ = ["LARGEST_SPEED", "WALL_TOLERANCE", "Kick", "State", "amplitudes_of", "kick", "own_size"]

LARGEST_SPEED = 1e100
"""Largest speed of a start: for far larger ones the bounds that prove a flight contact-free overflow."""
WALL_TOLERANCE = 1e-12
"""Distance from ``|U| = 1`` within which a start counts as on the wall."""


@dataclass(frozen=True)
class State:
    """A state of the rotor in the co-rotating frame.

    Attributes
    ----------
    position, velocity : complex
        ``U`` in clearances and ``U̇`` in clearances times ``Ω``.
    """

    position: complex
    velocity: complex = 0j


@dataclass(frozen=True)
class Kick:
    """A velocity kick out of the contact-free equilibrium.

    Attributes
    ----------
    speed : float or str
        Size of the kick: in clearances times ``Ω``, or text with a unit, such as ``"50 mm/s"``.
    angle : float or str
        Direction in the co-rotating frame: in rad, or text with a unit, such as ``"30 deg"``.
    """

    speed: float | str
    angle: float | str = 0.0

    def state(self, rotor: Jeffcott) -> State:
        """Return the state just after the kick.

        Raises
        ------
        InputError
            The text is no speed or no angle, or its unit needs scales that the rotor does not have.
        """
        speed = own_size("kick speed", self.speed, "velocity", rotor.scales)
        return State(rotor.equilibrium, cmath.rect(speed, own_size("kick angle", self.angle, "angle", rotor.scales)))


def kick(speed: float | str, angle: float | str = 0.0) -> Kick:
    """Velocity kick out of the contact-free equilibrium.

    Parameters
    ----------
    speed : float or str
        In ``c_r Ω``, or text with a unit, such as ``"50 mm/s"``.
    angle : float or str
        Its direction in the co-rotating frame: in rad, or text with a unit, such as ``"30 deg"``.
    """
    return Kick(speed, angle)


def own_size(name: str, given: float | str, kind: str, scales: Scales | None) -> float:
    """Convert text with a unit to the units of the equations; a number is already in these."""
    return read_size(name, given, kind, scales).own(scales) if isinstance(given, str) else given


def amplitudes_of(rotor: Jeffcott, state: State) -> tuple[np.ndarray, int]:
    """Amplitudes of a start, and the plane it touches or INSIDE_ALL."""
    for name in ("position", "velocity"):
        if not cmath.isfinite(getattr(state, name)):
            raise InputError(f"start {name}", getattr(state, name), "finite numbers")
    if abs(state.velocity) > LARGEST_SPEED:
        raise InputError("start velocity", state.velocity, f"a speed up to {LARGEST_SPEED:g}")
    radius = abs(state.position)
    if radius > 1.0 + WALL_TOLERANCE:
        raise InputError("start position", state.position, f"inside the wall, |U| <= 1 (here |U| = {radius:.12g})")
    amplitudes = rotor.system.amplitudes(state.position, state.velocity)
    if radius < 1.0 - WALL_TOLERANCE:
        return amplitudes, INSIDE_ALL
    set_on_wall(rotor.system.arrays, 0, amplitudes)
    return amplitudes, 0
