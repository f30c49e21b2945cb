"""Bifurcation diagrams: all steady motions and single-impact orbits along one parameter, optionally orbits with several impacts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result, in_a_line
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.followed import EVENTS, Followed
from carom.bifurcations.points import HALVING, Bifurcation
from carom.bifurcations.steady import (
    EquilibriumBranch,
    RollingBranch,
    equilibrium_branches,
    levitation_along,
    rolling_branch,
    steady_points,
)
from carom.bifurcations.words import continue_orbit
from carom.models import Rotor, Subject, rotor_of
from carom.models.axes import Axis, Ends, axis, read_interval
from carom.orbits.flow import FlowBudget
from carom.orbits.orbit import Orbit
from carom.orbits.search import Impacts
from carom.orbits.searched import Searched
from carom.orbits.single_impact import find_orbits
from carom.parameters.formats import shown_in
from carom.parameters.scaling import SCALING

SAMPLES = 13
"""Number of values of the parameter at which all orbits are searched."""
SINGLE_SHARE = 0.2
"""Fraction of the progress for orbits with one impact, if others are searched too."""
LONGEST_PERIOD = 60.0
"""Longest period searched, in ``1/Ω``, where damping is so weak that there would be hundreds of pairs."""


@dataclass(frozen=True, eq=False, repr=False)
class Diagram(Result):
    """Equilibria and orbits along one parameter; of the planar rotor all with one impact a period.

    Attributes
    ----------
    model : Rotor
    axis : Axis
        The parameter.
    interval : tuple of float
    equilibria : tuple of EquilibriumBranch
    rolling : RollingBranch
    orbits : tuple of OrbitBranch
        Orbits with one impact a period: all of the planar rotor, those that a search finds of other models.
    several : tuple of OrbitBranch
        Orbits with several impacts a period that a search and special points of other branches lead to; empty unless asked for.
    search : Searched or None
        How much was searched for them; of other models than the planar rotor also for those with one.
    points : tuple of Bifurcation
        In ascending order of the parameter.
    """

    figure: ClassVar[str] = "bifurcation_diagram"

    model: Rotor
    axis: Axis
    interval: tuple[float, float]
    equilibria: tuple[EquilibriumBranch, ...]
    rolling: RollingBranch
    # Not narrower: branches of orbits closed on the flow of the simulator are of another class.
    orbits: tuple[Any, ...]
    several: tuple[Any, ...]
    search: Searched | None
    points: tuple[Bifurcation, ...]

    def rows(self) -> list[tuple[str, str]]:
        """The motions, and each special point."""
        low, high = self.interval
        names = dict.fromkeys(name for branch in self.branches for name in branch.names)
        field = self.axis.field
        unit = f" {field.usual_unit}".rstrip()
        ends = f"from {field.in_usual_unit(low):.6g} to {field.in_usual_unit(high):.6g}{unit}"
        found = [
            (f"{field.in_usual_unit(each.value):.6g}{unit}", f"{each.kind}, {STEADY_WORDS.get(each.name, each.name)}")
            for each in self.points
        ]
        return [(self.parameter, ends), ("orbits", in_a_line(tuple(names))), *found]

    @property
    def branches(self) -> list[Any]:
        """Branches of orbits with one impact a period, then those of orbits with several."""
        return [*self.orbits, *self.several]

    @property
    def speed_unit(self) -> str:
        """Unit in which people see speeds: mm/s where the machine is known."""
        return shown_in("velocity", self.model.scales)[1]

    @property
    def time_unit(self) -> str:
        """Unit in which people see periods."""
        return shown_in("time", self.model.scales)[1]

    def shown_speeds(self, values: np.ndarray | float, speeds: np.ndarray | float) -> np.ndarray:
        """Speeds in this unit, from those in ``c_r Ω`` of the machines that have these values of the parameter."""
        return self.stated("velocity", values, speeds)

    def stated(self, kind: str, values: np.ndarray | float, sizes: np.ndarray | float) -> np.ndarray:
        """Sizes in the unit in which people see them, from units of the equations of the machines with these values.

        The kind is a property of :class:`~carom.parameters.Scales`.
        """
        scales = self.model.scales
        factor, _ = shown_in(kind, scales)
        ratio: np.ndarray | float = 1.0
        if scales is not None and self.parameter in SCALING:
            # Every unit is a product of powers of the three, so a doubled scale shows the power.
            doubled = replace(scales, **{self.parameter: 2.0 * getattr(scales, self.parameter)})
            power = np.log2(getattr(doubled, kind) / getattr(scales, kind))
            ratio = (np.asarray(values) / self.axis.value(self.model)) ** np.round(power)
        return np.asarray(factor * ratio * np.asarray(sizes))

    @property
    def parameter(self) -> str:
        """Name of the parameter."""
        return self.axis.name


@checked
@shows_progress
def find_bifurcations(
    machine: Subject,
    parameter: str,
    interval: Ends,
    *,
    impacts: Impacts = 1,
    virtual: bool = False,
    progress: ShowProgress = None,
) -> Diagram:
    """Find the branches of motions on an interval of a parameter, and their special points.

    All single-impact orbits are computed (:func:`~carom.orbits.single_impact.find_orbits`) at 13 evenly spaced values.
    Each orbit that does not lie on a known branch is continued in both directions.

    Of other machines than the planar rotor in a rigid bearing orbits have no closed form: they are searched at 3 values and followed on the
    flow of the simulator, and some may be missing.  Rolling and special points of rubs are left out there; where levitation is lost is
    a point of kind ``"levitation-lost"``, found between the values of ``equilibria[0]``.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    parameter : str
        Dimensionless or physical name.
    interval : tuple of float or str
        In SI units if the parameter is physical; text has a unit, ``("300 N s/m", "2000 N s/m")``.
    impacts : int
        Follow orbits with at most so many impacts a period: those that begin at special points of others, and those that a search
        at 9 values finds.  Unlike the orbits with one impact, some with several may be missing.
    virtual : bool
        Follow all orbits, including those of higher pairs that are virtual at all of these values.

    Raises
    ------
    InputError
        Empty interval, unknown parameter, values out of the range of the parameter, ``impacts`` that is no whole
        number from 1 to 64.

    See Also
    --------
    carom.continue_orbit : one orbit only
    carom.map_regions : in the plane of two parameters

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> diagram = cm.find_bifurcations(machine, "gamma", (0.09, 0.2))
    >>> [point.kind for point in diagram.points if point.name == "B1,d"]
    ['fold']
    """
    model = rotor_of(machine)
    model.system.refuse_non_stationary()
    along = axis(model, parameter)
    limits = read_interval(along, interval)
    tell = Reporter.of(progress, "following motions")
    orbits, several, search = _branches(model, along, limits, tell, impacts, virtual=virtual)
    equilibria, rolling = equilibrium_branches(model, along, limits), rolling_branch(model, along, limits)
    points = _points(model, along, limits, [*orbits, *several])
    if not model.has_closed_forms:
        held, lost = levitation_along(model, along, limits)
        equilibria, points = (held, *equilibria[1:]), sorted([*points, *lost], key=lambda point: point.value)
    return Diagram(model, along, limits, equilibria, rolling, orbits, several, search, tuple(points))


def special_points(
    model: Rotor, parameter: str, interval: tuple[float, float], budget: FlowBudget, *, virtual: bool
) -> tuple[Bifurcation, ...]:
    """Special points of :func:`find_bifurcations`, in ascending order of the parameter; what a search of simulated motions may take is limited."""
    along = axis(model, parameter)
    orbits, several, _ = _branches(model, along, interval, Reporter(), budget=budget, virtual=virtual)
    return tuple(_points(model, along, interval, [*orbits, *several]))


def _points(model: Rotor, along: Axis, limits: tuple[float, float], branches: Sequence[Any]) -> list[Bifurcation]:
    """Special points of all motions; where a branch ends by halving its period, in a doubling of another, it is one point."""
    points = steady_points(model.parameters, along, limits) if model.has_closed_forms else []
    points += [point for branch in branches for point in branch.special if point.kind != HALVING]
    return sorted(points, key=lambda point: point.value)


def _branches(
    model: Rotor,
    along: Axis,
    limits: tuple[float, float],
    tell: Reporter,
    impacts: int = 1,
    *,
    budget: FlowBudget | None = None,
    virtual: bool,
) -> tuple[tuple[Any, ...], tuple[Any, ...], Searched | None]:
    """Branches of orbits with one impact a period, those of others, and what was searched."""
    budget = budget or FlowBudget(EVENTS)
    if not model.has_closed_forms:
        followed = Followed(along, limits, impacts, (), virtual, budget)
        search = followed.run(model, tell)
        single = tuple(branch for branch in followed.found if branch.impacts == 1)
        return single, tuple(branch for branch in followed.found if branch.impacts != 1), search
    branches: list[OrbitBranch] = []
    part = tell.part(0.0, 1.0 if impacts == 1 else SINGLE_SHARE)
    for done, value in enumerate(np.linspace(*limits, SAMPLES).tolist()):
        for orbit in _orbits(along.move(model, value)):
            wanted = virtual or orbit.admissible or orbit.name.pair == 1
            if wanted and not any(branch.passes(orbit, value) for branch in branches):
                branches.append(continue_orbit(orbit, along.name, limits))
        part((done + 1) / SAMPLES)
    if impacts == 1:
        return tuple(branches), (), None
    followed = Followed(along, limits, impacts, branches, virtual, budget)
    search = followed.run(model, tell.part(SINGLE_SHARE, 1.0))
    return tuple(branches), tuple(followed.found), search


def _orbits(rotor: Rotor) -> Iterator[Orbit]:
    """Orbits with forward slip; none without damping, where there are infinitely many."""
    at = rotor.parameters
    if at.gamma > 0.0 and at.rho > 0.0:
        longest = LONGEST_PERIOD if at.gamma < 0.05 else None
        yield from (orbit for orbit in find_orbits(rotor, longest) if orbit.slip > 0)
