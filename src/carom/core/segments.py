"""Maps of the segments that an orbit consists of, with their exact derivatives, for any linear rotor.

A segment begins with what happens at its node (an impact with a given slip case, a lift-off, the beginning of sliding or
rolling, or the loss of a force) and lasts for a given duration.  Its end has to fulfil a condition: the wall is met, the normal force vanishes,
the slip stops, or the limit of the friction cone is reached.  Neither the kind of a segment nor its duration is decided
here.  So all maps are smooth, even where an impact grazes or the motion is impossible.

A chatter is one segment too.  Its bounces have been followed by :func:`carom.core.advance.advance`; their derivatives are
multiplied here (:func:`carry_through_chatter`).

Directions are changes of the amplitudes, to which everything here is real-linear: those by which each of the ``S`` coordinates and
rates changes by ``1`` and by ``i``, ``2S`` in all, stand for the derivative.
"""

from __future__ import annotations

import math

import numpy as np

from carom.compiling.decorators import inlined, kernel
from carom.core.contact_series import rub_series
from carom.core.flow import acceleration, displacement, flight_increments, squared_modulus, velocity
from carom.core.friction import BACKWARD, FORWARD, STOPPED, friction_ratio, rolling_force, slip_of, spare_grip
from carom.core.layout import ORDER
from carom.core.phases import AWAY, BACKWARD_SLIP, FORWARD_SLIP, ROLLING, SEPARATED, sense_of_phase
from carom.core.taylor import series_step, sum_series
from carom.core.variation import blow, carry_through_impact, carry_to_wall, strike
from carom.core.wall import move_plane, rigid_wall, unit, wall_of, yields

IMPACT_FORWARD, IMPACT_BACKWARD, IMPACT_STOPPED, LIFT, LAND, SLIDE_FORWARD, SLIDE_BACKWARD, ROLL, FREE = range(9)
"""Kinds of segments; of the last, a plane has parted from a wall that gives way, and is still inside its place."""
NO_CONDITION, MEETS_WALL, LEAVES, NO_SLIP, CONE_FORWARD, CONE_BACKWARD, LEAST_PUSH, PARTS = range(8)
"""Conditions at the end: the plane leaves its wall where the normal force vanishes, or the depth in a wall that gives way; two are the
limits of the friction cone beyond which forward or backward slip begins; at ``LEAST_PUSH`` the normal force is least, and the same
sliding goes on; at ``PARTS`` the force of a wall that gives way vanishes, or is back."""

MOST_STEPS = 2000
"""Taylor steps of one stretch of lasting contact, beyond which it is not followed; a turn of the shaft takes some thirty."""


@kernel
def follow_flights(rotor, basis, to_modes, rest, kinds, planes, targets, nodes, durations, arrivals, values, slopes):
    """Follow each impact and flight from its node, with the derivatives of its end, where the wall is to be met.

    Parameters
    ----------
    rotor : record of :func:`~carom.core.layout.rotor_record`
    basis, to_modes : complex arrays, shape (S, N) and (N, S)
        State (coordinates, then their rates) per amplitude, and amplitudes per state.
    rest : complex array, shape (S,)
        State whose amplitudes are zero.
    kinds, planes : int arrays, shape (m,)
        Kind of each segment and plane of the contact at its beginning; segments that do not fly are left out.
    targets : int array, shape (m,)
        Plane at whose wall it ends.
    nodes : complex array, shape (m, S)
        States at the beginning: just before the impact.
    durations : array, shape (m,)
    arrivals : complex array, shape (m, S)
        Overwritten: states at the end.
    values : array, shape (m,)
        Overwritten: value of the condition, ``(|y|² − 1)/2``.
    slopes : array, shape (m, 2S + 1, 2S + 1)
        Overwritten: derivative of real and imaginary parts of the end, then of the condition, by those of the node, then
        by the duration.
    """
    modes, last = to_modes.shape[0], 2 * nodes.shape[1]
    moved, increments = np.empty((last + 1, modes), np.complex128), np.empty((last + 1, modes), np.complex128)
    rate = np.empty(modes, np.complex128)
    for i in range(kinds.shape[0]):
        if not strikes(kinds[i]) and kinds[i] != LIFT:
            continue
        directions = set_out(to_modes, rest, nodes[i], moved)
        if strikes(kinds[i]):
            strike(rotor, planes[i], sense_after(kinds[i]), moved[last], directions)
        flight_increments(rotor, moved, durations[i], increments)
        for row in range(last + 1):
            for k in range(modes):
                moved[row, k] += increments[row, k]
        _flight_rate(rotor, moved[last], rate)
        hand_over(basis, rest, moved, rate, arrivals[i], slopes[i])
        y = displacement(rotor, targets[i], moved[last])
        values[i] = 0.5 * (squared_modulus(y) - 1.0)
        for row in range(last + 1):
            part_of_y = 0j
            for k in range(modes):
                part_of_y += rotor.rows[targets[i], k] * (rate[k] if row == last else moved[row, k])
            slopes[i, last, row] = (y.conjugate() * part_of_y).real


