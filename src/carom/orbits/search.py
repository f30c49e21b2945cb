"""Search for orbits with any number of impacts a period, over starts of simulations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from carom.models import Model
from carom.motions.ensembles import settle
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory, simulate
from carom.orbits.names import CountedName
from carom.orbits.orbit import Orbit, OrbitSequence, lasts, orbit_of_links, same_orbit
from carom.orbits.recognising import orbit_of_motion, segments_of
from carom.orbits.shooting import Start, converged, pack
from carom.orbits.word import Word
from carom.outcome import InputError, Outcome
from carom.progress import Reporter
from carom.results import Result, in_a_line

STARTS = 100
"""Default number of starts."""
SETTLED = 200
"""Motions for each start that are followed in an ensemble until they settle, for orbits that attract few starts."""
SLOWER = 50
"""The same number is divided by this for rotors whose motions are not followed side by side."""
GIVEN_UP = 1000
"""Impacts after which such a motion is given up."""
ENDS = 200
"""Most ends of such motions, different ones, that are closed to orbits."""
FOLLOWED = 300
"""Impacts of each simulated motion."""
LONGEST = 1000.0
"""Time in ``1/Ω`` for which each motion is followed."""
GUESSES = 4
"""Stretches of each motion that Newton's method begins from: those that come back closest to where they began."""
FASTEST = 1.5
"""Velocities of the starts, in ``c_r Ω``, are up to this."""
KIND = 3
"""Decimals to which the states of ends must agree to count as one."""
NEAR = 1e-4
"""Relative distance from a known orbit below which a stretch is not tried."""
SAME = 1e-7
"""Relative distance below which two solutions are the same."""


@dataclass(frozen=True, eq=False, repr=False)
class FoundOrbits(Result, OrbitSequence):
    """Orbits with a given number of impacts a period that a search has found; look one up by index or name, ``found["P2,1"]``.

    A search proves nothing: an orbit that no start came near to is missing.

    Attributes
    ----------
    rotor : Model
    impacts : int
    members : tuple of Orbit
        Admissible ones, stable or not, the shortest period first.
    virtual : int
        Number of solutions that are not motions of the machine.
    settled : int
        Number of motions that were followed until they settled; the orbits on which these end come first.
    starts : int
        Number of further motions that were simulated.
    guesses : int
        Number of stretches of them from which Newton's method was begun.
    repeats : int
        Number of those that led to a known solution, and to no other when that was deflated.
    failures : int
        Number of those from which it converged to no solution.
    last_new : int
        Number of the start, from 1, that led to the last new orbit; 0 if none did.
    """

    if_none: ClassVar[str] = "none, no orbits were found"

    rotor: Model
    impacts: int
    members: tuple[Orbit, ...]
    virtual: int
    settled: int
    starts: int
    guesses: int
    repeats: int
    failures: int
    last_new: int

    def rows(self) -> list[tuple[str, str]]:
        """Each orbit, and how much was searched."""
        told = [
            (orbit.name, f"period {orbit.period:.6g}, {'stable' if orbit.stable else 'unstable'}, {orbit.segments}")
            for orbit in self
        ]
        return [("rotor", in_a_line(self.rotor)), *told, ("search", self.argument)]

    @property
    def argument(self) -> str:
        """How much was searched, in one sentence."""
        newest = (
            f"the last new orbit came from start {self.last_new}" if self.last_new else "none led to a further orbit"
        )
        return (
            f"Found by a search, which proves nothing: {self.settled} motions were followed until they settled; {self.starts} "
            f"simulated starts gave {self.guesses} guesses for Newton's method, of which {self.repeats} led to known orbits "
            f"and {self.failures} to none; {newest}; solutions that are not motions: {self.virtual}."
        )


def search_orbits(rotor: Model, impacts: int, starts: int, seed: int, tell: Reporter) -> FoundOrbits:
    """Search orbits with a number of impacts a period.

    Motions of an ensemble are followed until they settle; the orbits on which they end are closed.  Then, from each start a motion is simulated.  Stretches of so many impacts that nearly come back to where they began are
    corrected by Newton's method.  Known solutions are deflated, so that the iteration leads to others.

    Raises
    ------
    InputError
        ``impacts`` or ``starts`` is below 1.
    """
    for name, number in (("impacts", impacts), ("starts", starts)):
        if number < 1:
            raise InputError(name, number, "a whole number of at least 1")
    search = _Search(rotor, impacts)
    settled = starts * SETTLED // (1 if rotor.system.is_planar else SLOWER)
    search.settle(settled, np.random.default_rng([seed, 1]))
    random = np.random.default_rng(seed)
    for start in range(1, starts + 1):
        search.look_through(start, _followed(rotor, random_start(rotor, random)))
        tell(start / starts)
    admissible = sorted((orbit for orbit in search.found if orbit.admissible), key=lambda orbit: orbit.period)
    members = tuple(
        replace(orbit, name=CountedName(impacts, number)) for number, orbit in enumerate(admissible, start=1)
    )
    virtual = len(search.found) - len(members)
    return FoundOrbits(
        rotor,
        impacts,
        members,
        virtual,
        settled,
        starts,
        search.guesses,
        search.repeats,
        search.failures,
        search.last_new,
    )


def orbits_of_several_impacts(rotor: Model, impacts: int, starts: Iterable[State]) -> list[Orbit]:
    """Admissible orbits with 2 up to a number of impacts a period, from the motions of some starts; a search, as above."""
    searches = [_Search(rotor, count) for count in range(2, impacts + 1)]
    for number, start in enumerate(starts, start=1):
        motion = _followed(rotor, start)
        for search in searches:
            search.look_through(number, motion)
    return [orbit for search in searches for orbit in search.found if orbit.admissible]


