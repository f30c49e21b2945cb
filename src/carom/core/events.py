"""Certified first crossing of the wall ``|y(t)| = 1``.

The search moves only over times that are proven free of a crossing.  Two proofs are used:

1. *Block.*  The Bernstein coefficients of ``f = |y|² − 1`` on a block, plus the bound of their error, are all negative:
   no crossing.  If instead they change sign once, the root is polished on the exact flight and accepted when
   ``f'² > 4 R M₂`` (``R`` error bound of the polynomial, ``M₂ ≥ |f''|``).  That proves it the first one: ``f`` rises all
   along the last ``w = f'/M₂`` before the root, and at ``root − w`` the polynomial plus its error is negative.
2. *Steps* for what a block leaves open: ``f(t + τ) ≤ f + f'τ + M₂τ²/2``, so the first root of the right side is a time
   that cannot be behind a crossing.  The steps converge to a transversal crossing quadratically.

Where ``f`` comes to zero within its rounding and is not seen to rise above it, the outcome is ``grazing``.
"""

from __future__ import annotations

import math

from carom.core.flow import acceleration, displacement, flight_increments, nudge, squared_modulus, velocity
from carom.core.layout import DEGREE, kernel
from carom.outcome import Outcome

__all__ = ["INSIDE", "LEAVING", "basis_amplitudes", "first_crossing"]

CLEAR, CONTACT, GRAZING = int(Outcome.CLEAR), int(Outcome.CONTACT), int(Outcome.GRAZING)

INSIDE, LEAVING = 0, 1
"""How a flight starts: inside the wall, or on it with inward velocity."""

UNDECIDED = -1.0
NO_ROOT = 2.0
MARGIN = 4.4
"""The 4 of the acceptance test plus room for the rounding of both sides."""
ROUNDING = 16 * 2.220446049250313e-16
POLISHED = 1e-5
"""Correction, in units of ``f'/M₂``, below which a Householder step and the cubic nudge are exact to rounding.

With ``M₂ ≥ 2|ẏ|²`` and ``f' ≤ 2|ẏ|`` the error this leaves in ``f`` is of the order of ``POLISHED³`` at any speed.
"""


@kernel
def first_crossing(rotor, table, plane, amplitudes, horizon, start, work):
    """First time at which a flight meets the wall of a plane.

    Parameters
    ----------
    rotor, table : records of :mod:`carom.core.layout`
    plane : int
    amplitudes : complex array, shape (N,)
        Amplitudes at the start; left unchanged.
    horizon : float
        Latest time of interest, counted from the start.
    start : int
        ``INSIDE``, or ``LEAVING`` where the start lies on the wall: there ``|y|`` is one by definition.  A start at rest
        on the wall is for :func:`carom.core.rub.lift_off`.
    work : record of :func:`~carom.core.layout.workspace`
        On return ``work.arrival`` holds the amplitudes at the returned time.

    Returns
    -------
    outcome : int
        ``CLEAR`` (time is the horizon), ``CONTACT`` or ``GRAZING``.
    time : float
    """
    modes = amplitudes.shape[0]
    for k in range(modes):
        work.current[k] = amplitudes[k]
    elapsed = 0.0
    while True:
        origin = displacement(rotor, plane, work.current)
        level = 0.0 if start != INSIDE else squared_modulus(origin) - 1.0
        block = min(table.duration, horizon - elapsed)
        spread = _spread(rotor, plane, work.current)
        floor = ROUNDING * spread
        remainder = _load_block(rotor, table, plane, origin, level, work)
        guess = _guess_root(work.polynomial, level, floor, remainder)
        outcome, time = CLEAR, block
        if guess != NO_ROOT:
            bounds = _bounds(table, work)
            certified = False
            if guess != UNDECIDED:
                least_square = MARGIN * (floor + remainder) * bounds[0]
                certified, time = _polish(
                    rotor, plane, origin, level, guess * table.duration, bounds[0], least_square, work
                )
            if certified and time <= block:
                return CONTACT, elapsed + time
            # Past the end of the table's block the polynomial says nothing: a root there does not prove the block free.
            if certified and time <= table.duration:
                time = block
            else:
                outcome, time = _step_safely(rotor, plane, origin, level, start, spread, block, bounds, work)
                if outcome != CLEAR:
                    return outcome, elapsed + time
        flight_increments(rotor, work.current, time, work.increments)
        for k in range(modes):
            work.arrival[k] = work.current[k] + work.increments[k]
        elapsed += time
        if elapsed >= horizon:
            return CLEAR, horizon
        for k in range(modes):
            work.current[k] = work.arrival[k]
        start = INSIDE


