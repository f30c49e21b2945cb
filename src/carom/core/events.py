"""Certified first crossing of the wall ``|y(t)| = 1``.

The search moves only over times that are proven free of a crossing.  Two proofs are used:

1. *Block.*  The Bernstein coefficients of ``f = |y|² − 1`` on a block, plus the bound of their error, are those of a
   polynomial ``q ≥ f``.  If all are negative, there is no crossing.  If the positive ones are consecutive, ``q`` has at
   most two roots.  A root of ``f`` is then polished on the exact flight and accepted on two conditions.

   *It is a root:* ``|f| M₂ < POLISHED f'²`` at the last time looked at, with ``M₂ ≥ |f''|``.  By Newton and Kantorovich
   there is then a root within ``2|f|/f'``, to which the step that follows leads.  That this step is short proves
   nothing: a Householder step is zero also where ``f f'' = 2f'²``, a little before a maximum below the wall.

   *It is the first:* ``f'² > 4 R M₂`` (``R`` error bound of the polynomial up to there).  ``f`` rises during the
   whole time ``w = f'/M₂`` before the root; ``q(root − w) ≤ f + 2R`` is negative and ``q(root)`` is not, so ``q`` has a
   root in between; if ``q`` had been positive before, it would have three roots.  What a block leaves undecided is
   tried again on shorter blocks, whose polynomials approximate more closely.
2. *Steps* for what the shortest block leaves undecided, and for rotors of more than MOST_IN_POLYNOMIALS modes: ``f(t + τ) ≤ f + f'τ + M₂τ²/2``, so there is no crossing before
   the first root of the right side.  The steps converge to a transversal crossing quadratically.

If ``f`` reaches zero within its rounding error and is not found to rise above it, the outcome is ``grazing``.
"""

from __future__ import annotations

import math

from carom.base.outcome import Outcome
from carom.core.block import (
    basis_amplitudes,
    derivatives,
    load_polynomial,
    load_products,
    look_at_node,
    move_to,
    nearest_node,
    rough_root,
    sign_changes,
)
from carom.core.compiling.decorators import expanded, inlined, kernel
from carom.core.flow import copy, displacement, nudge, squared_modulus
from carom.core.layout import LEVELS, MOST_IN_POLYNOMIALS

CLEAR, CONTACT, GRAZING = int(Outcome.CLEAR), int(Outcome.CONTACT), int(Outcome.GRAZING)

INSIDE, LEAVING = 0, 1
"""How a flight starts: inside the wall, or on it with inward velocity."""

MARGIN = 4.4
"""The 4 of the acceptance test with a margin for the rounding of both sides."""
ROUNDING = 16 * 2.220446049250313e-16
POLISHED = 1e-4
"""Value of ``|f| M₂/f'²`` below which a root is proven to be near.

There ``|y|² < 1 + 2 POLISHED |y|²``, since ``f' ≤ 2|y||ẏ|`` and ``M₂ ≥ 2|ẏ|²``, and so it stays within ``2|f|/f'``:
``M₂``, a bound for ``|y| ≤ 1``, holds but for a thousandth, which MARGIN covers.  A Householder step from there errs by
the third power of POLISHED relative to its length, and so in ``f`` by the fourth, at any speed.
"""
BRIEF = 1e-3
"""Length of that last step, in spacings of the nodes, below which it and the cubic nudge are exact to rounding.

A spacing is at most ``5.3/64`` of the time ``1/|λ|`` of the fastest mode, so the fourth power of ``λ`` times the step is
below rounding, however stiff that mode is.
"""
SIXTH = 1.0 / 6.0


@kernel
def first_crossing(rotor, table, station, amplitudes, horizon, start, work):
    """First time at which a flight reaches the wall of a station.

    Parameters
    ----------
    rotor, table : records of :mod:`carom.core.layout`
    station : int
    amplitudes : complex array, shape (N,)
        Amplitudes at the start; left unchanged.
    horizon : float
        Latest time of interest, counted from the start.
    start : int
        ``INSIDE``, or ``LEAVING`` if the start lies on the wall: there ``|y|`` is one by definition.  Use
        :func:`carom.core.rub.lift_off` for a start at rest on the wall.
    work : record of :func:`~carom.core.layout.workspace`
        On return ``work.end`` holds the amplitudes at the returned time.

    Returns
    -------
    outcome : int
        ``CLEAR`` (time is the horizon), ``CONTACT`` or ``GRAZING``.
    time : float
    """
    copy(amplitudes, work.current)
    return search(rotor, table, station, horizon, start, work)


