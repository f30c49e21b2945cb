"""Criteria that decide to which end a motion settles, and the memory they need.

- *Levitated*: at every contact station, the sum of the moduli of the modes is smaller than the distance between the
  contact-free equilibrium and the wall.  This sum is a bound for all later time: a proof.
- *Forward rub*: the state slides within ``RECURRENCE_RTOL`` of the synchronous rub that attracts sliding, or, if the rubs of a rotor
  are not known, changes by less than ``RECURRENCE_RTOL`` per unit time.
- *Backward whirl*, *rolling* and forward rub that runs round the wall: after a full turn without flight the state has
  changed by less than ``RECURRENCE_RTOL`` and by less than ``RECURRENCE_RTOL`` per unit time, so a slow change is not taken for none.
- The same, but never repeating: twice :data:`TURNS` full turns without an impact, in the later of which the state changes from turn
  to turn on average at least half as much as in the earlier, and by a thousandth at least.  Stick and slip of a rotor with
  several coordinates need not keep time with its turns.
- At the limits of magnetic bearings also: contact that lasts, whose state after a whole turn of the shaft is that of the turn before.
- *Periodic*: the state at an impact recurs to within ``RECURRENCE_RTOL`` twice in a row after the same number of impacts.  The
  reference state is replaced after 1, 2, 4, 8 … impacts (Brent 1980), so no period is too long.  A motion that has
  recurred close to a repelling orbit only passes by it and is followed further (:mod:`carom.core.closing`).
- *Aperiodic*: ``patience`` impacts have passed without recurrence.

Where contact that persists ends a stage, contact that lasts or recurs for ever is no end: it is followed until it triggers.

Some ends of the planar rotor are proven earlier (:mod:`carom.core.planar_proofs`).
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.block import basis_amplitudes
from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import displacement, squared_modulus
from carom.core.layout import RECURRENCE_RTOL
from carom.core.limits import FREE
from carom.core.planar_proofs import planar_proofs
from carom.core.records import record

NO_TURN, STARTED, ROUND = 0, 1, 2
NO_CONTACT = -1.0
"""Instead of the time for which contact has persisted: there has been none."""
PATIENCE_AT_LIMITS = 2000
"""Most impacts without recurrence of a motion at the limits of its bearings: a whirl beside axes that stand still seldom repeats."""
TURNS = 512
"""Full turns along the wall whose changes are added up, to compare them with those of as many before."""
BLOCK = 64
"""Full turns along the wall of which the mean duration, and the mean sum of the radii at all stations, are kept."""
UNLIKE = 1e-3
"""Mean change from turn to turn, relative to the size of the state, above which they never repeat if it lasts.

