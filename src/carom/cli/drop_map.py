"""``carom drop --map``: drops over a plane of two numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from carom.cli.output import output_directory, say_where
from carom.cli.terminal import console, print_document, progress
from carom.outcome import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from carom.basins import DropMap
    from carom.motions.drops import Drop
    from carom.parameters import Case

CELLS = (24, 16)
MOST_CELLS = 100_000
"""Each takes some hundredths of a second to some seconds: more would be a typing error."""


@dataclass(frozen=True)
class Plane:
    """What is varied, over which ranges and with how many values."""

    names: tuple[str, str]
    ranges: tuple[Any, Any]
    shape: tuple[int, int]


def read_plane(case: Case, plane: str | None, grid: str | None, x: str | None, y: str | None) -> Plane | None:
    """Read the options of ``--map``; ``None`` without it, where the others are refused."""
    if plane is None:
        for option, given in {"--grid": grid, "--x": x, "--y": y}.items():
            if given is not None:
                raise InputError(option, given, "allowed only with --map NAME,NAME")
        return None
    from carom.basins.drops import RELEASED, varied_of
    from carom.cli.basin_options import read_cells
    from carom.cli.starts import read_range
    from carom.models import rotor_of
    from carom.parameters.fields import unknown_name

    names = [name.strip() for name in plane.split(",")]
    if len(names) != 2 or names[0] == names[1]:
        raise InputError("--map", plane, "must be two names with a comma between them, such as phase,speed")
    rotor = rotor_of(case)
    for name in names:
        if name not in (known := dict.fromkeys([*RELEASED, *rotor.varied])):
            raise InputError("--map", plane, f"{name}: {unknown_name(name, None, known, 'what can be varied').allowed}")
    axes = [varied_of(rotor, name) for name in names]
    ranges = [
        None if text is None else read_range(option, text, varied)
        for option, text, varied in zip(("--x", "--y"), (x, y), axes, strict=True)
    ]
    first, second = CELLS if grid is None else read_cells("--grid", grid, 2, least=2, most=MOST_CELLS)
    return Plane((axes[0].name, axes[1].name), (ranges[0], ranges[1]), (first, second))


def map_plane(case: Case, released: Drop, asked: Plane, end: float | None, out: str | None, *, as_json: bool) -> None:
    """Drop the machine over the plane, write figure, dataset and document, and tell how the drops end."""
    from carom.basins import map_drops
    from carom.basins.document import drop_map_document

    with progress("following drops (the kernels are compiled on first use)") as tell:
        found = map_drops(
            case,
            released,
            asked.names,
            ranges=asked.ranges,
            shape=asked.shape,
            until=end,
            progress=tell if out is None else tell.part(0.0, 0.95),
        )
        document = {"name": case.name, **drop_map_document(found)}
        if out is not None:
            with output_directory(out, case) as output:
                output.figure("drop-map", found.plot())
                found.save(output.directory / "drop-map.nc")
                output.document("drop-map", document)
    if as_json:
        print_document(document)
    else:
        _print(console(), found)
    say_where(out)


def _print(screen: Console, found: DropMap) -> None:
    """Print how the drops end, what they ask of the bearing, and how many exceed its limits."""
    from carom.basins.drops import MEASURES
    from carom.cli.fitting import fitted, plain_table
    from carom.parameters.load_limits import LIMIT_FIELDS, LoadLimits
    from carom.parameters.told import number

    index, exists = found.dataset["motion"].values, found.exists
    screen.print(f"Drops over {found.plane}: {' x '.join(map(str, exists.shape))}.")
    unit, words = MEASURES[found.hardest]
    most, when = f"{words} ({unit})", "at rest or whirling since (median)"
    table = plain_table("", "how they end", "drops", "share", most, when, right=("drops", "share", most, when))
    for name, share in found.fractions.items():
        here = index == found.motions.index(name)
        loads, since = (found.dataset[each].values[here] for each in (found.hardest, "settled_at"))
        known = sorted(since[~(since != since)].tolist())
        ends = [number(float(each), 3) for each in (loads.min(), loads.max())]
        told = f"{number(1e3 * known[len(known) // 2], 3)} ms" if known else ""
        table.add_row(name.words, str(int(here.sum())), f"{100.0 * share:.3g} %", " to ".join(ends), told)
    screen.print(fitted(screen, table))
    screen.print(f"Hardest: {found.worst}.")
    for load, limit in found.limits.items():
        over = int(found.exceeding(load).sum())
        said = f"exceeded by {over} of {int(exists.sum())}" if over else "kept by all"
        screen.print(f"Limit of {LIMIT_FIELDS[load].words}, {LoadLimits.told(load, limit)}: {said}.")
    if not exists.all():
        screen.print(f"{int((~exists).sum())} of {exists.size} machines cannot levitate, and are not dropped.")
