"""Systems from their modes, of any linear rotor and of one with a single coordinate; and modes of ``ẋ = A x``, in pairs where two nearly coincide."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.core.layout import rotor_record
from carom.core.wall import Wall
from carom.models.system import BesideModes, System

PARALLEL = 1e-3
"""Sine of the angle between two eigenvectors below which their modes become a pair: each digit lost is one of sixteen."""
INDEPENDENT = 1e-9
"""Smallest singular value of the basis that is accepted, relative to the largest."""
EXACT, ACCURATE = 1e-13, 1e-9
"""Error of the modes (:meth:`Modes.error`) up to which no other form is tried, and up to which they are accepted."""
MIXTURES = (0.6180339887498949, -1.324717957244746, 0.2541733958637162)
"""Weights with which matrices that commute are added, so that coordinates that differ differ in some of the sums."""


class Modes(NamedTuple):
    """Modes of a system."""

    exponents: np.ndarray
    """Shape (N,), complex."""
    driven: np.ndarray
    """Whether a mode is driven by the one before it; see :func:`carom.core.layout.rotor_record`.  Shape (N,), bool."""
    basis: np.ndarray
    """State per amplitude.  Shape (N, N), complex."""

    @property
    def generator(self) -> np.ndarray:
        """Matrix of the amplitudes, shape (N, N)."""
        return np.diag(self.exponents) + np.diag(self.driven[1:].astype(complex), -1)

    def error(self, matrix: np.ndarray) -> float:
        """Change of the amplitudes' matrix that would make these the modes of a matrix, relative to its size."""
        sizes = np.linalg.norm(self.basis, axis=0)
        missing = (matrix @ self.basis - self.basis @ self.generator) / sizes
        values = np.linalg.svd(self.basis / sizes, compute_uv=False)
        if values[-1] < INDEPENDENT * values[0]:
            return np.inf
        return float(np.linalg.norm(np.linalg.solve(self.basis / sizes, missing)) / np.linalg.norm(matrix))


def modes_of(matrix: np.ndarray, mass: np.ndarray | None = None) -> Modes:
    """Modes of ``ẋ = A x``; for a rotor, with its mass matrix ``M``, ``A = [[0, 1], [−M⁻¹K, −M⁻¹D]]``.

    Two modes with nearly parallel eigenvectors, such as those of a critically damped oscillator, span a plane in which
    ``A`` is upper triangular, ``[[λ, t], [0, μ]]`` (Schur).  Its first vector is the driven mode, the second one over
    ``t`` the driving mode.  Where more modes nearly coincide, those of a rotor whose coordinates can be separated are
    still known: each coordinate has a pair.  Parts of the state that do not act on each other have modes of their own, such as the
    displacement of a free rotor beside its tilt; and parts that are only driven, such as controllers that run while the rotor falls, are what the
    modes of the others make of them, beside modes of their own.  Otherwise the system is refused.
    """
    found = [_by_eigenvectors(matrix)]
    if found[0].error(matrix) > EXACT:
        found += [_by_parts(matrix)]
    if mass is not None and found[0].error(matrix) > EXACT:
        found += [modes for weight in MIXTURES if (modes := _by_coordinates(matrix, mass, weight))]
    best = min(found, key=lambda modes: modes.error(matrix))
    if best.error(matrix) > ACCURATE and (cascade := _by_cascade(matrix)):
        best = cascade
    if best.error(matrix) > ACCURATE:
        raise InputError(
            "mass, damping, stiffness",
            "three modes in one",
            "at most two modes that nearly coincide, unless they belong to coordinates that can be separated",
        )
    return best


def _by_eigenvectors(matrix: np.ndarray) -> Modes:
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
    return Modes(np.array(values), np.array(driven), np.array(columns).T)


def _by_parts(matrix: np.ndarray) -> Modes:
    """Modes of the parts of the state that do not act on each other, one part after the other."""
    linked = (matrix != 0.0) | (matrix != 0.0).T | np.eye(len(matrix), dtype=bool)
    for _ in range(len(matrix).bit_length()):
        linked = linked @ linked
    firsts = linked.argmax(axis=1)
    exponents, driven = np.empty(len(matrix), complex), np.empty(len(matrix), bool)
    basis, first = np.zeros(matrix.shape, complex), 0
    for part in np.unique(firsts):
        places = np.flatnonzero(firsts == part)
        modes, those = _by_eigenvectors(matrix[np.ix_(places, places)]), slice(first, first + len(places))
        exponents[those], driven[those], basis[places, those] = modes.exponents, modes.driven, modes.basis
        first += len(places)
    return Modes(exponents, driven, basis)


