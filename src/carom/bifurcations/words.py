"""Branches of orbits of any word along a parameter, with their special points, and switching at period doublings.

The equations are those of multiple shooting (:mod:`carom.orbits.shooting`).  Durations are among the unknowns, so a branch
passes through grazing and goes on with orbits that are not motions of the machine.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from carom.bifurcations.branches import OrbitBranch, continue_single_impact
from carom.continuation import SpecialPoint, Steps, Watch, continue_branch
from carom.models import Model, model_of
from carom.models.axes import Axis, Ends, axis, interval_around
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.orbit import Margins, Orbit, margins_of, on_section
from carom.orbits.shooting import Links, Start, links_of, pack, unpack
from carom.orbits.word import Kind, Word
from carom.outcome import CaromError, InputError
from carom.results import Result

STEPS = Steps(first=0.02, largest=0.15, sharpest_turn=0.25, most_points=600, tolerance=1e-11)
DIFFERENCE = 1e-6
"""Step of the differences by the parameter, relative to its size; they only bend the predicted direction."""
REMEMBERED = 64
"""Points whose segments are kept: each is asked for by the equations, their derivative and all watches."""
SHORTEST = 1e-6
"""Duration of a flight, in ``1/Ω``, at which a branch ends."""
ASIDE = 0.02
"""Distance, in the norm of all unknowns, at which a branch born in a period doubling is begun."""
BEYOND = 0.2
"""Half of the range, relative to the parameter, in which a branch is followed that is switched to without a range."""
CORRECTIONS = 20


@dataclass(frozen=True, eq=False, repr=False)
class SpecialOrbit(Result):
    """A special point of a branch of orbits of any word.

    Attributes
    ----------
    kind : str
        ``"fold"``, ``"period-doubling"``, ``"neimark-sacker"``, ``"grazing"`` (a maximum of the radius reaches the wall),
        ``"vanishing-impact"`` (the speed of an impact vanishes: grazing of the orbit without this impact), ``"slip-stop"``
        (friction begins or ceases to stop the slip in an impact), ``"contact-onset"`` (the normal force at the beginning of lasting
        contact vanishes), ``"cone-limit"`` (rolling begins at the limit of friction), or ``"period-halving"`` (both halves of the
        period become equal: the branch ends on one of orbits of half the period).
    axis : Axis
        The parameter.
    value : float
        Its value.
    orbit : Orbit
        The orbit there.
    place : float
        Position on the branch: index of the point before it plus the fraction of the step.
    """

    kind: str
    axis: Axis
    value: float
    orbit: Orbit
    place: float

    def switch(self, interval: Ends | None = None) -> WordBranch:
        """Branch of orbits of twice the period that is born in this period doubling; see :func:`switched`."""
        return switched(self.kind, self.orbit, self.axis.name, interval)


@dataclass(frozen=True, eq=False, repr=False)
class WordBranch(Result):
    """Orbits of a word along a parameter, motions of the machine and others.

    Attributes
    ----------
    axis : Axis
    word : Word
    rotor : Model
        The rotor from which the branch was followed.
    values : ndarray, shape (m,)
        The parameter.
    unknowns : ndarray, shape (m, k)
        Nodes and durations, in the order of :func:`carom.orbits.shooting.pack`.
    special : tuple of SpecialOrbit
        In the order of the branch.
    stops : tuple of two str
        Reason for its end at both ends: ``"period-halving"``, or see :class:`~carom.continuation.Branch`.
    """

    shown: ClassVar[tuple[str, ...]] = ("axis", "word", "values", "period", "special", "stops")

    axis: Axis
    word: Word
    rotor: Model
    values: np.ndarray
    unknowns: np.ndarray
    special: tuple[SpecialOrbit, ...]
    stops: tuple[str, str]

    def __len__(self) -> int:
        return len(self.values)

    @property
    def period(self) -> np.ndarray:
        """Periods in ``1/Ω``, shape (m,)."""
        total: np.ndarray = self.unknowns.reshape(len(self), len(self.word), -1)[:, :, -1].sum(axis=1)
        return total

    @cached_property
    def orbits(self) -> tuple[Orbit, ...]:
        """Every orbit, with its multipliers and its admissibility certified."""
        pairs = zip(self.values.tolist(), self.unknowns, strict=True)
        return tuple(_orbit_at(self.axis.move(self.rotor, p), self.word, u) for p, u in pairs)

    @cached_property
    def admissible(self) -> np.ndarray:
        """Which orbits are motions of the machine, bool, shape (m,)."""
        return np.array([orbit.admissible for orbit in self.orbits])

    @cached_property
    def stable(self) -> np.ndarray:
        """Which orbits have all multipliers inside the unit circle, bool, shape (m,)."""
        return np.array([orbit.stable for orbit in self.orbits])

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Non-trivial Floquet multipliers, complex, shape (m, 2N − 1)."""
        return np.array([orbit.multipliers.values for orbit in self.orbits])


