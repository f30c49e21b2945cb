"""Branches of orbits with several impacts a period, for diagrams: from period doublings, and from a search at some values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.points import HALVING, Bifurcation
from carom.bifurcations.words import continue_orbit, renamed, switched
from carom.models import Model
from carom.models.axes import Axis
from carom.motions.starts import State
from carom.orbits.names import CountedName
from carom.orbits.orbit import Orbit
from carom.orbits.search import orbits_of_several_impacts, random_start
from carom.orbits.shooting import Start, pack_free
from carom.outcome import CaromError
from carom.progress import Reporter

VALUES = 9
"""Number of values of the parameter at which orbits are searched."""
STARTS = 12
"""Number of random starts at each; motions from beside the known orbits are looked through too."""
BESIDE = 1e-3
"""Relative change of the velocity of a start beside an orbit."""
SAME = 1e-6
"""Distance of the nodes, and of the durations, below which two orbits are the same."""


def several_impacts(
    model: Model,
    along: Axis,
    limits: tuple[float, float],
    impacts: int,
    singles: Sequence[OrbitBranch],
    *,
    virtual: bool,
    tell: Reporter,
) -> tuple[OrbitBranch, ...]:
    """Branches of orbits with 2 up to a number of impacts a period.

    They are born in period doublings of known branches, or pass through orbits that a search finds at evenly spaced
    values.  What a search does not come near to is missing.

    Parameters
    ----------
    impacts : int
    singles : sequence of OrbitBranch
        Branches of orbits with one impact a period.
    virtual : bool
        Follow them among virtual orbits to any distance from a motion.
    """
    found: list[OrbitBranch] = []

    def add(branch: OrbitBranch) -> None:
        number = 1 + sum(known.impacts == branch.impacts for known in found)
        found.append(renamed(branch, CountedName(branch.impacts, number)))
        follow_doublings(branch.special)

    def follow_doublings(points: Sequence[Bifurcation]) -> None:
        for point in points:
            if point.kind != "period-doubling" or 2 * point.orbit.impacts > impacts:
                continue
            if any(_begins_at(branch, point) for branch in found) or not (virtual or point.admissible):
                continue
            try:
                add(switched(point.kind, point.orbit, along.name, limits, virtual=virtual))
            except CaromError:
                continue

    for single in singles:
        follow_doublings(single.special)
    for done, value in enumerate(np.linspace(*limits, VALUES).tolist()):
        rotor = along.move(model, value)
        for orbit in orbits_of_several_impacts(rotor, impacts, _starts(rotor, value, singles, found)):
            if not any(lies_on(orbit, value, branch) for branch in found):
                add(continue_orbit(orbit, along.name, limits, virtual=virtual))
        tell((done + 1) / VALUES)
    return tuple(found)


def _starts(
    rotor: Model, value: float, singles: Sequence[OrbitBranch], found: Sequence[OrbitBranch]
) -> Iterator[State]:
    """States beside the known orbits at a value of the parameter, then random ones."""
    known: list[OrbitBranch] = [*singles, *found]
    for branch in known:
        nearest = int(np.argmin(np.abs(branch.values - value)))
        if branch.admissible[nearest]:
            before = branch.orbits[nearest].departure
            yield State(before.position, before.velocity * (1.0 + BESIDE))
    random = np.random.default_rng(0)
    for _ in range(STARTS):
        yield random_start(rotor, random)


def lies_on(orbit: Orbit, value: float, branch: OrbitBranch) -> bool:
    """Whether a branch passes through an orbit, whichever impact either of them begins with."""
    turns = [k for k in range(len(orbit.word)) if orbit.word.turned(k) == branch.word]
    if len(orbit.word) != len(branch.word) or not turns:
        return False
    for start in branch.starts_at(value, orbit.rotor):
        for k in turns:
            turned = Start(np.roll(orbit.nodes, -k, axis=0), np.roll(orbit.durations, -k))
            apart = np.abs(pack_free(branch.word, turned) - pack_free(branch.word, start)).max()
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
