"""The equations of orbits of a word along a parameter, the functions that vanish at special points, and the word beyond such a point."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import combinations
from math import isfinite, prod
from typing import Any

import numpy as np

from carom.base.outcome import CaromError, InputError
from carom.bifurcations.branches import speeds_at
from carom.bifurcations.conditions import BOUNDLESS, FASTEST
from carom.bifurcations.points import EXTREMUM, HALVING, HOPF, ONSET
from carom.continuation import Equations, Steps, Watch
from carom.core.friction import friction_margin, slip_of
from carom.core.margins import highest_point
from carom.core.planar import flight_profile
from carom.core.rub import wall_push
from carom.core.variation import apply_impact
from carom.models import Rotor
from carom.models.axes import Axis
from carom.orbits.admissibility import departure
from carom.orbits.orbit import Margins, Orbit, margins_of
from carom.orbits.shooting import (
    Links,
    ShootingStart,
    by_parameter,
    closed_flights,
    links_of,
    pack,
    unpack,
)
from carom.orbits.word import Kind, Word


def _with_impact(orbit: Orbit) -> tuple[Word, ShootingStart]:
    """One impact more, where the highest maximum of the radius touches the wall."""
    system, best = orbit.rotor.system, (-np.inf, 0, 0.0)
    nodes = system.nodes.amplitudes(orbit.nodes)
    left = [departure(orbit.rotor, *pair) for pair in zip(orbit.word, nodes, strict=True)]
    for i, after in enumerate(left):
        height, top = highest_point(system.arrays, 0, after, float(orbit.durations[i]))
        if height > best[0]:
            best = height, i, top
    _, i, top = best
    touching = system.fly(left[i], np.array(top))
    position, velocity = system.at_plane(touching, 0)
    slip = slip_of(complex(np.conj(position) * velocity), system.contacts[0].wall)
    added = Kind.IMPACT_FORWARD if slip > 0.0 else Kind.IMPACT_BACKWARD
    word = Word((*orbit.word[: i + 1], added, *orbit.word[i + 1 :]))
    states = np.insert(orbit.nodes, i + 1, system.nodes.of(touching[None])[0], axis=0)
    durations = np.insert(orbit.durations, i + 1, orbit.durations[i] - top)
    durations[i] = top
    return word, ShootingStart(states, durations)


def _without_impact(orbit: Orbit) -> tuple[Word, ShootingStart]:
    """One impact less: the slowest, which has no speed."""
    if len(orbit.word) == 1:
        raise InputError("orbit", str(orbit.word), "one with another flight than that after the impact that vanishes")
    # It comes last, so that the flight before it is the one that goes on.
    first = (int(np.argmin(orbit.impact_speeds)) + 1) % len(orbit.word)
    nodes, durations = orbit.start.turned(first)
    durations[-2] += durations[-1]
    return Word(orbit.word.turned(first)[:-1]), ShootingStart(nodes[:-1], durations[:-1])


def _with_other_slip(orbit: Orbit) -> tuple[Word, ShootingStart]:
    """The same impacts, one of which stops the slip or no longer does."""
    wall, gaps = orbit.rotor.system.contacts[0].wall, []
    for i, section in enumerate(orbit.sections):
        local = complex(section.radial_speed, section.angular_speed)
        gaps.append((abs(friction_margin(local, wall)), i, slip_of(local, wall)))
    _, i, slip = min(gaps)
    slides = Kind.IMPACT_FORWARD if slip > 0.0 else Kind.IMPACT_BACKWARD
    changed = Kind.IMPACT_STOPPED if orbit.word[i].sense else slides
    return Word((*orbit.word[:i], changed, *orbit.word[i + 1 :])), orbit.start


BORDERS: dict[str, Callable[[Orbit], tuple[Word, ShootingStart]]] = {
    "grazing": _with_impact,
    "vanishing-impact": _without_impact,
    "slip-stop": _with_other_slip,
}
"""Borders at which the word of a motion changes: from the orbit on the border the word, nodes and durations of the other side.

