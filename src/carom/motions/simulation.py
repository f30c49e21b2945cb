"""One motion: a start followed through flights, impacts and lasting contact, stage by stage."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from carom.base.arguments import Count, Whole, checked
from carom.base.outcome import Outcome
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.core.advance import advance
from carom.core.event_log import EventLog
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import AWAY, FLIGHT
from carom.models import Rotor, Subject, Trigger, rotor_of
from carom.models.stages import stages_of
from carom.motions.budget import present_question
from carom.motions.quiet import last_unrest, with_pause
from carom.motions.settling import (
    LOW_FOR,
    PATIENCE,
    REPEATING,
    SettlingProgress,
    begin_limits,
    fresh_memory,
    low_interval,
    may_be_low,
    settled,
    time_limit,
)
from carom.motions.starts import Beginning, State, Until, amplitudes_of, state_at
from carom.motions.trajectories import Trajectory, joined
from carom.parameters import own_time

CHUNK = 4096
"""Events per kernel call; between calls progress is reported."""


@checked
@shows_progress
def simulate(
    machine: Subject,
    start: State | Beginning,
    until: Until | None = None,
    *,
    settle: bool | None = None,
    stop_at_chatter: bool = False,
    patience: Whole = PATIENCE,
    max_events: Count = 1_000_000,
    progress: ShowProgress = None,
) -> Trajectory:
    """Follow a start through flights, impacts, sliding and rolling.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Of a rotor in stages (:func:`carom.models.in_stages`) the last stage reached is returned, with the ``earlier`` ones.
    start : State, Kick, Drop or carom.disturbances.single.Single
        On the wall (``|U| = 1`` to within 1e-12) or inside it.  After a drop the rotor of the motion is the one that falls.
    until : float or str, optional
        Time to follow it, in ``1/Ω`` or text with a unit, such as ``"2 s"``; by default to where it settles, at most
        for :func:`~carom.motions.settling.longest_time`, which is 1,500 turns of the shaft after a drop.
    settle : bool
        End as soon as the final motion is known (criteria in :mod:`carom.core.settling`); by default only without ``until``.
    stop_at_chatter : bool
        End with ``CHATTER`` and the exact state when impacts accumulate.
    patience : int
        While it may settle: impacts without recurrence after which bouncing counts as aperiodic.
    max_events : int
        Impacts and steps of lasting contact after which to give up.

    Raises
    ------
    InputError
        The start lies outside the wall or is too fast, a number is not finite, or a limit is out of range.

    See Also
    --------
    carom.settle : many starts at once
    carom.kick, carom.drop, carom.State : starts
    carom.motions.energy_ledger : evaluate a motion

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> motion = cm.simulate(machine, cm.kick("60 mm/s"))
    >>> motion.outcome.label, motion.multiplicity
    ('bouncing', 1)
    >>> len(motion.contacts)
    257
    """
    question = present_question()
    longest = min(max_events, question.longest)
    following = Following(settle, stop_at_chatter, patience, longest, Reporter.of(progress, "simulating"))
    pieces = list(stretches(machine, start, until, following))
    question.follow(sum(len(piece.segment_starts) for piece in pieces))
    return assembled(pieces)


def assembled(pieces: Iterable[Trajectory]) -> Trajectory:
    """The motion of all pieces of its stages, each of which a trigger has ended but the last."""
    stages: list[list[Trajectory]] = [[]]
    for piece in pieces:
        if stages[-1] and stages[-1][-1].outcome is Outcome.TRIGGERED:
            stages.append([])
        stages[-1].append(piece)
    *earlier, last = map(joined, stages)
    return dataclasses.replace(last, earlier=tuple(earlier)) if earlier else last


class Following(NamedTuple):
    """How a motion is followed; see :func:`simulate`."""

    settle: bool | None
    stop_at_chatter: bool
    patience: int
    max_events: int
    tell: Reporter


def stretches(
    machine: Subject, start: State | Beginning, until: Until | None, following: Following
) -> Iterator[Trajectory]:
    """Follow a start as :func:`simulate` does, in pieces of at most :data:`CHUNK` events.

    Times of a piece count from the beginning of its stage; that of its first segment is where the piece before ends, with the event there.
    """
    model, state = (rotor_of(machine), start) if isinstance(start, State) else start.stages(machine)
    if following.settle is None:
        following = following._replace(settle=until is None)
    end = None if until is None and following.settle else own_time("until", until, model.scales)
    stages, passed = stages_of(model), 0.0
    known = sum(stage.trigger.time for stage in stages if stage.trigger.time < np.inf)
    whole = (
        end or 2.0 * known or time_limit(stages[0].rotor, stages[0].trigger)
    )  # the rest counts as much as what has an end
    for stage in stages:
        longest = time_limit(stage.rotor, stage.trigger) if end is None else end - passed
        until_then = min(1.0, (passed + min(longest, stage.trigger.time)) / whole)
        in_stage = following._replace(tell=following.tell.part(min(1.0, passed / whole), until_then))
        if stage.slowed_to < np.inf:
            speed, angle = state.shaft or (1.0, 0.0)
            state = dataclasses.replace(state, shaft=(min(speed, stage.slowed_to), angle))
        for piece in follow_stage(stage.rotor, state, longest, stage.trigger, in_stage):
            yield piece
        if piece.outcome is not Outcome.TRIGGERED:
            return
        passed += piece.time
        ended, begins = piece.final, piece.begins + piece.time
        state = State.of(*stage.carried(ended.position, ended.velocity), ended.races, ended.shaft, begins)


def follow_stage(
    rotor: Rotor, start: State, longest: float, trigger: Trigger, following: Following
) -> Iterator[Trajectory]:
    """Follow a start through one stage, for so long at most, or until its trigger ends it."""
    settle, stop_at_chatter, patience, max_events, tell = following
    begins = start.time
    # What has settled may still be ended by a time.
    settle, until = bool(settle) and not trigger.is_certain, min(longest, trigger.time)
    amplitudes, contact = amplitudes_of(rotor, start)
    recollection = fresh_memory(rotor, patience if settle else 0, stop_at_chatter, trigger=trigger)
    limited = begin_limits(rotor.system, amplitudes, begins, recollection)
    first = np.where(contact == AWAY, FLIGHT, contact), amplitudes.copy(), limited
    reached, events, outcome, multiplicity, progress = 0.0, 0, Outcome.EVENT_LIMIT, 0, SettlingProgress()
    begun, impact_times, ended, restless = 0.0, np.zeros(0), False, 0.0
    given, limits = tools(rotor), rotor.system.limits
    room = EventLog.empty(min(CHUNK, max_events), len(amplitudes), len(contact), limits)
    while not ended:
        log, asked = room.first(max_events - events), min(until, restless + trigger.quiet_time)
        outcome, time, count = follow(given, amplitudes, asked - reached, contact, log, recollection)
        log = log.first(count)
        log = log._replace(times=reached + log.times)
        reached, events = reached + time, events + count
        if trigger.quiet_time < np.inf:
            reached = asked if outcome is Outcome.TIME_REACHED else reached
            restless = max(restless, last_unrest(rotor.system, log, amplitudes, reached, trigger))
            if outcome is Outcome.TIME_REACHED and asked < until and reached < restless + trigger.quiet_time:
                outcome, count, events = Outcome.EVENT_LIMIT, count + 1, events + 1
                log = with_pause(
                    log, np.where(contact == AWAY, FLIGHT, contact), amplitudes, reached, recollection.limited
                )
        impact_times = np.append(impact_times, log.times)[-LOW_FOR:]
        tell(reached / until if until > 0.0 else 1.0)
        outcome, multiplicity = settled(rotor, amplitudes, contact, outcome, recollection)
        if outcome is Outcome.EVENT_LIMIT and progress.stalls(count, time):
            outcome = Outcome.STALLED
        low = outcome in REPEATING and not multiplicity and may_be_low(rotor, patience)
        if low and np.ptp(impact_times) < low_interval(rotor) * (len(impact_times) - 1):
            outcome = Outcome.LOW_BOUNCES
        if outcome is Outcome.TIME_REACHED:
            triggered = asked in (trigger.time, restless + trigger.quiet_time)
            reached, outcome = asked, Outcome.TRIGGERED if triggered else outcome
        ended = outcome is not Outcome.EVENT_LIMIT or events >= max_events
        if not ended and not count:  # a slice of a flight, which goes on
            continue
        state = amplitudes if ended else log.after[-1]
        time = reached if ended else float(log.times[-1])
        yield Trajectory(
            rotor=rotor,
            start=start,
            outcome=outcome,
            time=time,
            final=state_at(rotor.system, state, begins + time if rotor.system.is_time_dependent else 0.0),
            multiplicity=multiplicity,
            segment_starts=np.append(begun, log.times),
            segment_phases=np.concatenate([first[0][None], log.phases]),
            event_planes=log.stations.copy(),
            segment_amplitudes=np.concatenate([first[1][None], log.after]),
            event_amplitudes=log.before.copy(),
            segment_limits=np.concatenate([first[2][None], log.limited]),
            begins=begins,
        )
        if not ended:
            begun, first = time, (log.phases[-1].copy(), log.after[-1].copy(), log.limited[-1].copy())


def tools(rotor: Rotor) -> tuple[np.record, ...]:
    """Rotor, table and scratch arrays for :func:`follow`."""
    modes, planes = rotor.system.arrays["columns"].shape
    return *rotor.system.own_records(), workspace(modes), rub_workspace(modes, planes, rotor.system.limits)


def follow(
    given: tuple[np.record, ...],
    amplitudes: np.ndarray,
    until: float,
    contact: np.ndarray,
    log: EventLog,
    recollection: np.record,
) -> tuple[Outcome, float, int]:
    """Advance amplitudes and contacts in place until the log is full or the motion ends, with :func:`tools` of the rotor.

    See :func:`carom.core.advance.advance`.
    """
    arrays, table, work, rub = given
    code, *rest = advance(arrays, table, amplitudes, until, contact, log, recollection, work, rub)
    return Outcome(code), *rest
