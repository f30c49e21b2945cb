"""Candidates for the first crossing that were not taken, to be measured beside the one that was.

A flight of the planar rotor is ``y(t) = K + c₁e^{λ₁t} + c₂e^{λ₂t}``, its modes do not grow and ``f = |y|² − 1`` is what
must not pass zero.  ``on_wall`` says that ``f`` is zero at the start by definition.  Both candidates return the time of
the first crossing, or the horizon where there is none before it.
"""

from __future__ import annotations

import cmath
import math

import numba
import numpy as np

CLOSE = 1e-8
"""Height below the wall, in units of ``f'²/M₂``, from where a Newton step is exact to rounding."""
STEP = 0.5
"""Length of the fixed steps."""


@numba.njit(inline="always")
def square(z):
    return z.real * z.real + z.imag * z.imag


@numba.njit(inline="always")
def measure(rest, first, second, a, b):
    """``f`` and its first three derivatives, from the two terms of the motion at this time."""
    y = rest + a + b
    v = first * a + second * b
    w = first * first * a + second * second * b
    x = first * first * first * a + second * second * second * b
    y = y.conjugate()
    return (
        square(y) - 1.0,
        2.0 * (y * v).real,
        2.0 * (square(v) + (y * w).real),
        2.0 * (3.0 * (v.conjugate() * w).real + (y * x).real),
    )


@numba.njit(inline="always")
def curvature(first, second, a, b):
    """Bound of ``|f''|`` for all later time inside: ``2(|ẏ|² + |ÿ|)`` from the moduli of the terms."""
    p, q = square(first), square(second)
    size = square(a) + square(b)
    return 2.0 * ((p + q) * size + math.sqrt((p * p + q * q) * size))


@numba.njit
def safe_steps(rest, first, second, a, b, on_wall, horizon):
    """Steps that the bound of the second derivative proves free: ``f(t + τ) ≤ f + f'τ + M₂τ²/2``."""
    time = 0.0
    height, slope, _, _ = measure(rest, first, second, a, b)
    if on_wall:
        height = 0.0
    start, other = a, b
    while time < horizon:
        bound = curvature(first, second, a, b)
        if time > 0.0 and slope > 0.0 and -height * bound <= CLOSE * slope * slope:
            return min(time - height / slope, horizon)
        root = math.sqrt(max(slope * slope - 2.0 * bound * height, 0.0))
        time += (root - slope) / bound if slope <= 0.0 else -2.0 * height / (root + slope)
        a, b = start * cmath.exp(first * time), other * cmath.exp(second * time)
        height, slope, _, _ = measure(rest, first, second, a, b)
    return horizon


@numba.njit
def polish(rest, first, second, a, b, time):
    """Householder steps to a root on the exact flight: its time and the slope there."""
    slope = 0.0
    for _ in range(6):
        c, d = a * cmath.exp(first * time), b * cmath.exp(second * time)
        height, slope, bend, third = measure(rest, first, second, c, d)
        steep, skew = slope * slope, height * bend
        step = -height * (steep - 0.5 * skew) / (slope * (steep - skew) + height * height * third / 6.0)
        time += step
        if abs(step) < 1e-4 * slope / curvature(first, second, a, b):
            return time, slope
    return np.nan, slope


@numba.njit
def fixed_steps(rest, first, second, a, b, on_wall, horizon):
    """Fixed steps by recurrence; on each the cubic of Hermite as a quartic in Bernstein form, with its error on top.

    That error is at most ``M₄τ²(h − τ)²/24``, which is ``M₄h⁴/144`` times the middle Bernstein polynomial.
    """
    turn, other_turn = cmath.exp(first * STEP), cmath.exp(second * STEP)
    p, q, cross = square(first), square(second), square(first + second.conjugate())
    sizes = math.sqrt(square(a)), math.sqrt(square(b))
    fourth = 2.0 * (
        math.sqrt(square(rest)) * (p * p * sizes[0] + q * q * sizes[1]) + cross * cross * sizes[0] * sizes[1]
    )
    fourth += 16.0 * (first.real**4 * sizes[0] ** 2 + second.real**4 * sizes[1] ** 2)
    excess = fourth * STEP**4 / 144.0
    height, slope, _, _ = measure(rest, first, second, a, b)
    if on_wall:
        height = 0.0
    time = 0.0
    while time < horizon:
        c, d = a * turn, b * other_turn
        end, end_slope, _, _ = measure(rest, first, second, c, d)
        early = height + 0.25 * STEP * slope
        late = end - 0.25 * STEP * end_slope
        middle = 0.5 * (height + end + STEP / 3.0 * (slope - end_slope)) + excess
        if not (early < 0.0 and middle < 0.0 and late < 0.0 and end < 0.0):
            if end > 0.0 and early < 0.0 and (middle < 0.0 or late >= 0.0):
                # The error of the cubic is largest in the middle of the step: M₄h⁴/384.
                least = 4.4 * 144.0 / 384.0 * excess * curvature(first, second, a, b)
                root, steepness = polish(rest, first, second, a, b, STEP * height / (height - end) if height else STEP)
                if 0.0 < root <= STEP and steepness > 0.0 and steepness * steepness > least:
                    return min(time + root, horizon)
            found = safe_steps(rest, first, second, a, b, on_wall and time == 0.0, STEP)
            if found < STEP:
                return min(time + found, horizon)
        a, b, height, slope = c, d, end, end_slope
        time += STEP
    return horizon
