"""Few vectors in place of all coordinates of a rotor, after Rubin (AIAA Journal 13, 1975).

Kept are the lowest modes of the free rotor; the vectors beside them hold the compliance of all other modes to a steady force where forces act and
displacements are measured.  So the motion far below the lowest mode left out is exact, however few are kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from carom.rotors.free_rotor import FreeRotor

DEPENDENT = 1e-10
"""Share of the elastic energy of the largest of the vectors up to which another one is counted as a sum of the others."""
RIGID = 2
"""Rigid motions: translation and tilt."""
MORE = 1.5
"""Times as many vectors, with which a reduction is compared."""
COMING, REACHED = 3, 0.05
"""Modes in which the rotor comes, and their share at the wall, over the largest, below which it hardly comes so."""
EQUAL = 1e-6
"""Difference of two exponents, over a contact, below which they count as so far apart: nothing changes but for rounding."""
TIMES = 600
"""Instants of a contact that are compared."""


class Basis(NamedTuple):
    """Vectors with unit modal mass in which no stiffness couples one with another."""

    shapes: np.ndarray
    """Coordinates per vector, shape (n, v); the first two are translation and tilt."""
    frequencies: np.ndarray
    """rad/s, shape (v,)."""
    modes: int
    """How many are modes of the free rotor."""
    damping_ratio: float = 0.0
    """Of the others, beside what the shaft damps them: their motion is none of the rotor, and with controllers it may grow where the rotor's does not."""


def rubin_basis(rotor: FreeRotor, rows: Sequence[np.ndarray], modes: int) -> Basis:
    """Vectors of a rotor: its first modes, and one for each row (n,) of what forces act on or sensors measure."""
    free = rotor.free_modes
    total = len(free.frequencies)
    if modes >= total:
        return Basis(free.shapes, free.frequencies, total)
    kept = free.shapes[:, :modes]
    beside = np.stack([free.flexibility(row, modes) for row in rows], axis=1)
    beside /= np.sqrt(np.einsum("ni,nm,mi->i", beside, rotor.matrices.stiffness, beside))
    energies, turn = np.linalg.eigh(beside.T @ rotor.matrices.stiffness @ beside)
    beside = beside @ turn[:, energies > DEPENDENT * energies[-1]]
    if modes + beside.shape[1] >= total:
        return Basis(free.shapes, free.frequencies, total)
    root = np.linalg.cholesky(beside.T @ rotor.matrices.mass @ beside)
    beside = np.linalg.solve(root, beside.T).T
    squares, turn = np.linalg.eigh(beside.T @ rotor.matrices.stiffness @ beside)
    return Basis(
        np.concatenate([kept, beside @ turn], axis=1), np.append(free.frequencies[:modes], np.sqrt(squares)), modes
    )


def damping_of_basis(rotor: FreeRotor, basis: Basis) -> np.ndarray:
    """Damping of the vectors by what stands still, and of those that are no modes beside it."""
    matrix = damping_by(basis, rotor.damping_matrix, rotor.damping_rates)
    beside = range(basis.modes, len(basis.frequencies))
    matrix[beside, beside] += 2.0 * basis.damping_ratio * basis.frequencies[basis.modes :]
    return matrix


def damping_by(basis: Basis, given: np.ndarray, rates: np.ndarray | None) -> np.ndarray:
    """Damping of the vectors: of each mode its own, which couples it with nothing, unless a matrix alone is given."""
    matrix = basis.shapes.T @ given @ basis.shapes
    if rates is not None:
        matrix[: basis.modes], matrix[:, : basis.modes] = 0.0, 0.0
        matrix[range(basis.modes), range(basis.modes)] = rates[: basis.modes]
    return np.asarray(0.5 * (matrix + matrix.T))


def contact_error(rotor: FreeRotor, coarse: Basis, fine: Basis, row: np.ndarray, stiffness: float) -> float:
    """Difference of the force on a wall between two sets of vectors, relative to the force: root of the means of the squares.

    The free rotor comes to a wall with this stiffness, N/m, at what a row measures: straight, with all its mass; tilting; and in its first
    bending mode.  Compared is the force until contact ends; stated is the largest difference.
    """
    end = 2.0 * np.pi * np.sqrt(1.0 / (stiffness * fine.shapes[0, 0] ** 2))  # twice as long as the rigid rotor stays
    times = np.linspace(0.0, end, TIMES)
    reached = np.abs(row @ fine.shapes[:, :COMING])
    modes = np.flatnonzero(reached > REACHED * reached.max())
    errors = []
    for one, other in zip(
        *(_forces(rotor, each, row, stiffness, times, modes) for each in (coarse, fine)), strict=True
    ):
        over = np.flatnonzero(other[1:] <= 0.0)
        lasts = slice(0, over[0] + 2 if len(over) else None)
        errors.append(float(np.linalg.norm((one - other)[lasts]) / np.linalg.norm(other[lasts])))
    return max(errors)


def _forces(
    rotor: FreeRotor, basis: Basis, row: np.ndarray, stiffness: float, times: np.ndarray, modes: np.ndarray
) -> np.ndarray:
    """Force on the wall over time, by the velocity at the wall and the stiffness, of a rotor that comes in each of these modes.

    Each motion of the rotor with the wall is damped by itself: what damping couples is left out.
    """
    reach = row @ basis.shapes
    squares, turn = np.linalg.eigh(np.diag(basis.frequencies**2) + stiffness * np.outer(reach, reach))
    half = 0.5 * np.einsum("vi,vw,wi->i", turn, damping_of_basis(rotor, basis), turn)
    split = np.sqrt(half**2 - squares + 0j)
    split = np.where(np.abs(split) * times[-1] < EQUAL, EQUAL / times[-1], split)
    grown, fallen = (np.exp(np.multiply.outer(times, sign * split - half)) for sign in (1.0, -1.0))
    moved = ((grown - fallen) / (2.0 * split)).real
    starts = turn[modes] / reach[modes, None]
    forces: np.ndarray = stiffness * (starts * (reach @ turn)) @ moved.T
    return forces
