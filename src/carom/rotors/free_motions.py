"""Free motions of a levitating machine, and which of them grow."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

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
    if not equations.is_anisotropic:
        exponents, coordinates = equations.exponents(speed)
        return FreeMotions(exponents, coordinates, np.zeros_like(coordinates))
    exponents, coordinates = equations.both.exponents(speed)
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
    matrix = (equations.both if equations.is_anisotropic else equations).generator(speed)
    exponents = _exponents(matrix.tobytes(), len(matrix))
    rounding = ROUNDING * float(np.abs(exponents).max(initial=0.0))
    if equations.is_anisotropic:  # each motion has two conjugate exponents
        exponents = exponents[exponents.imag >= -rounding]
    grows = exponents.real > rounding
    return Slowest(exponents[grows] if grows.any() else exponents[:1], bool(grows.any()), rounding)


@lru_cache(KEPT)
def _exponents(matrix: bytes, size: int) -> np.ndarray:
    """Exponents of a matrix, the one with the largest real part first."""
    exponents = np.linalg.eigvals(np.frombuffer(matrix, complex).reshape(size, size))
    return np.asarray(exponents[np.argsort(-exponents.real, kind="stable")])
