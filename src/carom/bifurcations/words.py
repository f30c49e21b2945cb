"""Branches of orbits of any word along a parameter, with their special points, and switching at period doublings.

The equations are those of multiple shooting (:mod:`carom.orbits.shooting`).  Durations are among the unknowns, so a branch
passes through grazing and goes on with orbits that are not motions of the machine.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, overload

import numpy as np

from carom.arguments import checked
from carom.bifurcations.branches import OrbitBranch, orbit_at, speeds_at
from carom.bifurcations.conditions import BOUNDLESS, corrected, with_slip
from carom.bifurcations.neighbours import BORDERS, NEIGHBOURS, is_other, read_beside
from carom.bifurcations.points import CONTACT_CHANGES, EXTREMUM, HALVING, HOPF, ONSET, PERMANENT, Bifurcation
from carom.bifurcations.simulated import SimulatedBranch, continue_simulated
from carom.bifurcations.single_impact import special_orbit
from carom.bifurcations.word_equations import (
    CONTACT_VANISHES,
    FAR_FROM_MOTION,
    FLIGHTS_VANISH,
    SHORTEST_FLIGHT,
    Family,
)
from carom.continuation import Branch, SpecialPoint, Steps, continue_branch
from carom.continuation.roots import bracketed_root, sign_change
from carom.models.axes import Axis, Ends, axis, interval_around
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.shooting import Links, Start, converged, pack, pack_free, unpack
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.stability import multipliers_of
from carom.orbits.word import Kind, Word
from carom.outcome import CaromError, InputError
from carom.parameters import Numbers

STEPS = Steps(first=0.02, largest=0.15, sharpest_turn=0.25, most_points=600, tolerance=1e-11)
CLOSE_STEPS = replace(STEPS, largest=0.1)
"""For orbits with one impact, of which figures and documents show every orbit of a branch."""
ON_BORDER = 1e-8
"""Margin that counts as zero at a border."""
HIDING = {
    **dict.fromkeys(("grazing", ONSET, EXTREMUM), ("vanishing-impact", HOPF)),
    **dict.fromkeys(("fold", "slide-stop"), ("cone-limit",)),
}
"""Special points at which others, of these kinds, mean nothing of their own."""
LEAVES = (PERMANENT, "lift-off")
"""Where contact that never leaves the wall begins to."""
ONE_PLACE = 1e-8
"""Distance, in sizes of the parameter, within which two special points are one."""
BESIDE = 1e-5
"""Distance from a border, relative to the parameter, at which the word beyond it is read from a simulated period."""
NEARBY = 0.02
"""Range in which permanent contact is searched beyond the last orbit whose flight is followed, in sizes of the parameter."""
NEAR_HALVING = 1e-5
"""Half of the range in which the period doubling is located at which a branch ends, in sizes of the parameter."""
BEYOND = 0.2
"""Half of the range, relative to the parameter, in which a branch is followed that is switched to without a range."""


MOST_UNKNOWNS = 1500
"""Most unknowns of an orbit that is followed: inverting their matrix takes a third of a second, a hundred times a branch."""


def renamed(branch: OrbitBranch, name: CountedName) -> OrbitBranch:
    """A branch followed by multiple shooting, with another name."""
    special = tuple(
        replace(point, name=name, shot=replace(point.shot, name=name) if point.shot else None)
        for point in branch.special
    )
    return replace(branch, name=name, special=special)


@overload
def continue_orbit(
    orbit: Orbit, parameter: str, interval: Ends, steps: Steps | None = None, *, virtual: bool = True
) -> OrbitBranch: ...


@overload
def continue_orbit(
    orbit: SimulatedOrbit, parameter: str, interval: Ends, steps: Steps | None = None, *, virtual: bool = True
) -> SimulatedBranch: ...


@checked
def continue_orbit(
    orbit: Orbit | SimulatedOrbit, parameter: str, interval: Ends, steps: Steps | None = None, *, virtual: bool = True
) -> OrbitBranch | SimulatedBranch:
    """Continue an orbit along a parameter, through folds, grazing and stretches where it is virtual.

    The unknowns are the states at the beginning of its segments and their durations (multiple shooting); of an orbit that was closed on the
    flow of the simulator the state where its period begins, and it is a motion all along.

    Parameters
    ----------
    parameter : str
        A parameter of the rotor: for the planar one dimensionless (``"gamma"``) or physical (``"speed"``, SI units;
        needs scales).
    interval : tuple of float or str
        Range of the parameter; it must contain the orbit's own value.  ``("300 N s/m", "2000 N s/m")`` has units.
    virtual : bool
        Follow it to any distance from motions of the machine.

    Returns
    -------
    OrbitBranch or SimulatedBranch

    Raises
    ------
    InputError
        Unknown parameter, an interval without the orbit, or an orbit of very many unknowns.

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
    if isinstance(orbit, SimulatedOrbit):
        return continue_simulated(orbit, parameter, interval, steps)
    along = axis(orbit.rotor, parameter)
    present, limits = interval_around(along, along.value(orbit.rotor), interval)
    start = pack_free(orbit.word, orbit.start)
    if len(start) > MOST_UNKNOWNS:
        each = f"{len(orbit.word)} segments with {len(start) // len(orbit.word)} unknowns each"
        allowed = f"at most {MOST_UNKNOWNS} unknowns: each step of a branch solves for all of them; follow a shorter orbit, or a rotor of fewer states"
        raise InputError("orbit", each, allowed)
    family = Family(orbit.rotor, along, orbit.word, limits)
    return _follow(family, start, present, steps, orbit.name, virtual=virtual)


