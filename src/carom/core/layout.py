"""The data that kernels work on."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from carom.core.compiling.target import has_wide_registers
from carom.core.records import blank, filled, layout_of

RECURRENCE_RTOL = 1e-9
"""Distance, relative to one plus the size of the state, below which two states are the same."""
ORDER = 20
"""Order of the Taylor series of lasting contact."""
DEGREE = 8
"""Degree of the Bernstein polynomials that stand for ``|y|² − 1`` on a block of flight."""
LEVELS = 3
"""Number of block lengths, each a quarter of the one before."""
MOST_IN_POLYNOMIALS = 2
"""Most modes for which blocks of flight have polynomials: of more modes, steps by moduli alone are faster.

Measured for chains of masses: 1.7 times as slow with 2 modes; with 4, 8 and 16 modes 0.6 to 0.85 of the time.
"""
NODES = 64
"""Intervals of the longest block at whose ends the basis functions are tabulated."""
TERMS = 8
"""Terms of the Taylor series of the basis functions."""
COMPLEX, REAL = np.dtype(np.complex128), np.dtype(np.float64)
OCTET = 8
"""Number of doubles in the widest vector registers."""
WIDE = has_wide_registers()
"""Whether the processor has registers of that width (AVX-512); it then has more of them too."""
WIDTH = 3 * OCTET if WIDE else OCTET
"""Motions advanced together, in one or several registers: several hide the latency of the instructions."""
LANES = 3 * OCTET
"""Number of motions that are followed side by side."""
LANE_NODES = 32
"""Number of nodes for lanes, including both ends of the longest block.

