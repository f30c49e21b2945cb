"""One motion for the terminal: how it ended, its contacts at all touchdown bearings, and where it is at the end."""

from __future__ import annotations

import cmath
import dataclasses
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.text import Text

from carom.attractors import MotionName
from carom.attractors.settled import settled_motion
from carom.base.outcome import Outcome, Phase
from carom.cli.fitting import print_table
from carom.cli.logs import contact_rows
from carom.cli.tables import TEXT_WIDTH, print_rows
from carom.motions import Trajectory, drop_loads
from carom.parameters.formats import complex_words, format_angle, format_quantity, number, shown_from_si
from carom.parameters.indentation import indentation_of_impact
from carom.studies import LoadCheck, Wording
from carom.studies.drops import checks_of_planes, load_tables
from carom.studies.wording import counted, listed, no_rigid_wall

if TYPE_CHECKING:
    from carom.parameters import Case

_SPARE = ("duration", "friction_impulse", "slip_after")
"""Columns of contacts that a narrow terminal leaves out, the first one first."""
FIRST_EVENTS, LAST_EVENTS = 20, 8
"""Numbers of contacts shown at the beginning and at the end of a long log."""


_FIRST = {"drop": "The fall:", "shock": "During the shock:"}
"""What the first stage of a motion is called, by the kind of the disturbance."""
_SINCE = {"drop": "the release", "shock": "the shock began", "kick": "the kick", "blade-loss": "the loss"}
"""From what times count."""


def print_parts(console: Console, case: Case, motion: Trajectory, kind: str) -> None:
    """Print how a motion after a disturbance of a kind ended, and its contacts, stage by stage; then what the bearing bears in all."""
    for part in motion.parts:
        if len(motion.parts) > 1:
            console.print()
            begun = f"From {format_quantity(part.begins, 'time', case.parameters.scales)}:"
            console.print(begun if part.begins else _FIRST.get(kind, "From the beginning:"))
        print_motion(console, case, part)
    found = drop_loads(motion)
    if any(plane.contacts or plane.contact_time for plane in found.planes):
        for title, rows in load_tables(found, _SINCE.get(kind, "the start")):
            print_rows(console, title, rows)
        print_checks(console, checks_of_planes(found, case.limits))


def print_checks(console: Console, checks: Iterable[LoadCheck]) -> None:
    """Print loads against the limits that are stated; nothing if none is."""
    for place, check in enumerate(checks):
        if not place:
            console.print()
            console.print(Text("Limits of the touchdown bearing", style="bold"))
        words = Text(f"  {check.words}", style="bold" if check.exceeded else "")
        console.print(words, width=min(console.width, TEXT_WIDTH))


def print_motion(console: Console, case: Case, motion: Trajectory) -> None:
    """Print how a motion ended, and its contacts."""
    say = Wording(case.parameters.scales)
    if motion.outcome is not Outcome.TRIGGERED:
        console.print(Text(_end_words(motion), style="bold"))
    if motion.multiplicity:
        console.print(f"It repeats after {counted(motion.multiplicity, 'impact')}.")
    turns = number(motion.time / (2.0 * math.pi), 3)
    followed = f"Simulated {say.time(motion.time)} ({turns} turns of the shaft)" if motion.time else "Decided at once"
    console.print(f"{followed}: {_counts(motion)}.")
    for seen in motion.at_each:
        if seen.is_compliant or not len(seen.contacts):
            continue
        fastest = float(seen.contacts.radial_speed.max())
        if soft := no_rigid_wall(indentation_of_impact(case.parameters, fastest)):
            console.print(f"Hardest impact{_where(seen)}: {soft}.")
    if any(len(seen.contacts) or seen.lasting_contacts for seen in motion.at_each):
        console.print()
        _print_contacts(console, motion)
    final = motion.final
    if motion.rotor.weight is not None or len(motion.rotor.system.rest) > 1:
        for seen in motion.at_each:
            console.print(_final_words(say, seen))
        return
    console.print(
        f"At the end: U = {complex_words(final.position)} c_r, U' = {complex_words(final.velocity)} c_r Ω (co-rotating frame), "
        f"r = {say.radius(abs(final.position))}"
    )


def _where(seen: Trajectory) -> str:
    """Which touchdown bearing a motion is seen at, of a rotor with several."""
    return f" at touchdown bearing {seen.plane + 1}" if len(seen.at_each) > 1 else ""


