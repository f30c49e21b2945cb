"""Search for orbits with any number of impacts a period, over starts of simulations."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from carom.models import Model
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory, simulate
from carom.orbits.names import CountedName
from carom.orbits.orbit import Orbit, OrbitSequence, orbit_of_links, same_orbit
from carom.orbits.recognising import segments_of
from carom.orbits.shooting import Start, converged, pack
from carom.orbits.word import Word
from carom.outcome import InputError
from carom.progress import Reporter
from carom.results import Result, in_a_line

STARTS = 100
"""Default number of starts."""
FOLLOWED = 300
"""Impacts of each simulated motion."""
LONGEST = 1000.0
"""Time in ``1/Ω`` for which each motion is followed."""
GUESSES = 4
"""Stretches of each motion that Newton's method begins from: those that come back closest to where they began."""
FASTEST = 1.5
"""Velocities of the starts, in ``c_r Ω``, are up to this."""
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
    starts : int
        Number of motions that were simulated.
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
        return (
            f"Found by a search, which proves nothing: {self.starts} simulated starts gave {self.guesses} guesses for Newton's method, "
            f"of which {self.repeats} led to known orbits and {self.failures} to none; the last new orbit came from start "
            f"{self.last_new}; {self.virtual} solutions found are not motions."
        )


def search_orbits(rotor: Model, impacts: int, starts: int, seed: int, tell: Reporter) -> FoundOrbits:
    """Search orbits with a number of impacts a period.

    From each start a motion is simulated.  Stretches of so many impacts that nearly come back to where they began are
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
        rotor, impacts, members, virtual, starts, search.guesses, search.repeats, search.failures, search.last_new
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
    system = rotor.system
    n = len(system.rest)
    directions = random.normal(size=(2, n, 2)) @ [1.0, 1j]
    share, speed = np.sqrt(random.uniform()), FASTEST * np.sqrt(random.uniform())
    arrays = system.arrays

    def reach(size: float) -> float:
        states = np.concatenate([size * directions[0], np.zeros(n)])[None]
        amplitudes = system.amplitudes_of(states)[0]
        return float(np.abs(arrays.rows @ amplitudes + arrays.offsets).max())

    size = share / reach(1.0)
    while reach(size) > 1.0:
        size *= 0.5
    velocity = speed * directions[1] / np.abs(directions[1]).max()
    return State.of(size * directions[0], velocity) if n > 1 else State(size * directions[0][0], velocity[0])


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

    def look_through(self, start: int, motion: Trajectory) -> None:
        """Correct the stretches of the motion from a start that come back closest."""
        impacts = np.flatnonzero(motion.is_impact)
        if len(impacts) <= self.impacts:
            return
        states = self.rotor.system.states_of(motion.arrivals[impacts])
        times = motion.segment_starts[1:][impacts]
        # Low bounces change little because they are short.
        lasted = times[self.impacts :] - times[: -self.impacts]
        apart = np.abs(states[self.impacts :] - states[: -self.impacts]).max(axis=1) / lasted
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
            if links is None or (links.start.durations <= 0.0).any():
                self.repeats += 1
                return
        if links is None or (links.start.durations <= 0.0).any():
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
