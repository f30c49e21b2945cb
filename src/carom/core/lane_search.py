"""The crossing search of :mod:`carom.core.events` on lanes: products, blocks, nodes and a first step to the root.

Written in real parts, for complex numbers keep the compiler from vector instructions.
"""

from __future__ import annotations

import math

from carom.core.events import MARGIN, ROUNDING, householder_step
from carom.core.layout import DEGREE, LANES, NODES, part

__all__ = [
    "derivatives",
    "examine",
    "load_products",
    "look_up_nodes",
    "moved",
    "step_towards_root",
    "sum_all_series",
]

HALLEY_STEPS = 2
BINOMIALS = tuple(float(math.comb(DEGREE, j)) for j in range(DEGREE + 1))


@part
def load_products(rotor, table, lanes):
    """Products of amplitudes in which ``f`` is linear (:func:`carom.core.block.load_products`), and bounds."""
    origin, first, second = rotor.offsets[0], table.bounds[0], table.bounds[1]
    offset_re, offset_im = origin.real, origin.imag
    fixed = abs(offset_re) + abs(offset_im)
    lower_speed, upper_speed, lower_force, upper_force = first[0], first[1], second[0], second[1]
    for lane in range(LANES):
        lower_re, lower_im = lanes.lower_re[lane], lanes.lower_im[lane]
        upper_re, upper_im = lanes.upper_re[lane], lanes.upper_im[lane]
        y_re, y_im = offset_re + upper_re, offset_im + upper_im
        lower_square = lower_re * lower_re + lower_im * lower_im
        upper_square = upper_re * upper_re + upper_im * upper_im
        lanes.products[0, lane] = y_re * lower_re + y_im * lower_im
        lanes.products[1, lane] = y_re * lower_im - y_im * lower_re
        lanes.products[2, lane] = y_re * upper_re + y_im * upper_im
        lanes.products[3, lane] = y_re * upper_im - y_im * upper_re
        lanes.products[4, lane] = lower_square
        lanes.products[5, lane] = lower_re * upper_re + lower_im * upper_im
        lanes.products[6, lane] = lower_im * upper_re - lower_re * upper_im
        lanes.products[7, lane] = upper_square
        lower, upper = math.sqrt(lower_square), math.sqrt(upper_square)
        speed = lower * lower_speed + upper * upper_speed
        lanes.curvature[lane] = 2.0 * (speed * speed + (lower * lower_force + upper * upper_force))
        lanes.floor[lane] = ROUNDING * (fixed + abs(upper_re) + abs(upper_im))
        lanes.open[lane] = 1.0


@part
def examine(table, depth, lanes):
    """Look for sign changes of ``f`` on a block of lanes still open; how many stay open.

    Sets ``free`` (1: no crossing on the block, 0: one root, to be polished from ``guess``) and, of lanes still open, the
    block's ``duration`` and the least ``square`` of ``f'`` that certifies a root.
    """
    errors, products, polynomial = table.errors[depth], lanes.products, lanes.polynomial
    e0, e1, e2, e3, e4, e5, e6, e7 = (
        errors[0], errors[1], errors[2], errors[3], errors[4], errors[5], errors[6], errors[7]
    )  # fmt: skip
    for lane in range(LANES):
        lanes.share[lane] = (
            (abs(products[0, lane]) * e0 + abs(products[1, lane]) * e1)
            + (abs(products[2, lane]) * e2 + abs(products[3, lane]) * e3)
            + (abs(products[4, lane]) * e4 + abs(products[5, lane]) * e5)
            + (abs(products[6, lane]) * e6 + abs(products[7, lane]) * e7)
        )
    for j in range(DEGREE):
        column = table.coefficients[depth, :, j]
        c0, c1, c2, c3, c4, c5, c6, c7 = (
            column[0], column[1], column[2], column[3], column[4], column[5], column[6], column[7]
        )  # fmt: skip
        for lane in range(LANES):
            polynomial[j, lane] = lanes.level[lane] + (
                ((products[0, lane] * c0 + products[1, lane] * c1) + (products[2, lane] * c2 + products[3, lane] * c3))
                + (
                    (products[4, lane] * c4 + products[5, lane] * c5)
                    + (products[6, lane] * c6 + products[7, lane] * c7)
                )
            )
    duration, level_number, undecided = table.durations[depth], float(depth), 0
    for lane in range(LANES):
        level, floor, remainder = lanes.level[lane], lanes.floor[lane], lanes.share[lane]
        share = remainder * (1.0 / DEGREE)
        first, last, number = float(DEGREE), -1.0, 0.0
        after, before, pending = 0.0, level, False
        for j in range(DEGREE - 1, -1, -1):
            value = polynomial[j, lane]
            before = value if pending else before
            pending = value + (floor + share * (j + 1.0)) >= 0.0
            last = float(j) if pending & (number == 0.0) else last
            first = float(j) if pending else first
            after = value if pending else after
            number += 1.0 if pending else 0.0
        before = level if pending else before
        rise = after - before
        place = (first + min(1.0, -before / rise) if rise > 0.0 else first + 0.5) * (1.0 / DEGREE)
        place = _refined_root(polynomial, lane, level, place)
        free = number == 0.0
        unclear = ((level >= -floor) & (level != 0.0)) | ((first == 0.0) & (level >= 0.0)) | (last - first >= number)
        was_open, square, length = lanes.open[lane], lanes.square[lane], lanes.duration[lane]
        was_free, guess, curvature = lanes.free[lane], lanes.guess[lane], lanes.curvature[lane]
        mine = (was_open > 0.0) & (lanes.depth[lane] <= level_number)
        lanes.duration[lane] = duration if mine else length
        lanes.square[lane] = MARGIN * (floor + remainder) * curvature if mine else square
        lanes.free[lane] = (1.0 if free else 0.0) if mine else was_free
        lanes.guess[lane] = (duration if free else place * duration) if mine else guess
        still = (1.0 if unclear else 0.0) if mine else was_open
        lanes.open[lane] = still
        undecided += 1 if still > 0.0 else 0
    return undecided


