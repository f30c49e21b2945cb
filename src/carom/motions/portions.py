"""Portions of the work of an ensemble: the motions of one machine in one stage, shared by threads."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from typing import NamedTuple

import numpy as np

from carom.base.outcome import Outcome, Phase
from carom.base.progress import Reporter
from carom.core.counter import fresh_counter, next_number
from carom.core.ensemble import MOTION, Task, Tools, follow_each
from carom.core.event_log import EventLog
from carom.core.lanes import lanes_record
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import AWAY, FLIGHT
from carom.core.settling import reset
from carom.models import Stage
from carom.motions.budget import START, Purse
from carom.motions.settling import PER_SLICE, SettlingProgress, begin_limits, fresh_memory, settled, time_limit
from carom.motions.simulation import follow, tools
from carom.motions.starts import WALL_TOLERANCE, State, amplitudes_of
from carom.parameters import own_time

PORTION = 16_384
"""Most starts of one machine in a portion of work that threads share: some milliseconds to a second of work."""
GLANCE = 0.1
"""Seconds between two reports of progress."""
FEW = 256
"""Number of starts of a portion for which one more thread is used: some for each lane."""
FEW_SINGLY = 8
"""The same for motions that are followed one after another, each for milliseconds to seconds."""
MODES = 2
"""Modes of the rotors whose motions are followed side by side."""
STOPPED = 1 << 40
"""Count of a part beyond which its threads are asked to stop, even within a motion."""
LOGGED = 256
"""Events per kernel call for motions that are followed one after another."""


class EventLimits(NamedTuple):
    """Until when, or after how many impacts and events, motions are given up, and how: see :func:`~carom.motions.ensembles.settle`."""

    until: float | str | None
    patience: int
    max_events: int
    threads: int
    tell: Reporter


def motions_from(positions: np.ndarray, velocities: np.ndarray, times: np.ndarray) -> np.recarray:
    """Records of motions at their starts, which are taken at given times, for the kernel to fill."""
    axes = {"position": positions.shape[1:], "velocity": positions.shape[1:]}
    kind = np.dtype([(name, MOTION[name], axes.get(name, ())) for name in MOTION.names or ()])
    motions = np.recarray(positions.shape[:1], kind)
    motions.position, motions.velocity, motions.time = positions, velocities, times
    if positions.ndim == 1:
        motions.contact = np.where(np.abs(positions) >= 1.0 - WALL_TOLERANCE, FLIGHT, AWAY)
    return motions


class Portion(NamedTuple):
    """Motions of one machine; all threads that hold the same part take motions from it by its shared counter.

    ``elapsed`` are the times, shape (M,), that earlier stages have taken; ``first`` is the number of its first motion among all that the
    purse pays.
    """

    stage: Stage
    motions: np.ndarray
    counter: np.record
    elapsed: np.ndarray
    purse: Purse
    first: int


def parts_of(
    stages: Sequence[Stage], which: np.ndarray, motions: np.recarray, elapsed: np.ndarray, purse: Purse, threads: int
) -> list[Portion]:
    """Parts for threads to take up: each as often as threads may follow it; motions are sorted by the number of their stage."""
    parts: list[Portion] = []
    ends = np.searchsorted(which, np.arange(len(stages) + 1)).tolist()
    for stage, first, last in zip(stages, ends, ends[1:], strict=False):
        for begins in range(first, last, PORTION):
            chosen = slice(begins, min(begins + PORTION, last))
            part = Portion(stage, motions[chosen], fresh_counter(), elapsed[chosen], purse, begins)
            few = FEW if stage.rotor.system.is_planar else FEW_SINGLY
            parts += [part] * min(threads, 1 + len(part.motions) // few)
    return parts


def settle_parts(parts: list[Portion], limits: EventLimits) -> Iterator[int]:
    """Follow all parts, in this thread if one suffices; yield now and then the number of motions followed since.

    When the caller stops iterating or is interrupted, no thread takes up another motion.
    """
    if (limits.threads == 1 or _is_brief(parts)) and all(len(part.motions) <= FEW for part in parts):
        yield from (_settle_part(part, limits) for part in parts)
        return
    with ThreadPoolExecutor(limits.threads) as pool:
        try:
            working = {pool.submit(_settle_part, part, limits) for part in parts}
            while working:
                finished, working = wait(working, GLANCE, FIRST_COMPLETED)
                yield sum(one.result() for one in finished)
        except BaseException:
            for part in parts:
                part.counter.numbers[0] = STOPPED + 1
            pool.shutdown(cancel_futures=True)
            raise


def _is_brief(parts: list[Portion]) -> bool:
    """Whether to start threads takes longer than to follow all motions in this one."""
    side_by_side = all(part.stage.rotor.system.is_planar for part in parts)
    return len(parts) == 1 or (side_by_side and sum(len(part.motions) for part in parts) <= FEW)


def _settle_part(part: Portion, limits: EventLimits) -> int:
    """Follow motions of a part until none is left; return how many this call has followed."""
    rotor, trigger = part.stage.rotor, part.stage.trigger
    until = time_limit(rotor, trigger) if limits.until is None else own_time("until", limits.until, rotor.scales)
    # What has settled may still be ended by a time.
    memory = fresh_memory(rotor, limits.patience if trigger.time == np.inf else 0, absorb=True, trigger=trigger)
    watches_contact = min(trigger.contact_time, trigger.impact_speed) < np.inf
    if not rotor.system.is_planar or watches_contact or (limits.until is not None and part.elapsed.any()):
        return _follow_singly(part, until, limits, memory)
    if not part.purse.suffices(part.first):
        return 0
    part.purse.costs[part.first : part.first + len(part.motions)] = 1
    task = Task(rotor.system.arrays, rotor.system.table, min(until, trigger.time), limits.max_events)
    # Without the compiler, NumPy warns of divisions in lanes that do not use the result.
    with np.errstate(all="ignore"):
        return int(follow_each(task, part.motions, part.counter, _scratch.tools(memory)))


def _follow_singly(part: Portion, until: float, limits: EventLimits, memory: np.record) -> int:
    """Follow the motions that this call takes from the counter, one after another: for any rotor and trigger."""
    rotor, taken, rubs_known = part.stage.rotor, 0, not memory.resting
    compliant = rotor.system.arrays["stiffness"] > 0.0
    planes, limits_of_bearings = len(rotor.system.arrays["rows"]), rotor.system.limits
    most_events = min(limits.max_events, part.purse.longest)
    scratch, room = tools(rotor), EventLog.empty(LOGGED, rotor.system.modes, planes, limits_of_bearings)
    while (number := int(next_number(part.counter.numbers))) < len(part.motions):
        if not part.purse.suffices(part.first + number):
            return taken
        motion = part.motions[number]
        elapsed = 0.0 if limits.until is None else float(part.elapsed[number])
        end = min(until - elapsed, part.stage.trigger.time)
        start = State.of(motion.position, motion.velocity, time=float(motion.time))
        amplitudes, contact = amplitudes_of(rotor, start)
        reset(memory)
        memory.resting = not rubs_known
        begin_limits(rotor.system, amplitudes, start.time, memory)
        motion.time, motion.impacts, outcome, progress = 0.0, 0, Outcome.EVENT_LIMIT, SettlingProgress()
        events, cost = 0, START
        while outcome is Outcome.EVENT_LIMIT and events < most_events:
            log = room.first(min(LOGGED, most_events - events))
            before = np.where(contact == AWAY, Phase.FLIGHT, contact)
            outcome, time, count = follow(scratch, amplitudes, end - motion.time, contact, log, memory)
            motion.time += time
            motion.impacts += np.count_nonzero(log.first(count).contact_beginnings(before, compliant))
            # A slice of flight has no event.
            events, cost = events + count, cost + (count if count or outcome is not Outcome.EVENT_LIMIT else PER_SLICE)
            outcome, motion.multiplicity = settled(rotor, amplitudes, contact, outcome, memory)
            if part.counter.numbers[0] > STOPPED:
                return taken
            if outcome is Outcome.EVENT_LIMIT and progress.stalls(count, time):
                outcome = Outcome.STALLED
        motion.outcome, part.purse.costs[part.first + number] = outcome, cost
        motion.position, motion.velocity = rotor.system.state(amplitudes)
        taken += 1
    return taken


class _Scratch(threading.local):
    """Scratch arrays of a thread, allocated once."""

    def __init__(self) -> None:
        self.lanes, self.work, self.rub = lanes_record(), workspace(MODES), rub_workspace(MODES)
        self.log, self.amplitudes = EventLog.empty(1, MODES), np.empty(MODES, complex)
        self.contact = np.empty(1, np.int64)

    def tools(self, memory: np.record) -> Tools:
        return Tools(self.lanes, memory, self.log, self.work, self.rub, self.amplitudes, self.contact)


_scratch = _Scratch()
