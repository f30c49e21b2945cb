"""Windows of a parameter in which single-impact orbits are motions of the machine, and what ends each window.

At given values of the parameter all orbits are known.  An orbit that is admissible at two neighbouring values, and not
close to becoming virtual, is taken to be admissible between them.  Every other orbit is continued from one value to the
other.  The special points on the way show where it appears, vanishes, becomes virtual or changes its stability, even if
it does so only between the values.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from carom.arguments import checked
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.conditions import (
    conditions_at,
    corrected,
    grazing_equations,
    is_admissible,
    margins_of,
    orbit_of,
    spectral_radii,
)
from carom.bifurcations.solutions import Solution, orbit_solutions
from carom.bifurcations.words import STEPS, continue_orbit
from carom.continuation.roots import bracketed_root, sign_change
from carom.models import Jeffcott, Subject, axis, jeffcott_of
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
"""Margin at which an orbit without a partner at the next value is not followed: it surely stays virtual."""

MOST_FOLLOWED = 100
"""Orbits, mostly unstable ones, that are followed from one value to the next: each takes some hundredths of a second."""

SUBSTEPS = (1, 8, 64)
"""Steps from one value to the next in which an orbit is moved there: those of long periods need many."""

Level = Literal["possible", "stable"]


@dataclass(frozen=True)
class WindowEnd:
    """One end of a window.

    Attributes
    ----------
    value : float
        Value of the parameter.
    kind : str
        Kind of the special point there (:class:`~carom.bifurcations.Bifurcation`), ``"vanishing-period"``, or empty at
        the end of the searched range.
    name : str
        Name of the orbit that appears, vanishes or changes there; empty at the end of the searched range.
    period, radial_speed : float or None
        Its period in ``1/Ω`` and radial speed in ``c_r Ω``.
    """

    value: float
    kind: str = ""
    name: str = ""
    period: float | None = None
    radial_speed: float | None = None


@dataclass(frozen=True)
class Window:
    """An interval of the parameter throughout which there is an orbit."""

    low: WindowEnd
    high: WindowEnd


@dataclass(frozen=True)
class OrbitWindows:
    """Windows of single-impact orbits along one parameter, in ascending order.

    Attributes
    ----------
    parameter : str
    values : tuple of float
        Values at which all orbits were searched.
    possible : tuple of Window
        Windows where some orbit is admissible, stable or not.
    stable : tuple of Window or None
        Windows where some admissible orbit is stable; ``None`` where that was not searched, as more than :data:`MOST_FOLLOWED`
        orbits would have to be followed.
    """

    parameter: str
    values: tuple[float, ...]
    possible: tuple[Window, ...]
    stable: tuple[Window, ...] | None


class _Member(NamedTuple):
    """A solution at one value, with its margins of admissibility and of stability."""

    solution: Solution
    possible: float
    stable: float


class _Arc(NamedTuple):
    """A part of a branch between two special points."""

    low: WindowEnd
    high: WindowEnd
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
    rotor, tell = jeffcott_of(machine), Reporter.of(progress, "following orbits")
    along = axis(rotor, parameter)
    columns: list[list[_Member]] = []
    for done, value in enumerate(values):
        columns.append(_members(along.move(rotor, value)))
        tell(0.7 * (done + 1) / len(values))
    cells = _cells(values, columns)
    levels = _levels_to_follow(cells)
    pieces: dict[Level, list[Window]] = {level: [] for level in levels}
    for place, cell in enumerate(cells):
        low, high = cell.ends
        for level in levels:
            if cell.holds(level):
                pieces[level].append(Window(WindowEnd(low), WindowEnd(high)))
        for arc in _followed(cell.to_follow(levels), parameter, cell.ends):
            for level in levels:
                if not cell.holds(level) and getattr(arc, level):
                    pieces[level].append(Window(arc.low, arc.high))
        tell(0.7 + 0.3 * (place + 1) / len(cells))
    stable = _joined(pieces["stable"]) if "stable" in pieces else None
    return OrbitWindows(parameter, tuple(values), _joined(pieces["possible"]), stable)


_LEVELS: tuple[Level, ...] = ("possible", "stable")


def _levels_to_follow(cells: list[_Cell]) -> tuple[Level, ...]:
    """What can be found out by following no more than MOST_FOLLOWED orbits."""
    for levels in (_LEVELS, _LEVELS[:1]):
        count = sum(len(cell.to_follow(levels)) for cell in cells)
        if count <= MOST_FOLLOWED:
            return levels
    raise CaromError(f"{count} orbits change between these values: too many to follow; choose a shorter range")


def _members(rotor: Jeffcott) -> list[_Member]:
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
    if possible <= 0.0:
        return _Member(solution, possible, possible)
    radius = spectral_radii([at])[0]
    return _Member(solution, possible, min(possible, 1.0 - radius))


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


def _partners(left: list[_Member], right: list[_Member]) -> dict[int, int]:
    """Index of the solution on the right into which each one on the left continues, where Newton's method finds it.

    Where two solutions are close, Newton's method may converge to the wrong one.  The letters of the names must
    therefore agree: without a fold in between each solution keeps its letter.
    """
    found: dict[int, int] = {}
    for backward in (False, True):
        places = [index for index, member in enumerate(right) if (member.solution.numbers.mu < 0.0) == backward]
        if not places:
            continue
        others = np.array([right[index].solution[2:] for index in places])
        for place, (solution, possible, _) in enumerate(left):
            if (solution.numbers.mu < 0.0) != backward:
                continue
            for steps in SUBSTEPS if possible > FAR else SUBSTEPS[:1]:
                guess = _moved(solution, right[places[0]].solution.numbers, steps)
                if guess is None:
                    continue
                nearest = int(np.argmin(np.abs(others - guess).max(axis=1)))
                partner = places[nearest]
                if (
                    _same(float(others[nearest, 0]), float(others[nearest, 1]), *guess)
                    and solution.name.letter == right[partner].solution.name.letter
                    and partner not in found.values()
                ):
                    found[place] = partner
                    break
    return found


def _moved(solution: Solution, numbers: Numbers, steps: int) -> tuple[float, float] | None:
    """Period and radial speed to which a solution moves while the parameters change to others in some steps."""
    start, end = np.array(solution.numbers[:-1]), np.array(numbers[:-1])
    at: tuple[float, float] | None = (solution.period, solution.radial_speed)
    for share in np.linspace(0.0, 1.0, steps + 1)[1:].tolist():
        if at is not None:
            at = corrected(Numbers(*((1.0 - share) * start + share * end).tolist()), *at)
    return at


def _same(period: float, speed: float, other_period: float, other_speed: float) -> bool:
    return max(abs(period - other_period), abs(speed - other_speed)) < SAME * (1.0 + period)


def _near_zero(columns: list[list[_Member]], partners: list[dict[int, int]], level: Level) -> list[set[int]]:
    """For each interval, the solutions at its left end whose margin may cross zero and return within it or the next.

    The criterion looks at three successive margins of one sign.  If the middle one is nearest to zero and the parabola
    through them is bent by more than its distance from zero, the margin may reach zero between them.  Margins far from
    zero are left out.
    """
    near: list[set[int]] = [set() for _ in partners]
    for place, (first, second) in enumerate(pairwise(partners)):
        for before, here in first.items():
            if here not in second:
                continue
            ends = columns[place][before], columns[place + 1][here], columns[place + 2][second[here]]
            low, middle, high = (getattr(member, level) for member in ends)
            sizes = abs(low), abs(middle), abs(high)
            alike = (low > 0.0) == (middle > 0.0) == (high > 0.0)
            if alike and middle > FAR and sizes[1] == min(sizes) and sizes[1] < sizes[0] + sizes[2] - 2.0 * sizes[1]:
                near[place].add(before)
                near[place + 1].add(here)
    return near


class _Cell(NamedTuple):
    """Orbits at two neighbouring values, which of them continue into each other, and which may change and change back between."""

    ends: tuple[float, float]
    left: list[_Member]
    right: list[_Member]
    pairs: dict[int, int]
    near: dict[Level, set[int]]

    def holds(self, level: Level) -> bool:
        """Whether one orbit has the property at both values, and is taken to have it between them."""
        return any(
            getattr(self.left[one], level) > 0.0
            and getattr(self.right[other], level) > 0.0
            and one not in self.near[level]
            for one, other in self.pairs.items()
        )

    def to_follow(self, levels: tuple[Level, ...]) -> list[Solution]:
        """Solutions that change between the values, or may change, if that can matter; of a pair the one with the larger margin."""
        open_levels = [level for level in levels if not self.holds(level)]
        if not open_levels:
            return []
        chosen = [member for k, member in enumerate(self.left) if k not in self.pairs and member.possible > FAR]
        chosen += [
            member for k, member in enumerate(self.right) if k not in self.pairs.values() and member.possible > FAR
        ]
        for one, other in self.pairs.items():
            before, after = self.left[one], self.right[other]
            if any(
                one in self.near[level] or (getattr(before, level) > 0.0) != (getattr(after, level) > 0.0)
                for level in open_levels
            ):
                chosen.append(max(before, after, key=lambda member: member.possible))
        return [member.solution for member in sorted(chosen, key=lambda member: -member.possible)]


def _cells(values: Sequence[float], columns: list[list[_Member]]) -> list[_Cell]:
    partners = [_partners(*pair) for pair in pairwise(columns)]
    near = {level: _near_zero(columns, partners, level) for level in _LEVELS}
    return [
        _Cell(ends, columns[k], columns[k + 1], partners[k], {level: near[level][k] for level in _LEVELS})
        for k, ends in enumerate(pairwise(values))
    ]


def _followed(solutions: Iterable[Solution], parameter: str, interval: tuple[float, float]) -> list[_Arc]:
    """Arcs of the branches through the given solutions, each of which lies at one end of the interval."""
    arcs: list[_Arc] = []
    passed: list[Solution] = []
    for solution in solutions:
        if any(end.numbers == solution.numbers and _same(*end[2:], *solution[2:]) for end in passed):
            continue
        orbit = orbit_of(solution.numbers, solution.name.pair, solution.period, solution.radial_speed)
        try:
            branch = continue_orbit(orbit, parameter, interval, STEPS)
        except CaromError:
            continue
        passed += [branch.closed[end] for end in (0, -1)]
        arcs += _arcs(branch, interval)
    return arcs


def _arcs(branch: OrbitBranch, interval: tuple[float, float]) -> list[_Arc]:
    """Parts of a branch in an interval between its special points; along each the parameter is monotone."""
    special, inner = branch.special, len(branch) - 2
    course = np.column_stack([branch.values, branch.period, branch.radial_speed])
    ends = [WindowEnd(point.value, point.kind, point.name, point.period, point.radial_speed) for point in special]
    marks = [_branch_end(branch, 0, interval), *ends, *([None] * inner), _branch_end(branch, -1, interval)]
    rows = [course[0], *([end.value, end.period, end.radial_speed] for end in ends), *course[1:]]
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


def _branch_end(branch: OrbitBranch, end: Literal[0, -1], interval: tuple[float, float]) -> WindowEnd:
    value, period = float(branch.values[end]), float(branch.period[end])
    stop = branch.stops[end]
    if stop in ("parameter limit", "closed loop"):
        return WindowEnd(value)
    if period < SHORT:
        return _short_end(branch, end, interval)
    return WindowEnd(value, stop, branch.names[end], period, float(branch.radial_speed[end]))


def _short_end(branch: OrbitBranch, end: Literal[0, -1], interval: tuple[float, float]) -> WindowEnd:
    """Where a branch ends whose period is too short for shooting, which loses digits there: by the closed form.

    That is where the period vanishes, or the end of the interval to which it is short.
    """
    value, period, speed = (float(each[end]) for each in (branch.values, branch.period, branch.radial_speed))

    def closing(there: float) -> float:
        return conditions_at(branch.numbers_at(there), VANISHED, speed).closing

    brackets = (sign_change(closing, value, limit) for limit in interval)
    places = [bracketed_root(closing, *bracket) for bracket in brackets if bracket is not None]
    if places:
        value = min(places, key=lambda place: abs(place - value))
        at = conditions_at(branch.numbers_at(value), VANISHED, speed)
        speeds = radial_speeds(math.sqrt(1.0 + at.boundary), at.lever)
        speed = min(speeds, key=lambda each: abs(each - speed), default=speed)
        return WindowEnd(value, "vanishing-period", branch.names[end], VANISHED, speed)
    for limit in interval:
        found = corrected(branch.numbers_at(limit), period, speed)
        if found is not None and found[0] < SHORT:
            return WindowEnd(limit)
    return WindowEnd(value, branch.stops[end], branch.names[end], period, speed)


def _halfway(branch: OrbitBranch, course: np.ndarray) -> tuple[Numbers, float, float] | None:
    """Orbit in the middle of an arc; ``None`` if Newton's method does not converge to one.

    ``course`` holds the parameter, period and radial speed along the arc, shape (m, 3).
    """
    middle = 0.5 * float(course[0, 0] + course[-1, 0])
    values, *others = course[np.argsort(course[:, 0])].T
    numbers = branch.numbers_at(middle)
    found = corrected(numbers, *(float(np.interp(middle, values, other)) for other in others))
    return None if found is None else (numbers, *found)


def _joined(pieces: Iterable[Window]) -> tuple[Window, ...]:
    """Merge windows that touch or overlap."""
    joined: list[Window] = []
    for piece in sorted(pieces, key=lambda window: window.low.value):
        if joined and piece.low.value <= joined[-1].high.value + MERGED * abs(piece.low.value):
            last = joined.pop()
            piece = Window(last.low, max(last.high, piece.high, key=lambda end: end.value))
        joined.append(piece)
    return tuple(joined)
