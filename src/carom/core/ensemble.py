"""Many motions in one call: each is followed until it settles, and only its end is stored.

Motions of a rotor with one pair of modes fly side by side in :mod:`carom.core.lanes`.  Whenever a motion needs more
than a plain flight and a plain impact, :mod:`carom.core.advance` follows it one event at a time until it flies again.
When a motion has ended, its lane takes the next one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.base.outcome import Outcome
from carom.core.advance import SHORTEST, STALLED, advance
from carom.core.block import move_to
from carom.core.closing import PASSES, least_period
from carom.core.compiling.decorators import expanded, inlined, kernel
from carom.core.counter import next_number
from carom.core.event_log import EventLog
from carom.core.flow import copy, displacement, squared_modulus, velocity
from carom.core.lanes import CLEARED, LATE, OPEN, fly_lanes, surely_flies
from carom.core.layout import LANES, RECURRENCE_RTOL
from carom.core.phases import AWAY, FLIGHT, lasts
from carom.core.planar_proofs import fades_to_rolling, stays_inside
from carom.core.settling import discard_candidate, impacts_until_noted, levitates, recurs, reset
from carom.core.wall import set_on_wall

EVENT_LIMIT, GRAZING, TIME_REACHED = int(Outcome.EVENT_LIMIT), int(Outcome.GRAZING), int(Outcome.TIME_REACHED)
BOUNCING, LEVITATED, MIXED = int(Outcome.BOUNCING), int(Outcome.LEVITATED), int(Outcome.MIXED)
ROLLING = int(Outcome.ROLLING)
GOES_ON, SINGLY, NONE_YET = -1, -2, -3
"""What to do with a lane whose motion has not ended: fly on; follow it one event at a time; there is no motion yet."""
VACANT = -1.0
"""Verdict on a lane that needs a new motion."""
EVERY_LANE = (1 << LANES) - 1
LONG_AGO = -1e300
RUN = 64
"""Number of motions that a call takes at a time: neighbouring motions share cache lines."""
CALM = 10_000
"""Number of free blocks of flight after which the expensive proof of levitation is tried (again)."""
SCREENING_RTOL = 1.5 * RECURRENCE_RTOL
"""The tolerance of :func:`carom.core.settling.same_state` for recurrence, with a margin."""


class Task(NamedTuple):
    """The rotor (:func:`~carom.models.from_modes.second_order_system`), its table, and the limits of time and events."""

    rotor: np.record
    table: np.record
    until: float
    most_events: int


MOTION = np.dtype(
    [
        ("position", np.complex128),
        ("velocity", np.complex128),
        ("time", np.float64),
        ("contact", np.int64),
        ("outcome", np.int64),
        ("impacts", np.int64),
        ("multiplicity", np.int64),
    ]
)
"""A motion.

