"""Limits of the magnetic bearings of a flexible machine, in the units of its model (:mod:`carom.models.limits`).

Without an amplifier the controller asks for the current ``i``, and what is beyond a limit is missing in the force ``−ki i``.  With one of bandwidth ``ω_b``
it asks for ``u``, and the current of the amplifier follows,

    di/dt = ω_b (u − i),

where ``u`` is cut off at the limit of the current and then ``di/dt`` at that of its rate.  The states of controller and amplifier are those of
the loop (:attr:`MagneticBearing.loop`), of which the last one is the amplifier's.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from carom.models import Limit
from carom.parameters import Scales
from carom.rotors.equations import RotorEquations
from carom.rotors.magnetic_bearing import MagneticBearing


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
        place = _LimitPlace(
            pulls[number],
            equations.currents[number],
            equations.current_rates[number],
            -equations.stiffness[last].real,
            last,
        )
        found += [_in_units(limit, scales) for limit in _in_si(bearing, place, len(found))]
    return tuple(found)


def asked_by_currents(bearings: Sequence[MagneticBearing], currents: np.ndarray) -> np.ndarray:
    """What constant currents (B,), A, ask of each limit of :func:`limits_of_bearings`, shape (L,); nothing of a rate."""
    asked: list[complex] = []
    for bearing, current in zip(bearings, currents.tolist(), strict=True):
        none = np.zeros(1)
        place = _LimitPlace(none, np.ones(1), none, none, 0)
        asked += [current * limit.displacement[0] for limit in _in_si(bearing, place, 0)]
    return np.array(asked, complex)


def _in_si(bearing: MagneticBearing, place: _LimitPlace, before: int) -> Iterator[Limit]:
    """Limits of a bearing after so many of others, for coordinates in m √kg."""
    none = np.zeros(len(place.current))
    of_force = np.inf if bearing.force_limit is None else bearing.force_limit / bearing.ki
    of_current = np.inf if bearing.current_limit is None else bearing.current_limit
    push = bearing.ki * place.pulls
    if bearing.amplifier_bandwidth is None:
        if min(of_force, of_current) < np.inf:
            yield Limit(min(of_force, of_current), place.current, place.current_rate, push, angle=bearing.axis_angle)
        return
    bandwidth, out = bearing.amplifier_bandwidth, float(place.current[place.last])
    state = np.eye(len(none))[place.last] / out
    changing, follows = out * place.rate, (0.0,) * before
    # Behind an ideal derivative the current has a part of the displacement beside the last state.
    moving = place.current_rate + place.current - out * np.eye(len(none))[place.last]
    if of_current < np.inf:
        asked = place.current + changing / bandwidth
        yield Limit(of_current, asked, moving / bandwidth, none, -bandwidth * state, bearing.axis_angle)
        follows = (*follows, -bandwidth)
    if bearing.slew_rate_limit is not None:
        yield Limit(bearing.slew_rate_limit, changing, moving, none, -state, bearing.axis_angle, follows)
    if of_force < of_current:
        yield Limit(of_force, place.current, none, push, angle=bearing.axis_angle)


def _in_units(limit: Limit, scales: Scales) -> Limit:
    """The same for the coordinates and the time of the model."""
    unit = scales.length * np.sqrt(scales.mass)
    return Limit(
        limit.bound,
        limit.displacement * unit,
        limit.velocity * unit * scales.speed,
        limit.accelerations / (unit * scales.speed**2),
        np.asarray(limit.rates) / (unit * scales.speed),
        limit.angle,
        limit.follows,
    )
