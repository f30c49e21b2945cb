"""What walls that give way take of a rotor's energy, in many states at a time."""

from __future__ import annotations

import math

import numpy as np

from carom.compiling.decorators import inlined, kernel
from carom.core.contact_series import rub_series
from carom.core.flow import squared_modulus
from carom.core.friction import friction_ratio
from carom.core.laws.choice import force, stored_energy
from carom.core.layout import ORDER
from carom.core.phases import ROLLING, lasts, sense_of_phase
from carom.core.wall import wall_of


@kernel
def courses_in_wall(rotor, plane, segments, amplitudes, phases, limited, clocks, times, work, found):
    """Follow a plane through segments (k,) in which it is in its wall, each from its one Taylor series, at times (k, m) after its start.

    ``found`` (6, k, m) receives depth, slip, normal force, friction, the power lost in the wall's damper and the speed of the shaft; of a
    plane that has parted from its wall all but the first and the last are zero.  ``amplitudes``, ``phases`` and ``limited`` are those of all segments,
    ``clocks`` (k,) the instants at the starts of the chosen ones.
    """
    wall, mass = wall_of(rotor, plane), rotor.masses[plane]
    for i in range(segments.shape[0]):
        segment = segments[i]
        if rotor.limit_bounds.shape[0] > 0:
            work.clock = clocks[i]
            work.limited[:] = limited[segment]
        rub_series(rotor, phases[segment], amplitudes[segment], work)
        phase = phases[segment, plane]
        for j in range(times.shape[1]):
            time, shaft = times[i, j], 1.0
            y, v = _sum(work.position[plane], time), _sum(work.speed[plane], time)
            if rotor.shaft.shape[0] > 0:
                shaft = _sum(work.series[:, rotor.shaft[0] + 1], time).real
            radius = math.sqrt(squared_modulus(y))
            depth, rate = radius - 1.0, (y.conjugate() * v).real / radius
            found[:, i, j] = 0.0
            found[0, i, j], found[5, i, j] = depth, shaft
            if lasts(phase):
                push = force(depth, rate, wall)
                grip = _sum(work.grip[plane], time)
                if phase != ROLLING:
                    grip = friction_ratio(sense_of_phase(phase), wall) * push
                found[1, i, j] = _sum(work.slip[plane], time)
                found[2, i, j], found[3, i, j] = mass * push, mass * grip
                found[4, i, j] = mass * (push - force(depth, 0.0, wall)) * rate


@inlined
def _sum(series, time):
    """A real or complex series at a time."""
    total = series[ORDER]
    for k in range(ORDER - 1, -1, -1):
        total = total * time + series[k]
    return total


@kernel
def stored_energies_all(rotor, plane, depths):
    """Energy of the spring of the wall at a plane, (M,), at depths (M,)."""
    wall = wall_of(rotor, plane)
    energies = np.empty_like(depths)
    for i in range(depths.shape[0]):
        energies[i] = rotor.masses[plane] * stored_energy(depths[i], wall)
    return energies
