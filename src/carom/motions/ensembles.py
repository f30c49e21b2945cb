"""Ensembles: many starts, each followed until it settles, on all cores."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from carom.base.arguments import Count, Whole, checked, kind_of_numbers
from carom.base.outcome import InputError, Outcome, shown
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result
from carom.core.processors import available_cores
from carom.models import Rotor, Stage, Subject, rotor_of
from carom.models.stages import stages_of
from carom.motions.budget import NOT_FOLLOWED, present_question
from carom.motions.portions import EventLimits, motions_from, parts_of, settle_parts
from carom.motions.settling import (
    LOW_FOR,
    PATIENCE,
    REPEATING,
    may_be_low,
)
from carom.motions.simulation import Following, stretches
from carom.motions.starts import LARGEST_SPEED, WALL_TOLERANCE, State, Until, arrays_of
from carom.parameters import own_time

MOST_EVENTS = 1_000_000
"""Default number of impacts and steps of lasting contact after which a motion is given up."""


@dataclass(frozen=True, eq=False, repr=False)
class Endings(Result):
    """Where the motions of an ensemble end; every array has the shape of the starts.

    Attributes
    ----------
    outcomes : ndarray of int8
        Codes of :class:`~carom.base.outcome.Outcome`.
    times : ndarray
        Time at which the outcome was known, in ``1/Ω``.
    impacts : ndarray of int64
        Impacts until then.
    multiplicities : ndarray of int64
        Impacts per period of periodic bouncing; zero otherwise (bouncing with zero is aperiodic).
    positions, velocities : ndarray of complex
        State at that time, co-rotating frame; where the outcome was proven in advance, a state on the way to it.  For a
        rotor of ``n > 1`` coordinates with a last axis of that length.
    begins : ndarray
        Times at which the starts were taken, from which ``times`` count.
    """

    outcomes: np.ndarray
    times: np.ndarray
    impacts: np.ndarray
    multiplicities: np.ndarray
    positions: np.ndarray
    velocities: np.ndarray
    begins: np.ndarray

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

    def state(self, place: int) -> State:
        """State of one of the motions of an ensemble in one dimension at that time."""
        time = float(self.begins[place] + self.times[place])
        return State.of(self.positions[place], self.velocities[place], time=time)

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
    starts: State,
    *,
    which: np.ndarray | None = None,
    until: Until | None = None,
    patience: Whole = PATIENCE,
    max_events: Count = MOST_EVENTS,
    threads: Count | None = None,
    progress: ShowProgress = None,
) -> Endings:
    """Follow many starts, each as :func:`~carom.motions.simulation.simulate` would, and keep how they end.

    A motion ends early when its outcome is proven: when it slides into an absorbing neighbourhood of the synchronous
    rub (:func:`~carom.closed_forms.absorbing.rub_neighbourhood`), or whirls backward fast enough to run away to rolling
    (:func:`~carom.closed_forms.whirl.runaway_speed`).  ``simulate`` follows it until it has reached the rub or rolls.

    The result does not depend on the number of threads, to the last bit: motions do not influence each other.  Those of
    rotors with one contact plane and one pair of modes are followed side by side, which is much faster.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model, or a sequence of them
        In a sequence: ``which`` assigns one of the machines to each start.
    starts : State
        Many in one: arrays of positions, velocities and times, broadcast to one shape; ``|U| ≤ 1``.  Races and a shaft have the speeds that the
        rotor begins with.
    which : array_like of int, optional
        With a sequence: the index of the machine of each start, of the same shape.
    until : float or str
        Time after which a motion that has not settled is given up, in ``1/Ω`` or text with a unit, such as ``"2 s"``; by
        default :func:`~carom.motions.settling.longest_time` of its machine.
    patience : int
        Impacts without recurrence after which bouncing counts as aperiodic.  With 0 all motions are followed to
        ``until``, settled or not; otherwise each ends as soon as its outcome is known (criteria in
        :mod:`carom.core.settling`).
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
    >>> endings = cm.settle(machine, cm.State([0.2, 0.9j], [0.0, -1.0]))
    >>> [cm.outcome.Outcome(code).label for code in endings.outcomes]
    ['forward-rub', 'forward-rub']
    """
    rotors, which = _machines(machine, which)
    shape, which, begun = _broadcast(rotors, which, starts)
    for rotor in rotors if until is not None or patience == 0 else ():
        own_time("until", until, rotor.scales)
    tell = Reporter.of(progress, "following starts")
    limits = EventLimits(until, patience, max_events, threads or available_cores(), tell)
    endings = _followed([stages_of(rotor) for rotor in rotors], which, begun, limits)
    present_question().count(endings.outcomes)
    return endings.reshaped(*shape)


_Begun = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""Positions and velocities at the beginning of a stage, the times at which the starts were taken, and those elapsed since."""


def _followed(courses: Sequence[Sequence[Stage]], which: np.ndarray, starts: _Begun, limits: EventLimits) -> Endings:
    """Endings of starts in one dimension, through all stages of their machines."""
    for stages in courses:
        systems = [stage.rotor.system for stage in stages]
        # Of many motions these speeds are not kept.
        if len(stages) > 1 and any(each.races is not None or each.shaft is not None for each in systems):
            turning = "a race that turns, or a shaft whose speed changes, in stages"
            raise InputError("machine", turning, "one motion at a time: carom.simulate keeps these speeds")
    endings = _in_stage([stages[0] for stages in courses], which, starts, limits)
    for number in range(1, max(map(len, courses), default=1)):
        further = np.array([number < len(stages) for stages in courses])[which]
        on = np.flatnonzero(further & (endings.outcomes == Outcome.TRIGGERED))
        before = endings[on]
        for machine in np.unique(which[on]).tolist():
            here = which[on] == machine
            ended, begun = courses[machine][number - 1 : number + 1]
            places, speeds = ended.carried(before.positions[here], before.velocities[here])
            if ended.carry is not None:
                _check_starts(places, speeds, begun.rotor.system.is_planar)
            before.positions[here], before.velocities[here] = places, speeds
        states = before.positions, before.velocities, before.begins, before.times
        later = _in_stage([stages[min(number, len(stages) - 1)] for stages in courses], which[on], states, limits)
        later.times[:] += before.times
        later.impacts[:] += before.impacts
        for name, values in vars(endings).items():
            values[on] = getattr(later, name)
    return endings


