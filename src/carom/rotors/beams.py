"""Matrices of a beam element by Timoshenko: bending, shear, rotary inertia and gyroscopic moments.

The shaft is round, so both planes of bending are one complex displacement ``w = x + iy`` and one tilt ``φ`` of the cross-section,
which is ``dw/ds`` without shear.  Between the ends both follow the static course without loads, with
``Φ = 12EI/(κGA L²)`` and ``ξ = s/L``,

    (1 + Φ) w = (1 − 3ξ² + 2ξ³ + Φ(1 − ξ)) w₁ + L (ξ − 2ξ² + ξ³ + Φ(ξ − ξ²)/2) φ₁ + …,      φ = dw/ds − γ,

with one shear angle ``γ``, and the matrices are the integrals of the energies (see for example Friswell, Penny, Garvey and Lees, *Dynamics of
Rotating Machines*, 2010, sections 5.4 and 5.5).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.rotors.sections import ShaftSection

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)
"""Four points integrate polynomials of degree 7 exactly; those here have degree 6."""


class ElementMatrices(NamedTuple):
    """Matrices (4, 4) of ``w₁, φ₁, w₂, φ₂``: kg, kg m and kg m² in the first and the last, N/m, N and N m in the second."""

    mass: np.ndarray
    stiffness: np.ndarray
    gyroscopic: np.ndarray


def beam_element(section: ShaftSection, length: float) -> ElementMatrices:
    """Matrices of an element of a section with this length, m; the gyroscopic one is by the speed of the shaft, rad/s.

    ``M ẅ − iΩG ẇ + K w = 0``.
    """
    material = section.material
    bending = material.elastic_modulus * section.second_moment
    shear = section.shear_coefficient * material.shear_modulus * section.area
    places = 0.5 * (1.0 + POINTS)
    displacement, tilt, curvature, angle = _courses(places, length, 12.0 * bending / (shear * length**2))

    def integral(courses: np.ndarray) -> np.ndarray:
        weighted: np.ndarray = 0.5 * length * np.einsum("k,ik,jk->ij", WEIGHTS, courses, courses)
        return weighted

    rotary = material.density * section.second_moment * integral(tilt)
    return ElementMatrices(
        mass=material.density * section.area * integral(displacement) + rotary,
        stiffness=bending * integral(curvature) + shear * length * np.outer(angle, angle),
        # The polar moment of a round section is twice that about a diameter.
        gyroscopic=2.0 * rotary,
    )


def _courses(at: np.ndarray, length: float, phi: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Displacement, tilt and curvature (4, k) at places ``ξ`` and the shear angle (4,), for ones at each end in turn."""
    one = np.ones_like(at)
    displacement = np.array(
        [
            1.0 - 3.0 * at**2 + 2.0 * at**3 + phi * (1.0 - at),
            length * (at - 2.0 * at**2 + at**3 + 0.5 * phi * (at - at**2)),
            3.0 * at**2 - 2.0 * at**3 + phi * at,
            length * (at**3 - at**2 - 0.5 * phi * (at - at**2)),
        ]
    )
    tilt = np.array(
        [
            6.0 * (at**2 - at) / length,
            1.0 - 4.0 * at + 3.0 * at**2 + phi * (1.0 - at),
            6.0 * (at - at**2) / length,
            3.0 * at**2 - 2.0 * at + phi * at,
        ]
    )
    curvature = np.array(
        [
            6.0 * (2.0 * at - one) / length**2,
            (6.0 * at - 4.0 - phi) / length,
            6.0 * (one - 2.0 * at) / length**2,
            (6.0 * at - 2.0 + phi) / length,
        ]
    )
    angle = np.array([-phi / length, -0.5 * phi, phi / length, -0.5 * phi])
    whole = 1.0 + phi
    return displacement / whole, tilt / whole, curvature / whole, angle / whole