:class:`InputError` if no orbit is left without the impact.
"""


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
        """Least pull off a wall from which the rotor does not rebound, just after an impact; infinite with rebound."""
        system = self.rotor.system
        if system.contacts[0].wall.restitution:
            return np.inf
        nodes = system.nodes.amplitudes(self.links.start.nodes)
        left = (departure(self.rotor, kind, node) for kind, node in zip(self.word, nodes, strict=True))
        return min(-wall_push(system.arrays, 0, each)[0] for each in left)

    @property
    def flattest(self) -> float:
        """What changes its sign where the radius between impacts of a planar rotor gains a maximum and a minimum."""
        system, (nodes, durations) = self.rotor.system, self.links.start
        (after,) = system.nodes.amplitudes(nodes)
        apply_impact(system.arrays, 0, self.word[0].sense, after, np.empty((0, 2), complex))
        (slow, fast), (driving, driven) = system.exponents.tolist(), after.tolist()
        at = system.arrays["offsets"][0], driven, driving, system.arrays["restitution"][0]
        return float(flight_profile(slow, fast, *at, durations[0], self.margins.approach)[2])

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
    """The segments of a word from the unknowns of :func:`~carom.orbits.shooting.pack`; ``None`` where they are not defined."""
    start = unpack(unknowns, len(word))
    if start.durations.min() < (SHORTEST_ALONE if len(word) == 1 else SHORTEST):
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
}
"""Functions that vanish at special points; not finite where they are not defined."""


class WordFamily:
    """The equations of orbits of a word along a parameter; the last points, and the last rotors, are remembered."""

    def __init__(self, rotor: Rotor, along: Axis, word: Word, limits: tuple[float, float]) -> None:
        self.rotor, self.along, self.word, self.limits = rotor, along, word, limits
        self.size = max(abs(along.value(rotor)), 0.1 * (limits[1] - limits[0]))
        self.rotor_at = lru_cache(REMEMBERED)(self._rotor_at)
        self._known = lru_cache(REMEMBERED)(self._evaluated)

    def _rotor_at(self, p: float) -> Rotor | None:
        """The rotor at a value of the parameter; ``None`` where there is none."""
        try:
            return self.along.move(self.rotor, p)
        except InputError:
            return None

    def point(self, u: np.ndarray, p: float) -> FamilyPoint | None:
        """The segments from the unknowns; ``None`` where they are not defined."""
        return self._known(u.tobytes(), p)

    def _evaluated(self, unknowns: bytes, p: float) -> FamilyPoint | None:
        rotor = self.rotor_at(p)
        return None if rotor is None else point_at(rotor, self.word, np.frombuffer(unknowns))

    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        """Left sides of the equations; ``nan`` where they are not defined."""
        point = self.point(u, p)
        return np.full(len(u), np.nan) if point is None else point.links.residual

    def jacobian(self, u: np.ndarray, p: float) -> np.ndarray:
        """Their exact derivatives by the unknowns and by the parameter."""
        point = self.point(u, p)
        if point is None:
            return np.full((len(u), len(u) + 1), np.nan)
        slopes = np.empty((len(u), len(u) + 1))
        slopes[:, :-1] = point.links.jacobian
        slopes[:, -1] = by_parameter(point.rotor, self.word, point.links.start, self.along.name)
        return slopes

    def solved(self, u: np.ndarray, p: float) -> np.ndarray | None:
        """Orbit next to a point at the same parameter; ``None`` where the iteration fails."""
        rotor = self.rotor_at(p)
        if rotor is None:
            return None
        found = closed_flights(rotor, self.word, unpack(u, len(self.word)))
        return None if found is None else pack(found)

    def beside(self, doubled: np.ndarray, p: float, tangent: np.ndarray) -> tuple[np.ndarray, float]:
        """Point of the branch in the hyperplane at a distance along a direction from a point."""
        sizes, normal = np.append(np.ones(len(doubled)), self.size), np.append(tangent, 0.0)
        equations = Equations(self.residual, self.jacobian, sizes, Steps(iterations=CORRECTIONS))
        guess = np.append(doubled, p / self.size) + FROM_DOUBLING * normal
        found = equations.correct(guess, normal, equations.inverse(guess, normal))
        if found is None:
            raise CaromError("no orbit of twice the period was found beside the period doubling")
        u, p = equations.plain(found)
        return u, min(max(p, self.limits[0]), self.limits[1])

    def speeds(self, u: np.ndarray) -> list[complex]:
        """``ṙ`` in ``c_r Ω`` and ``θ̇`` in ``Ω`` before each impact, as real and imaginary part."""
        return speeds_at(unpack(u, len(self.word)).nodes).tolist()

    def fastest(self, u: np.ndarray) -> float:
        """Largest radial speed before an impact."""
        return max(abs(speed.real) for speed in self.speeds(u))

    def reach(self, u: np.ndarray) -> float:
        """Factor by which steps may grow: a branch whose speeds grow without bound becomes straight."""
        return max([1.0, *(abs(speed) / FAST for speed in self.speeds(u))])

    def _nearness(self, u: np.ndarray, p: float) -> float:
        """Above zero as long as the orbit is a motion, or not far from one."""
        point = self.point(u, p)
        if point is None:
            return np.nan
        return min(point.margins.radius - RADIUS_MARGIN, point.margins.approach - SPEED_MARGIN, 1.0)

    def watches(self, start: np.ndarray, *, virtual: bool = True) -> list[Watch]:
        """Functions that vanish at the special points, and where the branch ends."""
        return [*self._special_points(), *self._ends(start, virtual=virtual)]

    def _special_points(self) -> list[Watch]:
        # The continuation finds folds itself.
        rebounds = self.rotor.system.contacts[0].wall.restitution > 0.0
        tests = {kind: test for kind, test in TESTS.items() if kind != "fold" and not (kind == ONSET and rebounds)}
        if len(self.word) == 1:
            # Without its only impact the rotor never leaves levitation.
            tests[HOPF] = tests.pop("vanishing-impact")
            # Beyond that point the orbit meets the wall from outside, and its maxima lie outside from the first.
            tests["grazing"] = lambda point: min(point.margins.radius, 1.0) if point.margins.approach >= 0.0 else 1.0
            tests[EXTREMUM] = lambda point: point.flattest
        return [Watch(kind, self._where_defined(test)) for kind, test in tests.items()]

    def _where_defined(self, test: Callable[[FamilyPoint], float]) -> Callable[[np.ndarray, float], float]:
        """A test as a function of the unknowns and the parameter."""

        def value(u: np.ndarray, p: float) -> float:
            point = self.point(u, p)
            found = np.nan if point is None else test(point)
            return found if isfinite(found) else np.nan

        return value

    def _ends(self, start: np.ndarray, *, virtual: bool) -> list[Watch]:
        """What ends the branch through a point beside special points: bounds, and parts of the orbit that vanish or become equal."""
        fastest = max(FASTEST, 2.0 * self.fastest(start))
        ends: dict[str, Callable[[np.ndarray, float], float]] = {BOUNDLESS: lambda u, _: fastest - self.fastest(u)}
        if not virtual:
            ends[FAR_FROM_MOTION] = self._nearness
        if (halves := halving(self.word, start)) is not None:
            ends[HALVING] = lambda u, _: halves(u)
        watches = [Watch(kind, function, at_zero="end") for kind, function in ends.items()]
        return [*watches, Watch(HOPF, lambda u, _: self.fastest(u) - AT_REST, at_zero="avoid")]


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
