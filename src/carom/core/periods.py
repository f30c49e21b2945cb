"""All periods of single-impact orbits: the roots of ``F₁(T) = 1 + Re(q a₂₂(T))``.

For one contact station with row ``W``, column ``B`` and flight ``ċ = Mc`` let, in the source paper's notation (4.1),

    a₁₂(T) = W (e^{−MT} − 1)⁻¹ B,     a₂₂(T) = W M (e^{−MT} − 1)⁻¹ B.

With ``g(z) = 1/(e^{−z} − 1)`` these are sums over the modes of ``λⁿ g(λT)`` times a residue; for a driven pair a divided
difference over ``λ`` replaces the value.  Because an impulse does not change the position at once (``WB = 0``) the poles
of ``a₂₂`` at ``T = 0`` cancel, so the regular part ``g̃(z) = g(z) + 1/z`` may replace ``g`` there.

Completeness rests on two bounds.  ``|a₂₂|`` is below a decreasing function of ``T``, so beyond ``longest_period``
there is ``F₁ > 0``.  Up to there, ``g̃(z) = −1/2 − Σ_{k≠0} 1/(z − 2πik)`` gives

    |g̃⁽ⁿ⁾(z)| ≤ 2 n! (δ^{−n−1} + ζ(n+1) (2π)^{−n−1}),      δ = min_{k≠0} |z − 2πik|,

hence a bound of ``|F₁''|`` on any interval, and ``g(z) = Σ e^{mz}`` gives a sharper one at long periods.  Near a pole
the bounds grow at the rate of ``|F₁''|`` itself, so the intervals need only shrink in proportion to the distance from
the pole, unless the pole is one of the imaginary part alone (no damping and no friction).  An interval is discarded, or
accepted as monotone, only when that bound proves it; one on which ``F₁`` cannot be distinguished from zero in double
precision holds a double root, or a single one if ``F₁`` changes sign across it.  So all roots are counted correctly,
down to the last pair.

The kernels take the modes as an array of shape (N, 3): the exponent ``λ_k``, the residue ``W_k B_k`` of a mode by itself,
and the residue ``W_k B_{k−1}`` of the pair of a driven mode and the one before it.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import complex_expm1, squared_modulus

# B₂ₖ/(2k)! with the Bernoulli numbers B₂ₖ: g̃(z) = −1/2 − Σ B₂ₖ z^{2k−1}/(2k)!.
_BERNOULLI = (
    1 / 12, -1 / 720, 1 / 30240, -1 / 1209600, 1 / 47900160, -691 / 1307674368000, 1 / 74724249600,
    -3617 / 10670622842880000, 43867 / 5109094217170944000, -174611 / 802857662698291200000,
)  # fmt: skip
_TERMS = len(_BERNOULLI)
TURN = 2.0 * math.pi
_ZETA3, _ZETA4 = 1.2020569031595943, 1.0823232337111382

ROUNDING = 16 * 2.220446049250313e-16
"""Rounding error of a sum relative to the moduli of its terms."""
MOST_STEPS = 200
"""More than bisection takes to exhaust double precision."""
DEEPEST = 200
"""Halvings of one interval after which the search is given up: more than there are binary digits."""
EMPTY, MONOTONE, UNCERTAIN, UNDECIDED = 0, 1, 2, 3
"""What is known of ``F₁`` on an interval: no root, monotone, not to be distinguished from zero, or not enough."""


@inlined
def _quotient(z, w):
    """``z/w``, infinite where ``w`` is zero: at a pole."""
    return z / w if w != 0.0 else complex(math.inf, 0.0)


@inlined
def propagator(first, second, time):
    """``e^{λ₊t}``, the divided difference of ``e^{λt}``, and ``e^{λ₋t}`` for ``λ₋, λ₊`` = ``first, second``."""
    gap = second - first
    growth = cmath.exp(second * time)
    lag = complex_expm1(-gap * time)
    response = -growth * lag / gap if gap != 0.0 else growth * time
    return growth, response, growth * (1.0 + lag)


@inlined
def returns(first, second, period):
    """``a₁₂``, ``a₂₂`` and ``da₂₂/dT`` of a pair with these exponents, as of the planar rotor (source paper (4.1)).

    They are the divided differences over ``λ`` of ``g(λT)``, ``λ g(λT)`` and ``λ² g'(λT)``.  The first is a product,
    accurate however close the exponents are; the second is a value of ``g`` and a multiple of the first; the third
    follows from ``g' = g(1 + g)``.  At short periods the poles of ``g`` cancel in the last two, which are summed there
    from the Bernoulli series of ``g̃``.

    The fourth result is the size of the error of ``a₂₂``, in rounding errors: the moduli of its terms, and what the rounding
    of ``λT`` does to them.
    """
    # g(z) = −1 − g(−z) avoids growing exponentials.
    grows = first.real + second.real > 0.0
    if grows:
        first, second = -second, -first
    _, response, _ = propagator(first, second, period)
    if squared_modulus(first) < squared_modulus(second):
        first, second = second, first
    z, w = first * period, second * period
    x, y = complex_expm1(z), complex_expm1(w)
    a12 = _quotient(response, x * y)
    if squared_modulus(z) > 1.0:
        # Never from e^{−z}, which overflows at long periods.
        g, h = -_quotient(cmath.exp(z), x), -_quotient(cmath.exp(w), y)
        a22 = g + second * a12
        rate = (first + second) * h * (1.0 + h) + first * first * a12 * (1.0 + g + h)
        size = abs(g) + abs(z * g * (1.0 + g)) + abs(second * a12) * (1.0 + abs(z * g) + abs(w) + abs(w * h))
    else:
        a22, rate = complex(-0.5, 0.0), 0j
        power, difference = second, first + second  # w^{n−1}/T and the divided difference of zⁿ over T, n = 2
        for k in range(_TERMS):
            a22 -= _BERNOULLI[k] * difference * period
            rate -= _BERNOULLI[k] * (2 * k + 1) * difference
            for _ in range(2):
                power *= w
                difference = z * difference + power
        size = 1.0
    if grows:
        a22, rate, size = -1.0 - a22, -rate, 1.0 + size
    return a12, a22, rate, size


@inlined
def _regular(z):
    """``g(z)``, ``g̃(z)`` and ``g̃'(z)``."""
    # Neither form has a growing exponential.
    g = _quotient(1.0, complex_expm1(-z)) if z.real > 0.0 else -_quotient(cmath.exp(z), complex_expm1(z))
    if squared_modulus(z) > 1.0:
        inverse = 1.0 / z
        return g, g + inverse, g * (1.0 + g) - inverse * inverse
    value, slope, square = 0j, 0j, z * z
    for k in range(_TERMS - 1, -1, -1):
        value = value * square - _BERNOULLI[k]
        slope = slope * square - (2 * k + 1) * _BERNOULLI[k]
    return g, value * z - 0.5, slope


