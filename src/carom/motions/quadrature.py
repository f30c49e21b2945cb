"""Integrals and largest values along a motion: Gauss rules over pieces of it that are smooth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import legendre

from carom.outcome import Phase

if TYPE_CHECKING:
    from carom.motions.trajectories import Trajectory

NODES, WEIGHTS = legendre.leggauss(16)
"""Gauss rule for a piece, on −1 … 1."""
LONGEST_PIECE = 1.5
"""Longest stretch, in ``1/max|λ|``, over which one Gauss rule is used; its error is below rounding."""
_DEGREES = np.arange(len(NODES))
_TO_SERIES = (legendre.legvander(NODES, len(NODES) - 1) * WEIGHTS[:, None]) * (_DEGREES + 0.5)
"""Legendre coefficients of the polynomial through values at the nodes, shape (16, 16)."""
_GRID = np.linspace(-1.0, 1.0, 33)
_ON_GRID = legendre.legvander(_GRID, len(NODES) - 1).T
_NEWTON_STEPS = 5
"""From a point of the grid these leave no more than rounding of a maximum that a step of the motion can have."""


def pieces(trajectory: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Edges of the stretches to integrate, and the number of stretches in each segment: one where a Taylor series is followed."""
    bounds = np.append(trajectory.segment_starts, trajectory.time)
    lengths = np.diff(bounds)
    fastest = np.abs(trajectory.rotor.system.arrays["exponents"]).max()
    flying = (trajectory.segment_phases == Phase.FLIGHT).all(axis=1)
    counts = np.where(flying, np.ceil(lengths * fastest / LONGEST_PIECE), 1).astype(int)
    counts = np.maximum(counts, 1)
    owner = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    return np.append(bounds[owner] + lengths[owner] * place / counts[owner], trajectory.time), counts


def largest(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Largest value within each piece and its place on −1 … 1, shape (k,), of functions known at the nodes, shape (k, 16).

    The polynomial through the nodes is exact to rounding on a Taylor step: its terms fall by a factor of thirty each.  Its largest value
    on a grid is refined by Newton's method for the zero of its derivative.
    """
    series = (values @ _TO_SERIES).T
    on_grid = series.T @ _ON_GRID
    best = on_grid.argmax(axis=1)
    start, low, high = _GRID[best], _GRID[np.maximum(best - 1, 0)], _GRID[np.minimum(best + 1, len(_GRID) - 1)]
    slopes, bends = legendre.legder(series), legendre.legder(series, 2)
    place = start
    for _ in range(_NEWTON_STEPS):
        slope, bend = (legendre.legval(place, each, tensor=False) for each in (slopes, bends))
        step = np.divide(slope, bend, out=np.zeros_like(slope), where=bend < 0.0)
        place = np.clip(place - step, low, high)
    refined, known = legendre.legval(place, series, tensor=False), on_grid.max(axis=1, initial=-np.inf)
    return np.maximum(refined, known), np.where(refined >= known, place, start)
