"""``carom drop``: what a drop asks of the touchdown bearing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from carom.cli import release_options as options
from carom.cli.terminal import AsJson, MachineFile, Settings, check_output, console, print_document, progress

if TYPE_CHECKING:
    from rich.console import Console

    from carom.motions.drops import Drop
    from carom.motions.loads import DropLoads
    from carom.motions.reduction_errors import ReductionError
    from carom.parameters import Case
    from carom.studies.drops import DropStudy

_DRAWN = 20_000
"""Impacts and steps of contact that are drawn: figures need them all at once."""


def drop(
    machine: MachineFile,
    settings: Settings = None,
    start: options.ReleaseStart = None,
    kick: options.ReleaseKick = None,
    whirl: options.ReleaseWhirl = None,
    phase: options.Phase = None,
    race_speed: options.RaceSpeed = None,
    regained_after: options.RegainedAfter = None,
    until: options.DropUntil = None,
    plane: options.Mapped = None,
    grid: options.Grid = None,
    x: options.FirstRange = None,
    y: options.SecondRange = None,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help="Write figures, drop.json and drop.html to this directory.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Drop a machine on its touchdown bearing: forces, depth, heat, whirl and race, against its limits.

    Levitation is lost, and the rotor falls by its weight: by [gravity], or by 9.81 m/s² downward, which the bias currents carry before. With --out it also writes
    figures, drop.json and drop.html. `carom simulate --drop` logs every contact of the same motion. With --map it is dropped at many points of a plane.
    """
    from carom.cli.drop_map import map_plane, read_plane
    from carom.cli.drops import read_release
    from carom.cli.starts import read_time
    from carom.loading import load

    case = load(machine, settings or ())
    check_output(out)
    ways = {"--start": start, "--kick": kick, "--whirl": whirl}
    released = read_release(case, ways, regained_after, phase=phase, race_speed=race_speed, called="the release")
    asked = read_plane(case, plane, grid, x, y)
    end = None if until is None else read_time(until, case.parameters.scales)
    if asked is not None:
        map_plane(case, released, asked, end, out, as_json=as_json)
    else:
        _drop_once(case, released, end, out, as_json=as_json)


def _drop_once(case: Case, released: Drop, end: float | None, out: str | None, *, as_json: bool) -> None:
    """Follow one drop, write its report, and tell what the bearing bears."""
    from carom.studies.drops import release

    with progress("simulating (the kernels are compiled on first use)") as tell:
        rotor, state, echo = release(case, released)
        from carom.motions import follow_loads, simulate
        from carom.studies.drops import DropStudy

        loads = follow_loads(rotor, state, end, progress=tell if out is None else tell.part(0.0, 0.4))
        found, page = DropStudy(case, echo, loads, _reduction(case, released, loads)), None
        if out is not None:
            from carom.report import write_drop_report

            motion = simulate(rotor, state, end, settle=True, max_events=_DRAWN)
            page = write_drop_report(found, motion, out, progress=tell.part(0.4, 1.0))
    if as_json:
        print_document(found.document())
        if page is not None:
            console(errors=True).print(f"Report: {page}", soft_wrap=True)
        return
    _print(console(), found, page)


def _reduction(case: Case, released: Drop, loads: DropLoads) -> ReductionError | None:
    """Error of the reduction of a flexible machine along this drop."""
    from carom.cli.drops import error_along
    from carom.studies.drops import release

    return error_along(case, loads, lambda finer: release(finer, released))


def _print(console: Console, found: DropStudy, page: Path | None) -> None:
    """Print what was done, how it ended, the loads of each plane, and the limits."""
    from rich.text import Text

    from carom.cli.load_tables import print_checks, print_tables
    from carom.cli.tables import TEXT_WIDTH

    width = min(console.width, TEXT_WIDTH)
    console.print(f"{found.echo.words}.", width=width)
    console.print(Text(found.headline, style="bold"), width=width)
    print_tables(console, found.tables)
    print_checks(console, found.checks)
    for each in (found.loads.magnets, found.reduction):
        if each is not None and each.words:
            console.print()
            console.print(each.words, width=width)
    console.print()
    if page is None:
        console.print("Figures, drop.json and drop.html: add --out DIR")
    else:
        console.print(f"Report: {page}", soft_wrap=True)