On call: position and velocity at its start, and its state of contact there (see :func:`~carom.core.advance.advance`).  On return: position and
velocity at its end, outcome and time as in :func:`~carom.core.advance.advance`, the number of impacts, and the
multiplicity from :func:`~carom.core.closing.least_period`.
"""


class Tools(NamedTuple):
    """Scratch arrays of a call: the lanes, and the arguments of ``advance`` with a log of one event.

    The loop itself uses records only: passing an array to a kernel costs reference counting.
    """

    lanes: np.record
    memory: np.record
    log: EventLog
    work: np.record
    rub: np.record
    amplitudes: np.ndarray
    contact: np.ndarray


@kernel
def follow_each(task, motions, counter, tools):
    """Follow the motions that this call takes from the counter; they are independent of each other.

    Parameters
    ----------
    task : Task
    motions : recarray of MOTION, shape (M,)
    counter : record of :func:`~carom.core.counter.fresh_counter`
        Shared by the threads that follow these motions.
    tools : Tools

    Returns
    -------
    int
        Number of motions that this call has followed.
    """
    lanes, memory, work = tools.lanes, tools.memory, tools.work
    count, number, stop, taken = motions.shape[0], 0, 0, 0
    idle, looks = 0, EVERY_LANE
    lanes.verdict[:], lanes.motion[:] = VACANT, 0
    while idle != EVERY_LANE:
        for lane in range(LANES if looks != 0 else 0):
            if (looks >> lane) & 1 == 0:
                continue
            outcome = _act_on_verdict(task, lanes, memory, work, lane)
            while outcome != GOES_ON:
                if outcome == SINGLY:
                    outcome = _follow_by_events(task, tools, lane)
                    continue
                if outcome in (BOUNCING, MIXED) and _passes_by_orbit(task, tools, lane):
                    outcome = SINGLY
                    continue
                if outcome != NONE_YET:
                    _note_end(task, tools, motions[lanes.motion[lane]], lane, outcome)
                if number == stop:
                    number = min(next_number(counter.numbers) * RUN, count)
                    stop = min(number + RUN, count)
                    taken += stop - number
                if number == count:
                    _fill_unused(lanes, lane)
                    idle |= 1 << lane
                    break
                lanes.motion[lane] = number
                outcome = _begin(task, motions[number], lanes, memory, work, lane)
                number += 1
        looks = fly_lanes(task.rotor, task.table, task.until, lanes) & ~idle
    return taken


@expanded
def _begin(task, start, lanes, memory, work, lane):
    """Start a motion on a lane; return how it continues."""
    _set_state(task.rotor, start.position, start.velocity, work.current)
    contact = start.contact
    if contact == FLIGHT:
        set_on_wall(task.rotor, 0, work.current)
    reset(memory)
    _save_memory(lanes, memory, lane)
    lanes.contact[lane] = contact
    lanes.impacts[lane], lanes.events[lane], lanes.stalled[lane], lanes.calm[lane] = 0, 0, 0, 0
    lanes.clock[lane], lanes.quiet[lane] = 0.0, 0.0
    if contact == FLIGHT and not surely_flies(task.rotor, work.current):
        return SINGLY
    _put_on_lane(task, lanes, memory, work, lane)
    return GOES_ON


@expanded
def _act_on_verdict(task, lanes, memory, work, lane):
    """Act on the verdict on a lane; return how its motion ends or continues.

    If a motion ends or must be followed one event at a time, its state is left in ``work.current``.
    """
    verdict = lanes.verdict[lane]
    if verdict == VACANT:
        return NONE_YET
    _copy_state(lanes, lane, work.current)
    if verdict == CLEARED:
        lanes.calm[lane] += 1
        if memory.patience <= 0:
            return GOES_ON
        longs = lanes.calm[lane] % CALM == 0 and stays_inside(task.rotor, work.current)
        return LEVITATED if longs or levitates(task.rotor, work.current, work) else GOES_ON
    if verdict == LATE:
        if memory.patience > 0 and levitates(task.rotor, work.current, work):
            return LEVITATED
        # The lane has proved that there is no contact up to this time, on a block that lasts longer.
        move_to(task.rotor, task.table, task.until - lanes.clock[lane], work)
        copy(work.end, work.current)
        lanes.clock[lane] = task.until
        return TIME_REACHED
    _count_plain_impacts(lanes, lane)
    if verdict == OPEN:
        lanes.contact[lane] = FLIGHT if lanes.level[lane] == 0.0 else AWAY
        return SINGLY
    lanes.events[lane] += 1
    lanes.impacts[lane] += 1
    lanes.stalled[lane] = 0
    _copy_end(lanes, lane, work.end)
    _load_memory(lanes, memory, lane)
    fades = memory.patience > 0 and fades_to_rolling(memory.proofs, task.rotor, work.end)
    if fades or (memory.patience > 0 and recurs(memory, work.end)):
        lanes.impacts[lane] -= 1
        copy(work.end, work.current)
        if fades:
            return ROLLING
        return MIXED if memory.rubbed > 0 else BOUNCING
    _save_memory(lanes, memory, lane)
    if lanes.events[lane] >= task.most_events:
        return EVENT_LIMIT
    _set_next_look(task, lanes, memory, lane)
    return GOES_ON


@expanded
def _follow_by_events(task, tools, lane):
    """Follow the motion of ``work.current`` event by event until it ends, or flies and can return to its lane."""
    lanes, memory, amplitudes, work = tools.lanes, tools.memory, tools.amplitudes, tools.work
    contact = tools.contact
    contact[0] = lanes.contact[lane]
    _load_memory(lanes, memory, lane)
    outcome, follows = EVENT_LIMIT, True
    while follows:
        departed = contact[0]
        copy(work.current, amplitudes)
        outcome, time, count = advance(
            task.rotor, task.table, amplitudes, task.until - lanes.clock[lane], contact,
            tools.log, memory, work, tools.rub,
        )  # fmt: skip
        copy(amplitudes, work.current)
        lanes.clock[lane] += time
        lanes.events[lane] += count
        if (
            not lasts(departed)
            and not lasts(contact[0])
            and count > 0
            and _changed(tools.log.before[0], tools.log.after[0])
        ):
            lanes.impacts[lane] += 1
        lanes.stalled[lane] = lanes.stalled[lane] + 1 if time <= SHORTEST else 0
        if outcome == EVENT_LIMIT and lanes.stalled[lane] == STALLED:
            outcome = GRAZING
        flies = contact[0] == AWAY or (
            contact[0] == FLIGHT and memory.lifting == 0 and surely_flies(task.rotor, work.current)
        )
        follows = outcome == EVENT_LIMIT and lanes.events[lane] < task.most_events and not flies
    if outcome != EVENT_LIMIT or lanes.events[lane] >= task.most_events:
        return outcome
    lanes.contact[lane] = contact[0]
    _save_memory(lanes, memory, lane)
    _put_on_lane(task, lanes, memory, work, lane)
    return GOES_ON


@inlined
def _put_on_lane(task, lanes, memory, work, lane):
    """Put the motion of ``work.current``, which is in free flight, on a lane."""
    lower, upper = work.current[0], work.current[1]
    lanes.lower_re[lane], lanes.lower_im[lane] = lower.real, lower.imag
    lanes.upper_re[lane], lanes.upper_im[lane] = upper.real, upper.imag
    lanes.level[lane] = 0.0
    if lanes.contact[lane] == AWAY:
        lanes.level[lane] = squared_modulus(displacement(task.rotor, 0, work.current)) - 1.0
    lanes.depth[lane] = 0.0
    _set_next_look(task, lanes, memory, lane)


@inlined
def _set_next_look(task, lanes, memory, lane):
    """Set the number of impacts after which a lane must be examined, and whether to examine its free flights too."""
    due = task.most_events - lanes.events[lane]
    if memory.patience > 0:
        due = min(due, impacts_until_noted(memory))
    lanes.due[lane], lanes.watched[lane] = float(due), 1.0 if memory.patience > 0 else 0.0


@inlined
def _count_plain_impacts(lanes, lane):
    """Add the plain impacts of a lane since it was last examined to its counts."""
    quiet = int(lanes.quiet[lane])
    lanes.quiet[lane] = 0.0
    lanes.stalled[lane] = 0 if quiet > 0 else lanes.stalled[lane]
    lanes.events[lane] += quiet
    lanes.impacts[lane] += quiet
    lanes.seen[lane] += quiet
    lanes.since[lane] += quiet


@inlined
def _load_memory(lanes, memory, lane):
    """Load the memory of a lane's motion; the state of a rub is not part of it, because it ends with the rub."""
    memory.events, memory.since, memory.renewal = lanes.seen[lane], lanes.since[lane], lanes.renewal[lane]
    memory.candidate, memory.rubbed, memory.lifting = lanes.candidate[lane], lanes.rubbed[lane], 0
    memory.period = 0
    memory.reference[0] = complex(lanes.reference_lower_re[lane], lanes.reference_lower_im[lane])
    memory.reference[1] = complex(lanes.reference_upper_re[lane], lanes.reference_upper_im[lane])


