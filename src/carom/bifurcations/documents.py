"""Diagrams and maps as plain data for JSON; unknown or non-finite numbers are written as ``null``."""

from __future__ import annotations

from typing import Any

from carom.attractors import DisturbanceSet, document_of
from carom.bifurcations.axes import Axis, Numbers
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.diagrams import Diagram
from carom.bifurcations.regions import RegionMap
from carom.bifurcations.rubbing import RubbingBranch
from carom.bifurcations.samples import AttractorSample
from carom.bifurcations.steady import EquilibriumBranch
from carom.motions.settling import PATIENCE
from carom.parameters import Parameters

__all__ = ["diagram_document", "regions_document"]


def diagram_document(parameters: Parameters, diagram: Diagram) -> dict[str, Any]:
    """Special points and branches along a parameter.

    Values of a physical parameter are in the SI unit given under ``"unit"``; periods are in ``1/Ω``, radial speeds in
    ``c_r Ω``.
    """
    return {
        "parameters": parameters.as_dict(),
        **_axis("parameter", diagram.axis),
        "interval": list(diagram.interval),
        "points": [
            {
                "kind": point.kind,
                "branch": point.name,
                "parameter": point.parameter,
                "value": point.value,
                "period": point.period,
                "radial_speed": point.radial_speed,
                "admissible": point.admissible,
                "detail": point.detail,
            }
            for point in diagram.points
        ],
        "branches": [_orbit_branch(branch) for branch in diagram.orbits],
        "equilibria": [_equilibrium_branch(branch) for branch in diagram.equilibria],
        "rolling": {
            "values": diagram.rolling.values.tolist(),
            "largest_force": diagram.rolling.largest_force.tolist(),
            "holds": diagram.rolling.holds.tolist(),
        },
        "rubbing": [_rubbing_branch(branch) for branch in diagram.rubbing],
        "attractors": [_attractor(sample) for sample in diagram.attractors],
        "disturbances": _disturbances(diagram.disturbances) if diagram.disturbances else None,
    }


def regions_document(parameters: Parameters, found: RegionMap) -> dict[str, Any]:
    """Curves, points where two bifurcations meet, and regions of a plane of two parameters.

    Regions are numbered as in the figure and the table.
    """
    plane = found.plane
    first, second = plane.axes(parameters)
    return {
        "parameters": parameters.as_dict(),
        "plane": [
            {**_axis("parameter", axis), "range": list(limits)}
            for axis, limits in ((first, plane.first_range), (second, plane.second_range))
        ],
        "curves": [
            {
                "kind": curve.kind,
                "orbits": list(curve.orbits),
                "points": curve.points.tolist(),
                "periods": curve.periods.tolist(),
                "radial_speeds": curve.radial_speeds.tolist(),
                "admissible": curve.admissible.tolist(),
                "ends": list(curve.stops),
            }
            for curve in found.curves
        ],
        "codim2": [
            {
                "kind": point.kind,
                "value": list(point.value),
                "period": point.period,
                "radial_speed": point.radial_speed,
                "admissible": point.admissible,
            }
            for point in found.codimension2
        ],
        "regions": [
            {
                "number": number,
                "name": region.motions.region,
                "words": region.motions.words,
                "contact_free": region.motions.contact_free,
                "orbits": region.motions.orbits,
                "stable_orbits": region.motions.stable_orbits,
                "stable_orbit_names": list(region.motions.stable_names),
                "unstable_orbit_names": list(region.motions.unstable_names),
                "rub": region.motions.rub,
                "rolling": region.motions.rolling,
                "source_region": region.motions.source_region,
                "point": list(region.point),
                "share": region.share,
            }
            for number, region in enumerate(found.regions, start=1)
        ],
        "present": {
            "point": list(plane.place_of(Numbers.of(parameters))),
            "region": found.present_region,
            "words": found.present_motions.words,
        },
        "unexplained": [
            {
                "point": list(change.point),
                "before": change.before.words,
                "after": change.after.words,
                "reason": change.reason,
            }
            for change in found.unexplained
        ],
        "everywhere": list(found.everywhere),
        "lost": list(found.lost),
    }


def _axis(key: str, axis: Axis) -> dict[str, Any]:
    return {key: axis.name, "unit": axis.field.unit}


def _orbit_branch(branch: OrbitBranch) -> dict[str, Any]:
    return {
        "names": list(branch.names),
        "values": branch.values.tolist(),
        "period": branch.period.tolist(),
        "radial_speed": branch.radial_speed.tolist(),
        "admissible": branch.admissible.tolist(),
        "stable": branch.stable.tolist(),
        "ends": list(branch.stops),
    }


def _equilibrium_branch(branch: EquilibriumBranch) -> dict[str, Any]:
    return {
        "kind": branch.kind,
        "values": branch.values.tolist(),
        "radius": branch.radius.tolist(),
        "normal_force": branch.normal_force.tolist(),
        "admissible": branch.admissible.tolist(),
        "stable": branch.stable.tolist(),
    }


def _rubbing_branch(branch: RubbingBranch) -> dict[str, Any]:
    return {
        "whirl": "forward" if branch.whirl > 0 else "backward",
        "values": branch.values.tolist(),
        "lift_off_angle": branch.angle.tolist(),
        "period": branch.period.tolist(),
        "impacts": branch.impacts.tolist(),
        "contact_time": branch.contact_time.tolist(),
        "landing_force": branch.landing_force.tolist(),
        "multiplier": branch.multiplier.tolist(),
        "stable": branch.stable.tolist(),
        "ends": list(branch.stops),
    }


def _disturbances(tried: DisturbanceSet) -> dict[str, Any]:
    return {
        "count": tried.count,
        "seed": tried.seed,
        "fastest": tried.fastest,
        "patience": PATIENCE,
        "words": tried.general_words,
    }


def _attractor(sample: AttractorSample) -> dict[str, Any]:
    return {
        "value": sample.value,
        "name": sample.name,
        "outcome": sample.outcome,
        "whirl": sample.whirl,
        "count": sample.count,
        "share": sample.share,
        "known_starts": sample.known,
        "radial_speeds": sample.radial_speeds.tolist(),
        **document_of(sample.survival),
    }
