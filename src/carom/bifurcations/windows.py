"""Windows of a parameter in which single-impact orbits are motions of the machine, and what ends each window.

At given values of the parameter all orbits are known.  Where none of the branches followed so far holds one that is admissible, every
orbit that is, or is not far from it, is continued over all values; the same for stable ones.  The special points on the way show where
an orbit appears, vanishes, becomes virtual or changes its stability, even if it does so only between the values.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from carom.arguments import checked
from carom.bifurcations.branches import OrbitBranch, passing
from carom.bifurcations.conditions import (
    Solution,
    conditions_at,
    corrected,
    grazing_equations,
    is_admissible,
    margins_of,
    orbit_of,
    orbit_solutions,
    spectral_radii,
)
from carom.bifurcations.words import STEPS, continue_orbit
from carom.continuation.roots import bracketed_root, sign_change
from carom.models import Edge, Rotor, Span, Subject, axis, exact_rotor_of
from carom.orbits.admissibility import slip_stays_forward
from carom.orbits.single_impact import longest_within_reach, radial_speeds
from carom.outcome import CaromError
from carom.parameters import Numbers
from carom.progress import Reporter, ShowProgress

SAME = 1e-6
"""Relative difference of period and radial speed below which two solutions are the same."""
MERGED = 1e-9
"""Relative width of a gap below which two windows are merged."""
SHORT, VANISHED = 3e-3, 1e-4
"""Period, in ``1/Ω``, below which the end of a branch is attributed to a vanishing period, and the period that counts as vanished."""
FAR = -1.0
"""Margin of an orbit that is surely virtual, whose other margins are not computed."""
NEARLY = -0.2
"""Margin from which an orbit is followed: with less it is taken to stay virtual, or unstable, up to the next value."""

MOST_FOLLOWED = 100
"""Orbits, mostly unstable ones, that are followed: each takes some hundredths of a second."""

Level = Literal["possible", "stable"]


@dataclass(frozen=True)
class OrbitWindows:
    """Windows of single-impact orbits along one parameter, in ascending order.

    Attributes
    ----------
    parameter : str
    values : tuple of float
        Values at which all orbits were searched.
    possible : tuple of Span
        Windows where some orbit is admissible, stable or not.
    stable : tuple of Span or None
        Windows where some admissible orbit is stable; ``None`` where that was not searched, as more than :data:`MOST_FOLLOWED`
        orbits would have to be followed.
    """

    parameter: str
    values: tuple[float, ...]
    possible: tuple[Span, ...]
    stable: tuple[Span, ...] | None


class _Member(NamedTuple):
    """A solution at one value, with its margins of admissibility and of stability."""

    solution: Solution
    possible: float
    stable: float


class _Arc(NamedTuple):
    """A part of a branch between two special points."""

    low: Edge
    high: Edge
    possible: bool
    stable: bool


@checked
def orbit_windows(
    machine: Subject, parameter: str, values: Sequence[float], progress: ShowProgress = None
) -> OrbitWindows:
    """Find where along a parameter single-impact orbits are motions of the machine.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        The planar rotor, with positive damping at all values.
    parameter : str
        Dimensionless, or physical (in SI units; needs scales).
    values : sequence of float
        Values, in ascending order, at which all orbits are searched
        (:func:`~carom.orbits.single_impact.orbits_within_reach`).  A window between two of them is found if its orbit
        is admissible, or nearly so, at one of them.

    Raises
    ------
    CaromError
        More than :data:`MOST_FOLLOWED` orbits would have to be followed.
    """
    rotor, tell = exact_rotor_of(machine), Reporter.of(progress, "following orbits")
    along, interval = axis(rotor, parameter), (values[0], values[-1])
    branches: list[OrbitBranch] = []
    pieces: dict[Level, list[Span]] = {"possible": [], "stable": []}
    tried = dict.fromkeys(pieces, 0)
    for k, value in enumerate(values):
        reach = values[max(k - 1, 0)], values[min(k + 1, len(values) - 1)]
        levels = _open(pieces, *reach)
        members = _members(along.move(rotor, value)) if levels else []
        for member in sorted(members, key=lambda member: -member.possible):
            solution, wanted = member.solution, [level for level in levels if getattr(member, level) > NEARLY]
            if not wanted or any(_lies_on(solution, value, branch) for branch in branches):
                continue
            for level in wanted:
                tried[level] += 1
            if tried["possible"] > MOST_FOLLOWED:
                raise CaromError(
                    "the orbits that change between these values are too many to follow; choose a shorter range"
                )
            if tried["stable"] > MOST_FOLLOWED:
                pieces.pop("stable", None)
            orbit = orbit_of(solution.numbers, solution.name.pair, *solution[2:])
            try:
                branches.append(continue_orbit(orbit, parameter, interval, STEPS, virtual=False))
            except CaromError:
                continue
            arcs = _arcs(branches[-1], interval)
            for level, known in pieces.items():
                known += [Span(arc.low, arc.high) for arc in arcs if getattr(arc, level)]
            levels = _open(pieces, *reach)
        tell((k + 1) / len(values))
    stable = _joined(pieces["stable"]) if "stable" in pieces else None
    return OrbitWindows(parameter, tuple(values), _joined(pieces["possible"]), stable)


def _open(pieces: dict[Level, list[Span]], low: float, high: float) -> list[Level]:
    """Levels at which the windows known do not hold all of an interval."""
    return [
        level
        for level, known in pieces.items()
        if not any(window.low.value <= low and high <= window.high.value for window in _joined(known))
    ]


def _lies_on(solution: Solution, value: float, branch: OrbitBranch) -> bool:
    """Whether a branch passes through a solution; where it passes, its orbits have the letter of the solution's name."""
    numbers = branch.numbers_at(value)
    if (numbers.mu < 0.0) != (solution.numbers.mu < 0.0):
        return False
    for i, share in passing(branch.values, value):
        if solution.name.letter in (branch.closed[i].name.letter, branch.closed[i + 1].name.letter):
            guess = (1.0 - share) * np.array(branch.closed[i][2:]) + share * np.array(branch.closed[i + 1][2:])
            found = corrected(numbers, *guess.tolist())
            if found is not None and _same(*found, *solution[2:]):
                return True
    return False


