"""``carom basins``: where disturbances go, and which gains bring back more of them."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from carom.cli.terminal import AsJson, MachineFile, Settings, console, print_document, progress
from carom.outcome import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from carom.basins import Basin, GainChange, GainMap, SmallestKick
    from carom.disturbances import Disturbance, Plan
    from carom.parameters import Case, Parameters

__all__ = ["basins"]

CELLS = 60
RELEASES = 360
STARTS = 10_000
MOST_STARTS = 5_000_000
"""More would not fit into the memory of a common machine; larger sets are the business of sweeps."""
KINDS = ("kick", "kick-plane", "shock", "unbalance", "release", "slice", "state")


def basins(
    machine: MachineFile,
    settings: Settings = None,
    disturbance: Annotated[
        str, typer.Option(metavar="KIND", help=f"What happens to the rotor: {', '.join(KINDS)}.")
    ] = "kick",
    grid: Annotated[
        str | None, typer.Option(metavar="NxM", help="Cells of size and direction, or of x and y; N for releases.")
    ] = None,
    starts: Annotated[
        int | None, typer.Option(metavar="N", help="Instead of a grid: a seeded sample of this size.")
    ] = None,
    seed: Annotated[int, typer.Option(metavar="S", help="Of the sample.")] = 0,
    fastest: Annotated[
        str | None, typer.Option(metavar="SPEED", help="Largest kick or start speed, such as '50 mm/s'.")
    ] = None,
    peak: Annotated[str | None, typer.Option(metavar="ACC", help="Largest peak of a shock, such as '20 g'.")] = None,
    duration: Annotated[
        str | None, typer.Option(metavar="TIME", help="Duration of its half-sine pulse, such as '5 ms'.")
    ] = None,
    before: Annotated[
        str | None,
        typer.Option(metavar="LENGTH", help="Largest eccentricity before an unbalance step, such as '0.1 mm'."),
    ] = None,
    release: Annotated[
        str, typer.Option(metavar="MOTION", help="Of a release from the wall: fixed, rotating or rolling.")
    ] = "fixed",
    gains: Annotated[
        str | None, typer.Option(metavar="NxM", help="Map the share that comes back against two parameters.")
    ] = None,
    plane: Annotated[
        str | None, typer.Option(metavar="NAME,NAME", help="These, by default stiffness,damping (P and D gain).")
    ] = None,
    x: Annotated[
        str | None, typer.Option("--x", metavar="A,B", help="Range of the first, by default half to twice.")
    ] = None,
    y: Annotated[str | None, typer.Option("--y", metavar="C,D", help="Range of the second.")] = None,
    wanted: Annotated[
        float, typer.Option(metavar="SHARE", help="Share that is to come back, for the least change.")
    ] = 0.99,
    threads: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Cores to use; the result does not depend on it.")
    ] = None,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help="Write figures, basins.nc and basins.json to this directory.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Find where disturbances go: what share comes back, the smallest kick that does not, and the gains that help.

    Every start is followed to where it settles. Values without a unit are dimensionless: lengths in clearances, times in
    1/Omega. With --gains the share that comes back is mapped against P and D gain, or any two parameters.
    """
    from carom.parameters import load_case

    case = load_case(machine, settings or ())
    sizes = {"fastest": fastest, "peak": peak, "duration": duration, "before": before, "release": release}
    plan = _plan(case.parameters, disturbance, sizes, grid, starts, seed)
    map_shape = None if gains is None else _cells("--gains", gains, 2)
    if not 0.0 < wanted <= 1.0:
        raise InputError("--wanted", wanted, "must be a share above 0 and at most 1, such as 0.99")
    names, ranges = _plane(case.parameters, plane, x, y)
    if out is not None:
        from carom.report.directory import check_directory

        check_directory(out, "--out")
    source = _source(machine, settings)
    with progress("following starts (the kernels are compiled on first use)") as tell:
        basin, smallest, harmless = _follow(case, plan, threads, source, 0.9 if map_shape is None else 0.3, tell)
        found, change = None, None
        if map_shape is not None:
            found, change = _map(case, plan, names, ranges, map_shape, wanted, threads, source, tell)
        from carom.basins.document import basin_document

        document = basin_document(basin, smallest, harmless, found, change)
        if out is not None:
            tell(0.97, "drawing")
            _write(out, basin, smallest, found, change, document)
    if as_json:
        print_document(document)
    else:
        from carom.cli.basin_tables import print_basin, print_gains

        print_basin(console(), basin, smallest, harmless)
        if found is not None:
            print_gains(console(), found, change, wanted)
    if out is not None:
        console(errors=True).print(f"Written to {out}", soft_wrap=True)