@kernel
def flight_return(modes, period):
    """``a₁₂``, ``a₂₂`` and ``da₂₂/dT``, and the size of the error of ``a₂₂`` in rounding errors."""
    a12, a22, rate, size = 0j, 0j, 0j, 0.0
    for k in range(modes.shape[0]):
        exponent, residue, coupling = modes[k, 0], modes[k, 1], modes[k, 2]
        if residue != 0.0:
            g, value, slope = _regular(exponent * period)
            value, slope = residue * exponent * value, residue * exponent * exponent * slope
            a12 += residue * g
            a22 += value
            rate += slope
            size += abs(value) + period * abs(slope)
        if coupling != 0.0:
            g, value, slope, error = returns(modes[k - 1, 0], exponent, period)
            a12 += coupling * g
            a22 += coupling * value
            rate += coupling * slope
            size += abs(coupling) * error
    return a12, a22, rate, size


@kernel
def _measure(modes, factor, period):
    """``F₁``, its slope, and the possible rounding error of ``F₁``."""
    _, a22, rate, size = flight_return(modes, period)
    return 1.0 + (factor * a22).real, (factor * rate).real, ROUNDING * (1.0 + abs(factor) * size)


@kernel
def _bounds(exponent, middle, half, wander):
    """Bounds of ``|g̃⁽ⁿ⁾|`` and ``|g⁽ⁿ⁾|`` at ``λT`` for periods on an interval, for ``n = 2`` and then ``n = 3``.

    They hold within a distance ``wander`` of ``λT``, in directions in which ``|Re z|`` does not become smaller.
    """
    z = exponent * middle
    turns = math.floor(z.imag / TURN + 0.5)
    if turns == 0.0:
        turns = 1.0 if z.imag >= 0.0 else -1.0
    distance = abs(complex(z.real, z.imag - TURN * turns)) - abs(exponent) * half - wander
    second, third, far_second, far_third = math.inf, math.inf, math.inf, math.inf
    if distance > 0.0:
        inverse = 1.0 / distance
        cube = inverse * inverse * inverse
        second, third = 4.0 * (cube + _ZETA3 / TURN**3), 12.0 * (cube * inverse + _ZETA4 / TURN**4)
    decay = abs(exponent.real) * (middle - half)
    if decay > 0.0:
        ratio, rest = math.exp(-decay), -math.expm1(-decay)
        cube = rest * rest * rest
        far_second = ratio * (1.0 + ratio) / cube
        far_third = ratio * (1.0 + 4.0 * ratio + ratio * ratio) / (cube * rest)
    return second, far_second, third, far_third