@kernel
def _load_block(rotor, table, plane, origin, level, work):
    """Write the polynomial of ``f`` on a block from ``work.current``; return the bound of its error."""
    modes = work.current.shape[0]
    basis_amplitudes(rotor, plane, work.current, work.amplitudes)
    products = work.products
    row = 0
    for k in range(modes):
        linear = origin.conjugate() * work.amplitudes[k]
        products[row] = linear.real
        products[row + 1] = linear.imag
        row += 2
    for j in range(modes):
        first = work.amplitudes[j]
        products[row] = squared_modulus(first)
        row += 1
        for k in range(j + 1, modes):
            pair = first * work.amplitudes[k].conjugate()
            products[row] = pair.real
            products[row + 1] = pair.imag
            row += 2
    polynomial = work.polynomial
    for j in range(DEGREE):
        polynomial[j] = level
    remainder = 0.0
    for i in range(row):
        factor = products[i]
        remainder += abs(factor) * table.errors[i]
        for j in range(DEGREE):
            polynomial[j] += factor * table.coefficients[i, j]
    return remainder


@kernel
def basis_amplitudes(rotor, plane, amplitudes, out):
    """Factors ``α`` of the basis functions of :mod:`carom.core.table` in the motion of a plane."""
    modes = amplitudes.shape[0]
    for k in range(modes):
        out[k] = rotor.rows[plane, k] * amplitudes[k]
        if rotor.driven[k]:
            out[k] += rotor.rows[plane, k - 1] * amplitudes[k - 1]
            out[k - 1] = (rotor.rows[plane, k] - rotor.gaps[k] * rotor.rows[plane, k - 1]) * amplitudes[k - 1]


@kernel
def _guess_root(polynomial, level, floor, remainder):
    """Where on the block, in 0 … 1, the only root may be; or NO_ROOT (proven), or UNDECIDED.

    The error grows from ``floor``, the rounding of ``f`` at the start, by ``remainder`` at the end.
    """
    if -floor <= level != 0.0:
        return UNDECIDED
    share = remainder / DEGREE
    first = DEGREE
    for j in range(DEGREE - 1, -1, -1):
        if polynomial[j] + share * (j + 1) + floor >= 0.0:
            first = j
    if first == DEGREE:
        return NO_ROOT
    before = level
    if first > 0:
        before = polynomial[first - 1]
    elif level >= 0.0:
        return UNDECIDED
    for j in range(first + 1, DEGREE):
        if polynomial[j] - share * (j + 1) - floor <= 0.0:
            return UNDECIDED
    rise = polynomial[first] - before
    return (first + min(1.0, -before / rise)) / DEGREE if rise > 0.0 else (first + 0.5) / DEGREE


@kernel
def _bounds(table, work):
    """Bounds of ``f''``, ``f'''`` and ``|ẏ|`` while ``|y| ≤ 1`` on the block whose amplitudes are loaded."""
    speed = 0.0
    second = 0.0
    third = 0.0
    for k in range(work.amplitudes.shape[0]):
        modulus = math.sqrt(squared_modulus(work.amplitudes[k]))
        speed += modulus * table.bounds[0, k]
        second += modulus * table.bounds[1, k]
        third += modulus * table.bounds[2, k]
    return (
        2.0 * (speed * speed + second),
        2.0 * (3.0 * speed * second + third),
        speed,
    )


@kernel
def _measure(rotor, plane, origin, level, time, work):
    """Move to ``time``: fill ``work.arrival``, return ``f``, ``f'`` and ``f''``."""
    flight_increments(rotor, work.current, time, work.increments)
    change = 0j
    for k in range(work.current.shape[0]):
        change += rotor.rows[plane, k] * work.increments[k]
        work.arrival[k] = work.current[k] + work.increments[k]
    value = level + (2.0 * (origin.conjugate() * change).real + squared_modulus(change))
    position = origin + change
    speed = velocity(rotor, plane, work.arrival)
    force = acceleration(rotor, plane, work.arrival)
    slope = 2.0 * (position.conjugate() * speed).real
    bend = 2.0 * ((position.conjugate() * force).real + squared_modulus(speed))
    return value, slope, bend


