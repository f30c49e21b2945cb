"""Integrals along a motion: Gauss rules over pieces of it that are smooth."""

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
