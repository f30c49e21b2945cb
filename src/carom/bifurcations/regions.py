"""Regions of a plane of two parameters in which the same motions coexist, and the curves between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from carom.bifurcations.axes import value_of, vary
from carom.bifurcations.curves import KINDS, Codimension2Point, Curve, Plane, continue_curve
from carom.bifurcations.diagrams import Diagram, bifurcation_diagram
from carom.bifurcations.motions import Motions, motions_at
from carom.bifurcations.onsets import ONSETS, continue_onset
from carom.bifurcations.rubbing import RubbingBranch, RubbingPoint
from carom.bifurcations.steady import SpecialValue
from carom.outcome import CaromError
from carom.parameters import Parameters

__all__ = ["Region", "RegionMap", "region_map"]

THIN = 0.05
"""Share of the plane below which a region's point is looked for between those of the grid."""
LOOK_AROUND, FINER = 6, 5
BETWEEN = 12
"""Points looked at between two groups of grid points with the same motions."""
SAME_POINT = 1e-6
"""Distance, in widths of the plane, below which codimension-2 points are the same."""


@dataclass(frozen=True, eq=False)
class Region:
    """A connected set of grid points with the same motions.

    Attributes
    ----------
    motions : Motions
    point : tuple of float
        A point well inside.
    share : float
        Fraction of the plane.
    places : ndarray, shape (n, 2)
        The grid points.
    """

    motions: Motions
    point: tuple[float, float]
    share: float
    places: np.ndarray


@dataclass(frozen=True, eq=False)
class RegionMap:
    """Curves, codimension-2 points and regions of a plane.

    Attributes
    ----------
    plane : Plane
    curves : tuple of Curve
    regions : tuple of Region
        Largest first.
    lost : tuple of str
        Curves that could not be followed, each with the reason.
    """

    plane: Plane
    curves: tuple[Curve, ...]
    regions: tuple[Region, ...]
    lost: tuple[str, ...] = ()

    @property
    def everywhere(self) -> tuple[str, ...]:
        """What holds in every region, in words."""
        if not self.regions:
            return ()
        first, *others = (region.motions.parts for region in self.regions)
        return tuple(part for place, part in enumerate(first) if all(parts[place] == part for parts in others))

    @property
    def codimension2(self) -> tuple[Codimension2Point, ...]:
        """Points where two curves meet, each once.

        A non-smooth Hopf bifurcation is a boundary equilibrium with orbits, and its points are told as such.
        """
        widths = np.ptp([self.plane.first_range, self.plane.second_range], axis=1)
        found: list[Codimension2Point] = []
        ordered = sorted(self.curves, key=lambda curve: curve.kind == "non-smooth-hopf")
        for point in (point for curve in ordered for point in curve.codimension2):
            parts = set(point.kind.replace("non-smooth-hopf", "boundary-equilibrium").split(" + "))
            if not any(
                parts == set(other.kind.split(" + "))
                and np.abs((np.subtract(point.value, other.value)) / widths).max() < SAME_POINT
                for other in found
            ):
                found.append(point)
        return tuple(found)


