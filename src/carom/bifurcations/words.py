"""Branches of orbits of any word along a parameter, with their special points, and switching at period doublings.

Of orbits with one impact the special points are those of the closed form.  The equations are those of multiple shooting (:mod:`carom.orbits.shooting`).  Durations are among the unknowns, so a branch
passes through grazing and goes on with orbits that are not motions of the machine.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar, overload

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.roots import bracketed_root, sign_change
from carom.bifurcations.branches import OrbitBranch, orbit_at, speeds_at
from carom.bifurcations.conditions import (
    BOUNDLESS,
    conditions_at,
    corrected,
    is_admissible,
    margins_of,
    name_of,
    orbits_joined_at,
    profile_at,
    with_slip,
)
from carom.bifurcations.points import EXTREMUM, HALVING, HOPF, ONSET, VANISHING, Bifurcation
from carom.bifurcations.simulated import SimulatedBranch, continue_simulated, switch_simulated
from carom.bifurcations.word_equations import BORDERS, FAR_FROM_MOTION, WordFamily
from carom.closed_forms.thresholds import wall_condition
from carom.continuation import Branch, Equations, SpecialPoint, Steps, continue_branch
from carom.models.axes import Ends, axis, interval_around
from carom.orbits.maps import multipliers_of
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.orbit import Orbit
from carom.orbits.shooting import Links, converged, pack, unpack
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.word import Word
from carom.parameters import Numbers

EMERGING = 1e-4
"""Time of a maximum, in periods, below which its height is only rounding: the height grows with the cube of the time."""
SMALL = 1e-4
"""Radial speed of the orbit that represents those shrinking to a point."""


def special_orbit(
    kind: str, numbers: Numbers, pair: int, period: float, speed: float, parameter: str, place: float
) -> Bifurcation | None:
    """Special point from the parameters, the pair, the period and the radial speed of its orbit; ``None`` if it is none.

    Of the folds, those of two radial speeds of one period are distinguished from those of two periods.  Without rebound a maximum of the
    radius emerges from the impact, with its height zero, as lasting contact begins: no grazing.
    """
    at = numbers, period, speed
    if kind == "grazing" and not profile_at(*at).top > EMERGING * period:
        return None
    if kind == "fold":
        conditions = conditions_at(*at)
        kind = "speed-fold" if abs(conditions.speed_fold) < abs(conditions.period_fold) else kind
    name = orbits_joined_at(kind, name_of(numbers, pair, period, speed))[-1]
    value, admissible = numbers.value(parameter), _bounds_admissible(kind, *at)
    return Bifurcation(kind, *at, name, parameter, value, admissible, place=place)


def _bounds_admissible(kind: str, numbers: Numbers, period: float, speed: float) -> bool:
    """Whether the orbits on at least one side of a special point are motions of the machine."""
    if kind == "non-smooth-hopf":
        speed = SMALL
    slips = kind == "slip-stop" or margins_of(numbers, period, speed)["slip-stop"] > 0.0
    # At the onset of lasting contact the radius may have a maximum of zero height next to the impact.
    slack = 1e-9 if kind == "contact-onset" else 0.0
    inside = kind == "grazing" or not profile_at(numbers, period, speed).height >= slack
    return speed > 0.0 and slips and inside


STEPS = Steps(first=0.02, largest=0.15, sharpest_turn=0.25, most_points=600, tolerance=1e-11)
CLOSE_STEPS = replace(STEPS, largest=0.1)
"""For orbits with one impact, of which figures and documents show every orbit of a branch."""
ON_BORDER = 1e-8
"""Margin that counts as zero at a border."""
HIDING = dict.fromkeys(("grazing", ONSET, EXTREMUM), (VANISHING, HOPF))
"""Special points at which others, of these kinds, mean nothing of their own."""
OFF_WALL = 1e-6
"""Distance of levitation from the wall beyond which an orbit does not shrink to it, in the square of its radius."""
NEAR_HALVING = 1e-5
"""Half of the range in which the period doubling is located at which a branch ends, in sizes of the parameter."""
BEYOND = 0.2
"""Half of the range, relative to the parameter, in which a branch is followed that is switched to without a range."""


MOST_UNKNOWNS = 1500
"""Most unknowns of an orbit that is followed: inverting their matrix takes a third of a second, a hundred times a branch."""


Followed = TypeVar("Followed", OrbitBranch, SimulatedBranch)


def renamed(branch: Followed, name: CountedName) -> Followed:
    """A branch with another name, which its orbits and special points have too."""
    shots = [replace(point.shot, name=name) if point.shot else None for point in branch.special]
    special = tuple(replace(point, name=name, shot=shot) for point, shot in zip(branch.special, shots, strict=True))
    if isinstance(branch, SimulatedBranch):
        branch = replace(branch, orbits=tuple(replace(orbit, name=name) for orbit in branch.orbits))
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
    start = pack(orbit.start)
    if len(start) > MOST_UNKNOWNS:
        each = f"{len(orbit.word)} segments with {len(start) // len(orbit.word)} unknowns each"
        allowed = f"at most {MOST_UNKNOWNS} unknowns: each step of a branch solves for all of them; follow a shorter orbit, or a rotor of fewer states"
        raise InputError("orbit", each, allowed)
    family = WordFamily(orbit.rotor, along, orbit.word, limits)
    return _follow(family, start, present, steps, orbit.name, virtual=virtual)


@checked
def switch(point: Bifurcation, interval: Ends | None = None, *, virtual: bool = True) -> OrbitBranch | SimulatedBranch:
    """Branch that crosses or continues another at a special point.

    At a period doubling it is that of orbits of twice the period.  Where a maximum of the radius or an impact grazes, and
    where friction begins or ceases to stop the slip, it is that of the neighbouring word: one impact more, one less, or the
    other slip.  ``admissible`` of the branch says which of its orbits are motions, and so on which side.  A branch of orbits that were
    closed on the flow of the simulator goes on through such points by itself, and begins another one at a period doubling alone.

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
    simulated = isinstance(orbit, SimulatedOrbit)
    if kind != "period-doubling" and (simulated or kind not in BORDERS):
        others = "" if simulated else f", or one of: {', '.join(BORDERS)}"
        raise InputError("special point", kind, f"a period doubling{others}")
    along = axis(orbit.rotor, point.parameter)
    value = along.value(orbit.rotor)
    ends = (value - BEYOND * abs(value), value + BEYOND * abs(value)) if interval is None else interval
    if simulated:
        return switch_simulated(point, ends)
    present, limits = interval_around(along, value, ends)
    if kind == "period-doubling":
        family = WordFamily(orbit.rotor, along, orbit.word.repeated(2), limits)
        doubled = np.tile(pack(orbit.start), 2)
        unknowns, present = family.beside(doubled, present, _alternating(orbit.word, orbit.links))
    else:
        word, start = BORDERS[kind](orbit)
        family, unknowns = WordFamily(orbit.rotor, along, word, limits), pack(start)
    return _follow(family, unknowns, present, None, CountedName(len(family.word), 1), virtual=virtual)


