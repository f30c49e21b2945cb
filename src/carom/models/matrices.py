"""Matrices of a rotor, and derivatives of its equations of motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


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


class Rates(NamedTuple):
    """Derivatives of the equations of motion in the co-rotating frame by a parameter, with masses and contact planes that stay.

    Attributes
    ----------
    accelerations : ndarray of complex, shape (n, 2n)
        Of the accelerations of the coordinates, per coordinate, then per rate of a coordinate.
    force : ndarray of complex, shape (n,)
        Of their constant part.
    friction, restitution, surface_speed : ndarray, shape (P,)
        Of the contact law of each plane.
    """

    accelerations: np.ndarray
    force: np.ndarray
    friction: np.ndarray
    restitution: np.ndarray
    surface_speed: np.ndarray
