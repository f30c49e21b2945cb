"""Regions of a plane of two parameters in which the same motions coexist, and the curves between them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from carom.base.arguments import Count, checked
from carom.base.outcome import CaromError
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result
from carom.bifurcations.cells import Region, regions_between, settled_cells
from carom.bifurcations.changes import UnexplainedChange
from carom.bifurcations.curve_results import Codimension2Point, Curve, passes, with_curve
from carom.bifurcations.curves import can_be_followed, continue_curve
from carom.bifurcations.diagrams import special_points
from carom.bifurcations.motions import STARTS, Motions, motions_at
from carom.bifurcations.planes import Plane
from carom.bifurcations.survey import Survey
from carom.models import Axis, Rotor, Subject, rotor_of
from carom.orbits.flow import FlowBudget
from carom.orbits.names import OrbitName, combined

SAME_POINT, SAME_PERIOD = 1e-6, 1e-5
"""Distance in widths of the plane, and relative difference of periods, below which codimension-2 points are the same."""

EVENTS, DIAGRAM_EVENTS, CURVE_EVENTS = 6e6, 6e5, 1.8e6
"""Simulated events after which no further point of the grid is examined; those of each of both diagrams, and of all curves together."""


@dataclass(frozen=True, eq=False, repr=False)
class RegionMap(Result):
    """Curves, codimension-2 points and regions of a plane.

    Attributes
    ----------
    model : Rotor
        The machine itself.
    plane : Plane
    axes : tuple of Axis
        The two parameters of the plane.
    curves : tuple of Curve
    regions : tuple of Region
        Largest first.
    present : tuple of float or None
        Place of the machine itself; ``None`` if it lies outside the plane.
    present_motions : Motions
        Motions of the machine.
    unexplained : tuple of UnexplainedChange
        Changes of motions between neighbouring points of the grid that lie on none of the curves.
    lost : tuple of str
        Curves that could not be followed, each with the reason.
    """

    figure: ClassVar[str] = "region_map"
    shown: ClassVar[tuple[str, ...]] = ("plane", "curves", "regions", "present_motions", "unexplained", "lost")

    model: Rotor
    plane: Plane
    axes: tuple[Axis, Axis]
    curves: tuple[Curve, ...]
    regions: tuple[Region, ...]
    present: tuple[float, float] | None
    present_motions: Motions
    unexplained: tuple[UnexplainedChange, ...] = ()
    lost: tuple[str, ...] = ()

    @property
    def everywhere(self) -> tuple[str, ...]:
        """Motions that are the same in every region, in words."""
        if not self.regions:
            return ()
        first, *others = (region.motions.parts for region in self.regions)
        return tuple(part for part in first if all(part in parts for parts in others))

    @checked
    def orbits_of(self, kind: str) -> str:
        """Orbits that the curves of a kind belong to, such as ``"B1,b/d, B2,b"``; empty for equilibria."""
        names = {name for curve in self.curves if curve.kind == kind for name in curve.orbits}
        return combined(name for name in names if isinstance(name, OrbitName))

    @property
    def present_region(self) -> int | None:
        """Number of the region that the machine is in, counted from 1; ``None`` outside the plane."""
        if self.present is None:
            return None
        here = np.array(self.present) / self.plane.widths

        def distance(number: int) -> float:
            places = self.regions[number - 1].places / self.plane.widths
            return float(np.linalg.norm(places - here, axis=1).min())

        numbers = [n for n, region in enumerate(self.regions, start=1) if region.motions == self.present_motions]
        return min(numbers, key=distance, default=None)

    @property
    def codimension2(self) -> tuple[Codimension2Point, ...]:
        """Points where two or more curves meet, each listed once with all its kinds.

        A non-smooth Hopf bifurcation is a boundary equilibrium with orbits, and its points are treated as such.
        """
        found: list[Codimension2Point] = []
        ordered = sorted(self.curves, key=lambda curve: curve.kind == "non-smooth-hopf")
        for point in (point for curve in ordered for point in curve.codimension2):
            for i, other in enumerate(found):
                if self._same(point, other):
                    real = other.admissible or point.admissible
                    found[i] = replace(other, kinds=_joined(other, point), admissible=real)
                    break
            else:
                found.append(point)
        return tuple(found)

    def _same(self, point: Codimension2Point, other: Codimension2Point) -> bool:
        """Whether two points are at the same place and have the same kinds, or belong to the same orbit.

        A resonance is never merged with a point of other kinds: it may lie next to a point where two folds meet.
        """
        alike = set(_parts(point)) == set(_parts(other))
        if not alike and (point.resonance or other.resonance):
            return False
        near = np.abs(np.subtract(point.value, other.value) / self.plane.widths).max() < SAME_POINT
        return bool(near and (alike or abs(point.period - other.period) < SAME_PERIOD * other.period))


def _parts(point: Codimension2Point) -> list[str]:
    """Kinds of a point, each once; a non-smooth Hopf bifurcation counts as a boundary equilibrium."""
    return list(dict.fromkeys({"non-smooth-hopf": "boundary-equilibrium"}.get(kind, kind) for kind in point.kinds))


def _joined(point: Codimension2Point, other: Codimension2Point) -> tuple[str, ...]:
    """Kinds of both points: those of the first, and those of the second that it lacks."""
    return *point.kinds, *(part for part in _parts(other) if part not in _parts(point))


@checked
@shows_progress
def map_regions(
    machine: Subject,
    plane: Plane,
    *,
    grid: Count = 24,
    virtual: bool = False,
    progress: ShowProgress = None,
) -> RegionMap:
    """Compute the map of a plane: the curves of bifurcations, and the regions between them.

    Curves start from the special points of the diagrams along both parameters through the present parameters (through
    the middle of the plane if they lie outside).  Further curves start from every change of motions between
    neighbouring points of the grid that no curve explains; there the bifurcation is found by bisection.  A change whose
    bifurcation cannot be followed is listed in ``unexplained``.  A region may be missed if it fits between the points
    of the grid and no curve from elsewhere enters it.

    Of machines whose orbits have no closed forms the special points are those of a diagram from a short search, and regions are stated by where
    disturbances settle.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    grid : int
        Number of grid points per side at which motions are counted.
    virtual : bool
        Follow bifurcations of virtual orbits too.

    Raises
    ------
    InputError
        Unknown parameters, or a range they cannot have.

    See Also
    --------
    carom.continue_curve : one curve
    carom.bifurcations.motions_at : the motions at a point

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> plane = cm.bifurcations.Plane("gamma", "omega", (0.09, 0.25), (0.74, 0.8))
    >>> regions = cm.map_regions(machine, plane, grid=4)
    >>> sorted({curve.kind for curve in regions.curves})
    ['boundary-equilibrium', 'fold', 'non-smooth-hopf']
    """
    model, budget = rotor_of(machine), FlowBudget(EVENTS)
    model.system.refuse_non_stationary()
    exact = model.has_closed_forms
    # Of a rotor with closed forms its parameters, which are moved faster.
    given: Any = model.parameters if exact else model
    axes = plane.axes(given)
    tell = Reporter.of(progress, "counting motions, following curves" if exact else "following disturbances")
    place = plane.place_of(given)
    inside = plane.holds(*place)
    base = given if inside else plane.at(given, *np.mean([plane.first_range, plane.second_range], axis=1).tolist())
    curves, lost = _on_two_lines(rotor_of(base), plane, virtual, tell)
    present, later = motions_at(given), tell.part(0.3, 1.0)
    if exact:
        survey = Survey(base, plane, curves)
        columns = survey.run(grid, later)
        curves, unexplained = survey.curves, tuple(survey.unexplained)
        if inside:
            survey.seen.setdefault(present, place)
        regions = regions_between(base, plane, columns, survey.seen)
    else:
        columns, examined = settled_cells(model, plane, grid, budget, later)
        regions, unexplained = regions_between(base, plane, columns, {}), ()
        lost += _remarks(grid, examined)
    return RegionMap(
        model=model,
        plane=plane,
        axes=axes,
        curves=tuple(curves),
        regions=regions,
        present=place if inside else None,
        present_motions=present,
        unexplained=unexplained,
        lost=tuple(lost),
    )


def _remarks(grid: int, examined: int) -> list[str]:
    """What is said of regions that are known by where disturbances settle."""
    settled = f"Regions are named after the motions in which {STARTS} disturbances at each of {examined} points settle"
    words = [f"{settled}; curves are followed only from special points of orbits on two lines of the plane."]
    if examined < grid**2:
        words.append(
            f"{grid**2 - examined} points of the grid were not reached within {EVENTS:.0e} events; each counts as its nearest."
        )
    return words


def _on_two_lines(rotor: Rotor, plane: Plane, virtual: bool, tell: Reporter) -> tuple[list[Curve], list[str]]:
    """Curves through the special points on the two lines of a plane through a rotor, and which of them could not be followed."""
    curves, lost, budget = list[Curve](), list[str](), FlowBudget(CURVE_EVENTS, binding=True)
    for share, name, interval in ((0.15, plane.first, plane.first_range), (0.3, plane.second, plane.second_range)):
        allowed = FlowBudget(DIAGRAM_EVENTS, binding=True)
        for point in special_points(rotor, name, interval, allowed, virtual=virtual):
            wanted = can_be_followed(point) and (virtual or point.admissible)
            if not wanted or any(passes(curve, point) for curve in curves):
                continue
            try:
                curves = with_curve(curves, continue_curve(point, plane, budget=budget))
            except CaromError as problem:
                lost.append(f"{point.kind} of {point.name} at {point.parameter} = {point.value:.6g}: {problem}")
        tell(share)
    return curves, lost