The table at so few nodes fits in registers; in return, the power series from a node is longer.
"""
LANE_TERMS = 10
"""Terms of the Taylor series from a node for lanes."""


def rotor_record(
    *,
    exponents: np.ndarray,
    driven: np.ndarray,
    offsets: np.ndarray,
    rows: np.ndarray,
    columns: np.ndarray,
    friction: np.ndarray,
    restitution: np.ndarray,
    surface_speed: np.ndarray,
    free: np.ndarray | None = None,
    unbalance: np.ndarray | None = None,
    **others: np.ndarray,
) -> np.record:
    """A linear rotor with ``N`` moving modes and ``P`` contact stations, as the kernels see it.

    The displacement at station ``p``, in units of that station's clearance, is
    ``y_p(t) = offsets[p] + Σ_k rows[p, k] c_k(t)``, where the amplitudes obey ``ċ_k = λ_k c_k`` for a free-standing
    mode and ``ċ_k = λ_k c_k + c_{k−1}`` for a driven one.  A driven mode and those before it up to one that is not driven
    form a chain.  A pair stays well conditioned when its exponents meet (critical damping); the exponents of a longer chain
    are one number (free fall: weight, velocity, displacement).  Forcing with an exponent of its own (weight seen in the
    co-rotating frame, say) is a mode whose ``columns`` are zero, and not free.

    Parameters
    ----------
    exponents : ndarray of complex, shape (N,)
        ``λ_k`` in units of the shaft speed.
    driven : ndarray of bool, shape (N,)
        Whether mode ``k`` is driven by mode ``k − 1``; then ``Re λ_k ≥ Re λ_{k−1}``, and if ``k − 1`` is driven too, ``λ_k = λ_{k−1}``.
    offsets : ndarray of complex, shape (P,)
        Constant displacement of the stations.
    rows : ndarray of complex, shape (P, N)
        Displacement at the stations per amplitude.
    columns : ndarray of complex, shape (N, P)
        Change of the amplitudes by an impulse at a station that changes its velocity by one.
    friction, restitution : ndarray, shape (P,)
        Coulomb friction coefficient and coefficient of restitution of the stations.
    surface_speed : ndarray, shape (P,)
        Slip velocity of a rotor at rest in this frame, in clearances per unit time.
    law, law_number : ndarray, shape (P,), optional
        Law of each wall along its normal, and the law's own number (:class:`~carom.core.wall.Wall`).  Rigid by default.
    stiffness, loss : ndarray, shape (P,), optional
        Of compliant walls, per effective mass of the station.  Zero by default.
    farthest : ndarray, shape (P,), optional
        Distance of each station from the centre at which a motion ends, as the model holds no further.  Infinite by default.
    race : ndarray of int, shape (P,), optional
        Mode whose real amplitude is the surface speed of the race that turns at a station; −1, the default, without one.
    race_gain : ndarray, shape (P,), optional
        Change of that speed by a friction impulse, against it, that changes the velocity of the station by one.  Zero by default.
    masses : ndarray, shape (P,), optional
        Effective mass ``1/(W M⁻¹ Wᴴ)`` of each station: the impulse that changes its velocity by one.  Ones by default.
    free : ndarray of bool, shape (N,), optional
        Which modes a disturbance can change; the others are forcing, or fill the places of a larger rotor.  All by default.
    shaft : ndarray of int, shape (1,), optional
        First of the two modes of a shaft whose speed changes (:mod:`carom.core.shaft`).
    unbalance : ndarray of complex, shape (N,), optional
        Rates of the amplitudes by the unbalance of that shaft at the nominal speed; then ``offsets`` are those without it.
    shaft_gain : ndarray, shape (P,), optional
        Change of its speed by a friction impulse along growing angle that changes the velocity of the station by one.
    drive : ndarray, shape (1,), optional
        Rate of its speed by the torque of its drive, which acts in contact.
    limit_rows, limit_offsets, limit_bounds, limit_columns, limit_couplings, limit_conjugates : ndarray, optional
        Of ``L`` quantities with a limit along each of two axes of the fixed frame (:mod:`carom.core.limits`): rows (L, N) and offsets
        (L,), complex, by which they follow from the amplitudes; bounds (L,); columns (N, L), rates of the amplitudes by what lies beyond;
        couplings (L, L), by which what lies beyond one adds to those after it; where there is ``anisotropy``, also conjugates (N, L), as
        ``conjugate_columns``.
    anisotropy : ndarray of int, shape (1,), optional
        Mode of the turn of anisotropic bearings (:mod:`carom.core.anisotropy`).
    conjugate_columns : ndarray of complex, shape (N, P), optional
        Change of the amplitudes by the conjugate of an impulse at a station, times that turn.
    gap_rows, gap_offsets : ndarray of complex, shapes (G, N) and (G,), optional
        Displacements at magnets in their air gaps, as those of the stations: a motion ends where one is larger than one.

    Returns
    -------
    numpy.record
        The arguments and what follows from them: ``gaps`` and ``inverse_gaps`` (``λ_k − λ_{k−1}`` of the pairs),
        ``largest_response`` (bound of their ``|φ|`` over all later time), ``rate_rows``, ``acceleration_rows`` and
        ``jerk_rows`` (first three derivatives of the displacement at the stations per amplitude), ``mobility`` (change of
        velocity at the stations per unit impulse at each, shape (P, P), ones on its diagonal), ``weights``
        (``Σ_k |rows|²`` over the free modes), of a shaft ``unbalance_rows`` (acceleration of the stations by its unbalance at the nominal speed), and of
        limits ``limit_pulls`` (P, L) (acceleration of the stations by what lies beyond) and ``reach``, a record in which the quantities are stations, in
        units of their bounds.
        The fields of a shaft, of limits, of anisotropy and of air gaps have no entries without them: kernels for such rotors are compiled without them.  A record is passed by address and its shapes are known at compile time: kernels run six
        times as fast as with a tuple of arrays.
    """
    modes, stations = len(exponents), len(rows)
    generator = np.zeros((modes, modes), COMPLEX)
    generator.ravel()[:: modes + 1] = exponents
    values: list[complex] = exponents.tolist()
    gaps = [0j] * modes
    for k, follows in enumerate(np.asarray(driven).tolist()):
        if follows:
            generator[k, k - 1] = 1.0
            gaps[k] = values[k] - values[k - 1]
    own: dict[str, np.ndarray] = {
        "exponents": exponents,
        "driven": driven,
        "gaps": np.array(gaps),
        "inverse_gaps": np.array([1.0 / np.complex128(gap) if gap else 0j for gap in gaps]),
        "largest_response": np.array(_largest_response(values, gaps)),
    }
    seen = _seen(generator, rows, offsets)
    fields = _nothing_more(modes, stations) | own | seen | others
    number, scale = len(fields["limit_bounds"]), 1.0 / fields["limit_bounds"]
    limited = _seen(generator, fields["limit_rows"] * scale[:, None], fields["limit_offsets"] * scale)
    reach = own | limited | {"shaft": np.zeros(0)}
    fields |= {
        "columns": columns,
        "mobility": seen["rate_rows"].dot(columns),
        "weights": (np.abs(rows) ** 2).sum(axis=1) if free is None else (np.abs(rows) ** 2).dot(free),
        "friction": friction,
        "restitution": restitution,
        "surface_speed": surface_speed,
        "limit_pulls": seen["rate_rows"].dot(fields["limit_columns"]),
    }
    if free is not None:
        fields["free"] = free
    if unbalance is not None:
        more = {"unbalance": unbalance, "unbalance_rows": seen["rate_rows"].dot(unbalance), "response": np.zeros(modes)}
        fields |= more
    sizes = len(fields["shaft"]), number, len(fields["anisotropy"]), len(fields["gap_rows"])
    layout = _rotor_layout(modes, stations, *sizes)
    within = tuple(reach[name] for name in _flight_layout(modes, number).names or ())
    return filled(layout, tuple(within if name == "reach" else fields[name] for name in layout.names or ()))


@cache
def _nothing_more(modes: int, stations: int) -> dict[str, np.ndarray]:
    """Fields of a rotor between rigid walls, without race, shaft, limits, anisotropy and magnets."""
    none = np.zeros(stations)
    names = "law", "law_number", "stiffness", "loss", "race_gain"
    of_shaft = "shaft", "unbalance", "unbalance_rows", "response", "shaft_gain", "drive"
    return {
        **dict.fromkeys(names, none),
        "farthest": np.full(stations, np.inf),
        "race": np.full(stations, -1),
        "masses": np.ones(stations),
        "free": np.ones(modes),
        **dict.fromkeys((*of_shaft, "anisotropy", "gap_offsets"), np.zeros(0)),
        **dict.fromkeys(("conjugate_columns", "limit_conjugates", "limit_columns"), np.zeros((modes, 0), COMPLEX)),
        **dict.fromkeys(("gap_rows", "limit_rows"), np.zeros((0, modes), COMPLEX)),
        **dict.fromkeys(("limit_bounds", "limit_offsets"), np.zeros(0)),
        "limit_couplings": np.zeros((0, 0), COMPLEX),
    }


def _seen(generator: np.ndarray, rows: np.ndarray, offsets: np.ndarray) -> dict[str, np.ndarray]:
    """Rows of what follows from the amplitudes, and of its first three derivatives."""
    # For so few numbers, dot takes half the time of @.
    rate_rows = rows.dot(generator)
    acceleration_rows = rate_rows.dot(generator)
    return {
        "offsets": offsets,
        "rows": rows,
        "rate_rows": rate_rows,
        "acceleration_rows": acceleration_rows,
        "jerk_rows": acceleration_rows.dot(generator),
    }


@cache
def _flight_fields(modes: int, stations: int) -> tuple[tuple[str, np.dtype, tuple[int, ...]], ...]:
    """Fields of what the search of a flight needs to know."""
    of_both = ("rows", "rate_rows", "acceleration_rows", "jerk_rows")
    return (
        ("exponents", COMPLEX, (modes,)),
        ("driven", np.dtype(np.int8), (modes,)),
        ("gaps", COMPLEX, (modes,)),
        ("inverse_gaps", COMPLEX, (modes,)),
        ("largest_response", REAL, (modes,)),
        ("offsets", COMPLEX, (stations,)),
        *((name, COMPLEX, (stations, modes)) for name in of_both),
    )


@cache
def _flight_layout(modes: int, stations: int) -> np.dtype:
    return layout_of((*_flight_fields(modes, stations), ("shaft", np.dtype(np.int64), (0,))))


@cache
def _rotor_layout(modes: int, stations: int, shafts: int, limits: int, anisotropic: int, gaps: int) -> np.dtype:
    return layout_of(
        (
            *_flight_fields(modes, stations),
            ("columns", COMPLEX, (modes, stations)),
            ("mobility", COMPLEX, (stations, stations)),
            ("weights", REAL, (stations,)),
            *((name, REAL, (stations,)) for name in ("friction", "restitution", "surface_speed")),
            ("law", np.dtype(np.int64), (stations,)),
            *(
                (name, REAL, (stations,))
                for name in ("law_number", "stiffness", "loss", "farthest", "race_gain", "masses")
            ),
            ("race", np.dtype(np.int64), (stations,)),
            ("free", np.dtype(np.int8), (modes,)),
            ("shaft", np.dtype(np.int64), (shafts,)),
            *((name, COMPLEX, (shafts * modes,)) for name in ("unbalance", "response")),
            ("unbalance_rows", COMPLEX, (shafts * stations,)),
            ("shaft_gain", REAL, (shafts * stations,)),
            ("drive", REAL, (shafts,)),
            ("limit_rows", COMPLEX, (limits, modes)),
            ("limit_offsets", COMPLEX, (limits,)),
            ("limit_bounds", REAL, (limits,)),
            ("limit_columns", COMPLEX, (modes, limits)),
            ("limit_couplings", COMPLEX, (limits, limits)),
            ("limit_pulls", COMPLEX, (stations, limits)),
            ("anisotropy", np.dtype(np.int64), (anisotropic,)),
            ("conjugate_columns", COMPLEX, (modes, anisotropic * stations)),
            ("limit_conjugates", COMPLEX, (modes, anisotropic * limits)),
            ("gap_rows", COMPLEX, (gaps, modes)),
            ("gap_offsets", COMPLEX, (gaps,)),
            ("reach", _flight_layout(modes, limits), ()),
        )
    )


def _largest_response(exponents: list[complex], gaps: list[complex]) -> list[float]:
    """Bound of a pair's ``|φ(t)|`` for all later time: it is at most ``t e^{−xt} ≤ 1/(ex)`` and at most ``2/|gap|``."""
    bounds = []
    for exponent, gap in zip(exponents, gaps, strict=True):
        slow = -1.0 / (math.e * exponent.real) if exponent.real < 0.0 else math.inf
        apart = 2.0 / abs(gap) if gap != 0.0 else math.inf
        bounds.append(min(slow, apart) if exponent.real <= 0.0 else math.inf)
    return bounds


