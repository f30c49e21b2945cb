"""Ensembles: many starts, each followed until it settles, on all cores."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from carom.arguments import Count, Whole, checked
from carom.core.counter import fresh_counter, next_number
from carom.core.ensemble import MOTION, Task, Tools, follow_each
from carom.core.event_log import EventLog
from carom.core.fate import forget
from carom.core.lanes import lanes_record
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import AWAY, FLIGHT
from carom.core.processors import available_cores
from carom.models import Model, Stage, Subject, model_of, stages_of
from carom.motions.settling import (
    LOW_FOR,
    PATIENCE,
    REPEATING,
    fresh_memory,
    longest_time,
    low_interval,
    may_be_low,
    settled,
)
from carom.motions.starts import LARGEST_SPEED, WALL_TOLERANCE, State, Until, amplitudes_of, time_until
from carom.motions.trajectories import follow
from carom.outcome import InputError, Outcome, Phase
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import Result

MOST_EVENTS = 1_000_000
"""Default number of impacts and steps of lasting contact after which a motion is given up."""
PORTION = 16_384
"""Most starts of one machine in a portion of work that threads share: some milliseconds to a second of work."""
GLANCE = 0.1
"""Seconds between two reports of progress."""
FEW = 256
"""Number of starts of a portion for which one more thread is used: some for each lane."""
MODES = 2
"""Modes of the rotors whose motions are followed side by side."""
LOGGED = 256
"""Events per kernel call for motions that are followed one after another."""


@dataclass(frozen=True, eq=False, repr=False)
class Endings(Result):
    """Where the motions of an ensemble end; every array has the shape of the starts.

    Attributes
    ----------
    outcomes : ndarray of int8
        Codes of :class:`~carom.outcome.Outcome`.
    times : ndarray
        Time at which the outcome was known, in ``1/Ω``.
    impacts : ndarray of int64
        Impacts until then.
    multiplicities : ndarray of int64
        Impacts per period of periodic bouncing; zero otherwise (bouncing with zero is aperiodic).
    positions, velocities : ndarray of complex
        State at that time, co-rotating frame; where the outcome was proven in advance, a state on the way to it.  For a
        rotor of ``n > 1`` coordinates with a last axis of that length.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "brent1980")

    outcomes: np.ndarray
    times: np.ndarray
    impacts: np.ndarray
    multiplicities: np.ndarray
    positions: np.ndarray
    velocities: np.ndarray

    def rows(self) -> list[tuple[str, str]]:
        """How many motions end in each way."""
        codes, counts = np.unique(self.outcomes, return_counts=True)
        return [
            ("motions", str(self.outcomes.size)),
            *((Outcome(int(code)).label, str(count)) for code, count in zip(codes, counts, strict=True)),
        ]

    def __getitem__(self, chosen: np.ndarray | slice) -> Endings:
        """Return some of the endings."""
        return Endings(**{name: values[chosen] for name, values in vars(self).items()})

    @checked
    def count(self, outcome: Outcome | int) -> int:
        """Return how many motions have this outcome."""
        return int(np.count_nonzero(self.outcomes == outcome))

    def reshaped(self, *shape: int) -> Endings:
        """Return the same endings for starts of another shape."""
        ndim = self.outcomes.ndim
        return Endings(**{name: values.reshape((*shape, *values.shape[ndim:])) for name, values in vars(self).items()})

    @property
    def recovered(self) -> np.ndarray:
        """Which motions return to levitation and stay there."""
        recovered: np.ndarray = self.outcomes == Outcome.LEVITATED
        return recovered


