"""The search for orbits with at most a number of impacts a period, with or without lasting contact.

Most motions from random starts stop bouncing soon, and unstable orbits attract none: a search must not wait until motions settle.  Any
stretch of a motion that is a few impacts long is a guess for Newton's method, which costs less than the simulation.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Annotated

import numpy as np

from carom.arguments import whole
from carom.models import Rotor
from carom.motions.ensembles import Endings, settle
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.names import CountedName
from carom.orbits.orbit import Orbit, lasts, orbit_of_links, same_orbit
from carom.orbits.recognising import arrives, lift_offs, orbit_of_motion, segments_of
from carom.orbits.shooting import Start, closed_flights, converged, links_of, pack
from carom.orbits.word import Word
from carom.outcome import InputError, Outcome
from carom.progress import Reporter

GUESSES, MOST_IMPACTS = 1500, 64
"""Default number of guesses for each number of impacts, and the most impacts that are searched."""
Impacts = Annotated[int, whole(1, MOST_IMPACTS)]
"""Most impacts a period of the orbits that are searched."""
EARLY, NEAREST = 3, 1
"""Stretches of a motion taken for each number of impacts: the first ones, before it comes near to what attracts it, and those
that come back closest."""
FRUITLESS = 200
"""Motions in a row without any guess, after which the search ends."""
WHOLE_WIDTH, LEAST_SHARE = 21, 0.002
"""Equations of a segment up to which a search tries all that it is meant to, and the least share of it: each guess solves equations whose work
grows with the third power of their number."""
IMPACTS = 4
"""Impacts of these motions, in multiples of the largest number of impacts a period."""
FOLLOWED = 1000.0
"""Time in ``1/Ω`` for which each is followed."""
IN_WALL = 16
"""Events logged of a contact with a wall that gives way, about."""
LANDING, LANDS = 0.05, 2000
"""Share of the motions that are followed through landings and lift-offs, and their most events."""
SETTLED, SLOWER = 10_000, 50
"""Motions that are followed until they settle, for orbits that attract few starts; divided by the second number for rotors
whose motions are not followed side by side."""
FRESH = 1000
"""Fresh motions that measure which share ends on the orbits found; divided by the same for such rotors."""
GIVEN_UP = 1000
"""Impacts after which a motion that does not settle is given up."""
ENDS = 200
"""Most ends of such motions, different ones, that are closed to orbits."""
FASTEST = 1.5
"""Velocities of the starts in the fixed frame, in ``c_r Ω``, are up to this."""
BESIDE = (1e-2, 0.5)
"""Relative changes of the velocity, least and largest, of a start beside a known orbit."""
KIND = 3
"""Decimals to which the states of ends must agree to count as one."""
KNOWN = 1e-4
"""Relative distance from a known solution below which a stretch is not tried."""
BARREN = 100
"""Guesses in a row without any solution after which the search ends where walls give way: there each takes hundreds of steps."""
SECONDS = 25.0
"""Time of the processor after which no further guess is made for rotors whose motions are not followed side by side."""
LEAST = 1e-9
"""Least duration of a flight, in ``1/Ω``."""


@dataclass(frozen=True)
class Searched:
    """How much a search for orbits has tried, and what share of fresh motions ended on the orbits known afterwards.

    Attributes
    ----------
    settled : int
        Number of motions that were followed until they settled; the orbits on which these end are closed.
    motions : int
        Number of further motions, whose stretches are the guesses.
    guesses : int
        Number of stretches from which Newton's method was begun; those on a known orbit are left out.
    repeats : int
        Number of those that led to a known solution.
    failures : int
        Number of those from which it converged to no orbit.
    last_new : int
        Number of the guess, from 1, that led to the last new orbit; 0 if none did.
    virtual : int
        Number of solutions that are not motions of the machine.
    fresh : int
        Number of fresh motions from random starts, which the search has not used.
    on_listed : int
        Number of those that ended on one of the orbits.
    on_others : int
        Number of those that ended on another periodic motion with no more impacts than were searched.
    """

    settled: int
    motions: int
    guesses: int
    repeats: int
    failures: int
    last_new: int
    virtual: int
    fresh: int
    on_listed: int
    on_others: int

    @property
    def share_on_listed(self) -> float:
        """Share of the fresh motions that ended on one of the orbits."""
        return self.on_listed / self.fresh

    def and_then(self, later: Searched) -> Searched:
        """Both searches together, of which the given one came later."""
        sums = {each.name: getattr(self, each.name) + getattr(later, each.name) for each in fields(self)}
        sums["last_new"] = self.guesses + later.last_new if later.last_new else self.last_new
        return Searched(**sums)

    @property
    def words(self) -> str:
        """The same in a few sentences."""
        newest = f"guess {self.last_new} led to the last new orbit" if self.last_new else "none led to a further orbit"
        return (
            f"Orbits were searched, which does not prove that these are all: {self.settled} motions "
            f"were followed until they settled; stretches of {self.motions} others gave {self.guesses} guesses for Newton's method, of "
            f"which {self.repeats} led to known orbits and {self.failures} to none; {newest}. Solutions that are not motions: {self.virtual}. "
            f"Of {self.fresh} fresh motions {self.on_listed} ended on an orbit listed here and {self.on_others} on other orbits with no more impacts than were searched."
        )


def usual_share(rotor: Rotor) -> float:
    """Share of the usual guesses and motions that a search tries: fewer for a rotor of many states, whose guesses take seconds each."""
    width = 2 * len(rotor.system.nodes.rest) + 1
    return max(LEAST_SHARE, min(1.0, (WHOLE_WIDTH / width) ** 3))


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
    search, share = Search(rotor, impacts, known), usual_share(rotor)
    done = search.run(SETTLED, guesses or math.ceil(share * GUESSES), FRESH, [seed], tell)
    return search.named(), done


def random_starts(
    rotor: Rotor, random: np.random.Generator, count: int, *, on_wall: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Random positions inside all walls, or on one, and velocities, complex, shape (count,) or, for n > 1 coordinates, (count, n).

    The velocities are random in the fixed frame: those of bounces that whirl backward are far from zero in the frame that turns.
    """
    system = rotor.system
    arrays, n = system.arrays, len(system.rest)
    directions = random.normal(size=(count, 2, n, 2)) @ [1.0, 1j]
    shares, speeds = np.sqrt(random.uniform(size=count)), FASTEST * np.sqrt(random.uniform(size=count))
    if on_wall:
        shares[:] = 1.0

    def reach(sizes: np.ndarray) -> np.ndarray:
        states = np.concatenate([sizes[:, None] * directions[:, 0], np.zeros((count, n))], axis=1)
        radii: np.ndarray = np.abs(system.amplitudes_of(states) @ arrays.rows.T + arrays.offsets).max(axis=1)
        return radii

    sizes = shares / reach(np.ones(count))
    while (far := reach(sizes) > 1.0).any():
        sizes = np.where(far, 0.5 * sizes, sizes)
    positions = sizes[:, None] * directions[:, 0]
    velocities = (speeds / np.abs(directions[:, 1]).max(axis=1))[:, None] * directions[:, 1] - 1j * positions
    return (positions, velocities) if n > 1 else (positions[:, 0], velocities[:, 0])