@kernel
def _pair_bounds(driven, driving, middle, half):
    """Bounds of the modulus of a pair's divided difference of ``λ³ g''(λT)``, from ``g̃`` and from ``g``."""
    size, other, gap, longest = abs(driven), abs(driving), abs(driven - driving), middle + half
    near, far = math.inf, math.inf
    if gap > 0.0:
        first, far_first, _, _ = _bounds(driven, middle, half, 0.0)
        second, far_second, _, _ = _bounds(driving, middle, half, 0.0)
        near = (size**3 * first + other**3 * second) / gap
        far = (size**3 * far_first + other**3 * far_second) / gap
    if gap * longest < 1.0:
        # The pair lies within gap·T of its slower exponent: the driven one, or the driving one where both grow.
        size, slower = max(size, other), driving if driving.real > 0.0 else driven
        second, far_second, third, far_third = _bounds(slower, middle, half, gap * longest)
        near = min(near, size * size * (3.0 * second + size * longest * third))
        if driven.real * driving.real > 0.0:
            far = min(far, size * size * (3.0 * far_second + size * longest * far_third))
    return near, far


@kernel
def curvature_bound(modes, factor, middle, half):
    """Bound of ``|F₁''|`` on an interval, the smaller of a bound from ``g̃`` and one from ``g``.

    The second, ``|g⁽ⁿ⁾(z)| ≤ Σ mⁿ e^{−m|Re z|}``, decays at long periods: for modes that grow too, by ``g(z) = −1 − g(−z)``.
    """
    near, far = 0.0, 0.0
    for k in range(modes.shape[0]):
        exponent, residue, coupling = modes[k, 0], abs(modes[k, 1]), abs(modes[k, 2])
        if residue != 0.0:
            second, far_second, _, _ = _bounds(exponent, middle, half, 0.0)
            near += residue * abs(exponent) ** 3 * second
            far += residue * abs(exponent) ** 3 * far_second
        if coupling != 0.0:
            second, far_second = _pair_bounds(exponent, modes[k - 1, 0], middle, half)
            near += coupling * second
            far += coupling * far_second
    return abs(factor) * min(near, far)


@inlined
def _decay_bound(modes, factor, period):
    """Bound of ``|q a₂₂|`` that decreases with the period, from ``|g(z)| ≤ 1/(e^{−Re z} − 1)``."""
    total, driving = 0.0, 0.0
    for k in range(modes.shape[0]):
        size, decay = abs(modes[k, 0]), modes[k, 0].real * period
        slow = -math.exp(decay) / math.expm1(decay)
        total += abs(modes[k, 1]) * size * slow
        if modes[k, 2] != 0.0:
            gap, largest = abs(modes[k, 0] - modes[k - 1, 0]), max(size, abs(modes[k - 1, 0]))
            bound = slow + largest * period * slow * (1.0 + slow)
            if gap > 0.0:
                bound = min(bound, (size * slow + driving) / gap)
            total += abs(modes[k, 2]) * bound
        driving = size * slow
    return abs(factor) * total


@kernel
def longest_period(modes, factor):
    """Time beyond which ``|q a₂₂| < 1``, hence ``F₁ > 0``; infinite without damping."""
    for k in range(modes.shape[0]):
        if modes[k, 0].real >= 0.0:
            return math.inf
    low, high = 0.0, 1.0
    while _decay_bound(modes, factor, high) >= 1.0:
        low, high = high, 2.0 * high
    while high - low > 1e-2 * high:
        middle = 0.5 * (low + high)
        if _decay_bound(modes, factor, middle) >= 1.0:
            low = middle
        else:
            high = middle
    return high