def _follow(
    case: Case,
    plan: Plan,
    threads: int | None,
    source: dict[str, str],
    share: float,
    tell: Callable[[float, str], None],
) -> tuple[Basin, SmallestKick | None, float]:
    """Basin, smallest lost kick and harmless speed of a machine."""
    from carom.basins import basins as classify
    from carom.basins import harmless_kick, smallest_unrecovered_kick
    from carom.disturbances import FASTEST
    from carom.rotors import jeffcott

    rotor = jeffcott(case.parameters)
    basin = classify(
        rotor,
        plan,
        threads=threads,
        source=source,
        progress=lambda done: tell(share * done, f"following {plan.count} starts"),
    )
    harmless = harmless_kick(rotor)
    if harmless == 0.0:
        return basin, None, harmless
    tell(share, "looking for the smallest kick that is lost")
    kick_limit = plan.model.coordinates[0].high if plan.model.kind in ("kick", "kick-plane") else FASTEST
    return basin, smallest_unrecovered_kick(rotor, kick_limit, threads=threads), harmless


def _map(
    case: Case,
    plan: Plan,
    names: tuple[str, str],
    ranges: tuple[Any, Any],
    shape: tuple[int, ...],
    wanted: float,
    threads: int | None,
    source: dict[str, str],
    tell: Callable[[float, str], None],
) -> tuple[GainMap, GainChange | None]:
    from carom.basins import gain_map, least_gain_change

    found = gain_map(
        case.parameters,
        plan,
        names,
        ranges=ranges,
        shape=(shape[0], shape[1]),
        threads=threads,
        source=source,
        progress=lambda done: tell(0.3 + 0.6 * done, "following starts of other gains"),
    )
    tell(0.92, "looking for the least change")
    return found, least_gain_change(found, wanted, threads=threads) if all(found.present) else None


def _plan(
    parameters: Parameters, kind: str, sizes: dict[str, str | None], grid: str | None, starts: int | None, seed: int
) -> Plan:
    """Disturbances from the options."""
    from carom.disturbances import Grid, Sample

    if kind not in KINDS:
        raise InputError("--disturbance", kind, f"must be one of: {', '.join(KINDS)}")
    if grid is not None and starts is not None:
        raise InputError("--starts", starts, "must be left out where --grid is given")
    if seed < 0:
        raise InputError("--seed", seed, "must be a whole number of at least 0")
    model = _model(parameters, kind, sizes)
    if kind == "state" and grid is not None:
        raise InputError("--grid", grid, "must be left out for states, of four coordinates: give --starts")
    if starts is not None or kind == "state":
        count = STARTS if starts is None else starts
        if not 1 <= count <= MOST_STARTS:
            raise InputError("--starts", count, f"must be a whole number from 1 to {MOST_STARTS}")
        return Sample(model, count, seed)
    dimensions = len(model.coordinates)
    if grid is None:
        return Grid(model, (RELEASES,) if dimensions == 1 else (CELLS, CELLS))
    return Grid(model, _cells("--grid", grid, dimensions))


