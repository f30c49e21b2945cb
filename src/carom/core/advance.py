"""The event loop of one motion: fly, reach the wall, rebound; land, slide, roll, lift off; end where it settles."""

from __future__ import annotations

import math

from carom.base.outcome import Outcome
from carom.core.compiling.decorators import expanded, inlined, kernel, separate
from carom.core.contact_events import LANDING, begin_contact, rests
from carom.core.events import INSIDE, LEAVING, search
from carom.core.flow import acceleration, copy, displacement, squared_modulus, velocity
from carom.core.limits import FREE, WITHIN, at_limits, keeps_time, pass_time
from carom.core.phases import AWAY, FLIGHT, stays
from carom.core.planar_proofs import stays_inside
from carom.core.rounding import RESTING, push_rounding, speed_rounding
from carom.core.rub import lift_off, press, wall_push
from carom.core.rub_step import NOWHERE, leading_station, rub_step
from carom.core.settling import levitates, triggers, until_triggered
from carom.core.shaft import enter_flight, has_slowed_down, leave_flight
from carom.core.wall import unit

CLEAR, CONTACT, GRAZING = int(Outcome.CLEAR), int(Outcome.CONTACT), int(Outcome.GRAZING)
TIME_REACHED, EVENT_LIMIT = int(Outcome.TIME_REACHED), int(Outcome.EVENT_LIMIT)
TRIGGERED, BEYOND_MODEL, LEVITATED = int(Outcome.TRIGGERED), int(Outcome.BEYOND_MODEL), int(Outcome.LEVITATED)
CHATTER_HEIGHT = 1e-13
"""Height of a bounce, in clearances, below which a chatter counts as complete; penetration is allowed to 1e-12 at least."""
STALLED = 64
"""Events in a row without progress in time after which double precision cannot decide what follows."""
STALLED_TOGETHER, AT_A_STAND = 4096, 1e-9
"""Events of several stations within less than that time after which they count as jammed: no bounces of a chatter are so quick."""
BLOCKS = 4.0
"""Longest blocks of flight that one of several stations is searched for contact before the others are."""
SHORTEST = 1e-15
"""Duration that counts as no progress."""
FIRST_LOOK = 4.0
"""Blocks of a flight until it is first asked whether it levitates; then after twice as many each time, up to the recheck time.

The flight of a strongly damped rotor may take millions of blocks until the slower mode has decayed.
"""
LEAST_LOSS = 1e-3
"""Smallest loss of speed per bounce used in the test for the end of a chatter; an elastic one would never end."""


@separate
def advance(rotor, table, amplitudes, until, contacts, log, memory, work, rub):
    """Follow a motion until a given time, until the log is full, or until it settles.

    Impacts at several stations in one instant are resolved together (:mod:`carom.core.joint`) and are one event, of one of these stations.

    Parameters
    ----------
    rotor, table : records of :mod:`carom.core.layout`
        Of a shaft whose speed changes they have to be copies of the motion's own: each flight sets entries of them.  Of one with limits the
        memory holds the time and the states of these limits at time zero, and on return those at the returned time.
    amplitudes : complex array, shape (N,)
        State at time zero; on return the state at the returned time.
    until : float
        Duration to follow.
    contacts : int array, shape (P,)
        State of contact of each station at the start; on return that at the returned time.  It is a
        :class:`~carom.base.outcome.Phase` on the wall (``FLIGHT``: about to leave or to rebound), otherwise ``AWAY``.
    log : EventLog
        Its entries are overwritten.  An impact is followed by ``FLIGHT`` and changes the amplitudes; a long contact is logged
        in steps that change nothing.  A motion that settles at an impact ends just before it.
    memory : record of :func:`~carom.core.settling.memory`
    work, rub : records of :func:`~carom.core.layout.workspace` and :func:`~carom.core.layout.rub_workspace`

    Returns
    -------
    outcome : int
        ``TIME_REACHED``, ``EVENT_LIMIT`` (log full, or the time of a slice is over), ``GRAZING``, ``CHATTER``, ``TRIGGERED``,
        ``BEYOND_MODEL`` at the end of the first step of contact that leads further into a wall than the model holds, or at an event at which a
        magnet is reached,
        or what the motion settles to.
    time : float
    events : int
    """
    state, contact = work.current, rub.contact
    copy(amplitudes, state)
    copy(contacts, contact)
    if rotor.limit_bounds.shape[0] > 0:
        copy(memory.limited, rub.limited)
    if keeps_time(rotor):
        rub.clock = memory.clock
    time = 0.0
    events, most_stalled = 0, STALLED_TOGETHER
    if rotor.rows.shape[0] == 1:
        memory.stalled, most_stalled = 0, STALLED
    outcome = CONTACT
    while outcome == CONTACT and events < log.times.shape[0] and time < memory.slice:
        slides, rubs, horizon, left = _slides(rotor, contact, state, rub), False, until - time, math.inf
        if memory.watches > 0:
            rubs = leading_station(rotor, contact) != NOWHERE
            left = until_triggered(memory, rubs)
            horizon = min(horizon, left)
        if slides:
            outcome, duration, station = _slide(rotor, contact, horizon, memory, work, rub)
        else:
            horizon = min(horizon, memory.slice - time)
            outcome, duration, station = _fly(rotor, table, horizon, contact, memory, work, rub)
        if outcome == TIME_REACHED and horizon >= left:
            outcome = TRIGGERED
        memory.lap += duration
        outcome, time = _cut(outcome, time, duration, until, slides, memory)
        if outcome == CONTACT:
            _note(rotor, contact, events, time, station, log, work, rub)
            events += 1
            stands = duration <= SHORTEST
            if rotor.rows.shape[0] > 1:
                memory.stood += duration
                stands = memory.stood <= AT_A_STAND
            memory.stalled = memory.stalled + 1 if stands else 0
            memory.stood = memory.stood if stands else 0.0
            if memory.stalled >= most_stalled:
                outcome = GRAZING
            makes_contact = (not slides or duration == 0.0) and station != NOWHERE
            persists = memory.watches > 0 and triggers(memory, rubs, makes_contact, duration)
            if persists or has_slowed_down(rotor, state, memory):
                outcome = TRIGGERED
            if (slides and _beyond(rotor, state)) or _at_magnet(rotor, state):
                outcome = BEYOND_MODEL
    copy(state, amplitudes)
    copy(contact, contacts)
    if rotor.limit_bounds.shape[0] > 0:
        copy(rub.limited, memory.limited)
    return (EVENT_LIMIT if outcome == CONTACT else outcome), time, events


