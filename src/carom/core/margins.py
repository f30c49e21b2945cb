"""How far the segments of an orbit are from a change of its word: motion at the nodes, and highest points of flights."""

from __future__ import annotations

import math

import numpy as np

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import copy, displacement, flight_increments, squared_modulus, velocity
from carom.core.friction import friction_margin, margin_of_slip, slip_of
from carom.core.segments import sense_after
from carom.core.variation import apply_impact
from carom.core.wall import local_velocity, unit, wall_of

SAMPLES, PER_RADIAN = 32, 10.0
"""Samples of a flight in the search for its highest point: at least, and per ``|λ|T``."""
FINE = 10
"""Further samples in the first and in the last of these steps, each half as far from the wall in time as the one before.

A flight that leaves a wall to which it is pressed, while this force falls linearly, has its minimum at a third of the time
of the maximum with which it reaches the wall again.
"""
HALVINGS = 50


@kernel
def local_motion(rotor, stations, states):
    """Of each state (m, N) at its station (m,): radial speed, slip and margin of friction."""
    local = np.empty((states.shape[0], 3))
    for i in range(states.shape[0]):
        y, v = displacement(rotor, stations[i], states[i]), velocity(rotor, stations[i], states[i])
        speed = unit(y).conjugate() * v
        local[i, 0] = speed.real
        local[i, 1] = slip_of(speed, wall_of(rotor, stations[i]))
        local[i, 2] = friction_margin(speed, wall_of(rotor, stations[i]))
    return local


@kernel
def least_margins(rotor, kinds, stations, nodes, durations):
    """Least distances of a word's segments from a change of the word.

    Parameters
    ----------
    rotor : record
    kinds, stations : int arrays, shape (m,)
        As for :func:`~carom.core.segments.follow_flights`.
    nodes : complex array, shape (m, N)
        Amplitudes at the beginning of each segment.
    durations : array, shape (m,)

    Returns
    -------
    tuple of float
        Depth of the highest maximum of the radius inside a flight, ``1 − |y|²``; radial speed before impacts; and slip left after
        impacts, or where friction stops the slip what it could still take.  Infinite where there is none of the kind.
    """
    local = local_motion(rotor, stations, nodes)
    radius, approach, slip = np.inf, np.inf, np.inf
    after, still = np.empty(nodes.shape[1], np.complex128), np.empty((0, nodes.shape[1]), np.complex128)
    for i in range(kinds.shape[0]):
        wall, sense = wall_of(rotor, stations[i]), sense_after(kinds[i])
        if wall.friction > 0.0:
            slip = min(slip, margin_of_slip(local_velocity(rotor, stations[i], nodes[i]), sense, wall))
        approach = min(approach, local[i, 0])
        copy(nodes[i], after)
        apply_impact(rotor, stations[i], sense, after, still)
        for station in range(rotor.rows.shape[0]):
            height, _ = highest_point(rotor, station, after, durations[i])
            if height > -radius:
                radius = -height
    return radius, approach, slip


@kernel
def highest_point(rotor, station, start, duration):
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
    _, before = _radial(rotor, station, starts, reached, increments)
    for i in range(1, count + 2 * FINE):
        early, late = reached, _sample(i, count, duration)
        reached = late
        _, after = _radial(rotor, station, starts, late, increments)
        if before > 0.0 and after < 0.0:
            for _ in range(HALVINGS):
                middle = 0.5 * (early + late)
                _, slope = _radial(rotor, station, starts, middle, increments)
                if slope > 0.0:
                    early = middle
                else:
                    late = middle
            excess, _ = _radial(rotor, station, starts, early, increments)
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
def _radial(rotor, station, starts, time, increments):
    """``|y|² − 1`` and ``Re(ȳẏ)`` of a flight at a time."""
    flight_increments(rotor, starts, time, increments)
    for k in range(starts.shape[1]):
        increments[0, k] += starts[0, k]
    y, v = displacement(rotor, station, increments[0]), velocity(rotor, station, increments[0])
    return squared_modulus(y) - 1.0, (y.conjugate() * v).real
