"""``carom regions``: where motions appear, vanish and change, in a plane of two parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.cli import options
from carom.cli.options import option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine, write_output

if TYPE_CHECKING:
    from rich.console import Console

    from carom.bifurcations import RegionMap

NODES = option("N", "Grid points per axis used to determine the regions.", default=24, min=2, max=400)
USUAL_RANGE = (0.25, 2.5)
"""Default range of a parameter, relative to its present value."""


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
    """Map a plane of two parameters: bifurcation curves, codimension-2 points, and the regions between them.

    Curves are followed from the bifurcations found on the two lines through the present machine, and from every change
    of motions between neighbouring points of the grid.  Changes that no curve explains are listed.  For machines whose
    orbits have no closed form, curves start from the bifurcations that a short search finds, and regions are named after the motions
    in which disturbances settle.
    """
    case = read_machine(machine, settings)
    with progress("loading") as tell:
        from carom.basins.maps import usual_gains
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
            limits or usual_range(varied, subject.value(varied.name), name, USUAL_RANGE)
            for varied, limits, name in zip(axes, given, ("--x", "--y"), strict=True)
        ]
        check_output(out)
        found = map_regions(subject, Plane(axes[0].name, axes[1].name, *ranges), grid=grid, progress=tell)
        name = f"regions-{axes[0].name}-{axes[1].name}"
        write_output(out, case, name, lambda: regions_document(found), {name: found.plot})
    hand_over(lambda: regions_document(found), as_json, lambda: _print_map(console(), found), out)


def _print_map(screen: Console, found: RegionMap) -> None:
    """Print the curves of a map, their meeting points, the regions, and in which of them the machine lies."""
    from carom.base.results import table_of
    from carom.bifurcations.documents import CHANGE, CODIMENSION2, CURVE, REGION
    from carom.cli.screen import print_table

    screen.print(f"Plane of {' and '.join(axis.field.words for axis in found.axes)}")
    screen.print()
    if not found.curves and found.model.has_closed_forms:
        screen.print("No bifurcation in this plane.")
    styles = ["" if curve.admissible.any() else "dim" for curve in found.curves]
    if found.curves:
        print_table(screen, "Curves", *table_of(CURVE, found.curves, found), styles=styles)
    others = (
        ("Codimension-2 points and resonances", CODIMENSION2, found.codimension2),
        ("Regions", REGION, found.regions),
        ("Changes of motions that no curve explains", CHANGE, found.unexplained),
    )
    for title, columns, entries in others:
        if entries:
            print_table(screen, title, *table_of(columns, entries, found))
    if found.everywhere:
        screen.print(f"In every region: {', '.join(found.everywhere)}")
    screen.print(_present_words(found))
    for words in found.lost:
        screen.print(f"Not followed: {words}" if found.model.has_closed_forms else words)


def _present_words(found: RegionMap) -> str:
    """Say in one sentence in which region the machine lies."""
    words = ", ".join(part for part in found.present_motions.parts if part not in found.everywhere)
    if found.present is None:
        return f"This machine lies outside the plane: {found.present_motions.words}"
    place = ", ".join(
        f"{axis.name} = {axis.field.in_usual_unit(value):.6g} {axis.field.usual_unit}".rstrip()
        for axis, value in zip(found.axes, found.present, strict=True)
    )
    return f"This machine, {place}, lies in region {found.present_region} ({words})"