@inlined
def _cut(outcome, time, duration, until, slides, memory):
    """Outcome and time after a stretch; a flight that the end of a slice has cut goes on in the next call."""
    if outcome == TIME_REACHED and not slides and memory.slice < until:
        memory.flown += duration
        return EVENT_LIMIT, memory.slice
    return outcome, (until if outcome == TIME_REACHED else time + duration)


@inlined
def _note(rotor, contact, event, time, station, log, work, rub):
    """Write an event into the log."""
    log.times[event], log.stations[event] = time, station
    for p in range(rotor.rows.shape[0]):
        log.phases[event, p] = FLIGHT if contact[p] == AWAY else contact[p]
    for k in range(work.current.shape[0]):
        log.before[event, k] = work.end[k]
        log.after[event, k] = work.current[k]
    for axis in range(rub.limited.shape[0]):
        log.limited[event, axis] = rub.limited[axis]


@inlined
def _beyond(rotor, amplitudes):
    """Whether a station is further from the centre than the model holds."""
    found = False
    for station in range(rotor.rows.shape[0]):
        radius = math.sqrt(squared_modulus(displacement(rotor, station, amplitudes)))
        found = found or radius > rotor.farthest[station]
    return found


@inlined
def _at_magnet(rotor, amplitudes):
    """Whether a magnet is reached."""
    found = False
    for magnet in range(rotor.gap_offsets.shape[0]):
        place = rotor.gap_offsets[magnet]
        for k in range(amplitudes.shape[0]):
            place += rotor.gap_rows[magnet, k] * amplitudes[k]
        found = found or squared_modulus(place) > 1.0
    return found


@inlined
def _slides(rotor, contact, amplitudes, rub):
    """Whether the motion is followed by Taylor series: in lasting contact, next to a wall beside other stations, or near a limit of a bearing."""
    if rotor.rows.shape[0] == 1 and rotor.limit_bounds.shape[0] == 0:
        return stays(contact[0])
    if rotor.limit_bounds.shape[0] > 0 and at_limits(rub):
        return True
    for station in range(rotor.rows.shape[0]):
        if stays(contact[station]) or (contact[station] == FLIGHT and rests(rotor, station, amplitudes)):
            return True
    return False


