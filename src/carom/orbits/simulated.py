"""Periodic motions of any machine, closed on the flow that the simulator follows.

A period begins in a flight, or where the motion rests on walls for long; what happens in it is read from the simulated motion.  The state
there and, where nothing stands in the fixed frame, the period are the unknowns of Newton's method; else the period is a whole number of turns.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.extremes import Extremes, extremes_of
from carom.orbits.flow import TURN, Flow, krylov, repeats_after
from carom.orbits.happenings import Happening, happenings, told
from carom.orbits.maps import Section
from carom.orbits.names import CountedName, RubbingName
from carom.orbits.stability import Multipliers
from carom.outcome import Phase
from carom.parameters import Scales
from carom.results import Result

ITERATIONS = 12
TOLERANCE, ACCEPTED = 1e-11, 3e-9
"""Distance of the end from the start, relative to one plus the size of the state, at which Newton's method stops; and that which is accepted
where rounding lets it fall no further."""
KEPT = 0.1
"""Factor by which the distance must fall for the derivative to be kept."""
LONGEST_STEP, BACKTRACKS = 0.3, 5
"""Largest change of the state in a step, relative to one plus its size; and halvings of a step that leads farther away."""
OFF_PERIOD = 0.05
"""Largest distance of a time from a whole number of turns, in these, at which it is taken for it."""
SHORTER, SHORTEST = 0.5, 1e-2
"""Least period that Newton's method may lead to, relative to that of the guess, and in ``1/Ω``: no time at all closes any path."""
DENSE, DIRECTIONS = 40, 24
"""Numbers of a state up to which its whole derivative is computed; and the directions in which it is known beyond."""
SAME, CLOSE = 1e-6, 1e-5
STILL = 1e-6
"""Rate of change of the state below which a rotor is at rest in its frame: a synchronous rub is no orbit."""
MOST_PARTS = 64
"""Most shorter periods of which a period may consist."""