def continue_orbit(
    orbit: Orbit, parameter: str, interval: Ends, steps: Steps | None = None
) -> OrbitBranch | WordBranch:
    """Continue an orbit along a parameter, through folds, grazing and stretches where it is virtual.

    Orbits of the closed form are continued by their own two equations, all others by multiple shooting.

    Parameters
    ----------
    parameter : str
        A parameter of the rotor: for the planar one dimensionless (``"gamma"``) or physical (``"speed"``, SI units; needs scales).
    interval : tuple of float or str
        Range of the parameter; it must contain the orbit's own value.  ``("300 N s/m", "2000 N s/m")`` has units.

    Returns
    -------
    OrbitBranch or WordBranch

    Raises
    ------
    InputError
        Unknown parameter, or an interval without the orbit.
    """
    if isinstance(orbit.name, OrbitName):
        return continue_single_impact(orbit, parameter, interval, steps)
    return continue_word(orbit, parameter, interval, steps)


def continue_word(orbit: Orbit, parameter: str, interval: Ends, steps: Steps | None = None) -> WordBranch:
    """:func:`continue_orbit` by multiple shooting, for an orbit of any word."""
    along = axis(orbit.rotor, parameter)
    present, limits = interval_around(along, along.value(orbit.rotor), interval)
    start = pack(Start(orbit.nodes, orbit.durations))
    return _follow(_Family(orbit.rotor, along, orbit.word, limits), start, present, steps)


def switched(kind: str, orbit: Orbit, parameter: str, interval: Ends | None = None) -> WordBranch:
    """Branch of orbits of twice the period that is born in a period doubling.

    Parameters
    ----------
    kind : str
        Kind of the special point.
    orbit : Orbit
        The orbit there.
    parameter : str
    interval : tuple of float or str, optional
        Range of the parameter; by default a fifth of it to either side.

    Raises
    ------
    InputError
        The special point is no period doubling.
    CaromError
        No orbit of twice the period is found next to it.
    """
    if kind != "period-doubling":
        raise InputError("special point", kind, "a period doubling: only there orbits of twice the period are born")
    along = axis(orbit.rotor, parameter)
    value = along.value(orbit.rotor)
    ends = (value - BEYOND * abs(value), value + BEYOND * abs(value)) if interval is None else interval
    present, limits = interval_around(along, value, ends)
    family = _Family(orbit.rotor, along, orbit.word.repeated(2), limits)
    tangent = _alternating(orbit.links)
    unknowns, parameter_there = family.beside(np.tile(pack(orbit.links.start), 2), present, tangent)
    return _follow(family, unknowns, parameter_there, None)


def _alternating(links: Links) -> np.ndarray:
    """Change of all unknowns of twice the period that turns into its opposite after one period, of norm one."""
    values, vectors = np.linalg.eig(links.monodromy)
    change = vectors[:, np.argmin(np.abs(values + 1.0))].real
    rows = []
    for passage, slope in zip(links.passages, links.slopes, strict=True):
        delay = -(slope[-1, :-1] @ change) / slope[-1, -1]
        rows.append([*change, delay])
        change = passage @ change
    once = np.ravel(rows)
    both = np.concatenate([once, -once])
    whole: np.ndarray = both / np.linalg.norm(both)
    return whole


