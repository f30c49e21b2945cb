"""``carom drop``: the loads of a drop on the touchdown bearing, once or over a plane of two numbers."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any, cast

from carom.base.outcome import InputError
from carom.cli import options
from carom.cli.options import option
from carom.cli.recovery import DROPS, KICKS_UP_TO, RECOVERY, compare_recoveries
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine, write_output

if TYPE_CHECKING:
    from rich.console import Console

    from carom.base.progress import Reporter
    from carom.basins import DropMap
    from carom.cli.starts import StatedBeginning
    from carom.disturbances import Drop
    from carom.motions import Trajectory
    from carom.parameters import Case
    from carom.studies.drops import DropStudy

STANDSTILL = "standstill"
_DRAWN = 20_000
"""Impacts and steps of contact that are drawn and written as histories, which need them all at once."""
MOST_CELLS = 100_000
"""Each takes some hundredths of a second to some seconds: more would be a typing error."""
WHIRL = option(
    "RADIUS,SPEED[,ANGLE]",
    "Start in a circular whirl about the bearing centre, such as '0.1 mm,-80 Hz,30 deg': radius, frequency (negative: backward) and angle in the fixed frame.",
)
PHASE = option(
    "ANGLE",
    "Angle from the direction of the fall to the unbalance at the release, in the sense of rotation, such as '90 deg'; by default from the machine file.",
)
RACE_SPEED = option("SPEED", "Speed of the inner race at the release, such as '500 rpm'; 0 by default.")
MAP = option(
    "NAME,NAME",
    "Map drops over two quantities, such as 'phase,speed': phase, regained_after or race_speed of the release, or parameters of the machine.",
    "--map",
)
GRID = option("NxM", "With --map: numbers of values; 24x16 by default.")
UNTIL = option(
    "T",
    "Simulate until this time, in 1/Omega or with a unit, or until the shaft stands: 'standstill'; by default until the outcome is certain.",
)
STEPS = option(
    "N", "With --until standstill: steps of speed down to zero; the error is that of half as many.", default=200
)
REGAINED_BY = option("NAME", "Levitation returns as the table [[recovery]] of this name says.")
OUT = option("DIR", "Write figures, drop.json and the landing report drop.html to this directory.")


def drop(
    machine: str = options.MACHINE,
    settings: list[str] | None = options.SETTINGS,
    start: str | None = options.START,
    kick: str | None = options.KICK,
    whirl: str | None = WHIRL,
    shock: str | None = options.SHOCK,
    base_record: str | None = options.BASE_RECORD,
    phase: str | None = PHASE,
    race_speed: str | None = RACE_SPEED,
    regained_after: str | None = options.REGAINED_AFTER,
    regained_by: str | None = REGAINED_BY,
    compare: bool = RECOVERY,
    drops: int | None = DROPS,
    kicks_up_to: str | None = KICKS_UP_TO,
    seed: int | None = options.SEED,
    until: str | None = UNTIL,
    plane: str | None = MAP,
    grid: str | None = GRID,
    x: str | None = options.FIRST_RANGE,
    y: str | None = options.SECOND_RANGE,
    out: str | None = OUT,
    steps: int = STEPS,
    history: str | None = options.HISTORY,
    every: str | None = options.EVERY,
    nodes: str | None = options.NODES,
    as_json: bool = options.AS_JSON,
) -> None:
    """Drop the rotor on its touchdown bearings: forces, depth, heat, whirl and race speed, against their limits.

    Levitation is lost and the rotor falls under [gravity], or 9.81 m/s² downward if the file has none; with --shock or --base-record the base moves from the
    release on. With --out it also writes figures, drop.json
    and drop.html. `carom simulate --drop` logs every contact of the same motion. With --map drops are simulated over two quantities, with --recovery many
    are, to compare what brings the rotor back.
    """
    from carom.basins.drops import RELEASED, USUAL
    from carom.cli.logs import history_writer
    from carom.cli.starts import by_option, read_cells, read_plane, read_time, refuse, released

    case = read_machine(machine, settings)
    check_output(out)
    begun = {"start": start, "kick": kick, "whirl": whirl}
    moved = {"shock": shock, "base_record": base_record}
    if compare:
        said = {"phase": phase, "race_speed": race_speed, "regained_after": regained_after, "regained_by": regained_by}
        allowed = "not allowed with --recovery: its drops and recoveries are those of the file"
        refuse(allowed, **begun, **moved, **said, map=plane)
        return compare_recoveries(case, drops, kicks_up_to, seed, until, out, as_json)
    refuse("allowed only with --recovery", drops=drops, kicks_up_to=kicks_up_to, seed=seed)
    ways, bases = by_option(**begun), by_option(**moved)
    begins = released(
        case, ways, regained_after, phase, race_speed, called="the release", regained_by=regained_by, bases=bases
    )
    if plane is None:
        refuse("allowed only with --map NAME,NAME", grid=grid, x=x, y=y)
    else:
        refuse("allowed without --map", history=history)
    asked = plane and read_plane(case, "--map", plane, x, y, RELEASED)
    record = history_writer(case, history, every, nodes)
    if until == STANDSTILL:
        if plane is not None:
            raise InputError("--until", until, "a time beside --map, such as '0.5 s'")
        return _drop_once(case, begins, None, steps, out, record, as_json)
    end = read_time(until, case.parameters.scales)
    if asked:
        shape = tuple(USUAL.values()) if grid is None else read_cells("--grid", grid, 2, least=2, most=MOST_CELLS)
        _map(case, begins, {"over": asked.over(shape), "until": end}, out, as_json)
    else:
        _drop_once(case, begins, end, None, out, record, as_json)


def _drop_once(
    case: Case,
    begins: StatedBeginning,
    end: float | None,
    steps: int | None,
    out: str | None,
    record: Callable[[Trajectory], None] | None,
    as_json: bool,
) -> None:
    """Follow one drop, write its histories and its report, and tell what the bearing bears."""
    page, drawn = None, out is not None or record is not None
    with progress("simulating (the kernels are compiled on first use)") as tell:
        part = tell.part(0.0, 0.4) if drawn else tell
        found, motion = _follow(case, begins, end, steps, _DRAWN if drawn else 0, part)
        if motion is not None and record is not None:
            record(motion)
            if (until := motion.begins + motion.time) < found.loads.time and not motion.outcome.settled:
                seconds = until * (1.0 if motion.rotor.scales is None else motion.rotor.scales.time)
                console(errors=True).print(
                    f"History up to {seconds:.4g} s: the first {_DRAWN:,} impacts and steps of contact"
                )
        if motion is not None and out is not None:
            from carom.report import write_drop_report

            page = write_drop_report(found, motion, out, progress=tell.part(0.4, 1.0))
    hand_over(found.document, as_json, lambda: _print_drop(console(), found, out), out, f"Report: {page}")


def _follow(
    case: Case, begins: StatedBeginning, end: float | None, steps: int | None, drawn: int, tell: Reporter
) -> tuple[DropStudy, Trajectory | None]:
    """A drop followed to a time, or in steps of speed until the shaft stands, with its first events where they are to be drawn."""
    rotor, state, echo = begins.apply(case)
    from carom.motions import follow_loads, simulate, spin_down
    from carom.studies.drops import DropStudy

    slowed = None
    if steps is not None:
        slowed = spin_down(case, cast("Drop", begins.release), steps=steps, keep=drawn, progress=tell)
        loads, motion = slowed.loads, slowed.motion
    else:
        loads = follow_loads(rotor, state, end, progress=tell)
        motion = simulate(rotor, state, end, max_events=drawn) if drawn else None
    return DropStudy(case, echo, loads, begins.reduction_error(case, loads), spin_down=slowed), motion


def _print_drop(screen: Console, found: DropStudy, out: str | None) -> None:
    """Print what was done, how it ended, the loads of each touchdown bearing, and the limits."""
    from rich.text import Text

    from carom.cli.tables import TEXT_WIDTH, print_checks, print_rows

    width = min(screen.width, TEXT_WIDTH)
    screen.print(f"{found.echo.words}.", width=width)
    screen.print(Text(found.headline, style="bold"), width=width)
    for title, rows in found.tables:
        print_rows(screen, title, rows)
    print_checks(screen, found.checks)
    for each in (found.loads.magnets, found.reduction):
        if each is not None and each.words:
            screen.print()
            screen.print(each.words, width=width)
    screen.print()
    if out is None:
        screen.print("Figures, drop.json and drop.html: add --out DIR")


def _map(case: Case, begins: StatedBeginning, asked: dict[str, Any], out: str | None, as_json: bool) -> None:
    """Drop the machine over the plane, write figure, dataset and document, and tell how the drops end."""
    from carom.basins import map_drops
    from carom.basins.document import drop_map_document

    with progress("following drops (the kernels are compiled on first use)") as tell:
        found = map_drops(case, begins.release, **asked, progress=tell if out is None else tell.part(0.0, 0.95))
        document = cache(lambda: {"name": case.name, **drop_map_document(found)})
        write_output(out, case, "drop-map", document, {"drop-map": found.plot}, files={"drop-map.nc": found.save})
    hand_over(document, as_json, lambda: _print_map(console(), found), out)


def _print_map(screen: Console, found: DropMap) -> None:
    """Print how the drops end, the loads on the bearing, and how many exceed its limits."""
    from carom.base.results import table_of
    from carom.basins.document import DROPPED
    from carom.cli.screen import print_table
    from carom.parameters.tables import LIMIT_FIELDS, LoadLimits

    exists, tried = found.exists, int(found.exists.sum())
    screen.print(f"Drops over {found.plane}: {' x '.join(map(str, exists.shape))}.")
    print_table(screen, "", *table_of(DROPPED, found.fractions, found))
    screen.print(f"Hardest: {found.worst}.")
    ends = {"Backward whirl at the end": found.backward, "Force still growing at the end": found.still_growing}
    for words, cells in ends.items():
        where = f"{int(cells.sum())} of {tried}, all at {found.ranges_of(cells)}" if cells.any() else f"none of {tried}"
        screen.print(f"{words}: {where}.")
    if found.still_growing.any():
        screen.print(
            "The largest loads of these are unknown: simulate one of them longer, with --until, without --map."
        )
    for load, limit in found.limits.items():
        over = int(found.exceeding(load).sum())
        said = f"exceeded in {over} of {tried} drops" if over else "met by all drops"
        screen.print(f"Limit of {LIMIT_FIELDS[load].words}, {LoadLimits.format(load, limit)}: {said}.")
    if not exists.all():
        screen.print(f"{int((~exists).sum())} of {exists.size} machines cannot levitate and were not dropped.")