@dataclass(frozen=True, eq=False, repr=False)
class SimulatedOrbit(Result):
    """A periodic motion of any machine: races that turn, limits that are met, several bearings that touch at a time.

    Attributes
    ----------
    rotor : Model
    name : CountedName
    start : State
        Where the period begins, between two events.
    period : float
        In ``1/Ω``.
    multipliers : Multipliers
        Factors by which small disturbances grow in a period, without the one of a delay where nothing stands in the fixed frame; of a rotor
        of many states the leading ones.
    complete : bool
        Whether these are all.
    repeats : float or None
        Time of which the period is a multiple; ``None`` if it could have any.
    """

    shown: ClassVar[tuple[str, ...]] = ("rotor", "name", "segments", "period", "turns", "start", "extremes", "stable")

    rotor: Any
    name: Any
    start: State
    period: float
    multipliers: Multipliers
    complete: bool
    repeats: float | None
    rests: tuple[tuple[int, bool], ...] = ()

    reason: ClassVar[str] = ""
    admissible: ClassVar[bool] = True

    @property
    def flow(self) -> Flow:
        """The flow that it is a closed path of."""
        return Flow(self.rotor, self.start.time, self.rests)

    @cached_property
    def motion(self) -> Trajectory:
        """One period."""
        motion = self.flow.follow(Flow.vector(self.start), self.period)
        if motion is None:
            raise RuntimeError("the motion of an orbit is followed to its end")
        return motion

    @property
    def departure(self) -> State:
        """State where the period begins."""
        return self.start

    def plot(self, *args: Any, **options: Any) -> Any:
        """Draw one period of it, as :func:`carom.plots.motion` draws any motion."""
        return self.trajectory().plot(*args, **options)

    def trajectory(self, periods: float = 1.0) -> Trajectory:
        """Follow it by simulation, from where its period begins."""
        from carom.motions.simulation import simulate

        return simulate(self.rotor, self.start, periods * self.period)

    @cached_property
    def happenings(self) -> tuple[Happening, ...]:
        """What happens in a period, from the fastest arrival at a wall on."""
        found = happenings(self.motion)
        arrivals = [place for place, each in enumerate(found) if each.arrives]
        if not arrivals:
            return tuple(found)
        speeds = [self.section_of(found[place]).radial_speed for place in arrivals]
        first = arrivals[int(np.argmax(speeds))]
        return (*found[first:], *found[:first])

    @property
    def segments(self) -> str:
        """The same as text."""
        return told(self.happenings) or "contact that never changes"

    @property
    def word(self) -> str:
        """The same: what happens is no word of segments at one touchdown bearing."""
        return self.segments

    @property
    def flies(self) -> bool:
        """Whether it only bounces, without lasting contact."""
        return bool((self.motion.segment_phases == Phase.FLIGHT).all())

    @property
    def impacts(self) -> int:
        """Arrivals at a wall in a period, without those of a chatter."""
        return sum(each.arrives for each in self.happenings)

    @property
    def turns(self) -> int | None:
        """Turns of the shaft in a period, where it must be whole turns."""
        return round(self.period / TURN) if self.repeats == TURN else None

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out."""
        return self.multipliers.stable

    def section_of(self, happening: Happening) -> Section:
        """Place and speed of the plane of an event just before it."""
        plane = self.leading_plane if happening.limits else happening.place
        position, velocity = self.rotor.system.at_plane(self.motion.arrivals[happening.event], plane)
        return Section.from_state(complex(position), complex(velocity))

    @property
    def leading_plane(self) -> int:
        """Contact plane of the first event; where there is none, that which touches."""
        if self.happenings and not self.happenings[0].limits:
            return self.happenings[0].place
        return int(np.argmax((self.motion.segment_phases != Phase.FLIGHT).any(axis=0)))

    @cached_property
    def section(self) -> Section:
        """Place and speed at the first event; where there is none, at the start, of the plane that touches."""
        if self.happenings:
            return self.section_of(self.happenings[0])
        position, velocity = self.rotor.system.at_plane(self.motion.segment_amplitudes[0], self.leading_plane)
        return Section.from_state(complex(position), complex(velocity))

    @property
    def contacts(self) -> list[tuple[str, int, float, Section]]:
        """Kind, contact plane (of a limit its number) and time since the first of each happening, and the state there."""
        begun = self.happenings[0].time if self.happenings else 0.0
        return [
            (
                each.label,
                each.place // 2 if each.limits else each.place,
                (each.time - begun) % self.period,
                self.section_of(each),
            )
            for each in self.happenings
        ]

    @property
    def impulse(self) -> float:
        """Largest normal impulse of a contact in the period at the plane of the first event, in ``m c_r Ω``; ``nan`` without any."""
        impulses = self.motion.seen_at(self.leading_plane).log.normal_impulse
        return float(impulses.max()) if len(impulses) else np.nan

    @property
    def impact_speeds(self) -> np.ndarray:
        """``ṙ`` of the fastest arrival in ``c_r Ω``, shape (1,)."""
        return np.array([self.radial_speed])

    def moved(
        self, flow: Flow, vector: np.ndarray, period: float, multipliers: np.ndarray, name: Any
    ) -> SimulatedOrbit:
        """Another closed path that repeats as this one does."""
        state = flow.state(vector)
        return replace(
            self,
            rotor=flow.rotor,
            name=name,
            start=state,
            period=period,
            multipliers=Multipliers(multipliers),
            complete=True,
            rests=flow.rests,
        )

    @property
    def radial_speed(self) -> float:
        """``ṙ`` just before the first event in ``c_r Ω``."""
        return self.section.radial_speed

    @property
    def angle(self) -> float:
        """``θ`` there in rad."""
        return self.section.angle

    @property
    def angular_speed(self) -> float:
        """``θ̇`` there in ``Ω``."""
        return self.section.angular_speed

    @property
    def scales(self) -> Scales | None:
        """Scales of what is told of the plane of the first event: lengths there are in its own clearance."""
        return self.rotor.system.scales_at(self.leading_plane, self.rotor.scales)

    @cached_property
    def extremes(self) -> Extremes:
        """Largest radius, depth and force."""
        return extremes_of(self.motion)

    @cached_property
    def arrivals(self) -> np.ndarray:
        """States just before the arrivals at walls, complex, shape (k, 2n)."""
        events = [each.event for each in self.happenings if each.arrives]
        return self.rotor.system.states_of(self.motion.arrivals[events])


def close(motion: Trajectory, begin: float, period: float) -> SimulatedOrbit | None:
    """Close the periodic orbit next to a stretch of a motion.

    Parameters
    ----------
    motion : Trajectory
    begin, period : float
        Where the stretch begins, in the time of the motion, and how long it is.

    Returns
    -------
    SimulatedOrbit or None
        ``None`` if Newton's method does not converge, or to levitation.
    """
    whole = _stretch(motion, begin, period) if period > SHORTEST else None
    if whole is None:
        return None
    known = repeats_after(whole)
    if known is not None:
        count = round(period / known)
        if count < 1 or abs(period - count * known) > OFF_PERIOD * known:
            return None
        period = count * known
    flow, vector = Flow.at(whole, quietest(whole))
    found = newton(flow, vector, period, free=known is None)
    if found is None:
        return None
    vector, period = found
    return _orbit(flow, vector, period, known)


def _stretch(motion: Trajectory, begin: float, period: float) -> Trajectory | None:
    """One period from an instant of a motion on, followed anew."""
    flow, vector = Flow.at(motion, begin)
    return flow.follow(vector, period)


def quietest(motion: Trajectory) -> float:
    """Middle of the longest flight of a motion, or else of its longest stretch without an event."""
    events = np.unique([0.0, *(each.time for each in happenings(motion)), motion.time])
    lengths, middles = np.diff(events), 0.5 * (events[1:] + events[:-1])
    _, phases = motion.amplitudes_at(middles)
    flies = (phases == Phase.FLIGHT).all(axis=1)
    lengths = np.where(flies | ~flies.any(), lengths, 0.0)
    return float(middles[int(np.argmax(lengths))])


def newton(flow: Flow, vector: np.ndarray, period: float, *, free: bool) -> tuple[np.ndarray, float] | None:
    """Solve for a closed path of the flow next to a state; with a ``free`` period this is an unknown too."""
    motion = flow.follow(vector, period)
    if motion is None:
        return None
    apart, step, guess = flow.vector(motion.final) - vector, None, period
    miss = _size(apart, vector)
    for _ in range(ITERATIONS):
        if miss <= TOLERANCE:
            break
        if step is None:
            step = _solver(flow, vector, period, motion, free=free)
        change = step(-apart)
        if change is None:
            return None
        length = float(np.abs(change).max()) / (1.0 + float(np.abs(vector).max()))
        share, before = min(1.0, LONGEST_STEP / length if length > 0.0 else 1.0), miss
        for _ in range(BACKTRACKS):
            there = vector + share * change[: len(vector)]
            later = period + share * float(change[-1]) if free else period
            ahead = flow.follow(there, later) if later > SHORTER * guess else None
            if ahead is not None and _size(flow.vector(ahead.final) - there, there) < miss:
                break
            share *= 0.5
        else:
            break
        vector, period, motion = there, later, ahead
        apart = flow.vector(motion.final) - vector
        miss = _size(apart, vector)
        if miss > KEPT * before:
            step = None
    return (vector, period) if miss <= ACCEPTED else None


def _size(apart: np.ndarray, vector: np.ndarray) -> float:
    return float(np.abs(apart).max()) / (1.0 + float(np.abs(vector).max()))


def _solver(flow: Flow, vector: np.ndarray, period: float, motion: Trajectory, *, free: bool):  # type: ignore[no-untyped-def]
    """Newton's step from a distance: of few numbers by the whole derivative, else in the space that the distance spans."""
    same, n = happenings(motion), len(vector)
    begun, ended = (flow.rate(vector, 0.0), flow.rate(vector, period)) if free else (None, None)

    def bordered(change: np.ndarray, moved: np.ndarray) -> np.ndarray:
        if begun is None:
            return moved - change
        return np.append(moved - change[:n] + ended * change[n], begun @ change[:n])

    def applied(change: np.ndarray) -> np.ndarray:
        moved = flow.change(vector, change[:n], period, same) if change[:n].any() else np.zeros(n)
        return bordered(change, moved)

    if n > DENSE:
        return lambda right: _krylov_step(applied, np.append(right, 0.0) if free else right)
    slopes = flow.derivative(vector, period, same)
    whole = np.eye(n + int(free))
    matrix = np.array([bordered(each, slopes @ each[:n]) for each in whole]).T

    def step(right: np.ndarray) -> np.ndarray | None:
        try:
            found = np.linalg.solve(matrix, np.append(right, 0.0) if free else right)
        except np.linalg.LinAlgError:
            return None
        return found if np.isfinite(found).all() else None

    return step