def region_map(
    parameters: Parameters,
    plane: Plane,
    *,
    grid: int = 24,
    virtual: bool = False,
    lasting: bool = False,
    progress: Callable[[float], None] | None = None,
) -> RegionMap:
    """Draw the map of a plane: all curves through the bifurcations on its cross-sections, and the regions between.

    The special points of both parameters' diagrams through the present parameters are continued; a curve that
    passes a point already drawn is left out.

    Parameters
    ----------
    parameters : Parameters
        A point of the plane.
    plane : Plane
    grid : int
        Grid points a side at which motions are counted.
    virtual : bool
        Follow bifurcations of virtual orbits too.
    lasting : bool
        Follow the onsets of lasting and of permanent contact too (a few seconds).
    progress : callable, optional
        Called with the fraction done.

    Returns
    -------
    RegionMap

    Raises
    ------
    InputError
        Unknown parameters, or a range they cannot have.
    """
    plane.axes(parameters)
    tell = progress or (lambda _: None)
    curves: list[Curve] = []
    lost: list[str] = []
    for share, name, interval in ((0.15, plane.first, plane.first_range), (0.3, plane.second, plane.second_range)):
        diagram = bifurcation_diagram(parameters, name, interval, virtual=virtual, lasting=lasting)
        for point in _starts(diagram, virtual):
            at = vary(parameters, diagram.parameter, point.value)
            if not any(_passes(curve, at, point) for curve in curves):
                try:
                    curves.append(continue_curve(point.kind, at, plane, _unknowns(point)))
                except CaromError as problem:
                    lost.append(f"{point.kind} of {point.branch} at {name} = {point.value:.6g}: {problem}")
        for branch in diagram.rubbing:
            for end in branch.special:
                if end.kind in ONSETS and not any(_passes_onset(curve, branch, end, parameters) for curve in curves):
                    try:
                        curves.append(continue_onset(branch, end, parameters, plane))
                    except CaromError as problem:
                        lost.append(f"{end.kind} at {name} = {end.value:.6g}: {problem}")
        tell(share)
    regions = _regions(parameters, plane, grid, lambda share: tell(0.3 + 0.7 * share))
    return RegionMap(plane, tuple(curves), regions, tuple(lost))


def _starts(diagram: Diagram, virtual: bool) -> list[SpecialValue]:
    """Special points that lie on curves."""
    return [
        point
        for point in diagram.points
        if point.kind in KINDS and (virtual or point.admissible) and not point.branch.startswith("rubbing")
    ]


def _unknowns(point: SpecialValue) -> tuple[float, ...]:
    return () if point.period is None or point.radial_speed is None else (point.period, point.radial_speed)


def _passes_onset(curve: Curve, branch: RubbingBranch, end: RubbingPoint, parameters: Parameters) -> bool:
    at = vary(parameters, branch.axis.name, end.value)
    return _passes(curve, at, SpecialValue(end.kind, "", branch.axis.name, end.value, end.period, None, True))


def _passes(curve: Curve, at: Parameters, start: SpecialValue) -> bool:
    """Whether a curve passes the start: its nearest points, corrected, have the same orbit there."""
    if curve.kind != start.kind:
        return False
    plane = curve.plane
    sizes = np.ptp([plane.first_range, plane.second_range], axis=1)
    place = np.array([value_of(at, plane.first), value_of(at, plane.second)]) / sizes
    points = curve.points / sizes
    ahead = np.diff(points, axis=0)
    share = np.clip(((place - points[:-1]) * ahead).sum(axis=1) / np.maximum((ahead**2).sum(axis=1), 1e-300), 0.0, 1.0)
    distance = np.linalg.norm(points[:-1] + share[:, None] * ahead - place, axis=1)
    # Between points the curve bends off its chord by less than an eighth of the step.
    near = np.flatnonzero(distance <= 0.125 * np.linalg.norm(ahead, axis=1) + 1e-9)
    return any(_same_orbit(curve, int(i), float(share[i]), start) for i in near)


def _same_orbit(curve: Curve, step: int, share: float, start: SpecialValue) -> bool:
    """Whether the orbit on a step of a curve is that of the start."""
    if start.period is None:
        return True
    weights = np.array([1.0 - share, share])
    period = weights @ curve.periods[step : step + 2]
    if not abs(period - start.period) < 0.02 * start.period:
        return False
    speed = weights @ curve.radial_speeds[step : step + 2]
    return start.radial_speed is None or bool(abs(speed - start.radial_speed) < 0.02)