@checked
def switch(point: Bifurcation, interval: Ends | None = None, *, virtual: bool = True) -> OrbitBranch:
    """Branch that crosses or continues another at a special point.

    At a period doubling it is that of orbits of twice the period.  Where a maximum of the radius or an impact grazes, and
    where friction begins or ceases to stop the slip, it is that of the neighbouring word: one impact more, one less, or the
    other slip.  Where contact becomes permanent, it is that of the sliding that never leaves the wall.  At the onset of
    lasting contact it is that of the many impacts which the interrupted chatter has at a small distance; the closer, the
    more they are.  Where lasting contact changes its kind it is that of the word which a simulated period has beside the
    border.  ``admissible`` of the branch says which of its orbits are motions, and so on which side.

    Parameters
    ----------
    point : Bifurcation
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
    kind, orbit = point.kind, point.orbit
    if kind not in ("period-doubling", *BORDERS):
        raise InputError("special point", kind, f"a period doubling, or one of: {', '.join(BORDERS)}")
    along = axis(orbit.rotor, point.parameter)
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
        alone = orbit.word, orbit.start
        word, start = alone if kind == PERMANENT else NEIGHBOURS[kind](orbit)
        family, unknowns = Family(orbit.rotor, along, word, limits), pack_free(word, start)
    return _follow(family, unknowns, present, None, CountedName(family.word.impacts, 1), virtual=virtual)


def _beyond(orbit: Orbit, along: Axis, limits: tuple[float, float]) -> tuple[Word, Start, float]:
    """Orbit of the word that a simulated period has beside a border, and the parameter there."""
    value = along.value(orbit.rotor)
    places = [value + side * BESIDE * abs(value) for side in (-1, 1)]
    rotors = {there: along.move(orbit.rotor, there) for there in places if limits[0] <= there <= limits[1]}
    guesses: list[tuple[Word, Start]] = []
    for there, rotor in rotors.items():
        for word, start in read_beside(orbit, rotor):
            found = orbit_near(rotor, word, start) if is_other(word, orbit.word) else None
            if found is not None and found.admissible:
                return found.word, found.start, there
            if is_other(word, orbit.word):
                guesses.append((word, start) if found is None else (found.word, found.start))
    # Where both orbits end at the border, that of the other word is a motion where the simulated one is none of it.
    for there, rotor in rotors.items():
        for guess in guesses:
            found = orbit_near(rotor, *guess)
            if found is not None and found.admissible and len(found.word) == len(guess[0]):
                return found.word, found.start, there
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
        solver=family.solved if family.word.flies else None,
        steps=steps or (CLOSE_STEPS if isinstance(name, OrbitName) else STEPS),
        scales=np.append(np.ones(len(start)), family.size),
        reach=family.reach,
        crossings="",
    )
    whole = [family.whole(u, p) for u, p in zip(branch.unknowns, branch.parameters.tolist(), strict=True)]
    wanted = [point for point in branch.special if _is_special(family, branch, point)]
    special = [found for point in wanted if (found := _special_point(family, branch, point, name)) is not None]
    stops = list(branch.stops)
    for end, place in ((0, 0.0), (-1, len(branch) - 1.0)):
        lies = stops[end] in (FLIGHTS_VANISH, "step too small")
        point = _permanent_contact(family, whole[end], branch.parameters[end], place) if lies else None
        if point is not None:
            special.append(point)
            stops[end] = point.kind
    return OrbitBranch(
        axis=family.along,
        name=name,
        word=family.word,
        rotor=family.rotor,
        values=branch.parameters,
        unknowns=np.array(whole),
        special=tuple(sorted(special, key=lambda point: point.place)),
        stops=(stops[0], stops[1]),
    )


def _special_point(
    family: Family, branch: Branch, point: SpecialPoint, name: OrbitName | CountedName
) -> Bifurcation | None:
    """Special point of orbits of a name, those of the closed form without certified orbit; ``None`` if it is none."""
    parameter, value = family.along.name, point.parameter
    rotor: Any = family.along.move(family.rotor, value)
    unknowns = family.whole(point.unknowns, value)
    if isinstance(name, OrbitName):
        numbers, period = with_slip(Numbers.of(rotor.parameters), name.slip), float(unknowns[-1])
        speed = float(speeds_at(rotor, family.word.planes, unpack(unknowns, 1).nodes)[0].real)
        if point.kind == HOPF:
            # Any period solves the equations there: it is the limit of those on both sides.
            period = float(np.interp(point.place, np.arange(len(branch)), branch.unknowns[:, -1]))
            period, speed = corrected(numbers, period, speed) or (period, speed)
        return special_orbit(point.kind, numbers, name.pair, period, speed, parameter, point.place)
    if point.kind == HALVING:
        value, unknowns = _halved(family, unknowns, value)
        rotor = family.along.move(family.rotor, value)
    orbit = orbit_at(rotor, family.word, unknowns, name)
    return Bifurcation(
        point.kind,
        None,
        orbit.period,
        orbit.radial_speed if orbit.word.arrives[0] else math.nan,
        name,
        parameter,
        value,
        orbit.admissible
        or (point.kind in (*BORDERS, HOPF) and min(orbit.margins.least, orbit.durations.min()) > -ON_BORDER),
        place=point.place,
        shot=orbit,
    )


def _halved(family: Family, unknowns: np.ndarray, value: float) -> tuple[float, np.ndarray]:
    """Where both halves of a period are equal: the period doubling of the orbit of half the period, next to a point.

    Their difference vanishes like a root of the parameter, so that it tells the place to half of all digits only.
    """
    half = Word(family.word[: len(family.word) // 2])
    start = unpack(np.mean(np.split(unknowns, 2), axis=0), len(half))

    def alone(there: float) -> Links | None:
        # Not as an orbit, which may begin with another impact.
        return converged(family.along.move(family.rotor, there), half, start)

    def doubling(there: float) -> float:
        links = alone(there)
        return np.nan if links is None else float(np.prod(1.0 + multipliers_of(links).values).real)

    bracket = sign_change(doubling, value - NEAR_HALVING * family.size, value + NEAR_HALVING * family.size)
    exact = value if bracket is None else bracketed_root(doubling, *bracket)
    links = alone(exact)
    return (value, unknowns) if links is None else (exact, np.tile(pack(links.start), 2))


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
    found = [point for point in continue_orbit(alone, family.along.name, limits).special if point.kind in LEAVES]
    nearest = min((abs(point.value - value) for point in found), default=math.inf)
    near = [point for point in found if abs(point.value - value) <= nearest + ONE_PLACE * family.size]
    near.sort(key=lambda point: point.kind != PERMANENT)
    return replace(near[0], place=place) if near else None


def _without_flight(word: Word, start: Start) -> tuple[Word, Start] | None:
    """The contact of a period without its only flight, if it is of one kind before and after this."""
    lifts = np.flatnonzero(word.kinds == Kind.LIFT)
    if len(lifts) != 1 or word.impacts or word.lands.sum() != 1 or start.durations[lifts[0]] > 1.01 * SHORTEST_FLIGHT:
        return None
    first = int(lifts[0])
    turned, (nodes, durations) = word.turned(first), start.turned(first)
    if turned[1].kind is not Kind.LAND or turned[2] != turned[-1] or turned[2].kind is Kind.ROLL:
        return None
    if len(word) == 3:
        return Word(turned[2:]), Start(nodes[:1], durations.sum()[None])
    durations[-1] += durations[:3].sum()
    return Word(turned[3:]), Start(nodes[3:], durations[3:])


def _is_special(family: Family, branch: Branch, point: SpecialPoint) -> bool:
    """Whether a special point of the continuation is one of orbits.

    Where a period is halved, the branch turns and two multipliers pass through one: nothing of its own.  Where an
    impact vanishes, a maximum of the radius is at the wall: that impact; without rebound the force after it vanishes
    too, and extrema of the radius are only rounding.  Where rolling between slides of one direction shrinks to nothing,
    their slip touches zero and the branch turns.  Two real multipliers with the product one are no Neimark–Sacker
    bifurcation.
    """
    if point.kind == HALVING:
        return True
    if point.kind in (FAR_FROM_MOTION, FLIGHTS_VANISH, CONTACT_VANISHES, BOUNDLESS):
        return False
    if any(abs(point.place - other.place) < 1e-3 for other in branch.of_kind(HALVING)):
        return False
    if any(_meet(point, other) for kind in HIDING.get(point.kind, ()) for other in branch.of_kind(kind)):
        return False
    if point.kind == "neimark-sacker":
        there = family.point(point.unknowns, point.parameter)
        return there is not None and abs(there.pair_sum) < 2.0
    return True


def _meet(point: SpecialPoint, other: SpecialPoint) -> bool:
    """Whether two special points of a branch are one."""
    return abs(point.place - other.place) < 1e-2 or abs(point.parameter - other.parameter) < 1e-7 * abs(other.parameter)
