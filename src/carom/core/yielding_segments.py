"""Maps of the segments of an orbit in walls that give way, with their exact derivatives, for any linear rotor.

Such a segment slides or rolls in the wall, or has parted from it and comes back without force (:mod:`carom.core.compliance`).  A small
change of the motion has Taylor series of its own, by the derivatives of the recurrences of :mod:`carom.core.contact_series`:
of ``r² = |y|²``, of ``rn = y``, of the law's force (:mod:`carom.core.laws.choice.force_change`), and of the friction that rolling needs.
"""

from __future__ import annotations

import numpy as np

from carom.compiling.decorators import inlined, kernel
from carom.core.compliance import next_form
from carom.core.contact_series import rub_series
from carom.core.flow import flight_increments
from carom.core.friction import BACKWARD, FORWARD, friction_ratio, spare_grip
from carom.core.laws.choice import force_change, force_rounding, press_coefficient, press_rounding
from carom.core.layout import ORDER
from carom.core.phases import AWAY, ROLLING, SEPARATED, sense_of_phase
from carom.core.segments import (
    CONE_FORWARD,
    FREE,
    LEAST_PUSH,
    LEAVES,
    MOST_STEPS,
    NO_SLIP,
    PARTS,
    hand_over,
    in_wall,
    phase_of,
    set_out,
)
from carom.core.taylor import margin_step, series_step, sum_series
from carom.core.wall import wall_of

POSITION, SPEED, ACCELERATION, NORMAL, LOCAL, PULL = range(6)
"""Complex series of a small change: of position, speed and free acceleration of the plane, ``n``, ``n̄ẏ`` and contact force."""
DEPTH, RATE, POWER, PUSH, TURNING, GRIP, SLIP = range(7)
"""Real ones: of depth, its rate, the power of it that the law has, normal force, turning of ``n``, friction and slip."""


@kernel
def follow_in_walls(rotor, basis, to_modes, rest, kinds, planes, ends, nodes, durations, rub, arrivals, values, slopes):
    """:func:`~carom.core.segments.follow_contact` for segments in walls that give way, from wherever their nodes are.

    The conditions are divided by the stiffness where they are forces, so that the residuals of all are of one size.
    """
    modes, last = to_modes.shape[0], 2 * nodes.shape[1]
    moved, rate = np.empty((last + 1, modes), np.complex128), np.empty(modes, np.complex128)
    contact = np.empty(rotor.rows.shape[0], np.int64)
    varied, real = np.empty((6, ORDER + 1), np.complex128), np.empty((7, ORDER + 1))
    series = np.empty((ORDER + 1, modes), np.complex128)
    for i in range(kinds.shape[0]):
        if not in_wall(rotor, kinds[i], planes[i]):
            continue
        plane, directions = planes[i], set_out(to_modes, rest, nodes[i], moved)
        contact[:] = AWAY
        contact[plane] = phase_of(kinds[i])
        if kinds[i] == FREE:
            _fly(rotor, moved, durations[i])
        elif not _march(rotor, contact, plane, durations[i], moved[last], directions, series, varied, real, rub):
            arrivals[i], values[i], slopes[i] = np.nan, np.nan, np.nan
            continue
        rub_series(rotor, contact, moved[last], rub)
        for k in range(modes):
            rate[k] = rub.series[1, k]
        hand_over(basis, rest, moved, rate, arrivals[i], slopes[i])
        wall = wall_of(rotor, plane)
        for row in range(last):
            for k in range(modes):
                series[0, k] = directions[row, k]
            _varied_series(rotor, contact[plane], plane, 1, rub, series, varied, real)
            slopes[i, last, row] = _change(
                ends[i], wall, 0, real[DEPTH], real[RATE], real[SLIP], real[PUSH], real[GRIP]
            )
        at = rub.depth[plane], rub.rate[plane], rub.slip[plane], rub.push[plane], rub.grip[plane]
        slopes[i, last, last] = _change(ends[i], wall, 1, *at)
        values[i] = _value(ends[i], wall, *at)


@inlined
def _fly(rotor, moved, duration):
    """Flight of changes, and of the state in the last row, in place."""
    increments = np.empty_like(moved)
    flight_increments(rotor, moved, duration, increments)
    for row in range(moved.shape[0]):
        for k in range(moved.shape[1]):
            moved[row, k] += increments[row, k]


@kernel
def _march(rotor, contact, plane, duration, state, directions, series, varied, real, rub):
    """Follow lasting contact in a wall for a given duration, in place; return whether there is a motion of that length."""
    elapsed, modes = 0.0, state.shape[0]
    for _ in range(MOST_STEPS):
        rub_series(rotor, contact, state, rub)
        largest, left = min(series_step(rub), margin_step(rub.depth[plane])), duration - elapsed
        if not largest > 0.0:
            return False
        step = next_form(rotor, plane, min(largest, left), rub) if left >= 0.0 else max(-largest, left)
        for row in range(directions.shape[0]):
            for k in range(modes):
                series[0, k] = directions[row, k]
            _varied_series(rotor, contact[plane], plane, ORDER, rub, series, varied, real)
            for k in range(modes):
                total = series[ORDER, k]
                for j in range(ORDER - 1, -1, -1):
                    total = total * step + series[j, k]
                directions[row, k] = total
        sum_series(rub, step, state)
        elapsed += step
        if step == left:
            return True
    return False