@inlined
def search(rotor, table, station, horizon, start, work):
    """:func:`first_crossing` of the flight from ``work.current``, which is advanced from block to block."""
    elapsed = 0.0
    while True:
        outcome, time = _search_block(rotor, table, station, horizon - elapsed, start, work)
        elapsed += time
        if outcome != CLEAR:
            return outcome, elapsed
        move_to(rotor, table, time, work)
        if elapsed >= horizon:
            return CLEAR, horizon
        copy(work.end, work.current)
        start = INSIDE


@expanded
def _search_block(rotor, table, station, horizon, start, work):
    """First crossing on a block from ``work.current``, or a time up to which there is none."""
    origin = displacement(rotor, station, work.current)
    level = 0.0 if start != INSIDE else squared_modulus(origin) - 1.0
    spread = _spread(rotor, station, work.current)
    floor = ROUNDING * spread
    if work.current.shape[0] > MOST_IN_POLYNOMIALS:
        basis_amplitudes(rotor, station, work.current, work.amplitudes)
        bounds, longest = _bounds(table, work), min(table.durations[0], horizon)
        return _step_safely(rotor, table, station, origin, level, start, spread, longest, bounds, work)
    load_products(rotor, station, origin, work)
    bounds = _bounds(table, work)
    for depth in range(LEVELS):
        duration = table.durations[depth]
        remainder = load_polynomial(table, depth, level, work)
        changes, first = sign_changes(work.polynomial, level, floor, remainder)
        if changes == 0:
            return CLEAR, min(duration, horizon)
        if changes == 1:
            guess = rough_root(work.polynomial, level, first) * duration
            certified, time = _root_on_block(
                rotor, table, station, origin, level, guess, bounds[0], floor, remainder, duration, work
            )
            if certified:
                return (CONTACT, time) if time <= horizon else (CLEAR, horizon)
    return _step_safely(rotor, table, station, origin, level, start, spread, min(duration, horizon), bounds, work)


@inlined
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


@inlined
def _measure(rotor, table, station, origin, level, time, work):
    """Move to ``time``: fill ``work.end``, return ``f`` and its first three derivatives."""
    move_to(rotor, table, time, work)
    change, speed, force, jerk = 0j, 0j, 0j, 0j
    for k in range(work.current.shape[0]):
        change += rotor.rows[station, k] * work.increments[k]
        speed += rotor.rate_rows[station, k] * work.end[k]
        force += rotor.acceleration_rows[station, k] * work.end[k]
        jerk += rotor.jerk_rows[station, k] * work.end[k]
    return derivatives(origin, level, change, speed, force, jerk)


@inlined
def householder_step(value, slope, bend, third):
    """Step towards a root, of fourth order."""
    square, skew = slope * slope, value * bend
    return -value * (square - 0.5 * skew) / (slope * (square - skew) + SIXTH * value * value * third)


@inlined
def _root_on_block(rotor, table, station, origin, level, guess, curvature, floor, remainder, duration, work):
    """Whether the root close to a guess is certified to be the first on a block of this duration, and the root."""
    growth = remainder / duration
    certified, time = _polish(rotor, table, station, origin, level, guess, curvature, floor, growth, work)
    # The polynomial is valid on the block only: a root beyond its end does not prove the block free of crossings.
    return certified and time <= duration, time


@inlined
def _polish(rotor, table, station, origin, level, time, curvature, floor, growth, work):
    """Householder steps to a root, from the node nearest to a time; certified by ``|f|`` and ``f'²``.

    The error of the polynomial up to that time is at most ``floor + growth time``.
    """
    node = nearest_node(table, time)
    value, slope, bend, third = look_at_node(table, node, origin, level, work)
    time = node * table.spacing + householder_step(value, slope, bend, third)
    for _ in range(8):
        # Outside the range of the nodes the series are not valid.
        if not 0.0 <= time <= table.durations[0]:
            return False, time
        value, slope, bend, third = _measure(rotor, table, station, origin, level, time, work)
        if slope * slope <= MARGIN * (floor + growth * time) * curvature or slope <= 0.0:
            return False, time
        step = householder_step(value, slope, bend, third)
        time += step
        if abs(value) * curvature < POLISHED * (slope * slope) and abs(step) < BRIEF * table.spacing:
            nudge(rotor, work.end, step)
            return True, time
    return False, time


@kernel
def _probe(rotor, table, station, origin, level, time, work):
    """Move to ``time``: fill ``work.end``, return ``f``, ``f'`` and ``f''``."""
    value, slope, bend, _ = _measure(rotor, table, station, origin, level, time, work)
    return value, slope, bend