@inlined
def _save_memory(lanes, memory, lane):
    """Save the memory of a lane's motion."""
    lanes.seen[lane], lanes.since[lane], lanes.renewal[lane] = memory.events, memory.since, memory.renewal
    lanes.candidate[lane], lanes.rubbed[lane] = memory.candidate, memory.rubbed
    lower, upper, reach = 0j, 0j, -1.0
    if memory.patience > 0:
        lower, upper = memory.reference[0], memory.reference[1]
        reach = SCREENING_RTOL * (1.0 + abs(lower) + abs(upper))
    lanes.reference_lower_re[lane], lanes.reference_lower_im[lane] = lower.real, lower.imag
    lanes.reference_upper_re[lane], lanes.reference_upper_im[lane] = upper.real, upper.imag
    lanes.reach[lane] = reach


@kernel
def _passes_by_orbit(task, tools, lane):
    """Whether a motion that has recurred only passes by an orbit; if not, ``memory.period`` is that of its orbit."""
    lanes, memory = tools.lanes, tools.memory
    state = tools.amplitudes
    copy(tools.work.current, state)
    memory.period = least_period(
        task.rotor, task.table, state, memory.period, tools.contact, tools.log, memory, tools.work, tools.rub
    )
    copy(state, tools.work.current)
    if memory.period != PASSES:
        return False
    discard_candidate(memory)
    lanes.contact[lane] = FLIGHT
    _save_memory(lanes, memory, lane)
    return True


