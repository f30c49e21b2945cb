"""Matrices of a rotor."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

SINGULAR = 1e-14
"""Smallest singular value of a matrix, relative to the size of its terms, up to which it counts as singular."""


class Matrices(NamedTuple):
    """Matrices of a rotor in the fixed frame, ``M Z̈ + (D − iG) Ż + K Z = F e^{it}``.

    Attributes
    ----------
    mass, damping, gyroscopic, stiffness : ndarray of complex, shape (n, n)
        ``D`` and ``G`` are Hermitian; so is ``K`` without circulatory forces.
    forcing : ndarray of complex, shape (n,)
    """

    mass: np.ndarray
    damping: np.ndarray
    gyroscopic: np.ndarray
    stiffness: np.ndarray
    forcing: np.ndarray


def is_singular(matrix: np.ndarray, *terms: np.ndarray) -> bool:
    """Whether a matrix is singular to the rounding of these."""
    return bool(np.linalg.svd(matrix, compute_uv=False)[-1] <= SINGULAR * max(map(np.linalg.norm, terms)))
