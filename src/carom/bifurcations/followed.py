"""Branches of orbits for diagrams: through what searches at some values find, and from special points of known branches."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Any

import numpy as np

from carom.base.outcome import CaromError
from carom.base.progress import Reporter
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.points import HALVING, Bifurcation
from carom.bifurcations.simulated import MOST_NUMBERS, STEPS, SimulatedBranch, continue_simulated, switch_simulated
from carom.bifurcations.word_equations import BORDERS
from carom.bifurcations.words import continue_orbit, renamed, switch
from carom.models import Rotor
from carom.models.axes import Axis
from carom.orbits.flow import Flow, FlowBudget
from carom.orbits.names import CountedName
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.search import OrbitSearch
from carom.orbits.searched import Searched
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.simulated_search import search_simulated

VALUES = 9
"""Number of values of the parameter at which words of impacts are searched."""
GUESSES, SETTLED, FRESH = 300, 1000, 300
"""Guesses at each value for each number of impacts, motions followed until they settle, and fresh ones (:class:`~carom.orbits.search.OrbitSearch`)."""
PLACES = (0.5, 0.15, 0.85)
"""Places of the range at which orbits of any machine are searched."""
SHARE, FIRST_SHARE, EVENTS = 0.2, 0.05, 3e6
"""Share of the usual search there, and of one for special points alone; events after which no further orbit is followed."""
FEW = replace(STEPS, largest=0.3, most_points=60)
"""Steps of simulated branches, of which there may be many."""
ALONE = "not followed"
SAME_POINT_RTOL = 1e-6
"""Distance from a period doubling below which a branch is born in it."""


@dataclass
class Followed:
    """Branches of orbits with at most a number of impacts a period along a parameter, each once.

    They are born in period doublings of known branches, or, as words of impacts, meet them where an impact grazes or vanishes, or friction begins to stop
    the slip; or they pass through orbits that a search finds at some values.  What a search does not come near to is missing.

    Attributes
    ----------
    singles : sequence of OrbitBranch
        Branches of the orbits that the closed form gives.
    virtual : bool
        Follow words among virtual orbits to any distance from a motion.
    budget : FlowBudget
        What simulated motions are paid from.
    """

    along: Axis
    limits: tuple[float, float]
    impacts: int
    singles: Sequence[OrbitBranch]
    virtual: bool
    budget: FlowBudget
    found: list[Any] = field(default_factory=list)

    @property
    def branches(self) -> list[Any]:
        """All known branches."""
        return [*self.singles, *self.found]

    def _numbered(self, name: CountedName) -> CountedName:
        """The name with the next number among those of its impacts and kind."""
        alike = sum(replace(branch.name, number=1) == replace(name, number=1) for branch in self.found)
        return replace(name, number=1 + alike)

    def follow(self, orbit: Orbit | SimulatedOrbit, value: float) -> None:
        """Follow an orbit that lies on no branch, and the branches that begin on its own."""
        if any(branch.passes(orbit, value) for branch in self.found):
            return
        if isinstance(orbit, Orbit):
            branch = continue_orbit(orbit, self.along.name, self.limits, virtual=self.virtual)
            self._add(renamed(branch, self._numbered(CountedName(orbit.impacts, 1))))
            return
        named = replace(orbit, name=self._numbered(orbit.name))
        # Where it cannot be followed the orbit is shown alone.
        shown = SimulatedBranch(self.along, named.name, orbit.rotor, np.array([value]), (named,), (), (ALONE, ALONE))
        if len(Flow.vector(orbit.start)) <= MOST_NUMBERS and not self.budget.spent:
            with suppress(CaromError):
                found = continue_simulated(named, self.along.name, self.limits, FEW, self.budget)
                shown = found if len(found) else shown
        self._add(shown)

    def _add(self, branch: OrbitBranch | SimulatedBranch) -> None:
        self.found.append(branch)
        self.leave(branch.special)

    def leave(self, points: Sequence[Bifurcation]) -> None:
        """Follow the branches that begin at special points of another."""
        for point in points:
            if (self.virtual or point.admissible) and self._begins_another(point):
                with suppress(CaromError):
                    self._switch(point)

    def _switch(self, point: Bifurcation) -> None:
        """Follow the branch that begins at a special point."""
        if not isinstance(point.shot, SimulatedOrbit):
            other: Any = switch(point, self.limits, virtual=self.virtual)
            self._add(renamed(other, self._numbered(CountedName(other.impacts, 1))))
            return
        branch = switch_simulated(point, self.limits, self.budget)
        middle = len(branch) // 2
        if not any(other.passes(branch.orbits[middle], float(branch.values[middle])) for other in self.found):
            self.found.append(renamed(branch, self._numbered(branch.name)))

    def _begins_another(self, point: Bifurcation) -> bool:
        """Whether a branch of orbits with so many impacts begins at a special point, which is not known."""
        if isinstance(point.shot, SimulatedOrbit):
            few = point.kind == "period-doubling" and 2 * point.orbit.impacts <= self.impacts
            return few and not self.budget.spent
        if point.kind == "period-doubling":
            few = 2 * point.orbit.impacts <= self.impacts
            return few and not any(_begins_at(each, point) for each in self.branches)
        if point.kind not in BORDERS:
            return False
        try:
            word, start = BORDERS[point.kind](point.orbit)
        except CaromError:
            return False
        other = orbit_near(point.orbit.rotor, word, start) if 2 <= len(word) <= self.impacts else None
        return other is not None and not any(branch.passes(other, point.value) for branch in self.branches)

    def known(self, rotor: Rotor, value: float) -> list[Orbit]:
        """Orbits of known branches at a value of the parameter, of words of impacts."""
        starts = ((branch, start) for branch in self.branches for start in branch.starts_at(value, rotor))
        orbits = (orbit_near(rotor, branch.word, start) for branch, start in starts)
        return [orbit for orbit in orbits if orbit is not None and orbit.admissible]

    def run(self, model: Rotor, tell: Reporter) -> Searched:
        """Follow what special points of the branches of the closed form and searches lead to; say what was searched.

        Orbits found at one value are followed to all others, those of rotors of very many states are not.  With a binding budget they are
        simulated at one value only.
        """
        for single in self.singles:
            self.leave(single.special)
        exact, brief, (low, high), done = model.has_closed_forms, self.budget.binding, self.limits, list[Searched]()
        values = np.linspace(low, high, VALUES).tolist()
        if not exact:
            # Branches of many numbers are not followed, and setting up their equations takes long.
            few = brief or 4 * len(model.system.rest) > MOST_NUMBERS
            values = [low + share * (high - low) for share in (PLACES[:1] if few else PLACES)]
        orbits: Sequence[Orbit | SimulatedOrbit]
        for place, value in enumerate(values):
            rotor, part = self.along.move(model, value), tell.part(place / len(values), (place + 1) / len(values))
            if exact:
                search = OrbitSearch(rotor, self.impacts, self.known(rotor, value))
                searched = search.run(SETTLED, GUESSES, FRESH, [0, place], part)
                words = [each for each in search.found if isinstance(each, Orbit)]
                orbits = [each for each in words if each.admissible and each.impacts >= 2]
            else:
                share = FIRST_SHARE if brief else SHARE
                orbits, searched = search_simulated(rotor, self.impacts, None, place, part, share)
            done.append(searched)
            for orbit in orbits:
                self.follow(orbit, value)
        return reduce(Searched.and_then, done)


def _begins_at(branch: OrbitBranch, point: Bifurcation) -> bool:
    """Whether a branch is born in a period doubling."""
    return any(
        end.kind == HALVING
        and branch.impacts == 2 * point.orbit.impacts
        and abs(end.value - point.value) < SAME_POINT_RTOL * (1.0 + abs(point.value))
        and abs(end.orbit.period - 2.0 * point.orbit.period) < 1e-2 * end.orbit.period
        for end in branch.special
    )