def _by_cascade(matrix: np.ndarray) -> Modes | None:
    """Modes of the states that act on others, with what they drive, then those of the states that are only driven; ``None`` without such."""
    acts = (matrix != 0.0) | np.eye(len(matrix), dtype=bool)
    for _ in range(len(matrix).bit_length()):
        acts = acts @ acts
    last = ~(acts & ~acts.T).any(axis=0)
    if last.all():
        return None
    first, second = (modes_of(matrix[np.ix_(those, those)]) for those in (~last, last))
    inner, pushes = matrix[np.ix_(last, last)], matrix[np.ix_(last, ~last)] @ first.basis
    basis, count = np.zeros(matrix.shape, complex), len(first.exponents)
    basis[~last, :count], basis[last, count:] = first.basis, second.basis
    for mode in reversed(range(count)):
        push = -pushes[:, mode]
        if mode + 1 < count and first.driven[mode + 1]:
            push = push + basis[last, mode + 1]
        basis[last, mode] = np.linalg.lstsq(inner - first.exponents[mode] * np.eye(len(inner)), push)[0]
    return Modes(np.append(first.exponents, second.exponents), np.append(first.driven, second.driven), basis)


def _by_coordinates(matrix: np.ndarray, mass: np.ndarray, weight: float) -> Modes | None:
    """Modes of coordinates in which ``M``, ``D`` and ``K`` are diagonal, if there are any.

    With ``M = L Lᴴ`` they are orthogonal eigenvectors that the Hermitian and anti-Hermitian parts of ``L⁻¹ K L⁻ᴴ`` and
    ``L⁻¹ D L⁻ᴴ`` have in common, and so those of a sum of these with any weights.  Each coordinate, ``ü + d u̇ + k u = 0``,
    has the driven amplitude ``u`` and the driving one ``u̇ − λ₊u``, however close ``λ₊`` and ``λ₋`` are.
    """
    n = len(mass)
    try:
        root = np.linalg.cholesky(mass)
    except np.linalg.LinAlgError:
        return None
    # Similar to M⁻¹K and M⁻¹D: Lᴴ (M⁻¹K) L⁻ᴴ.
    across = np.linalg.inv(root).conj().T
    stiffness, damping = (-root.conj().T @ part @ across for part in (matrix[n:, :n], matrix[n:, n:]))
    normed = (part / np.linalg.norm(part) for part in (stiffness, damping))
    parts = [part + part.conj().T for each in normed for part in (each, 1j * each)]
    turn = np.linalg.eigh(sum(weight**power * part for power, part in enumerate(parts)))[1]
    k, d = (np.diag(turn.conj().T @ part @ turn) for part in (stiffness, damping))
    split = np.sqrt(d * d / 4.0 - k)
    split = np.where(split.real < 0.0, -split, split)
    driving, driven, shapes = -d / 2.0 - split, -d / 2.0 + split, across @ turn
    columns = [
        np.concatenate(column)
        for shape, rate in zip(shapes.T, driven, strict=True)
        for column in ((0.0 * shape, shape), (shape, rate * shape))
    ]
    exponents = np.stack([driving, driven], axis=1).ravel()
    return Modes(exponents, np.tile([False, True], n), np.array(columns).T)


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


SMALLEST = 2
"""Least number of modes in the arrays; larger numbers are powers of two."""


_ALONG_MODES = {
    **dict.fromkeys(
        ("driven", "free", "columns", "conjugate_columns", "limit_columns", "limit_conjugates", "unbalance"), 0
    ),
    **dict.fromkeys(("rows", "limit_rows", "gap_rows"), 1),
}
"""Fields with a number for each mode, and along which axis."""


def size_of(modes: int) -> int:
    """Number of modes in the arrays of a system with so many."""
    return max(SMALLEST, 1 << (modes - 1).bit_length())


def walls_as_arrays(walls: Sequence[Wall]) -> dict[str, np.ndarray]:
    """The fields of :func:`~carom.core.layout.rotor_record` for the walls at its planes."""
    return dict(zip(Wall._fields, np.array(walls, float).T, strict=True))


