"""Branches of orbits of any word along a parameter, with their special points, and switching at period doublings.

The equations are those of multiple shooting (:mod:`carom.orbits.shooting`).  Durations are among the unknowns, so a branch
passes through grazing and goes on with orbits that are not motions of the machine.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from carom.bifurcations.branches import OrbitBranch, continue_single_impact, passing
from carom.bifurcations.neighbours import CONTACT_CHANGES, NEIGHBOURS, is_other, neighbour, read_beside
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.word_equations import BRIEF, FAR, GONE, LYING, Family
from carom.continuation import SpecialPoint, Steps, continue_branch
from carom.models import Jeffcott, Model
from carom.models.axes import Axis, Ends, axis, interval_around
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.shooting import Links, Start, converged, links_of, pack_free, unpack
from carom.orbits.word import Kind, Word
from carom.outcome import CaromError, InputError
from carom.parameters import Numbers

STEPS = Steps(first=0.02, largest=0.15, sharpest_turn=0.25, most_points=600, tolerance=1e-11)
BORDERS = ("grazing", "vanishing-impact", "slip-stop", "contact-onset", "permanent-contact", *CONTACT_CHANGES)
"""Special points at which the word of a motion changes."""
ON_BORDER = 1e-8
"""Margin that counts as zero at a border."""
ONSET, PERMANENT = "contact-onset", "permanent-contact"
LEAVES = (PERMANENT, "lift-off")
"""Where contact that never leaves the wall begins to."""
BESIDE = 1e-5
"""Distance from a border, relative to the parameter, at which the word beyond it is read from a simulated period."""
NEARBY = 0.02
"""Range in which permanent contact is searched beyond the last orbit whose flight is followed, in sizes of the parameter."""
BEYOND = 0.2
"""Half of the range, relative to the parameter, in which a branch is followed that is switched to without a range."""


@dataclass(frozen=True, eq=False)
class WordOrbits:
    """Orbits of a word along a parameter, by the unknowns of multiple shooting.

    Attributes
    ----------
    axis : Axis
    name : OrbitName or CountedName
        Name of all of them, on both sides of folds: that of the orbit from which they were followed.
    word : Word
    rotor : Model
        The rotor of that orbit.
    values : ndarray, shape (m,)
        The parameter.
    unknowns : ndarray, shape (m, k)
        Nodes and durations, in the order of :func:`carom.orbits.shooting.pack`.
    """

    axis: Axis
    name: OrbitName | CountedName
    word: Word
    rotor: Model
    values: np.ndarray
    unknowns: np.ndarray

    @property
    def names(self) -> tuple[OrbitName | CountedName, ...]:
        """Name of each orbit."""
        return (self.name,) * len(self.values)

    @cached_property
    def radial_speeds(self) -> np.ndarray:
        """``ṙ`` just before each impact in ``c_r Ω``, shape (m, n)."""
        return np.array([orbit.impact_speeds for orbit in self.orbits])

    @cached_property
    def angular_speed(self) -> np.ndarray:
        """``θ̇`` just before the first impact in ``Ω``, shape (m,)."""
        return np.array([orbit.angular_speed for orbit in self.orbits])

    def starts_at(self, value: float) -> list[Start]:
        """Nodes and durations of the orbits at a value of the parameter, one for each time the branch passes there."""
        found = []
        for i, share in passing(self.values, value):
            guess = (1.0 - share) * self.unknowns[i] + share * self.unknowns[i + 1]
            links = converged(self.axis.move(self.rotor, value), self.word, unpack(guess, len(self.word)))
            found.append(unpack(guess, len(self.word)) if links is None else links.start)
        return found

    @property
    def period(self) -> np.ndarray:
        """Periods in ``1/Ω``, shape (m,)."""
        total: np.ndarray = self.unknowns.reshape(len(self.values), len(self.word), -1)[:, :, -1].sum(axis=1)
        return total

    @cached_property
    def orbits(self) -> tuple[Orbit, ...]:
        """Every orbit, with its multipliers and its admissibility certified."""
        pairs = zip(self.values.tolist(), self.unknowns, strict=True)
        return tuple(_orbit_at(self.axis.move(self.rotor, p), self.word, u, self.name) for p, u in pairs)

    @cached_property
    def admissible(self) -> np.ndarray:
        """Which orbits are motions of the machine, bool, shape (m,)."""
        return np.array([orbit.admissible for orbit in self.orbits])

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Non-trivial Floquet multipliers, complex, shape (m, 2N − 1)."""
        return np.array([orbit.multipliers.values for orbit in self.orbits])


