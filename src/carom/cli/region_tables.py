"""The tables that ``carom regions`` prints."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rich.table import Table

from carom.cli.fitting import plain_table

if TYPE_CHECKING:
    from carom.bifurcations import RegionMap

Names = tuple[str, str]
"""Names of both parameters with their units."""


def _place(point: tuple[float, float]) -> str:
    return ", ".join(f"{value:.6g}" for value in point)


def curve_table(found: RegionMap, names: Names, named: Callable[[str], str]) -> Table:
    """Return the table of curves with their orbits; curves that only virtual orbits have are dim."""
    table = plain_table("Curves", "bifurcation", "of", f"from {', '.join(names)}", "to", "ends", "")
    for curve in found.curves:
        first, last = (_place(tuple(curve.points[end])) for end in (0, -1))
        virtual = "" if curve.admissible.all() else "in part virtual" if curve.admissible.any() else "virtual"
        ends = ", ".join(dict.fromkeys(named(stop) for stop in curve.stops))
        table.add_row(
            named(curve.kind), curve.subject, first, last, ends, virtual, style="dim" if virtual == "virtual" else ""
        )
    return table


def meeting_table(found: RegionMap, names: Names, named: Callable[[str], str]) -> Table:
    """Return the table of codimension-2 points."""
    table = plain_table("Where two happen at once, and resonances", "kinds", *names, "period (1/Ω)", "")
    for point in found.codimension2:
        kinds = " + ".join(named(kind) for kind in point.kinds)
        period = "" if point.period != point.period else f"{point.period:.6g}"
        table.add_row(kinds, *(f"{value:.8g}" for value in point.value), period, "" if point.admissible else "virtual")
    return table


def region_table(found: RegionMap, names: Names) -> Table:
    """Return the table of regions, with their numbers in figure and JSON."""
    table = plain_table(
        "Regions", "#", "share", f"for example at {', '.join(names)}", "region", "motions", no_wrap=("#", "share")
    )
    for number, region in enumerate(found.regions, start=1):
        words = ", ".join(part for part in region.motions.parts if part not in found.everywhere)
        share = f"{100 * region.share:.1f} %" if region.share else "thin"
        table.add_row(str(number), share, _place(region.point), region.motions.region, words)
    return table


def unexplained_table(found: RegionMap, names: Names) -> Table:
    """Return the table of changes of motions that lie on no curve."""
    table = plain_table(
        "Changes of motions on no curve found", f"at {', '.join(names)}", "what changes", "why no curve"
    )
    for change in found.unexplained:
        table.add_row(_place(change.point), change.words, change.reason)
    return table


def present_words(found: RegionMap) -> str:
    """Say in one sentence in which region the machine lies."""
    words = ", ".join(part for part in found.present_motions.parts if part not in found.everywhere)
    if found.present is None:
        return f"The machine as it is lies outside this plane: {found.present_motions.words}"
    place = ", ".join(
        f"{axis.name} = {value:.6g}" + (f" {axis.field.unit}" if axis.field.unit else "")
        for axis, value in zip(found.axes, found.present, strict=True)
    )
    return f"The machine as it is, {place}: region {found.present_region} ({words})"