A change of less may be a slow approach.  One that loses half of a change as large as the state in so many turns begins with more.
"""


def memory(
    modes: int,
    rub_position: complex = 0j,
    patience: int = 0,
    recheck: float = np.inf,
    stop_at_landing: bool = False,
    resting: bool = False,
    proofs: np.record | None = None,
    contact_time: float = np.inf,
    contact_gap: float = 0.0,
    impact_speed: float = np.inf,
    slowest: float = -np.inf,
    limits: int = 0,
    slice_time: float = np.inf,
) -> np.record:
    """Memory of the criteria for one motion, and the options on how far to follow it.

    Parameters
    ----------
    modes : int
    rub_position : complex
        Position of the synchronous rub that attracts sliding; zero if there is none.
    patience : int
        Impacts without recurrence after which a motion counts as aperiodic; zero to test no criterion.
    recheck : float
        Longest time of free flight after which to test again whether the rotor levitates; then also by the expensive proof.
    stop_at_landing : bool
        End with ``CHATTER`` where bounces turn into lasting contact.
    resting : bool
        Whether lasting contact that is at rest counts as a synchronous rub; for rotors whose rubs are not known.  A rub
        that repels is marked by −1 until the motion has left it.
    proofs : record of :func:`~carom.core.planar_proofs.planar_proofs`, optional
        What is proven of the ends of this rotor's motions.
    contact_time, contact_gap : float
        End with ``TRIGGERED`` when contact has persisted for that long, interrupted by flights of at most ``contact_gap``.
    impact_speed : float
        End with ``TRIGGERED`` at an impact with that speed or more.
    slowest : float
        End with ``TRIGGERED`` at an event, or after a step of contact, at which a shaft is no faster.
    limits : int
        Number of limited quantities: ``clock`` then is the time, and ``limited`` the states of their axes, at the start of the motion.
    slice_time : float
        Time after which a call returns at the next event or within a flight, so that no call is deaf for long.
    """
    return record(
        reference=np.zeros(modes, np.complex128),
        attracted=np.full(modes, np.nan, np.complex128),
        rub_position=np.asarray(rub_position, np.complex128),
        resting=np.asarray(resting, np.int64),
        patience=np.asarray(patience, np.int64),
        slice=np.asarray(slice_time),
        recheck=np.asarray(recheck),
        stop_at_landing=np.asarray(stop_at_landing, np.int64),
        stalled=np.asarray(0, np.int64),
        stood=np.asarray(0.0),
        lap=np.asarray(np.inf),
        events=np.asarray(0, np.int64),
        renewal=np.asarray(1, np.int64),
        since=np.asarray(0, np.int64),
        candidate=np.asarray(0, np.int64),
        period=np.asarray(0, np.int64),
        rubbed=np.asarray(0, np.int64),
        lifting=np.asarray(0, np.int64),
        turning=np.asarray(NO_TURN, np.int64),
        turn_time=np.asarray(0.0),
        turn_slipped=np.asarray(0, np.int64),
        turns=np.asarray(0, np.int64),
        changes=np.asarray(0.0),
        earlier_changes=np.asarray(0.0),
        block=np.zeros(2),
        blocks=np.zeros((3, 2)),
        turn_position=np.asarray(0, np.complex128),
        turn_state=np.zeros(modes, np.complex128),
        proofs=planar_proofs() if proofs is None else proofs,
        watches=np.asarray(min(contact_time, impact_speed) < np.inf, np.int64),
        contact_time=np.asarray(contact_time),
        contact_gap=np.asarray(contact_gap),
        impact_speed=np.asarray(impact_speed),
        slowest=np.asarray(slowest),
        hardest_impact=np.asarray(0.0),
        contact_so_far=np.asarray(NO_CONTACT),
        flown=np.asarray(0.0),
        parted=np.asarray(0, np.int64),
        clock=np.asarray(0.0),
        limited=np.full(2 * limits, FREE, np.int64),
        limited_steps=np.asarray(0, np.int64),
        reference_clock=np.asarray(0.0),
        reference_limited=np.asarray(0, np.int64),
        turn_clock=np.asarray(0.0),
        turn_limited=np.asarray(0, np.int64),
        rounds=np.asarray(0, np.int64),
        round_state=np.zeros(modes, np.complex128),
    )


@kernel
def levitates(rotor, amplitudes, work):
    """Whether the rotor can provably never reach any wall again."""
    modes = amplitudes.shape[0]
    for station in range(rotor.rows.shape[0]):
        basis_amplitudes(rotor, station, amplitudes, work.amplitudes)
        reach = math.sqrt(squared_modulus(rotor.offsets[station]))
        for k in range(modes):
            if rotor.exponents[k].real > 0.0 or (k > 1 and rotor.driven[k] and rotor.driven[k - 1]):
                return False
            if k + 1 < modes and rotor.driven[k + 1]:
                continue
            size = math.sqrt(squared_modulus(work.amplitudes[k]))
            if rotor.driven[k]:
                driving = work.amplitudes[k - 1]
                share = driving * rotor.inverse_gaps[k]
                apart = math.sqrt(squared_modulus(work.amplitudes[k] + share)) + math.sqrt(squared_modulus(share))
                size += math.sqrt(squared_modulus(driving)) * rotor.largest_response[k]
                if rotor.gaps[k] != 0.0:
                    size = min(size, apart)
            reach += size
        if reach >= 1.0 - RECURRENCE_RTOL:
            return False
    return True


@kernel
def recurs(memory, amplitudes):
    """Record the state at an impact; return whether the motion is periodic (``memory.period`` > 0) or aperiodic (0)."""
    memory.events += 1
    if memory.events > 1:
        memory.since += 1
        recurred = same_state(memory.reference, amplitudes, RECURRENCE_RTOL)
        if recurred and in_step(memory, memory.reference_clock, memory.reference_limited):
            if memory.candidate == memory.since:
                memory.period = memory.since
                return True
            memory.candidate = memory.since
            _renew(memory, amplitudes)
            return False
        if memory.candidate > 0 and memory.since >= memory.candidate:
            memory.candidate = 0
        if memory.since < memory.renewal:
            return memory.events >= _patience(memory)
        memory.renewal *= 2
    memory.candidate = 0
    _renew(memory, amplitudes)
    memory.rubbed = 0
    return memory.events >= _patience(memory)


@inlined
def _patience(memory):
    """Impacts without recurrence after which a motion counts as aperiodic: fewer if bearings come to their limits, which slow it down."""
    if memory.limited_steps > 0:
        return min(memory.patience, PATIENCE_AT_LIMITS)
    return memory.patience


@kernel
def impacts_until_noted(memory):
    """Number of impacts until the next one that :func:`recurs` has to record even if its state does not recur."""
    if memory.events == 0:
        return 1
    number = min(memory.renewal - memory.since, memory.patience - memory.events)
    return min(number, memory.candidate - memory.since) if memory.candidate > 0 else number


@kernel
def _renew(memory, amplitudes):
    memory.since, memory.parted = 0, 0
    memory.reference_clock, memory.reference_limited = memory.clock, memory.limited_steps
    for k in range(amplitudes.shape[0]):
        memory.reference[k] = amplitudes[k]


@kernel
def same_state(first, second, tolerance):
    """Whether the distance of two states, relative to one plus their size, is within a tolerance."""
    size, distance = _size_and_distance(first, second)
    return distance <= tolerance * size


@inlined
def in_step(memory, clock, limited_steps):
    """Whether limits act as at an earlier instant: they have not been in reach since, or their axes are turned by quarters of a turn."""
    if memory.limited_steps == limited_steps:
        return True
    quarters = (memory.clock - clock) * 2.0 / math.pi
    return abs(quarters - math.floor(quarters + 0.5)) <= RECURRENCE_RTOL


@inlined
def _size_and_distance(first, second):
    """One plus the size of the second state, and its distance from the first."""
    size = 1.0
    distance = 0.0
    for k in range(first.shape[0]):
        size += math.sqrt(squared_modulus(second[k]))
        distance += math.sqrt(squared_modulus(first[k] - second[k]))
    return size, distance


@kernel
def never_repeats(memory, amplitudes):
    """Note a turn along the wall after which the state was another; return whether so many have passed that it will stay so."""
    if memory.turns == 0:
        memory.changes = 0.0
    size, distance = _size_and_distance(memory.turn_state, amplitudes)
    memory.turns += 1
    memory.changes += distance / size
    if memory.turns % TURNS > 0:
        return False
    lasts = memory.turns > TURNS and memory.changes >= max(0.5 * memory.earlier_changes, UNLIKE * TURNS)
    memory.earlier_changes, memory.changes = memory.changes, 0.0
    return lasts


@kernel
def note_turn(rotor, memory, amplitudes):
    """Add a turn along the wall to the means of the present block of turns; call it before :func:`never_repeats`."""
    radii = 0.0
    for station in range(rotor.rows.shape[0]):
        radii += math.sqrt(squared_modulus(displacement(rotor, station, amplitudes)))
    if memory.turns % BLOCK == 0:
        memory.block[:] = 0.0
    memory.block[0] += memory.turn_time / BLOCK
    memory.block[1] += radii / BLOCK
    if memory.turns % BLOCK == BLOCK - 1:
        for k in range(2):
            memory.blocks[0, k], memory.blocks[1, k] = memory.blocks[1, k], memory.blocks[2, k]
            memory.blocks[2, k] = memory.block[k]


@kernel
def near_rub(memory, position, speed):
    """Whether a sliding state has reached the synchronous rub that attracts it."""
    if memory.rub_position == 0.0:
        return False
    return math.sqrt(squared_modulus(position - memory.rub_position)) + abs(speed) < RECURRENCE_RTOL


@kernel
def at_rest(rotor, work):
    """Whether the free modes of a motion, given by its Taylor series, are at rest in the frame of the rotor, and races and shaft steady."""
    size, rate = 1.0, 0.0
    for m in range(work.series.shape[1]):
        moves = rotor.free[m] != 0
        for station in range(rotor.race.shape[0]):
            moves = moves or rotor.race[station] == m
        if rotor.shaft.shape[0] > 0:
            moves = moves or m == rotor.shaft[0] or m == rotor.shaft[0] + 1
        if moves:
            size += math.sqrt(squared_modulus(work.series[0, m]))
            rate += math.sqrt(squared_modulus(work.series[1, m]))
    return rate <= RECURRENCE_RTOL * size


@kernel
def approaches_turn(memory, position, amplitudes, speed):
    """Record the position where a turn begins; later return whether the rotor is in the last quarter of a full turn."""
    if memory.turning == NO_TURN:
        memory.turn_position = position
        memory.turn_time = 0.0
        memory.turn_slipped = 0
        memory.turn_clock, memory.turn_limited = memory.clock, memory.limited_steps
        for k in range(amplitudes.shape[0]):
            memory.turn_state[k] = amplitudes[k]
        memory.turning = STARTED
        return False
    ahead = memory.turn_position.conjugate() * position
    if ahead.real < 0.0:
        memory.turning = ROUND
        return False
    return memory.turning == ROUND and ahead.imag * speed < 0.0


@kernel
def reset(memory):
    """Reset a memory for another motion of the same rotor."""
    memory.events, memory.renewal, memory.since = 0, 1, 0
    memory.candidate, memory.period, memory.rubbed, memory.lifting = 0, 0, 0, 0
    memory.turning, memory.turns, memory.rounds, memory.limited_steps = NO_TURN, 0, 0, 0
    memory.stalled, memory.stood, memory.lap = 0, 0.0, math.inf
    memory.hardest_impact, memory.contact_so_far, memory.flown, memory.parted = 0.0, NO_CONTACT, 0.0, 0


@kernel
def until_triggered(memory, rubs):
    """Time after which contact that goes on as it does will have persisted long enough to trigger."""
    left = memory.contact_time - max(memory.contact_so_far, 0.0)
    if rubs:
        return left
    return left - memory.flown if memory.contact_so_far >= 0.0 and left <= memory.contact_gap else math.inf


@kernel
def triggers(memory, rubs, makes_contact, duration):
    """Note that a flight or a stretch of contact has ended with an event, which may be no contact; return whether this triggers."""
    memory.flown = 0.0 if rubs else memory.flown + duration
    if rubs:
        memory.contact_so_far = max(memory.contact_so_far, 0.0) + duration
    elif makes_contact:
        if memory.contact_so_far >= 0.0 and memory.flown <= memory.contact_gap:
            memory.contact_so_far += memory.flown
        else:
            memory.contact_so_far, memory.parted = 0.0, 1
        memory.flown = 0.0
    return memory.hardest_impact >= memory.impact_speed or memory.contact_so_far >= memory.contact_time


@kernel
def persists(memory, duration):
    """Whether contact that recurs will persist until it triggers: no flight of the period, the last one included, is too long."""
    return memory.contact_time < math.inf and memory.parted == 0 and memory.flown + duration <= memory.contact_gap


@kernel
def discard_candidate(memory):
    """Discard a recurrence and look for another one: the motion only passes by a repelling orbit."""
    memory.candidate, memory.period = 0, 0


@kernel
def reset_rub(memory):
    """Restart the search for full turns along the wall, and for turns of the shaft."""
    memory.turning, memory.rounds = NO_TURN, 0


@kernel
def is_turn_periodic(memory, amplitudes):
    """Note the state after a whole turn of the shaft in lasting contact; return whether it is that of the turn before."""
    same = memory.rounds > 0 and same_state(memory.round_state, amplitudes, RECURRENCE_RTOL)
    memory.rounds += 1
    for k in range(amplitudes.shape[0]):
        memory.round_state[k] = amplitudes[k]
    return same