def _in_stage(stages: Sequence[Stage], which: np.ndarray, starts: _Begun, limits: EventLimits) -> Endings:
    """Endings in one stage of each machine, with times that count from its beginning, and low bounces distinguished from others.

    Motions that do not repeat are followed further to see whether they stay at the wall in low bounces.
    """
    endings, rotors = _settled(stages, which, starts, limits), [stage.rotor for stage in stages]
    may = np.array([may_be_low(rotor, limits.patience) for rotor in rotors], bool)
    doubtful = np.flatnonzero(np.isin(endings.outcomes, REPEATING) & (endings.multiplicities == 0) & may[which])
    look, times = Following(True, False, LOW_FOR, limits.max_events, Reporter.of(None, "")), starts[2] + starts[3]
    for place in doubtful.tolist():
        state = endings.positions[place], endings.velocities[place]
        start = State.of(*state, time=float(times[place] + endings.times[place]))
        *_, last = stretches(rotors[which[place]], start, None, look)
        if last.outcome is Outcome.LOW_BOUNCES:
            endings.outcomes[place] = last.outcome
    return endings


def _settled(stages: Sequence[Stage], which: np.ndarray, starts: _Begun, limits: EventLimits) -> Endings:
    """Endings in one stage, in which the starts of each machine are followed together, in portions."""
    order, question = slice(None) if len(stages) == 1 else np.argsort(which, kind="stable"), present_question()
    if len(stages) == 1 and question.left < np.inf:
        # Those that the events of a question suffice for are a fair part of all.
        order = np.random.default_rng(len(which)).permutation(len(which))
    positions, velocities, begins, elapsed = (values[order] for values in starts)
    motions = motions_from(positions, velocities, begins + elapsed)
    purse = question.purse(len(motions))
    done = 0
    for finished in settle_parts(parts_of(stages, which[order], motions, elapsed, purse, limits.threads), limits):
        done += finished
        limits.tell(done / len(motions))
    question.pay(purse)
    missed = ~purse.followed
    motions[missed] = np.zeros((), motions.dtype)
    motions.outcome[missed] = NOT_FOLLOWED
    found = np.empty_like(motions)
    found[order] = motions  # in the order of the starts
    ends = np.array([stage.trigger.time for stage in stages])[which]
    reached = (found.outcome == Outcome.TIME_REACHED) & (found.time >= ends)
    return Endings(
        outcomes=np.where(reached, Outcome.TRIGGERED, found.outcome).astype(np.int8),
        times=found.time.copy(),
        impacts=found.impacts.astype(np.int64),
        multiplicities=found.multiplicity.astype(np.int64),
        positions=found.position.copy(),
        velocities=found.velocity.copy(),
        begins=starts[2].copy(),
    )


def _broadcast(rotors: Sequence[Rotor], which: np.ndarray, starts: State) -> tuple[tuple[int, ...], np.ndarray, _Begun]:
    """The shape of all starts, and in one dimension the numbers of their machines and themselves."""
    counts = {len(rotor.system.rest) for rotor in rotors} or {1}
    if len(counts) > 1:
        raise InputError("machine", f"rotors of {sorted(counts)} coordinates", "rotors of equally many coordinates")
    if starts.races or starts.shaft:
        raise InputError("start races, shaft", shown(starts), "left out: of many motions these speeds are not kept")
    if kind_of_numbers(starts.time) not in "iuf":
        raise InputError("start time", shown(starts.time), "finite real numbers")
    coordinates = tuple(counts - {1})  # last axes of positions: none for rotors of one coordinate
    parts, started = arrays_of(starts), np.asarray(starts.time, float)
    own = [values.ndim - len(coordinates) for values in parts]
    for name, values, axes in zip(("position", "velocity"), parts, own, strict=True):
        if values.shape[axes:] != coordinates:
            allowed = f"an array with a last axis of {coordinates[0]} coordinates"
            raise InputError(f"start {name}", values.shape, allowed)
    shapes = *(values.shape[:axes] for values, axes in zip(parts, own, strict=True)), which.shape, started.shape
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        raise InputError(
            "start position, velocity, time, which", shapes, "arrays of shapes that fit together"
        ) from None
    places, speeds = (np.broadcast_to(values, shape + coordinates) for values in parts)
    which, started = (np.broadcast_to(values, shape).ravel() for values in (which, started))
    _check_starts(places, speeds, all(rotor.system.is_planar for rotor in rotors))
    places, speeds = (values.reshape(len(which), *coordinates) for values in (places, speeds))
    return shape, which, (places, speeds, started, np.zeros(len(which)))


def _machines(machine: Subject | Sequence[Subject], which: np.ndarray | None) -> tuple[Sequence[Rotor], np.ndarray]:
    """Models of one machine or of several, and the index of the machine of each start."""
    if isinstance(machine, Subject):
        if which is not None:
            raise InputError("which", which, "left out where there is one machine")
        return [rotor_of(machine)], np.zeros((), np.int64)
    if which is None:
        raise InputError("which", which, "the machine of each start, where there are several")
    rotors = [rotor_of(one) for one in machine]
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
