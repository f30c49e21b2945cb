"""The search for orbits of the planar rotor with at most a number of impacts a period, each of them a word or, with lasting contact, closed on the flow.

Most motions from random starts stop bouncing soon, and unstable orbits attract none: a search must not wait until motions settle.  Any
stretch of a motion that is a few impacts long is a guess for Newton's method, which costs less than the simulation.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any

import numpy as np

from carom.base.arguments import whole
from carom.base.outcome import Outcome
from carom.base.progress import Reporter
from carom.models import Rotor
from carom.motions.ensembles import Endings, settle
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.orbits.names import CountedName
from carom.orbits.orbit import Orbit, all_numbered, lasts, orbit_of_links, same_orbit
from carom.orbits.searched import KIND, Searched, random_starts
from carom.orbits.shooting import ShootingStart, closed_flights, links_of, pack
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.simulated_search import orbit_of_motion, with_impacts
from carom.orbits.word import Word

GUESSES, MOST_IMPACTS = 1500, 64
"""Default number of guesses for each number of impacts, and the most impacts that are searched."""
Impacts = Annotated[int, whole(1, MOST_IMPACTS)]
"""Most impacts a period of the orbits that are searched."""
EARLY, NEAREST = 3, 1
"""Stretches of a motion taken for each number of impacts: the first ones, before it comes near to what attracts it, and those
that come back closest."""
FRUITLESS = 200
"""Motions in a row without any guess, after which the search ends."""
IMPACTS = 4
"""Impacts of these motions, in multiples of the largest number of impacts a period."""
FOLLOWED = 1000.0
"""Time in ``1/Ω`` for which each is followed."""
SETTLED = 10_000
"""Motions that are followed until they settle, for orbits that attract few starts."""
FRESH = 1000
"""Fresh motions that measure which share ends on the orbits found."""
GIVEN_UP = 1000
"""Impacts after which a motion that does not settle is given up."""
ENDS = 200
"""Most ends of such motions, different ones, that are closed to orbits."""
DISTANCES_TRIED = (1e-2, 0.5)
"""Relative changes of the velocity, least and largest, of a start beside a known orbit."""
KNOWN = 1e-4
"""Relative distance from a known solution below which a stretch is not tried."""


def search_orbits(
    rotor: Rotor, impacts: int, guesses: int | None, seed: int, known: Sequence[Orbit], tell: Reporter
) -> tuple[tuple[Orbit, ...], Searched]:
    """Search orbits with at most a number of impacts a period: the admissible ones known then, and what was tried.

    Motions of an ensemble are followed until they settle; the orbits on which they end are closed.  Then stretches of other
    motions are corrected by Newton's method.  At last fresh motions are followed until they settle.

    Parameters
    ----------
    guesses : int or None
        Stretches that are corrected, for each number of impacts; ``None`` for as many as usual.
    known : sequence of Orbit
        Orbits that are known to exist.
    """
    search = OrbitSearch(rotor, impacts, known)
    done = search.run(SETTLED, guesses or GUESSES, FRESH, [seed], tell)
    return search.named(), done


def _orbits_of_ends(
    rotor: Rotor, count: int, random: np.random.Generator
) -> tuple[list[tuple[Orbit | SimulatedOrbit, int]], int]:
    """Orbits on which motions from random starts end, with the number of motions; an orbit may come several times.

    And the number of motions that had not settled when they were given up.
    """
    ends: Endings = settle(rotor, State(*random_starts(rotor, random, count)), patience=GIVEN_UP, max_events=GIVEN_UP)
    irregular = (ends.outcomes == Outcome.BOUNCING) & (ends.multiplicities == 0)
    unsettled = int(np.count_nonzero(irregular | (ends.outcomes < Outcome.LEVITATED)))
    ends = ends[((ends.outcomes == Outcome.BOUNCING) & ~irregular) | (ends.outcomes == Outcome.MIXED)]
    found: list[tuple[Orbit | SimulatedOrbit, int]] = []
    if not len(ends.times):
        return found, unsettled
    states = np.stack([ends.positions, ends.velocities], axis=1).reshape(len(ends.times), -1)
    _, different, numbers = np.unique(states.round(KIND), axis=0, return_index=True, return_counts=True)
    for place, number in zip(different[:ENDS].tolist(), numbers[:ENDS].tolist(), strict=True):
        orbit = orbit_of_motion(simulate(rotor, ends.state(place), settle=True))
        if orbit is not None:
            found.append((orbit, number))
    return found, unsettled


class OrbitSearch:
    """What a search has found so far.

    Parameters
    ----------
    known : sequence of Orbit
        Orbits that are not to be found again.
    """

    def __init__(self, rotor: Rotor, impacts: int, known: Sequence[Orbit] = ()) -> None:
        self.rotor, self.impacts = rotor, impacts
        self.found: list[Any] = []
        self.solutions: dict[Word, np.ndarray] = {}
        self.motions = self.guesses = self.repeats = self.failures = self.last_new = 0
        for orbit in known:
            self._add(orbit)

    def named(self) -> tuple[Orbit, ...]:
        """The admissible orbits, those found under new names."""
        listed = [orbit for orbit in self.found if orbit.admissible]
        named = [orbit for orbit in listed if not isinstance(orbit.name, CountedName)]
        return (*named, *all_numbered(orbit for orbit in listed if orbit not in named))

    def run(self, settled: int, guesses: int, fresh: int, seed: Sequence[int], tell: Reporter) -> Searched:
        """Search, with so many guesses for each number of impacts."""
        for orbit, _ in _orbits_of_ends(self.rotor, settled, np.random.default_rng([*seed, 1]))[0]:
            self._add(orbit)
        tell(0.3)
        self._guess(guesses, np.random.default_rng([*seed, 2]), tell.part(0.3, 0.9))
        ended = self.measured(fresh, np.random.default_rng([*seed, 3]))
        tell(1.0)
        virtual = sum(not orbit.admissible for orbit in self.found)
        return Searched(
            settled, self.motions, self.guesses, self.repeats, self.failures, self.last_new, virtual, fresh, *ended
        )

    def measured(self, fresh: int, random: np.random.Generator) -> tuple[int, int, int]:
        """Number of motions from random starts that end on the orbits found, on others with no more impacts than are searched, and not settled."""
        listed = others = 0
        ends, unsettled = _orbits_of_ends(self.rotor, fresh, random)
        for orbit, number in ends:
            if any(same_orbit(orbit, other) for other in self.found):
                listed += number
            elif orbit.impacts <= self.impacts:
                others += number
        return listed, others, unsettled

    def _guess(self, guesses: int, random: np.random.Generator, tell: Reporter) -> None:
        """Correct stretches of motions from random starts and from beside known orbits, so many for each number of impacts."""
        tried = np.zeros(self.impacts + 1, int)
        fruitless = 0
        while tried[1:].min() < guesses and fruitless < FRUITLESS:
            before = tried.sum()
            for count, word, guess in self._stretches(self._start(random)):
                if tried[count] < guesses and not self._is_known(word, guess, KNOWN):
                    tried[count] += 1
                    self._correct(word, guess)
            self.motions += 1
            fruitless = 0 if tried.sum() > before else fruitless + 1
            tell(float(tried.sum()) / (guesses * self.impacts))

    def _start(self, random: np.random.Generator) -> State:
        """A random start, or every third time one beside a known orbit."""
        beside = [orbit for orbit in self.found if orbit.admissible and orbit.flies]
        if self.motions % 3 or not beside:
            positions, velocities = random_starts(self.rotor, random, 1, on_wall=True)
            return State.of(positions[0], velocities[0])
        known = beside[int(random.integers(len(beside)))].departure
        velocity = np.array(known.velocity, complex)
        size = np.exp(random.uniform(*np.log(DISTANCES_TRIED)))
        change = size * (random.normal(size=(*velocity.shape, 2)) @ [1.0, 1j])
        return State.of(np.array(known.position), velocity + np.abs(velocity).max() * change)

    def _stretches(self, start: State) -> Iterator[tuple[int, Word, ShootingStart]]:
        """Stretches of a motion that come back closest, with their number of impacts."""
        motion = simulate(self.rotor, start, FOLLOWED, stop_at_chatter=True, max_events=IMPACTS * (self.impacts + 1))
        marks = np.flatnonzero(motion.is_impact)
        if len(marks) < 2:
            return
        states, times = self.rotor.system.nodes.of(motion.event_amplitudes[marks]), motion.segment_starts[1:][marks]
        for count in range(1, self.impacts + 1):
            # Low bounces change little because they are short.
            changes = np.abs(states[count:] - states[:-count]).max(axis=1)
            nearest = np.argsort(changes / (times[count:] - times[:-count]), kind="stable")[:NEAREST].tolist()
            for first in dict.fromkeys([*range(min(EARLY, len(changes))), *nearest]):
                stretch = with_impacts(motion, first, count)
                if stretch is not None:
                    yield count, *stretch

    def _correct(self, word: Word, guess: ShootingStart) -> None:
        """Correct one stretch of a motion."""
        self.guesses += 1
        solved = closed_flights(self.rotor, word, guess)
        if solved is None or not lasts(solved):
            self.failures += 1
            return
        links = links_of(self.rotor, word, solved)
        if self._is_known(word, links.start, KNOWN):
            self.repeats += 1
        elif self._add(orbit_of_links(self.rotor, word, links)):
            self.last_new = self.guesses if self.found[-1].admissible else self.last_new
        else:
            self.repeats += 1

    def _is_known(self, word: Word, solution: ShootingStart, within: float) -> bool:
        """Whether a solution is a known one, to within a relative distance."""
        known = self.solutions.get(word)
        if known is None:
            return False
        # Entry by entry: a solution with one huge duration is not near to everything.
        return bool((np.abs(pack(solution) - known) < within * (1.0 + np.abs(known))).all(axis=1).any())

    def _add(self, orbit: Orbit | SimulatedOrbit) -> bool:
        """Keep an orbit; whether it is new and has no more impacts than are searched."""
        if orbit.impacts > self.impacts or any(same_orbit(orbit, other) for other in self.found):
            return False
        self.found.append(orbit)
        if isinstance(orbit, SimulatedOrbit):
            return True
        most = max(1, self.impacts // max(orbit.impacts, 1))
        for place in range(len(orbit.word)):
            turned = orbit.start.turned(place)
            for times in range(1, most + 1):
                several = ShootingStart(np.tile(turned.nodes, (times, 1)), np.tile(turned.durations, times))
                word = orbit.word.turned(place).repeated(times)
                solution = pack(several)[None]
                known = self.solutions.get(word, solution[:0])
                self.solutions[word] = np.concatenate([known, solution])
        return True
