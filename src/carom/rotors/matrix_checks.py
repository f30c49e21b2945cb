"""What matrices of a free rotor must be; each fault is stated in one line that names the matrix."""

from __future__ import annotations

import numpy as np

from carom.base.outcome import InputError
from carom.rotors.state_spaces import real_numbers

ROUNDED = 1e-6
"""Share of the largest numbers up to which a fault is taken for rounding: files are written with few digits."""
DEFINITE = 1e-12
"""Smallest eigenvalue of a matrix whose diagonal is one, up to which it counts as zero."""
RIGID = 2
"""Motions of a rotor that nothing holds: translation and tilt."""
APART = 10.0
"""Times that bending is stiffer than what resists these motions, which is rounding."""


def checked_matrix(name: str, given: object, size: int) -> np.ndarray:
    """A symmetric matrix of this size, made so to the last digit; read-only."""
    matrix = real_numbers(name, given)
    if matrix.shape != (size, size):
        allowed = f"a square matrix with a displacement and a tilt at each of {size // 2} nodes: {size} rows"
        raise InputError(name, f"an array of shape {matrix.shape}", allowed)
    uneven = np.abs(matrix - matrix.T)
    row, column = np.unravel_index(uneven.argmax(), uneven.shape)
    if uneven[row, column] > ROUNDED * np.abs(matrix).max():
        shown = f"unsymmetric: {matrix[row, column]:g} in row {row}, column {column}; {matrix[column, row]:g} opposite"
        raise InputError(name, shown, "a symmetric matrix (rows and columns are counted from 0)")
    matrix = 0.5 * (matrix + matrix.T)
    matrix.flags.writeable = False
    return matrix


def check_mass(mass: np.ndarray) -> None:
    """Refuse masses with which a motion would have no kinetic energy, or less."""
    least = int(mass.diagonal().argmin())
    if mass[least, least] <= 0.0:
        shown = f"indefinite: {mass[least, least]:g} on the diagonal in row {least}"
        raise InputError("M", shown, f"masses above zero; of {_kind(least)} give the inertia of the shaft there")
    lowest = float(_scaled(mass)[0])
    if lowest <= DEFINITE:
        allowed = "a positive definite matrix: each motion has kinetic energy"
        raise InputError("M", f"indefinite: eigenvalue {lowest:.3g}, with ones on the diagonal", allowed)


def check_free(stiffness: np.ndarray, nodes: np.ndarray) -> None:
    """Refuse a stiffness that holds the rotor, pushes it away, or leaves it in pieces."""
    count = len(nodes)
    at = nodes - nodes.mean()
    along, up, down = np.tile([1.0, 0.0], count), _tilted(at, 1.0), _tilted(at, -1.0)
    least = int(stiffness.diagonal().argmin())
    if stiffness[least, least] <= 0.0:
        shown = f"indefinite: {stiffness[least, least]:g} on the diagonal in row {least}"
        raise InputError("K", shown, f"stiffness above zero for {_kind(least)}")
    if _resists(stiffness, along):
        raise InputError(
            "K", "holds the rotor when it moves as a whole", "the stiffness of the rotor without its bearings"
        )
    if _resists(stiffness, up):
        turned = not _resists(stiffness, down)
        shown = "has tilts of the other sign" if turned else "holds the rotor when it tilts as a whole"
        allowed = "tilts dx/ds" if turned else "the stiffness of the rotor without its bearings, and nodes in m"
        raise InputError("K", shown, allowed)
    first, second, third = _scaled(stiffness)[: RIGID + 1].tolist()
    if third <= APART * max(abs(first), abs(second)) or first < -ROUNDED:
        shown = f"three lowest eigenvalues, with ones on the diagonal: {first:.3g}, {second:.3g}, {third:.3g}"
        allowed = (
            "two that vanish, for the rotor moves freely, and others well above zero; numbers need all their digits"
        )
        raise InputError("K", shown, allowed)


def check_gyroscopic(gyroscopic: np.ndarray, nodes: np.ndarray) -> None:
    """Refuse moments of a rotor that does not tilt, and a polar inertia below zero."""
    count = len(nodes)
    if _resists(gyroscopic, np.tile([1.0, 0.0], count)):
        raise InputError(
            "G", "acts on a rotor that does not tilt", "0 times a translation: polar inertias act on tilts"
        )
    tilted = _tilted(nodes - nodes.mean(), 1.0)
    polar = float(tilted @ gyroscopic @ tilted)
    if polar < 0.0:
        raise InputError("G", f"polar inertia {polar:g} kg m^2", "above zero: M z'' + (D - i speed G) z' + K z = f")


def check_damping(damping: np.ndarray) -> None:
    """Refuse damping that feeds a motion."""
    size = np.abs(damping).max()
    if size and np.linalg.eigvalsh(damping)[0] < -ROUNDED * size:
        raise InputError("D", "indefinite: it feeds a motion", "a positive semidefinite matrix")


def _tilted(at: np.ndarray, sign: float) -> np.ndarray:
    """Coordinates of a straight rotor tilted by 1."""
    return np.stack([at, np.full(len(at), sign)], axis=1).ravel()


def _resists(matrix: np.ndarray, motion: np.ndarray) -> bool:
    """Whether a matrix times a motion is more than rounding, in any row."""
    return bool((np.abs(matrix @ motion) > ROUNDED * (np.abs(matrix) @ np.abs(motion))).any())


def _scaled(matrix: np.ndarray) -> np.ndarray:
    """Eigenvalues, from the lowest on, with ones on the diagonal."""
    sizes = np.sqrt(matrix.diagonal())
    found: np.ndarray = np.linalg.eigvalsh(matrix / np.outer(sizes, sizes))
    return found


def _kind(row: int) -> str:
    return f"the {'tilt' if row % 2 else 'displacement'} at node {row // 2}"
