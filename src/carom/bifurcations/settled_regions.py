"""Regions of a plane of two parameters by where simulated motions settle: for machines whose orbits have no closed forms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from carom.attractors.names import LEVITATION
from carom.base.outcome import InputError, Outcome
from carom.base.progress import Reporter
from carom.bifurcations.cells import Region, connected
from carom.bifurcations.planes import Plane
from carom.models import Rotor
from carom.models.axes import Axis
from carom.motions.simulation import simulate
from carom.orbits.flow import Budget
from carom.orbits.simulated_search import start_of

STARTS = 6
"""Motions that are followed at each point of the grid, from the same random numbers everywhere."""
MOST_EVENTS, PATIENCE = 1500, 500
EVENTS = 6e6
"""Events (:class:`~carom.orbits.flow.Budget`) after which no further point of the grid is examined."""
UNTOLD = "not examined"


@dataclass(frozen=True)
class SettledMotions:
    """The motions on which some disturbances end; two sets are equal if they hold the same motions.

    Attributes
    ----------
    parts : tuple of str
        Whether levitation is inside the wall, then the motions in words, those with several impacts a period with their number.
    contact_free, rub, rolling : bool
        Whether levitation is inside the wall; whether a motion ends in forward rub, and in rolling.
    orbits : int
        Number of kinds of periodic bouncing, all of which attract.
    """

    parts: tuple[str, ...]
    contact_free: bool
    rub: bool
    rolling: bool
    orbits: int

    source_region = ""
    stable_names = ()
    unstable_names = ()

    @property
    def stable_orbits(self) -> int:
        """Number of kinds of periodic bouncing: motions settle on what attracts them."""
        return self.orbits

    @property
    def words(self) -> str:
        """The motions in words."""
        return ", ".join(self.parts)

    @property
    def region(self) -> str:
        """The same."""
        return self.words


def settled_motions(rotor: Rotor, budget: Budget | None = None) -> SettledMotions:
    """Follow some disturbances of a machine until they settle."""
    random, found, budget = np.random.default_rng(0), set(), budget or Budget()
    held = rotor.system.levitates
    for _ in range(STARTS):
        motion = budget.pay(simulate(rotor, start_of(rotor, random), patience=PATIENCE, max_events=MOST_EVENTS))
        found.add((motion.outcome, motion.multiplicity))
    words = [f"{LEVITATION}" if held else f"no {LEVITATION}"]
    for outcome, count in sorted(found):
        if outcome is not Outcome.LEVITATED:
            words.append(f"{outcome.words} ({count} a period)" if count else outcome.words)
    outcomes = {outcome for outcome, _ in found}
    periodic = sum(count > 0 for _, count in found)
    return SettledMotions(tuple(words), held, Outcome.FORWARD_RUB in outcomes, Outcome.ROLLING in outcomes, periodic)


NONE = SettledMotions((UNTOLD,), contact_free=False, rub=False, rolling=False, orbits=0)


def settled_regions(
    model: Rotor, plane: Plane, axes: tuple[Axis, Axis], grid: int, tell: Reporter
) -> tuple[tuple[Region, ...], tuple[str, ...]]:
    """Regions of the cells of a grid, largest first, and what is said about them.

    The middle of each cell is examined; of a plane that takes too long only every second one along each parameter, or fewer.
    """
    budget, shares = Budget(EVENTS), (np.arange(grid) + 0.5) / grid
    xs, ys = (low + (high - low) * shares for low, high in (plane.first_range, plane.second_range))
    cells: dict[tuple[int, int], SettledMotions] = {}
    order = _spread(grid)
    for done, (i, j) in enumerate(order):
        if budget.spent:
            break
        rotor = axes[1].move(axes[0].move(model, float(xs[i])), float(ys[j]))
        try:
            cells[i, j] = settled_motions(rotor, budget)
        except InputError:
            cells[i, j] = NONE
        tell((done + 1) / len(order))
    remarks = f"Regions are told by where {STARTS} disturbances at each of {len(cells)} points of the grid settle; curves between them are not followed."
    left = grid**2 - len(cells)
    notes = (
        remarks,
        *(
            [f"{left} points of the grid were not reached within {EVENTS:.0e} events; each counts as its nearest."]
            if left
            else []
        ),
    )
    known = np.array(list(cells))
    for cell in order[len(cells) :]:
        nearest = known[int(np.argmin(np.abs(known - cell).sum(axis=1)))]
        cells[cell] = cells[int(nearest[0]), int(nearest[1])]
    regions = [_region(group, cells, xs, ys) for group in connected(cells)]
    return tuple(sorted(regions, key=lambda region: -region.share)), notes


def _spread(grid: int) -> list[tuple[int, int]]:
    """Cells of a grid, coarse ones first."""
    found: dict[tuple[int, int], None] = {}
    step = 1 << max(0, (grid - 1).bit_length() - 1)
    while step:
        for i in range(step // 2, grid, step):
            for j in range(step // 2, grid, step):
                found[i, j] = None
        step //= 2
    found.update(dict.fromkeys((i, j) for i in range(grid) for j in range(grid)))
    return list(found)


def _region(
    group: set[tuple[int, int]], cells: dict[tuple[int, int], SettledMotions], xs: np.ndarray, ys: np.ndarray
) -> Region:
    places = np.array([(xs[i], ys[j]) for i, j in sorted(group)])
    scaled = places / np.maximum(np.ptp([(xs[0], ys[0]), (xs[-1], ys[-1])], axis=0), 1e-300)
    middle = places[int(np.argmin(np.linalg.norm(scaled - scaled.mean(axis=0), axis=1)))]
    motions = cells[next(iter(group))]
    return Region(motions, (float(middle[0]), float(middle[1])), len(group) / len(cells), places)


def axes_of(model: Rotor, plane: Plane, axes: Sequence[Axis]) -> None:
    """Refuse ranges that the machine cannot have."""
    for end in (0, 1):
        moved = axes[0].move(model, plane.first_range[end])
        axes[1].move(moved, plane.second_range[end])