@part
def _refined_root(polynomial, lane, level, place):
    """Halley step towards the root of a Bernstein polynomial on 0 … 1 from near it.

    With ``u = t/(1 − t)``, or its inverse from the other end, the polynomial is ``Σ C(n, j) b_j u^j`` but for a factor.
    """
    far = place > 0.5
    u = (1.0 - place) / place if far else place / (1.0 - place)
    for _ in range(HALLEY_STEPS):
        value, slope, half_bend = level if far else polynomial[DEGREE - 1, lane], 0.0, 0.0
        for j in range(DEGREE - 1, 0, -1):
            factor = BINOMIALS[j] * (polynomial[DEGREE - 1 - j, lane] if far else polynomial[j - 1, lane])
            half_bend, slope, value = half_bend * u + slope, slope * u + value, value * u + factor
        factor = polynomial[DEGREE - 1, lane] if far else level
        half_bend, slope, value = half_bend * u + slope, slope * u + value, value * u + factor
        u -= value * slope / (slope * slope - value * half_bend)
    refined = 1.0 / (1.0 + u) if far else u / (1.0 + u)
    lowest, highest = place - 1.0 / DEGREE, place + 1.0 / DEGREE
    # In this order what is no number becomes one.
    refined = refined if refined > lowest else lowest
    return refined if refined < highest else highest


@part
def look_up_nodes(table, lanes):
    """Nearest node of each lane's guess, the rest of the way, and the basis functions there."""
    pace, spacing = table.pace, table.spacing
    for lane in range(LANES):
        node = min(max(int(lanes.guess[lane] * pace + 0.5), 0), NODES)
        lanes.node[lane] = node
        lanes.rest[lane] = lanes.guess[lane] - node * spacing
    for lane in range(LANES):
        node = lanes.node[lane]
        decay, growth, response = table.growth[node, 0], table.growth[node, 1], table.basis[node, 0, 0]
        lanes.decay_re[lane], lanes.decay_im[lane] = decay.real, decay.imag
        lanes.growth_re[lane], lanes.growth_im[lane] = growth.real, growth.imag
        lanes.response_re[lane], lanes.response_im[lane] = response.real, response.imag


@part
def sum_all_series(table, lanes):
    """Growth of the basis functions from the node over the rest of the way."""
    for column in range(2):
        _sum_series(table.growth_series, column, lanes.series[2 * column], lanes.series[2 * column + 1], lanes.rest)
    _sum_series(table.basis_series, 0, lanes.series[4], lanes.series[5], lanes.rest)


@part
def step_towards_root(rotor, spacing, lanes):
    """Move each guess by a Householder step; of a lane that is free, the guess is the end of the block."""
    offset, lower, upper = rotor.offsets[0], rotor.exponents[0], rotor.exponents[1]
    offset_re, offset_im = offset.real, offset.imag
    lower_re, lower_im, upper_re, upper_im = lower.real, lower.imag, upper.real, upper.imag
    for lane in range(LANES):
        b_re, b_im, change_re, change_im = moved(lanes, lane)
        a0_re, a0_im = lanes.upper_re[lane], lanes.upper_im[lane]
        value, slope, bend, third = derivatives(
            offset_re + a0_re, offset_im + a0_im, lanes.level[lane], change_re, change_im, b_re, b_im,
            a0_re + change_re, a0_im + change_im, lower_re, lower_im, upper_re, upper_im,
        )  # fmt: skip
        step = householder_step(value, slope, bend, third)
        # No step off the series, nor one that is no number.
        step = step if (lanes.free[lane] == 0.0) & (abs(step) <= spacing) else 0.0
        guess, rest = lanes.guess[lane], lanes.rest[lane]
        lanes.guess[lane] = guess + step
        lanes.rest[lane] = rest + step