@inlined
def _varied_series(rotor, phase, plane, order, rub, series, varied, real):
    """Taylor coefficients, up to an order, of a small change of a motion in a wall; those of order zero are given."""
    for k in range(order + 1):
        position, speed, free = 0j, 0j, 0j
        for m in range(series.shape[1]):
            position += rotor.rows[plane, m] * series[k, m]
            speed += rotor.rate_rows[plane, m] * series[k, m]
            free += rotor.acceleration_rows[plane, m] * series[k, m]
        varied[POSITION, k], varied[SPEED, k], varied[ACCELERATION, k] = position, speed, free
        _indent(plane, k, rub, varied, real)
        _press(phase, plane, k, wall_of(rotor, plane), rub, varied, real)
        if k < order:
            for m in range(series.shape[1]):
                change = rotor.exponents[m] * series[k, m] + rotor.columns[m, plane] * varied[PULL, k]
                if rotor.driven[m]:
                    change += series[k, m - 1]
                series[k + 1, m] = change / (k + 1)


@inlined
def _indent(plane, k, rub, varied, real):
    """Coefficients ``k`` of the changes of depth, normal, local velocity and slip; see :func:`~carom.core.compliance.indent`."""
    radius, size = 1.0 + rub.depth[plane, 0], 0.0
    for j in range(k + 1):
        size += (rub.position[plane, j].conjugate() * varied[POSITION, k - j]).real
    for j in range(1, k + 1):
        size -= rub.depth[plane, j] * real[DEPTH, k - j]
    real[DEPTH, k] = size / radius
    direction, local = varied[POSITION, k], 0j
    for j in range(k + 1):
        direction -= real[DEPTH, j] * rub.normal[plane, k - j]
    for j in range(1, k + 1):
        direction -= rub.depth[plane, j] * varied[NORMAL, k - j]
    varied[NORMAL, k] = complex(direction.real / radius, direction.imag / radius)
    for j in range(k + 1):
        local += varied[NORMAL, j].conjugate() * rub.speed[plane, k - j]
        local += rub.normal[plane, j].conjugate() * varied[SPEED, k - j]
    varied[LOCAL, k], real[RATE, k] = local, local.real
    real[SLIP, k] = local.imag + real[DEPTH, k]


@inlined
def _press(phase, plane, k, wall, rub, varied, real):
    """Coefficients ``k`` of the changes of normal force, friction and contact force."""
    varied[PULL, k], real[PUSH, k], real[GRIP, k] = 0j, 0.0, 0.0
    if phase == SEPARATED:
        return
    at = rub.depth[plane], rub.rate[plane], rub.power[plane], real[DEPTH], real[RATE], real[POWER]
    real[PUSH, k] = force_change(k, *at, wall)
    if phase == ROLLING:
        real[GRIP, k] = _rolling_grip(plane, k, rub, varied, real)
    else:
        real[GRIP, k] = friction_ratio(sense_of_phase(phase), wall) * real[PUSH, k]
    pull = 0j
    for j in range(k + 1):
        pull += complex(-real[PUSH, j], real[GRIP, j]) * rub.normal[plane, k - j]
        pull += complex(-rub.push[plane, j], rub.grip[plane, j]) * varied[NORMAL, k - j]
    varied[PULL, k] = pull


@inlined
def _rolling_grip(plane, k, rub, varied, real):
    """Coefficient ``k`` of the change of the friction that rolling needs; see :func:`~carom.core.compliance.rolling_grip`."""
    turning, grip = varied[LOCAL, k].imag, -real[RATE, k]
    for j in range(k + 1):
        turning -= real[DEPTH, j] * rub.turning[plane, k - j]
    for j in range(1, k + 1):
        turning -= rub.depth[plane, j] * real[TURNING, k - j]
    real[TURNING, k] = turning / (1.0 + rub.depth[plane, 0])
    for j in range(k + 1):
        grip += real[TURNING, j] * rub.rate[plane, k - j] + rub.turning[plane, j] * real[RATE, k - j]
        grip -= (varied[NORMAL, j].conjugate() * rub.free[plane, k - j]).imag
        grip -= (rub.normal[plane, j].conjugate() * varied[ACCELERATION, k - j]).imag
    return grip


@inlined
def _scale(end, wall):
    """Size of a condition that is a force, per unit of depth and rate; 1 for others."""
    scale = 1.0
    if end == PARTS:
        scale = press_rounding(1.0, 1.0, wall)
    elif end not in (LEAVES, NO_SLIP):
        scale = force_rounding(1.0, 1.0, wall)
    return scale if scale > 0.0 else 1.0


@inlined
def _value(end, wall, depth, rate, slip, push, grip):
    """Value of the condition at the end, from the series there."""
    if end == LEAVES:
        return depth[0]
    if end == NO_SLIP:
        return slip[0]
    if end == PARTS:
        value = press_coefficient(0, depth, rate, wall)
    elif end == LEAST_PUSH:
        value = push[1]
    else:
        value = spare_grip(push[0], grip[0], FORWARD if end == CONE_FORWARD else BACKWARD, wall)
    return value / _scale(end, wall)


@inlined
def _change(end, wall, k, depth, rate, slip, push, grip):
    """How the condition changes: with time from coefficients ``k = 1`` of the motion, otherwise from the start, 0, of a change of it."""
    if end == LEAVES:
        return depth[k]
    if end == NO_SLIP:
        return slip[k]
    if end == PARTS:
        # From its first coefficient on, it is linear in depth and rate.
        value = press_coefficient(1, np.array([0.0, depth[k]]), np.array([0.0, rate[k]]), wall)
    elif end == LEAST_PUSH:
        value = (k + 1) * push[k + 1]
    else:
        value = spare_grip(push[k], grip[k], FORWARD if end == CONE_FORWARD else BACKWARD, wall)
    return value / _scale(end, wall)
