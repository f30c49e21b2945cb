"""What ``carom regions`` prints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from carom.cli.fitting import fitted, plain_table

if TYPE_CHECKING:
    from carom.bifurcations import RegionMap
    from carom.models import Axis

_NAMED = {"non-smooth-hopf": "non-smooth Hopf", "neimark-sacker": "Neimark-Sacker"}
"""Names of bifurcations that keep hyphens or capitals."""


def named(kind: str) -> str:
    """Return the kind of a bifurcation in words."""
    return _NAMED.get(kind, kind.replace("-", " "))


def print_map(screen: Console, found: RegionMap) -> None:
    """Print the curves of a map, their meeting points, the regions, and in which of them the machine lies."""
    names = tuple(map(_quantity, found.axes))
    first, second = (f"{axis.field.words} {name}" for axis, name in zip(found.axes, names, strict=True))
    screen.print(f"Plane of {first} and {second}")
    if not found.curves and found.model.has_closed_forms:
        screen.print("No bifurcation in this plane.")
    for table in _tables(found, names):
        if table.row_count:
            screen.print(fitted(screen, table))
    if found.everywhere:
        screen.print(f"In every region: {', '.join(found.everywhere)}")
    screen.print(_present_words(found))
    for words in found.lost:
        screen.print(f"Not followed: {words}" if found.model.has_closed_forms else words)


def _tables(found: RegionMap, names: tuple[str, ...]) -> Iterator[Table]:
    table = plain_table("Curves", "bifurcation", "of", f"from {', '.join(names)}", "to", "ends", "")
    for curve in found.curves:
        ends = [_place(found, curve.points[end]) for end in (0, -1)]
        virtual = "" if curve.admissible.all() else "in part virtual" if curve.admissible.any() else "virtual"
        stops = ", ".join(dict.fromkeys(map(named, curve.stops)))
        style = "dim" if virtual == "virtual" else ""
        table.add_row(named(curve.kind), curve.subject, *ends, stops, virtual, style=style)
    yield table
    table = plain_table("Where two happen at once, and resonances", "kinds", *names, "period (1/Ω)", "")
    for point in found.codimension2:
        kinds = " + ".join(map(named, point.kinds))
        period = "" if point.period != point.period else f"{point.period:.6g}"
        table.add_row(
            kinds,
            *(f"{value:.8g}" for value in _usual(found, point.value)),
            period,
            "" if point.admissible else "virtual",
        )
    yield table
    headings = ("#", "share", f"for example at {', '.join(names)}", "region", "motions")
    table = plain_table("Regions", *headings, no_wrap=headings[:2])
    for number, region in enumerate(found.regions, start=1):
        share = f"{100 * region.share:.1f} %" if region.share else "thin"
        own = ", ".join(part for part in region.motions.parts if part not in found.everywhere)
        table.add_row(str(number), share, _place(found, region.point), region.motions.region, own)
    yield table
    at = f"at {', '.join(names)}"
    table = plain_table("Changes of motions on no curve found", at, "what changes", "why no curve")
    for change in found.unexplained:
        table.add_row(_place(found, change.point), change.words, change.reason)
    yield table


def _place(found: RegionMap, point: Sequence[float]) -> str:
    return ", ".join(f"{value:.6g}" for value in _usual(found, point))


def _usual(found: RegionMap, point: Sequence[float]) -> list[float]:
    """Return a point of the plane in the units of the headings."""
    return [axis.field.in_usual_unit(value) for axis, value in zip(found.axes, point, strict=True)]


def _quantity(varied: Axis) -> str:
    """Return the name of a parameter with its unit."""
    return f"{varied.name} ({varied.field.usual_unit})" if varied.field.usual_unit else varied.name


def _present_words(found: RegionMap) -> str:
    """Say in one sentence in which region the machine lies."""
    words = ", ".join(part for part in found.present_motions.parts if part not in found.everywhere)
    if found.present is None:
        return f"The machine as it is lies outside this plane: {found.present_motions.words}"
    place = ", ".join(
        f"{axis.name} = {value:.6g} {axis.field.usual_unit}".rstrip()
        for axis, value in zip(found.axes, _usual(found, found.present), strict=True)
    )
    return f"The machine as it is, {place}: region {found.present_region} ({words})"
