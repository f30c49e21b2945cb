"""A rotor by its matrices, as another program has made them; a fault of these is stated in one line that names the matrix."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from carom.base.outcome import InputError, shown
from carom.rotors.free_rotor import BendingRotor, RotorMatrices
from carom.rotors.shaft_parts import Damping, Disc
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
    _check_diagonal("M", mass, "masses above zero; of {} give the inertia of the shaft there")
    lowest = float(_scaled(mass)[0])
    if lowest <= DEFINITE:
        allowed = "a positive definite matrix: each motion has kinetic energy"
        raise InputError("M", f"indefinite: eigenvalue {lowest:.3g}, with ones on the diagonal", allowed)


def check_free(stiffness: np.ndarray, nodes: np.ndarray) -> None:
    """Refuse a stiffness that holds the rotor, pushes it away, or leaves it in pieces."""
    count = len(nodes)
    at = nodes - nodes.mean()
    along, up, down = np.tile([1.0, 0.0], count), _tilted(at, 1.0), _tilted(at, -1.0)
    _check_diagonal("K", stiffness, "stiffness above zero for {}")
    free = "the stiffness of the rotor without its bearings"
    if _resists(stiffness, along):
        raise InputError("K", "holds the rotor when it moves as a whole", free)
    if _resists(stiffness, up):
        turned = not _resists(stiffness, down)
        shown = "has tilts of the other sign" if turned else "holds the rotor when it tilts as a whole"
        raise InputError("K", shown, "tilts dx/ds" if turned else f"{free}, and nodes in m")
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


def _check_diagonal(name: str, matrix: np.ndarray, allowed: str) -> None:
    row = int(matrix.diagonal().argmin())
    if matrix[row, row] <= 0.0:
        coordinate = f"the {'tilt' if row % 2 else 'displacement'} at node {row // 2}"
        shown = f"indefinite: {matrix[row, row]:g} on the diagonal in row {row}"
        raise InputError(name, shown, allowed.format(coordinate))


MOST_NODES = 500
"""With more, matrices take gigabytes; a shaft needs dozens."""
ORDERS = {4: ("x", "y", "alpha", "beta"), 6: ("x", "y", "z", "alpha", "beta", "theta")}
"""Order of real coordinates of a node by their number, unless another one is stated: that of ROSS."""
SIGNS = {"x": 1.0, "beta": 1.0, "y": 1.0, "alpha": -1.0}
"""``x`` and ``β = dx/ds``, and ``y`` and ``−α = dy/ds``, are alike: ``α`` and ``β`` turn about the axes of ``x`` and ``y``."""
SYMMETRY_RTOL = 1e-6
"""Difference of both planes, relative to the largest number, up to which they are alike; files are rounded."""


@dataclass(frozen=True, eq=False)
class MatrixRotor(BendingRotor):
    """A rotor free in space by its matrices, in SI units.

    At each node, of which 0 is the first one, there are a complex displacement ``x + iy``, m, and a complex tilt
    ``dx/ds + i dy/ds``, in turn; with the speed ``Ω`` of the shaft in the fixed frame ``M z̈ + (D − iΩG) ż + K z = f``.

    Attributes
    ----------
    M, K, G : array_like, shape (2N, 2N)
        Masses, stiffness and gyroscopic matrix (polar inertias), symmetric.  Bearings are no part of them: nothing holds the rotor.
    nodes : sequence of float, length N
        Where the nodes are along the shaft, m, increasing.
    damping : ProportionalDamping, ModalDamping, or array_like, shape (2N, 2N)
        Or the matrix ``D``, symmetric, as seen in the fixed frame.
    names : sequence of str, optional
        A name for each node; empty ones have none.
    discs : sequence of Disc, optional
        What is put on the shaft beside what the matrices hold.
    internal : ProportionalDamping or ModalDamping, optional
        Damping that turns with the shaft, ``D_i (ż − iΩz)``, beside ``D``, which stands still.

    Raises
    ------
    InputError
        A matrix has another size, is not symmetric, or holds what is no finite real number; masses are indefinite, stiffness holds the rotor or pushes it
        away, or both planes of bending differ; or a disc sits at a node that the shaft does not have.
    """

    M: np.ndarray
    K: np.ndarray
    G: np.ndarray
    nodes: np.ndarray
    damping: Damping | np.ndarray
    names: Sequence[str] = ()
    discs: Sequence[Disc] = ()
    internal: Damping | None = None

    def __post_init__(self) -> None:
        for name in ("nodes", "places", "node_places"):
            object.__setattr__(self, name, _nodes(self.nodes))
        size = 2 * len(self.nodes)
        for name in ("M", "K", "G"):
            object.__setattr__(self, name, checked_matrix(name, getattr(self, name), size))
        check_mass(self.M)
        check_free(self.K, self.nodes)
        check_gyroscopic(self.G, self.nodes)
        if not isinstance(self.damping, Damping):
            if self.damping is None:
                allowed = "carom.rotors.ModalDamping, such as ModalDamping(0.005), ProportionalDamping, or a matrix"
                raise InputError("damping", None, allowed)
            object.__setattr__(self, "damping", checked_matrix("D", self.damping, size))
            check_damping(self.damping)
        self._check_internal()
        object.__setattr__(self, "names", _names(self.names, len(self.nodes)))
        self._read_discs()

    source: ClassVar[str] = ""
    """The file from which it was read, if it was."""

    @property
    def entries(self) -> Mapping[str, Any] | None:  # type: ignore[override]
        """Its file, if it is known."""
        return {"source": self.source} if self.source else None

    @classmethod
    def of_planes(
        cls,
        M: object,
        K: object,
        G: object,
        nodes: Any,
        damping: Any,
        coordinates: Sequence[str] | None = None,
        **others: Any,
    ) -> MatrixRotor:
        """Rotor by real matrices, with four or more coordinates at each node, in ``M q̈ + (D + ΩG) q̇ + K q = f``.

        Parameters
        ----------
        M, K, G : array_like, shape (kN, kN)
            ``G`` is skew.
        nodes : sequence of float, length N
        damping : ProportionalDamping, ModalDamping, or array_like, shape (kN, kN)
        coordinates : sequence of str, optional
            The ``k`` coordinates of each node: ``"x"``, ``"y"``, and rotations ``"alpha"`` and ``"beta"`` about these axes, so that ``β = dx/ds`` and
            ``α = −dy/ds``; others, such as those of torsion, are left out.  By default x, y, alpha, beta, or x, y, z, alpha, beta, theta of six.
        **others
            Further attributes of :class:`MatrixRotor`.

        Raises
        ------
        InputError
            Both planes are not alike, or coupled by other than gyroscopic moments, or see :class:`MatrixRotor`.
        """
        count = len(_nodes(nodes))
        given = {"M": M, "K": K, "G": G} | ({} if isinstance(damping, Damping | None) else {"D": damping})
        read = {name: real_numbers(name, matrix) for name, matrix in given.items()}
        order = _order(coordinates, read["M"], count)
        found: dict[str, Any] = {}
        for name, matrix in read.items():
            if matrix.shape != (count * len(order),) * 2:
                shape = f"a square matrix of {len(order)} coordinates at each of {count} nodes"
                raise InputError(name, f"an array of shape {matrix.shape}", shape)
            found[name] = _of_both_planes(name, matrix, order, count)
        return cls(**{name: found[name] for name in "MKG"}, nodes=nodes, damping=found.get("D", damping), **others)

    @cached_property
    def matrices(self) -> RotorMatrices:  # type: ignore[override]
        """``M``, ``K`` and ``G``."""
        return self._with_discs(self.M, self.K, self.G)

    def node_of(self, name: str) -> int:
        """Return the number of the node with this name.

        Raises
        ------
        InputError
            No node has it.
        """
        if name in self.names and name:
            return self.names.index(name)
        known = ", ".join(shown(each) for each in self.names if each)
        allowed = (
            f"a number, or the name of a node: {known}" if known else "a number: nodes of this rotor have no names"
        )
        raise InputError("node", shown(name), allowed)


def _nodes(given: object) -> np.ndarray:
    found = real_numbers("nodes", given).ravel()
    if not 2 <= len(found) <= MOST_NODES or not (np.diff(found) > 0.0).all():
        raise InputError("nodes", shown(given), f"increasing numbers in m, 2 to {MOST_NODES}, one for each node")
    return found


def _names(given: object, count: int) -> tuple[str, ...]:
    listed = tuple(given) if isinstance(given, Iterable) and not isinstance(given, str) else (given,)
    named = [each for each in listed if each]
    if (
        not all(isinstance(each, str) for each in listed)
        or len(listed) not in (0, count)
        or len(set(named)) < len(named)
    ):
        raise InputError("names", shown(given), f"{count} texts, one for each node, no name twice")
    return listed


def _order(coordinates: Sequence[str] | None, mass: np.ndarray, count: int) -> tuple[str, ...]:
    """The coordinates of each node."""
    each = len(mass) // count if mass.ndim == 2 else 0
    found = tuple(ORDERS.get(each, ())) if coordinates is None else tuple(coordinates)
    if not set(SIGNS) <= set(found) or len(set(found)) < len(found):
        given = f"an array of shape {mass.shape}" if coordinates is None else shown(", ".join(map(str, found)))
        field = "M" if coordinates is None else "coordinates"
        allowed = (
            f"2 (complex), 4 or 6 coordinates at each of {count} nodes, or coordinates that name x, y, alpha and beta"
        )
        raise InputError(field, given, allowed)
    return found


def _of_both_planes(name: str, matrix: np.ndarray, order: tuple[str, ...], count: int) -> np.ndarray:
    """One matrix (2N, 2N) of two planes alike."""
    at = len(order) * np.arange(count)
    planes = []
    for pair in (("x", "beta"), ("y", "alpha")):
        places = np.stack([at + order.index(each) for each in pair], axis=1).ravel()
        planes.append((places, np.tile([SIGNS[each] for each in pair], count)))
    blocks = [[matrix[np.ix_(i, j)] * np.outer(p, q) for j, q in planes] for i, p in planes]
    (same, across), (back, other) = blocks
    if name == "G":
        same, other, across, back = across, -back, same, other
    size = np.abs(matrix).max() or 1.0
    if max(np.abs(across).max(), np.abs(back).max()) > SYMMETRY_RTOL * size:
        words = "G is skew, from one plane to the other" if name == "G" else "nothing but G couples both planes"
        found = "couples a plane with itself" if name == "G" else "both planes of bending are coupled"
        raise InputError(name, found, words)
    if np.abs(same - other).max() > SYMMETRY_RTOL * size:
        raise InputError(name, "the planes of x and of y differ", "a round shaft, alike in both planes")
    return 0.5 * (same + other)