def _model(parameters: Parameters, kind: str, sizes: dict[str, str | None]) -> Disturbance:
    from carom.cli.starts import read_size
    from carom.disturbances import (
        FASTEST,
        AnyState,
        BaseShock,
        ContactRelease,
        KickPlane,
        StateSlice,
        UnbalanceStep,
        VelocityKick,
    )

    scales = parameters.scales

    def size(name: str, measure: str, default: float | None) -> float:
        given = sizes[name]
        if given is not None:
            return read_size(f"--{name}", given, measure, scales)
        if default is None:
            example = {"peak": "'20 g'", "duration": "'5 ms'"}[name]
            raise InputError(f"--{name}", None, f"needed for a {kind}, such as {example}, or dimensionless")
        return default

    if kind == "shock":
        return BaseShock(size("peak", "acceleration", None), size("duration", "time", None))
    if kind == "unbalance":
        # The unbalance that would just fill the clearance.
        return UnbalanceStep(size("before", "length", abs(complex(parameters.omega**2 - 1.0, parameters.gamma))))
    if kind == "release":
        motion = str(sizes["release"])
        if motion not in ("fixed", "rotating", "rolling"):
            raise InputError("--release", motion, "must be fixed, rotating or rolling")
        return ContactRelease(motion)  # type: ignore[arg-type]
    if kind == "slice":
        return StateSlice()
    model = {"kick": VelocityKick, "kick-plane": KickPlane, "state": AnyState}[kind]
    return model(size("fastest", "velocity", FASTEST))


def _cells(option: str, text: str, dimensions: int) -> tuple[int, ...]:
    """Read ``60x60``."""
    example = "60x60" if dimensions == 2 else "360"
    match = re.fullmatch("[x×X]".join([r"\s*([0-9]{1,5})\s*"] * dimensions), text)
    cells = tuple(int(number) for number in match.groups()) if match else ()
    if not match or min(cells) < (2 if option == "--gains" else 1):
        raise InputError(option, text, f"must be {dimensions} whole number{'s'[: dimensions - 1]} such as {example}")
    total = 1
    for number in cells:
        total *= number
    if total > MOST_STARTS:
        raise InputError(option, text, f"must make at most {MOST_STARTS} cells")
    return cells


def _plane(
    parameters: Parameters, plane: str | None, x: str | None, y: str | None
) -> tuple[tuple[str, str], tuple[Any, Any]]:
    """Names and ranges of the two parameters of a gain map."""
    from carom.bifurcations import axis
    from carom.parameters import read_quantity

    given = plane or ("stiffness,damping" if parameters.scales else "omega,gamma")
    names = [name.strip() for name in given.split(",")]
    if len(names) != 2 or names[0] == names[1]:
        raise InputError("--plane", given, "must be two names with a comma between them, such as stiffness,damping")
    axes = axis(parameters, names[0]), axis(parameters, names[1])
    ranges: list[tuple[float, float] | None] = []
    for varied, option, text in zip(axes, ("--x", "--y"), (x, y), strict=True):
        if text is None:
            ranges.append(None)
            continue
        parts = text.split(",")
        if len(parts) != 2:
            raise InputError(option, text, f"must be two values of {varied.name} with a comma between them")
        low, high = (read_quantity(varied.field, part, bare=True) for part in parts)
        if not low < high:
            raise InputError(option, text, f"must be two growing values of {varied.name}")
        ranges.append((low, high))
    return (axes[0].name, axes[1].name), (ranges[0], ranges[1])


def _source(machine: str, settings: list[str] | None) -> dict[str, str]:
    """Where the machine comes from."""
    text = Path(machine).read_bytes()
    return {
        "machine_file": Path(machine).name,
        "machine_file_sha256": hashlib.sha256(text).hexdigest(),
        "machine_text": text.decode("utf-8", "replace"),
        "settings": "; ".join(settings or ()),
    }


def _write(
    out: str,
    basin: Basin,
    smallest: SmallestKick | None,
    found: GainMap | None,
    change: GainChange | None,
    document: dict[str, Any],
) -> None:
    """Fill the directory, whole or not at all."""
    from carom.plots import basin as draw_basin
    from carom.plots import gain_map as draw_map
    from carom.plots import save
    from carom.report.directory import filled_at_once
    from carom.study import as_json

    with filled_at_once(out, "--out") as directory:
        save(draw_basin(basin, smallest), directory / "figures" / "basins")
        basin.save(directory / "basins.nc")
        if found is not None:
            save(draw_map(found, change), directory / "figures" / "gain-map")
            found.save(directory / "gains.nc")
        (directory / "basins.json").write_text(as_json(document) + "\n", encoding="utf-8")