@dataclass(frozen=True)
class _Point:
    """The segments of an orbit at a value of the parameter, and what is watched there."""

    rotor: Model
    word: Word
    links: Links

    @cached_property
    def margins(self) -> Margins:
        return margins_of(self.links, self.rotor, self.word)

    @cached_property
    def multipliers(self) -> np.ndarray:
        section = on_section(self.links)
        if not np.isfinite(section).all():
            return np.full(len(section), np.nan + 0j)
        return np.linalg.eigvals(section).astype(complex)

    @property
    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Products and sums of the multipliers, two at a time."""
        first, second = np.triu_indices(len(self.multipliers), 1)
        return self.multipliers[first] * self.multipliers[second], self.multipliers[first] + self.multipliers[second]


class _Family:
    """The equations of orbits of a word along a parameter."""

    def __init__(self, rotor: Model, along: Axis, word: Word, limits: tuple[float, float]) -> None:
        self.rotor, self.along, self.word, self.limits = rotor, along, word, limits
        self.size = max(abs(along.value(rotor)), 0.1 * (limits[1] - limits[0]))
        self.points: OrderedDict[bytes, _Point | None] = OrderedDict()
        self.rotors: OrderedDict[float, Model | None] = OrderedDict()

    def rotor_at(self, p: float) -> Model | None:
        """The rotor at a value of the parameter; ``None`` where it has none."""
        if p not in self.rotors:
            try:
                self.rotors[p] = self.along.move(self.rotor, p)
            except InputError:
                self.rotors[p] = None
            if len(self.rotors) > REMEMBERED:
                self.rotors.popitem(last=False)
        return self.rotors[p]

    def point(self, u: np.ndarray, p: float) -> _Point | None:
        """The segments at a point; ``None`` where they are not defined."""
        key = u.tobytes() + np.float64(p).tobytes()
        if key not in self.points:
            self.points[key] = self._evaluated(u, p)
            if len(self.points) > REMEMBERED:
                self.points.popitem(last=False)
        return self.points[key]

    def _evaluated(self, u: np.ndarray, p: float) -> _Point | None:
        start, rotor = unpack(u, len(self.word)), self.rotor_at(p)
        if rotor is None or (start.durations[self.word.kinds != Kind.LAND] < SHORTEST).any():
            return None
        links = links_of(rotor, self.word, start)
        return _Point(rotor, self.word, links) if np.isfinite(links.size) else None

    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        point = self.point(u, p)
        return np.full(len(u), np.nan) if point is None else point.links.residual

    def jacobian(self, u: np.ndarray, p: float) -> np.ndarray:
        point = self.point(u, p)
        if point is None:
            return np.full((len(u), len(u) + 1), np.nan)
        return np.column_stack([point.links.jacobian, self._by_parameter(point, p)])

    def _by_parameter(self, point: _Point, p: float) -> np.ndarray:
        """Derivative of the equations by the parameter, by a difference to a side where the rotor exists."""
        step = DIFFERENCE * self.size
        rotor = self.rotor_at(p + step)
        if rotor is None:
            step = -step
            rotor = self.rotor_at(p + step)
        if rotor is None:
            return np.full(len(point.links.residual), np.nan)
        slope: np.ndarray = (links_of(rotor, self.word, point.links.start).residual - point.links.residual) / step
        return slope

    def beside(self, doubled: np.ndarray, p: float, tangent: np.ndarray) -> tuple[np.ndarray, float]:
        """Point of the branch in the hyperplane at a distance along a direction from a point."""
        u = doubled + ASIDE * tangent
        for _ in range(CORRECTIONS):
            residual = self.residual(u, p)
            if not np.isfinite(residual).all():
                break
            rows = np.vstack([self.jacobian(u, p) * np.append(np.ones(len(u)), self.size), np.append(tangent, 0.0)])
            change = np.linalg.solve(rows, np.append(-residual, ASIDE - tangent @ (u - doubled)))
            u, p = u + change[:-1], p + self.size * float(change[-1])
            if np.abs(change).max() < 1e-12:
                return u, min(max(p, self.limits[0]), self.limits[1])
        raise CaromError("no orbit of twice the period was found beside the period doubling")

    def watches(self, start: np.ndarray) -> list[Watch]:
        """Functions that vanish at the special points."""
        kinds: dict[str, Callable[[_Point], float]] = {
            "period-doubling": lambda point: float(np.prod(1.0 + point.multipliers).real),
            "neimark-sacker": lambda point: float(np.prod(point.pairs[0] - 1.0).real),
            # Without maxima the margin is that of a flight through the centre: their birth is not an event.
            "grazing": lambda point: min(point.margins.radius, 1.0),
            "vanishing-impact": lambda point: point.margins.approach,
            "slip-stop": lambda point: point.margins.slip,
            "contact-onset": lambda point: point.margins.normal_force,
            "cone-limit": lambda point: point.margins.cone,
        }

        def watch(kind: str) -> Watch:
            def value(u: np.ndarray, p: float) -> float:
                point = self.point(u, p)
                found = np.nan if point is None else kinds[kind](point)
                return found if np.isfinite(found) else np.nan

            return Watch(kind, value)

        watched = [watch(kind) for kind in kinds]
        m = len(self.word)
        if m % 2 == 0 and (m // 2) % self.word.least == 0:
            first = np.subtract(*np.split(start, 2))

            def halves(u: np.ndarray, _: float) -> float:
                apart = np.subtract(*np.split(u, 2))
                return float(np.copysign(np.linalg.norm(apart), apart @ first))

            watched.append(Watch("period-halving", halves, ends_branch=True))
        return watched


def _follow(family: _Family, start: np.ndarray, present: float, steps: Steps | None) -> WordBranch:
    """Follow a branch through a point, in both directions."""
    branch = continue_branch(
        family.residual,
        start,
        present,
        family.limits,
        jacobian=family.jacobian,
        watches=family.watches(start),
        steps=steps or STEPS,
        scales=np.append(np.ones(len(start)), family.size),
    )
    halvings = branch.of_kind("period-halving")
    special = tuple(
        SpecialOrbit(
            point.kind,
            family.along,
            point.parameter,
            _orbit_at(family.along.move(family.rotor, point.parameter), family.word, point.unknowns),
            point.place,
        )
        for point in branch.special
        if _is_special(family, point, halvings)
    )
    return WordBranch(
        family.along, family.word, family.rotor, branch.parameters, branch.unknowns, special, branch.stops
    )


def _is_special(family: _Family, point: SpecialPoint, halvings: tuple[SpecialPoint, ...]) -> bool:
    """Whether a special point of the continuation is one of orbits.

    Where a period is halved, the branch turns and two multipliers pass through one: nothing of its own.  Two real multipliers with
    the product one are no Neimark–Sacker bifurcation.
    """
    if point.kind == "period-halving":
        return True
    if point.kind == "branch point" or any(abs(point.place - halving.place) < 1e-3 for halving in halvings):
        return False
    if point.kind == "neimark-sacker":
        there = family.point(point.unknowns, point.parameter)
        if there is None:
            return False
        products, sums = there.pairs
        return abs(float(sums[np.argmin(np.abs(products - 1.0))].real)) < 2.0
    return True


def _orbit_at(rotor: Model, word: Word, unknowns: np.ndarray) -> Orbit:
    """Orbit at a point of a branch, without its name among others."""
    links = links_of(model_of(rotor), word, unpack(unknowns, len(word)))
    return Orbit.from_links(rotor, word, links, CountedName(word.impacts, 1))
