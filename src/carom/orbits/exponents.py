"""Lyapunov exponents of a motion through impacts, chatter, sliding and rolling, and of a periodic orbit.

Those of machines without closed forms come from the derivatives of the flow that the simulator follows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar, NamedTuple

import numpy as np

from carom.base.arguments import Count, checked, whole
from carom.base.outcome import CaromError, Phase
from carom.base.results import Result
from carom.core.closing import LONGEST
from carom.models import Rotor, Subject, rotor_of
from carom.motions.simulation import simulate
from carom.motions.starts import Beginning, State
from carom.motions.trajectories import Trajectory
from carom.orbits.flow import Flow, FlowBudget
from carom.orbits.happenings import happenings
from carom.orbits.orbit import Orbit
from carom.orbits.shooting import links_of
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.simulated_search import impacts_between
from carom.orbits.word import Kind, Word

STRETCH = 2.0
"""Time of a stretch, in ``1/Ω``, after which directions are made orthogonal."""
NOTHING = 1e-7
"""Factor in a stretch below which a direction is taken away: it is the error of the derivatives."""
EVENTS = 7e6
"""Events (:class:`~carom.orbits.flow.FlowBudget`) after which no further stretch is measured."""
MOST = 100_000
WALL_DISTANCE, CUTS = 1e-3, 41
"""Distance from a rigid wall, in clearances, that is next to it, and times tried at which a stretch may end."""


class Grown:
    """What the stretches of a motion say: logarithms of the growth of each direction, durations, impacts and landings.

    Attributes
    ----------
    logarithms : ndarray, shape (m, n)
    durations : ndarray, shape (m,)
    impacts, landings : int
    along : float
        Logarithm of the growth of a delay, over all of them; 0 where something stands in the fixed frame.
    """

    def __init__(self, rotor: Rotor, state: State, impacts: int, transient: int) -> None:
        self.rotor, self.budget = rotor, FlowBudget(EVENTS / 4)
        motion = simulate(rotor, state, 0.5 * STRETCH, settle=False)
        self.flow, self.vector = Flow.at(motion, _cut(motion), self.budget)
        self.directions = np.linalg.qr(np.random.default_rng(0).normal(size=(len(self.vector),) * 2))[0]
        self._measure(transient)
        self.budget.left = EVENTS  # a long transient must leave something to be measured
        before = self._speed()
        self.durations, self.logarithms, (self.impacts, self.landings) = self._measure(impacts)
        self.along = 0.0 if rotor.system.is_time_dependent else math.log(self._speed() / before)

    def _speed(self) -> float:
        return float(np.linalg.norm(self.flow.rate(self.vector, 0.0)))

    def _measure(self, impacts: int) -> tuple[np.ndarray, np.ndarray, tuple[int, int]]:
        """Follow the motion for a number of impacts and landings, or as long as there is time."""
        found: list[np.ndarray] = []
        durations: list[float] = []
        impacts_seen = landed = 0
        while impacts_seen + landed < impacts and len(found) < MOST and not self.budget.spent:
            motion = self.flow.follow(self.vector, STRETCH)
            if motion is not None and (length := _cut(motion)) < STRETCH:
                motion = self.flow.follow(self.vector, length)
            if motion is None:
                raise CaromError("the motion goes beyond the model: it has no exponents")
            happened = happenings(motion)
            if not happened and not impacts_seen + landed and len(found) > 50:
                raise CaromError("the motion stops hitting the wall: it has no exponents of impacts")
            slopes = self.flow.derivative(self.vector, motion)
            if not np.isfinite(slopes).all():
                raise CaromError("no exponents: a motion that starts next to this one leaves the range of the model")
            self.directions, triangle = np.linalg.qr(slopes @ self.directions)
            found.append(np.log(np.maximum(np.abs(np.diag(triangle)), NOTHING)))
            durations.append(motion.time)
            impacts_seen += sum(each.begins_contact for each in happened)
            landed += sum(each.label == "land" for each in happened)
            self.flow, self.vector = Flow.at(motion, motion.time, self.budget)
        return np.array(durations), np.array(found).reshape(len(found), -1), (impacts_seen, landed)


def _cut(motion: Trajectory) -> float:
    """Time near the end of a stretch at which no plane flies next to a rigid wall, beyond which no motion beside it could begin."""
    system = motion.rotor.system
    times = motion.time * np.linspace(1.0, 0.5, CUTS)
    amplitudes, phases = motion.amplitudes_at(times)
    radii = np.array(
        [[abs(system.at_plane(each, plane)[0]) for plane in range(phases.shape[1])] for each in amplitudes]
    )
    beside = (phases == Phase.FLIGHT) & (system.arrays["stiffness"] == 0.0) & (radii > 1.0 - WALL_DISTANCE)
    clear = np.flatnonzero(~beside.any(axis=1))
    return float(times[clear[0]]) if len(clear) else motion.time


REPEATED = 1e-8
"""Largest distance, relative to one plus the size of the state, between the simulated and the repeated end of a segment."""
CHUNK = 4096
"""Events that are simulated at a time."""
LEFT = 1e-6
"""Factor in any stretch below which a direction counts as taken away."""
TINY = float(np.finfo(float).tiny)
"""Growth of directions that contact takes away, whose exponents are left out: its logarithm is finite."""


@dataclass(frozen=True, eq=False, repr=False)
class LyapunovExponents(Result):
    """Mean rates at which small disturbances of a motion grow.

    A positive value does not prove chaos: the motion may be a long transient (:class:`carom.attractors.Survival` tells
    how long it lasts), and the errors hold for batches that are independent of each other.

    Attributes
    ----------
    values : ndarray, shape (2N,), or (2N + 1,) where something stands in the fixed frame
        All exponents in ``Ω``, the largest first, for ``N`` modes.  One belongs to the disturbance along the motion itself
        (``along``).  Those of directions that a landing, a stopped slip or rolling takes away are minus infinity.
    errors : ndarray
        Standard errors from batches; 0 where the value is minus infinity.  That of ``along`` is its distance from 0.
    along : float
        The exponent along the motion.  It tends to 0 as one over the time.
    volume : float
        Sum of the exponents by the other route: the trace of the flow and the logarithm of the determinant of each impact,
        per time.  Minus infinity where directions are lost; ``nan`` of other machines than the planar rotor in a rigid bearing.
    impacts : int
        Impacts in the time measured, those of chatter included.
    landings : int
        Chatters that ended in lasting contact in this time.
    time : float
        Time measured, in ``1/Ω``: from an impact to an impact.
    """

    shown: ClassVar[tuple[str, ...]] = ("values", "errors", "lost", "impacts", "landings", "time")

    values: np.ndarray
    errors: np.ndarray
    along: float
    volume: float
    impacts: int
    landings: int
    time: float

    @property
    def across(self) -> tuple[float, float]:
        """Largest exponent of disturbances across the motion, in ``Ω``, and its standard error."""
        largest = int(self.values[0] == self.along)
        return float(self.values[largest]), float(self.errors[largest])

    @property
    def per_impact(self) -> np.ndarray | None:
        """The exponents per impact instead of per time; ``None`` for a whirl without impacts."""
        return self.values * (self.time / self.impacts) if self.impacts else None

    @property
    def error_per_impact(self) -> np.ndarray | None:
        """Their standard errors, per impact too."""
        return self.errors * (self.time / self.impacts) if self.impacts else None

    @property
    def lost(self) -> int:
        """Number of directions that are taken away: how many exponents are minus infinity."""
        return int(np.isneginf(self.values).sum())


@checked
def lyapunov_exponents(
    machine: Subject,
    start: State | Beginning,
    impacts: Count = 10_000,
    *,
    transient: Count = 1000,
    batches: Annotated[int, whole(2)] = 20,
) -> LyapunovExponents:
    """Lyapunov exponents of the motion from a start, by QR decomposition of the exact derivatives of its segments.

    The method is that of Benettin, Galgani, Giorgilli and Strelcyn (1980), with the change of the time of each event in the
    derivatives (Müller 1995).  During the transient the directions turn towards those that grow fastest.  For a periodic
    orbit :func:`orbit_exponents` is exact.  With lasting contact, and of other machines than the planar rotor in a rigid bearing, the
    derivatives are central differences of the simulated flow; then fewer impacts are measured if they take too long.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    start : State, kick or other single disturbance
        Co-rotating frame.
    impacts : int
        Number of impacts to measure, those of chatter included.
    transient : int
        Number of impacts to leave out before.
    batches : int
        Number of stretches of the motion from which the errors are computed.

    Raises
    ------
    InputError
        A number is out of range, or the speed of the shaft changes.
    CaromError
        The motion stops hitting the wall, has too few segments, or its segments cannot be repeated to eight digits.
    """
    rotor = rotor_of(machine)
    rotor.system.refuse_non_stationary()
    state = start if isinstance(start, State) else start.stages(rotor)[1]
    found = _by_impacts(rotor, state, impacts, transient, batches) if rotor.has_closed_forms else None
    return found or _by_flow(rotor, state, impacts, transient, batches)


def _by_impacts(rotor: Rotor, state: State, impacts: int, transient: int, batches: int) -> LyapunovExponents | None:
    """The exponents of a motion of the planar rotor by the exact derivatives of its flights; ``None`` if it has lasting contact."""
    directions = np.eye(2 * len(rotor.system.exponents))[:, 1:]
    for stretch in _stretches(rotor, state, transient):
        if stretch is None:
            return None
        directions, _ = _carried(stretch.passages, directions)
        state, last = stretch.end, stretch
    before, grown, stretches = _apart(last.rate, directions), [], []
    for stretch in _stretches(rotor, state, impacts):
        if stretch is None:
            return None
        directions, factors = _carried(stretch.passages, directions)
        grown.append(np.log(np.maximum(factors, TINY)))
        stretches.append(stretch)
    words, durations = [each.word for each in stretches], np.concatenate([each.durations for each in stretches])
    if len(durations) < batches:
        raise CaromError(f"only {len(durations)} segments were measured: raise impacts or lower batches")
    section, time = directions.shape[1], float(durations.sum())
    kept = _directions_kept(rotor, words)
    rate = float((_apart(stretches[-1].rate, directions) - before)[kept]) / time
    values, errors = np.full(section + 1, -np.inf), np.zeros(section + 1)
    values[:kept], errors[:kept] = _means(np.concatenate(grown)[:, :kept], durations, batches)
    values[-1], errors[-1] = rate, abs(rate)
    order = np.argsort(-values, kind="stable")
    volume = _growth_of_volume(rotor, len(durations), time) if kept == section else -math.inf
    return LyapunovExponents(values[order], errors[order], rate, volume, len(durations), 0, time)


def _by_flow(rotor: Rotor, state: State, impacts: int, transient: int, batches: int) -> LyapunovExponents:
    """The exponents of a machine whose motions have no words: by central differences of the flow, for as long as there is time."""
    grown = Grown(rotor, state, impacts, transient)
    if len(grown.durations) < batches:
        raise CaromError(f"only {len(grown.durations)} stretches were measured: raise impacts or lower batches")
    values, errors = _means(grown.logarithms, grown.durations, batches)
    time = float(grown.durations.sum())
    lost = grown.logarithms.min(axis=0) <= math.log(LEFT)
    values[lost], errors[lost] = -np.inf, 0.0
    along = grown.along / time
    if rotor.system.is_time_dependent:
        values, errors = np.append(values, 0.0), np.append(errors, 0.0)
    else:
        place = int(np.argmin(np.abs(values - along)))
        values[place], errors[place] = along, abs(along)
    order = np.argsort(-values, kind="stable")
    return LyapunovExponents(values[order], errors[order], along, math.nan, grown.impacts, grown.landings, time)


@checked
def orbit_exponents(orbit: Orbit | SimulatedOrbit) -> LyapunovExponents:
    """Lyapunov exponents of a periodic orbit from its multipliers: ``log|m|/T``, and 0 along the motion.

    Of orbits that are closed on the flow of the simulator multipliers below 1e-7 count as zero, and ``volume`` is ``nan``.
    """
    if isinstance(orbit, SimulatedOrbit):
        sizes = np.abs(orbit.multipliers.values)
        rates = np.log(np.maximum(sizes, NOTHING)) / orbit.period
        values = -np.sort(-np.append(np.where(sizes < NOTHING, -np.inf, rates), 0.0))
        landings = sum(each.label == "land" for each in orbit.happenings)
        return LyapunovExponents(values, np.zeros(len(values)), 0.0, math.nan, orbit.impacts, landings, orbit.period)
    rotor, kept = orbit.rotor, _directions_kept(orbit.rotor, [orbit.word])
    values = np.full(len(orbit.multipliers.values) + 1, -np.inf)
    values[:kept] = np.log(np.abs(orbit.multipliers.values[:kept])) / orbit.period
    values[-1] = 0.0
    every = kept == len(values) - 1
    volume = _growth_of_volume(rotor, orbit.impacts, orbit.period) if every else -math.inf
    return LyapunovExponents(-np.sort(-values), np.zeros(len(values)), 0.0, volume, orbit.impacts, 0, orbit.period)


class _Stretch(NamedTuple):
    """Segments of a motion from an impact to an impact: derivatives of their ends by their nodes, and ``ċ`` at the end."""

    word: Word
    durations: np.ndarray
    passages: np.ndarray
    rate: np.ndarray
    end: State


def _stretches(rotor: Rotor, state: State, impacts: int) -> Iterator[_Stretch | None]:
    """Follow a motion for a number of impacts; each stretch begins with the impact with which the last one ended.

    ``None`` follows where the motion has anything else than impacts.
    """
    while impacts > 0:
        motion = simulate(rotor, state, LONGEST, max_events=min(CHUNK, 2 * impacts))
        if not motion.is_impact.all():
            yield None
            return
        last = min(impacts, len(motion.is_impact) - 1)
        if last < 1:
            ended = motion.outcome.label
            raise CaromError(f"the motion stops hitting the wall ({ended}): it has no exponents of impacts")
        word, begin = impacts_between(motion, 0, last + 1)
        links = links_of(rotor, word, begin)
        apart = np.abs(links.ends[:-1] - begin.nodes[1:]).max() / (1.0 + np.abs(begin.nodes).max())
        if not (apart <= REPEATED and np.isfinite(links.values).all()):
            raise CaromError(f"the segments of the motion cannot be repeated: their ends are {apart:.3g} apart")
        state = State.of(*rotor.system.state(motion.event_amplitudes[last]))
        yield _Stretch(Word(word[:-1]), begin.durations[:-1], links.passages[:-1], links.slopes[-2, :-1, -1], state)
        impacts -= last


def _carried(passages: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Directions at the end of a stretch, and the factor by which each grew in each segment, shape (m, 2N − 1).

    The directions lie in the section at the node: disturbances that reach the event at the same time.
    """
    factors = np.empty((len(passages), directions.shape[1]))
    for place, passage in enumerate(passages):
        directions, triangle = np.linalg.qr(passage @ directions)
        factors[place] = np.abs(np.diag(triangle))
    return directions, factors