@kernel
def follow_contact(rotor, basis, to_modes, rest, kinds, planes, ends, nodes, durations, rub, arrivals, values, slopes):
    """:func:`follow_flights` for sliding and rolling on one rigid wall; ``ends`` are the conditions at their ends.

    ``rub`` is a record of :func:`~carom.core.layout.rub_workspace`.
    """
    modes, last = to_modes.shape[0], 2 * nodes.shape[1]
    moved, rate = np.empty((last + 1, modes), np.complex128), np.empty(modes, np.complex128)
    contact = np.empty(rotor.rows.shape[0], np.int64)
    for i in range(kinds.shape[0]):
        if not rubs(kinds[i]) or yields(rotor, planes[i]):
            continue
        directions, phase = set_out(to_modes, rest, nodes[i], moved), phase_of(kinds[i])
        _rest(rotor, planes[i], moved[last], directions, 0.0, sense_of_phase(phase))
        contact[:] = AWAY
        contact[planes[i]] = phase
        normal = slopes[i, last]
        change = _slide(rotor, contact, planes[i], durations[i], moved[last], directions, rate, normal, rub)
        hand_over(basis, rest, moved, rate, arrivals[i], slopes[i])
        if ends[i] == LEAST_PUSH:
            values[i] = change
            continue
        values[i] = _condition(rotor, planes[i], ends[i], moved[last], directions, rate, normal)


@inlined
def phase_of(kind):
    """Phase of a segment that stays at its wall."""
    if kind == ROLL:
        return ROLLING
    if kind == FREE:
        return SEPARATED
    return FORWARD_SLIP if kind == SLIDE_FORWARD else BACKWARD_SLIP


@inlined
def set_out(to_modes, rest, node, moved):
    """Write the amplitudes of a unit change of each real and imaginary part of the state, and in the last row those of the state.

    Return the rows of the changes.
    """
    size = node.shape[0]
    for k in range(to_modes.shape[0]):
        moved[2 * size, k] = 0j
        for j in range(size):
            moved[j, k], moved[size + j, k] = to_modes[k, j], 1j * to_modes[k, j]
            moved[2 * size, k] += to_modes[k, j] * (node[j] - rest[j])
    return moved[: 2 * size]


@inlined
def hand_over(basis, rest, moved, rate, arrival, slopes):
    """Write the state from its amplitudes, and the derivatives of its real and imaginary parts."""
    size, modes = basis.shape
    for j in range(size):
        for row in range(2 * size + 1):
            change = 0j
            for k in range(modes):
                change += basis[j, k] * (rate[k] if row == 2 * size else moved[row, k])
            slopes[j, row], slopes[size + j, row] = change.real, change.imag
        arrival[j] = rest[j]
        for k in range(modes):
            arrival[j] += basis[j, k] * moved[2 * size, k]


@inlined
def strikes(kind):
    """Whether a segment begins with an impact."""
    return kind in (IMPACT_FORWARD, IMPACT_BACKWARD, IMPACT_STOPPED)


