"""Root of a function of one argument between two values of opposite sign, and where there are such values."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from carom.outcome import CaromError

__all__ = ["bracketed_root", "sign_change"]

HALVINGS = 30
"""Halvings of an interval after which a function has one sign wherever it is defined."""


def bracketed_root(function: Callable[[float], float], low: float, high: float, tolerance: float = 0.0) -> float:
    """Root between two arguments with values of opposite sign, by the Illinois variant of the secant method.

    Parameters
    ----------
    function : callable
    low, high : float
    tolerance : float
        Width at which to stop, besides rounding.

    Returns
    -------
    float

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
        # Where the secant does not close in, halve.
        halve = attempt % 4 == 3
        middle = 0.5 * (low + high) if halve else high - above * (high - low) / (above - below)
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


def sign_change(function: Callable[[float], float], low: float, high: float) -> tuple[float, float] | None:
    """Part of an interval at whose ends a function has opposite signs.

    A function that is ``nan`` at one end is looked at next to where it begins to be defined: a new maximum of the radius,
    for one, may be born close to the wall.

    Parameters
    ----------
    function : callable
    low, high : float

    Returns
    -------
    tuple of float or None
        ``None`` if the function has one sign at both ends, or wherever it was looked at.
    """
    below, above = function(low), function(high)
    if math.isnan(below) == math.isnan(above):
        return (low, high) if below * above < 0.0 else None
    undefined, defined, known = (low, high, above) if math.isnan(below) else (high, low, below)
    for _ in range(HALVINGS):
        middle = 0.5 * (undefined + defined)
        value = function(middle)
        if value * known < 0.0:
            return min(middle, defined), max(middle, defined)
        undefined, defined = (middle, defined) if math.isnan(value) else (undefined, middle)
    return None