def _krylov_step(applied, right: np.ndarray) -> np.ndarray | None:  # type: ignore[no-untyped-def]
    basis, matrix = krylov(applied, right, DIRECTIONS)
    if not np.isfinite(matrix).all():
        return None
    goal = np.zeros(len(matrix))
    goal[0] = np.linalg.norm(right)
    solution: np.ndarray = basis @ np.linalg.lstsq(matrix, goal, rcond=None)[0]
    return solution


def _orbit(flow: Flow, vector: np.ndarray, period: float, repeats: float | None) -> SimulatedOrbit | None:
    """The orbit of a closed path: as short as it is, with its multipliers."""
    motion = flow.follow(vector, period)
    if motion is None or not _touches(motion) or float(np.abs(flow.rate(vector, period)).max()) < STILL:
        return None
    found = happenings(motion)
    arrivals = sum(each.arrives for each in found)
    most = arrivals or MOST_PARTS
    for parts in range(min(most, MOST_PARTS), 1, -1):
        part = period / parts
        whole = repeats is None or abs(part / repeats - round(part / repeats)) < SAME
        if (
            part > SHORTEST
            and whole
            and len(found) % parts == 0
            and _size(flow.end(vector, part) - vector, vector) < SAME
        ):
            closed = newton(flow, vector, part, free=repeats is None)
            if closed is not None and abs(closed[1] - part) < SAME * part:
                return _orbit(flow, *closed, repeats)
    values, complete = _multipliers(flow, vector, period, motion, free=repeats is None)
    if values is None:
        return None
    name = CountedName(arrivals, 1) if arrivals else RubbingName(0, 1)
    state = flow.state(vector)
    return SimulatedOrbit(flow.rotor, name, state, period, Multipliers(values), complete, repeats, flow.rests)