def modal_system(
    *,
    rest: np.ndarray,
    shapes: np.ndarray,
    inverse: np.ndarray,
    arrays: dict[str, np.ndarray],
    beside: BesideModes,
    forced: np.ndarray | None = None,
    conjugate_modes: np.ndarray | None = None,
) -> System:
    """System of these modes, in arrays of one of few sizes: each size of the kernels takes seconds to compile.

    Parameters
    ----------
    rest, shapes, inverse, forced, conjugate_modes
        See :class:`System`.
    arrays : dict of str to ndarray
        Arguments of :func:`~carom.core.layout.rotor_record`; all modes are free by default.
    beside : BesideModes
        Each race that turns is one more mode, a shaft whose speed changes two, at the nominal speed at first.
    """
    exponents, shaft, races = arrays["exponents"], beside.shaft, beside.races or ()
    modes, turning = len(exponents), [(plane, race) for plane, race in enumerate(races) if race is not None]
    number = len(turning)
    size = size_of(modes + number + (0 if shaft is None else 2))

    def filled(values: np.ndarray, axis: int = 0, filler: complex = 0.0) -> np.ndarray:
        room = [(0, 0)] * values.ndim
        room[axis] = (0, size - values.shape[axis])
        return np.pad(values, room, constant_values=filler)

    arrays = {"free": np.ones(modes, bool)} | arrays
    if turning:
        exponents = np.append(exponents, [race.exponent for _, race in turning])
        speeds = np.append(np.zeros(modes) if forced is None else forced, [race.surface_speed for _, race in turning])
        forced = speeds if speeds.any() else None
        place, gain = np.full(len(races), -1), np.zeros(len(races))
        for mode, (plane, race) in enumerate(turning, modes):
            place[plane], gain[plane] = mode, race.gain(float(arrays["masses"][plane]))
        arrays |= {"race": place, "race_gain": gain}
    if shaft is not None:
        exponents = np.append(exponents, np.zeros(2))
        forced = np.append(np.zeros(modes + number) if forced is None else forced, np.ones(2))
        arrays |= {
            "shaft": np.array([modes + number]),
            "unbalance": inverse[:, len(rest) :] @ shaft.accelerations,
            "shaft_gain": shaft.gains(arrays["masses"], arrays["surface_speed"] - 1.0),
            "drive": np.array([shaft.drive]),
        }
    if beside.magnets is not None:
        arrays |= {"gap_rows": beside.magnets @ shapes, "gap_offsets": beside.magnets @ rest}
    arrays = {name: filled(each, _ALONG_MODES[name]) if name in _ALONG_MODES else each for name, each in arrays.items()}
    return System(
        rotor_record(**arrays | {"exponents": filled(exponents, filler=exponents[-1])}),
        rest,
        filled(shapes, 1),
        filled(inverse),
        forced=None if forced is None else filled(forced),
        conjugate_modes=None if conjugate_modes is None else filled(conjugate_modes),
        translation=beside.translation,
        races=races if turning else None,
        shaft=shaft,
        clearances=beside.clearances,
        growth=beside.growth,
        magnets=beside.magnets,
    )


@checked
def second_order_system(
    *,
    exponents: tuple[complex, complex],
    equilibrium: complex,
    wall: Wall,
    mass: float = 1.0,
) -> System:
    """System of ``ü + αu̇ + βu = Γ`` with one coordinate ``u``, which is also its displacement at the wall.

    Its two modes are a pair: the driving amplitude ``b = u̇ − λ₊(u − K)``, which decays with ``λ₋``, and the driven
    ``a = u − K``.  So underdamped, critically damped and overdamped rotors are treated alike.

    Parameters
    ----------
    exponents : tuple of complex
        Roots ``λ₋, λ₊`` of ``λ² + αλ + β``, the one with the smaller real part first.
    equilibrium : complex
        ``K = Γ/β``.
    wall : carom.core.wall.Wall
    mass : float
        Effective mass at the wall, in the unit of masses.
    """
    offsets, rows = np.array([equilibrium], np.complex128), np.array([[0.0, 1.0]], np.complex128)
    arrays = rotor_record(
        exponents=np.array(exponents, np.complex128),
        driven=np.array([False, True]),
        offsets=offsets,
        rows=rows,
        columns=np.array([[1.0], [0.0]], np.complex128),
        **walls_as_arrays([wall]),
        masses=np.array([mass]),
    )
    return System(arrays, offsets, rows, np.array([[-exponents[1], 1.0], [1.0, 0.0]], np.complex128))