def _followed(rotor: Model, start: State) -> Trajectory:
    return simulate(rotor, start, LONGEST, stop_at_chatter=True, max_events=FOLLOWED)


def random_start(rotor: Model, random: np.random.Generator) -> State:
    """State with random coordinates inside all walls, and random velocities."""
    positions, velocities = random_starts(rotor, random, 1)
    return State.of(positions[0], velocities[0])


def random_starts(rotor: Model, random: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Random positions inside all walls and random velocities, complex, shape (count,) or, for n > 1 coordinates, (count, n)."""
    system = rotor.system
    arrays, n = system.arrays, len(system.rest)
    directions = random.normal(size=(count, 2, n, 2)) @ [1.0, 1j]
    shares, speeds = np.sqrt(random.uniform(size=count)), FASTEST * np.sqrt(random.uniform(size=count))

    def reach(sizes: np.ndarray) -> np.ndarray:
        states = np.concatenate([sizes[:, None] * directions[:, 0], np.zeros((count, n))], axis=1)
        radii: np.ndarray = np.abs(system.amplitudes_of(states) @ arrays.rows.T + arrays.offsets).max(axis=1)
        return radii

    sizes = shares / reach(np.ones(count))
    while (far := reach(sizes) > 1.0).any():
        sizes = np.where(far, 0.5 * sizes, sizes)
    positions = sizes[:, None] * directions[:, 0]
    velocities = (speeds / np.abs(directions[:, 1]).max(axis=1))[:, None] * directions[:, 1]
    return (positions, velocities) if n > 1 else (positions[:, 0], velocities[:, 0])


def _is_among(unknowns: np.ndarray, known: Sequence[np.ndarray], within: float) -> bool:
    """Whether a solution is one of the known ones, to within a relative distance."""
    return any(np.abs(unknowns - other).max() < within * (1.0 + np.abs(other).max()) for other in known)


class _Search:
    """What a search has found so far."""

    def __init__(self, rotor: Model, impacts: int) -> None:
        self.rotor, self.impacts = rotor, impacts
        self.found: list[Orbit] = []
        self.known: dict[Word, list[np.ndarray]] = {}
        self.guesses = self.repeats = self.failures = self.last_new = 0

    def settle(self, count: int, random: np.random.Generator) -> None:
        """Close the orbits on which motions from random starts end."""
        ends = settle(self.rotor, *random_starts(self.rotor, random, count), patience=GIVEN_UP, max_events=GIVEN_UP)
        ends = ends[(ends.outcomes == Outcome.BOUNCING) & (ends.multiplicities == self.impacts)]
        if not len(ends.times):
            return
        states = np.stack([ends.positions, ends.velocities], axis=1).reshape(len(ends.times), -1)
        _, different = np.unique(states.round(KIND), axis=0, return_index=True)
        for place in different[:ENDS]:
            start = State.of(ends.positions[place], ends.velocities[place])
            orbit = orbit_of_motion(simulate(self.rotor, start, settle=True))
            if orbit is None or orbit.impacts != self.impacts or any(same_orbit(orbit, other) for other in self.found):
                continue
            self.found.append(orbit)
            self._remember(orbit.word, Start(orbit.nodes, orbit.durations))

    def look_through(self, start: int, motion: Trajectory) -> None:
        """Correct the stretches of the motion from a start that come back closest."""
        impacts = np.flatnonzero(motion.is_impact)
        if len(impacts) <= self.impacts:
            return
        states = self.rotor.system.states_of(motion.arrivals[impacts])
        times = motion.segment_starts[1:][impacts]
        # Low bounces change little because they are short; planes that strike at one instant take no time.
        lasted = times[self.impacts :] - times[: -self.impacts]
        changes = np.abs(states[self.impacts :] - states[: -self.impacts]).max(axis=1)
        apart = np.divide(changes, lasted, out=np.full_like(changes, np.inf), where=lasted > 0.0)
        for first in np.argsort(apart, kind="stable")[:GUESSES]:
            self.correct(start, motion, int(impacts[first]), int(impacts[first + self.impacts]))

    def correct(self, start: int, motion: Trajectory, first: int, last: int) -> None:
        """Correct one stretch of a motion, unless it lies on a known orbit."""
        if last - first != self.impacts:
            return
        word, guess = segments_of(motion, first, last)
        known = self.known.setdefault(word, [])
        unknowns = pack(guess)
        if _is_among(unknowns, known, NEAR):
            return
        self.guesses += 1
        links = converged(self.rotor, word, guess)
        if links is not None and _is_among(pack(links.start), known, SAME):
            links = converged(self.rotor, word, guess, known)
            if links is None or not lasts(word, links.start):
                self.repeats += 1
                return
        if links is None or not lasts(word, links.start):
            self.failures += 1
            return
        orbit = orbit_of_links(self.rotor, word, links)
        self._remember(word, links.start)
        if orbit.impacts == self.impacts and not any(same_orbit(orbit, other) for other in self.found):
            self.found.append(orbit)
            self.last_new = start if orbit.admissible else self.last_new

    def _remember(self, word: Word, solution: Start) -> None:
        """Deflate a solution, whichever impact it begins with."""
        for places in range(len(word)):
            turned = Start(np.roll(solution.nodes, -places, axis=0), np.roll(solution.durations, -places))
            self.known.setdefault(word.turned(places), []).append(pack(turned))
