"""Free motions of a machine at a speed, which of them decides whether it levitates, and the speeds at which that changes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped]

from carom.rotors.equations import RotorEquations

STRAIGHT = 1e-9
"""Sense up to which a whirl counts as going to and fro along lines."""
ROUNDING = 1e-13
"""Growth over the size of the largest exponent that is rounding: of rotors without damping it is up to 2e-15."""
KEPT = 8
"""Machines whose exponents are kept: unbalance, weight and walls, which are changed often, change none of them."""


class FreeMotions(NamedTuple):
    """Free motions of a machine, each once: ``ahead e^{λt} + behind e^{λ̄t}``."""

    exponents: np.ndarray
    """1/s, shape (N,)."""
    ahead: np.ndarray
    """Coordinates, shape (n, N)."""
    behind: np.ndarray


def motions_at(equations: RotorEquations, speed: float) -> FreeMotions:
    """Free motions at a speed, 1/s; of two conjugate exponents that stand for one motion the one whose sense prevails."""
    exponents, coordinates = equations.exponents(speed)
    if not equations.is_anisotropic:
        return FreeMotions(exponents, coordinates, np.zeros_like(coordinates))
    ahead, behind = np.split(coordinates, 2)
    has_mass = equations.mass.any(axis=1)
    prevails = np.linalg.norm(ahead[has_mass], axis=0) - np.linalg.norm(behind[has_mass], axis=0)
    # Of one to and fro along lines neither does.
    level = STRAIGHT * np.linalg.norm(coordinates, axis=0)
    chosen = (prevails > level) | ((np.abs(prevails) <= level) & (exponents.imag > 0.0)) | (exponents.imag == 0.0)
    return FreeMotions(exponents[chosen], ahead[:, chosen], behind[:, chosen].conj())


def growing(exponents: np.ndarray) -> np.ndarray:
    """Which of all exponents of a machine, shape (..., N), are those of motions that grow by more than rounding."""
    rounding = ROUNDING * np.abs(exponents).max(axis=-1, keepdims=True, initial=0.0)
    return np.asarray(exponents.real > rounding)


class Slowest(NamedTuple):
    """What decides whether a machine levitates."""

    exponents: np.ndarray
    """Those of motions that grow, 1/s, the fastest first; where none does, the one that comes back last."""
    grows: bool
    rounding: float
    """Growth, 1/s, that is rounding."""


def slowest_of(equations: RotorEquations, speed: float) -> Slowest:
    """What decides whether a machine levitates, from all its exponents; where supports are not alike in both directions without the sense of whirls."""
    matrix = equations.generator(speed)
    exponents = _exponents(matrix.tobytes(), len(matrix))
    rounding = ROUNDING * float(np.abs(exponents).max(initial=0.0))
    if equations.is_anisotropic:  # each motion has two conjugate exponents
        exponents = exponents[exponents.imag >= -rounding]
    grows = exponents.real > rounding
    return Slowest(exponents[grows] if grows.any() else exponents[:1], bool(grows.any()), rounding)


class StabilityLimit(NamedTuple):
    """A speed at which levitation becomes stable or ceases to be."""

    speed: float
    """rad/s."""
    exponent: complex
    """Of the motion that neither grows nor decays there, 1/s."""
    stable_below: bool
    """Whether levitation is stable at lower speeds, and not at higher ones."""

    @property
    def hertz(self) -> float:
        """Turns of this motion per second, Hz."""
        return abs(self.exponent.imag) / (2.0 * math.pi)


def stability_limits(equations: RotorEquations, speeds: Sequence[float]) -> tuple[StabilityLimit, ...]:
    """Speeds at which the motion that decides whether a rotor levitates begins or ceases to grow, between increasing ones, 1/s.

    Two of them between neighbouring speeds are not seen.
    """

    def growth(speed: float) -> float:
        slowest = slowest_of(equations, speed)
        return float(slowest.exponents.real.max()) - slowest.rounding

    grows = [growth(speed) > 0.0 for speed in speeds]
    found = []
    for place in np.flatnonzero(np.diff(grows)).tolist():
        at = float(brentq(growth, speeds[place], speeds[place + 1], xtol=1e-12 * speeds[place]))
        found.append(StabilityLimit(at, complex(slowest_of(equations, at).exponents[0]), not grows[place]))
    return tuple(found)


@lru_cache(KEPT)
def _exponents(matrix: bytes, size: int) -> np.ndarray:
    """Exponents of a matrix, the one with the largest real part first."""
    exponents = np.linalg.eigvals(np.frombuffer(matrix, complex).reshape(size, size))
    return np.asarray(exponents[np.argsort(-exponents.real, kind="stable")])
