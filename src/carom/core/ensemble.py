"""Many motions in one call: each followed to where it settles, of which only the ending is kept."""

from __future__ import annotations

import numpy as np

from carom.core.advance import advance
from carom.core.fate import forget
from carom.core.flow import displacement, velocity
from carom.core.impact import set_on_wall
from carom.core.layout import kernel, part
from carom.outcome import Outcome, Phase

__all__ = ["follow_each"]

EVENT_LIMIT, FLIGHT = int(Outcome.EVENT_LIMIT), int(Phase.FLIGHT)


@kernel
def follow_each(rotor, table, positions, velocities, planes, until, most_events, endings, log, memory, work, rub):
    """Follow motions of a rotor with two modes one after the other, in place; none depends on another.

    Parameters
    ----------
    rotor, table : records of :mod:`carom.core.layout`
    positions, velocities : complex arrays, shape (M,)
        The starts; on return the ends.
    planes : int array, shape (M,)
        Plane whose wall a start lies on, or −1.
    until : float
        Longest time to follow a motion.
    most_events : int
        Events after which a motion is given up with ``EVENT_LIMIT``, to a whole log.
    endings : tuple of arrays, each of shape (M,)
        Outcome, time, impacts and multiplicity of each motion, as :func:`~carom.core.advance.advance` and its memory
        state them.
    log : tuple of arrays
        Room for events, written over again and again; see :func:`~carom.core.advance.advance`.
    memory, work, rub : records
        As :func:`~carom.core.advance.advance` takes them.
    """
    outcomes, times, impacts, multiplicities = endings
    log_times, log_phases, log_planes, before, after = log
    amplitudes = np.empty(2, np.complex128)
    for start in range(positions.shape[0]):
        _set_state(rotor, positions[start], velocities[start], amplitudes)
        forget(memory)
        if planes[start] >= 0:
            set_on_wall(rotor, planes[start], amplitudes)
        outcome, phase, plane = EVENT_LIMIT, FLIGHT, planes[start]
        reached, events, struck = 0.0, 0, 0
        while outcome == EVENT_LIMIT and events < most_events:
            departed = phase
            outcome, time, count, phase, plane = advance(
                rotor, table, amplitudes, until - reached, phase, plane,
                log_times, log_phases, log_planes, before, after, memory, work, rub,
            )  # fmt: skip
            reached += time
            events += count
            struck += _impacts(departed, log_phases, before, after, count)
        outcomes[start], times[start], impacts[start] = outcome, reached, struck
        multiplicities[start] = memory.period
        positions[start], velocities[start] = displacement(rotor, 0, amplitudes), velocity(rotor, 0, amplitudes)


@part
def _set_state(rotor, position, speed, amplitudes):
    """Amplitudes of two modes with this displacement and velocity at the first plane.

    Not left to array arithmetic, whose last bit depends on the place of a number in its array.
    """
    rows, rates = rotor.rows[0], rotor.rate_rows[0]
    change = position - rotor.offsets[0]
    determinant = rows[0] * rates[1] - rows[1] * rates[0]
    amplitudes[0] = (change * rates[1] - speed * rows[1]) / determinant
    amplitudes[1] = (speed * rows[0] - change * rates[0]) / determinant


@kernel
def _impacts(phase, phases, before, after, count):
    """Number of impacts among logged events that begin in a phase: from flight to flight with a changed state."""
    struck = 0
    for event in range(count):
        if phase == FLIGHT and phases[event] == FLIGHT:
            for k in range(before.shape[1]):
                if before[event, k] != after[event, k]:
                    struck += 1
                    break
        phase = phases[event]
    return struck
