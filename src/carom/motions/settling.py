"""How a motion is recognised as settled: its memory, the proofs about its end, whether it repeats or leaves, whether the rotor lies on its bearing.

Weight that turns in the frame of the rotor keeps whirl from repeating itself, and changes it less from turn to turn than what
:mod:`carom.core.settling` takes for a change that lasts.  So it counts as whirl that goes on after as many turns, whatever it changes.

In the frame that turns with the shaft a rotor that lies at the bottom of the wall goes round it once per turn, backward: a turn
that repeats is found there as whirl.  Without damping it does not come to rest but rocks about the place where it leans, for on a
slipping contact friction does not change its sense; such turns never repeat.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.base.outcome import Outcome, Phase
from carom.closed_forms.equilibria import rub_attracts
from carom.closed_forms.exact_results import exact_results
from carom.core.advance import advance
from carom.core.closing import PASSES, least_period
from carom.core.contact_events import SHORTEST_LAP
from carom.core.event_log import EventLog
from carom.core.layout import rub_workspace, workspace
from carom.core.limits import set_limits
from carom.core.phases import FLIGHT, lasts
from carom.core.planar_proofs import fades_to_rolling, planar_proofs
from carom.core.settling import BLOCK, NO_TURN, TURNS, discard_candidate, memory
from carom.models import Rotor, System
from carom.models.stages import NEVER, Trigger

PATIENCE = 20_000
"""Default number of impacts without recurrence after which bouncing counts as irregular.

Irregular transients of thousands of impacts are common.
"""
LONG_FLIGHT = 3e4
"""Longest free flight, in ``1/Ω``, before the expensive proof is tried that the rotor levitates."""
TIME_CONSTANTS = 40.0
SHORTEST_LIMIT, LONGEST_LIMIT = 2e5, 2e7
"""Smallest and largest time, in ``1/Ω``, that a motion is given to settle: seconds of computing."""
FALLING_TURNS = 1_500
"""Turns of the shaft for which a rotor without levitation is followed: whirl and rest are known after 1,024 turns at the latest.

Of a rotor that bends, contact without end may neither settle nor repeat.  A shaft that loses its speed is given its time to stand.
"""
CHATTER = 15.0
"""Impacts of a chatter, times ``|ln d|``, until its bounces are too low to be distinguished from lasting contact."""
LOW, LOW_FOR = 0.5, 200
"""Bounces are low if this many take on average less than this time, in units of ``1/|λ|`` of the fastest exponent: so quickly
no rotor returns to a wall that does not keep pulling it."""
AT_REST = 1e-6
"""Largest velocity of a rub that counts as synchronous, far above the rate at which it was recognised."""
SLICE = 1_000_000
"""Blocks of flight in one compiled call, times modes and contact planes: a fraction of a second, in which Ctrl-C is not heard."""
LOOKED_AT, LEAST_PROGRESS = 32_768, 5e-7
"""Steps after which it is asked whether a motion gets on, and the time in ``1/Ω`` that these must take on average.