def _regions(parameters: Parameters, plane: Plane, grid: int, progress: Callable[[float], None]) -> tuple[Region, ...]:
    xs = np.linspace(*plane.first_range, 2 * grid + 1)[1::2]
    ys = np.linspace(*plane.second_range, 2 * grid + 1)[1::2]
    found: dict[tuple[int, int], Motions] = {}
    for i, x in enumerate(xs):
        for j, y in enumerate(ys):
            found[i, j] = motions_at(plane.at(parameters, float(x), float(y)))
        progress((i + 1) / grid)

    def joins(first: tuple[int, int], second: tuple[int, int]) -> bool:
        """Whether all points between two cells have the same motions."""
        shares = np.linspace(0.0, 1.0, BETWEEN + 2)[1:-1]
        places = [
            [axis[a] + share * (axis[b] - axis[a]) for axis, a, b in zip((xs, ys), first, second, strict=True)]
            for share in shares
        ]
        return all(motions_at(plane.at(parameters, *place)) == found[first] for place in places)

    regions = []
    for cells in _merged(_connected(found), found, joins):
        i, j = max(cells, key=lambda cell: _depth(cell, cells, grid))
        place, share = (float(xs[i]), float(ys[j])), len(cells) / grid**2
        if share < THIN or _depth((i, j), cells, grid) < 3:
            place = _centred(parameters, plane, grid, found[i, j], place)
        regions.append(Region(found[i, j], place, share, np.array([(xs[k], ys[m]) for k, m in sorted(cells)])))
    return tuple(sorted(regions, key=lambda region: -region.share))


def _centred(
    parameters: Parameters, plane: Plane, grid: int, motions: Motions, place: tuple[float, float]
) -> tuple[float, float]:
    """The middle of a thin region, seen from a point of it along either parameter."""
    ranges, point = (plane.first_range, plane.second_range), list(place)
    for along, (low, high) in enumerate(ranges):
        ends = []
        for side in (-1.0, 1.0):
            here = point.copy()

            def inside(value: float, here: list[float] = here, along: int = along) -> bool:
                here[along] = value
                return motions_at(plane.at(parameters, here[0], here[1])) == motions

            step, end = side * (high - low) / grid, point[along]
            for _ in range(LOOK_AROUND):
                if not (low <= end + step <= high and inside(end + step)):
                    break
                end += step
            for _ in range(FINER):
                step *= 0.5
                if low <= end + step <= high and inside(end + step):
                    end += step
            ends.append(end)
        point[along] = 0.5 * sum(ends)
    return point[0], point[1]


def _connected(found: dict[tuple[int, int], Motions]) -> list[set[tuple[int, int]]]:
    """Groups of neighbouring cells with equal motions."""
    left = set(found)
    groups = []
    while left:
        group, border = set(), [left.pop()]
        while border:
            cell = border.pop()
            group.add(cell)
            for step in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                other = (cell[0] + step[0], cell[1] + step[1])
                if other in left and found[other] == found[cell]:
                    left.remove(other)
                    border.append(other)
        groups.append(group)
    return groups


def _merged(
    groups: list[set[tuple[int, int]]],
    found: dict[tuple[int, int], Motions],
    joins: Callable[[tuple[int, int], tuple[int, int]], bool],
) -> list[set[tuple[int, int]]]:
    """Join groups of equal motions that a narrow place between the grid points seems to part."""
    merged: list[set[tuple[int, int]]] = []
    for group in sorted(groups, key=len, reverse=True):
        for other in merged:
            if found[next(iter(other))] == found[next(iter(group))]:
                pair = min(product(other, group), key=lambda cells: np.hypot(*np.subtract(*cells)))
                if joins(*pair):
                    other |= group
                    break
        else:
            merged.append(group)
    return merged


def _depth(cell: tuple[int, int], cells: set[tuple[int, int]], grid: int) -> int:
    """Cells one can go in each direction without leaving the group."""
    depth = 0
    while all(
        (cell[0] + i * (depth + 1), cell[1] + j * (depth + 1)) in cells for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ):
        depth += 1
        if depth > grid:
            break
    return depth