@inlined
def rubs(kind):
    """Whether a segment is lasting contact."""
    return kind in (SLIDE_FORWARD, SLIDE_BACKWARD, ROLL)


@inlined
def in_wall(rotor, kind, plane):
    """Whether a segment lies inside the place of a wall that gives way."""
    return kind == FREE or (rubs(kind) and yields(rotor, plane))


@inlined
def sense_after(kind):
    """Sense of the slip after the impact of a segment that begins with one."""
    if kind == IMPACT_STOPPED:
        return STOPPED
    return FORWARD if kind == IMPACT_FORWARD else BACKWARD


@kernel
def _rest(rotor, plane, state, directions, friction, sense):
    """Put a plane to rest on its wall, in place, by an impulse with this friction and sense of the slip."""
    position = displacement(rotor, plane, state)
    normal, radius = unit(position), math.sqrt(squared_modulus(position))
    for row in range(directions.shape[0]):
        moved = displacement(rotor, plane, directions[row]) - rotor.offsets[plane]
        shift = 1j * normal * ((normal.conjugate() * moved).imag / radius) - moved
        move_plane(rotor, plane, shift, directions[row])
    move_plane(rotor, plane, normal - position, state)
    blow(rotor, plane, rigid_wall(friction, 0.0, rotor.surface_speed[plane]), sense, state, directions)


@inlined
def _flight_rate(rotor, state, rate):
    """Write ``ċ`` of a flight."""
    for k in range(state.shape[0]):
        rate[k] = rotor.exponents[k] * state[k]
        if rotor.driven[k]:
            rate[k] += state[k - 1]


@kernel
def _slide(rotor, contact, plane, duration, state, directions, rate, falls, rub):
    """Lasting contact at one plane for a given duration, in place; ``rate`` receives ``ċ`` at the end.

    Returns the rate of the normal force at the end; ``falls`` receives its derivatives by the directions and by the duration, which
    mean nothing for rolling.
    """
    modes, elapsed, steps = state.shape[0], 0.0, 0
    series = np.empty((ORDER + 1, modes), np.complex128)
    moved = np.empty((4, ORDER + 1), np.complex128)
    push = np.empty(ORDER + 1)
    while True:
        rub_series(rotor, contact, state, rub)
        largest = series_step(rub)
        left = duration - elapsed
        steps += 1
        if steps > MOST_STEPS or not largest > 0.0:
            # Sliding may run away in a finite time, backward in time sooner than forward.
            state[:], rate[:], falls[:] = np.nan, np.nan, np.nan
            return np.nan
        step = min(largest, left) if left >= 0.0 else max(-largest, left)
        for row in range(directions.shape[0]):
            for k in range(modes):
                series[0, k] = directions[row, k]
            _varied_series(rotor, contact[plane], plane, rub, series, moved, push)
            for k in range(modes):
                total = series[ORDER, k]
                for j in range(ORDER - 1, -1, -1):
                    total = total * step + series[j, k]
                directions[row, k] = total
        sum_series(rub, step, state)
        elapsed += step
        if step == left:
            break
    rub_series(rotor, contact, state, rub)
    for k in range(modes):
        rate[k] = rub.series[1, k]
    for row in range(directions.shape[0]):
        for k in range(modes):
            series[0, k] = directions[row, k]
        _varied_series(rotor, contact[plane], plane, rub, series, moved, push)
        falls[row] = push[1]
    falls[directions.shape[0]] = 2.0 * rub.push[plane, 2]
    return rub.push[plane, 1]