def _members(rotor: Rotor) -> list[_Member]:
    longest = longest_within_reach(rotor)
    solutions = orbit_solutions(rotor, longest)
    if not slip_stays_forward(rotor):
        solutions += orbit_solutions(rotor, longest, backward=True)
    return [_member(solution) for solution in solutions]


def _member(solution: Solution) -> _Member:
    at = solution.numbers, solution.period, solution.radial_speed
    if _is_far_outside(*at):
        return _Member(solution, FAR, FAR)
    possible = min(margins_of(*at).values())
    if possible <= NEARLY:
        return _Member(solution, possible, possible)
    if solution.name.letter in "bc":  # a multiplier is above 1 (carom.proofs.block_orbits)
        return _Member(solution, possible, FAR)
    return _Member(solution, possible, min(possible, 1.0 - spectral_radii([at])[0]))


def _is_far_outside(numbers: Numbers, period: float, speed: float) -> bool:
    """Whether some samples of the radius lie far beyond the wall.

    This is so for most orbits of long period, soon after the impact.  To find all extrema of their radius would take
    long.
    """
    step = 0.5 / (1.0 + numbers.omega + numbers.gamma)
    return any(
        grazing_equations(numbers, period, speed, time)[1] > -FAR
        for time in np.arange(step, min(period, 60.0 * step), step)
    )


def _same(period: float, speed: float, other_period: float, other_speed: float) -> bool:
    return max(abs(period - other_period), abs(speed - other_speed)) < SAME * (1.0 + period)


