"""``carom drop``: what a drop asks of the touchdown bearing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from carom.cli.terminal import AsJson, MachineFile, Settings, check_output, console, print_document, progress

if TYPE_CHECKING:
    from rich.console import Console

    from carom.studies.drops import DropStudy


def drop(
    machine: MachineFile,
    settings: Settings = None,
    start: Annotated[
        str | None,
        typer.Option(
            metavar="RE,IM,VRE,VIM",
            help="Position and velocity at the release in place of levitation, co-rotating frame; in c_r and c_r Omega, or with units.",
        ),
    ] = None,
    kick: Annotated[
        str | None,
        typer.Option(
            metavar="SPEED[,ANGLE]", help="Released by a velocity kick out of levitation, such as '50 mm/s,30 deg'."
        ),
    ] = None,
    whirl: Annotated[
        str | None,
        typer.Option(
            metavar="RADIUS,SPEED[,ANGLE]",
            help="Released from a whirl about the centre, such as '0.1 mm,-80 Hz,30 deg': its speed (below 0: backward) and where it "
            "is, in the fixed frame.",
        ),
    ] = None,
    phase: Annotated[
        str | None,
        typer.Option(
            metavar="ANGLE",
            help="Angle from the direction of the fall to the unbalance at the release, in the sense of rotation, such as '90 deg'; "
            "by default that of the machine.",
        ),
    ] = None,
    race_speed: Annotated[
        str | None,
        typer.Option(
            metavar="SPEED", help="Speed of the race at the release, such as '500 rpm'; by default it stands still."
        ),
    ] = None,
    regained_after: Annotated[
        str | None,
        typer.Option(metavar="T", help="Time after which levitation is back, such as '50 ms'; by default never."),
    ] = None,
    until: Annotated[
        str | None,
        typer.Option(
            metavar="T",
            help="Follow the drop to this time, such as '200 ms'; by default until it is known where it ends.",
        ),
    ] = None,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help="Write figures, drop.json and drop.html to this directory.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Drop a machine on its touchdown bearing: forces, depth, heat, whirl and race, against its limits.

    Levitation is lost, and the rotor falls by its weight; the machine needs [gravity]. With --out it also writes figures, drop.json and
    drop.html. `carom simulate --drop` logs every contact of the same motion.
    """
    from carom.cli.drops import read_drop
    from carom.cli.starts import read_time
    from carom.parameters import load

    case = load(machine, settings or ())
    check_output(out)
    with progress("simulating (the kernels are compiled on first use)") as tell:
        options = {"--start": start, "--kick": kick, "--whirl": whirl}
        rotor, state, echo = read_drop(
            case, options, regained_after, phase=phase, race_speed=race_speed, called="the release"
        )
        end = None if until is None else read_time(until, case.parameters.scales)
        from carom.motions.simulation import simulate as follow
        from carom.studies.drops import DropStudy

        motion = follow(rotor, state, end, progress=tell if out is None else tell.part(0.0, 0.4))
        found, page = DropStudy(case, echo, motion), None
        if out is not None:
            from carom.report import write_drop_report

            page = write_drop_report(found, out, progress=tell.part(0.4, 1.0))
    if as_json:
        print_document(found.document())
        if page is not None:
            console(errors=True).print(f"Report: {page}", soft_wrap=True)
        return
    _print(console(), found, page)


def _print(console: Console, found: DropStudy, page: Path | None) -> None:
    """Print what was done, how it ended, the loads of each plane, and the limits."""
    from rich.table import Table
    from rich.text import Text

    from carom.cli.tables import TEXT_WIDTH

    width = min(console.width, TEXT_WIDTH)
    console.print(f"{found.echo.words}.", width=width)
    console.print(Text(found.headline, style="bold"), width=width)
    for title, rows in found.tables:
        console.print()
        if title:
            console.print(Text(title, style="bold"))
        table = Table.grid(padding=(0, 2, 0, 0))
        table.add_column(no_wrap=True)
        table.add_column()
        for label, told in rows:
            table.add_row(Text(f"  {label}"), Text(told))
        console.print(table, width=width)
    if found.checks:
        console.print()
        console.print(Text("Limits of the touchdown bearing", style="bold"))
        for check in found.checks:
            console.print(Text(f"  {check.words}", style="bold" if check.exceeded else ""), width=width)
    console.print()
    if page is None:
        console.print("Figures, drop.json and drop.html: add --out DIR")
    else:
        console.print(f"Report: {page}", soft_wrap=True)