def workspace(modes: int) -> np.record:
    """Scratch arrays of a kernel call for this number of modes; no value is kept from one call to the next."""
    return blank(_workspace_layout(modes))


@cache
def _workspace_layout(modes: int) -> np.dtype:
    vectors = ("current", "end", "departure", "nearest", "increments", "at_node", "amplitudes")
    return layout_of(
        (
            *((name, COMPLEX, (modes,)) for name in vectors),
            ("products", REAL, (2 * modes + modes**2,)),
            ("polynomial", REAL, (DEGREE,)),
        )
    )


def rub_workspace(modes: int, stations: int = 1, limits: int = 0) -> np.record:
    """Scratch arrays of contact: Taylor coefficients at the contact stations and of limits, impulses of joint impacts, states of contact."""
    return blank(_rub_workspace_layout(modes, stations, limits))


@cache
def _rub_workspace_layout(modes: int, stations: int, limits: int) -> np.dtype:
    return layout_of(
        (
            ("series", COMPLEX, (ORDER + 1, modes)),
            *((name, COMPLEX, (stations, ORDER + 1)) for name in ("position", "speed", "free", "force")),
            *((name, COMPLEX, (stations, ORDER + 1)) for name in ("normal", "pressed")),
            *((name, REAL, (stations, ORDER + 1)) for name in ("push", "slip", "grip")),
            *((name, REAL, (stations, ORDER + 1)) for name in ("rate", "power", "turning")),
            ("depth", REAL, (stations, ORDER + 2)),
            ("eccentricity", COMPLEX, (stations, ORDER + 1)),
            *((name, COMPLEX, (ORDER + 1,)) for name in ("sweep", "whirl", "euler")),
            ("braking", REAL, (ORDER + 1,)),
            *((name, REAL, (ORDER + 1,)) for name in ("first_margin", "second_margin")),
            ("links", COMPLEX, (stations, stations, ORDER + 1)),
            ("matrix", REAL, (2 * stations, 2 * stations + 1)),
            ("couplings", COMPLEX, (stations, stations)),
            *(
                (name, COMPLEX, (stations,))
                for name in ("approaches", "local", "impulses", "compression", "tried", "tried_after", "levers")
            ),
            *((name, REAL, (stations,)) for name in ("aims", "least")),
            ("joined", np.dtype(np.int8), (stations,)),
            ("contact", np.dtype(np.int64), (stations,)),
            *((name, COMPLEX, (limits, ORDER + 1)) for name in ("asked", "turned", "beyond", "excess")),
            ("turn", COMPLEX, (ORDER + 1,)),
            ("clock", REAL, ()),
            ("limited", np.dtype(np.int64), (2 * limits,)),
            ("reached", np.dtype(np.int64), (limits,)),
        )
    )
