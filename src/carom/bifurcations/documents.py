"""Diagrams and maps as plain data for JSON; unknown or non-finite numbers are written as ``null``."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from carom.attractors import DisturbanceSet, document_of, exact_interval
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.diagrams import Diagram
from carom.bifurcations.regions import RegionMap
from carom.bifurcations.simulated import SimulatedBranch
from carom.models.axes import Axis
from carom.motions.settling import PATIENCE
from carom.orbits.orbit import Orbit
from carom.orbits.searched import Searched
from carom.parameters import Scales
from carom.results import fields_of


def diagram_document(diagram: Diagram) -> dict[str, Any]:
    """Special points and branches along a parameter.

    Values of a physical parameter are in the SI unit given under ``"unit"``; periods are in ``1/Ω``, radial speeds in
    ``c_r Ω``.
    """
    return {
        **diagram.model.document(),
        **_axis(diagram.axis),
        **fields_of(diagram, "interval"),
        "points": [
            fields_of(point, "kind", branch="name")
            | fields_of(point, "parameter", "value", "period", "radial_speed", "admissible", "detail")
            | _word(point.orbit if point.motion in ("orbit", "rubbing") else None)
            for point in diagram.points
        ],
        "branches": [
            fields_of(branch, "names", "values", "period", "radial_speed", "admissible", "stable", ends="stops")
            for branch in diagram.orbits
        ],
        "several": [
            fields_of(branch, "name", "values", "period", "radial_speeds", "admissible", "stable", ends="stops")
            | _word(branch)
            for branch in diagram.several
        ],
        "search": None if diagram.search is None else search_document(diagram.search),
        "equilibria": [
            fields_of(branch, "kind", "values", "radius", "normal_force", "admissible", "stable")
            for branch in diagram.equilibria
        ],
        "rolling": fields_of(diagram.rolling, "values", "largest_force", "holds"),
        "attractors": [
            fields_of(
                sample, "value", "name", "outcome", "whirl", "count", "share", "radial_speeds", known_starts="known"
            )
            | document_of(sample.survival)
            for sample in diagram.attractors
        ],
        "disturbances": _disturbances(diagram.disturbances, diagram.model.scales) if diagram.disturbances else None,
    }


def search_document(searched: Searched) -> dict[str, Any]:
    """How much a search for orbits has tried, and the share of fresh motions that end on the orbits listed, with its interval of 95 %."""
    return {
        **fields_of(searched, *(each.name for each in fields(searched))),
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
        "curves": [
            fields_of(curve, "kind", "orbits", "points", "periods", "radial_speeds", "admissible", ends="stops")
            for curve in found.curves
        ],
        "codim2": [
            fields_of(point, "kind", "value", "period", "radial_speed", "admissible") for point in found.codimension2
        ],
        "regions": [
            {"number": number}
            | fields_of(region.motions, "words", "contact_free", "orbits", "stable_orbits", name="region")
            | fields_of(region.motions, stable_orbit_names="stable_names", unstable_orbit_names="unstable_names")
            | fields_of(region.motions, "rub", "rolling", "source_region")
            | fields_of(region, "point", "share")
            for number, region in enumerate(found.regions, start=1)
        ],
        "present": {
            "point": list(plane.place_of(found.model)),
            "region": found.present_region,
            "words": found.present_motions.words,
        },
        "unexplained": [
            fields_of(change, "point", "reason") | {"before": change.before.words, "after": change.after.words}
            for change in found.unexplained
        ],
        **fields_of(found, "everywhere", "lost"),
    }


def _word(orbit: Orbit | OrbitBranch | SimulatedBranch | None) -> dict[str, Any]:
    """Word and number of impacts of an orbit, without those of a chatter; ``None`` for other motions."""
    return {"word": str(orbit.word) if orbit else None, "impacts": orbit.impacts if orbit else None}


def _axis(axis: Axis) -> dict[str, Any]:
    return {"parameter": axis.name, "unit": axis.field.unit}


def _disturbances(tried: DisturbanceSet, scales: Scales | None) -> dict[str, Any]:
    words = {"words": tried.general_words(scales), "patience": PATIENCE}
    return fields_of(tried, "count", "seed", "fastest") | words
