"""Regions of a plane: groups of neighbouring cells with the same motions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from carom.base.outcome import InputError
from carom.base.progress import Reporter
from carom.base.results import Result
from carom.bifurcations.changes import PlanePoint
from carom.bifurcations.motions import NOT_EXAMINED, Motions, motions_at
from carom.bifurcations.planes import Plane
from carom.models import Rotor, rotor_of
from carom.orbits.flow import FlowBudget
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

    motions: Motions
    point: tuple[float, float]
    share: float
    places: np.ndarray


def settled_cells(
    model: Rotor, plane: Plane, grid: int, budget: FlowBudget, tell: Reporter
) -> tuple[list[list[PlanePoint]], int]:
    """Motions on which disturbances end in the middle of each cell of a grid, and the number of cells that were examined.

    Of a plane that takes longer than the budget only every second one along each parameter, or fewer; each other counts as its nearest.
    """
    shares = (np.arange(grid) + 0.5) / grid
    xs, ys = (low + (high - low) * shares for low, high in (plane.first_range, plane.second_range))
    known: dict[tuple[int, int], Motions] = {}
    order = _spread(grid)
    for cell in order:
        if budget.spent:
            break
        try:
            known[cell] = motions_at(plane.at(model, float(xs[cell[0]]), float(ys[cell[1]])), budget)
        except InputError:
            known[cell] = NOT_EXAMINED
        tell(len(known) / len(order))

    def nearest(cell: tuple[int, int]) -> Motions:
        return known[min(known, key=lambda other: abs(other[0] - cell[0]) + abs(other[1] - cell[1]))]

    cells = [[PlanePoint(np.array([x, y]), nearest((i, j))) for j, y in enumerate(ys)] for i, x in enumerate(xs)]
    return cells, len(known)


def _spread(grid: int) -> list[tuple[int, int]]:
    """Cells of a grid, coarse ones first."""
    found: dict[tuple[int, int], None] = {}
    step = 1 << max(0, (grid - 1).bit_length() - 1)
    while step:
        places = range(step // 2, grid, step)
        found.update(dict.fromkeys(product(places, places)))
        step //= 2
    found.update(dict.fromkeys(product(range(grid), range(grid))))
    return list(found)


def regions_between(
    base: Parameters | Rotor,
    plane: Plane,
    cells: Sequence[Sequence[PlanePoint]],
    seen: dict[Motions, tuple[float, float]],
) -> tuple[Region, ...]:
    """Regions of a plane, largest first, from the middle of each cell by first and second parameter.

    ``seen`` has a point for each set of motions found anywhere.  Sets that occur in the middle of no cell become
    regions thinner than a cell, with a share of 0.  Between the cells motions are counted of machines with closed forms alone.
    """
    grid, counted = len(cells), rotor_of(base).has_closed_forms
    found = {(i, j): point.motions for i, column in enumerate(cells) for j, point in enumerate(column)}

    def place_of(cell: tuple[int, int]) -> np.ndarray:
        return cells[cell[0]][cell[1]].place

    def joins(first: tuple[int, int], second: tuple[int, int]) -> bool:
        """Whether all points between two cells have the same motions."""
        if not counted:
            return False
        shares = np.linspace(0.0, 1.0, BETWEEN + 2)[1:-1, None]
        places = place_of(first) + shares * (place_of(second) - place_of(first))
        return all(motions_at(plane.at(base, *place)) == found[first] for place in places.tolist())

    regions = []
    for group in _merged(_connected(found), found, joins):
        cell = max(group, key=lambda cell: _depth(cell, group, grid))
        x, y = place_of(cell).tolist()
        share = len(group) / grid**2
        if counted and (share < THIN or _depth(cell, group, grid) < 3):
            x, y = _centre_of(base, plane, grid, found[cell], (x, y))
        regions.append(Region(found[cell], (x, y), share, np.array([place_of(each) for each in sorted(group)])))
    known = set(found.values())
    for motions, place in seen.items():
        if motions not in known:
            regions.append(Region(motions, _centre_of(base, plane, 8 * grid, motions, place), 0.0, np.array([place])))
    return tuple(sorted(regions, key=lambda region: -region.share))


def _centre_of(
    base: Parameters | Rotor, plane: Plane, grid: int, motions: Motions, place: tuple[float, float]
) -> tuple[float, float]:
    """Approximate middle of a thin region, searched along one parameter and then the other from a point in it."""
    ranges, point = (plane.first_range, plane.second_range), list(place)
    for along, (low, high) in enumerate(ranges):
        ends = []
        for side in (-1.0, 1.0):
            here = point.copy()

            def inside(value: float, here: list[float] = here, along: int = along) -> bool:
                here[along] = value
                return motions_at(plane.at(base, here[0], here[1])) == motions

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


def _connected(found: Mapping[tuple[int, int], object]) -> list[set[tuple[int, int]]]:
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
