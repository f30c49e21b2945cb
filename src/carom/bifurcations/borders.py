"""What becomes of a motion where its word changes: which orbits there are on both sides, and where simulated motions go."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from typing import Literal

import numpy as np

from carom.arguments import checked
from carom.bifurcations.neighbours import BORDERS, NEIGHBOURS, gives_way, is_other, read_beside, setting_out
from carom.bifurcations.paths import Path
from carom.bifurcations.points import Bifurcation
from carom.models import Rotor
from carom.models.axes import axis
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.exponents import CONFIDENT, lyapunov_exponents
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.shooting import Start
from carom.orbits.word import Word
from carom.outcome import CaromError, InputError, Outcome
from carom.results import Result

STEPS = (4e-5, 1e-5, 2.5e-6, 6.25e-7, 1.5625e-7)
"""Distances from the border at which both sides are examined, relative to the parameter; each a quarter of the one before."""
BESIDE = 1e-7
"""Relative change of the velocity at the start of a simulated motion."""
PATIENCE = 20_000
"""Impacts for which motions are simulated; those that have not settled by then count as they are."""
LATEST = 10_000
"""Number of last impacts whose distance from the orbit counts: beside a border a motion may stay near for thousands, and leave."""
SHRINKS = 0.75
"""Ratio of the distances at two neighbouring steps below which they count as shrinking; a square root gives a half."""
STAYS = 0.85
"""Ratio above which they count as staying; where a small jump adds to a square root, at the last steps alone."""
LARGEST_STEP, LEAST_JUMP = 0.3, 0.01
"""Distance above which even a shrinking one is not called small, and below which one that stays is not called a jump."""

LONG = 4
"""Number of equal segments in a row above which they are counted, not listed."""
STAYING = (Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
"""How motions end that do not leave the wall."""
SETTLED = 8
"""Periods of the orbit over which a motion counts that has settled, with lasting contact."""
TURNS = 50
"""Periods over which the distance of such a motion counts."""
RESOLVED = 1e-6
"""Departure down to which a motion with chatter is resolved: the simulation completes it where bounces have a speed of this size."""
MEASURED = 4000
"""Impacts over which the exponent of an irregular motion is measured."""

Verdict = Literal["continuous", "chaotic band", "jump", "undecided", "unstable"]


@dataclass(frozen=True, eq=False, repr=False)
class Border(Result):
    """What was found on both sides of a special point at which the word of an orbit changes.

    Everything here refers to five distances from the border.  Nothing is claimed beyond them, and a motion that was
    simulated for 20,000 impacts may go elsewhere later.

    Attributes
    ----------
    point : Bifurcation
    inside : {1, -1, 0}
        Side on which the orbit is a motion of the machine: where the parameter is above, or below, the border; 0 if not
        on exactly one.
    word : Word or None
        The neighbouring word; ``None`` if none was seen.
    neighbours : tuple of Orbit or None
        Orbits of the neighbouring word just below and just above the border, where they are motions: at the smallest of
        the distances at which one is found.
    distances : tuple of float
        From the border, in units of the parameter.
    departures : tuple of float
        How far from the orbit on the border the impacts of motions are that were started beside it at these distances
        outside, or all events of motions with lasting contact (:class:`~carom.bifurcations.paths.Path`); infinite for
        motions that no longer bounce, or no longer touch the wall if the orbit never leaves it.  Empty if the orbit is
        unstable or has no outside.
    exponents : tuple of (float, float)
        Largest Lyapunov exponent across each of these motions that is irregular, and its standard error; ``nan`` for
        the others.
    """

    point: Bifurcation
    inside: int
    word: Word | None
    neighbours: tuple[Orbit | None, Orbit | None]
    distances: tuple[float, ...]
    departures: tuple[float, ...]
    exponents: tuple[tuple[float, float], ...]

    @property
    def beyond(self) -> Orbit | None:
        """Orbit of the neighbouring word on the other side, where the orbit itself is no motion."""
        return self.neighbours[(1 - self.inside) // 2] if self.inside else None

    @property
    def alongside(self) -> Orbit | None:
        """Orbit of the neighbouring word on the same side."""
        return self.neighbours[(1 + self.inside) // 2] if self.inside else None

    @property
    def verdict(self) -> Verdict:
        """What simulated motions did when the orbit ceased to be a motion.

        ``"continuous"``: they stay near, the nearer the smaller the distance; ``"chaotic band"``: they do so and are
        irregular at all distances, with an exponent that is above zero by more than three standard errors; ``"jump"``:
        they go away at all distances, no less at the smallest ones, or by more than 0.3 at each; ``"unstable"``: the
        orbit is unstable on its own side, so that no motion can be followed from it.  With a chatter, departures below
        1e-6 are not told apart.
        """
        if not self.departures:
            return "unstable" if self.inside else "undecided"
        far, *nearer = self.departures
        if not np.isfinite(self.departures).all():
            return "jump" if not np.isfinite(self.departures).any() else "undecided"
        chatters = any(word is not None and word.lands.any() for word in (self.point.orbit.word, self.word))
        resolved = chatters * RESOLVED
        steps = [(a, b) for a, b in zip(self.departures, nearer, strict=False) if max(a, b) > resolved]
        ratios = [b / a if a > 0.0 else np.inf for a, b in steps]
        if far < LARGEST_STEP and ratios and max(ratios) < SHRINKS:
            chaotic = all(value > CONFIDENT * error for value, error in self.exponents)
            return "chaotic band" if chaotic else "continuous"
        # What shrinks like a root cannot be as far away as that at the smallest of these distances.
        away = min(self.departures) > LARGEST_STEP
        return "jump" if away or (min(self.departures) > LEAST_JUMP and min(ratios[-2:]) > STAYS) else "undecided"

    @property
    def _other(self) -> str:
        """The neighbouring word, equal segments in a row counted."""
        if self.word is None:
            return "of another word"
        runs = [(str(segment), sum(1 for _ in run)) for segment, run in groupby(self.word)]
        return " ".join(
            f"{count} × {segment}" if count > LONG else " ".join([segment] * count) for segment, count in runs
        )

    @property
    def words(self) -> str:
        """What was found, in one or two sentences."""
        side = {1: "above", -1: "below", 0: "on neither or both sides of"}[self.inside]
        told = f"{self.point.kind} at {self.point.parameter} = {self.point.value:.10g}: the orbit is a motion {side} it"
        if self.inside:
            other = {1: "below", -1: "above"}[self.inside]
            if self.beyond is not None:
                told += f", an orbit {self._other} ({_stability(self.beyond)}) {other} it"
            else:
                told += f", no orbit {self._other} was found {other} it"
            if self.alongside is not None:
                told += f", and one ({_stability(self.alongside)}) on the same side: both end there"
        seen = {
            "continuous": "Simulated motions beyond it stay near, the nearer the closer to it: a continuous transition.",
            "chaotic band": "Simulated motions beyond it stay near, the nearer the closer to it, and are irregular with a positive "
            "exponent: a band of chaos that begins there.",
            "jump": "Simulated motions beyond it move away by a distance that does not shrink with that from the border: a jump.",
            "unstable": "The orbit is unstable, so no motion was followed across.",
            "undecided": "Simulated motions beyond it do not decide between a continuous transition and a jump.",
        }[self.verdict]
        return f"{told}. {seen}"

    def rows(self) -> list[tuple[str, str]]:
        """What was found."""
        exponents = ", ".join(f"{value:.3g} ± {error:.1g}" for value, error in self.exponents)
        return [
            ("found", self.words),
            ("distances", ", ".join(f"{each:.3g}" for each in self.distances)),
            ("departures", ", ".join(f"{each:.3g}" for each in self.departures) or "none followed"),
            ("exponents", exponents or "none measured"),
        ]


@checked
def examine_border(point: Bifurcation) -> Border:
    """Look at both sides of a special point at which the word of an orbit changes.

    On both sides the orbits of both words next to the border are computed, with certified admissibility.  The
    neighbouring word follows from the orbit where an impact grazes, vanishes or ceases to slip; at the borders of
    lasting contact it is that of a simulated period that starts on the orbit, beside the border.  If the orbit is
    stable on its own side, motions are simulated that start beside it on the other side.

    Parameters
    ----------
    point : Bifurcation
        Of kind ``"grazing"``, ``"vanishing-impact"`` or ``"slip-stop"``, or of orbits with lasting contact
        ``"contact-onset"``, ``"permanent-contact"``, ``"cone-limit"``, ``"slide-stop"`` or ``"lift-off"``.

    Raises
    ------
    InputError
        Another kind.
    """
    if point.kind not in BORDERS:
        raise InputError("border", point.kind, f"one of {', '.join(BORDERS)}")
    orbit, sides = point.orbit, _Sides(point)
    contacts = orbit.nodes
    own = sides.own() if point.admissible else {}
    if point.kind in NEIGHBOURS and not gives_way(orbit):
        known, start = NEIGHBOURS[point.kind](orbit)
        contacts = np.concatenate([contacts, start.nodes])
        neighbours = sides.near(-1, sides.least, known, start), sides.near(1, sides.least, known, start)
        word: Word | None = known
    else:
        word, neighbours = sides.read()
    inside = sum(side for side, found in own.items() if found is not None)
    followed: list[tuple[float, tuple[float, float]]] = []
    held = own.get(inside)
    if held is not None and held.stable:
        apart = Path.of(orbit).distances if not orbit.word.flies else partial(_from_contacts, contacts)
        followed = [_follow(orbit, apart, sides.at(-inside, distance)) for distance in sides.distances]
    departures, exponents = tuple(departure for departure, _ in followed), tuple(found for _, found in followed)
    return Border(point, inside, word, neighbours, sides.distances, departures, exponents)


class _Sides:
    """Rotors on both sides of a border, and the orbits there."""

    def __init__(self, point: Bifurcation) -> None:
        self.orbit, self.value = point.orbit, point.value
        self.along = axis(self.orbit.rotor, point.parameter)
        self.distances = tuple(step * abs(point.value) for step in STEPS)

    def at(self, side: int, distance: float) -> Rotor:
        """Rotor on a side."""
        return self.along.move(self.orbit.rotor, self.value + side * distance)

    @property
    def least(self) -> float:
        """Smallest distance."""
        return self.distances[-1]

    def near(self, side: int, distance: float, word: Word, start: Start) -> Orbit | None:
        """Orbit of a word on a side, if it is a motion and next to that on the border."""
        found = orbit_near(self.at(side, distance), word, start)
        if found is None or not found.admissible or len(found.word) != len(word):
            return None
        return found if abs(found.period - self.orbit.period) < LARGEST_STEP else None

    def own(self) -> dict[int, Orbit | None]:
        """The orbit itself on both sides where it is a motion, at the smallest distance at which it is one on either."""
        found: dict[int, Orbit | None] = {-1: None, 1: None}
        for distance in reversed(self.distances):
            found = {side: self._own_at(side, distance) for side in (-1, 1)}
            # Bounces that the simulation leaves out of a chatter hide a slip of 1e-7.
            if self.orbit.word.flies or any(each is not None for each in found.values()):
                break
        return found

    def _own_at(self, side: int, distance: float) -> Orbit | None:
        found = self.near(side, distance, self.orbit.word, self.orbit.start)
        if found is None and not self.orbit.word.flies:
            # Where a segment shrinks like a root, the orbit on the border is no start for Newton's method.
            for word, start in read_beside(self.orbit, self.at(side, distance)):
                if found is None and not is_other(word, self.orbit.word):
                    found = self.near(side, distance, word, start)
        return found

    def read(self) -> tuple[Word | None, tuple[Orbit | None, Orbit | None]]:
        """The word that a simulated period has beside the border where it is not that of the orbit, and the orbits of it.

        They are those at the smallest distance at which one is found: close to permanent contact flights are lower than
        rounding.
        """
        seen = None
        for distance in reversed(self.distances):
            beside = [(side, *read) for side in (-1, 1) for read in read_beside(self.orbit, self.at(side, distance))]
            for side, word, start in beside:
                if not is_other(word, self.orbit.word):
                    continue
                seen = seen or word
                # Virtual where the motion was simulated, it may be a motion on the other side: then both orbits end at the border.
                closed = orbit_near(self.at(side, distance), word, start)
                guess = (word, start) if closed is None else (closed.word, closed.start)
                here, there = (self.near(each, distance, *guess) for each in (side, -side))
                found = here or there
                if found is not None:
                    return found.word, (here, there) if side < 0 else (there, here)
        return seen, (None, None)


def _from_contacts(contacts: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Distance of states (m, 2n) before impacts from the nearest of those of an orbit, shape (m,)."""
    nearest: np.ndarray = np.abs(states[:, None] - contacts).max(axis=2).min(axis=1)
    return nearest


