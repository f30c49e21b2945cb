"""Whether a flight stays inside the wall between two impacts: branch and bound over its time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from flint import arb, arb_series

from carom.proofs.series import hull, terms

Height = Callable[[Any, bool], Any]
"""A height over the wall, up to a positive factor: takes the time after the first impact, or with ``True`` the negative time before
the second, as a ball or a power series."""
_ORDER = 4
"""Order of Taylor's formula on a cell of times."""
NARROWEST, FINEST = 1e-4, 1e-11
"""Width of a cell, as a share of half the flight, at which the search gives up: on blocks, and for one machine.

Next to a maximum at a small depth below the wall the cells become as narrow as the root of the depth.
"""
_SAMPLES = 16


def stays_inside(
    height: Height,
    narrow: Height,
    period: arb,
    falls: tuple[arb, arb],
    touch: arb | None = None,
    narrowest: float = NARROWEST,
) -> bool | None:
    """Whether a height that vanishes at both impacts is negative in between; ``None`` if this is open.

    ``height`` gives balls for balls, ``narrow`` narrower ones for exact times.  ``falls`` are the rates, not negative, at which
    the height falls from zero at the first impact and, backward in time, at the second.  At the time ``touch``, if given, it is
    allowed to vanish with its rate.
    """
    half = 0.5 * float(period.mid())
    times = [half * 2 * k / _SAMPLES for k in range(1, _SAMPLES)]
    top, at = max((float(height(arb(time), False).mid()), time) for time in times)
    at = _peak(height, at, float(period.mid()))
    if top > 0 or height(arb(at), False).mid() > 0:
        return False if narrow(arb(at), False) > 0 and at < period else None
    for backward, end in ((False, half), (True, float((period - half).upper()) * (1 + 1e-15))):
        touched = period - touch if touch is not None and backward else touch
        stack = [(end * k / 3, end * (k + 1) / 3) for k in range(3)]
        while stack:
            low, high = stack.pop()
            if _below(height, narrow, falls[backward], (low, high), backward):
                continue
            if touched is not None and _touches(height, (low, high), backward, touched):
                continue
            if not high - low > narrowest * end:
                return None
            middle = 0.5 * (low + high)
            stack += [(middle, high), (low, middle)]
    return True


def _peak(height: Height, near: float, period: float) -> float:
    """Time of a maximum of the height next to a time, by Newton's method; that time itself if there is none."""
    time = near
    with terms(3):
        for _ in range(6):
            series = height(arb_series([arb(time), 1]), False)
            slope, curve = float(series[1].mid()), 2 * float(series[2].mid())
            time -= slope / curve if curve < 0.0 else period
            if not 0.0 < time < period:
                return near
    return time


def _touches(height: Height, cell: tuple[float, float], backward: bool, touch: arb) -> bool:
    """Whether the height is concave from a cell of times to a time at which it vanishes with its rate."""
    time = hull(hull(*cell), touch)
    if not time.rad() < 0.5:
        return False
    with terms(3):
        return bool(height(arb_series([-time if backward else time, 1]), backward)[2] < 0)


def _below(height: Height, narrow: Height, fall: arb, cell: tuple[float, float], backward: bool) -> bool:
    """Whether the height is negative on a cell of times; at time zero itself it vanishes."""
    low, high = cell
    sign = -1 if backward else 1
    time = hull(low, high)
    middle = time.mid()
    late = (time - middle) * sign
    with terms(_ORDER + 1):
        far = height(arb_series([time * sign, 1]), backward)
    if low == 0.0:
        # The height is what it falls, and at most the curvature times t² more.
        return bool(far[2] < 0 or far[2] * high < fall)
    if far[0] < 0:
        return True
    with terms(_ORDER):
        near = height(arb_series([middle * sign, 1]), backward)
    value = far[_ORDER]
    for k in range(_ORDER - 1, 0, -1):
        value = near[k] + value * late
    return bool(narrow(middle * sign, backward) + value * late < 0)
