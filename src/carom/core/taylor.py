"""Taylor series in time: the length of a step, sums, and the first zero of a polynomial.

Nothing here knows what moves: :mod:`carom.core.contact_series` writes the coefficients.
"""

from __future__ import annotations

import math

from carom.core.compiling.decorators import inlined, kernel
from carom.core.layout import ORDER

STEP_FRACTION = 0.135
"""Ratio of step to radius of convergence: ``0.135^ORDER`` is below rounding."""
NEWTON_STEPS = 8
"""Far more steps than needed for a zero that is not blurred by rounding."""


@kernel
def series_step(work):
    """Step with a truncation error below rounding, from the last two coefficients (Jorba and Zou 2005); zero if they are not finite."""
    modes = work.series.shape[1]
    start, last, before, total = 0.0, 0.0, 0.0, 0.0
    for m in range(modes):
        first, end, beside = work.series[0, m], work.series[ORDER, m], work.series[ORDER - 1, m]
        total += abs(end.real) + abs(end.imag) + abs(beside.real) + abs(beside.imag)
        start, last, before = _larger(start, first), _larger(last, end), _larger(before, beside)
    if not total < math.inf:
        return 0.0
    return _step(max(start, 1.0), last, before)


@inlined
def _larger(size, number):
    """The larger of a size and a modulus, whose root is taken only where it may be the larger one."""
    return max(size, abs(number)) if abs(number.real) + abs(number.imag) > size else size


@kernel
def margin_step(margin):
    """The same for a margin of size one or less."""
    return _step(1.0, abs(margin[ORDER]), abs(margin[ORDER - 1]))


@inlined
def _step(scale, last, before):
    """Step from the size of what moves and of its last two coefficients."""
    radius = math.inf
    if last > 0.0:
        radius = (scale / last) ** (1.0 / ORDER)
    if before > 0.0:
        radius = min(radius, (scale / before) ** (1.0 / (ORDER - 1)))
    return min(STEP_FRACTION * radius, 1.0)


@kernel
def sum_series(work, time, amplitudes):
    """Amplitudes at a time within the step."""
    for m in range(amplitudes.shape[0]):
        amplitudes[m] = work.series[ORDER, m]
    for k in range(ORDER - 1, -1, -1):  # of one order all modes: their sums do not wait for one another
        for m in range(amplitudes.shape[0]):
            total, part = amplitudes[m], work.series[k, m]
            amplitudes[m] = complex(total.real * time + part.real, total.imag * time + part.imag)


@kernel
def first_fall(margin, step, rounding):
    """Time within a step at which a polynomial margin falls through zero, or the step; certified for the polynomial.

    That is the last zero before it first falls below minus its rounding error; zero if it is negative up to there.
    """
    reach, curvature = 0.0, 0.0
    power = 1.0
    for k in range(1, ORDER + 1):
        power *= step
        reach += abs(margin[k]) * power
        curvature += k * (k - 1) * abs(margin[k]) * power
    if margin[0] + rounding > reach:
        return step
    curvature /= step * step
    time, value, slope = 0.0, margin[0], margin[1]
    while value > -rounding:
        height = value + rounding
        root = math.sqrt(slope * slope + 2.0 * curvature * height)
        if slope <= 0.0:
            advance = 2.0 * height / (root - slope) if root > slope else step
        else:
            advance = (root + slope) / curvature if curvature > 0.0 else step
        if time + advance >= step:
            return step
        if time + advance <= time * (1.0 + 4e-16):
            break
        time += advance
        value, slope = _value_and_slope(margin, time)
    return _zero_before(margin, time)


@kernel
def _zero_before(margin, time):
    """Last zero of a margin before a time at which it is below minus its rounding error, or 0."""
    latest = time
    for _ in range(NEWTON_STEPS):
        value, slope = _value_and_slope(margin, time)
        if slope >= 0.0:
            return time
        before = time
        time = min(max(time - value / slope, 0.0), latest)
        if abs(time - before) <= 2e-16 * time:
            break
    return time


@kernel
def _value_and_slope(margin, time):
    value, slope = margin[ORDER], 0.0
    for k in range(ORDER - 1, -1, -1):
        slope = slope * time + value
        value = value * time + margin[k]
    return value, slope