@checked
@shows_progress
def settle(
    machine: Subject | Sequence[Subject],
    positions: np.ndarray,
    velocities: np.ndarray,
    *,
    which: np.ndarray | None = None,
    until: Until | None = None,
    patience: Whole = PATIENCE,
    max_events: Count = MOST_EVENTS,
    threads: Count | None = None,
    progress: ShowProgress = None,
) -> Endings:
    """Follow many starts, each as :func:`~carom.motions.trajectories.simulate` would, and keep how they end.

    A motion ends early when its outcome is proven: when it slides into an absorbing neighbourhood of the synchronous
    rub (:func:`~carom.closed_forms.absorbing.rub_neighbourhood`), or whirls backward fast enough to run away to rolling
    (:func:`~carom.closed_forms.whirl.runaway_speed`).  ``simulate`` follows it until it has reached the rub or rolls.

    The result does not depend on the number of threads, to the last bit: motions do not influence each other.  Those of
    rotors with one contact plane and one pair of modes are followed side by side, which is much faster.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model, or a sequence of them
        In a sequence: ``which`` assigns one of the machines to each start.
    positions, velocities : array_like of complex
        Starts in the co-rotating frame, broadcast to one shape; ``|U| ≤ 1``.  For a rotor of ``n > 1`` coordinates with a
        last axis of that length.
    which : array_like of int, optional
        With a sequence: the index of the machine of each start, of the same shape.
    until : float or str
        Time after which a motion that has not settled is given up, in ``1/Ω`` or text with a unit, such as ``"2 s"``; by
        default :func:`~carom.motions.settling.longest_time` of its machine.
    patience : int
        Impacts without recurrence after which bouncing counts as aperiodic.  With 0 all motions are followed to
        ``until``, settled or not; otherwise each ends as soon as its outcome is known (criteria in
        :mod:`carom.core.fate`).
    max_events : int
        Impacts and steps of lasting contact after which a motion is given up.
    threads : int, optional
        By default the number of available cores.

    Raises
    ------
    InputError
        A start lies outside the wall, is too fast or not finite; ``which`` is no valid index; or a limit is out of
        range.

    See Also
    --------
    carom.simulate : one motion, with its contacts
    carom.map_basins : starts that a disturbance leads to

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> endings = cm.settle(machine, [0.2, 0.9j], [0.0, -1.0])
    >>> [cm.outcome.Outcome(code).label for code in endings.outcomes]
    ['forward-rub', 'forward-rub']
    """
    rotors, which = _machines(machine, which)
    coordinates = _coordinates(rotors)
    positions, velocities = _read("positions", positions, coordinates), _read("velocities", velocities, coordinates)
    shapes = [values.shape[: values.ndim - len(coordinates)] for values in (positions, velocities)] + [which.shape]
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        raise InputError("start positions, velocities, which", shapes, "arrays of shapes that fit together") from None
    positions, velocities = (np.broadcast_to(values, shape + coordinates) for values in (positions, velocities))
    which = np.broadcast_to(which, shape).ravel()
    _check_starts(positions, velocities, all(rotor.system.is_planar for rotor in rotors))
    for rotor in rotors if until is not None or patience == 0 else ():
        time_until(until, rotor.scales)
    positions, velocities = (values.reshape(len(which), *coordinates) for values in (positions, velocities))
    limits, threads = _Limits(until, patience, max_events), threads or available_cores()
    tell = Reporter.of(progress, "following starts")
    endings = _followed(rotors, which, positions, velocities, limits, threads, tell)
    _note_low_bounces(rotors, which, endings, limits, threads)
    return endings.reshaped(*shape)


def _followed(
    rotors: Sequence[Model],
    which: np.ndarray,
    positions: np.ndarray,
    velocities: np.ndarray,
    limits: _Limits,
    threads: int,
    tell: Reporter,
) -> Endings:
    """Endings of starts in one dimension, through all stages."""
    courses = [stages_of(rotor) for rotor in rotors]
    begins = np.zeros(len(which))
    endings = _in_stage(
        [stages[0] for stages in courses], which, (positions, velocities, begins), limits, threads, tell
    )
    for number in range(1, max(map(len, courses), default=1)):
        further = np.array([number < len(stages) for stages in courses])[which]
        on = np.flatnonzero(further & (endings.outcomes == Outcome.TRIGGERED))
        before = endings[on]
        for machine, stages in enumerate(courses):
            here = which[on] == machine
            carried = stages[number - 1].carried(before.positions[here], before.velocities[here])
            before.positions[here], before.velocities[here] = carried
        states = before.positions, before.velocities, before.times
        later = _in_stage(
            [stages[min(number, len(stages) - 1)] for stages in courses], which[on], states, limits, threads, tell
        )
        later.times[:] += before.times
        later.impacts[:] += before.impacts
        for name, values in vars(endings).items():
            values[on] = getattr(later, name)
    return endings