def _apart(rate: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Logarithm of the part of ``ċ`` that is orthogonal to none, one, … and all of the directions, shape (2N,).

    It measures what a disturbance has along the motion.
    """
    apart = [np.linalg.norm(rate - directions[:, :k] @ (directions[:, :k].T @ rate)) for k in range(len(rate))]
    return np.log(apart)


def _directions_kept(rotor: Rotor, words: list[Word]) -> int:
    """Number of directions of the section at an impact that no segment takes away.

    A stopped slip takes away one, and so does the normal velocity that is lost without restitution.
    """
    stopped = any(Kind.IMPACT_STOPPED in word for word in words)
    lost = int(stopped) + int(rotor.system.arrays.restitution[0] == 0.0)
    return 2 * len(rotor.system.exponents) - 1 - lost


def _means(logarithms: np.ndarray, durations: np.ndarray, batches: int) -> tuple[np.ndarray, np.ndarray]:
    """Exponents, and their standard errors from batches of equally many segments."""
    values = logarithms.sum(axis=0) / durations.sum()
    edges = np.linspace(0, len(durations), batches + 1).astype(int)[:-1]
    apart = np.add.reduceat(logarithms - values * durations[:, None], edges)
    return values, np.sqrt(batches / (batches - 1) * (apart**2).sum(axis=0)) / durations.sum()


def _growth_of_volume(rotor: Rotor, impacts: int, time: float) -> float:
    """Rate at which volumes of the state space grow: ``2 Re Σλ`` in flight, and a factor ``d²`` at each impact.

    An impact with slip multiplies the normal velocity by ``−d``; the other velocities change by what depends on it and on
    the position alone.  The change of the time of impact gives the same factor once more.
    """
    losses = float(np.log(rotor.system.arrays.restitution[0]))
    return float(2.0 * rotor.system.exponents.real.sum() + 2.0 * impacts * losses / time)
