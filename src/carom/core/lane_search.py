"""The crossing search of :mod:`carom.core.events` for lanes: blocks, and the state at a time."""

from __future__ import annotations

import math
from typing import NamedTuple

from carom.core.block import two_derivatives
from carom.core.compiling.decorators import inlined
from carom.core.events import ROUNDING
from carom.core.flow import squared_modulus
from carom.core.layout import DEGREE, LANE_NODES, LEVELS
from carom.core.vector import choose, fma, join, lanes_of, load, sqrt, store, take, truncate, where

BINOMIALS = tuple(float(math.comb(DEGREE, j)) for j in range(DEGREE + 1))
DIAGONAL = 1.5
"""Upper bound of the ratio of ``|Re z| + |Im z|`` to ``|z|``."""


class Departure(NamedTuple):
    """Start of a flight: amplitudes, displacement ``y``, ``level`` = ``|y|² − 1``, and derived quantities.

    ``low`` and ``high`` are the moduli of the amplitudes, followed by their squares; ``curvature`` is a bound of
    ``f''``; ``floor`` is the rounding error of ``f``.
    """

    lower: object
    upper: object
    position: object
    level: object
    low: object
    high: object
    low_square: object
    high_square: object
    curvature: object
    floor: object


class Search(NamedTuple):
    """Result for the block of each lane: whether it ``decides`` and, if so, whether it is ``free`` of a crossing.

    ``guess`` is an approximate root, or the end of a free block; ``growth`` is the rate at which the error bound grows.
    """

    decides: object
    free: object
    duration: object
    guess: object
    growth: object


class Node(NamedTuple):
    """A node: its time, the amplitudes there and the change of the driven one since the start."""

    time: object
    lower: object
    upper: object
    change: object


@inlined
def departure(rotor, table, lower, upper, level):
    """Start of a flight, with the moduli of its amplitudes and the bounds of :func:`carom.core.events.search`."""
    offset, first, second = rotor.offsets[0], table.bounds[0], table.bounds[1]
    low_square, high_square = squared_modulus(lower), squared_modulus(upper)
    low, high = sqrt(low_square), sqrt(high_square)
    speed = low * first[0] + high * first[1]
    curvature = 2.0 * (speed * speed + (low * second[0] + high * second[1]))
    floor = (high * DIAGONAL + (abs(offset.real) + abs(offset.imag))) * ROUNDING
    return Departure(lower, upper, upper + offset, level, low, high, low_square, high_square, curvature, floor)


@inlined
def products_of(start):
    """Products of amplitudes in which ``f`` is linear; see :func:`carom.core.block.load_products`."""
    position = start.position.conjugate()
    first, second, pair = position * start.lower, position * start.upper, start.lower * start.upper.conjugate()
    return (
        first.real, first.imag, second.real, second.imag,
        start.low_square, pair.real, pair.imag, start.high_square,
    )  # fmt: skip


@inlined
def examine(table, depth, start, polynomial, factors):
    """Look for sign changes of ``f``, in each lane on a block of its own; see :func:`carom.core.block.sign_changes`.

    A lane whose ``depth`` is LEVELS or more has no block left to try, and decides nothing.
    """
    given = depth < float(LEVELS)
    number, level = where(given, depth, 0.0), start.level
    _load_polynomial(table.lane_coefficients, number, start, polynomial)
    growth, length = _growth(table.lane_errors, number, start.low, start.high), choose(table.lane_durations, number)
    remainder = growth * length
    lowest, share = -start.floor, remainder * (-1.0 / DEGREE)
    last = load(polynomial[DEGREE - 1], 0)
    positive = last >= lowest - remainder
    runs, first = where(positive, 1.0, 0.0), where(positive, DEGREE - 1.0, float(DEGREE))
    before, after = last, where(positive, last, level)
    for j in range(DEGREE - 2, -1, -1):
        value = load(polynomial[j], 0)
        before, followed = where(positive, value, before), positive
        positive = value >= share * (j + 1.0) + lowest
        runs = where(positive & ~followed, runs + 1.0, runs)
        first = where(positive, float(j), first)
        after = where(positive, value, after)
    before = where(positive, level, before)
    place = _root(polynomial, factors, table.degree, level, first, before, after)
    begins_outside = ((level >= lowest) & ~(level == 0.0)) | (positive & (level >= 0.0))
    none = first == float(DEGREE)
    return Search(
        given & ~begins_outside & (runs < 2.0), none, length, where(none, length, place * length), growth,
    )  # fmt: skip


@inlined
def _load_polynomial(coefficients, depth, start, polynomial):
    """Write the Bernstein coefficients of ``f`` on the block of each lane; most often all blocks are the longest."""
    a, b, c, d, e, f, g, h = products_of(start)
    if lanes_of(depth > 0.0) == 0:
        for j in range(DEGREE):
            row = coefficients[j]
            value = start.level + a * row[0, 0] + b * row[1, 0] + c * row[2, 0] + d * row[3, 0]
            store(polynomial[j], 0, value + e * row[4, 0] + f * row[5, 0] + g * row[6, 0] + h * row[7, 0])
    else:
        for j in range(DEGREE):
            row = coefficients[j]
            store(
                polynomial[j], 0,
                start.level + a * choose(row[0], depth) + b * choose(row[1], depth) + c * choose(row[2], depth)
                + d * choose(row[3], depth) + e * choose(row[4], depth) + f * choose(row[5], depth)
                + g * choose(row[6], depth) + h * choose(row[7], depth),
            )  # fmt: skip


