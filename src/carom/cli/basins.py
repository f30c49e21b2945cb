"""``carom basins``: where disturbances end, and which gains bring back more of them."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom.base.outcome import InputError
from carom.cli import options
from carom.cli.options import option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine, write_output

if TYPE_CHECKING:
    from collections.abc import Callable

    from carom.cli.terminal import Drawings
    from carom.disturbances import Disturbance, Plan
    from carom.parameters import Case

CELLS, RELEASES, STARTS = 60, 360, 10_000
MOST_STARTS = 5_000_000
"""More would not fit into the memory of a common computer; use a sweep for larger sets."""
_OTHERS = {
    "kick-plane": "SPEED",
    "state": "SPEED",
    "release": "fixed|rotating|rolling",
    "slice": "",
}
"""Kinds of disturbances without an option of their own, and what may follow them."""
OTHERS = option(
    "KIND[,SIZE]",
    "Other disturbances, such as 'state, 50 mm/s': kick-plane or state, up to a speed; release from the wall, fixed (the default), rotating or "
    "rolling, such as 'release, rolling'; slice, at rest anywhere in the clearance.",
    "--disturbance",
)
GRID = option("NxM", "Grid cells in size and direction, or in x and y; a single N for releases and blade losses.")
SAMPLE = option("N", "Use a random sample of this size instead of a grid.")
GAINS = option("NxM", "Map the share that comes back over the two parameters of --plane.")


def basins(
    machine: str = options.MACHINE,
    settings: list[str] | None = options.SETTINGS,
    kick: str | None = options.KICKS,
    shock: str | None = options.SHOCKS,
    blade_loss: str | None = options.BLADE_LOSSES,
    base_record: str | None = options.BASE_RECORDS,
    disturbance: str | None = OTHERS,
    grid: str | None = GRID,
    instant: str | None = options.INSTANT,
    starts: int | None = SAMPLE,
    seed: int | None = options.SEED,
    gains: str | None = GAINS,
    plane: str | None = options.PLANE,
    x: str | None = options.FIRST_RANGE,
    y: str | None = options.SECOND_RANGE,
    out: str | None = options.OUT,
    as_json: bool = options.AS_JSON,
) -> None:
    """Find where disturbances end: the share that comes back, the smallest that does not, and gains that help.

    Every disturbance is simulated until it settles. Values need units, such as '50 mm/s', unless the machine file is
    dimensionless. With --gains the share that comes back is mapped over P and D gain, or any two parameters.
    """
    case = read_machine(machine, settings)
    with progress("loading") as tell:
        from carom.cli.starts import by_option, read_cells, read_plane, refuse

        ways = by_option(
            kick=kick, shock=shock, blade_loss=blade_loss, base_record=base_record, disturbance=disturbance
        )
        plan = _plan(case, _model(case, ways), grid, starts, seed, instant)
        if gains is None:
            refuse("allowed only with --gains NxM", plane=plane, x=x, y=y)
        from carom.basins import map_basins, map_gains, smallest_unrecovered
        from carom.basins.document import basin_document
        from carom.basins.maps import usual_gains
        from carom.basins.sizes import size_coordinate
        from carom.closed_forms import contact_free_kick
        from carom.models import rotor_of

        rotor, share = rotor_of(case), 0.45
        if gains is not None:
            share, shape = 0.2, read_cells("--gains", gains, 2, least=2, most=MOST_STARTS)
            asked = read_plane(case, "--plane", plane or ",".join(usual_gains(rotor)), x, y)
        check_output(out)
        source = _source(machine, settings)
        step = tell.part(0.0, share, f"following {plan.count} starts")
        basin = map_basins(rotor, plan, source=source, progress=step)
        contact_free, smallest = contact_free_kick(rotor), None
        if contact_free > 0.0 and size_coordinate(plan.model) is not None:
            smallest = smallest_unrecovered(rotor, plan.model, progress=tell.part(share, 2.0 * share))
        figures: Drawings = {"basins": lambda: basin.plot(smallest)}
        files: dict[str, Callable[[Path], None]] = {"basins.nc": basin.save}
        over: tuple[Any, ...] = ()
        if gains is not None:
            found = map_gains(rotor, plan, asked.over(shape), source=source, progress=tell.part(0.33, 0.97))
            over = (found, asked.in_terms_of)
            figures["gain-map"] = lambda: found.plot(in_terms_of=asked.in_terms_of)
            files["gains.nc"] = found.save
        document = cache(lambda: basin_document(basin, smallest, contact_free, *over))
        write_output(out, case, "basins", document, figures, files=files, tell=tell.part(0.97, 1.0))

    def show() -> None:
        from carom.cli.basin_tables import print_basin, print_gains

        print_basin(console(), basin, smallest, contact_free)
        if over:
            print_gains(console(), *over)

    hand_over(document, as_json, show, out)


def _model(case: Case, ways: dict[str, str | None]) -> Disturbance:
    """The kind of disturbance that the options describe, with its largest size."""
    from carom.cli.starts import read_all_around, read_positive
    from carom.disturbances import MODELS, VelocityKick

    scales, usual = case.parameters.scales, case.requirement.own(case.parameters.scales).kick
    chosen = {name: text for name, text in ways.items() if text is not None}
    if len(chosen) > 1:
        raise InputError(*list(chosen.items())[1], f"not allowed with {next(iter(chosen))}: give one kind only")
    if not chosen:
        return VelocityKick(usual)
    ((name, text),) = chosen.items()
    if name != "--disturbance":
        single = read_all_around(name, text, scales)
        if name != "--kick":
            return single.model
        if not (speed := float(single.values[0])) > 0.0:
            raise InputError(name, text, "must be a velocity above 0")
        return VelocityKick(speed)
    kind, _, size = (part.strip() for part in text.partition(","))
    if kind not in _OTHERS or (size and not _OTHERS[kind]):
        forms = (f"{each}[,{more}]" if more else each for each, more in _OTHERS.items())
        raise InputError(name, text, f"must be one of: {', '.join(forms)}")
    if kind == "release":
        if size not in ("", *_OTHERS[kind].split("|")):
            raise InputError(name, text, f"must be release,{_OTHERS[kind]}")
        return MODELS[kind](size or "fixed")  # type: ignore[call-arg]
    if kind == "slice":
        return MODELS[kind]()
    return MODELS[kind](read_positive(name, size, "velocity", scales) if size else usual)  # type: ignore[call-arg]


def _plan(
    case: Case, model: Disturbance, grid: str | None, starts: int | None, seed: int | None, instant: str | None
) -> Plan:
    """Which of these disturbances are followed: on a grid, or a sample of them."""
    from carom.cli.starts import read_cells, read_instant, refuse
    from carom.disturbances import Grid, Sample
    from carom.models import rotor_of

    drawn, dimensions = starts is not None or model.kind == "state", len(model.coordinates)
    if grid is not None:
        refuse("not allowed with --grid", starts=starts)
    if drawn:
        refuse("allowed only with a grid: a sample has random instants", instant=instant)
        refuse("not allowed for states, which have four coordinates: give --starts", grid=grid)
        count = STARTS if starts is None else starts
        if not 1 <= count <= MOST_STARTS:
            raise InputError("--starts", count, f"must be a whole number from 1 to {MOST_STARTS}")
        return Sample(model, count, seed or 0)
    refuse("allowed only for a sample: give --starts too", seed=seed)
    cells: tuple[int, ...] = (RELEASES,) if dimensions == 1 else (CELLS, CELLS)
    if grid is not None:
        cells = read_cells("--grid", grid, dimensions, least=1, most=MOST_STARTS)
    return Grid(model, cells, None if instant is None else read_instant(instant, rotor_of(case)))


def _source(machine: str, settings: list[str] | None) -> dict[str, str]:
    """Describe where the machine comes from."""
    text = Path(machine).read_bytes()
    return {
        "machine_file": Path(machine).name,
        "machine_file_sha256": hashlib.sha256(text).hexdigest(),
        "machine_text": text.decode("utf-8", "replace"),
        "settings": "; ".join(settings or ()),
    }