@kernel
def _polish(rotor, plane, origin, level, time, curvature, least_square, work):
    """Householder steps to a root; certified when ``f'²`` there exceeds ``least_square``."""
    for _ in range(8):
        value, slope, bend = _measure(rotor, plane, origin, level, time, work)
        if slope * slope <= least_square or slope <= 0.0:
            return False, time
        newton = value / slope
        step = -newton / (1.0 - 0.5 * newton * bend / slope)
        time += step
        if abs(step) * curvature < POLISHED * slope:
            nudge(rotor, work.arrival, step)
            return time > 0.0, time
    return False, time


@kernel
def _step_safely(rotor, plane, origin, level, start, spread, block, bounds, work):
    """Certified steps from the start of a block to its end or to the first crossing."""
    time = 0.0
    curvature, jerk, speed = bounds
    if start != INSIDE:
        _, slope, bend = _measure(rotor, plane, origin, level, 0.0, work)
        time = _departure(min(slope, 0.0), bend, jerk)
        if time == 0.0:
            return GRAZING, time
    while time < block:
        value, slope, bend = _measure(rotor, plane, origin, level, time, work)
        # On the wall f is exact at the start, and the rounding of y there turns the change of y that follows.
        share = 1.0 if start == INSIDE else min(1.0, speed * time)
        rounding = ROUNDING * (spread * share + speed * time)
        if value >= -rounding:
            if slope <= 2.0 * math.sqrt(curvature * rounding):
                return _decide(rotor, plane, origin, level, time, block, bounds, rounding, work)
            step = -value / slope
            nudge(rotor, work.arrival, step)
            return CONTACT, time + step
        # A bound of f'' that holds for steps up to `reach` takes longer ones along a wall that is nearly followed.
        reach = (-value / jerk) ** (1.0 / 3.0)
        nearby = min(reach, _first_root(value, slope, bend + jerk * reach / 3.0))
        step = max(nearby, _first_root(value, slope, curvature))
        if time + step == time:
            return (CONTACT if slope > 0.0 else GRAZING), time
        time += step
    return CLEAR, block


@kernel
def _spread(rotor, plane, amplitudes):
    """Sum of the sizes of the terms of a displacement: its rounding error in units of the spacing of doubles."""
    total = abs(rotor.offsets[plane].real) + abs(rotor.offsets[plane].imag)
    for k in range(amplitudes.shape[0]):
        term = rotor.rows[plane, k] * amplitudes[k]
        total += abs(term.real) + abs(term.imag)
    return total


@kernel
def _first_root(value, slope, bend):
    """First positive root of ``value + slope τ + bend τ²/2`` with ``value < 0``; infinite where there is none."""
    square = slope * slope - 2.0 * bend * value
    if square < 0.0 or (slope <= 0.0 and bend <= 0.0):
        return math.inf
    root = math.sqrt(square)
    return -2.0 * value / (root + slope) if slope > 0.0 else (root - slope) / bend


@kernel
def _decide(rotor, plane, origin, level, time, block, bounds, rounding, work):
    """Whether ``f``, zero to rounding at a time up to which nothing crosses, goes on to rise above its rounding.

    It is followed over stretches on which ``f' + f''τ − M₃τ²/2 > 0`` proves it rising, until the rise is beyond
    doubt; the root is then bisected, for a derivative as small as this one may be does not lead to it.
    """
    first = time
    value, slope, bend = _measure(rotor, plane, origin, level, time, work)
    while value <= rounding:
        if slope <= 0.0:
            return GRAZING, time
        rise = 2.0 * slope / (math.sqrt(bend * bend + 2.0 * bounds[1] * slope) - bend)
        later = min(time + rise, block)
        if later == time:
            return (CLEAR if time == block else GRAZING), time
        time = later
        value, slope, bend = _measure(rotor, plane, origin, level, time, work)
    middle = 0.5 * (first + time)
    while first < middle < time:
        value, _, _ = _measure(rotor, plane, origin, level, middle, work)
        if value < 0.0:
            first = middle
        else:
            time = middle
        middle = 0.5 * (first + time)
    _measure(rotor, plane, origin, level, time, work)
    return CONTACT, time


@kernel
def _departure(slope, bend, jerk):
    """Time after leaving the wall, ``f' ≤ 0``, before which no return is possible; zero where that cannot be said.

    First root of ``f' + f''τ/2 + M₃τ²/6``, which bounds ``f/τ`` from above.
    """
    if slope == 0.0 and bend >= 0.0:
        return 0.0
    half = 0.5 * bend
    root = math.sqrt(half * half - 2.0 / 3.0 * jerk * slope)
    return -2.0 * slope / (root + half) if half > 0.0 else 3.0 * (root - half) / jerk
