"""Limits of the magnetic bearings of a flexible machine, in the units of its model (:mod:`carom.models.limits`).

Without an amplifier the controller asks for the current ``i``, and what is beyond a limit is missing in the force ``−ki i``.  With one of bandwidth ``ω_b``
it asks for ``u``, and the current of the amplifier follows,

    di/dt = ω_b (u − i),

where ``u`` is cut off at the limit of the current and then ``di/dt`` at that of its rate.  The states of controller and amplifier are those of
the loop (:attr:`MagneticBearing.loop`), of which the last one is the amplifier's.  Where both axes of a bearing differ, each has limits of its own.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from carom.base.outcome import InputError
from carom.models import Limit
from carom.parameters import Scales
from carom.rotors.equations import RotorEquations
from carom.rotors.magnetic_bearing import MagneticBearing

_LIMITS = ("force_limit", "current_limit", "slew_rate_limit")


class _LimitPlace(NamedTuple):
    """Where a bearing is in the equations."""

    pulls: np.ndarray
    """Displacement at it per coordinate, shape (n,)."""
    current: np.ndarray
    """Its current, A, per coordinate, shape (n,)."""
    current_rate: np.ndarray
    """Its current per rate of a coordinate, shape (n,)."""
    rate: np.ndarray
    """Rate of the last state of its loop per coordinate, shape (n,)."""
    last: int
    """Coordinate of that state."""
    axis: complex = 1.0
    """Factor whose real part makes of that coordinate the state of one axis: 1 or −i."""
    one_axis: bool = False


def limits_of_bearings(
    equations: RotorEquations, bearings: tuple[MagneticBearing, ...], pulls: np.ndarray, scales: Scales
) -> tuple[Limit, ...]:
    """All limits that are stated.

    Parameters
    ----------
    pulls : ndarray, shape (B, n)
        Displacement at each bearing per coordinate.
    scales : Scales
        Units of the model.
    """
    found: list[Limit] = []
    for number, bearing in enumerate(bearings):
        last = int(equations.amplifiers[number])
        by_place, by_rate = equations.currents_across[:, number]
        for part, axis in _axes(equations, number, bearing):
            turn = 1.0 if axis is None else axis * np.exp(-1j * bearing.axis_angle)
            current, current_rate, rate = (
                own if axis is None else factor * own + np.conj(factor * across)
                for factor, own, across in (
                    (turn, equations.currents[number], by_place),
                    (turn, equations.current_rates[number], by_rate),
                    (axis or 1.0, -equations.stiffness[last], -equations.across[1, last]),
                )
            )
            pull, alone = pulls[number] * np.conj(turn), axis is not None
            place = _LimitPlace(pull, current, current_rate, rate, last, axis or 1.0, alone)
            found += [_in_units(limit, scales) for limit in _in_si(part, place, len(found))]
    return tuple(found)


def _axes(
    equations: RotorEquations, number: int, bearing: MagneticBearing
) -> list[tuple[MagneticBearing, complex | None]]:
    """Axes of a bearing whose limits are apart, each with a factor whose real part makes of a displacement along the first one that along it; ``None`` for both at once."""
    if equations.currents_across[:, number].any() or (bearing.y is not None and equations.is_anisotropic):
        return list(zip(bearing.axes, (1.0, -1j), strict=True))
    one, other = ([getattr(axis, name) for name in _LIMITS] for axis in bearing.axes)
    if one != other:
        allowed = f"limits as along the first axis, {', '.join(map(str, one))}, unless something else of the axes differs too, such as gain_factor"
        raise InputError(f"[[magnetic_bearing]] {number + 1}: y", ", ".join(map(str, other)), allowed)
    return [(bearing, None)]


def asked_by_currents(
    equations: RotorEquations, bearings: Sequence[MagneticBearing], currents: np.ndarray
) -> np.ndarray:
    """What constant currents (B,), A, ask of each limit of :func:`limits_of_bearings`, shape (L,); nothing of a rate."""
    asked: list[complex] = []
    for number, bearing in enumerate(bearings):
        for part, axis in _axes(equations, number, bearing):
            current, none = complex(currents[number]), np.zeros(1)
            if axis is not None:
                current = (axis * np.exp(-1j * bearing.axis_angle) * current).real
            place = _LimitPlace(none, np.ones(1), none, none, 0)
            asked += [current * limit.displacement[0] for limit in _in_si(part, place, 0)]
    return np.array(asked, complex)


def limited_currents(bearings: Sequence[MagneticBearing], currents: np.ndarray, constant: np.ndarray) -> np.ndarray:
    """What limits leave of control currents (n, B), A, beside constant ones (B,); the current of an amplifier is a state, which its limits keep."""
    found = currents.copy()
    for number, bearing in enumerate(bearings):
        bounds = [np.inf if each.amplifier_bandwidth else each.current_limit or np.inf for each in bearing.axes]
        if min(bounds) < np.inf:
            turn = np.exp(1j * bearing.axis_angle)
            whole = (currents[:, number] + constant[number]) / turn
            kept = [np.clip(each, -bound, bound) for each, bound in zip((whole.real, whole.imag), bounds, strict=True)]
            found[:, number] = turn * (kept[0] + 1j * kept[1]) - constant[number]
    return found


def _in_si(bearing: MagneticBearing, place: _LimitPlace, before: int) -> Iterator[Limit]:
    """Limits of a bearing after so many of others, for coordinates in m √kg."""
    none = np.zeros(len(place.current))
    of_force = np.inf if bearing.force_limit is None else bearing.force_limit / bearing.ki
    of_current = np.inf if bearing.current_limit is None else bearing.current_limit
    push = bearing.ki * place.pulls
    limit = partial(Limit, angle=0.0 if place.one_axis else bearing.axis_angle, one_axis=place.one_axis)
    if bearing.amplifier_bandwidth is None:
        if min(of_force, of_current) < np.inf:
            yield limit(min(of_force, of_current), place.current, place.current_rate, push)
        return
    bandwidth, own = bearing.amplifier_bandwidth, np.eye(len(none))[place.last]
    out = place.current[place.last] / place.axis
    out = out.real if place.one_axis else out
    state = own * np.conj(place.axis) / out
    changing, follows = out * place.rate, (0.0,) * before
    # Behind an ideal derivative the current has a part of the displacement beside the last state.
    moving = place.current_rate + place.current * (1.0 - own)
    if of_current < np.inf:
        asked = place.current + changing / bandwidth
        yield limit(of_current, asked, moving / bandwidth, none, -bandwidth * state)
        follows = (*follows, -bandwidth)
    if bearing.slew_rate_limit is not None:
        yield limit(bearing.slew_rate_limit, changing, moving, none, -state, follows=follows)
    if of_force < of_current:
        yield limit(of_force, place.current, none, push)


def _in_units(limit: Limit, scales: Scales) -> Limit:
    """The same for the coordinates and the time of the model."""
    unit = scales.length * np.sqrt(scales.mass)
    return replace(
        limit,
        displacement=limit.displacement * unit,
        velocity=limit.velocity * unit * scales.speed,
        accelerations=limit.accelerations / (unit * scales.speed**2),
        rates=np.asarray(limit.rates) / (unit * scales.speed),
    )
