"""Drops on the command line, and motions under gravity for people: times from the release, places in the fixed frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.outcome import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from carom.disturbances.echo import Echo
    from carom.models import Model
    from carom.motions.starts import State
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Case


def read_drop(case: Case, options: dict[str, str | None], regained_after: str | None) -> tuple[Model, State, Echo]:
    """Read the rotor that falls, its start and what was taken; refuse wrong input before kernels are loaded."""
    from carom.cli.starts import read_kick, read_positive, read_start
    from carom.disturbances.echo import echo_of_drop
    from carom.motions.drops import Drop

    scales = case.parameters.scales
    chosen = {option: text for option, text in options.items() if text is not None}
    if len(chosen) > 1 or not {"--start", "--kick"}.issuperset(chosen):
        given = " with ".join(f"{option} {text}" for option, text in chosen.items())
        raise InputError("--drop", f"with {given}", "allowed alone, or with one of --start and --kick")
    regained = None if regained_after is None else read_positive("--regained-after", regained_after, "time", scales)
    start, kick = options["--start"], options["--kick"]
    at = read_start(start, scales) if start is not None else read_kick(kick, scales) if kick is not None else None
    rotor, state = Drop(at, None, regained).stages(case)
    if case.gravity is None or scales is None:  # which stages() has refused
        raise InputError("gravity", None, "a table [gravity] in the machine file")
    return rotor, state, echo_of_drop(state, case.parameters.phi, regained, case.gravity, scales)


def drop_document(case: Case, motion: Trajectory) -> dict[str, Any]:
    """Return the document of a motion under gravity: of all its stages if it has several, with times from the release."""
    from carom.studies import trajectory_document

    documents = [trajectory_document(part, case.limits) for part in motion.parts]
    gravity = (
        {"acceleration_si": case.gravity.acceleration, "direction": case.gravity.direction} if case.gravity else {}
    )
    document = documents[-1] | {"parameters": case.parameters.as_dict(), "gravity": gravity}
    if len(documents) == 1:
        return document
    document |= {"start": documents[0]["start"], "time": motion.begins + motion.time}
    for key, times in (("impacts", ("time",)), ("contacts", ("start", "end", "peak_time"))):
        document[key] = [
            entry | {name: part.begins + entry[name] for name in times if name in entry}
            for part, own in zip(motion.parts, documents, strict=True)
            for entry in own[key]
        ]
    for key in ("loads", "limits"):
        document.pop(key, None)
    begun = [{"begins": part.begins} | own for part, own in zip(motion.parts, documents, strict=True)]
    return document | {"stages": begun}


def print_parts(console: Console, case: Case, motion: Trajectory) -> None:
    """Print how a motion ended, and its contacts, stage by stage."""
    from carom.cli.tables import print_motion
    from carom.parameters.told import told

    for part in motion.parts:
        if len(motion.parts) > 1:
            console.print()
            console.print(f"From {told(part.begins, 'time', case.parameters.scales)}:" if part.begins else "The fall:")
        print_motion(console, case, part)
