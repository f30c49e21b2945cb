"""``carom basins``: where disturbances end, and which gains bring back more of them."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

from carom.cli import basin_options as options
from carom.cli.output import output_directory, say_where
from carom.cli.terminal import AsJson, MachineFile, Out, Settings, check_output, console, print_document, progress

if TYPE_CHECKING:
    from carom.basins import GainChange, GainMap
    from carom.disturbances import Plan
    from carom.models import Rotor
    from carom.progress import Reporter


def basins(
    machine: MachineFile,
    settings: Settings = None,
    disturbance: options.Kind = "kick",
    grid: options.Cells = None,
    instant: options.Instant = None,
    starts: options.Starts = None,
    seed: options.Seed = None,
    fastest: options.Fastest = None,
    peak: options.Peak = None,
    duration: options.Duration = None,
    change: options.Change = None,
    node: options.Node = None,
    release: options.Release = None,
    gains: options.GainsWanted = None,
    plane: options.Plane = None,
    x: options.FirstRange = None,
    y: options.SecondRange = None,
    wanted: options.Wanted = None,
    out: Out = None,
    as_json: AsJson = False,
) -> None:
    """Find where disturbances go: what share comes back, the smallest that does not, and the gains that help.

    Every start is followed to where it settles. Values need units, such as '50 mm/s', unless the machine file is
    dimensionless. With --gains the share that comes back is mapped against P and D gain, or any two parameters.
    """
    with progress("loading") as tell:
        from carom.loading import load

        case = load(machine, settings or ())
        sizes = {
            "fastest": fastest,
            "peak": peak,
            "duration": duration,
            "change": change,
            "node": node,
            "release": release,
        }
        plan = options.at_instant(options.read_plan(case, disturbance, sizes, grid, starts, seed), instant, case)
        asked = options.read_gains(case, gains, plane, x, y, wanted)
        check_output(out)
        source = _source(machine, settings)
        from carom.basins import map_basins, smallest_loss
        from carom.basins.document import basin_document
        from carom.basins.families import has_sizes
        from carom.closed_forms import harmless_kick
        from carom.models import rotor_of

        rotor, share = rotor_of(case), 0.45 if asked is None else 0.2
        step = tell.part(0.0, share, f"following {plan.count} starts")
        basin = map_basins(rotor, plan, source=source, progress=step)
        harmless, smallest = harmless_kick(rotor), None
        if harmless > 0.0 and has_sizes(plan.model):
            smallest = smallest_loss(rotor, plan.model, progress=tell.part(share, 2.0 * share))
        found, least = (None, None) if asked is None else _map(rotor, plan, asked, source, tell)
        if found is None or asked is None:
            document = basin_document(basin, smallest, harmless)
        else:
            document = basin_document(basin, smallest, harmless, found, least, asked.wanted, asked.told_by)
        if out is not None:
            tell(0.97, "drawing")
            with output_directory(out, case) as output:
                output.figure("basins", basin.plot(smallest))
                basin.save(output.directory / "basins.nc")
                if found is not None and asked is not None:
                    output.figure("gain-map", found.plot(least, told_by=asked.told_by))
                    found.save(output.directory / "gains.nc")
                output.document("basins", document)
    if as_json:
        print_document(document)
    else:
        from carom.cli.basin_tables import print_basin, print_gains

        print_basin(console(), basin, smallest, harmless)
        if found is not None and asked is not None:
            print_gains(console(), found, least, asked.wanted, asked.told_by)
    say_where(out)


def _map(
    rotor: Rotor, plan: Plan, asked: options.Gains, source: dict[str, str], tell: Reporter
) -> tuple[GainMap, GainChange | None]:
    from carom.basins import least_gain_change, map_gains

    found = map_gains(
        rotor,
        plan,
        asked.names,
        ranges=asked.ranges,
        shape=asked.shape,
        source=source,
        progress=tell.part(0.33, 0.9),
    )
    if not all(found.present):
        return found, None
    return found, least_gain_change(found, asked.wanted, progress=tell.part(0.9, 0.97))


def _source(machine: str, settings: list[str] | None) -> dict[str, str]:
    """Describe where the machine comes from."""
    text = Path(machine).read_bytes()
    return {
        "machine_file": Path(machine).name,
        "machine_file_sha256": hashlib.sha256(text).hexdigest(),
        "machine_text": text.decode("utf-8", "replace"),
        "settings": "; ".join(settings or ()),
    }