def renamed(branch: OrbitBranch, name: CountedName) -> OrbitBranch:
    """A branch followed by multiple shooting, with another name."""
    points: Any = branch.points
    special = tuple(
        replace(point, name=name, shot=replace(point.shot, name=name) if point.shot else None)
        for point in branch.special
    )
    return replace(branch, name=name, points=replace(points, name=name), special=special)


def continue_orbit(orbit: Orbit, parameter: str, interval: Ends, steps: Steps | None = None) -> OrbitBranch:
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
    OrbitBranch

    Raises
    ------
    InputError
        Unknown parameter, or an interval without the orbit.

    See Also
    --------
    carom.find_bifurcations : all branches on an interval
    carom.continue_curve : follow a special point in two parameters

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> branch = cm.continue_orbit(cm.find_orbits(machine)["B1,d"], "gamma", (0.05, 0.2))
    >>> [(point.kind, round(point.value, 6)) for point in branch.special]
    [('grazing', 0.063611), ('radius-extremum', 0.07852), ('period-doubling', 0.083381), ('fold', 0.178028)]
    """
    if isinstance(orbit.name, OrbitName):
        return continue_single_impact(orbit, parameter, interval, steps)
    return continue_word(orbit, parameter, interval, steps)


def continue_word(
    orbit: Orbit, parameter: str, interval: Ends, steps: Steps | None = None, *, virtual: bool = True
) -> OrbitBranch:
    """:func:`continue_orbit` by multiple shooting, for an orbit of any word; on request not far among virtual orbits."""
    along = axis(orbit.rotor, parameter)
    present, limits = interval_around(along, along.value(orbit.rotor), interval)
    start = pack_free(orbit.word, Start(orbit.nodes, orbit.durations))
    family = Family(orbit.rotor, along, orbit.word, limits)
    return _follow(family, start, present, steps, orbit.name, virtual=virtual)


def switched(
    kind: str, orbit: Orbit, parameter: str, interval: Ends | None = None, *, virtual: bool = True
) -> OrbitBranch:
    """Branch that crosses or continues another at a special point.

    At a period doubling it is that of orbits of twice the period.  Where a maximum of the radius or an impact grazes, and where friction
    begins or ceases to stop the slip, it is that of the neighbouring word: one impact more, one less, or the other slip.  Where contact becomes
    permanent, it is that of the sliding that never leaves the wall.  At the onset of lasting contact it is that of the many impacts which the
    interrupted chatter has at a small distance; the closer, the more they are.  Where lasting contact changes its kind it is that of the word which a
    simulated period has beside the border.  Which of
    its orbits are motions, and on which side, :func:`~carom.bifurcations.examine_border` tells.

    Parameters
    ----------
    kind : str
        Kind of the special point.
    orbit : Orbit
        The orbit there.
    parameter : str
    interval : tuple of float or str, optional
        Range of the parameter; by default a fifth of it to either side.
    virtual : bool
        Follow it to any distance from motions of the machine.

    Raises
    ------
    InputError
        No branch is known to begin at such a point.
    CaromError
        No orbit is found next to it.
    """
    known = (ONSET, PERMANENT, *CONTACT_CHANGES, *NEIGHBOURS)
    if kind not in ("period-doubling", *known):
        raise InputError("special point", kind, f"a period doubling, or one of: {', '.join(known)}")
    along = axis(orbit.rotor, parameter)
    value = along.value(orbit.rotor)
    ends = (value - BEYOND * abs(value), value + BEYOND * abs(value)) if interval is None else interval
    present, limits = interval_around(along, value, ends)
    if kind == "period-doubling":
        family = Family(orbit.rotor, along, orbit.word.repeated(2), limits)
        doubled = np.tile(pack_free(orbit.word, orbit.links.start), 2)
        unknowns, present = family.beside(doubled, present, _alternating(orbit.word, orbit.links))
    elif kind == ONSET or kind in CONTACT_CHANGES:
        word, start, present = _beyond(orbit, along, limits)
        family, unknowns = Family(orbit.rotor, along, word, limits), pack_free(word, start)
    else:
        alone = orbit.word, Start(orbit.nodes, orbit.durations)
        word, start = alone if kind == PERMANENT else neighbour(kind, orbit)
        family, unknowns = Family(orbit.rotor, along, word, limits), pack_free(word, start)
    return _follow(family, unknowns, present, None, CountedName(family.word.impacts, 1), virtual=virtual)


def _beyond(orbit: Orbit, along: Axis, limits: tuple[float, float]) -> tuple[Word, Start, float]:
    """Orbit of the word that a simulated period has beside a border, and the parameter there."""
    value = along.value(orbit.rotor)
    for side in (-1, 1):
        there = value + side * BESIDE * abs(value)
        if not limits[0] <= there <= limits[1]:
            continue
        rotor = along.move(orbit.rotor, there)
        read = read_beside(orbit, rotor)
        found = orbit_near(rotor, *read) if read is not None and is_other(read[0], orbit.word) else None
        if found is not None and found.admissible:
            return found.word, Start(found.nodes, found.durations), there
    raise CaromError("no orbit of another word was found beside the border")


def _alternating(word: Word, links: Links) -> np.ndarray:
    """Change of all unknowns of twice the period that turns into its opposite after one period, of norm one."""
    values, vectors = np.linalg.eig(links.monodromy)
    change = vectors[:, np.argmin(np.abs(values + 1.0))].real
    rows = []
    for passage, slope in zip(links.passages, links.slopes, strict=True):
        delay = -(slope[-1, :-1] @ change) / slope[-1, -1]
        rows.append([*change, delay])
        change = passage @ change
    once = pack_free(word, unpack(np.ravel(rows), len(word)))
    both = np.concatenate([once, -once])
    whole: np.ndarray = both / np.linalg.norm(both)
    return whole


def _follow(
    family: Family,
    start: np.ndarray,
    present: float,
    steps: Steps | None,
    name: OrbitName | CountedName,
    *,
    virtual: bool,
) -> OrbitBranch:
    """Follow a branch through a point, in both directions."""
    branch = continue_branch(
        family.residual,
        start,
        present,
        family.limits,
        jacobian=family.jacobian,
        watches=family.watches(start, virtual=virtual),
        solver=family.solved,
        steps=steps or STEPS,
        scales=np.append(np.ones(len(start)), family.size),
        crossings="",
    )
    passed = [branch.of_kind(kind) for kind in ("period-halving", "vanishing-impact", "cone-limit")]
    whole = [family.whole(u, p) for u, p in zip(branch.unknowns, branch.parameters.tolist(), strict=True)]
    special = tuple(
        _special_point(
            point.kind,
            family.along,
            point.parameter,
            _orbit_at(
                family.along.move(family.rotor, point.parameter),
                family.word,
                family.whole(point.unknowns, point.parameter),
                name,
            ),
            point.place,
        )
        for point in branch.special
        if _is_special(family, point, *passed)
    )
    stops = list(branch.stops)
    for end, place in ((0, 0.0), (-1, len(branch) - 1.0)):
        lies = stops[end] in (LYING, "step too small")
        point = _permanent_contact(family, whole[end], branch.parameters[end], place) if lies else None
        if point is not None:
            special, stops[end] = (*special, point), point.kind
    special = tuple(sorted(special, key=lambda point: point.place))
    at = family.along, name, family.word, family.rotor, branch.parameters
    return OrbitBranch(*at, WordOrbits(*at, np.array(whole)), special, (stops[0], stops[1]))


def _special_point(kind: str, along: Axis, value: float, orbit: Orbit, place: float) -> Bifurcation:
    """Special point at which multiple shooting has found the orbit."""
    return Bifurcation(
        kind,
        Numbers.of(orbit.rotor.parameters) if isinstance(orbit.rotor, Jeffcott) else None,
        orbit.period,
        orbit.radial_speed if orbit.word[0].kind.is_impact else math.nan,
        orbit.name,
        along.name,
        value,
        orbit.admissible or (kind in BORDERS and min(orbit.margins.least, orbit.durations.min()) > -ON_BORDER),
        place=place,
        shot=orbit,
    )


def _permanent_contact(family: Family, unknowns: np.ndarray, value: float, place: float) -> Bifurcation | None:
    """Where the only flight of a period vanishes: lasting contact that never leaves the wall, whose least normal force vanishes."""
    start = _without_flight(family.word, unpack(unknowns, len(family.word)))
    if start is None:
        return None
    alone = orbit_near(family.along.move(family.rotor, value), *start)
    if alone is None:
        return None
    reach = NEARBY * family.size
    limits = max(family.limits[0], value - reach), min(family.limits[1], value + reach)
    found = [point for point in continue_word(alone, family.along.name, limits).special if point.kind in LEAVES]
    nearest = min(found, key=lambda point: abs(point.value - value), default=None)
    return None if nearest is None else replace(nearest, place=place)


def _without_flight(word: Word, start: Start) -> tuple[Word, Start] | None:
    """The contact of a period without its only flight, if it is of one kind before and after this."""
    lifts = np.flatnonzero(word.kinds == Kind.LIFT)
    if len(lifts) != 1 or word.impacts or word.lands.sum() != 1 or start.durations[lifts[0]] > 1.01 * BRIEF:
        return None
    first = int(lifts[0])
    turned, nodes, durations = (
        word.turned(first),
        np.roll(start.nodes, -first, axis=0),
        np.roll(start.durations, -first),
    )
    if turned[1].kind is not Kind.LAND or turned[2] != turned[-1] or turned[2].kind is Kind.ROLL:
        return None
    if len(word) == 3:
        return Word(turned[2:]), Start(nodes[:1], durations.sum()[None])
    durations[-1] += durations[:3].sum()
    return Word(turned[3:]), Start(nodes[3:], durations[3:])


def _is_special(
    family: Family,
    point: SpecialPoint,
    halvings: tuple[SpecialPoint, ...],
    vanishing: tuple[SpecialPoint, ...],
    limits: tuple[SpecialPoint, ...],
) -> bool:
    """Whether a special point of the continuation is one of orbits.

    Where a period is halved, the branch turns and two multipliers pass through one: nothing of its own.  Where an impact vanishes, a
    maximum of the radius is at the wall: that impact.  Where rolling between slides of one direction shrinks to nothing, their slip touches zero
    and the branch turns.  Two real multipliers with
    the product one are no Neimark–Sacker bifurcation.
    """
    if point.kind == "period-halving":
        return True
    if point.kind in (FAR, LYING, GONE) or any(abs(point.place - halving.place) < 1e-3 for halving in halvings):
        return False
    if point.kind == "grazing" and any(_meet(point, other) for other in vanishing):
        return False
    if point.kind in ("fold", "slide-stop") and any(_meet(point, other) for other in limits):
        return False
    if point.kind == "neimark-sacker":
        there = family.point(point.unknowns, point.parameter)
        return there is not None and abs(there.pair_sum) < 2.0
    return True


def _meet(point: SpecialPoint, other: SpecialPoint) -> bool:
    """Whether two special points of a branch are one."""
    return abs(point.place - other.place) < 1e-2 or abs(point.parameter - other.parameter) < 1e-7 * abs(other.parameter)


def _orbit_at(rotor: Model, word: Word, unknowns: np.ndarray, name: OrbitName | CountedName) -> Orbit:
    """Orbit at a point of a branch."""
    return Orbit.from_links(rotor, word, links_of(rotor, word, unpack(unknowns, len(word))), name)