@part
def moved(lanes, lane):
    """Driving amplitude at the guess, and change of the driven one: to the node, and from there by the series."""
    b0_re, b0_im, a0_re, a0_im = lanes.lower_re[lane], lanes.lower_im[lane], lanes.upper_re[lane], lanes.upper_im[lane]
    series = lanes.series
    b_re = b0_re + (lanes.decay_re[lane] * b0_re - lanes.decay_im[lane] * b0_im)
    b_im = b0_im + (lanes.decay_re[lane] * b0_im + lanes.decay_im[lane] * b0_re)
    change_re = (lanes.growth_re[lane] * a0_re - lanes.growth_im[lane] * a0_im) + (
        lanes.response_re[lane] * b0_re - lanes.response_im[lane] * b0_im
    )
    change_im = (lanes.growth_re[lane] * a0_im + lanes.growth_im[lane] * a0_re) + (
        lanes.response_re[lane] * b0_im + lanes.response_im[lane] * b0_re
    )
    a_re, a_im = a0_re + change_re, a0_im + change_im
    change_re += (series[2, lane] * a_re - series[3, lane] * a_im) + (series[4, lane] * b_re - series[5, lane] * b_im)
    change_im += (series[2, lane] * a_im + series[3, lane] * a_re) + (series[4, lane] * b_im + series[5, lane] * b_re)
    end_re = b_re + (series[0, lane] * b_re - series[1, lane] * b_im)
    end_im = b_im + (series[0, lane] * b_im + series[1, lane] * b_re)
    return end_re, end_im, change_re, change_im


@part
def derivatives(
    y_re, y_im, level, change_re, change_im, b_re, b_im, a_re, a_im, lower_re, lower_im, upper_re, upper_im
):
    """``f`` and its first three derivatives where the amplitudes are ``b``, ``a`` and ``y`` has changed since the start."""
    end_re, end_im = y_re + change_re, y_im + change_im
    speed_re = b_re + (upper_re * a_re - upper_im * a_im)
    speed_im = b_im + (upper_re * a_im + upper_im * a_re)
    rate_re, rate_im = lower_re * b_re - lower_im * b_im, lower_re * b_im + lower_im * b_re
    force_re = rate_re + (upper_re * speed_re - upper_im * speed_im)
    force_im = rate_im + (upper_re * speed_im + upper_im * speed_re)
    second_re, second_im = lower_re * rate_re - lower_im * rate_im, lower_re * rate_im + lower_im * rate_re
    jerk_re = second_re + (upper_re * force_re - upper_im * force_im)
    jerk_im = second_im + (upper_re * force_im + upper_im * force_re)
    value = level + (2.0 * (y_re * change_re + y_im * change_im) + (change_re * change_re + change_im * change_im))
    slope = 2.0 * (end_re * speed_re + end_im * speed_im)
    bend = 2.0 * ((end_re * force_re + end_im * force_im) + (speed_re * speed_re + speed_im * speed_im))
    third = 2.0 * ((end_re * jerk_re + end_im * jerk_im) + 3.0 * (speed_re * force_re + speed_im * force_im))
    return value, slope, bend, third


@part
def _sum_series(series, column, real, imag, times):
    """Sum a power series without constant term at every lane's time."""
    for half in range(2):
        out = real if half == 0 else imag
        c1 = series[0, column].real if half == 0 else series[0, column].imag
        c2 = series[1, column].real if half == 0 else series[1, column].imag
        c3 = series[2, column].real if half == 0 else series[2, column].imag
        c4 = series[3, column].real if half == 0 else series[3, column].imag
        c5 = series[4, column].real if half == 0 else series[4, column].imag
        c6 = series[5, column].real if half == 0 else series[5, column].imag
        c7 = series[6, column].real if half == 0 else series[6, column].imag
        c8 = series[7, column].real if half == 0 else series[7, column].imag
        for lane in range(LANES):
            time = times[lane]
            square = time * time
            odd = c1 + square * (c3 + square * (c5 + square * c7))
            even = c2 + square * (c4 + square * (c6 + square * c8))
            out[lane] = time * odd + square * even
