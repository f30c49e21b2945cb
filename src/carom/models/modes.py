"""Modes of a linear system ``ẋ = A x`` in a form that stays well conditioned where two of them nearly coincide."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.outcome import InputError

PARALLEL = 1e-3
"""Sine of the angle between two eigenvectors below which their modes become a pair: each digit lost is one of sixteen."""
INDEPENDENT = 1e-9
"""Smallest singular value of the basis that is accepted, relative to the largest."""


class Modes(NamedTuple):
    """Modes of a system."""

    exponents: np.ndarray
    """Shape (N,), complex."""
    driven: np.ndarray
    """Whether a mode is driven by the one before it; see :func:`carom.core.layout.rotor_record`.  Shape (N,), bool."""
    basis: np.ndarray
    """State per amplitude.  Shape (N, N), complex."""


def modes_of(matrix: np.ndarray) -> Modes:
    """Modes of ``ẋ = A x``.

    Two modes with nearly parallel eigenvectors, such as those of a critically damped oscillator, span a plane in which
    ``A`` is upper triangular, ``[[λ, t], [0, μ]]`` (Schur).  Its first vector is the driven mode, the second one over
    ``t`` the driving mode.

    Parameters
    ----------
    matrix : ndarray of complex, shape (N, N)

    Raises
    ------
    InputError
        More than two modes nearly coincide.
    """
    exponents, vectors = np.linalg.eig(matrix)
    order = np.lexsort((exponents.imag, exponents.real))
    exponents, vectors = exponents[order], vectors[:, order]
    cosines = np.abs(vectors.conj().T @ vectors)
    left = list(range(len(exponents)))
    found: list[tuple[complex, bool, np.ndarray]] = []
    while left:
        first = left.pop(0)
        nearest = max(left, key=lambda k: cosines[first, k], default=first)
        if nearest == first or cosines[first, nearest] ** 2 < 1.0 - PARALLEL**2:
            found.append((exponents[first], False, vectors[:, first]))
            continue
        left.remove(nearest)
        found += _pair(matrix, exponents[first], exponents[nearest])
    values, driven, columns = zip(*found, strict=True)
    basis = np.array(columns).T
    sizes = np.linalg.svd(basis / np.linalg.norm(basis, axis=0), compute_uv=False)
    if sizes[-1] < INDEPENDENT * sizes[0]:
        raise InputError("mass, damping, stiffness", "three modes in one", "at most two modes that nearly coincide")
    return Modes(np.array(values), np.array(driven), basis)


def _pair(matrix: np.ndarray, first: complex, second: complex) -> list[tuple[complex, bool, np.ndarray]]:
    """Driving and driven mode of the plane that two nearly parallel eigenvectors span."""
    unit = np.eye(len(matrix))
    plane = np.linalg.svd((matrix - first * unit) @ (matrix - second * unit))[2][-2:].conj().T
    block = plane.conj().T @ matrix @ plane
    mean, gap = 0.5 * np.trace(block), 0.5 * (block[0, 0] - block[1, 1])
    split = np.sqrt(gap * gap + block[0, 1] * block[1, 0])
    slow = mean + split if split.real >= 0.0 else mean - split
    # The longer of two forms of the eigenvector: one may vanish.
    forms = np.array([[block[0, 1], slow - block[0, 0]], [slow - block[1, 1], block[1, 0]]])
    vector = forms[np.abs(forms).sum(axis=1).argmax()]
    vector = vector / np.linalg.norm(vector)
    turn = np.array([[vector[0], -vector[1].conj()], [vector[1], vector[0].conj()]])
    triangle = turn.conj().T @ block @ turn
    driven, driving = (plane @ turn).T
    if abs(triangle[0, 1]) <= INDEPENDENT * np.abs(block).max():
        return [(triangle[1, 1], False, driving), (triangle[0, 0], False, driven)]
    return [(triangle[1, 1], False, driving / triangle[0, 1]), (triangle[0, 0], True, driven)]
