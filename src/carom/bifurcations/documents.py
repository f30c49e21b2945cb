"""Diagrams and maps as plain data for JSON; unknown or non-finite numbers are written as ``null``."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from carom.attractors import exact_interval
from carom.base.results import record
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.diagrams import Diagram
from carom.bifurcations.regions import RegionMap
from carom.bifurcations.simulated import SimulatedBranch
from carom.models.axes import Axis
from carom.orbits.orbit import Orbit
from carom.orbits.searched import Searched

POINT = "kind branch=name parameter value period radial_speed admissible detail"
BRANCH = "values period admissible stable ends=stops"
CURVE = "kind orbits points periods radial_speeds admissible ends=stops"
MOTIONS = (
    "name=region words contact_free orbits stable_orbits stable_orbit_names=stable_names unstable_orbit_names=unstable_names "
    "rub rolling source_region"
)


def diagram_document(diagram: Diagram) -> dict[str, Any]:
    """Special points and branches along a parameter.

    Values of a physical parameter are in the SI unit given under ``"unit"``; periods are in ``1/Ω``, radial speeds in
    ``c_r Ω``.
    """
    return {
        **diagram.model.document(),
        **_axis(diagram.axis),
        **record(diagram, "interval"),
        "points": [
            record(point, POINT) | _word(point.orbit if point.motion in ("orbit", "rubbing") else None)
            for point in diagram.points
        ],
        "branches": [record(branch, f"names {BRANCH} radial_speed") for branch in diagram.orbits],
        "several": [record(branch, f"name {BRANCH} radial_speeds") | _word(branch) for branch in diagram.several],
        "search": None if diagram.search is None else search_document(diagram.search),
        "equilibria": [
            record(branch, "kind values radius normal_force admissible stable") for branch in diagram.equilibria
        ],
        "rolling": record(diagram.rolling, "values largest_force holds"),
    }


def search_document(searched: Searched) -> dict[str, Any]:
    """How much a search for orbits has tried, and the share of fresh motions that end on the orbits listed, with its interval of 95 %."""
    return {
        **asdict(searched),
        "share_on_listed": [searched.share_on_listed, *exact_interval(searched.on_listed, searched.fresh)],
    }


def regions_document(found: RegionMap) -> dict[str, Any]:
    """Curves, points where two bifurcations meet, and regions of a plane of two parameters.

    Regions are numbered as in the figure and the table.
    """
    plane = found.plane
    first, second = found.axes
    return {
        **found.model.document(),
        "plane": [
            {**_axis(axis), "range": list(limits)}
            for axis, limits in ((first, plane.first_range), (second, plane.second_range))
        ],
        "curves": [record(curve, CURVE) for curve in found.curves],
        "codim2": [record(point, "kind value period radial_speed admissible") for point in found.codimension2],
        "regions": [
            {"number": number, **record(region.motions, MOTIONS), **record(region, "point share")}
            for number, region in enumerate(found.regions, start=1)
        ],
        "present": {
            "point": list(plane.place_of(found.model)),
            "region": found.present_region,
            "words": found.present_motions.words,
        },
        "unexplained": [
            record(change, "point reason before=before.words after=after.words") for change in found.unexplained
        ],
        **record(found, "everywhere lost"),
    }


def _word(orbit: Orbit | OrbitBranch | SimulatedBranch | None) -> dict[str, Any]:
    """Word and number of impacts of an orbit, without those of a chatter; ``None`` for other motions."""
    return {"word": str(orbit.word) if orbit else None, "impacts": orbit.impacts if orbit else None}


def _axis(axis: Axis) -> dict[str, Any]:
    return {"parameter": axis.name, "unit": axis.field.unit}
