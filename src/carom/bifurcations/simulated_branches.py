"""Branches of the periodic motions of any machine for diagrams, through what searches at some values find."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce

import numpy as np

from carom.base.outcome import CaromError
from carom.base.progress import Reporter
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.simulated import MOST_NUMBERS, STEPS, SimulatedBranch, continue_simulated, switch_simulated
from carom.models import Rotor
from carom.models.axes import Axis
from carom.orbits.flow import Budget, Flow
from carom.orbits.names import CountedName
from carom.orbits.searched import Searched
from carom.orbits.simulated import SimulatedOrbit, numbered
from carom.orbits.simulated_search import search_simulated

VALUES = (0.5, 0.15, 0.85)
"""Places of the range at which orbits are searched."""
SHARE, FIRST_SHARE, EVENTS = 0.2, 0.05, 3e6
"""Share of the usual search there, and of one for special points alone; events after which no further orbit is followed."""
FEW = replace(STEPS, largest=0.3, most_points=60)
"""Steps of the branches of a diagram, of which there may be many."""
ALONE = "not followed"


def simulated_branches(
    model: Rotor, along: Axis, limits: tuple[float, float], impacts: int, tell: Reporter, budget: Budget | None = None
) -> tuple[list[SimulatedBranch], Searched]:
    """Branches of the periodic motions of any machine with at most a number of impacts, and what was searched.

    Those of rotors of very many states are found at some values, and not followed.  With a ``budget`` they are searched at one value only.
    """
    usual, budget, done = budget is None, budget or Budget(EVENTS), list[Searched]()
    found: list[SimulatedBranch] = []
    counts: dict[int, int] = {}

    def add(orbit: SimulatedOrbit) -> None:
        value = along.value(orbit.rotor)
        counts[orbit.impacts] = counts.get(orbit.impacts, 0) + 1
        named = numbered(orbit, counts[orbit.impacts])
        followed = len(Flow.vector(orbit.start)) <= MOST_NUMBERS and not budget.spent
        try:
            branch = continue_simulated(named, along.name, limits, FEW, budget) if followed else None
        except CaromError:
            branch = None
        if branch is None or not len(branch):
            branch = SimulatedBranch(along, named.name, orbit.rotor, np.array([value]), (named,), (), (ALONE, ALONE))
        found.append(branch)
        for point in branch.special if followed else ():
            if point.kind == "period-doubling" and 2 * orbit.impacts <= impacts and not budget.spent:
                _leave(point)

    def _leave(point: Bifurcation) -> None:
        try:
            branch = switch_simulated(point, limits, budget)
        except CaromError:
            return
        known = any(
            other.passes(orbit, value)
            for other in found
            for orbit, value in [(branch.orbits[len(branch) // 2], float(branch.values[len(branch) // 2]))]
        )
        if not known:
            counts[branch.impacts] = counts.get(branch.impacts, 0) + 1
            found.append(replace(branch, name=CountedName(branch.impacts, counts[branch.impacts])))

    # Branches of many numbers are not followed, and setting up their equations takes long.
    values = VALUES if 4 * len(model.system.rest) <= MOST_NUMBERS and usual else VALUES[:1]
    for place, share in enumerate(values):
        value = limits[0] + share * (limits[1] - limits[0])
        rotor = along.move(model, value)
        part = tell.part(place / len(values), (place + 1) / len(values))
        orbits, searched = search_simulated(rotor, impacts, None, place, part, SHARE if usual else FIRST_SHARE)
        done.append(searched)
        for orbit in orbits:
            if not any(branch.passes(orbit, value) for branch in found):
                add(orbit)
    return found, reduce(Searched.and_then, done)