A slice of flight without an event counts as :data:`PER_SLICE` steps.  The stiffest walls of machines need steps of ``1e-5/Ω``.
"""
PER_SLICE = 4096
WHIRLING = (Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
REPEATING = (Outcome.BOUNCING, Outcome.MIXED)
MODES = 2
"""Modes of the rotors whose orbits are closed here."""


def fresh_memory(
    rotor: Rotor, patience: int, stop_at_chatter: bool = False, *, absorb: bool = False, trigger: Trigger = NEVER
) -> np.record:
    """Memory of a motion at its start, for :func:`~carom.motions.simulation.follow`.

    With a ``patience`` of zero the motion never counts as settled.  With ``absorb`` it ends as soon as it is proven to
    go over to the synchronous rub or to rolling, otherwise when it has reached them.
    """
    known = exact_results(rotor)
    # What goes over to lasting contact triggers there.
    absorb = absorb and trigger.contact_time == np.inf
    decay = rotor.system.decay
    rub, around = known.rub if patience > 0 else None, known.around if patience > 0 and absorb else None
    return memory(
        rotor.system.modes,
        rub_position=rub.position if rub else 0j,
        patience=patience,
        recheck=min(1.0 / decay, LONG_FLIGHT) if decay > 0.0 else np.inf,
        stop_at_landing=stop_at_chatter,
        resting=not known.rubs,
        proofs=planar_proofs(
            # Lowered by the rounding error once more, so that the end lies inside even if V is computed another way.
            level=around.level - around.rounding if around else 0.0,
            shape=(around.friction, around.strength, around.phase) if around else (0.0, 0.0, 0.0),
            runaway=known.runaway if patience > 0 and absorb else np.inf,
            fading=known.fading if patience > 0 and absorb else 0.0,
            hastening=known.hastening if patience > 0 else np.inf,
        ),
        contact_time=trigger.contact_time,
        contact_gap=trigger.contact_gap,
        impact_speed=trigger.impact_speed,
        slowest=trigger.shaft_speed,
        limits=rotor.system.limits,
        slice_time=SLICE * float(rotor.system.table.durations[0]) / rotor.system.arrays["columns"].size,
    )


@dataclass
class SettlingProgress:
    """Whether a motion gets on: the steps, and the time that they took, since it was last asked."""

    steps: int = 0
    passed: float = 0.0

    def stalls(self, steps: int, time: float) -> bool:
        """Note the steps of a call, none in a slice of flight, and the time that it has passed; return whether the motion stalls."""
        self.steps, self.passed = self.steps + (steps or PER_SLICE), self.passed + time
        if self.steps < LOOKED_AT:
            return False
        stalled = self.passed < LEAST_PROGRESS * self.steps
        self.steps, self.passed = 0, 0.0
        return stalled


def begin_limits(system: System, amplitudes: np.ndarray, time: float, recollection: np.record) -> np.ndarray:
    """Note in the memory of a motion when it begins, and the states of limits there, which are returned, shape (2L,)."""
    work = rub_workspace(system.modes, len(system.arrays["rows"]), system.limits)
    if system.limits:
        work.clock = math.fmod(time, 2.0 * math.pi)
        set_limits(system.arrays, amplitudes, work)
        recollection.clock, recollection.limited[:] = work.clock, work.limited
    return np.array(work.limited)


def settled(
    rotor: Rotor, amplitudes: np.ndarray, contact: np.ndarray, outcome: Outcome, recollection: np.record
) -> tuple[Outcome, int]:
    """Examine the end of a motion: whether it has settled there, and the impacts per period of periodic bouncing.

    Parameters
    ----------
    amplitudes : ndarray of complex, shape (N,)
        State at the end; of bouncing, just before an impact.
    contact : ndarray of int, shape (P,)
        State of contact there.
    outcome : Outcome
        What :func:`carom.core.advance.advance` has found.
    recollection : record of :func:`carom.core.settling.memory`
        Where a motion only passes by an orbit or a rub, this is noted there.

    Returns
    -------
    outcome : Outcome
        ``EVENT_LIMIT`` if it only passes by.
    multiplicity : int
        See :func:`carom.core.closing.least_period`; for rotors with other than one plane and one pair of modes
        :func:`carom.motions.settling.least_recurrence`.
    """
    # A rub that runs round the wall has been recognised by a full turn.
    rests = outcome is Outcome.FORWARD_RUB and np.max(np.abs(rotor.system.state(amplitudes)[1])) < AT_REST
    if rests and recollection.resting:
        if rub_attracts(rotor.system, amplitudes, contact):
            return outcome, 0
        recollection.resting = -1
        return Outcome.EVENT_LIMIT, 0
    if outcome is Outcome.EVENT_LIMIT:
        outcome = goes_round(rotor, amplitudes, contact, recollection) or outcome
    if outcome in WHIRLING and lies(rotor, amplitudes, contact, recollection):
        return Outcome.AT_REST, 0
    if outcome not in REPEATING:
        return outcome, 0
    if not recollection.period and rotor.system.is_planar and _fade(rotor, amplitudes):
        if recollection.contact_time < np.inf:  # which triggers there
            discard_candidate(recollection)
            return Outcome.EVENT_LIMIT, 0
        return Outcome.ROLLING, 0
    recurred = int(recollection.period)
    if rotor.system.is_planar:
        count = int(least_period(rotor.system.arrays, rotor.system.table, amplitudes, recurred, *_tools()))
    else:
        count = least_recurrence(rotor.system, amplitudes, contact, recurred, recollection)
    if count != PASSES:
        return outcome, count
    discard_candidate(recollection)
    return Outcome.EVENT_LIMIT, 0


def may_be_low(rotor: Rotor, patience: int) -> bool:
    """Whether bounces may stay low for so many impacts: not if a chatter would have ended."""
    restitution = rotor.system.arrays.restitution
    return patience > 0 and bool((restitution > math.exp(-2.0 * CHATTER / patience)).any())


def low_interval(rotor: Rotor) -> float:
    """Mean time between impacts, in ``1/Ω``, below which bounces are low."""
    return LOW / float(np.abs(rotor.system.arrays["exponents"]).max())


def _fade(rotor: Rotor, before_impact: np.ndarray) -> bool:
    """Whether bounces from a state just before an impact are proven to fade to rolling."""
    proofs = planar_proofs(fading=exact_results(rotor).fading)
    return bool(fades_to_rolling(proofs, rotor.system.arrays, before_impact))


def _tools() -> tuple[np.ndarray, EventLog, np.record, np.record, np.record]:
    """State of contact and log, memory and scratch arrays for the kernels that close orbits."""
    log = EventLog.empty(1, MODES)
    return np.empty(1, np.int64), log, memory(MODES), workspace(MODES), rub_workspace(MODES)


def time_limit(rotor: Rotor, trigger: Trigger) -> float:
    """Time in ``1/Ω`` after which a stage is given up: :func:`longest_time`, or that of its trigger."""
    return trigger.time if trigger.time < np.inf else longest_time(rotor)


def longest_time(rotor: Rotor) -> float:
    """Time limit in ``1/Ω`` for a motion to settle: TIME_CONSTANTS time constants of free flight, within bounds; else :data:`FALLING_TURNS`."""
    decay = rotor.system.decay
    weighs = rotor.acting.weight is not None or rotor.is_vertical
    if weighs and not rotor.system.levitates and rotor.system.shaft is None:
        return 2.0 * math.pi * FALLING_TURNS
    return min(max(TIME_CONSTANTS / decay, SHORTEST_LIMIT), LONGEST_LIMIT) if decay > 0.0 else SHORTEST_LIMIT


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


def _apart(
    system: System, logged: int, before: np.record
) -> tuple[np.record, np.record, EventLog, tuple[np.record, np.record, np.record]]:
    """What the kernel takes to follow a motion further, apart from its own memory: rotor and table, a log, memory and scratch arrays."""
    (arrays, table), (planes, modes) = system.own_records(), system.arrays["rows"].shape
    log, own = EventLog.empty(logged, modes, planes, system.limits), memory(modes, limits=system.limits)
    own.clock, own.limited[:] = before.clock, before.limited
    return arrays, table, log, (own, workspace(modes), rub_workspace(modes, planes, system.limits))


def _states_at_impacts(
    system: System, amplitudes: np.ndarray, contact: np.ndarray, count: int, before: np.record
) -> np.ndarray:
    """Amplitudes just before an impact and the ``count`` following ones, fewer if the motion does something else."""
    planes, state, touching = len(contact), amplitudes.copy(), contact.copy()
    arrays, table, log, tools = _apart(system, LOGGED, before)
    found: list[np.ndarray] = []
    passed, last, events, outcome = 0.0, -np.inf, 0, Outcome.EVENT_LIMIT
    while outcome == Outcome.EVENT_LIMIT and len(found) <= count and events < MOST_EVENTS:
        begun = np.maximum(touching, FLIGHT)
        outcome, time, noted = advance(arrays, table, state, FOLLOWED_TIME, touching, log, *tools)
        new = log.first(noted)
        for event in np.flatnonzero(new.contact_beginnings(begun, arrays["stiffness"] > 0.0)).tolist():
            if planes == 1 or passed + new.times[event] - last > SHORTEST_LAP:
                found.append(new.before[event].copy())
                last = passed + new.times[event]
        passed, events = passed + time, events + noted
    return np.array(found[: count + 1]).reshape(-1, len(amplitudes))


STEADY = 1e-3
"""Relative change of the means of a block of turns, from one block to the next, below which backward whirl is steady."""
FOLLOWED_TURNS = 64
"""Turns of the shaft over which the place of the contact is watched: whirl of 1/128 of the shaft speed goes half round the wall."""
STEPS_LOGGED, MOST_LOGS = 2048, 128
"""Steps of lasting contact that are looked at together, and how often: of a rigid rotor a turn takes about eight, of one that bends hundreds."""


def goes_round(rotor: Rotor, amplitudes: np.ndarray, contact: np.ndarray, recollection: np.record) -> Outcome | None:
    """Whirl of a rotor that weighs something that has lasted for 1,024 turns along the wall, or of the shaft; else ``None``.

    Contact that has not gone round once in the frame of the shaft in so many of its turns keeps in step with it.  Where the shaft loses
    its speed, none of this has lasted.
    """
    if rotor.system.shaft is not None:
        return None
    in_step = recollection.turning != NO_TURN and recollection.turn_time >= 2 * TURNS * 2.0 * math.pi
    lasts_on = recollection.turns >= 2 * TURNS or _steady(recollection)
    if not (in_step or lasts_on) or (rotor.acting.weight is None and not rotor.system.is_time_dependent):
        return None
    plane = next((place for place, each in enumerate(contact.tolist()) if lasts(each)), None)
    if plane is None:
        return None
    if in_step:
        return Outcome.FORWARD_RUB
    if contact[plane] == Phase.ROLLING and not recollection.turn_slipped:
        return Outcome.ROLLING
    position, velocity = rotor.system.at_plane(amplitudes, plane)
    backward = (position.conjugate() * velocity).imag < -1.0
    return Outcome.BACKWARD_WHIRL if backward else Outcome.FORWARD_RUB


def _steady(recollection: np.record) -> bool:
    """Whether whirl that is backward in the fixed frame goes on as it is: over three blocks of turns, by their duration and radii."""
    if recollection.turns < 3 * BLOCK:
        return False
    blocks = recollection.blocks
    steady = np.abs(np.diff(blocks, axis=0)) <= STEADY * blocks[1:]
    return bool(blocks[-1, 0] < 2.0 * math.pi and steady.all())


def lies(rotor: Rotor, amplitudes: np.ndarray, contact: np.ndarray, recollection: np.record) -> bool:
    """Whether every contact that lasts goes on, within half the wall, for 64 turns of the shaft.

    Parameters
    ----------
    amplitudes : ndarray of complex, shape (N,)
    contact : ndarray of int, shape (P,)
        State of contact at each plane.
    recollection : record of :func:`carom.core.settling.memory`
    """
    touching = np.array([lasts(int(each)) for each in contact])
    if rotor.acting.weight is None or not touching.any():
        return False
    state, contact = amplitudes.copy(), contact.copy()
    arrays, table, log, tools = _apart(rotor.system, STEPS_LOGGED, recollection)
    passed, until = 0.0, 2.0 * math.pi * FOLLOWED_TURNS
    reached = np.zeros((0, np.count_nonzero(touching)))
    for _ in range(MOST_LOGS):
        outcome, time, count = advance(arrays, table, state, until - passed, contact, log, *tools)
        seen = log.first(count)
        if (seen.phases[:, touching] == Phase.FLIGHT).any():
            return False
        places = seen.after @ arrays["rows"][touching].T + arrays["offsets"][touching]
        angles = np.angle(places * np.exp(1j * (passed + seen.times))[:, None])
        turned = np.unwrap(np.concatenate([reached, angles]), axis=0)
        passed += time
        if len(turned):
            # Of the past the extremes are enough, and where it has come to.
            reached = np.stack([turned.min(axis=0), turned.max(axis=0), turned[-1]])
            if (np.ptp(reached, axis=0) >= math.pi).any():
                return False
        if outcome != Outcome.EVENT_LIMIT:
            return outcome == Outcome.TIME_REACHED
    return False
