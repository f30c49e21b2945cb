"""``carom regions``: where motions appear, vanish and change, in a plane of two parameters."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from carom.cli import options
from carom.cli.options import option
from carom.cli.output import hand_over, write_output
from carom.cli.terminal import check_output, console, progress, read_machine

if TYPE_CHECKING:
    from rich.console import Console

    from carom.bifurcations import RegionMap
    from carom.models import Axis

NODES = option("N", "Number of grid points per axis that determine the regions.", default=24, min=2, max=400)
AROUND = (0.25, 2.5)
"""Default range of a parameter, relative to its present value."""
_NAMED = {"non-smooth-hopf": "non-smooth Hopf", "neimark-sacker": "Neimark-Sacker"}
"""Names of bifurcations that keep hyphens or capitals."""


def regions(
    machine: str = options.MACHINE,
    plane: str | None = options.PLANE,
    x: str | None = options.FIRST_RANGE,
    y: str | None = options.SECOND_RANGE,
    settings: list[str] | None = options.SETTINGS,
    grid: int = NODES,
    out: str | None = options.OUT,
    as_json: bool = options.AS_JSON,
) -> None:
    """Map the plane of two parameters: curves of bifurcations, their meeting points, and the regions between them.

    Curves are followed from the bifurcations found on the two lines through the present machine, and from every change
    of motions between neighbouring points of the grid.  Changes that no curve explains are listed.  Of machines whose
    orbits have no closed forms, curves are those through the bifurcations of a short search, and the regions are told by where disturbances
    settle.
    """
    case = read_machine(machine, settings)
    with progress("loading") as tell:
        from carom.basins.gains import usual_gains
        from carom.bifurcations import Plane, map_regions
        from carom.bifurcations.documents import regions_document
        from carom.cli.starts import read_plane
        from carom.models import rotor_of
        from carom.models.axes import usual_range

        model = rotor_of(case)
        subject = model.parameters if model.has_closed_forms else model
        usual = ",".join(usual_gains(model)) if model.scales else "gamma,omega"
        axes, given, _ = read_plane(case, "--plane", plane or usual, x, y)
        ranges = [
            limits or usual_range(varied, subject.value(varied.name), name, AROUND)
            for varied, limits, name in zip(axes, given, ("--x", "--y"), strict=True)
        ]
        check_output(out)
        found = map_regions(
            subject,
            Plane(axes[0].name, axes[1].name, *ranges),
            grid=grid,
            progress=tell,
        )
        document, name = regions_document(found), f"regions-{axes[0].name}-{axes[1].name}"
        write_output(out, case, name, document, {name: found.plot})
    hand_over(out, document, as_json, lambda: _print_map(console(), found))


def named(kind: str) -> str:
    """Return the kind of a bifurcation in words."""
    return _NAMED.get(kind, kind.replace("-", " "))


def _print_map(screen: Console, found: RegionMap) -> None:
    """Print the curves of a map, their meeting points, the regions, and in which of them the machine lies."""
    from carom.cli.fitting import print_table

    names = tuple(map(quantity, found.axes))
    screen.print(f"Plane of {' and '.join(axis.field.words for axis in found.axes)}")
    screen.print()
    if not found.curves and found.model.has_closed_forms:
        screen.print("No bifurcation in this plane.")
    for title, headings, rows, styles in _tables(found, names):
        if rows:
            print_table(screen, title, headings, rows, styles=styles)
    if found.everywhere:
        screen.print(f"In every region: {', '.join(found.everywhere)}")
    screen.print(_present_words(found))
    for words in found.lost:
        screen.print(f"Not followed: {words}" if found.model.has_closed_forms else words)


def _tables(
    found: RegionMap, names: tuple[str, ...]
) -> Iterator[tuple[str, tuple[str, ...], list[tuple[str, ...]], list[str]]]:
    """Title, headings, rows and styles of each table."""
    from carom.bifurcations.planes import EDGE
    from carom.parameters.formats import format_quantity

    rows, styles, at = [], [], f"at {', '.join(names)}"
    for curve in found.curves:
        ends = [_place(found, curve.points[end]) for end in (0, -1)]
        virtual = "" if curve.admissible.all() else "in part virtual" if curve.admissible.any() else "virtual"
        stops = ", ".join(dict.fromkeys(named(stop) for stop in curve.stops if stop != EDGE))
        rows.append((named(curve.kind), curve.subject, *ends, stops, virtual))
        styles.append("dim" if virtual == "virtual" else "")
    yield (
        "Curves",
        ("bifurcation", "of", f"from {', '.join(names)}", "to", "ends before the edge of the plane", "possible"),
        rows,
        styles,
    )
    rows = []
    for point in found.codimension2:
        scales = found.plane.at(found.model.parameters, *point.value).scales
        period = "" if point.period != point.period else format_quantity(point.period, "time", scales, 6)
        place = (f"{value:.8g}" for value in _usual(found, point.value))
        rows.append((" + ".join(map(named, point.kinds)), *place, period, "" if point.admissible else "virtual"))
    yield "Codimension-2 points and resonances", ("kinds", *names, "period", "possible"), rows, []
    rows = []
    for number, region in enumerate(found.regions, start=1):
        share = f"{100 * region.share:.1f} %" if region.share else "thin"
        own = ", ".join(part for part in region.motions.parts if part not in found.everywhere)
        rows.append((str(number), share, _place(found, region.point), region.motions.region, own))
    yield "Regions", ("#", "share", f"for example {at}", "region", "motions"), rows, []
    rows = [(_place(found, change.point), change.words, change.reason) for change in found.unexplained]
    yield "Changes of motions that no curve explains", (at, "what changes", "why no curve"), rows, []


def _place(found: RegionMap, point: Sequence[float]) -> str:
    return ", ".join(f"{value:.6g}" for value in _usual(found, point))


def _usual(found: RegionMap, point: Sequence[float]) -> list[float]:
    """Return a point of the plane in the units of the headings."""
    return [axis.field.in_usual_unit(value) for axis, value in zip(found.axes, point, strict=True)]


def quantity(varied: Axis) -> str:
    """Return the name of a parameter with its unit."""
    return f"{varied.name} ({varied.field.usual_unit})" if varied.field.usual_unit else varied.name


def _present_words(found: RegionMap) -> str:
    """Say in one sentence in which region the machine lies."""
    words = ", ".join(part for part in found.present_motions.parts if part not in found.everywhere)
    if found.present is None:
        return f"This machine lies outside the plane: {found.present_motions.words}"
    place = ", ".join(
        f"{axis.name} = {value:.6g} {axis.field.usual_unit}".rstrip()
        for axis, value in zip(found.axes, _usual(found, found.present), strict=True)
    )
    return f"This machine, {place}, lies in region {found.present_region} ({words})"
