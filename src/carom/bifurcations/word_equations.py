"""The equations of orbits of a word along a parameter, and the functions that vanish at special points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from itertools import combinations
from math import isfinite, prod
from typing import Any

import numpy as np

from carom.bifurcations.branches import speeds_at
from carom.bifurcations.conditions import BOUNDLESS, FASTEST
from carom.bifurcations.points import EXTREMUM, HALVING, HOPF, OF_CONTACT, ONSET, PERMANENT
from carom.continuation import Watch
from carom.continuation.equations import applied
from carom.core.planar import flight_profile
from carom.core.rub import wall_push
from carom.core.segments import LEAST_PUSH
from carom.core.variation import strike
from carom.models import Rotor
from carom.models.axes import Axis
from carom.orbits.admissibility import departure
from carom.orbits.orbit import Margins, margins_of
from carom.orbits.shooting import (
    Links,
    by_parameter,
    closed_flights,
    links_of,
    pack,
    unpack,
    unpack_free,
)
from carom.orbits.word import Kind, Word
from carom.outcome import CaromError, InputError

DIFFERENCE = 1e-6
"""Step of the differences by the parameter, relative to its size, where there is no exact derivative; they only bend the predicted direction."""
REMEMBERED = 64
"""Points whose segments are kept: each is asked for by the equations, their derivative and all watches."""
SHORTEST, SHORTEST_ALONE = 1e-6, 1e-3
"""Duration of a flight, in ``1/Ω``, at which a branch ends; the second for the only flight of a period, which can vanish if ``d = 1``:
there rounding shifts the parameter of the orbit by some 1e-7."""
FROM_DOUBLING = 0.02
"""Distance, in the norm of all unknowns, at which a branch born in a period doubling is begun."""
CORRECTIONS = 20
FAR_FROM_MOTION = "far from a motion"
"""Where a branch ends that is not followed among virtual orbits."""
FLIGHTS_VANISH, SHORTEST_FLIGHT = "flights vanish", 0.03
"""Where a branch ends because flights between lasting contacts vanish, and their duration there, in ``1/Ω``: their height falls
with the fourth power of it, so that there is nothing to be computed beyond."""
CONTACT_VANISHES, BEYOND_VANISHING = "contact vanishes", -0.05
"""Where a branch ends beyond the value at which a stretch of lasting contact shrinks to nothing, and its duration there, in ``1/Ω``."""
AT_REST = 1e-9
"""Radial speeds, in ``c_r Ω``, at or below which nodes are no orbit: the equilibrium on the wall solves the equations with any durations."""
FAST = 3.0
"""Speed before an impact, in ``c_r Ω``, above which steps grow with it."""
RADIUS_MARGIN, SPEED_MARGIN = -0.3, -0.1
"""Margins of the radius and of the radial speed at an impact beyond which an orbit is far from being a motion."""


@dataclass(frozen=True)
class FamilyPoint:
    """The segments of an orbit at a value of the parameter, and what is watched there."""

    # Not narrower: the closed form reads the parameters of a planar rotor.
    rotor: Any
    word: Word
    links: Links

    @cached_property
    def margins(self) -> Margins:
        """Distances from a change of the word."""
        return margins_of(self.links, self.rotor, self.word)

    @property
    def onset(self) -> float:
        """Least distance from the onset of lasting contact, proportional to that of the parameter; or infinite.

        That of a chatter, or the pull off a wall from which the rotor does not rebound just after an impact.
        """
        if not self.word.flies:
            return float(self.links.landings.min())
        system = self.rotor.system
        struck = [i for i, plane in enumerate(self.word.planes) if not system.contacts[plane].wall.restitution]
        nodes = system.nodes.amplitudes(self.links.start.nodes[struck])
        left = (departure(self.rotor, self.word[i], node) for i, node in zip(struck, nodes, strict=True))
        pushes = (wall_push(system.arrays, self.word[i].plane, each)[0] for i, each in zip(struck, left, strict=True))
        return min((-push for push in pushes), default=np.inf)

    @property
    def flattest(self) -> float:
        """What changes its sign where the radius between impacts of a planar rotor gains a maximum and a minimum."""
        system, (nodes, durations) = self.rotor.system, self.links.start
        (after,) = system.nodes.amplitudes(nodes)
        strike(system.arrays, 0, self.word[0].kind.sense, after, np.empty((0, 2), complex))
        (slow, fast), (driving, driven) = system.exponents.tolist(), after.tolist()
        at = system.arrays["offsets"][0], driven, driving, system.arrays["restitution"][0]
        return float(flight_profile(slow, fast, *at, durations[0], self.margins.approach)[2])

    @property
    def least_push(self) -> float:
        """Least normal force of sliding that goes on where it is least; infinite for words without."""
        goes_on = self.word.conditions[np.arange(len(self.word)) - 1] == LEAST_PUSH
        return self.margins.normal_force if goes_on.any() else np.inf

    @cached_property
    def multipliers(self) -> list[complex]:
        """Non-trivial multipliers; ``nan`` where an impact grazes."""
        monodromy = self.links.monodromy
        if not isfinite(monodromy.sum()):
            return [complex(np.nan)] * (len(monodromy) - 1)
        found: list[complex] = np.linalg.eigvals(monodromy).astype(complex).tolist()
        # The derivative of the return to the wall has a zero of its own.
        found.remove(min(found, key=abs))
        return found

    @property
    def pairs(self) -> list[tuple[complex, complex]]:
        """Products and sums of the multipliers, two at a time."""
        return [(first * second, first + second) for first, second in combinations(self.multipliers, 2)]

    @property
    def pair_sum(self) -> float:
        """Sum of the two multipliers whose product is closest to one: ``2 cos α`` on a Neimark–Sacker curve."""
        return min(self.pairs, key=lambda pair: abs(pair[0] - 1.0))[1].real


def point_at(rotor: Rotor, word: Word, unknowns: np.ndarray) -> FamilyPoint | None:
    """The segments of a word from the unknowns of :func:`~carom.orbits.shooting.pack_free`; ``None`` where they are not defined."""
    start = unpack_free(word, unknowns)
    # The contact after a chatter may vanish: lasting contact begins there.  Contact that shrinks to nothing goes on with negative duration.
    shortest = SHORTEST_ALONE if word.flies and len(word) == 1 else SHORTEST
    if min(start.durations[word.timed_flights].tolist(), default=np.inf) < shortest:
        return None
    links = links_of(rotor, word, start)
    return FamilyPoint(rotor, word, links) if all(map(isfinite, links.residual.tolist())) else None


TESTS: dict[str, Callable[[FamilyPoint], float]] = {
    "fold": lambda point: prod([1.0 - each for each in point.multipliers], start=1.0 + 0j).real,
    "period-doubling": lambda point: prod([1.0 + each for each in point.multipliers], start=1.0 + 0j).real,
    "neimark-sacker": lambda point: prod([product - 1.0 for product, _ in point.pairs], start=1.0 + 0j).real,
    "vanishing-impact": lambda point: point.margins.approach,
    # Without maxima the margin is that of a flight through the centre: their birth is not an event.  A flight that meets the wall
    # from outside has a maximum beyond the wall.
    "grazing": lambda point: min(point.margins.radius, 1.0) if point.margins.approach >= 0.0 else np.nan,
    "slip-stop": lambda point: point.margins.slip,
    ONSET: lambda point: point.onset,
    PERMANENT: lambda point: point.least_push,
    "cone-limit": lambda point: point.margins.cone,
    "slide-stop": lambda point: point.margins.sliding,
    "lift-off": lambda point: point.margins.pressing,
}
"""Functions that vanish at special points; not finite where they are not defined."""


class Orbits:
    """Orbits of a word by their unknowns and the values of parameters; the last ones, and the last rotors, are remembered."""

    def __init__(self, word: Word, rotor_of: Callable[..., Rotor]) -> None:
        self.word, self._rotor_of = word, rotor_of
        self.rotor_at = lru_cache(REMEMBERED)(self._rotor_at)
        self._known = lru_cache(REMEMBERED)(self._evaluated)

    def _rotor_at(self, *place: float) -> Rotor | None:
        """The rotor at values of the parameters; ``None`` where there is none."""
        try:
            return self._rotor_of(*place)
        except InputError:
            return None

    def point(self, u: np.ndarray, *place: float) -> FamilyPoint | None:
        """The segments from the free unknowns; ``None`` where they are not defined."""
        return self._known(u.tobytes(), *place)

    def _evaluated(self, unknowns: bytes, *place: float) -> FamilyPoint | None:
        rotor = self.rotor_at(*place)
        return None if rotor is None else point_at(rotor, self.word, np.frombuffer(unknowns))


class Family(Orbits):
    """The equations of orbits of a word along a parameter."""

    def __init__(self, rotor: Rotor, along: Axis, word: Word, limits: tuple[float, float]) -> None:
        super().__init__(word, partial(along.move, rotor))
        self.rotor, self.along, self.limits = rotor, along, limits
        self.size = max(abs(along.value(rotor)), 0.1 * (limits[1] - limits[0]))
        self.strikes = word.arrives
        self.struck = word.planes[self.strikes]

    def whole(self, u: np.ndarray, p: float) -> np.ndarray:
        """All nodes and durations, in the order of :func:`~carom.orbits.shooting.pack`, from the unknowns."""
        if self.word.flies:
            return u
        point = self.point(u, p)
        return np.full_like(pack(unpack_free(self.word, u)), np.nan) if point is None else pack(point.links.start)

    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        """Left sides of the equations; ``nan`` where they are not defined."""
        point = self.point(u, p)
        return np.full(len(u), np.nan) if point is None else point.links.reduced[0]

    def jacobian(self, u: np.ndarray, p: float) -> np.ndarray:
        """Their derivatives by the unknowns, which are exact, and by the parameter."""
        point = self.point(u, p)
        if point is None:
            return np.full((len(u), len(u) + 1), np.nan)
        slopes = np.empty((len(u), len(u) + 1))
        slopes[:, :-1], slopes[:, -1] = point.links.reduced[1], self._by_parameter(point, p)
        return slopes

    def solved(self, u: np.ndarray, p: float) -> np.ndarray | None:
        """Orbit of a word without lasting contact next to a point at the same parameter; ``None`` where the iteration fails."""
        rotor = self.rotor_at(p)
        if rotor is None:
            return None
        found = closed_flights(rotor, self.word, unpack(u, len(self.word)))
        return None if found is None else pack(found)

    def _by_parameter(self, point: FamilyPoint, p: float) -> np.ndarray:
        """Derivative of the equations by the parameter: exact, or by a difference inside the limits."""
        exact = by_parameter(point.rotor, self.word, point.links.start, self.along.name)
        if exact is not None:
            return exact
        step = DIFFERENCE * self.size
        step = step if p + step <= self.limits[1] else -step
        moved = links_of(self.along.move(self.rotor, p + step), self.word, point.links.start)
        slope: np.ndarray = (moved.reduced[0] - point.links.reduced[0]) / step
        return slope

    def beside(self, doubled: np.ndarray, p: float, tangent: np.ndarray) -> tuple[np.ndarray, float]:
        """Point of the branch in the hyperplane at a distance along a direction from a point."""
        u = doubled + FROM_DOUBLING * tangent
        for _ in range(CORRECTIONS):
            residual = self.residual(u, p)
            if not np.isfinite(residual).all():
                break
            slopes = self.jacobian(u, p) * np.append(np.ones(len(u)), self.size)
            misses = np.append(-residual, FROM_DOUBLING - tangent @ (u - doubled))
            change = applied(np.linalg.solve, slopes, np.append(tangent, 0.0), misses)
            if change is None:
                break
            u, p = u + change[:-1], p + self.size * float(change[-1])
            if np.abs(change).max() < 1e-12:
                return u, min(max(p, self.limits[0]), self.limits[1])
        raise CaromError("no orbit of twice the period was found beside the period doubling")

    def speeds(self, u: np.ndarray) -> list[complex]:
        """``ṙ`` in ``c_r Ω`` and ``θ̇`` in ``Ω`` before each impact, as real and imaginary part."""
        speeds: list[complex] = speeds_at(
            self.rotor, self.struck, unpack_free(self.word, u).nodes[self.strikes]
        ).tolist()
        return speeds

    def fastest(self, u: np.ndarray) -> float:
        """Largest radial speed before an impact."""
        return max((abs(speed.real) for speed in self.speeds(u)), default=0.0)

    def reach(self, u: np.ndarray) -> float:
        """Factor by which steps may grow: a branch whose speeds grow without bound becomes straight."""
        return max([1.0, *(abs(speed) / FAST for speed in self.speeds(u))])

    def _may_happen(self, kind: str) -> bool:
        """Whether orbits of the word can have special points of a kind."""
        if not self.word.flies or kind not in OF_CONTACT:
            return True
        return kind == ONSET and any(not contact.wall.restitution for contact in self.rotor.system.contacts)

    def _nearness(self, u: np.ndarray, p: float) -> float:
        """Above zero as long as the orbit is a motion, or not far from one."""
        point = self.point(u, p)
        return (
            np.nan
            if point is None
            else min(point.margins.radius - RADIUS_MARGIN, point.margins.approach - SPEED_MARGIN, 1.0)
        )

    def watches(self, start: np.ndarray, *, virtual: bool = True) -> list[Watch]:
        """Functions that vanish at the special points, and where the branch ends."""
        return [*self._special_points(), *self._ends(start, virtual=virtual)]

    def _special_points(self) -> list[Watch]:
        # The continuation finds folds itself.
        tests = {kind: test for kind, test in TESTS.items() if kind != "fold" and self._may_happen(kind)}
        if self.word.impacts == 1 and self.word.flies:
            # Without its only arrival the rotor never leaves levitation.
            tests[HOPF] = tests.pop("vanishing-impact")
            # Beyond that point the orbit meets the wall from outside, and its maxima lie outside from the first.
            tests["grazing"] = lambda point: min(point.margins.radius, 1.0) if point.margins.approach >= 0.0 else 1.0
            if self.rotor.system.is_planar:
                tests[EXTREMUM] = lambda point: point.flattest
        # Where friction stops the slip before a slide, this ceases to be; other words go on among virtual orbits.
        slides = bool((self.word.landed & (self.word.kinds != Kind.ROLL)).any())
        ends = {ONSET: not self.word.flies, "slide-stop": slides}
        return [
            Watch(kind, self._where_defined(test), at_zero="end" if ends.get(kind) else "pass")
            for kind, test in tests.items()
        ]

    def _where_defined(self, test: Callable[[FamilyPoint], float]) -> Callable[[np.ndarray, float], float]:
        """A test as a function of the unknowns and the parameter."""

        def value(u: np.ndarray, p: float) -> float:
            point = self.point(u, p)
            found = np.nan if point is None else test(point)
            return found if isfinite(found) else np.nan

        return value

    def _ends(self, start: np.ndarray, *, virtual: bool) -> list[Watch]:
        """What ends the branch through a point beside special points: bounds, and parts of the orbit that vanish or become equal."""

        def beyond(segments: np.ndarray, least: float) -> Callable[[np.ndarray, float], float]:
            return lambda u, _: float(unpack_free(self.word, u).durations[segments].min()) - least

        fastest = max(FASTEST, 2.0 * self.fastest(start))
        ends: dict[str, Callable[[np.ndarray, float], float]] = {BOUNDLESS: lambda u, _: fastest - self.fastest(u)}
        if not virtual:
            ends[FAR_FROM_MOTION] = self._nearness
        contacts = self.word.timed & np.array([segment.kind.lasts for segment in self.word])
        if contacts.any():
            ends[CONTACT_VANISHES] = beyond(contacts, BEYOND_VANISHING)
        if (lifts := self.word.kinds == Kind.LIFT).any():
            ends[FLIGHTS_VANISH] = beyond(lifts, SHORTEST_FLIGHT)
        if (halves := halving(self.word, start)) is not None:
            ends[HALVING] = lambda u, _: halves(u)
        watches = [Watch(kind, function, at_zero="end") for kind, function in ends.items()]
        if self.word.flies:
            watches.append(Watch(HOPF, lambda u, _: self.fastest(u) - AT_REST, at_zero="avoid"))
        return watches


def halving(word: Word, start: np.ndarray) -> Callable[[np.ndarray], float] | None:
    """Function of the free unknowns that vanishes where both halves of a period become equal; ``None`` if their words differ.

    Parameters
    ----------
    start : ndarray
        Unknowns at which it is positive.
    """
    m = len(word)
    if m % 2 or (m // 2) % word.least:
        return None
    first = np.subtract(*np.split(start, 2))

    def halves(u: np.ndarray) -> float:
        apart = np.subtract(*np.split(u, 2))
        return float(np.copysign(np.linalg.norm(apart), apart @ first))

    return halves