def _counts(motion: Trajectory) -> str:
    """Numbers of impacts and contacts, at all touchdown bearings together and at each of several."""
    each = [(len(seen.contacts), len(seen.lasting_contacts)) for seen in motion.at_each]
    begun, lasting = (sum(numbers) for numbers in zip(*each, strict=True))
    text = (
        counted(begun, "contact")
        if motion.is_compliant
        else f"{counted(begun, 'impact')}, {counted(lasting, 'lasting contact')}"
    )
    if len(each) == 1 or not begun:
        return text
    shares = [f"{number} at touchdown bearing {place}" for place, (number, _) in enumerate(each, start=1)]
    return f"{text} ({listed(shares)})"


def _final_words(say: Wording, seen: Trajectory) -> str:
    """Where a rotor that weighs something, or one with several coordinates, is in a bearing at the end, and how fast, in the fixed frame."""
    place, speed = seen.end()
    say = dataclasses.replace(say, scales=seen.scales)
    return (
        f"At the end{_where(seen)}, in the fixed frame: {say.radius(abs(place))} from the centre at {format_angle(cmath.phase(place))}, "
        f"moving with {say.velocity(abs(speed))} at {format_angle(cmath.phase(speed))}"
    )


def _end_words(motion: Trajectory) -> str:
    """Say how a motion ended; a forward rub by the name that studies give it."""
    if motion.outcome is not Outcome.FORWARD_RUB:
        return motion.outcome.meaning
    settled = settled_motion(motion)
    name = MotionName(motion.outcome, drifting=not settled.synchronous)
    how = "turns with the shaft" if settled.synchronous else "slides in the sense of rotation"
    return f"The rotor ends in {name}: it stays in contact with the touchdown bearing and {how}."


def _print_contacts(console: Console, motion: Trajectory) -> None:
    """Print contacts of a stage in order of time, by the columns of their log; the middle of a long log is left out."""
    units, rows = contact_rows((motion,))
    headings = {name: each["heading"] for name, each in motion.contacts.columns.items() if each["heading"]}
    if len(motion.at_each) == 1:
        del headings["touchdown_bearing"]
    if motion.rotor.weight is not None:
        headings["angle"] = "fixed angle"
    shown = {name: shown_from_si(units[name]) for name in headings} | {"angle": (math.degrees(1.0), "°")}
    hidden, note = len(rows) - FIRST_EVENTS - LAST_EVENTS, ""
    if hidden > 1:
        note = f"… {number(hidden, 12)} more: --csv FILE has all"
        rows = [*rows[:FIRST_EVENTS], {"kind": "…"}, *rows[-LAST_EVENTS:]]
    cells = [_contact_cells(motion, row, {name: shown[name][0] for name in headings}) for row in rows]
    heads = [
        f"{heading} ({shown[name][1].replace('Omega', 'Ω')})".removesuffix(" (1)") for name, heading in headings.items()
    ]
    spare = tuple(heads[list(headings).index(name)] for name in _SPARE if name in headings)
    print_table(console, "Contacts", ("contact", *heads, "whirl"), cells, note=note, spare=spare)


def _contact_cells(motion: Trajectory, row: dict[str, Any], factors: dict[str, float]) -> list[str]:
    """The cells of a contact: its kind, its numbers in the units of the table, and the sense of the whirl."""
    shown, kind, whirl = dict(row), row["kind"], ""
    period = motion.rotor.scales.time if motion.rotor.scales else 1.0
    if "angle" in row:
        # Weight has a direction in the fixed frame alone.
        turned = 0.0 if motion.rotor.weight is None else row["time"] / period
        shown["angle"] = math.remainder(row["angle"] + turned, math.tau)
        whirl = "forward" if row["angular_speed"] > -1.0 / period else "backward"
    elif "end" in row:
        shown["duration"] = row["end"] - row["time"]
    if kind == "impact":
        del shown["duration"]
    else:  # its slip changes on the way
        kind = Phase(row["phase"]).label.replace("-", " ") if "phase" in row else kind
        shown.pop("slip_after", None)
    digits = {"time": 7, "angle": 4}
    cells = {
        name: number(factor * value, digits.get(name, 3))
        for name, factor in factors.items()
        if not math.isnan(value := shown.get(name, math.nan))
    }
    if "slip_after" in cells and row["sticks"]:
        cells["slip_after"] = "stops"
    return [kind, *(cells.get(name, "") for name in factors), whirl]