def _touches(motion: Trajectory) -> bool:
    """Whether a motion touches a wall at all: levitation is no orbit."""
    return bool((motion.segment_phases != Phase.FLIGHT).any() or motion.is_impact.any())


def _multipliers(
    flow: Flow, vector: np.ndarray, period: float, motion: Trajectory, *, free: bool
) -> tuple[np.ndarray | None, bool]:
    """Non-trivial multipliers, the largest first, and whether these are all."""
    same = happenings(motion)
    if len(vector) <= DENSE:
        slopes = flow.derivative(vector, period, same)
        complete = True
    else:
        random = np.random.default_rng(0).normal(size=len(vector))
        _, matrix = krylov(lambda change: flow.change(vector, change, period, same), random, DIRECTIONS)
        slopes, complete = matrix[:-1], False
    if not np.isfinite(slopes).all():
        return None, False
    return multipliers_from(slopes, free=free), complete


def multipliers_from(slopes: np.ndarray, *, free: bool) -> np.ndarray:
    """Multipliers of the derivative of a closed path, the largest first; without that of a delay where the period is free."""
    values = np.linalg.eigvals(slopes).astype(complex).tolist()
    if free:
        values.remove(min(values, key=lambda value: abs(value - 1.0)))
    return np.array(sorted(values, key=lambda value: (-abs(value), -value.imag)))


def same_simulated(first: SimulatedOrbit, second: SimulatedOrbit) -> bool:
    """Whether two orbits are the same, wherever their periods begin."""
    if abs(first.period - second.period) > CLOSE * first.period or first.impacts != second.impacts:
        return False
    if first.impacts:
        size = CLOSE * (1.0 + float(np.abs(first.arrivals).max()))
        places = range(len(first.arrivals))
        return any(np.abs(np.roll(first.arrivals, -k, axis=0) - second.arrivals).max() < size for k in places)
    return bool(np.abs(np.subtract(first.extremes, second.extremes)).max() < CLOSE * (1.0 + max(first.extremes)))


def numbered(orbit: SimulatedOrbit, number: int) -> SimulatedOrbit:
    """The same with its number among those found."""
    made = CountedName if orbit.impacts else RubbingName
    return replace(orbit, name=made(orbit.impacts, number))
