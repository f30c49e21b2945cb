"""Branches of orbits that no closed form gives, for diagrams: from special points of known branches, and from a search at some values."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

import numpy as np

from carom.base.outcome import CaromError
from carom.base.progress import Reporter
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.neighbours import BORDERS
from carom.bifurcations.points import HALVING, Bifurcation
from carom.bifurcations.words import continue_orbit, renamed, switch
from carom.models import Rotor
from carom.models.axes import Axis
from carom.orbits.names import CountedName
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.search import Search
from carom.orbits.searched import Searched
from carom.orbits.shooting import pack

VALUES = 9
"""Number of values of the parameter at which orbits are searched."""
GUESSES, SETTLED, FRESH = 300, 1000, 300
"""Guesses at each value for each number of impacts, motions followed until they settle, and fresh ones (:class:`~carom.orbits.search.Search`)."""
SAME = 1e-6
"""Distance of the nodes, and of the durations, below which two orbits are the same."""


def searched_branches(
    model: Rotor,
    along: Axis,
    limits: tuple[float, float],
    impacts: int,
    singles: Sequence[OrbitBranch],
    *,
    virtual: bool,
    tell: Reporter,
) -> tuple[tuple[OrbitBranch, ...], Searched]:
    """Branches of orbits with two up to a number of impacts a period, and what was searched.

    They are born in period doublings of known branches, or meet them where an impact grazes or vanishes, or friction begins to stop
    the slip; or they pass through orbits that a search finds at evenly spaced values, and orbits found at one value are
    followed to all others.  What a search does not come near to is missing.

    Parameters
    ----------
    singles : sequence of OrbitBranch
        Branches of the orbits with one impact a period.
    virtual : bool
        Follow them among virtual orbits to any distance from a motion.
    """
    found: list[OrbitBranch] = []

    def add(branch: OrbitBranch) -> None:
        number = 1 + sum(known.impacts == branch.impacts for known in found)
        found.append(renamed(branch, CountedName(branch.impacts, number)))
        leave(branch.special)

    def leave(points: Sequence[Bifurcation]) -> None:
        """Follow the branches that begin at special points of another."""
        for point in points:
            if not (virtual or point.admissible) or not _begins_another(point, impacts, [*singles, *found]):
                continue
            try:
                branch = switch(point, limits, virtual=virtual)
            except CaromError:
                continue
            if isinstance(branch, OrbitBranch):
                add(branch)

    for single in singles:
        leave(single.special)
    done: list[Searched] = []
    for place, value in enumerate(np.linspace(*limits, VALUES).tolist()):
        rotor = along.move(model, value)
        search = Search(rotor, impacts, _known(rotor, value, [*singles, *found]))
        part = tell.part(place / VALUES, (place + 1) / VALUES)
        done.append(search.run(SETTLED, GUESSES, FRESH, [0, place], part))
        for orbit in search.found:
            wanted = isinstance(orbit, Orbit) and orbit.admissible and orbit.impacts >= 2
            if wanted and not any(lies_on(orbit, value, branch) for branch in found):
                add(continue_orbit(orbit, along.name, limits, virtual=virtual))
    return tuple(found), reduce(Searched.and_then, done)


def _begins_another(point: Bifurcation, most: int, known: Sequence[OrbitBranch]) -> bool:
    """Whether a branch of orbits with so many impacts begins at a special point, which is not known."""
    if point.kind == "period-doubling":
        return 2 * point.orbit.impacts <= most and not any(_begins_at(branch, point) for branch in known)
    if point.kind not in BORDERS:
        return False
    try:
        word, start = BORDERS[point.kind](point.orbit)
    except CaromError:
        return False
    other = orbit_near(point.orbit.rotor, word, start) if 2 <= len(word) <= most else None
    return other is not None and not any(lies_on(other, point.value, branch) for branch in known)


def _known(rotor: Rotor, value: float, branches: Sequence[OrbitBranch]) -> list[Orbit]:
    """Orbits of known branches at a value of the parameter."""
    starts = ((branch, start) for branch in branches for start in branch.starts_at(value, rotor))
    orbits = (orbit_near(rotor, branch.word, start) for branch, start in starts)
    return [orbit for orbit in orbits if orbit is not None and orbit.admissible]


def lies_on(orbit: Orbit, value: float, branch: OrbitBranch) -> bool:
    """Whether a branch passes through an orbit, whichever impact either of them begins with."""
    turns = [orbit.start.turned(places) for places in orbit.word.turns_to(branch.word)]
    for start in branch.starts_at(value, orbit.rotor) if turns else ():
        for turned in turns:
            apart = np.abs(pack(turned) - pack(start)).max()
            if apart < SAME * (1.0 + float(np.abs(turned.nodes).max())):
                return True
    return False


def _begins_at(branch: OrbitBranch, point: Bifurcation) -> bool:
    """Whether a branch is born in a period doubling."""
    return any(
        end.kind == HALVING
        and branch.impacts == 2 * point.orbit.impacts
        and abs(end.value - point.value) < SAME * (1.0 + abs(point.value))
        and abs(end.orbit.period - 2.0 * point.orbit.period) < 1e-2 * end.orbit.period
        for end in branch.special
    )