def _orbits_of_ends(rotor: Rotor, count: int, random: np.random.Generator) -> Iterator[tuple[Orbit, int]]:
    """Orbits on which motions from random starts end, with the number of motions; an orbit may come several times."""
    ends: Endings = settle(rotor, *random_starts(rotor, random, count), patience=GIVEN_UP, max_events=GIVEN_UP)
    ends = ends[((ends.outcomes == Outcome.BOUNCING) & (ends.multiplicities > 0)) | (ends.outcomes == Outcome.MIXED)]
    if not len(ends.times):
        return
    states = np.stack([ends.positions, ends.velocities], axis=1).reshape(len(ends.times), -1)
    _, different, numbers = np.unique(states.round(KIND), axis=0, return_index=True, return_counts=True)
    for place, number in zip(different[:ENDS].tolist(), numbers[:ENDS].tolist(), strict=True):
        orbit = orbit_of_motion(simulate(rotor, ends.state(place), settle=True))
        if orbit is not None:
            yield orbit, number


class Search:
    """What a search has found so far.

    Parameters
    ----------
    known : sequence of Orbit
        Orbits that are not to be found again.
    """

    def __init__(self, rotor: Rotor, impacts: int, known: Sequence[Orbit] = ()) -> None:
        self.rotor, self.impacts = rotor, impacts
        self.found: list[Orbit] = []
        self.solutions: dict[Word, np.ndarray] = {}
        self.motions = self.guesses = self.repeats = self.failures = self.last_new = self.fertile = 0
        for orbit in known:
            self._add(orbit)

    def named(self) -> tuple[Orbit, ...]:
        """The admissible orbits, those found under new names."""
        listed = [orbit for orbit in self.found if orbit.admissible]
        counts = dict.fromkeys(range(self.impacts + 1), 0)
        named = [orbit for orbit in listed if not isinstance(orbit.name, CountedName)]
        for orbit in sorted(
            (each for each in listed if each not in named), key=lambda each: (each.impacts, each.period)
        ):
            counts[orbit.impacts] += 1
            named.append(replace(orbit, name=CountedName(orbit.impacts, counts[orbit.impacts])))
        return tuple(named)

    def run(self, settled: int, guesses: int, fresh: int, seed: Sequence[int], tell: Reporter) -> Searched:
        """Search, with so many guesses for each number of impacts.

        Fewer motions are followed until they settle, of both kinds, if they are not followed side by side.
        """
        slower = 1.0 if self.rotor.system.is_planar else 1.0 / SLOWER
        # Following motions takes time in proportion to the states.
        slower *= usual_share(self.rotor) ** (1.0 / 3.0)
        settled, fresh = math.ceil(slower * settled), math.ceil(slower * fresh)
        for orbit, _ in _orbits_of_ends(self.rotor, settled, np.random.default_rng([*seed, 1])):
            self._add(orbit)
        tell(0.3)
        self._guess(guesses, np.random.default_rng([*seed, 2]), tell.part(0.3, 0.9))
        ended = self.measured(fresh, np.random.default_rng([*seed, 3]))
        tell(1.0)
        virtual = sum(not orbit.admissible for orbit in self.found)
        return Searched(
            settled, self.motions, self.guesses, self.repeats, self.failures, self.last_new, virtual, fresh, *ended
        )

    def measured(self, fresh: int, random: np.random.Generator) -> tuple[int, int]:
        """Number of motions from random starts that end on the orbits found, and on others with no more impacts than are searched."""
        listed = others = 0
        for orbit, number in _orbits_of_ends(self.rotor, fresh, random):
            if any(same_orbit(orbit, other) for other in self.found):
                listed += number
            elif orbit.impacts <= self.impacts:
                others += number
        return listed, others

    def _guess(self, guesses: int, random: np.random.Generator, tell: Reporter) -> None:
        """Correct stretches of motions from random starts and from beside known orbits, so many for each number of impacts."""
        tried = np.zeros(self.impacts + 1, int)
        fruitless = 0
        most = max(1, round(FRUITLESS * usual_share(self.rotor) ** (1.0 / 3.0)))
        barren = BARREN if self.rotor.system.arrays["stiffness"].any() else math.inf
        limit = math.inf if self.rotor.system.is_planar else time.process_time() + SECONDS
        while tried[1:].min() < guesses and fruitless < most and self.guesses - self.fertile < barren:
            if time.process_time() > limit:
                return
            before = tried.sum()
            for count, word, guess in self._stretches(self._start(random), random.uniform() < LANDING):
                if tried[count] < guesses and not self._is_known(word, guess, KNOWN):
                    tried[count] += 1
                    self._correct(word, guess)
            self.motions += 1
            fruitless = 0 if tried.sum() > before else fruitless + 1
            tell(float(tried.sum()) / (guesses * self.impacts))

    def _start(self, random: np.random.Generator) -> State:
        """A random start, or every third time one beside a known orbit."""
        beside = [orbit for orbit in self.found if orbit.admissible and (orbit.word.flies or orbit.word.arrives[0])]
        if self.motions % 3 or not beside:
            positions, velocities = random_starts(self.rotor, random, 1, on_wall=True)
            return State.of(positions[0], velocities[0])
        known = beside[int(random.integers(len(beside)))].departure
        velocity = np.array(known.velocity, complex)
        change = np.exp(random.uniform(*np.log(BESIDE))) * (random.normal(size=(*velocity.shape, 2)) @ [1.0, 1j])
        return State.of(np.array(known.position), velocity + np.abs(velocity).max() * change, time=known.time)

    def _stretches(self, start: State, landing: bool) -> Iterable[tuple[int, Word, Start]]:
        """Stretches of a motion that come back closest, with their number of impacts; through a landing, from lift-off to lift-off."""
        yields = bool(self.rotor.system.arrays["stiffness"].any())
        most = LANDS if landing else IMPACTS * (self.impacts + 1) * (IN_WALL if yields else 1)
        motion = simulate(self.rotor, start, FOLLOWED, stop_at_chatter=not landing, max_events=most)
        if landing:
            lifts = lift_offs(motion)
            yield from self._cut(motion, lifts[1:] if len(lifts) > 3 else lifts, range(1, 4), contact=True)
        yield from self._cut(motion, np.flatnonzero(arrives(motion)), range(1, self.impacts + 1), contact=False)

    def _cut(
        self, motion: Trajectory, marks: np.ndarray, counts: Iterable[int], *, contact: bool
    ) -> Iterator[tuple[int, Word, Start]]:
        """Stretches from one of the marked events to a later one."""
        if len(marks) < 2:
            return
        yields = bool(self.rotor.system.arrays["stiffness"].any())
        nodes = motion.segment_amplitudes[marks + 1] if contact else motion.arrivals[marks]
        states, times = self.rotor.system.nodes.of(nodes), motion.segment_starts[1:][marks]
        for count in counts:
            # Low bounces change little because they are short; planes that strike at one instant take no time.
            lasted = times[count:] - times[:-count]
            changes = np.abs(states[count:] - states[:-count]).max(axis=1)
            apart = np.divide(changes, lasted, out=np.full_like(changes, np.inf), where=lasted > 0.0)
            nearest = np.argsort(apart, kind="stable")[:NEAREST].tolist()
            for first in dict.fromkeys([*range(min(EARLY, len(apart))), *nearest]):
                begin, end = int(marks[first]), int(marks[first + count])
                if not contact and end - begin != count and not yields:
                    continue
                try:
                    word, guess = segments_of(motion, begin, end)
                except InputError:  # an impact at one plane while another stays in contact has no word
                    continue
                if word.impacts <= self.impacts:
                    yield max(word.impacts, 1), word, guess

    def _correct(self, word: Word, guess: Start) -> None:
        """Correct one stretch of a motion."""
        self.guesses += 1
        links = None
        if word.flies:
            solved = closed_flights(self.rotor, word, guess)
            links = None if solved is None or solved.durations.min() < LEAST else links_of(self.rotor, word, solved)
        else:
            links = converged(self.rotor, word, guess)
        if links is None or not lasts(word, links.start):
            self.failures += 1
            return
        self.fertile = self.guesses
        if self._is_known(word, links.start, KNOWN):
            self.repeats += 1
        elif self._add(orbit_of_links(self.rotor, word, links)):
            self.last_new = self.guesses if self.found[-1].admissible else self.last_new
        else:
            self.repeats += 1

    def _is_known(self, word: Word, solution: Start, within: float) -> bool:
        """Whether a solution is a known one, to within a relative distance."""
        known = self.solutions.get(word)
        if known is None:
            return False
        # Entry by entry: a solution with one huge duration is not near to everything.
        return bool((np.abs(pack(solution) - known) < within * (1.0 + np.abs(known))).all(axis=1).any())

    def _add(self, orbit: Orbit) -> bool:
        """Keep an orbit; whether it is new and has no more impacts than are searched."""
        if orbit.impacts > self.impacts or any(same_orbit(orbit, other) for other in self.found):
            return False
        self.found.append(orbit)
        most = max(1, self.impacts // max(orbit.impacts, 1))
        for place in range(len(orbit.word)):
            turned = orbit.start.turned(place)
            for times in range(1, most + 1):
                several = Start(np.tile(turned.nodes, (times, 1)), np.tile(turned.durations, times))
                word = orbit.word.turned(place).repeated(times)
                solution = pack(several)[None]
                known = self.solutions.get(word, solution[:0])
                self.solutions[word] = np.concatenate([known, solution])
        return True
