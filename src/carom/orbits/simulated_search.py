"""The search for periodic motions of any machine: ends of simulated motions, and stretches of them that nearly come back."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import Outcome
from carom.base.progress import Reporter
from carom.models import Rotor
from carom.motions.settling import AT_REST, REPEATING
from carom.motions.simulation import simulate
from carom.motions.starts import State, levitating
from carom.motions.trajectories import Trajectory
from carom.orbits.closing import OFF_PERIOD, close, quietest
from carom.orbits.flow import FlowBudget, repeats_after
from carom.orbits.happenings import begins_contact, first_of_period, impact_kinds
from carom.orbits.orbit import Orbit, all_numbered, orbit_near
from carom.orbits.searched import FASTEST, KIND, Searched, random_starts
from carom.orbits.shooting import ShootingStart
from carom.orbits.simulated import SimulatedOrbit, same_simulated
from carom.orbits.word import Kind, Word

SETTLED, FRESH, GUESSES = 120, 60, 150
"""Motions followed until they settle, fresh ones afterwards, and stretches of further ones that are tried for each number of impacts."""
GIVEN_UP = 30_000
"""Events after which a motion that does not settle is given up: weakly damped bouncing takes hundreds of periods."""
EVENTS = 4e6
"""Events of a search (:class:`~carom.orbits.flow.FlowBudget`), some 20 s of a processor; motions followed until they settle may take a quarter."""
SLOWEST = 0.01
"""Least speed of the starts, relative to the largest, evenly spread over its logarithm."""
FEW = 2
"""Coordinates up to which random places and velocities of all of them are starts too; those of many are kicked as a whole."""
FOLLOWED, IN_WALL = 400.0, 40
"""Time in ``1/Ω`` for which a motion is followed for stretches, and events logged of one contact, about."""
CANDIDATE_RADIUS = 0.5
"""Distance of the ends of a stretch, relative to one plus the size of the state, up to which it is tried."""
BARREN = 40
"""Stretches in a row that lead to nothing new, after which the search ends."""
LONGEST = 16.0 * np.pi
"""Time, in ``1/Ω``, within which a whirl must come back to count as periodic: eight turns of the shaft."""
SAMPLES, RETURNS = 6001, 1e-4
WHIRLS = (Outcome.BACKWARD_WHIRL, Outcome.ROLLING, Outcome.FORWARD_RUB, Outcome.AT_REST)


def search_simulated(
    rotor: Rotor, impacts: int, guesses: int | None, seed: int, tell: Reporter, share: float = 1.0
) -> tuple[tuple[SimulatedOrbit, ...], Searched]:
    """Search periodic motions with at most a number of impacts a period, of any machine, and say what was tried: a share of the usual."""
    share = min(share, 1.0 if guesses is None else guesses / GUESSES)
    search = _Search(rotor, impacts, share)
    settled = search.ends(math.ceil(share * SETTLED), np.random.default_rng([seed, 1]), tell.part(0.0, 0.4))
    for orbit, _ in settled.orbits:
        search.add(orbit)
    search.guess(guesses or math.ceil(share * GUESSES), np.random.default_rng([seed, 2]), tell.part(0.4, 0.8))
    fresh = search.ends(math.ceil(share * FRESH), np.random.default_rng([seed, 3]), tell.part(0.8, 1.0))
    listed = sum(count for orbit, count in fresh.orbits if search.knows(orbit))
    others = sum(count for orbit, count in fresh.orbits if not search.knows(orbit) and orbit.impacts <= impacts)
    for orbit, _ in fresh.orbits:
        search.add(orbit)
    done = (settled.followed, search.motions, search.guesses, search.repeats, search.failures, search.last_new)
    return tuple(all_numbered(search.found)), Searched(*done, 0, fresh.followed, listed, others, fresh.unsettled)


class _Ends(NamedTuple):
    """Where motions from random starts end: how many were followed, the orbits with their numbers, and how many had not settled."""

    followed: int
    orbits: list[tuple[SimulatedOrbit, int]]
    unsettled: int


class _Search:
    """What a search has found and tried so far."""

    def __init__(self, rotor: Rotor, impacts: int, share: float = 1.0) -> None:
        self.rotor, self.impacts, self.share, self.budget = rotor, impacts, share, FlowBudget(share * EVENTS)
        self.barren = math.ceil(share * BARREN)
        self.found: list[SimulatedOrbit] = []
        self.motions = self.guesses = self.repeats = self.failures = self.last_new = 0

    def knows(self, orbit: SimulatedOrbit) -> bool:
        """Whether an orbit is known."""
        return any(same_simulated(orbit, other) for other in self.found)

    def add(self, orbit: SimulatedOrbit) -> bool:
        """Note an orbit with few enough impacts; return whether it is new."""
        if self.knows(orbit):
            return False
        if orbit.impacts <= self.impacts:
            self.found.append(orbit)
        return True

    def ends(self, count: int, random: np.random.Generator, tell: Reporter) -> _Ends:
        """Follow motions from random starts until they settle or are given up."""
        followed, unsettled, reserve = 0, 0, self.budget.left - 0.25 * self.share * EVENTS
        found: list[tuple[SimulatedOrbit | None, int]] = []
        kinds: dict[tuple[Outcome, int, bytes], int] = {}
        left = np.array_split(np.arange(count), max(1, count // 10))
        for part in left:
            for _ in part:
                start = start_of(self.rotor, random)
                motion = self.budget.pay(simulate(self.rotor, start, patience=GIVEN_UP, max_events=GIVEN_UP))
                state = motion.rotor.system.states_of(motion.last_amplitudes[None])
                irregular = motion.outcome is Outcome.BOUNCING and not motion.multiplicity
                unsettled += irregular or not motion.outcome.settled
                kind = motion.outcome, motion.multiplicity, state.round(KIND).tobytes()
                if kind not in kinds:
                    kinds[kind] = len(found)
                    found.append((periodic_of(motion, self.budget), 0))
                orbit, number = found[kinds[kind]]
                found[kinds[kind]] = orbit, number + 1
            followed += len(part)
            tell(followed / count)
            if self.budget.left < reserve:
                break
        return _Ends(followed, [(orbit, number) for orbit, number in found if orbit is not None], unsettled)

    def guess(self, guesses: int, random: np.random.Generator, tell: Reporter) -> None:
        """Close stretches of motions that nearly come back."""
        barren, idle = 0, 0
        while self.guesses < guesses * self.impacts and barren < self.barren and idle < self.barren:
            if self.budget.spent:
                return
            before = self.guesses
            for motion, begin, period in self._stretches(start_of(self.rotor, random)):
                self.guesses += 1
                orbit = close(motion, begin, period, self.budget)
                if orbit is None:
                    self.failures += 1
                elif not self.add(orbit):
                    self.repeats += 1
                else:
                    self.last_new, barren = self.guesses, -1
                barren += 1
            self.motions += 1
            idle = 0 if self.guesses > before else idle + 1
            tell(self.guesses / (guesses * self.impacts))

    def _stretches(self, start: State) -> Iterator[tuple[Trajectory, float, float]]:
        """For each number of impacts the stretch of a motion that comes back closest: the motion, where it begins, and how long it is."""
        most = IN_WALL * 4 * (self.impacts + 1)
        motion = self.budget.pay(simulate(self.rotor, start, FOLLOWED, settle=False, max_events=most))
        events = np.flatnonzero(begins_contact(motion))
        if len(events) < 2:
            return
        times = motion.segment_starts[1:][events]
        states, unit = motion.rotor.system.states_of(motion.event_amplitudes[events]), repeats_after(motion)
        for count in range(1, self.impacts + 1):
            spans = times[count:] - times[:-count]
            apart = np.abs(states[count:] - states[:-count]).max(axis=1, initial=0.0)
            apart = apart / (1.0 + np.abs(states[count:]).max(axis=1, initial=0.0))
            if unit is not None:
                whole = np.round(spans / unit)
                apart = np.where((whole > 0) & (np.abs(spans - whole * unit) < OFF_PERIOD * unit), apart, np.inf)
            if len(apart) and apart.min() < CANDIDATE_RADIUS:
                place = int(np.argmin(apart))
                before = float(times[place - 1]) if place else 0.0
                # A stretch begins in a flight: at an impact a state has two velocities.
                begin = 0.5 * (before + float(times[place]))
                yield motion, begin, float(spans[place])


def start_of(rotor: Rotor, random: np.random.Generator) -> State:
    """A random start: a kick out of levitation, or of few coordinates also any place and velocity."""
    speed = FASTEST * float(SLOWEST ** random.uniform())
    if rotor.system.levitates and (len(rotor.system.rest) > FEW or random.uniform() < 0.5):
        angle, instant = random.uniform(0.0, 2.0 * np.pi, 2).tolist()
        return levitating(rotor, cmath.rect(speed, angle), instant)
    positions, velocities = random_starts(rotor, random, 1, on_wall=bool(random.uniform() < 0.5))
    whirl = -1j * positions[0] * random.uniform()
    return State.of(positions[0], velocities[0] * (speed / FASTEST) + whirl)


def periodic_of(motion: Trajectory, budget: FlowBudget | None = None) -> SimulatedOrbit | None:
    """Close the periodic motion on which a motion of any machine has settled; ``None`` if it has not, or repeats nothing."""
    if motion.outcome in REPEATING and motion.multiplicity:
        times = motion.segment_starts[1:][begins_contact(motion)]
        begun = first_of_period(motion, motion.multiplicity)
        span = motion.time - float(times[begun])
    elif motion.outcome in WHIRLS and np.abs(motion.final.velocity).max() > AT_REST:
        span = _first_return(motion)
    else:
        return None
    if not span > 0.0:
        return None
    later = simulate(motion.rotor, motion.final, 2.1 * span, settle=False)
    once = simulate(motion.rotor, motion.final, span, settle=False)
    return close(later, quietest(once), span, budget) if later.outcome is Outcome.TIME_REACHED else None


def _first_return(motion: Trajectory) -> float:
    """Time after which a whirl comes back to where it is, as samples tell; 0 if it does not."""
    later = simulate(motion.rotor, motion.final, LONGEST, settle=False)
    if later.outcome is not Outcome.TIME_REACHED:
        return 0.0
    unit = repeats_after(later)
    times = np.linspace(0.0, LONGEST, SAMPLES) if unit is None else unit * np.arange(LONGEST / unit)
    amplitudes, _ = later.amplitudes_at(times)
    states = later.rotor.system.states_of(amplitudes)
    apart = np.abs(states - states[0]).max(axis=1)
    if unit is not None:
        near = np.flatnonzero(apart[1:] < RETURNS * (1.0 + np.abs(states[0]).max()))
        return float(times[1:][near[0]]) if len(near) else 0.0
    away = np.flatnonzero(apart > 0.5 * apart.max())
    inner = apart[1:-1]
    back = np.flatnonzero((inner < 0.1 * apart.max()) & (inner <= apart[2:]) & (inner <= apart[:-2])) + 1
    back = back[back > away[0]]
    return float(times[back[0]]) if len(back) else 0.0


PERIODIC = (Outcome.BOUNCING, Outcome.MIXED)
RECOGNITION_RTOL = 1e-3
"""Distance, relative to one plus the size of the nodes, within which the orbit of a settled motion is searched for."""


@checked
def orbit_of_motion(motion: Trajectory) -> Orbit | SimulatedOrbit | None:
    """Close the periodic orbit on which a motion has settled.

    Parameters
    ----------
    motion : Trajectory
        Settled to periodic bouncing, with or without lasting contact in the period, or to a whirl in contact (``settle=True``).

    Returns
    -------
    Orbit, SimulatedOrbit or None
        Bouncing of the planar rotor in a rigid bearing as a word of impacts.  ``None`` if the motion has not settled to such an orbit,
        or if Newton's method closes none next to it.

    See Also
    --------
    carom.find_orbits : all orbits with one impact a period
    carom.continue_orbit : follow it along a parameter

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> motion = cm.simulate(machine, cm.kick("60 mm/s"), settle=True)
    >>> print(f"{cm.orbits.orbit_of_motion(motion).period:.9f}")
    2.328416080
    """
    if not motion.rotor.has_closed_forms:
        return periodic_of(motion)
    count, begun_contacts = motion.multiplicity, np.flatnonzero(begins_contact(motion))
    if motion.outcome in PERIODIC and 0 < count <= len(begun_contacts):
        first = int(begun_contacts[first_of_period(motion, count)])
        if motion.is_impact[first:].all():
            return _near(motion.rotor, *impacts_between(motion, first, len(motion.event_amplitudes)))
    return periodic_of(motion)


def _near(rotor: Rotor, word: Word, start: ShootingStart) -> Orbit | None:
    """Orbit next to a start, if it is the one that the motion has settled on."""
    orbit, begun = orbit_near(rotor, word, start), start.nodes[0]
    if orbit is None or np.abs(orbit.nodes - begun).max(axis=1).min() > RECOGNITION_RTOL * (1.0 + np.abs(begun).max()):
        return None
    return orbit


def impacts_between(motion: Trajectory, first: int, last: int) -> tuple[Word, ShootingStart]:
    """Word, nodes and durations of a motion from one impact up to another, with nothing but impacts in between."""
    kinds = impact_kinds(motion)[first:last].tolist()
    times = np.append(motion.segment_starts[1:], motion.time)
    nodes = motion.rotor.system.nodes.of(motion.event_amplitudes[first:last])
    return Word(tuple(map(Kind, kinds))), ShootingStart(nodes, np.diff(times[first : last + 1]))


def with_impacts(motion: Trajectory, first: int, count: int) -> tuple[Word, ShootingStart] | None:
    """Word and start of some impacts in a row, from that of given number; ``None`` where the motion does else."""
    impacts = np.flatnonzero(motion.is_impact)
    if first + count >= len(impacts) or impacts[first + count] - impacts[first] != count:
        return None
    return impacts_between(motion, int(impacts[first]), int(impacts[first + count]))
