"""The options of ``carom basins``, and the plans they describe."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from decimal import Decimal
from typing import TYPE_CHECKING, Annotated, Any

import typer

from carom.outcome import InputError

if TYPE_CHECKING:
    from carom.disturbances import Disturbance, Plan
    from carom.models import Axis
    from carom.parameters import Case

CELLS = 60
RELEASES = 360
STARTS = 10_000
MOST_STARTS = 5_000_000
"""More would not fit into the memory of a common computer; use a sweep for larger sets."""
_OPTIONS = {
    "kick": ("fastest",),
    "kick-plane": ("fastest",),
    "shock": ("peak", "duration"),
    "blade-loss": ("change", "node"),
    "release": ("release",),
    "slice": (),
    "state": ("fastest",),
}
"""Kinds of disturbances, and the options that belong to each."""
_FIELDS = {"release": "motion"}
"""Fields of the models where they do not have the name of the option."""
_NEEDED = {"peak": "'20 g'", "duration": "'5 ms'", "change": "'0.1 mm' or '5000 g mm'"}
KINDS = tuple(_OPTIONS)

Kind = Annotated[str, typer.Option(metavar="KIND", help=f"What happens to the rotor: {', '.join(KINDS)}.")]
Cells = Annotated[
    str | None, typer.Option(metavar="NxM", help="Cells of size and direction, or of x and y; N for releases.")
]
Instant = Annotated[
    str | None,
    typer.Option(
        metavar="ANGLE",
        help="Angle by which the shaft has turned when they come, such as '90 deg', where that matters (weight, limits of the magnetic bearings, "
        "bearings that differ in two directions); by default each cell has an instant of its own.",
    ),
]
Starts = Annotated[int | None, typer.Option(metavar="N", help="Instead of a grid: a seeded sample of this size.")]
Seed = Annotated[int | None, typer.Option(metavar="S", help="Seed of the sample, by default 0.")]
Fastest = Annotated[
    str | None,
    typer.Option(
        metavar="SPEED",
        help="Largest kick or start speed, such as '50 mm/s'; by default the one to be survived: stated in [survive], or of a fall through the clearance.",
    ),
]
Peak = Annotated[str | None, typer.Option(metavar="ACC", help="Largest peak of a shock, such as '20 g'.")]
Duration = Annotated[
    str | None, typer.Option(metavar="TIME", help="Duration of a shock, a half-sine pulse, such as '5 ms'.")
]
Change = Annotated[
    str | None,
    typer.Option(
        metavar="SIZE",
        help="By how much the loss of a blade changes the unbalance: '5000 g mm', or '0.1 mm' of eccentricity.",
    ),
]
Node = Annotated[str | None, typer.Option(metavar="N", help="Node of a flexible machine at which the blade is lost.")]
Release = Annotated[
    str | None,
    typer.Option(metavar="MOTION", help="Motion at a release from the wall: fixed (the default), rotating or rolling."),
]
GainsWanted = Annotated[
    str | None, typer.Option(metavar="NxM", help="Map the share that comes back over two parameters.")
]
Plane = Annotated[
    str | None,
    typer.Option(
        metavar="NAME,NAME",
        help="The two parameters, by default stiffness,damping, of a flexible machine proportional,derivative; or what a machine file "
        "states them by, such as proportional_gain,derivative_gain.",
    ),
]
FirstRange = Annotated[
    str | None,
    typer.Option(
        "--x",
        metavar="A,B",
        help="Range of the first parameter; by default half to twice the value, of a gain that of what it sets.",
    ),
]
SecondRange = Annotated[str | None, typer.Option("--y", metavar="C,D", help="Range of the second parameter.")]
Wanted = Annotated[
    float | None,
    typer.Option(metavar="SHARE", help="Share that must come back after the least change; by default 0.99."),
]


@dataclass(frozen=True)
class Gains:
    """The gain map requested by the options: names and ranges of its two parameters, and the share that must come back.

    ``told_by`` is the machine in whose terms its values are told.
    """

    names: tuple[str, str]
    ranges: tuple[Any, Any]
    shape: tuple[int, int]
    wanted: float
    told_by: Case


def read_gains(
    case: Case, cells: str | None, plane: str | None, x: str | None, y: str | None, wanted: float | None
) -> Gains | None:
    """Return the gain map requested, or ``None``; options that belong to one are refused without ``--gains``."""
    more = {"--plane": plane, "--x": x, "--y": y, "--wanted": wanted}
    if cells is None:
        for option, value in more.items():
            if value is not None:
                raise InputError(option, value, "allowed only with --gains NxM")
        return None
    from carom.basins.changes import WANTED

    shape = read_cells("--gains", cells, 2, least=2)
    share = WANTED if wanted is None else wanted
    if not 0.0 < share <= 1.0:
        raise InputError("--wanted", share, "must be a share above 0 and at most 1, such as 0.99")
    names, ranges, told_by = _plane(case, plane, x, y)
    return Gains(names, ranges, (shape[0], shape[1]), share, told_by)


def read_plan(
    case: Case,
    kind: str,
    sizes: dict[str, str | None],
    grid: str | None,
    starts: int | None,
    seed: int | None,
) -> Plan:
    """Return the disturbances described by the options."""
    from carom.disturbances import Grid, Sample

    if kind not in KINDS:
        raise InputError("--disturbance", kind, f"must be one of: {', '.join(KINDS)}")
    for option, value in sizes.items():
        if value is not None and option not in _OPTIONS[kind]:
            kinds = " or ".join(other for other in KINDS if option in _OPTIONS[other])
            raise InputError(f"--{option}", value, f"allowed only with --disturbance {kinds}, not with {kind}")
    if grid is not None and starts is not None:
        raise InputError("--starts", starts, "not allowed with --grid")
    drawn = starts is not None or kind == "state"
    if seed is not None and not drawn:
        raise InputError("--seed", seed, "allowed only for a sample: give --starts too")
    if seed is not None and seed < 0:
        raise InputError("--seed", seed, "must be a whole number of at least 0")
    model = _model(case, kind, sizes)
    if kind == "state" and grid is not None:
        raise InputError("--grid", grid, "not allowed for states, which have four coordinates: give --starts")
    if drawn:
        count = STARTS if starts is None else starts
        if not 1 <= count <= MOST_STARTS:
            raise InputError("--starts", count, f"must be a whole number from 1 to {MOST_STARTS}")
        return Sample(model, count, seed or 0)
    dimensions = len(model.coordinates)
    if grid is None:
        return Grid(model, (RELEASES,) if dimensions == 1 else (CELLS, CELLS))
    return Grid(model, read_cells("--grid", grid, dimensions))


def at_instant(plan: Plan, instant: str | None, case: Case) -> Plan:
    """The same plan, the cells of a grid at one instant of the turn if it is given."""
    from carom.cli.starts import read_instant
    from carom.disturbances import Grid
    from carom.models import rotor_of

    if instant is None:
        return plan
    if not isinstance(plan, Grid):
        raise InputError("--instant", instant, "allowed only with a grid: the starts of a sample come at any instant")
    return replace(plan, instant=read_instant(instant, rotor_of(case)))


def _model(case: Case, kind: str, sizes: dict[str, str | None]) -> Disturbance:
    from carom.cli.starts import read_loss, read_positive
    from carom.disturbances import MODELS

    parameters, model, given = case.parameters, MODELS[kind], dict[str, Any]()
    for option in _OPTIONS[kind]:
        name, text = _FIELDS.get(option, option), sizes[option]
        if option == "release":
            given[name] = text or "fixed"
            if given[name] not in ("fixed", "rotating", "rolling"):
                raise InputError("--release", text, "must be fixed, rotating or rolling")
        elif option == "change" and text is not None:
            given[name] = read_loss("--change", text, parameters.scales)
        elif option == "node":
            given[name] = None if text is None else _node(text)
        elif text is not None:
            given[name] = read_positive(f"--{option}", text, model.measured_in[name], parameters.scales)
        elif option in _NEEDED:
            raise InputError(f"--{option}", None, f"needed for a {kind}, such as {_NEEDED[option]}, or dimensionless")
        elif option == "fastest":
            given[name] = case.requirement.own(parameters.scales).kick
    return model(**given)


def _node(text: str) -> int:
    if not text.strip().isdecimal():
        raise InputError("--node", text, "must be the number of a node, from 0 on")
    return int(text)


def read_cells(option: str, text: str, dimensions: int, least: int = 1, most: int = MOST_STARTS) -> tuple[int, ...]:
    """Read a number of cells such as ``60x60``."""
    example = "60x60" if dimensions == 2 else "360"
    match = re.fullmatch("[x×X]".join([r"\s*([0-9]{1,30})\s*"] * dimensions), text)
    cells = tuple(int(number) for number in match.groups()) if match else ()
    if not match or min(cells) < least:
        words = f"{dimensions} whole number{'s'[: dimensions - 1]} of at least {least}"
        raise InputError(option, text, f"must be {words}, such as {example}")
    total = math.prod(cells)
    if total > most:
        raise InputError(option, text, f"makes {total} cells; at most {most} are allowed")
    return cells


def _plane(
    case: Case, plane: str | None, x: str | None, y: str | None
) -> tuple[tuple[str, str], tuple[Any, Any], Case]:
    """Return the names and ranges of the two parameters of a gain map, and the machine that states them as the plane does."""
    from carom.basins.gains import usual_gains
    from carom.cli.starts import read_entry_range, read_range
    from carom.parameters.terms import TERMS, set_by

    given = plane or ",".join(usual_gains(case.parameters))
    entries = [name.strip() for name in given.split(",")]
    names = [set_by(entry) if entry in TERMS else entry for entry in entries]
    if len(names) != 2 or names[0] == names[1]:
        raise InputError("--plane", given, "must be two names with a comma between them, such as stiffness,damping")
    axes = [_varied(case, given, entry, name) for entry, name in zip(entries, names, strict=True)]
    ranges, told_by = [], case
    for option, text, entry, varied, other in zip(("--x", "--y"), (x, y), entries, axes, reversed(names), strict=True):
        if entry not in TERMS:
            ranges.append(None if text is None else read_range(option, text, varied))
            continue
        if other in TERMS[entry].needs:
            allowed = f"{entry} changes with {other}, which is the other parameter; use {varied.name}"
            raise InputError("--plane", given, allowed)
        told_by = _stated_by(told_by, given, entry)
        ranges.append(None if text is None else read_entry_range(option, text, told_by, entry))
    return (axes[0].name, axes[1].name), (ranges[0], ranges[1]), told_by


def _varied(case: Case, given: str, entry: str, name: str) -> Axis:
    """The parameter that an entry of ``--plane`` states; what states none alone is refused, with why."""
    from carom.models import axis
    from carom.parameters import HELPER_FIELDS
    from carom.parameters.fields import unknown_name
    from carom.parameters.terms import TERMS

    varied = case.parameters.varied
    if name in varied:
        return axis(case.parameters, name)
    known = [*varied, *(term for term, (sets, *_) in TERMS.items() if sets in varied)]
    if entry in HELPER_FIELDS:
        words = HELPER_FIELDS[entry].words
        allowed = f"{entry} ({words}) is no parameter of the rotor by itself; allowed: {', '.join(known)}"
    elif entry in TERMS:
        allowed = f"{entry} sets {name} of a machine in SI units; this one has {', '.join(varied)}"
    else:
        allowed = unknown_name(entry, None, dict.fromkeys(known), "the parameters").allowed
        allowed = f"{entry}: {allowed}"
    raise InputError("--plane", given, allowed)


def _stated_by(case: Case, given: str, entry: str) -> Case:
    """The same machine with a field stated by this entry, as ``--set`` would; its value changes by rounding alone."""
    from carom.parameters.terms import TERMS, set_by

    machine = case.machine
    if machine is None or entry in machine.given.get(set_by(entry), {}):
        return case
    needed = (set_by(entry), *TERMS[entry].needs)
    missing = [name for name in needed if getattr(machine, name) is None]
    if missing:
        allowed = f"{entry} needs {' and '.join(missing)}, which the machine file does not state"
        raise InputError("--plane", given, allowed)
    exact = (Decimal(repr(getattr(machine, name))) for name in needed)
    return case.replace(**{entry: float(TERMS[entry].entry(*exact))})