@kernel
def _step_safely(rotor, table, station, origin, level, start, spread, block, bounds, work):
    """Certified steps from the start of a block to its end or to the first crossing."""
    time = 0.0
    curvature, jerk, speed = bounds
    if start != INSIDE:
        _, slope, bend = _probe(rotor, table, station, origin, level, 0.0, work)
        if slope >= 0.0 and bend >= 0.0:
            return GRAZING, time
        time = _departure(min(slope, 0.0), bend, jerk)
    while time < block:
        value, slope, bend = _probe(rotor, table, station, origin, level, time, work)
        # For a start on the wall f is exact there, and the rounding of y acts only through the later change of y.
        share = 1.0 if start == INSIDE else min(1.0, speed * time)
        rounding = ROUNDING * (spread * share + speed * time)
        if value >= -rounding:
            if slope <= 2.0 * math.sqrt(curvature * rounding):
                return _decide(rotor, table, station, origin, level, time, block, bounds, rounding, work)
            step = -value / slope
            nudge(rotor, work.end, step)
            return CONTACT, time + step
        # Steps end half the rounding error below zero: none can pass a crossing that rounding hides.
        # They advance: here 1 ≥ −f > rounding > ROUNDING |ẏ| t and f' ≤ 2|ẏ|, so a step exceeds two spacings of t.
        time += _safe_step(value + 0.5 * rounding, slope, bend, curvature, jerk)
    return CLEAR, block


@inlined
def _safe_step(value, slope, bend, curvature, jerk):
    """Time up to which ``f < 0`` stays negative whatever ``f'' ≤ M₂`` and ``f''' ≤ M₃`` do.

    A bound of ``f''`` that holds only for steps up to `reach` allows longer steps where the path runs close along the
    wall.
    """
    reach = (-value / jerk) ** (1.0 / 3.0)
    nearby = min(reach, _first_root(value, slope, bend + jerk * reach / 3.0))
    return max(nearby, _first_root(value, slope, curvature))


@inlined
def _spread(rotor, station, amplitudes):
    """Sum of the sizes of the terms of a displacement: its rounding error in units of the spacing of doubles."""
    total = abs(rotor.offsets[station].real) + abs(rotor.offsets[station].imag)
    for k in range(amplitudes.shape[0]):
        term = rotor.rows[station, k] * amplitudes[k]
        total += abs(term.real) + abs(term.imag)
    return total


@inlined
def _first_root(value, slope, bend):
    """First positive root of ``value + slope τ + bend τ²/2`` with ``value < 0``; infinite where there is none."""
    square = slope * slope - 2.0 * bend * value
    if square < 0.0 or (slope <= 0.0 and bend <= 0.0):
        return math.inf
    root = math.sqrt(square)
    return -2.0 * value / (root + slope) if slope > 0.0 else (root - slope) / bend


@kernel
def _decide(rotor, table, station, origin, level, time, block, bounds, rounding, work):
    """Decide whether ``f``, which is zero to rounding and has not crossed before, rises above its rounding error.

    ``f`` is followed over intervals on which it provably rises, until the rise exceeds rounding.  The root is then
    found by bisection, because the derivative may be too small for Newton's method.
    """
    first = time
    value, slope, bend = _probe(rotor, table, station, origin, level, time, work)
    while value <= rounding:
        if slope <= 0.0:
            return GRAZING, time
        later = min(time + _rising_time(slope, bend, bounds[1]), block)
        if later == time:
            return (CLEAR if time == block else GRAZING), time
        time = later
        value, slope, bend = _probe(rotor, table, station, origin, level, time, work)
    middle = 0.5 * (first + time)
    while first < middle < time:
        value, _, _ = _probe(rotor, table, station, origin, level, middle, work)
        if value < 0.0:
            first = middle
        else:
            time = middle
        middle = 0.5 * (first + time)
    _probe(rotor, table, station, origin, level, time, work)
    return CONTACT, time


@inlined
def _rising_time(slope, bend, jerk):
    """Time up to which ``f`` rises, if ``f' > 0`` now: root of ``f' + f''τ − M₃τ²/2``, a lower bound of ``f'``."""
    root = math.sqrt(bend * bend + 2.0 * jerk * slope)
    return (root + bend) / jerk if bend > 0.0 else 2.0 * slope / (root - bend)


@inlined
def _departure(slope, bend, jerk):
    """Time after leaving the wall, ``f' < 0`` or ``f' = 0`` and ``f'' < 0``, before which no return is possible.

    First root of ``f' + f''τ/2 + M₃τ²/6``, which bounds ``f/τ`` from above.
    """
    half = 0.5 * bend
    root = math.sqrt(half * half - 2.0 / 3.0 * jerk * slope)
    return -2.0 * slope / (root + half) if half > 0.0 else 3.0 * (root - half) / jerk
