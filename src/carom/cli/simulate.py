"""``carom simulate``: one motion."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

import typer

from carom.cli import release_options as options
from carom.cli.output import output_directory, say_where
from carom.cli.terminal import AsJson, MachineFile, Out, Settings, check_output, console, print_document, progress
from carom.outcome import InputError

if TYPE_CHECKING:
    from carom.disturbances.echo import Echo
    from carom.models import Rotor
    from carom.motions.starts import State
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Case
    from carom.progress import Reporter


def simulate(
    machine: MachineFile,
    settings: Settings = None,
    start: options.Start = None,
    kick: options.Kick = None,
    shock: options.Shock = None,
    blade_loss: options.BladeLoss = None,
    instant: options.Instant = None,
    drop: options.Dropped = False,
    regained_after: options.BackAfter = None,
    until: options.Until = None,
    out: Out = None,
    csv: Annotated[str | None, typer.Option(metavar="FILE", help="Write the contact log as CSV.")] = None,
    netcdf: Annotated[str | None, typer.Option(metavar="FILE", help="Write the contact log as netCDF.")] = None,
    as_json: AsJson = False,
) -> None:
    """Simulate one motion and log its contacts.

    The motion is followed through flights, impacts and lasting contact, exactly to rounding.
    """
    from carom.cli.drops import error_along, read_release
    from carom.cli.starts import read_time
    from carom.loading import load

    case = load(machine, settings or ())
    check_output(out)
    logs = {option: path for option, path in (("--csv", csv), ("--netcdf", netcdf)) if path is not None}
    _check_logs(logs)
    if regained_after is not None and not drop:
        raise InputError("--regained-after", regained_after, "allowed only with --drop")
    if instant is not None and drop:
        raise InputError(
            "--instant", instant, "not allowed with --drop; carom drop --phase sets where the unbalance is"
        )
    ways = {"--start": start, "--kick": kick, "--shock": shock, "--blade-loss": blade_loss}
    with progress("simulating (the kernels are compiled on first use)") as tell:
        end = None if until is None else read_time(until, case.parameters.scales)
        released = read_release(case, ways, regained_after) if drop else None

        def read(case: Case) -> tuple[Rotor, State, Echo]:
            if released is None:
                return _read(case, ways, instant)
            from carom.studies.drops import release

            return release(case, released)

        rotor, given, echo = read(case)
        motion = _follow(rotor, given, end, tell if out is None else tell.part(0.0, 0.4))
        from carom.motions import drop_loads

        _write_logs(logs, motion)
        loads = drop_loads(motion)
        beside = {"magnets": loads.magnets, "reduction": error_along(case, loads, read)}
        known = {name: found for name, found in beside.items() if found is not None}
        document = _document(case, motion, echo) | {name: found.document() for name, found in known.items()}
        if out is not None:
            _write(out, case, motion, document, tell.part(0.4, 1.0, "drawing"), decaying=end is None)
    if as_json:
        print_document(document)
    else:
        _tell(case, motion, echo, [found.words for found in known.values()])
    say_where(out)


def _check_logs(logs: dict[str, str]) -> None:
    """Refuse early files of contact logs, by their option, that cannot be written."""
    for option, path in logs.items():
        from carom.cli.logs import check_file

        check_file(option, path)


def _write_logs(logs: dict[str, str], motion: Trajectory) -> None:
    """Write the contact logs that are asked for."""
    for option, path in logs.items():
        from carom.cli.logs import write_csv, write_netcdf

        (write_csv if option == "--csv" else write_netcdf)(motion, path)


def _tell(case: Case, motion: Trajectory, echo: Echo, beside: list[str]) -> None:
    """Print the motion for people, and what else is known of it."""
    from carom.cli.drops import print_parts

    console().print(f"{echo.words}.")
    print_parts(console(), case, motion, echo.kind)
    for words in filter(None, beside):
        console().print()
        console().print(words)


def _document(case: Case, motion: Trajectory, echo: Echo) -> dict[str, Any]:
    """What was done to the rotor, then its motion."""
    from carom.cli.drops import motion_document

    return {"disturbance": echo.document(case.parameters.scales)} | motion_document(case, motion)


def _write(
    out: str, case: Case, motion: Trajectory, document: dict[str, Any], tell: Reporter, *, decaying: bool
) -> None:
    """Write the path, its touchdown over time if there is a contact, and the document.

    The figures of a motion that is followed until it is proven to return to levitation show it ``decaying`` further.
    """
    from carom import plots
    from carom.motions.ledger import energy_ledger
    from carom.plots.words import contacts_in_words

    with output_directory(out, case) as output:
        for place, part in enumerate(motion.parts):
            tell(place / len(motion.parts))
            whole, ends = _shown(part) if decaying else (part, "")
            for number, shown in enumerate(whole.at_each):
                tell((place + (number + 0.5) / len(whole.at_each)) / len(motion.parts))
                mark = f"-{place + 1}" if place else ""
                mark += f"-bearing-{shown.plane + 1}" if len(whole.at_each) > 1 else ""
                title = f"{contacts_in_words(shown)} \N{EM DASH} {ends}" if ends else None
                output.figure(f"motion{mark}", plots.motion(shown, title=title))
                touched = len(shown.contacts) or shown.lasting_contacts
                over_time = plots.touchdown(shown, energy_ledger(shown)) if touched else plots.radius(shown, case.zones)
                output.figure(f"touchdown{mark}" if touched else f"radius{mark}", over_time)
        output.document("simulation", document)


def _shown(motion: Trajectory) -> tuple[Trajectory, str]:
    """Return the motion to draw, and how it ends, if that of what is drawn does not say it."""
    from carom.motions.simulation import simulate as follow
    from carom.outcome import Outcome
    from carom.report.figures import until_decayed

    if motion.outcome is not Outcome.LEVITATED or motion.begins:
        return motion, ""
    rotor = motion.rotor
    return follow(rotor, motion.start, until_decayed(rotor, motion.time)), "returns to levitation"


def _read(case: Case, ways: dict[str, str | None], given_instant: str | None) -> tuple[Rotor, State, Echo]:
    """Read the machine that moves, its start and what was taken; refuse wrong input before the rotor is made."""
    from carom.cli.starts import read_instant, read_start
    from carom.disturbances import BaseShock, BladeLoss, VelocityKick, echo
    from carom.disturbances.single import read_single

    scales = case.parameters.scales
    chosen = {option: text for option, text in ways.items() if text is not None}
    if len(chosen) != 1:
        given = " with ".join(f"{option} {text}" for option, text in chosen.items()) or None
        allowed = (
            "give one of --start RE,IM,VRE,VIM, --kick SPEED[,ANGLE], --shock PEAK[,DURATION[,ANGLE]], "
            "--blade-loss CHANGE[,PHASE[,NODE]] and --drop"
        )
        raise InputError("--start", given, allowed)
    ((option, text),) = chosen.items()
    if option != "--start":
        kinds = {"--kick": VelocityKick, "--shock": BaseShock, "--blade-loss": BladeLoss}
        single, rotor = read_single(kinds[option], text, scales, option), _rotor(case)
        single = replace(single, instant=read_instant(given_instant, rotor))
        try:
            return *single.stages(rotor), echo.echo_of(single, rotor)
        except InputError as problem:
            if problem.field in ("kick", "disturbance"):
                raise InputError(option, text, f"{problem.allowed}; use --start") from None
            raise
    state, rotor = read_start(text, scales, case.touchdown is not None and case.touchdown.yields), _rotor(case)
    instant = read_instant(given_instant, rotor)
    said = echo.echo_of_start(state, rotor.unbalance_phase, scales)
    return rotor, replace(state, time=instant), echo.echo_at(said, rotor, instant)


def _rotor(case: Case) -> Rotor:
    from carom.models import rotor_of

    return rotor_of(case)


def _follow(rotor: Rotor, start: State, end: float | None, tell: Reporter) -> Trajectory:
    from carom.motions.simulation import simulate as follow

    return follow(rotor, start, end, progress=tell)