@inlined
def _varied_series(rotor, phase, plane, rub, series, moved, push):
    """Taylor coefficients of a small change of a motion in lasting contact; those of order zero are given."""
    position, speed, free, force = moved[0], moved[1], moved[2], moved[3]
    wall = wall_of(rotor, plane)
    sliding = complex(-1.0, friction_ratio(sense_of_phase(phase), wall))
    for k in range(ORDER):
        position[k], speed[k], free[k], force[k], push[k] = 0j, 0j, 0j, 0j, 0.0
        for m in range(series.shape[1]):
            position[k] += rotor.rows[plane, m] * series[k, m]
            speed[k] += rotor.rate_rows[plane, m] * series[k, m]
            free[k] += rotor.acceleration_rows[plane, m] * series[k, m]
        if phase == ROLLING:
            force[k] = rolling_force(position[k], free[k], wall)
        else:
            for j in range(k + 1):
                y, v = rub.position[plane, j], rub.speed[plane, j]
                push[k] += (position[k - j].conjugate() * rub.free[plane, j] + y.conjugate() * free[k - j]).real
                push[k] += 2.0 * (v.conjugate() * speed[k - j]).real
            for j in range(k + 1):
                force[k] += sliding * (push[j] * rub.position[plane, k - j] + rub.push[plane, j] * position[k - j])
        for m in range(series.shape[1]):
            change = rotor.exponents[m] * series[k, m] + rotor.columns[m, plane] * force[k]
            if rotor.driven[m]:
                change += series[k, m - 1]
            series[k + 1, m] = change / (k + 1)


@kernel
def _condition(rotor, plane, end, state, directions, rate, normal):
    """Value of the condition at the end; ``normal`` receives its derivatives by the directions and by the duration."""
    y, v, a = displacement(rotor, plane, state), velocity(rotor, plane, state), acceleration(rotor, plane, state)
    wall, last = wall_of(rotor, plane), directions.shape[0]
    for row in range(last + 1):
        change = rate if row == last else directions[row]
        dy = displacement(rotor, plane, change) - rotor.offsets[plane]
        dv, da = velocity(rotor, plane, change), acceleration(rotor, plane, change)
        dpush = (dy.conjugate() * a + y.conjugate() * da).real + 2.0 * (v.conjugate() * dv).real
        dpull = (dy.conjugate() * a + y.conjugate() * da).imag
        dslip = (dy.conjugate() * v + y.conjugate() * dv).imag
        normal[row] = _chosen(end, wall, (y.conjugate() * dy).real, dpush, dpull, dslip)
    push = (y.conjugate() * a).real + squared_modulus(v)
    gap = 0.5 * (squared_modulus(y) - 1.0)
    return _chosen(end, wall, gap, push, (y.conjugate() * a).imag, slip_of(y.conjugate() * v, wall))


@inlined
def _chosen(end, wall, gap, push, pull, slip):
    """The condition of this kind, or its derivative."""
    if end == MEETS_WALL:
        return gap
    if end == LEAVES:
        return push
    if end == NO_SLIP:
        return slip
    if end == CONE_FORWARD:
        return spare_grip(push, -pull, FORWARD, wall)
    if end == CONE_BACKWARD:
        return spare_grip(push, -pull, BACKWARD, wall)
    return 0.0


@kernel
def carry_through_chatter(rotor, plane, arrivals, durations, landing, slip, directions, delays):
    """Carry directions through the bounces of a chatter and its completion.

    Parameters
    ----------
    rotor : record
    plane : int
    arrivals : complex array, shape (B, N)
        Amplitudes just before each bounce; the directions belong to the first.
    durations : array, shape (B − 1,)
        Times between the bounces.
    landing : complex array, shape (N,)
        Amplitudes just after the last bounce; overwritten by those of lasting contact.
    slip : {FORWARD, BACKWARD, STOPPED}
        Sense of the slip at the landing.  The last impact has the same, whatever its state says.
    directions : complex array, shape (2S, N)
        Overwritten.
    delays : array, shape (2S,)
        Overwritten: derivative of the duration of the chatter.
    """
    later = np.empty_like(delays)
    delays[:] = 0.0
    for bounce in range(arrivals.shape[0] - 1):
        carry_through_impact(rotor, plane, arrivals[bounce], directions)
        carry_to_wall(rotor, plane, durations[bounce], arrivals[bounce + 1], directions, later)
        for row in range(delays.shape[0]):
            delays[row] += later[row]
    strike(rotor, plane, slip, arrivals[-1].copy(), directions)
    _rest(rotor, plane, landing, directions, rotor.friction[plane], slip)