@expanded
def _fly(rotor, table, horizon, contact, memory, work, rub):
    """One flight from ``work.current`` and the impact or landing at its end; ``work.current`` is then the new state.

    Returns the outcome (CONTACT: the motion continues), the duration and the station in contact.  ``work.end`` is the
    state just before the impact.
    """
    state = work.current
    elapsed, unproven = 0.0, 0.0
    memory.turns = 0
    settle = memory.patience > 0
    span = min(FIRST_LOOK * table.durations[0], memory.recheck)
    while True:
        reaction, resting, station = _reaction(rotor, contact, memory, work, rub)
        if reaction != CLEAR:
            copy(state, work.end)
            break
        if settle and _levitates(rotor, table, state, work):
            return LEVITATED, elapsed, station
        if settle and unproven >= memory.recheck:
            unproven = 0.0
            if stays_inside(rotor, state) and _stays_within_limits(rotor, state, work):
                return LEVITATED, elapsed, station
        leap = min(horizon - elapsed, span) if settle else horizon - elapsed
        reaction, duration, station = _leap(rotor, table, leap, contact, resting, work, rub)
        elapsed, unproven = elapsed + duration, unproven + duration
        span = min(2.0 * span, memory.recheck)
        if keeps_time(rotor):
            pass_time(duration, False, memory, rub)
        if reaction != CLEAR:
            break
        copy(work.end, state)
        if rotor.limit_bounds.shape[0] > 0 and at_limits(rub):
            return CONTACT, elapsed, NOWHERE
        if elapsed >= horizon:
            return TIME_REACHED, horizon, station
    return begin_contact(rotor, contact, station, reaction, elapsed, memory, work, rub), elapsed, station


@inlined
def _levitates(rotor, table, amplitudes, work):
    """:func:`~carom.core.settling.levitates`, at the speed that the shaft has."""
    if rotor.shaft.shape[0] > 0:
        enter_flight(rotor, table, amplitudes)
    found = levitates(rotor, amplitudes, work) and _stays_within_limits(rotor, amplitudes, work)
    if rotor.shaft.shape[0] > 0:
        leave_flight(rotor, amplitudes)
    return found


@inlined
def _stays_within_limits(rotor, amplitudes, work):
    """Whether a flight provably never reaches a limit of a bearing."""
    if rotor.limit_bounds.shape[0] > 0:
        return levitates(rotor.reach, amplitudes, work)
    return True


@expanded
def _reaction(rotor, contact, memory, work, rub):
    """What the first station on its wall that does not just fly away does: its reaction, whether it rests, the station."""
    reaction, resting, place = CLEAR, False, NOWHERE
    for station in range(rotor.rows.shape[0]):
        if reaction == CLEAR and contact[station] == FLIGHT:
            lifting = memory.lifting == station + 1
            reaction, resting = _wall_reaction(rotor, contact, station, work.current, lifting, rub)
            place = station
    memory.lifting = 0
    return reaction, resting, place


@expanded
def _leap(rotor, table, horizon, contact, resting, work, rub):
    """Fly from ``work.current`` to the next contact or the horizon, or just off the wall from a start at rest on it.

    Returns the reaction of the wall (CLEAR: the flight continues), the duration and the station in contact; ``work.end``
    holds the state there.
    """
    if resting:
        copy(work.current, work.end)
        duration, returned = lift_off(rotor, contact, work.end, horizon, rub)
        if duration == 0.0:
            return LANDING, duration, 0
        contact[0] = FLIGHT if returned else AWAY
        return CLEAR, duration, 0
    if rotor.limit_bounds.shape[0] > 0:
        return _next_contact_or_limit(rotor, table, horizon, contact, work, rub)
    return _next_contact(rotor, table, horizon, contact, work)


@kernel
def _next_contact_or_limit(rotor, table, horizon, contact, work, rub):
    """:func:`_next_contact`, unless a bearing comes to its limit first: then without a station, and with its axes no longer free."""
    copy(work.current, rub.series[0])
    outcome, time, station = _next_contact(rotor, table, horizon, contact, work)
    copy(work.end, rub.series[1])
    for each in range(rotor.limit_bounds.shape[0]):
        copy(rub.series[0], work.current)
        found, met = search(rotor.reach, table, each, time, INSIDE, work)
        if found != CLEAR and met < time:
            outcome, time, station = CLEAR, met, NOWHERE
            copy(work.end, rub.series[1])
            for other in range(each):
                rub.limited[2 * other], rub.limited[2 * other + 1] = FREE, FREE
            rub.limited[2 * each], rub.limited[2 * each + 1] = WITHIN, WITHIN
    copy(rub.series[1], work.end)
    return outcome, time, station


@expanded
def _next_contact(rotor, table, horizon, contact, work):
    """Earliest contact over all stations of the flight from ``work.current``; ``work.end`` holds the state there."""
    if rotor.shaft.shape[0] > 0:
        enter_flight(rotor, table, work.current)
        found = _next_contact_of_several(rotor, table, horizon, contact, work)
        leave_flight(rotor, work.end)
        return found
    if rotor.rows.shape[0] == 1:
        outcome, time = search(rotor, table, 0, horizon, LEAVING if contact[0] == FLIGHT else INSIDE, work)
        contact[0] = AWAY
        return outcome, time, (0 if outcome != CLEAR else NOWHERE)
    return _next_contact_of_several(rotor, table, horizon, contact, work)