@expanded
def _note_end(task, tools, motion, lane, outcome):
    """Store the end of a lane's motion, whose state is in ``work.current``."""
    lanes, memory, work = tools.lanes, tools.memory, tools.work
    motion.outcome, motion.time = outcome, lanes.clock[lane]
    motion.impacts = lanes.impacts[lane] + int(lanes.quiet[lane])
    motion.position, motion.velocity = (
        displacement(task.rotor, 0, work.current),
        velocity(task.rotor, 0, work.current),
    )
    motion.multiplicity = memory.period if outcome in (BOUNCING, MIXED) else 0


@inlined
def _fill_unused(lanes, lane):
    """Fill an unused lane with a motion that is never examined: at rest and free of contact."""
    lanes.lower_re[lane], lanes.lower_im[lane], lanes.upper_re[lane], lanes.upper_im[lane] = 0.0, 0.0, 0.0, 0.0
    lanes.level[lane], lanes.clock[lane], lanes.depth[lane] = -0.5, LONG_AGO, 0.0
    lanes.watched[lane] = 0.0


@inlined
def _copy_state(lanes, lane, amplitudes):
    amplitudes[0] = complex(lanes.lower_re[lane], lanes.lower_im[lane])
    amplitudes[1] = complex(lanes.upper_re[lane], lanes.upper_im[lane])


@inlined
def _copy_end(lanes, lane, amplitudes):
    amplitudes[0] = complex(lanes.end_lower_re[lane], lanes.end_lower_im[lane])
    amplitudes[1] = complex(lanes.end_upper_re[lane], lanes.end_upper_im[lane])


@inlined
def _changed(before, after):
    return before[0] != after[0] or before[1] != after[1]


@inlined
def _set_state(rotor, position, speed, amplitudes):
    """Write the amplitudes of a displacement and a velocity.

    Array arithmetic is avoided here: the last bit of its result depends on the position of a number in the array.
    """
    change = position - rotor.offsets[0]
    amplitudes[0], amplitudes[1] = speed - rotor.exponents[1] * change, change
