"""Impacts per period of a motion that has recurred, or that it leaves again, for rotors whose orbits no kernel closes."""

from __future__ import annotations

import numpy as np

from carom.base.outcome import Outcome
from carom.core.advance import advance
from carom.core.closing import PASSES
from carom.core.contact_events import SHORTEST_LAP
from carom.core.event_log import EventLog
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import FLIGHT
from carom.core.settling import memory
from carom.models import System

FOLLOWED, MOST_IMPACTS = 16, 4000
"""Recurrences, and impacts, for which a motion is followed further."""
REPEATS = 1e-6
"""Distance, relative to one plus the size of the state, below which a motion repeats within its recurrence.

Far above the tolerance of recurrence: a motion that approaches its orbit from alternating sides recurs after two periods first.
"""
GROWS, ROUNDING = 2.0, 1e-12
"""Growth of the change from one recurrence to a later one that shows a repelling orbit, if it is above rounding."""
FOLLOWED_TIME, LOGGED, MOST_EVENTS = 1e5, 256, 100_000


def least_recurrence(
    system: System, amplitudes: np.ndarray, contact: np.ndarray, impacts: int, recollection: np.record
) -> int:
    """Number of impacts after which a motion repeats that has recurred after ``impacts`` of them; PASSES if it leaves.

    The motion begins just before an impact.  Impacts at several planes in one instant count as one.  That it does not
    leave within 16 recurrences does not prove that its orbit attracts.
    """
    if not impacts:
        return 0
    further = max(1, min(FOLLOWED, MOST_IMPACTS // impacts))
    states = _states_at_impacts(system, amplitudes, contact, further * impacts, recollection)
    size = 1.0 + np.abs(amplitudes).sum()
    changes = np.abs(np.diff(states[::impacts], axis=0)).sum(axis=1)
    early, late = np.array_split(changes, 2)
    if late.max(initial=0.0) > max(GROWS * early.max(initial=0.0), ROUNDING * size):
        return PASSES
    once = states[: impacts + 1]
    for count in range(1, min(impacts, len(states) - 1)):
        # Not of the first state alone: the last bounces of a chatter are alike.
        if impacts % count == 0 and np.abs(once[count:] - once[:-count]).sum(axis=1).max() <= REPEATS * size:
            return count
    return impacts


def _states_at_impacts(
    system: System, amplitudes: np.ndarray, contact: np.ndarray, count: int, before: np.record
) -> np.ndarray:
    """Amplitudes just before an impact and the ``count`` following ones, fewer if the motion does something else."""
    (arrays, table), (planes, modes) = system.own_records(), system.arrays.rows.shape
    state, touching, recollection = amplitudes.copy(), contact.copy(), memory(modes, limits=system.limits)
    recollection.clock, recollection.limited[:] = before.clock, before.limited
    log = EventLog.empty(LOGGED, modes, planes, system.limits)
    tools = workspace(modes), rub_workspace(modes, planes, system.limits)
    found: list[np.ndarray] = []
    passed, last, events, outcome = 0.0, -np.inf, 0, Outcome.EVENT_LIMIT
    while outcome == Outcome.EVENT_LIMIT and len(found) <= count and events < MOST_EVENTS:
        begun = np.maximum(touching, FLIGHT)
        outcome, time, noted = advance(arrays, table, state, FOLLOWED_TIME, touching, log, recollection, *tools)
        new = log.first(noted)
        for event in np.flatnonzero(new.contact_beginnings(begun, arrays["stiffness"] > 0.0)).tolist():
            if planes == 1 or passed + new.times[event] - last > SHORTEST_LAP:
                found.append(new.before[event].copy())
                last = passed + new.times[event]
        passed, events = passed + time, events + noted
    return np.array(found[: count + 1]).reshape(-1, modes)
