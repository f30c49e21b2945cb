"""Regions of a plane: groups of neighbouring cells with the same motions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from carom.base.results import Result
from carom.bifurcations.changes import PlanePoint
from carom.bifurcations.motions import Motions, motions_at
from carom.bifurcations.planes import Plane
from carom.parameters import Parameters

THIN = 0.05
"""Fraction of the plane below which the point of a region is refined between the points of the grid."""
LOOK_AROUND, FINER = 6, 5
BETWEEN = 12
"""Points tested between two groups of grid points with the same motions."""


@dataclass(frozen=True, eq=False, repr=False)
class Region(Result):
    """A connected set of grid points with the same motions.

    Attributes
    ----------
    motions : Motions
    point : tuple of float
        A point well inside.
    share : float
        Fraction of the plane; 0 if it is thinner than a cell.
    places : ndarray, shape (n, 2)
        The grid points.
    """

    # Not narrower: of other machines the motions are those on which disturbances end.
    motions: Any
    point: tuple[float, float]
    share: float
    places: np.ndarray


def regions_between(
    parameters: Parameters,
    plane: Plane,
    cells: Sequence[Sequence[PlanePoint]],
    seen: dict[Motions, tuple[float, float]],
) -> tuple[Region, ...]:
    """Regions of a plane, largest first, from the middle of each cell by first and second parameter.

    ``seen`` has a point for each set of motions found anywhere.  Sets that occur in the middle of no cell become
    regions thinner than a cell, with a share of 0.
    """
    grid = len(cells)
    found = {(i, j): point.motions for i, column in enumerate(cells) for j, point in enumerate(column)}

    def place_of(cell: tuple[int, int]) -> np.ndarray:
        return cells[cell[0]][cell[1]].place

    def joins(first: tuple[int, int], second: tuple[int, int]) -> bool:
        """Whether all points between two cells have the same motions."""
        shares = np.linspace(0.0, 1.0, BETWEEN + 2)[1:-1, None]
        places = place_of(first) + shares * (place_of(second) - place_of(first))
        return all(motions_at(plane.at(parameters, *place)) == found[first] for place in places.tolist())

    regions = []
    for group in _merged(connected(found), found, joins):
        cell = max(group, key=lambda cell: _depth(cell, group, grid))
        x, y = place_of(cell).tolist()
        share = len(group) / grid**2
        if share < THIN or _depth(cell, group, grid) < 3:
            x, y = _centre_of(parameters, plane, grid, found[cell], (x, y))
        regions.append(Region(found[cell], (x, y), share, np.array([place_of(each) for each in sorted(group)])))
    known = set(found.values())
    for motions, place in seen.items():
        if motions not in known:
            regions.append(
                Region(motions, _centre_of(parameters, plane, 8 * grid, motions, place), 0.0, np.array([place]))
            )
    return tuple(sorted(regions, key=lambda region: -region.share))


def _centre_of(
    parameters: Parameters, plane: Plane, grid: int, motions: Motions, place: tuple[float, float]
) -> tuple[float, float]:
    """Approximate middle of a thin region, searched along one parameter and then the other from a point in it."""
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


def connected(found: Mapping[tuple[int, int], object]) -> list[set[tuple[int, int]]]:
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
    """Merge groups of equal motions that are connected by a passage narrower than a cell."""
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
    """Number of cells by which one can move in every direction without leaving the group."""
    depth = 0
    while all(
        (cell[0] + i * (depth + 1), cell[1] + j * (depth + 1)) in cells for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1))
    ):
        depth += 1
        if depth > grid:
            break
    return depth
