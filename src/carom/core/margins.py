"""How far the segments of an orbit are from a change of its word: motion at the nodes, and highest points of flights."""

from __future__ import annotations

import math

import numpy as np

from carom.compiling.decorators import inlined, kernel
from carom.core.contact_series import rub_series
from carom.core.flow import acceleration, copy, displacement, flight_increments, squared_modulus, velocity
from carom.core.friction import BACKWARD, FORWARD, margin_of_slip, slip_of, spare_friction, spare_grip
from carom.core.layout import ORDER
from carom.core.phases import AWAY, sense_of_phase
from carom.core.segments import LIFT, ROLL, SLIDE_BACKWARD, SLIDE_FORWARD, in_wall, phase_of, rubs, sense_after, strikes
from carom.core.taylor import series_step, sum_series
from carom.core.variation import strike
from carom.core.wall import local_velocity, unit, wall_of

SAMPLES, PER_RADIAN = 32, 10.0
"""Samples of a flight in the search for its highest point: at least, and per ``|λ|T``."""
FINE = 10
"""Further samples in the first and in the last of these steps, each half as far from the wall in time as the one before.

A flight that leaves a wall to which it is pressed, while this force falls linearly, has its minimum at a third of the time
of the maximum with which it touches the wall again.
"""
HALVINGS = 50
PARTS = 6
"""Parts of a Taylor step, a seventh of its radius of convergence, in each of which a margin has one minimum at most."""
AT_EDGE = 1e-9
"""Time from the ends of a Taylor step within which a minimum cannot be told from rounding, in ``1/Ω``."""


@kernel
def local_motion(rotor, planes, states):
    """Of each state (m, N) at its plane (m,): ``|y|² − 1``, radial speed, slip, normal force, pull along the wall and spare friction."""
    local = np.empty((states.shape[0], 6))
    for i in range(states.shape[0]):
        y, v = displacement(rotor, planes[i], states[i]), velocity(rotor, planes[i], states[i])
        a = acceleration(rotor, planes[i], states[i])
        normal = unit(y)
        local[i, 0] = squared_modulus(y) - 1.0
        local[i, 1] = (normal.conjugate() * v).real
        local[i, 2] = slip_of(normal.conjugate() * v, wall_of(rotor, planes[i]))
        local[i, 3] = (normal.conjugate() * a).real + (normal.conjugate() * v).imag ** 2
        local[i, 4] = (normal.conjugate() * a).imag
        local[i, 5] = spare_friction(normal.conjugate() * v, wall_of(rotor, planes[i]))
    return local


@kernel
def least_margins(rotor, kinds, planes, nodes, durations, landings):
    """Least distances of a word's segments from a change of the word, but for those in walls that give way.

    Parameters
    ----------
    rotor : record
    kinds, planes : int arrays, shape (m,)
        As for :func:`~carom.core.segments.follow_flights`.
    nodes : complex array, shape (m, N)
        Amplitudes at the beginning of each segment.
    durations, landings : array, shape (m,)
        Of the segments; and of each chatter its distance from the onset of lasting contact, below zero if it is interrupted.

    Returns
    -------
    tuple of float
        Depth of the highest maximum of the radius inside a flight, ``1 − |y|²``; radial speed before impacts; slip left after
        impacts, or where friction stops the slip what it could still take; normal force; and distance from the limit of
        friction where rolling begins, or where the slip passes through zero.  Infinite where there is none of the kind.
    """
    m = kinds.shape[0]
    local = local_motion(rotor, planes, nodes)
    radius, approach, slip, push, cone = np.inf, np.inf, np.inf, np.inf, np.inf
    after, still = np.empty(nodes.shape[1], np.complex128), np.empty((0, nodes.shape[1]), np.complex128)
    for i in range(m):
        if in_wall(rotor, kinds[i], planes[i]):
            continue
        radial, pressed, pull = local[i, 1], local[i, 3], local[i, 4]
        wall = wall_of(rotor, planes[i])
        if strikes(kinds[i]) and wall.friction > 0.0:
            slip = min(slip, margin_of_slip(local_velocity(rotor, planes[i], nodes[i]), sense_after(kinds[i]), wall))
        # After a chatter with rebound friction ceases to stop the slip before this limit is reached.
        if kinds[i] == ROLL and (math.isinf(landings[i - 1]) or wall.restitution == 0.0):
            cone = min(cone, spare_grip(pressed, -pull, FORWARD, wall), spare_grip(pressed, -pull, BACKWARD, wall))
        turned = kinds[i - 1] == SLIDE_FORWARD if kinds[i] == SLIDE_BACKWARD else kinds[i - 1] == SLIDE_BACKWARD
        if turned and (kinds[i] == SLIDE_FORWARD or kinds[i] == SLIDE_BACKWARD):
            cone = min(cone, -spare_grip(pressed, -pull, sense_of_phase(phase_of(kinds[i])), wall))
        if rubs(kinds[i]):
            begins = landings[i - 1]
            push = min(push, begins if begins < 0.0 else pressed)
        elif kinds[i] != LIFT:
            approach = min(approach, radial)
        if strikes(kinds[i]) or kinds[i] == LIFT:
            copy(nodes[i], after)
            if strikes(kinds[i]):
                strike(rotor, planes[i], sense_after(kinds[i]), after, still)
            for plane in range(rotor.rows.shape[0]):
                height, _ = highest_point(rotor, plane, after, durations[i])
                if height > -radius:
                    radius = -height
    return radius, approach, slip, push, cone


