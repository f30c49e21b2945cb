"""Changes of the motions of a machine between two points of a plane, and the bifurcations that cause them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from carom.bifurcations.conditions import TESTS, conditions_at, is_admissible
from carom.bifurcations.motions import Motions, forward_orbits, motions_at
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import STEADY, Bifurcation
from carom.parameters import Numbers, Parameters

NARROW = 1e-9
"""Width of the bracket around a change, in widths of the plane."""
SAME_ORBIT = 1e-3
"""Largest difference of period and radial speed between the same orbit on both sides of a bracket."""
SHRUNK = 1e-3
"""Radial speed, in ``c_r Ω``, below which an orbit in a bracket may vanish in the boundary equilibrium."""
_OF_ORBITS = {"fold", "speed-fold", "grazing", "slip-stop", "contact-onset", "non-smooth-hopf", "levitation-lost"}
CHANGED_BY = {
    "contact_free": {"boundary-equilibrium", "levitation-lost"},
    "rub": {"rub-fold", "boundary-equilibrium"},
    "rolling": {"rolling-limit"},
    "orbits": _OF_ORBITS,
    "stable_orbits": _OF_ORBITS | {"period-doubling", "neimark-sacker"},
}
"""Bifurcations that can change each count of :class:`~carom.bifurcations.motions.Motions`."""


class PlanePoint(NamedTuple):
    """A point of the plane, and the motions there."""

    place: np.ndarray
    motions: Motions


@dataclass(frozen=True)
class UnexplainedChange:
    """A change of motions that lies on none of the curves found.

    Attributes
    ----------
    point : tuple of float
        Its place in the plane.
    before, after : Motions
        Motions on the side of smaller and of larger values.
    reason : str
        Why there is no curve.
    """

    point: tuple[float, float]
    before: Motions
    after: Motions
    reason: str

    @property
    def words(self) -> str:
        """What changes, in words."""
        pairs = zip(self.before.parts, self.after.parts, strict=True)
        return "; ".join(f"{before} -> {after}" for before, after in pairs if before != after)


def change_between(
    parameters: Parameters, plane: Plane, low: PlanePoint, high: PlanePoint
) -> tuple[PlanePoint, PlanePoint]:
    """Narrow bracket, by bisection, around one of the changes of motions between two points that differ."""
    while np.linalg.norm((high.place - low.place) / plane.widths) > NARROW:
        place = 0.5 * (low.place + high.place)
        middle = PlanePoint(place, motions_at(plane.at(parameters, *place.tolist())))
        if middle.motions == low.motions:
            low = middle
        else:
            high = middle
    return low, high


def accounts_for(kinds: set[str], before: Motions, after: Motions) -> bool:
    """Whether bifurcations of these kinds can change one set of motions into the other."""
    return all(getattr(before, name) == getattr(after, name) or bool(kinds & able) for name, able in CHANGED_BY.items())


def causes_between(parameters: Parameters, plane: Plane, low: PlanePoint, high: PlanePoint) -> list[Bifurcation]:
    """Bifurcations of motions of the machine in a narrow bracket, from the test functions that change sign in it."""
    sides = [plane.numbers_at(Numbers.of(parameters), *point.place.tolist()) for point in (low, high)]
    steady = [Bifurcation(kind, sides[0]) for kind in STEADY if _changes_sign(kind, *sides)]
    here, there = ([orbit[1:] for orbit in forward_orbits(numbers.parameters)] for numbers in sides)
    return [*steady, *causes_of_orbits(here, there, _changes_sign("boundary-equilibrium", *sides))]


def _changes_sign(kind: str, low: Numbers, high: Numbers) -> bool:
    """Whether the test function of a steady motion changes sign."""
    return (TESTS[kind](low, 1.0, 0.0) < 0.0) != (TESTS[kind](high, 1.0, 0.0) < 0.0)


Known = tuple[Numbers, float, float]


def causes_of_orbits(here: list[Known], there: list[Known], shrinks: bool) -> list[Bifurcation]:
    """Match the orbits of both sides: compare the test functions of each pair, and explain unmatched orbits.

    ``shrinks`` says whether levitation meets the wall in between, into which orbits shrink.
    """
    causes, missing = [], []
    for orbit in here:
        match = min(there, key=lambda other: _apart(orbit, other), default=None)
        if match is not None and _apart(orbit, match) < SAME_ORBIT:
            there.remove(match)
            causes += _of_one_orbit(orbit, match)
        else:
            missing.append(orbit)
    return causes + _of_vanishing_orbits(missing, shrinks) + _of_vanishing_orbits(there, shrinks)


def _apart(first: Known, second: Known) -> float:
    return abs(first[1] - second[1]) + abs(first[2] - second[2])


def _of_one_orbit(low: Known, high: Known) -> list[Bifurcation]:
    """Bifurcations of an orbit between two sides, if it is a motion of the machine on one of them."""
    if not (is_admissible(*low) or is_admissible(*high)):
        return []
    causes = []
    for kind in ("grazing", "slip-stop", "contact-onset", "period-doubling", "neimark-sacker"):
        before, after = TESTS[kind](*low), TESTS[kind](*high)
        # Without a maximum between the impacts the height is nan, and the orbit stays inside.
        changes = (before >= 0.0) != (after >= 0.0)
        complex_pair = kind != "neimark-sacker" or abs(conditions_at(*low).pair_sum) < 2.0
        if changes and complex_pair:
            causes.append(Bifurcation(kind, *low))
    return causes


def _of_vanishing_orbits(orbits: list[Known], shrinks: bool) -> list[Bifurcation]:
    """Bifurcations of orbits that exist on one side only: two of them meet, or one shrinks to nothing if possible."""
    causes: list[Bifurcation] = []
    met: list[tuple[Known, Known]] = []
    for orbit in orbits:
        others = [other for other in orbits if other is not orbit]
        partner = min(others, key=lambda other: _apart(orbit, other), default=None)
        if shrinks and orbit[2] < SHRUNK:
            causes.append(Bifurcation("non-smooth-hopf", orbit[0], orbit[1], 0.0))
        elif partner is not None:
            kind = "speed-fold" if partner[1] == orbit[1] else "fold"
            if (partner, orbit) not in met:
                met.append((orbit, partner))
                between = 0.5 * (orbit[1] + partner[1]), 0.5 * (orbit[2] + partner[2])
                causes.append(Bifurcation(kind, orbit[0], *between))
    return causes