@inlined
def _growth(errors, depth, low, high):
    """Error bound of a block's polynomial, per unit time, by moduli of amplitudes; needs ``|y| ≤ 1`` at the start."""
    of_lower, of_upper = choose(errors[0], depth), choose(errors[1], depth)
    return low * (of_lower + (low * choose(errors[2], depth) + high * choose(errors[3], depth))) + high * (
        of_upper + high * choose(errors[4], depth)
    )


@inlined
def _root(polynomial, factors, degree, level, first, before, after):
    """Approximate root of a Bernstein polynomial on 0 … 1, from the coefficients on both sides of its sign change.

    With ``u = t/(1 − t)``, or its inverse from the other end, the polynomial is ``Σ C(n, j) b_j u^j`` up to a factor.
    Two Halley steps follow, each written as a ratio, so that few divisions have to wait for each other.  In a flight
    that starts on the wall, the root may lie close to the root at the start.  The latter is divided out: ``b_j n/j``
    are the coefficients of ``f/t``.
    """
    on_wall = level == 0.0
    before, after = where(on_wall, before * (first + 1.0), before), where(on_wall, after * first, after)
    rise, fall = after - before, -before
    rising = rise > 0.0
    scale, fall = where(rising, rise, 1.0), where(rising, where(fall < rise, fall, rise), 0.5)
    passed = where(on_wall, first - 1.0, first) * scale + fall
    ahead = where(on_wall, DEGREE - 1.0, float(DEGREE)) * scale - passed
    far = passed > ahead
    u = where(far, ahead, passed) / where(far, passed, ahead)
    last = load(polynomial[DEGREE - 1], 0)
    for j in range(1, DEGREE):
        factor = where(far, load(polynomial[DEGREE - 1 - j], 0), load(polynomial[j - 1], 0))
        store(factors[j], 0, factor * BINOMIALS[j])
    store(factors[0], 0, where(far, last, level))
    store(factors[DEGREE], 0, where(far, level, last))
    divided = on_wall & ~far
    above, below = _halley(factors, u, degree, divided)
    above, below = _halley(factors, above / below, degree, divided)
    place = where(far, below, above) / (above + below)
    least, most = (first - 1.0) * (1.0 / DEGREE), (first + 2.0) * (1.0 / DEGREE)
    # The order of the comparison replaces a NaN by the lower limit.
    place = where(place > least, place, least)
    return where(place < most, place, most)


@inlined
def _halley(factors, u, degree, divided):
    """Halley step for the polynomial with these factors, or ``divided`` by ``u``; return the new ``u`` as a ratio."""
    value = load(factors[DEGREE], 0)
    slope, half_bend = value * 0.0, value * 0.0
    for j in range(degree - 1, 0, -1):
        half_bend, slope, value = half_bend * u + slope, slope * u + value, value * u + load(factors[j], 0)
    half_bend, slope, value = (
        where(divided, half_bend, half_bend * u + slope),
        where(divided, slope, slope * u + value),
        where(divided, value, value * u + load(factors[0], 0)),
    )
    above, below = halley_ratio(value, slope, half_bend)
    return u * below - above, below


@inlined
def halley_ratio(value, slope, half_bend):
    """Distance by which a third-order (Halley) step goes back to a root, as numerator and denominator."""
    return value * slope, slope * slope - value * half_bend


@inlined
def look_up(rotor, table, start, guess):
    """The node nearest to a time, and the state there; with ``e^{λ₋τ} = e^{λ₊τ} − (λ₊ − λ₋) φ(τ)``."""
    place = guess * (1.0 / table.lane_spacing) + 0.5
    # The order of the comparison replaces a NaN by the lower limit.
    place = where(place > 0.0, place, 0.0)
    place = truncate(where(place < LANE_NODES - 1.0, place, LANE_NODES - 1.0))
    growth = join(take(table.lane_basis[1, 0], place), take(table.lane_basis[1, 1], place))
    response = join(take(table.lane_basis[0, 0], place), take(table.lane_basis[0, 1], place))
    change = fma(growth, start.upper, response * start.lower)
    decay = fma(response, -rotor.gaps[1], growth)
    return Node(place * table.lane_spacing, fma(decay, start.lower, start.lower), start.upper + change, change)


@inlined
def travel(rotor, table, start, node, rest, terms):
    """State some time after a node.

    Returns both amplitudes, rates (of the driving one; two of the driven one, and so of ``y``), and ``f`` with its
    first two derivatives.
    """
    growth = _power_series(table.basis_series, 1, rest, terms)
    response = _power_series(table.basis_series, 0, rest, terms)
    change = fma(growth, node.upper, fma(response, node.lower, node.change))
    decay = fma(response, -rotor.gaps[1], growth)
    lower, upper = fma(decay, node.lower, node.lower), start.upper + change
    slow, fast = rotor.exponents[0], rotor.exponents[1]
    rate, speed = lower * slow, fma(upper, fast, lower)
    force = fma(speed, fast, rate)
    return lower, upper, (rate, speed, force), two_derivatives(start.position, start.level, change, speed, force)


@inlined
def _power_series(series, column, time, terms):
    """Sum of a power series without constant term."""
    total = time * series[terms - 1, column] + series[terms - 2, column]
    for n in range(terms - 3, -1, -1):
        total = total * time + series[n, column]
    return total * time
