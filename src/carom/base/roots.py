"""Root of a function of one argument between two values of opposite sign, and the search for such values."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from carom.base.outcome import CaromError

HALVINGS = 30
"""Default number of halvings."""


def bracketed_root(function: Callable[[float], float], low: float, high: float, tolerance: float = 0.0) -> float:
    """Root between two arguments with values of opposite sign, by the Illinois variant of the secant method.

    Parameters
    ----------
    function : callable
    tolerance : float
        Width of the bracket at which to stop, in addition to rounding.

    Raises
    ------
    CaromError
        The values have the same sign, or one in between is ``nan``.
    """
    below, above = function(low), function(high)
    if below == 0.0:
        return low
    if above == 0.0:
        return high
    if not below * above < 0.0:
        raise CaromError(f"no sign change between {low:g} and {high:g}")
    for attempt in range(200):
        width = abs(high - low)
        if width <= tolerance + 4e-16 * max(abs(low), abs(high)):
            break
        # Every fourth step halves the bracket, in case the secant steps do not shrink it.
        halve = attempt % 4 == 3
        middle = 0.5 * (low + high) if halve else high - above * (high - low) / (above - below)
        # Next to a root at an end the secant may leave the bracket by a rounding error, to where there may be no value.
        middle = min(max(middle, min(low, high)), max(low, high))
        value = function(middle)
        if value == 0.0:
            return middle
        if not np.isfinite(value):
            raise CaromError(f"the function has no value at {middle:g}")
        if value * above < 0.0:
            low, below = high, above
        elif not halve:
            below *= 0.5
        settled = middle in (low, high)
        high, above = middle, value
        if settled:
            break
    return high if abs(above) < abs(below) else low


def sign_change(
    function: Callable[[float], float], low: float, high: float, halvings: int = HALVINGS
) -> tuple[float, float] | None:
    """Part of an interval at whose ends a function has opposite signs; ``None`` if it has one sign wherever evaluated.

    If a function is ``nan`` at one end, the point is approached at which it begins to be defined: a new maximum of the
    radius, for example, may be born close to the wall.
    """
    below, above = function(low), function(high)
    if math.isnan(below) == math.isnan(above):
        return (low, high) if below * above < 0.0 else None
    undefined, defined, known = (low, high, above) if math.isnan(below) else (high, low, below)
    for _ in range(halvings):
        middle = 0.5 * (undefined + defined)
        value = function(middle)
        if value * known < 0.0:
            return min(middle, defined), max(middle, defined)
        undefined, defined = (middle, defined) if math.isnan(value) else (undefined, middle)
    return None


def narrowed(function: Callable[[float], float], places: Sequence[float]) -> tuple[float, float]:
    """Two neighbours among ascending places between which a function changes sign, or ceases to be defined, as between the ends."""
    first, last = 0, len(places) - 1
    ends = _sign(function(places[first])), _sign(function(places[last]))
    while last - first > 1:
        middle = (first + last) // 2
        sign = _sign(function(places[middle]))
        if sign not in ends:
            break
        first, last = (middle, last) if sign == ends[0] else (first, middle)
    return places[first], places[last]


def _sign(value: float) -> float | None:
    """Sign of a number; ``None`` if it is ``nan``."""
    return None if math.isnan(value) else math.copysign(1.0, value) if value else 0.0