@kernel
def contact_margins(rotor, kinds, planes, nodes, durations, rub):
    """Least distances of lasting contact on rigid walls from a change of its kind, at the minima inside each segment.

    Parameters
    ----------
    rotor, kinds, planes, nodes, durations
        As for :func:`least_margins`.
    rub : record of :func:`~carom.core.layout.rub_workspace`

    Returns
    -------
    tuple of float
        Normal force, slip in the direction of the sliding, and distance from the limits of friction while rolling; infinite without
        minima.
    """
    push, slip, cone = np.inf, np.inf, np.inf
    state, contact = np.empty(nodes.shape[1], np.complex128), np.empty(rotor.rows.shape[0], np.int64)
    for i in range(kinds.shape[0]):
        if not rubs(kinds[i]) or in_wall(rotor, kinds[i], planes[i]):
            continue
        plane, rolls, sense = planes[i], kinds[i] == ROLL, sense_of_phase(phase_of(kinds[i]))
        wall = wall_of(rotor, plane)
        contact[:] = AWAY
        contact[plane] = phase_of(kinds[i])
        copy(nodes[i], state)
        elapsed = 0.0
        while elapsed < durations[i]:
            rub_series(rotor, contact, state, rub)
            step = min(series_step(rub), durations[i] - elapsed)
            if not step > 0.0:
                return np.nan, np.nan, np.nan
            push = min(push, least_inside(rub.push[plane], step))
            for k in range(ORDER + 1):
                if rolls:
                    rub.first_margin[k] = spare_grip(rub.push[plane, k], rub.grip[plane, k], BACKWARD, wall)
                    rub.second_margin[k] = spare_grip(rub.push[plane, k], rub.grip[plane, k], FORWARD, wall)
                else:
                    rub.first_margin[k] = sense * rub.slip[plane, k]
            if rolls:
                cone = min(cone, least_inside(rub.first_margin, step), least_inside(rub.second_margin, step))
            else:
                slip = min(slip, least_inside(rub.first_margin, step))
            sum_series(rub, step, state)
            elapsed = durations[i] if step == durations[i] - elapsed else elapsed + step
    return push, slip, cone


@inlined
def least_inside(margin, step):
    """Smallest value of the minima of a polynomial inside a step; infinite without any."""
    least, early, before = np.inf, 0.0, _slope(margin, AT_EDGE)
    for i in range(1, PARTS + 1):
        late = step * i / PARTS
        after = _slope(margin, late)
        if before < 0.0 and after >= 0.0:
            low, high = early, late
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                if _slope(margin, middle) < 0.0:
                    low = middle
                else:
                    high = middle
            value = margin[ORDER]
            for k in range(ORDER - 1, -1, -1):
                value = value * high + margin[k]
            # A change of kind begins with a margin of zero that may have no slope: by rounding that is no minimum.
            if AT_EDGE < high < step - AT_EDGE:
                least = min(least, value)
        early, before = late, after
    return least


@inlined
def _slope(margin, time):
    """Derivative of a polynomial."""
    slope = ORDER * margin[ORDER]
    for k in range(ORDER - 1, 0, -1):
        slope = slope * time + k * margin[k]
    return slope


@kernel
def highest_point(rotor, plane, start, duration):
    """Largest ``|y|² − 1`` of the local maxima inside a flight, by samples, and its time; ``nan`` if there is none.

    A flight from rest on the wall begins at such a maximum, which is left out as it lies before the first sample.
    """
    starts, increments = np.empty((1, start.shape[0]), np.complex128), np.empty((1, start.shape[0]), np.complex128)
    copy(start, starts[0])
    fastest = 0.0
    for k in range(start.shape[0]):
        fastest = max(fastest, math.sqrt(squared_modulus(rotor.exponents[k])))
    count = SAMPLES + int(PER_RADIAN * fastest * duration)
    height, top = np.nan, np.nan
    reached = _sample(0, count, duration)
    _, before = _radial(rotor, plane, starts, reached, increments)
    for i in range(1, count + 2 * FINE):
        early, late = reached, _sample(i, count, duration)
        reached = late
        _, after = _radial(rotor, plane, starts, late, increments)
        if before > 0.0 and after < 0.0:
            for _ in range(HALVINGS):
                middle = 0.5 * (early + late)
                _, slope = _radial(rotor, plane, starts, middle, increments)
                if slope > 0.0:
                    early = middle
                else:
                    late = middle
            excess, _ = _radial(rotor, plane, starts, early, increments)
            if not excess <= height:
                height, top = excess, early
        before = after
    return height, top


@inlined
def _sample(i, count, duration):
    """Time of a sample of a flight: of ``count`` steps, the first and the last of which are refined towards its ends."""
    step, refined = duration / count, i - FINE - count + 2
    if i < FINE:
        return step * 0.5 ** (FINE - i)
    if refined < 1:
        return step * (i - FINE + 1)
    return duration - step * 0.5**refined if refined <= FINE else duration


@inlined
def _radial(rotor, plane, starts, time, increments):
    """``|y|² − 1`` and ``Re(ȳẏ)`` of a flight at a time."""
    flight_increments(rotor, starts, time, increments)
    for k in range(starts.shape[1]):
        increments[0, k] += starts[0, k]
    y, v = displacement(rotor, plane, increments[0]), velocity(rotor, plane, increments[0])
    return squared_modulus(y) - 1.0, (y.conjugate() * v).real
