"""Systems from their modes: of any linear rotor, and of one with a single coordinate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from carom.base.arguments import checked
from carom.core.layout import rotor_record
from carom.core.wall import Wall
from carom.models.race import RaceModes
from carom.models.shaft import ShaftModes
from carom.models.system import System

SMALLEST = 2
"""Least number of modes in the arrays; larger numbers are powers of two."""


def walls_as_arrays(walls: Sequence[Wall]) -> dict[str, np.ndarray]:
    """The fields of :func:`~carom.core.layout.rotor_record` for the walls at its planes."""
    return dict(zip(Wall._fields, np.array(walls, float).T, strict=True))


def modal_system(
    *,
    exponents: np.ndarray,
    driven: np.ndarray,
    rest: np.ndarray,
    shapes: np.ndarray,
    inverse: np.ndarray,
    rows: np.ndarray,
    columns: np.ndarray,
    free: np.ndarray | None = None,
    forced: np.ndarray | None = None,
    translation: np.ndarray | None = None,
    races: RaceModes | None = None,
    shaft: ShaftModes | None = None,
    clearances: tuple[float, ...] | None = None,
    limits: Mapping[str, np.ndarray] | None = None,
    conjugate_modes: np.ndarray | None = None,
    mirror_columns: np.ndarray | None = None,
    mirror: np.ndarray | None = None,
    magnets: np.ndarray | None = None,
    **planes: np.ndarray,
) -> System:
    """System of these modes, in arrays of one of few sizes: each size of the kernels takes seconds to compile.

    Parameters
    ----------
    exponents, driven, free, rows, columns, limits, mirror, mirror_columns, **planes
        See :func:`~carom.core.layout.rotor_record`.
    rest, shapes, inverse, forced, translation, clearances, conjugate_modes, magnets
        See :class:`System`.
    races : RaceModes, optional
        Further modes, of races that turn.
    shaft : ShaftModes, optional
        Two more, of a shaft whose speed changes, at the nominal speed at first.
    """
    modes, number = len(exponents), 0 if races is None else len(races.planes)
    more = number if shaft is None else number + 2
    size = max(SMALLEST, 1 << (modes + more - 1).bit_length())

    def filled(values: np.ndarray, axis: int = 0, filler: complex = 0.0) -> np.ndarray:
        room = [(0, 0)] * values.ndim
        room[axis] = (0, size - values.shape[axis])
        return np.pad(values, room, constant_values=filler)

    if races is not None:
        exponents = np.append(exponents, races.exponents)
        speeds = np.append(np.zeros(modes) if forced is None else forced, races.speeds)
        forced = speeds if speeds.any() else None
        place, gain = np.full(len(rows), -1), np.zeros(len(rows))
        place[races.planes], gain[races.planes] = modes + np.arange(number), races.gains
        planes |= {"race": place, "race_gain": gain}
    if shaft is not None:
        exponents = np.append(exponents, np.zeros(2))
        forced = np.append(np.zeros(modes + number) if forced is None else forced, np.ones(2))
        planes |= {
            "shaft": np.array([modes + number]),
            "unbalance": filled(inverse[:, len(rest) :] @ shaft.accelerations),
            "shaft_gain": shaft.gains(planes["masses"], planes["surface_speed"] - 1.0),
            "drive": np.array([shaft.drive]),
        }
    if limits is not None:
        limits = {
            **limits,
            "limit_rows": filled(limits["limit_rows"], 1),
            "limit_columns": filled(limits["limit_columns"]),
            "limit_mirrors": filled(limits["limit_mirrors"]),
        }
    if mirror is not None and mirror_columns is not None:
        planes |= {"mirror": mirror, "mirror_columns": filled(mirror_columns)}
    if magnets is not None:
        planes |= {"gap_rows": filled(magnets @ shapes, 1), "gap_offsets": magnets @ rest}
    arrays = rotor_record(
        limits=limits,
        exponents=filled(exponents, filler=exponents[-1]),
        driven=filled(driven),
        free=filled(np.ones(modes, bool) if free is None else free),
        rows=filled(rows, 1),
        columns=filled(columns),
        **planes,
    )
    moved = None if forced is None else filled(forced)
    conjugates = None if conjugate_modes is None else filled(conjugate_modes)
    shown = filled(shapes, 1)
    return System(
        arrays, rest, shown, filled(inverse), translation, moved, races, shaft, clearances, conjugates, magnets=magnets
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
        limits=None,
        **walls_as_arrays([wall]),
        masses=np.array([mass]),
    )
    return System(arrays, offsets, rows, np.array([[-exponents[1], 1.0], [1.0, 0.0]], np.complex128))
