"""One motion for the terminal: how it ended, its contacts at all touchdown bearings, and where it is at the end."""

from __future__ import annotations

import cmath
import dataclasses
import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from rich.console import Console
from rich.table import Table
from rich.text import Text

from carom.attractors import MotionName
from carom.attractors.settled import settled_motion
from carom.base.outcome import Outcome, Phase
from carom.cli.fitting import fitted, plain_table
from carom.cli.tables import TEXT_WIDTH, complex_words, print_rows
from carom.motions import Trajectory, drop_loads
from carom.parameters.indentation import indentation_of_hit
from carom.parameters.told import number, told, told_angle
from carom.studies import LoadCheck, Wording
from carom.studies.load_checks import checks_of_planes
from carom.studies.load_tables import load_tables
from carom.studies.wording import counted, listed, no_rigid_wall

if TYPE_CHECKING:
    from carom.parameters import Case

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
            begun = f"From {told(part.begins, 'time', case.parameters.scales)}:"
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
    followed = f"Followed for {say.time(motion.time)} ({turns} turns of the shaft)" if motion.time else "Known at once"
    console.print(f"{followed}: {_counts(motion)}.")
    for seen in motion.at_each:
        if seen.is_compliant or not len(seen.contacts):
            continue
        fastest = float(seen.contacts.radial_speed.max())
        if soft := no_rigid_wall(indentation_of_hit(case.parameters, fastest)):
            console.print(f"Hardest impact{_where(seen)}: {soft}.")
    if any(len(seen.contacts) or seen.lasting_contacts for seen in motion.at_each):
        console.print()
        console.print(fitted(console, _events(say, motion)))
    final = motion.final
    console.print()
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
    struck, lasting = (sum(numbers) for numbers in zip(*each, strict=True))
    text = (
        counted(struck, "contact")
        if motion.is_compliant
        else f"{counted(struck, 'impact')}, {counted(lasting, 'lasting contact')}"
    )
    if len(each) == 1 or not struck:
        return text
    shares = [f"{number} at touchdown bearing {place}" for place, (number, _) in enumerate(each, start=1)]
    return f"{text} ({listed(shares)})"


def _final_words(say: Wording, seen: Trajectory) -> str:
    """Where a rotor that weighs something, or one with several coordinates, is in a bearing at the end, and how fast, in the fixed frame."""
    place, speed = seen.end()
    say = dataclasses.replace(say, scales=seen.scales)
    return (
        f"At the end{_where(seen)}, in the fixed frame: {say.radius(abs(place))} from the centre at {told_angle(cmath.phase(place))}, "
        f"moving with {say.velocity(abs(speed))} at {told_angle(cmath.phase(speed))}"
    )


def _end_words(motion: Trajectory) -> str:
    """Say how a motion ended; a forward rub by the name that studies give it."""
    if motion.outcome is not Outcome.FORWARD_RUB:
        return motion.outcome.meaning
    settled = settled_motion(motion)
    name = MotionName(motion.outcome, drifting=not settled.synchronous)
    how = "turns with the shaft" if settled.synchronous else "slides in the sense of rotation"
    return f"The rotor ends in {name}: it stays in contact with the touchdown bearing and {how}."


def _events(say: Wording, motion: Trajectory) -> Table:
    """Return the table of impacts and lasting contacts in order of time; the middle of a long log is left out."""
    speed, impulse, slip = (size(1.0).partition(" ")[2] for size in (say.velocity, say.impulse, say.slip))
    time = f"time, {'ms' if say.scales else '1/Ω'}"
    speeds, slips = f"speed towards wall, {speed}", f"slip, {slip}"
    normal, friction = f"normal impulse, {impulse}", f"friction impulse, {impulse}"
    angle = "angle" if motion.rotor.weight is None else "fixed angle"
    bearing = ("bearing",) if len(motion.at_each) > 1 else ()
    after = () if motion.is_compliant else (slips,)
    numbers = (time, *bearing, angle, speeds, normal, friction, *after)
    headings = (time, *bearing, "contact", angle, speeds, "whirl", normal, friction, *after)
    table = plain_table("Contacts", *headings, right=numbers, no_wrap=(*numbers, "whirl"))
    rows = [row for seen in motion.at_each for row in _event_rows(dataclasses.replace(say, scales=seen.scales), seen)]
    rows.sort(key=lambda row: row.time)
    hidden = len(rows) - FIRST_EVENTS - LAST_EVENTS
    shown = rows
    if hidden > 1:
        shown = [*rows[:FIRST_EVENTS], *rows[-LAST_EVENTS:]]
        table.caption, table.caption_justify = f"… {number(hidden, 12)} more: --csv FILE has all", "left"
    factor = 1e3 * say.scales.time if say.scales else 1.0
    for place, row in enumerate(shown):
        if hidden > 1 and place == FIRST_EVENTS:
            table.add_row("…")
        which = (str(row.bearing),) if bearing else ()
        table.add_row(number(factor * (motion.begins + row.time), 7), *which, *row.cells)
    return table


class _Row(NamedTuple):
    """A contact at a touchdown bearing, from 1; its time counts from the beginning of the stage."""

    time: float
    bearing: int
    cells: tuple[str, ...]


def _event_rows(say: Wording, seen: Trajectory) -> list[_Row]:
    """Contacts at one bearing: impacts and lasting contacts, or those with a compliant wall."""
    log, bearing, compliant = seen.contacts, seen.plane + 1, seen.is_compliant
    # Weight has a direction in the fixed frame alone.
    angles = log.angle if seen.rotor.weight is None else log.angle + seen.begins + log.time
    rows = []
    for place, time in enumerate(log.time.tolist()):
        slip = "stops" if log.sticks[place] else _number_of(say.slip(float(log.slip_after[place])))
        cells = (
            _lasting(say, int(log.phase[place]), float(log.duration[place])) if compliant else "impact",
            f"{math.degrees(math.remainder(angles[place], 2.0 * math.pi)):.1f}°",
            _number_of(say.velocity(float(log.radial_speed[place]))),
            "forward" if log.angular_speed[place] > -1.0 else "backward",
            _number_of(say.impulse(float(log.normal_impulse[place]))),
            _number_of(say.impulse(float(log.friction_impulse[place]))),
            *(() if compliant else (slip,)),
        )
        rows.append(_Row(time, bearing, cells))
    if not compliant:
        rows += [
            _Row(each.start, bearing, (_lasting(say, each.phase, each.end - each.start),))
            for each in seen.lasting_contacts
        ]
    return rows


def _lasting(say: Wording, phase: int, duration: float) -> str:
    return f"{Phase(phase).label.replace('-', ' ')} for {say.time(float(duration))}"


def _number_of(told: str) -> str:
    """The number of a size such as ``60 mm/s``, for a column whose heading has the unit."""
    return told.partition(" ")[0]
