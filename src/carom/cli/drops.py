"""Drops on the command line, and motions under gravity for people: times from the release, places in the fixed frame."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from carom.outcome import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from rich.console import Console

    from carom.disturbances.echo import Echo
    from carom.models import Rotor
    from carom.motions.drops import Drop, Whirl
    from carom.motions.loads import DropLoads
    from carom.motions.reduction_errors import ReductionError
    from carom.motions.starts import Kick, State
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Case, Scales

_FIRST = {"drop": "The fall:", "shock": "During the shock:"}
"""What the first stage of a motion is called, by the kind of the disturbance."""
_SINCE = {"drop": "the release", "shock": "the shock began", "kick": "the kick", "blade-loss": "the loss"}
"""From what times count."""


def read_release(
    case: Case,
    options: dict[str, str | None],
    regained_after: str | None,
    *,
    phase: str | None = None,
    race_speed: str | None = None,
    called: str = "--drop",
) -> Drop:
    """Read how levitation is lost; refuse wrong input before kernels are loaded.

    ``options`` are the ways to say the state at the release, of which one at most may be given; ``called`` is what an error calls them all.
    """
    from carom.cli.starts import read_kick, read_phase, read_positive, read_speed, read_start, read_whirl
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
    return Drop(at, turned, regained, turning)


def error_along(
    case: Case, loads: DropLoads, again: Callable[[Case], tuple[Rotor, Any, Echo]]
) -> ReductionError | None:
    """Error of the reduction of a flexible machine along a motion; ``None`` of other machines.  ``again`` reads the same motion of another case."""
    from carom.models import rotor_of
    from carom.motions.reduction_errors import reduction_error

    if (reduced := rotor_of(case).finite_elements) is None:
        return None
    return reduction_error(reduced, loads, lambda finer: again(replace(case, parameters=finer.limited))[:2])


def motion_document(case: Case, motion: Trajectory) -> dict[str, Any]:
    """Return the document of a motion: of all its stages if it has several, with times from its beginning."""
    from carom.models import rotor_of
    from carom.studies import trajectory_document

    document = trajectory_document(motion, case.limits)
    if case.gravity:
        gravity = {"acceleration_si": case.gravity.acceleration, "direction": case.gravity.direction}
        document |= rotor_of(case).document() | {"gravity": gravity}
    if case.touchdown:
        document["touchdown"] = {"law": case.touchdown.law, **case.touchdown.given}
    return document


def print_parts(console: Console, case: Case, motion: Trajectory, kind: str) -> None:
    """Print how a motion after a disturbance of a kind ended, and its contacts, stage by stage; then what the bearing bears in all."""
    from carom.cli.load_tables import print_checks, print_tables
    from carom.cli.motion_tables import print_motion
    from carom.motions import drop_loads
    from carom.motions.contacts import yields
    from carom.parameters.told import told
    from carom.studies.load_checks import checks_of_planes
    from carom.studies.load_tables import load_tables

    together = len(motion.parts) > 1 or len(motion.at_each) > 1 or yields(motion.rotor.system, motion.plane)
    for part in motion.parts:
        if len(motion.parts) > 1:
            console.print()
            begun = f"From {told(part.begins, 'time', case.parameters.scales)}:"
            console.print(begun if part.begins else _FIRST.get(kind, "From the beginning:"))
        print_motion(console, case, part, loads=not together)
    found = drop_loads(motion) if together else None
    if found is not None and any(plane.contacts or plane.contact_time for plane in found.planes):
        print_tables(console, load_tables(found, _SINCE.get(kind, "the start")))
        print_checks(console, checks_of_planes(found, case.limits))