def _follow(orbit: Orbit, apart: Callable[[np.ndarray], np.ndarray], rotor: Rotor) -> tuple[float, tuple[float, float]]:
    """Largest distance of a motion from the orbit beside which it starts, at its last events; its largest Lyapunov exponent if irregular."""
    before, regular = setting_out(orbit), (np.nan, np.nan)
    start = State(before.position, before.velocity * (1.0 + BESIDE))
    motion: Trajectory = simulate(rotor, start, settle=True, patience=PATIENCE)
    if motion.outcome not in (Outcome.BOUNCING, Outcome.MIXED):
        if any(segment.kind.flies for segment in orbit.word) or motion.outcome not in STAYING:
            return np.inf, regular
        motion = simulate(rotor, motion.final, TURNS * orbit.period)
    last = motion.arrivals[-LATEST:] if orbit.word.flies else _settled_on(motion, orbit.period)
    departure = float(apart(motion.rotor.system.nodes.of(last)).max())
    if motion.outcome is Outcome.TIME_REACHED or motion.multiplicity or departure > LARGEST_STEP:
        return departure, regular
    try:
        return departure, lyapunov_exponents(rotor, motion.final, MEASURED).across
    except CaromError:  # its segments cannot be repeated to eight digits, or it stops hitting the wall
        return departure, regular


def _settled_on(motion: Trajectory, period: float) -> np.ndarray:
    """Amplitudes at the events of a motion with lasting contact after it has settled, or at its last ones.

    It may settle within two periods.
    """
    if motion.outcome is Outcome.TIME_REACHED or not motion.multiplicity:
        return motion.arrivals[-LATEST:]
    return simulate(motion.rotor, motion.final, SETTLED * period).arrivals


def _stability(orbit: Orbit) -> str:
    return "stable" if orbit.stable else "unstable"