@kernel
def _judge(modes, factor, left, right):
    """What is known of ``F₁`` on an interval."""
    middle, half = 0.5 * (left + right), 0.5 * (right - left)
    value, slope, noise = _measure(modes, factor, middle)
    bend = curvature_bound(modes, factor, middle, half)
    change = (abs(slope) + 0.5 * bend * half) * half
    if abs(value) > change + noise:
        return EMPTY
    if abs(slope) > bend * half:
        return MONOTONE
    if change < noise:
        # Without damping F₁ has poles.  Next to one the rounding error is large, but there is no root.
        return UNCERTAIN if noise < 1.0 else EMPTY
    return UNDECIDED if half > ROUNDING * middle else EMPTY


@kernel
def isolate(modes, factor, end, count, most):
    """Intervals outside which ``F₁`` has no root up to ``end``.

    Parameters
    ----------
    modes : complex array, shape (N, 3)
    factor : complex
        ``q``.
    end : float
    count, most : int
        Number of equal intervals to begin with, and the largest number of halvings.

    Returns
    -------
    intervals : array, shape (n, 3)
        Both ends, in ascending order, and whether the interval is uncertain; on the others ``F₁`` is monotone.
    complete : bool
        False if more halvings are needed.
    """
    found, intervals = 0, np.empty((16, 3))
    waiting, halvings, left = np.empty(DEEPEST), 0, 0.0
    for i in range(count):
        # Right ends of the intervals that are still to be judged, the nearest last.
        waiting[0] = (i + 1) * (end / count) if i + 1 < count else end
        depth = 0
        while depth >= 0:
            right = waiting[depth]
            verdict = _judge(modes, factor, left, right)
            if verdict == UNDECIDED:
                depth, halvings = depth + 1, halvings + 1
                if depth == DEEPEST or halvings > most:
                    return intervals[:found], False
                waiting[depth] = 0.5 * (left + right)
                continue
            if verdict == UNCERTAIN and found and intervals[found - 1, 1] == left and intervals[found - 1, 2] != 0.0:
                intervals[found - 1, 1] = right
            elif verdict != EMPTY:
                if found == len(intervals):
                    shorter, intervals = intervals, np.empty((2 * found, 3))
                    for j in range(found):
                        intervals[j, 0], intervals[j, 1], intervals[j, 2] = shorter[j, 0], shorter[j, 1], shorter[j, 2]
                intervals[found, 0], intervals[found, 1] = left, right
                intervals[found, 2] = 1.0 if verdict == UNCERTAIN else 0.0
                found += 1
            left, depth = right, depth - 1
    return intervals[:found], True


@kernel
def roots_on(modes, factor, intervals):
    """Roots on the intervals of :func:`isolate`, a double root twice; ``a₁₂`` and ``a₂₂`` there; whether ``F₁ < 0`` next to ``T = 0``."""
    found, roots, starts_below = 0, np.empty(2 * len(intervals)), False
    for i in range(len(intervals)):
        left, right = intervals[i, 0], intervals[i, 1]
        low, slope, noise = _measure(modes, factor, left)
        high, end_slope, _ = _measure(modes, factor, right)
        if left == 0.0 and low <= noise:
            # Only d = 1 makes T = 0 a root; no other root lies on the interval that begins there.
            starts_below = high < 0.0
        elif (low >= 0.0) != (high >= 0.0):
            roots[found] = _root(modes, factor, left, right, high >= 0.0)
            found += 1
        elif intervals[i, 2] != 0.0:
            share = slope / (slope - end_slope) if slope * end_slope < 0.0 else 0.5
            roots[found] = roots[found + 1] = left + share * (right - left)
            found += 2
    values = np.empty((found, 2), np.complex128)
    for i in range(found):
        values[i, 0], values[i, 1], _, _ = flight_return(modes, roots[i])
    return roots[:found], values, starts_below


@inlined
def _root(modes, factor, low, high, rising):
    """Root on a bracket by Newton's method, bisecting where it leaves the bracket."""
    root = 0.5 * (low + high)
    for _ in range(MOST_STEPS):
        value, slope, noise = _measure(modes, factor, root)
        if (value >= 0.0) == rising:
            high = root
        else:
            low = root
        better = root - value / slope if slope != 0.0 else low - 1.0
        if not low <= better <= high:
            better = 0.5 * (low + high)
        settled = abs(value) <= noise or abs(better - root) <= 4e-16 * root
        root = better
        if settled:
            break
    return root
