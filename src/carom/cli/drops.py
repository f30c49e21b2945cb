"""Drops on the command line, and motions under gravity for people: times from the release, places in the fixed frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.outcome import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from rich.console import Console

    from carom.disturbances.echo import Echo
    from carom.models import Model
    from carom.motions.drops import Whirl
    from carom.motions.starts import Kick, State
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Case, Scales


def read_drop(
    case: Case,
    options: dict[str, str | None],
    regained_after: str | None,
    *,
    phase: str | None = None,
    race_speed: str | None = None,
    called: str = "--drop",
) -> tuple[Model, State, Echo]:
    """Read the rotor that falls, its start and what was taken; refuse wrong input before kernels are loaded.

    ``options`` are the ways to say the state at the release, of which one at most may be given; ``called`` is what an error calls them all.
    """
    from carom.cli.starts import read_kick, read_phase, read_positive, read_speed, read_start, read_whirl
    from carom.disturbances.echo import echo_of_drop
    from carom.models import model_of
    from carom.motions.drops import Drop
    from carom.studies.wording import listed

    scales = case.parameters.scales
    readers: dict[str, Callable[[str, Scales | None], State | Kick | Whirl]] = {
        "--start": read_start,
        "--kick": read_kick,
        "--whirl": read_whirl,
    }
    chosen = {option: text for option, text in options.items() if text is not None}
    known = [option for option in readers if option in options]
    if len(chosen) > 1 or not set(known).issuperset(chosen):
        given = " with ".join(f"{option} {text}" for option, text in chosen.items())
        raise InputError(called, f"with {given}", f"allowed alone, or with one of {listed(known)}")
    regained = None if regained_after is None else read_positive("--regained-after", regained_after, "time", scales)
    turned = None if phase is None else read_phase("--phase", phase, scales)
    turning = None if race_speed is None else read_speed("--race-speed", race_speed, scales)
    at = next((readers[option](text, scales) for option, text in chosen.items()), None)
    drop = Drop(at, turned, regained, turning)
    rotor, state = drop.stages(case)
    if case.gravity is None or scales is None:  # which stages() has refused
        raise InputError("gravity", None, "a table [gravity] in the machine file")
    angle = drop.unbalance_angle(model_of(case))
    return rotor, state, echo_of_drop(state, angle, regained, case.gravity, scales, turning)


def drop_document(case: Case, motion: Trajectory) -> dict[str, Any]:
    """Return the document of a motion under gravity: of all its stages if it has several, with times from the release."""
    from carom.models import model_of
    from carom.studies import trajectory_document
    from carom.studies.document import rotor_document

    documents = [trajectory_document(part, case.limits) for part in motion.parts]
    gravity = (
        {"acceleration_si": case.gravity.acceleration, "direction": case.gravity.direction} if case.gravity else {}
    )
    document = documents[-1] | rotor_document(model_of(case.parameters)) | {"gravity": gravity}
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
