"""Systems from their modes: of any linear rotor, and of one with a single coordinate."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.base.arguments import checked
from carom.core.layout import rotor_record
from carom.core.wall import Wall
from carom.models.system import BesideModes, System

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