def _in_stage(
    stages: Sequence[Stage],
    which: np.ndarray,
    starts: tuple[np.ndarray, np.ndarray, np.ndarray],
    limits: _Limits,
    threads: int,
    tell: Reporter,
) -> Endings:
    """Endings in one stage of each machine, with times that count from its beginning; starts are positions, velocities and times."""
    # The starts of each machine are followed together, in portions; their endings are put back into the order of the starts.
    order = slice(None) if len(stages) == 1 else np.argsort(which, kind="stable")
    motions = _motions(*(values[order] for values in starts))
    parts = []
    for number, portion in _portions(which[order], len(stages)):
        part = _Part(stages[number], motions[portion], fresh_counter())
        parts += [part] * min(threads, 1 + len(part.motions) // FEW)
    done = 0
    for finished in _settle_parts(parts, limits, threads):
        done += finished
        tell(done / len(motions))
    endings = _endings(motions, order)
    ends = np.array([stage.trigger.time for stage in stages])[which]
    endings.outcomes[(endings.outcomes == Outcome.TIME_REACHED) & (endings.times >= ends)] = Outcome.TRIGGERED
    return endings


def _note_low_bounces(
    rotors: Sequence[Model], which: np.ndarray, endings: Endings, limits: _Limits, threads: int
) -> None:
    """Note, in place, which motions that do not repeat stay at the wall in low bounces; they are followed further to see that."""
    may = np.array([len(stages_of(rotor)) == 1 and may_be_low(rotor, limits.patience) for rotor in rotors], bool)
    doubtful = np.flatnonzero(np.isin(endings.outcomes, REPEATING) & (endings.multiplicities == 0) & may[which])
    if not len(doubtful):
        return
    here, which = endings[doubtful], which[doubtful]
    look = limits._replace(until=None, patience=LOW_FOR)
    ends = _followed(rotors, which, here.positions, here.velocities, look, threads, Reporter.of(None, ""))
    intervals = np.array([low_interval(rotor) for rotor in rotors])[which]
    low = np.isin(ends.outcomes, REPEATING) & (ends.multiplicities == 0) & (ends.times < intervals * ends.impacts)
    endings.outcomes[doubtful[low]] = Outcome.LOW_BOUNCES


def _coordinates(rotors: Sequence[Model]) -> tuple[int, ...]:
    """Last axes of positions: none for rotors of one coordinate."""
    counts = {len(rotor.system.rest) for rotor in rotors} or {1}
    if len(counts) > 1:
        raise InputError("machine", f"rotors of {sorted(counts)} coordinates", "rotors of equally many coordinates")
    (count,) = counts
    return () if count == 1 else (count,)


def _read(name: str, given: np.ndarray, coordinates: tuple[int, ...]) -> np.ndarray:
    """Complex numbers with a last axis of the coordinates."""
    values = np.asarray(given, complex)
    if values.shape[values.ndim - len(coordinates) :] != coordinates:
        raise InputError(f"start {name}", values.shape, f"an array with a last axis of {coordinates[0]} coordinates")
    return values


class _Limits(NamedTuple):
    until: float | str | None
    patience: int
    max_events: int


def _machines(machine: Subject | Sequence[Subject], which: np.ndarray | None) -> tuple[Sequence[Model], np.ndarray]:
    """Models of one machine or of several, and the index of the machine of each start."""
    if isinstance(machine, Subject):
        if which is not None:
            raise InputError("which", which, "left out where there is one machine")
        return [model_of(machine)], np.zeros((), np.int64)
    if which is None:
        raise InputError("which", which, "the machine of each start, where there are several")
    rotors = [model_of(one) for one in machine]
    chosen = np.asarray(which)
    if not chosen.size:
        return rotors, chosen.astype(np.int64)
    if not np.issubdtype(chosen.dtype, np.integer) or chosen.min() < 0 or chosen.max() >= len(rotors):
        raise InputError("which", chosen, f"whole numbers from 0 to {len(rotors) - 1}")
    return rotors, chosen


def _check_starts(positions: np.ndarray, velocities: np.ndarray, planar: bool) -> None:
    fast = np.abs(velocities) > LARGEST_SPEED
    if fast.any():
        raise InputError("start velocity", velocities[fast].flat[0], f"a speed up to {LARGEST_SPEED:g}")
    outside = np.abs(positions) > 1.0 + WALL_TOLERANCE
    if planar and outside.any():
        raise InputError("start position", positions[outside].flat[0], "inside the wall, |U| <= 1")


def _motions(positions: np.ndarray, velocities: np.ndarray, times: np.ndarray) -> np.recarray:
    """Records of motions at their starts, for the kernel to fill."""
    axes = {"position": positions.shape[1:], "velocity": positions.shape[1:]}
    kind = np.dtype([(name, MOTION[name], axes.get(name, ())) for name in MOTION.names or ()])
    motions = np.recarray(positions.shape[:1], kind)
    motions.position, motions.velocity, motions.time = positions, velocities, times
    if positions.ndim == 1:
        motions.contact = np.where(np.abs(positions) >= 1.0 - WALL_TOLERANCE, FLIGHT, AWAY)
    return motions


def _portions(which: np.ndarray, machines: int) -> Iterator[tuple[int, slice]]:
    """Yield the machine and the slice of starts of each portion of work; starts are sorted by machine."""
    ends = np.searchsorted(which, np.arange(machines + 1))
    for machine in range(machines):
        for first in range(ends[machine], ends[machine + 1], PORTION):
            yield machine, slice(first, min(first + PORTION, ends[machine + 1]))


class _Part(NamedTuple):
    """Motions of one machine; all threads that hold the same part take motions from it by its shared counter."""

    stage: Stage
    motions: np.ndarray
    counter: np.record


def _settle_parts(parts: list[_Part], limits: _Limits, threads: int) -> Iterator[int]:
    """Follow all parts, in this thread if one suffices; yield now and then the number of motions followed since.

    When the caller stops iterating or is interrupted, no thread takes up another motion.
    """
    if min(threads, len(parts)) == 1:
        yield from (_settle_part(part, limits) for part in parts)
        return
    with ThreadPoolExecutor(threads) as pool:
        try:
            working = {pool.submit(_settle_part, part, limits) for part in parts}
            while working:
                finished, working = wait(working, GLANCE, FIRST_COMPLETED)
                yield sum(one.result() for one in finished)
        except BaseException:
            for part in parts:
                part.counter.numbers[0] = len(part.motions)
            pool.shutdown(cancel_futures=True)
            raise


def _settle_part(part: _Part, limits: _Limits) -> int:
    """Follow motions of a part until none is left; return how many this call has followed."""
    rotor, trigger = part.stage.rotor, part.stage.trigger
    until = longest_time(rotor) if limits.until is None else time_until(limits.until, rotor.scales)
    # What has settled may still be ended by a time.
    memory = fresh_memory(rotor, limits.patience if trigger.time == np.inf else 0, absorb=True, trigger=trigger)
    if (
        not rotor.system.is_planar
        or trigger.watches_contact
        or (limits.until is not None and part.motions["time"].any())
    ):
        return _follow_singly(part, until, limits, memory)
    task = Task(rotor.system.arrays, rotor.system.table, min(until, trigger.time), limits.max_events)
    # Without the compiler, NumPy warns of divisions in lanes that do not use the result.
    with np.errstate(all="ignore"):
        return int(follow_each(task, part.motions, part.counter, _scratch.tools(memory)))


def _follow_singly(part: _Part, until: float, limits: _Limits, memory: np.record) -> int:
    """Follow the motions that this call takes from the counter, one after another: for any rotor and trigger."""
    rotor, taken, rubs_known = part.stage.rotor, 0, not memory.resting
    while (number := int(next_number(part.counter.numbers))) < len(part.motions):
        motion = part.motions[number]
        begins = float(motion.time)
        end = min(until if limits.until is None else until - begins, part.stage.trigger.time)
        amplitudes, contact = amplitudes_of(rotor, State.of(motion.position, motion.velocity), begins)
        forget(memory)
        memory.resting = not rubs_known
        motion.time, motion.impacts, events, outcome = 0.0, 0, 0, Outcome.EVENT_LIMIT
        while outcome is Outcome.EVENT_LIMIT and events < limits.max_events:
            log = EventLog.empty(min(LOGGED, limits.max_events - events), len(amplitudes), len(contact))
            before = np.where(contact == AWAY, Phase.FLIGHT, contact)
            outcome, time, count = follow(rotor, amplitudes, end - motion.time, contact, log, memory)
            motion.time += time
            motion.impacts += np.count_nonzero(log.first(count).impacts(before))
            events += count
            outcome, motion.multiplicity = settled(rotor, amplitudes, contact, outcome, memory)
        motion.outcome = outcome
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


def _endings(motions: np.recarray, order: np.ndarray | slice) -> Endings:
    """Endings in the order of the starts."""

    def gather(name: str, kind: type) -> np.ndarray:
        found = motions[name]
        values: np.ndarray = np.empty(found.shape, kind)
        values[order] = found
        return values

    return Endings(
        outcomes=gather("outcome", np.int8),
        times=gather("time", float),
        impacts=gather("impacts", np.int64),
        multiplicities=gather("multiplicity", np.int64),
        positions=gather("position", complex),
        velocities=gather("velocity", complex),
    )