def _alternating(word: Word, links: Links) -> np.ndarray:
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
    return both / np.linalg.norm(both)


def _follow(
    family: WordFamily,
    start: np.ndarray,
    present: float,
    steps: Steps | None,
    name: OrbitName | CountedName,
    *,
    virtual: bool,
) -> OrbitBranch:
    """Follow a branch through a point, in both directions."""
    steps, sizes = steps or (CLOSE_STEPS if isinstance(name, OrbitName) else STEPS), np.ones(len(start))
    equations = Equations(family.residual, family.jacobian, np.append(sizes, family.size), steps, family.solved)
    watches = family.watches(start, virtual=virtual)
    branch = continue_branch(equations, start, present, family.limits, watches=watches, reach=family.reach)
    wanted = [point for point in branch.special if _is_special(family, branch, point)]
    special = [found for point in wanted if (found := _special_point(family, branch, point, name)) is not None]
    return OrbitBranch(
        axis=family.along,
        name=name,
        word=family.word,
        rotor=family.rotor,
        values=branch.parameters,
        unknowns=branch.unknowns,
        special=tuple(sorted(special, key=lambda point: point.place)),
        stops=branch.stops,
    )


def _special_point(
    family: WordFamily, branch: Branch, point: SpecialPoint, name: OrbitName | CountedName
) -> Bifurcation | None:
    """Special point of orbits of a name, those of the closed form without certified orbit; ``None`` if it is none."""
    parameter, value, unknowns = family.along.name, point.parameter, point.unknowns
    if isinstance(name, OrbitName):
        numbers, period, speed = _closed(family, unknowns, value, name)
        if point.kind == HOPF and abs(wall_condition(numbers)) > OFF_WALL:
            return _without_damping(family, branch, point, name)
        if point.kind == HOPF:
            # Any period solves the equations there: it is the limit of those on both sides.
            period = float(np.interp(point.place, np.arange(len(branch)), branch.unknowns[:, -1]))
            period, speed = corrected(numbers, period, speed) or (period, speed)
        return special_orbit(point.kind, numbers, name.pair, period, speed, parameter, point.place)
    if point.kind == HALVING:
        value, unknowns = _halved(family, unknowns, value)
    orbit = orbit_at(family.along.move(family.rotor, value), family.word, unknowns, name)
    on_border = point.kind in (*BORDERS, HOPF) and min(orbit.margins.least, orbit.durations.min()) > -ON_BORDER
    return Bifurcation.of(point.kind, orbit, parameter, value, point.place, real=orbit.admissible or on_border)