@kernel
def _next_contact_of_several(rotor, table, horizon, contact, work):
    """:func:`_next_contact` of several stations, over a few blocks at a time: each is searched no further than the others."""
    elapsed, outcome, target = 0.0, CLEAR, NOWHERE
    while True:
        time = min(horizon - elapsed, BLOCKS * table.durations[0])
        copy(work.current, work.departure)
        for station in range(rotor.rows.shape[0]):
            copy(work.departure, work.current)
            found, met = search(rotor, table, station, time, LEAVING if contact[station] == FLIGHT else INSIDE, work)
            contact[station] = AWAY
            if found != CLEAR or station == 0:
                copy(work.end, work.nearest)
            if found != CLEAR:
                outcome, time, target = found, met, station
        elapsed += time
        copy(work.nearest, work.end)
        if outcome != CLEAR or elapsed >= horizon:
            return outcome, min(elapsed, horizon), target
        copy(work.nearest, work.current)


@expanded
def _slide(rotor, contact, horizon, memory, work, rub):
    """One step of lasting contact from ``work.current``, in place; returns outcome, duration and station as :func:`_fly`."""
    reaction, station = CLEAR, NOWHERE
    if rotor.rows.shape[0] > 1 or rotor.limit_bounds.shape[0] > 0:
        reaction, _, station = _reaction(rotor, contact, memory, work, rub)
    if reaction != CLEAR:
        copy(work.current, work.end)
        outcome, duration = begin_contact(rotor, contact, station, reaction, 0.0, memory, work, rub), 0.0
    else:
        outcome, duration, station = rub_step(rotor, contact, work.current, horizon, memory, rub)
        copy(work.current, work.end)
    return outcome, duration, station


@inlined
def flies(position, speed, force, off, height):
    """Whether a state on the wall is sure to leave it faster than ``off``, to more than a ``height``; of one motion, or in lanes."""
    local = position.conjugate() * speed
    push = (position.conjugate() * force).real + local.imag * local.imag
    return (local.real < -off) & ((push <= 0.0) | (local.real * local.real > push * (4.0 * height)))


@expanded
def _wall_reaction(rotor, contact, station, amplitudes, lifting, rub):
    """What a state on the wall does next, and whether it is at rest there.

    It has an impact (CONTACT) if its speed is outward.  It lands (LANDING) if it is pressed outward and leaves so slowly that
    the whole remaining geometric series of bounces, of duration ``2v/(N(1 − d))``, stays below CHATTER_HEIGHT and ends
    before the normal force ``N`` can vanish.  Otherwise it flies (CLEAR); so does a state at rest whose contact has
    just lost its normal force (``lifting``).
    """
    rest = RESTING * speed_rounding(rotor, station, amplitudes)
    position, speed = displacement(rotor, station, amplitudes), velocity(rotor, station, amplitudes)
    # Nearly all states just fly: for them this saves a root, a division and the rest.
    alone = rotor.rows.shape[0] == 1
    if rotor.limit_bounds.shape[0] > 0:
        alone = alone and not at_limits(rub)
    if alone and flies(position, speed, acceleration(rotor, station, amplitudes), 2.0 * rest, CHATTER_HEIGHT):
        return CLEAR, False
    normal = unit(position)
    local = normal.conjugate() * speed
    departure = -local.real
    if departure < -rest:
        return CONTACT, False
    beside = False
    if rotor.rows.shape[0] > 1:
        beside = leading_station(rotor, contact) != NOWHERE
    if rotor.limit_bounds.shape[0] > 0:
        beside = beside or at_limits(rub)
    push, rate = 0.0, 0.0
    if (rotor.rows.shape[0] > 1 or rotor.limit_bounds.shape[0] > 0) and beside:
        push, rate = press(rotor, contact, station, amplitudes, rub)
    else:
        push = (normal.conjugate() * acceleration(rotor, station, amplitudes)).real + local.imag * local.imag
    if departure > rest and (push <= 0.0 or departure * departure > 2.0 * push * CHATTER_HEIGHT):
        return CLEAR, False
    if not beside:
        push, rate = wall_push(rotor, station, amplitudes)
    if departure <= rest:
        pressed = push > 0.0 if abs(push) > push_rounding(rotor, station, amplitudes) else rate > 0.0
        return (LANDING if pressed and not lifting else CLEAR), True
    loss = max(1.0 - rotor.restitution[station], LEAST_LOSS)
    brief = 2.0 * departure * abs(rate) < 0.5 * push * push * loss
    return (LANDING if brief else CLEAR), False
