"""What lasting contact does in each step of a motion: impulses, works and largest loads, from the one Taylor series of the step."""

from __future__ import annotations

import numpy as np

from carom.core.compiling.decorators import inlined, kernel
from carom.core.contact_series import rub_series
from carom.core.friction import friction_ratio
from carom.core.laws.choice import force, stored_energy
from carom.core.layout import ORDER
from carom.core.phases import ROLLING, lasts, sense_of_phase, stays
from carom.core.wall import is_compliant, wall_of

COLUMNS = 10
NORMAL, FRICTION, HEAT, DAMPED, DRIVEN, FORCE, FORCE_TIME, DEPTH, POWER, ROLLED = range(COLUMNS)
"""What is found of a step: impulses of normal force and friction, heat of friction, work lost in the wall's damper, integral of the friction times
the speed of the shaft; largest normal force and its time, largest depth and largest power of friction; integral of the cube of the normal
force times the surface speed of a race that turns."""
_COUNT = 8
"""Nodes of a step: its series fall by a factor of thirty from one Legendre term to the next, so that products of two are exact to rounding."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_COUNT)
POINTS, SHARES = np.array([0.0, *(0.5 + 0.5 * _NODES), 1.0]), np.array([0.0, *(0.5 * _WEIGHTS), 0.0])
"""Places in a step, its ends among them, and their shares in an integral over it."""
_NEWTON_STEPS = 5
"""From the highest point these leave no more than rounding of a maximum that a step can have."""


@kernel
def contact_works_all(rotor, segments, amplitudes, phases, limited, clocks, durations, work, found):
    """What contact does at all stations in chosen segments (k,) of a motion, each of a duration (k,) and from an instant (k,).

    ``amplitudes``, ``phases`` and ``limited`` are those of all segments.  ``found`` (k, P, 9) receives the columns above; of a station that
    has parted from its wall the depth alone, zero of one in flight.
    """
    found[:] = 0.0
    for i in range(segments.shape[0]):
        segment = segments[i]
        if rotor.limit_bounds.shape[0] > 0:
            work.clock = clocks[i]
            work.limited[:] = limited[segment]
        rub_series(rotor, phases[segment], amplitudes[segment], work)
        for station in range(phases.shape[1]):
            phase = phases[segment, station]
            if stays(phase) and is_compliant(rotor, station):
                found[i, station, DEPTH] = _highest(work.depth[station], durations[i])[0]
            if lasts(phase):
                _contact(rotor, station, phase, durations[i], work, found[i, station])


@inlined
def _contact(rotor, station, phase, duration, work, found):
    """Add up what a station in contact does in a step."""
    wall, mass, soft = wall_of(rotor, station), rotor.masses[station], is_compliant(rotor, station)
    race = rotor.race[station]
    if phase != ROLLING:
        ratio = friction_ratio(sense_of_phase(phase), wall)
        for k in range(ORDER + 1):
            work.grip[station, k] = ratio * work.push[station, k]
    for j in range(1, POINTS.shape[0] - 1):
        time, share = duration * POINTS[j], mass * duration * SHARES[j]
        push, grip = _sum(work.push[station], time), _sum(work.grip[station], time)
        shaft = 1.0
        if rotor.shaft.shape[0] > 0:
            shaft = _sum(work.series[:, rotor.shaft[0] + 1], time).real
        found[NORMAL] += share * push
        found[FRICTION] += share * grip
        found[DRIVEN] += share * grip * shaft
        if phase != ROLLING:
            found[HEAT] -= share * grip * _sum(work.slip[station], time)
        if race >= 0:
            found[ROLLED] += duration * SHARES[j] * (mass * push) ** 3 * abs(_sum(work.series[:, race], time).real)
        if soft:
            lost = push - force(_sum(work.depth[station], time), 0.0, wall)
            found[DAMPED] += share * lost * _sum(work.rate[station], time)
    top, time = _highest(work.push[station], duration)
    found[FORCE], found[FORCE_TIME] = mass * top, time
    if phase != ROLLING:
        for k in range(ORDER + 1):
            power = 0.0
            for j in range(k + 1):
                power -= work.grip[station, j] * work.slip[station, k - j]
            work.first_margin[k] = power
        found[POWER] = mass * _highest(work.first_margin, duration)[0]


@inlined
def _highest(series, duration):
    """Largest value of a real series within a step, and its time."""
    best, at = series[0], 0.0
    for j in range(1, POINTS.shape[0]):
        value = _sum(series, duration * POINTS[j])
        if value > best:
            best, at = value, duration * POINTS[j]
    time = at
    for _ in range(_NEWTON_STEPS):
        slope, bend = 0.0, 0.0
        for k in range(ORDER, 1, -1):
            slope = slope * time + k * series[k]
            bend = bend * time + k * (k - 1) * series[k]
        slope = slope * time + series[1]
        if bend >= 0.0 or (time == 0.0 and slope <= 0.0) or (time == duration and slope >= 0.0):
            break
        time = min(max(time - slope / bend, 0.0), duration)
    value = _sum(series, time)
    if value > best:
        best, at = value, time
    return best, at


@inlined
def _sum(series, time):
    """A real or complex series at a time."""
    total = series[ORDER]
    for k in range(ORDER - 1, -1, -1):
        total = total * time + series[k]
    return total


@kernel
def stored_energies_all(rotor, station, depths):
    """Energy of the spring of the wall at a station, (M,), at depths (M,)."""
    wall = wall_of(rotor, station)
    energies = np.empty_like(depths)
    for i in range(depths.shape[0]):
        energies[i] = rotor.masses[station] * stored_energy(depths[i], wall)
    return energies
