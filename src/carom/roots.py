"""Root of a function of one argument between two values of opposite sign."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom.outcome import CaromError

__all__ = ["bracketed_root"]


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
