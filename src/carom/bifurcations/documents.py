"""What people see of diagrams and maps: the columns of their tables, and plain data for JSON, where unknown or non-finite numbers are ``null``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any

from carom.attractors import exact_interval
from carom.base.outcome import STEADY_WORDS
from carom.base.results import Column, keys_of, record
from carom.bifurcations.branches import OrbitBranch
from carom.bifurcations.curve_results import Codimension2Point, Curve
from carom.bifurcations.diagrams import Diagram
from carom.bifurcations.planes import EDGE
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.regions import RegionMap
from carom.bifurcations.simulated import SimulatedBranch
from carom.models.axes import Axis
from carom.orbits.orbit import Orbit
from carom.orbits.searched import Searched
from carom.parameters.formats import format_quantity, number

_NAMED = {"non-smooth-hopf": "non-smooth Hopf", "neimark-sacker": "Neimark-Sacker"}
"""Names of bifurcations that keep hyphens or capitals."""


def kind_words(kind: str) -> str:
    """The kind of a bifurcation in words."""
    return _NAMED.get(kind, kind.replace("-", " "))


def _period_of_point(point: Bifurcation, diagram: Diagram) -> str:
    """In the unit of the machine there."""
    return "" if point.period != point.period else number(float(diagram.stated("time", point.value, point.period)), 8)


def _speed(point: Bifurcation, diagram: Diagram) -> str:
    """With six decimals in units of the equations, with four in mm/s: where an orbit shrinks to a point it vanishes but for rounding."""
    if point.radial_speed != point.radial_speed:
        return ""
    decimals, speed = 6 if diagram.model.scales is None else 4, diagram.shown_speeds(point.value, point.radial_speed)
    return f"{round(float(speed), decimals) + 0.0:.{decimals}f}"


def _possible(entry: Any, _: object) -> str:
    return "" if entry.admissible else "virtual"


def _place(found: RegionMap, point: Sequence[float]) -> str:
    """A point of the plane, in the units of its headings."""
    pairs = zip(found.axes, point, strict=True)
    return ", ".join(f"{axis.field.in_usual_unit(value):.6g}" for axis, value in pairs)


def _coordinate(place: int) -> Callable[[Codimension2Point, RegionMap], str]:
    return lambda point, found: f"{found.axes[place].field.in_usual_unit(point.value[place]):.8g}"


def _curve_possible(curve: Curve, _: RegionMap) -> str:
    return "" if curve.admissible.all() else "partly virtual" if curve.admissible.any() else "virtual"


def _period(point: Codimension2Point, found: RegionMap) -> str:
    scales = found.plane.at(found.model.parameters, *point.value).scales
    return "" if point.period != point.period else format_quantity(point.period, "time", scales, 6)


POINT = (
    Column("value", "{0.parameter}", lambda point, found: f"{found.axis.field.in_usual_unit(point.value):.10g}"),
    Column("kind", "event", lambda point, _: kind_words(point.kind)),
    Column("branch=name", "motion", lambda point, _: STEADY_WORDS.get(point.name, point.name)),
    Column("parameter"),
    Column("period", "period ({0.time_unit})", _period_of_point),
    Column("radial_speed", "radial speed ({0.speed_unit})", _speed),
    Column("admissible", "possible", _possible),
    Column("detail", "details"),
)
BRANCH = "values period admissible stable ends=stops"
CURVE = (
    Column("kind", "bifurcation", lambda curve, _: kind_words(curve.kind)),
    Column("orbits", "motion", lambda curve, _: curve.subject),
    Column(
        "points", "from {0.axes[0].heading}, {0.axes[1].heading}", lambda curve, found: _place(found, curve.points[0])
    ),
    Column("", "to", lambda curve, found: _place(found, curve.points[-1])),
    Column(
        "ends=stops",
        "ends before the edge of the plane",
        lambda curve, _: ", ".join(dict.fromkeys(kind_words(stop) for stop in curve.stops if stop != EDGE)),
    ),
    Column("periods"),
    Column("radial_speeds"),
    Column("admissible", "possible", _curve_possible),
)
CODIMENSION2 = (
    Column("kind", "kinds", lambda point, _: " + ".join(map(kind_words, point.kinds))),
    Column("value", "{0.axes[0].heading}", _coordinate(0)),
    Column("", "{0.axes[1].heading}", _coordinate(1)),
    Column("period", "period", _period),
    Column("radial_speed"),
    Column("admissible", "possible", _possible),
)
REGION = (
    Column("", "#", lambda region, found: str(next(n for n, each in enumerate(found.regions, 1) if each is region))),
    Column("share", "share", lambda region, _: f"{100 * region.share:.1f} %" if region.share else "thin"),
    Column(
        "point",
        "for example at {0.axes[0].heading}, {0.axes[1].heading}",
        lambda region, found: _place(found, region.point),
    ),
    Column("", "region", lambda region, _: region.motions.region),
    Column(
        "",
        "motions",
        lambda region, found: ", ".join(part for part in region.motions.parts if part not in found.everywhere),
    ),
)
CHANGE = (
    Column("point", "at {0.axes[0].heading}, {0.axes[1].heading}", lambda change, found: _place(found, change.point)),
    Column("", "change", lambda change, _: change.words),
    Column("reason", "why there is no curve"),
    Column("before=before.words"),
    Column("after=after.words"),
)
MOTIONS = (
    "name=region words contact_free orbits stable_orbits stable_orbit_names=stable_names unstable_orbit_names=unstable_names "
    "rub rolling source_region"
)


def diagram_document(diagram: Diagram) -> dict[str, object]:
    """Special points and branches along a parameter.

    Values of a physical parameter are in the SI unit given under ``"unit"``; periods are in ``1/Ω``, radial speeds in
    ``c_r Ω``.
    """
    return {
        **diagram.model.document(),
        **_axis(diagram.axis),
        **record(diagram, "interval"),
        "points": [
            record(point, keys_of(POINT)) | _word(point.orbit if point.motion in ("orbit", "rubbing") else None)
            for point in diagram.points
        ],
        "branches": [record(branch, f"names {BRANCH} radial_speed") for branch in diagram.orbits],
        "several": [record(branch, f"name {BRANCH} radial_speeds") | _word(branch) for branch in diagram.several],
        "search": None if diagram.search is None else search_document(diagram.search),
        "equilibria": [
            record(each, "kind values radius normal_force admissible stable") for each in diagram.equilibria
        ],
        "rolling": record(diagram.rolling, "values largest_force holds"),
    }


def search_document(searched: Searched) -> dict[str, object]:
    """How much a search for orbits has tried, and the share of fresh motions that end on the orbits listed, with its interval of 95 %."""
    return {
        **asdict(searched),
        "share_on_listed": [searched.share_on_listed, *exact_interval(searched.on_listed, searched.fresh)],
    }


def regions_document(found: RegionMap) -> dict[str, object]:
    """Curves, points where two bifurcations meet, and regions of a plane of two parameters.

    Regions are numbered as in the figure and the table.
    """
    plane = found.plane
    first, second = found.axes
    return {
        **found.model.document(),
        "plane": [
            _axis(first) | {"range": list(plane.first_range)},
            _axis(second) | {"range": list(plane.second_range)},
        ],
        "curves": [record(curve, keys_of(CURVE)) for curve in found.curves],
        "codim2": [record(point, keys_of(CODIMENSION2)) for point in found.codimension2],
        "regions": [
            {"number": number, **record(region.motions, MOTIONS), **record(region, keys_of(REGION))}
            for number, region in enumerate(found.regions, start=1)
        ],
        "present": {
            "point": list(plane.place_of(found.model)),
            "region": found.present_region,
            "words": found.present_motions.words,
        },
        "unexplained": [record(change, keys_of(CHANGE)) for change in found.unexplained],
        **record(found, "everywhere lost"),
    }


def _word(orbit: Orbit | OrbitBranch | SimulatedBranch | None) -> dict[str, object]:
    """Word and number of impacts of an orbit, without those of a chatter; ``None`` for other motions."""
    return {"word": str(orbit.word) if orbit else None, "impacts": orbit.impacts if orbit else None}


def _axis(axis: Axis) -> dict[str, object]:
    return {"parameter": axis.name, "unit": axis.field.unit}
