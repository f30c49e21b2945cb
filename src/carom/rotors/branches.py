"""Exponents of free motion followed over the speed of the shaft: which at one speed is which at the next."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment  # type: ignore[import-untyped]

from carom.rotors.equations import RotorEquations

LEAST_LIKENESS = 0.7
"""Least likeness of a motion at two speeds for it to count as the same; below, the speed between both is looked at too."""
HALVINGS = 6
"""Times that a step of the speed is halved at most; then the most alike motions are taken for the same."""


class MotionBranches(NamedTuple):
    """Free motions at one speed."""

    exponents: np.ndarray
    """1/s, shape (N,)."""
    states: np.ndarray
    """Coordinates, then velocities of those with mass, of each, shape (N, N)."""
    duals: np.ndarray
    """Rows that give the share of each motion in a state, shape (N, N)."""


def followed(equations: RotorEquations, speeds: np.ndarray) -> np.ndarray:
    """Exponents of all free motions at each of the speeds, 1/s, shape (m, N); each column is one motion, as far as it can be stated.

    Two motions are alike by ``|a b|``, where ``a`` is the share of the first in the second and ``b`` that of the second in the first: 1 of the
    same motion, whatever its size.  Where two whirls come near each other their shapes mix, and a whirl keeps its shape rather than its
    place.  Where supports are anisotropic, the exponent of each motion is that with the sense that prevails in it.
    """
    followed_of = equations.both if equations.is_anisotropic else equations
    here = _at(followed_of, float(speeds[0]))
    rows = [here]
    for before, after in zip(speeds[:-1].tolist(), speeds[1:].tolist(), strict=True):
        here = _step(followed_of, here, before, after, HALVINGS)
        rows.append(here)
    if not equations.is_anisotropic:
        return np.array([each.exponents for each in rows])
    once = rows[0].exponents.imag > 0.0  # the others are their conjugates
    return np.array([_with_sense(each, len(equations.mass))[once] for each in rows])


def _with_sense(motions: MotionBranches, coordinates: int) -> np.ndarray:
    """Exponents whose imaginary parts are above zero where a motion goes forward more than backward."""
    both = motions.states[: 2 * coordinates]
    ahead, behind = (np.linalg.norm(each, axis=0) for each in np.split(both, 2))
    forward = (ahead >= behind) == (motions.exponents.imag > 0.0)
    return motions.exponents.real + 1j * np.abs(motions.exponents.imag) * np.where(forward, 1.0, -1.0)


def _at(equations: RotorEquations, speed: float) -> MotionBranches:
    exponents, coordinates = equations.exponents(speed)
    has_mass = equations.mass.any(axis=1)
    states = np.concatenate([coordinates, exponents * coordinates[has_mass]])
    # Motions of a free rotor that stay where they are may be one and the same: no inverse.
    return MotionBranches(exponents, states, np.linalg.pinv(states))


def _step(
    equations: RotorEquations, here: MotionBranches, before: float, after: float, halvings: int
) -> MotionBranches:
    """The motions at the speed after, in the order of those here."""
    there = _at(equations, after)
    alike = np.abs((here.duals @ there.states) * (there.duals @ here.states).T)
    _, order = linear_sum_assignment(-np.minimum(alike, 1.0))
    if halvings and alike[np.arange(len(order)), order].min() < LEAST_LIKENESS:
        middle = 0.5 * (before + after)
        return _step(equations, _step(equations, here, before, middle, halvings - 1), middle, after, halvings - 1)
    return MotionBranches(there.exponents[order], there.states[:, order], there.duals[order])