def _closed(family: WordFamily, unknowns: np.ndarray, value: float, name: OrbitName) -> tuple[Numbers, float, float]:
    """Numbers, period and radial speed of an orbit with one impact."""
    numbers = with_slip(Numbers.of(family.along.move(family.rotor, value).parameters), name.slip)
    return numbers, float(unknowns[-1]), float(speeds_at(unpack(unknowns, 1).nodes)[0].real)


def _without_damping(family: WordFamily, branch: Branch, point: SpecialPoint, name: OrbitName) -> Bifurcation | None:
    """Where an orbit loses its only impact while levitation is not on the wall: there is no damping.

    What is left of the orbit is a free vibration that just touches the wall; ``None`` if it does so from outside.
    """
    for i in (int(point.place), int(point.place) + 1):
        numbers, period, speed = _closed(family, branch.unknowns[i], float(branch.parameters[i]), name)
        if is_admissible(numbers, period, speed):
            named = name_of(numbers, name.pair, period, speed)
            at, parameter = numbers._replace(gamma=0.0), family.along.name
            ends = float(point.unknowns[-1]), 0.0
            return Bifurcation(VANISHING, at, *ends, named, parameter, at.value(parameter), place=point.place)
    return None


def _halved(family: WordFamily, unknowns: np.ndarray, value: float) -> tuple[float, np.ndarray]:
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


def _is_special(family: WordFamily, branch: Branch, point: SpecialPoint) -> bool:
    """Whether a special point of the continuation is one of orbits.

    Where a period is halved, the branch turns and two multipliers pass through one: nothing of its own.  Where an
    impact vanishes, a maximum of the radius is at the wall: that impact; without rebound the force after it vanishes
    too, and extrema of the radius are only rounding.  Two real multipliers with the product one are no Neimark–Sacker
    bifurcation.
    """
    if point.kind == HALVING:
        return True
    if point.kind in (FAR_FROM_MOTION, BOUNDLESS):
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