def _arcs(branch: OrbitBranch, interval: tuple[float, float]) -> list[_Arc]:
    """Parts of a branch in an interval between its special points; along each the parameter is monotone."""
    special, inner = branch.special, len(branch) - 2
    course = np.column_stack([branch.values, branch.period, branch.radial_speed])
    ends = [
        _end_at(branch, interval, point.value, point.kind, point.name, point.period, point.radial_speed)
        for point in special
    ]
    marks = [_branch_end(branch, 0, interval), *ends, *([None] * inner), _branch_end(branch, -1, interval)]
    rows = [course[0], *([point.value, point.period, point.radial_speed] for point in special), *course[1:]]
    # A special point at the end of the branch comes before that end.
    order = np.argsort([0.0, *(point.place for point in special), *range(1, len(branch))], kind="stable").tolist()
    course, at = np.array([rows[k] for k in order]), [(i, marks[k]) for i, k in enumerate(order)]
    arcs = []
    for (start, one), (end, other) in pairwise((i, mark) for i, mark in at if mark is not None):
        low, high = sorted((one, other), key=lambda mark: mark.value)
        if high.value - low.value <= 1e-14 * abs(high.value):
            continue
        halfway = _halfway(branch, course[start : end + 1])
        if halfway is not None:
            possible = is_admissible(*halfway)
            stable = possible and spectral_radii([halfway])[0] < 1.0
            arcs.append(_Arc(low, high, possible, stable))
    return arcs


def _branch_end(branch: OrbitBranch, end: Literal[0, -1], interval: tuple[float, float]) -> Edge:
    value, period, speed = (float(each[end]) for each in (branch.values, branch.period, branch.radial_speed))
    stop = branch.stops[end]
    if stop in ("parameter limit", "closed loop"):
        return Edge(value)
    return _end_at(branch, interval, value, stop, branch.names[end], period, speed)


def _end_at(
    branch: OrbitBranch, interval: tuple[float, float], value: float, kind: str, name: str, period: float, speed: float
) -> Edge:
    """End of a window; where the period is too short for shooting, which loses digits there, by the closed form.

    That is where the period vanishes, or the end of the interval to which it is short.
    """
    if not period < SHORT:
        return Edge(value, kind, period, speed, name)

    def closing(there: float) -> float:
        return conditions_at(branch.numbers_at(there), VANISHED, speed).closing

    brackets = (sign_change(closing, value, limit) for limit in interval)
    places = [bracketed_root(closing, *bracket) for bracket in brackets if bracket is not None]
    if places:
        value = min(places, key=lambda place: abs(place - value))
        at = conditions_at(branch.numbers_at(value), VANISHED, speed)
        speeds = radial_speeds(math.sqrt(1.0 + at.boundary), at.lever)
        speed = min(speeds, key=lambda each: abs(each - speed), default=speed)
        return Edge(value, "vanishing-period", VANISHED, speed, name)
    for limit in interval:
        found = corrected(branch.numbers_at(limit), period, speed)
        if found is not None and found[0] < SHORT:
            return Edge(limit)
    return Edge(value, kind, period, speed, name)


def _halfway(branch: OrbitBranch, course: np.ndarray) -> tuple[Numbers, float, float] | None:
    """Orbit in the middle of an arc; ``None`` if Newton's method does not converge to one.

    ``course`` holds the parameter, period and radial speed along the arc, shape (m, 3).
    """
    middle = 0.5 * float(course[0, 0] + course[-1, 0])
    values, *others = course[np.argsort(course[:, 0])].T
    numbers = branch.numbers_at(middle)
    found = corrected(numbers, *(float(np.interp(middle, values, other)) for other in others))
    return None if found is None else (numbers, *found)


def _joined(pieces: Iterable[Span]) -> tuple[Span, ...]:
    """Merge windows that touch or overlap."""
    joined: list[Span] = []
    for piece in sorted(pieces, key=lambda window: window.low.value):
        if joined and piece.low.value <= joined[-1].high.value + MERGED * abs(piece.low.value):
            last = joined.pop()
            piece = Span(last.low, max(last.high, piece.high, key=lambda end: end.value))
        joined.append(piece)
    return tuple(joined)
