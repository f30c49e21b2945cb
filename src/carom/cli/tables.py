"""Results as tables for the terminal."""

from __future__ import annotations

import cmath
import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from carom.attractors import MotionName
from carom.attractors.settled import settled_motion
from carom.cli.fitting import fitted, plain_table
from carom.models.weight import weight_of
from carom.motions import TouchLog, Trajectory, touchdown_loads
from carom.motions.contacts import yields
from carom.outcome import Outcome, Phase
from carom.parameters.indentation import indentation_of_hit
from carom.parameters.told import number, told_angle
from carom.studies import FlexibleStudy, Study, Wording, check_loads
from carom.studies.advice_facts import CHANGES
from carom.studies.facts import Topic, about, paragraphs
from carom.studies.summaries import (
    MotionRow,
    State,
    dimensionless_rows,
    motion_rows,
    simple_motion_rows,
    threshold_rows,
)
from carom.studies.wording import counted, no_rigid_wall

if TYPE_CHECKING:
    from carom.closed_forms.equilibria import Equilibrium
    from carom.orbits.orbit import Orbit
    from carom.orbits.single_impact import OrbitSet
    from carom.parameters import Case

FIRST_EVENTS, LAST_EVENTS = 20, 8
"""Numbers of contacts shown at the beginning and at the end of a long log."""
MOST_NUMBERS = 40
"""Number of orbits above which the tables of numbers leave out virtual ones."""
TEXT_WIDTH = 110
"""Largest width of running text, in columns; longer lines are hard to read."""
NARROW = 116
"""Width in columns below which the table of motions leaves out remarks, unless a motion is not possible."""
_STYLES: dict[State, str] = {
    "stable": "bold",
    "seen": "bold",
    "unstable": "",
    "transient": "",
    "not possible": "dim",
    "undecided": "",
}
_LEVELS = {
    "no-contact-free-motion": "bold red",
    "may-not-come-back": "bold yellow",
    "all-tried-came-back": "bold green",
}


def print_study(console: Console, study: Study, report: Path | None) -> None:
    """Print the verdict, motions, thresholds and kicks of a study."""
    verdict = study.verdict
    headline = Text(f"{study.case.name}: {verdict.lead}", style=_LEVELS[verdict.level])
    console.print(headline, width=min(console.width, TEXT_WIDTH))
    _print_facts(console, study, "Verdict", "What it survives")
    _print_facts(console, study, "Recommendation", "Recommendation")
    _print_topics(console, study)
    console.print()
    console.print(Text("For a closer look", style="bold"))
    console.print()
    console.print(fitted(console, _motions(motion_rows(study), "Motions", console.width)))
    _print_left_out(console, study.orbits)
    console.print()
    if study.thresholds:
        console.print(fitted(console, _thresholds(study)))
    console.print()
    if report is None:
        console.print("Figures, study.json and report.html: add --out DIR")
    else:
        console.print(f"Report: {report}", soft_wrap=True)


def print_flexible_study(console: Console, study: FlexibleStudy, report: Path | None) -> None:
    """Print the verdict and the facts of the study of a flexible machine."""
    verdict = study.verdict
    headline = Text(f"{study.case.name}: {verdict.lead}", style=_LEVELS[verdict.level])
    console.print(headline, width=min(console.width, TEXT_WIDTH))
    _print_facts(console, study, "Verdict", "What it survives")
    _print_topics(console, study)
    console.print()
    told = "Figures, study.json and report.html: add --out DIR" if report is None else f"Report: {report}"
    console.print(told, soft_wrap=True)


def _print_topics(console: Console, study: Study | FlexibleStudy) -> None:
    """Print the facts of all other topics as text."""
    for topic, texts in paragraphs(study.facts):
        console.print()
        console.print(Text(topic, style="bold"))
        told = Padding(Text("\n".join(texts)), (0, 0, 0, 2), expand=False)
        console.print(told, width=min(console.width, TEXT_WIDTH))


def _print_facts(console: Console, study: Study | FlexibleStudy, topic: Topic, heading: str) -> None:
    """Print the facts of a topic with their labels: a table without lines, details indented."""
    console.print()
    console.print(Text(heading, style="bold"))
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(no_wrap=True)
    table.add_column()
    for fact in about(study.facts, topic):
        label = Text(f"    {fact.label}" if fact.detail else f"  {fact.label}")
        table.add_row(label, Text(fact.told, style="bold" if fact.label in CHANGES else ""))
    console.print(table, width=min(console.width, TEXT_WIDTH))


def print_orbits(console: Console, case: Case, equilibria: tuple[Equilibrium, ...], orbits: OrbitSet) -> None:
    """Print equilibria and orbits, in units of the equations and in SI units."""
    _print_parameters(console, case)
    rows = simple_motion_rows(equilibria, orbits, Wording(case.parameters.scales), most_virtual=40)
    motions = _motions(rows, "Equilibria and orbits with one impact a period", console.width)
    console.print(fitted(console, motions))
    _print_left_out(console, orbits, most_virtual=40)
    _print_numbers(console, [orbit for orbit in orbits if orbit.admissible or len(orbits) <= MOST_NUMBERS])
    console.print()
    console.print(orbits.argument)


def print_found_orbits(console: Console, case: Case, found: OrbitSet) -> None:
    """Print the orbits with at most a number of impacts."""
    _print_parameters(console, case)
    if len(found):
        title = f"Orbits with at most {counted(found.impacts, 'impact')} a period"
        motions = plain_table(title, "orbit", "period", "state", "word", no_wrap=("orbit", "period"))
        say = Wording(case.parameters.scales)
        for orbit in found:
            state = "stable" if orbit.stable else "unstable"
            turns = "" if orbit.turns is None else f", {counted(orbit.turns, 'turn')}"
            motions.add_row(orbit.name, f"{say.time(orbit.period)}{turns}", state, orbit.segments)
        console.print(fitted(console, motions))
    else:
        console.print(f"No orbit with at most {counted(found.impacts, 'impact')} a period was found.")
    _print_numbers(console, list(found))
    console.print()
    console.print(found.argument)


def _print_parameters(console: Console, case: Case) -> None:
    """Print the name and the dimensionless parameters of a machine."""
    parameters = ", ".join(f"{row.symbol} = {row.value}" for row in dimensionless_rows(case))
    console.print(Text(f"{case.name}: {parameters}"))
    console.print()


def _print_numbers(console: Console, shown: Sequence[Orbit]) -> None:
    """Print states and multipliers of orbits."""
    if shown:
        columns, size = ("period T", "ṙ", "θ", "θ̇"), "largest modulus"
        title = "Orbits in the units of the equations, just before the first impact"
        values = plain_table(title, "orbit", *columns, right=columns, no_wrap=("orbit", *columns))
        title = "Multipliers: a small disturbance is multiplied by these in a period"
        multipliers = plain_table(title, "orbit", size, "multipliers", right=[size])
        for orbit in shown:
            style = "" if orbit.admissible else "dim"
            numbers = (orbit.period, orbit.radial_speed, orbit.angle, orbit.angular_speed)
            values.add_row(orbit.name, *(f"{value:.10g}" for value in numbers), style=style)
            factors = "   ".join(map(_complex, orbit.multipliers.values))
            multipliers.add_row(orbit.name, f"{orbit.multipliers.spectral_radius:.6g}", factors, style=style)
        for table in (values, multipliers):
            console.print()
            console.print(fitted(console, table))


def print_motion(console: Console, case: Case, motion: Trajectory, *, loads: bool = True) -> None:
    """Print how a motion ended, and its contacts, with the ``loads`` on the touchdown bearing unless these are told elsewhere."""
    say = Wording(case.parameters.scales)
    log, contacts, touches = motion.contacts, motion.lasting_contacts, motion.touches
    if motion.outcome is not Outcome.TRIGGERED:
        console.print(Text(_end_words(motion), style="bold"))
    if motion.multiplicity:
        console.print(f"It repeats after {counted(motion.multiplicity, 'impact')}.")
    turns = number(motion.time / (2.0 * math.pi), 3)
    followed = f"Followed for {say.time(motion.time)} ({turns} turns of the shaft)" if motion.time else "Known at once"
    counts = [(len(log), "impact"), (len(contacts), "lasting contact")]
    if yields(motion.rotor.system, motion.plane):
        counts = [(len(touches), "contact")]
    console.print(f"{followed}: {', '.join(counted(*count) for count in counts)}.")
    if len(log):
        soft = no_rigid_wall(indentation_of_hit(case.parameters, float(log.radial_speed.max())))
        hardest = f"Hardest hit: normal impulse {say.impulse(float(log.normal_impulse.max()))}"
        console.print(f"{hardest}{'; ' if soft else ''}{soft}.")
    if len(log) or contacts:
        if loads:
            _print_loads(console, say, case, motion)
        console.print()
        console.print(fitted(console, _events(say, motion)))
    final = motion.final
    console.print()
    if weight_of(motion.rotor) is not None or len(motion.rotor.system.rest) > 1:
        console.print(_final_words(say, motion))
        return
    console.print(
        f"At the end: U = {_complex(final.position)} c_r, U' = {_complex(final.velocity)} c_r Ω (co-rotating frame), "
        f"r = {say.radius(abs(final.position))}"
    )


def _final_words(say: Wording, motion: Trajectory) -> str:
    """Where a rotor that weighs something, or the first plane of one with several coordinates, is at the end, and how fast, in the fixed frame."""
    (seen,), (rate,) = motion.at_plane(np.array([motion.time]))
    turn = cmath.exp(1j * (motion.begins + motion.time))
    place, speed = complex(seen) * turn, complex(rate + 1j * seen) * turn
    return (
        f"At the end, in the fixed frame: {say.radius(abs(place))} from the centre at {told_angle(cmath.phase(place))}, moving with "
        f"{say.velocity(abs(speed))} at {told_angle(cmath.phase(speed))}"
    )


def _end_words(motion: Trajectory) -> str:
    """Say how a motion ended; a forward rub by the name that studies give it."""
    if motion.outcome is not Outcome.FORWARD_RUB:
        return motion.outcome.meaning
    settled = settled_motion(motion)
    name = MotionName(motion.outcome, drifting=not settled.synchronous)
    how = "turns with the shaft" if settled.synchronous else "slides in the sense of rotation"
    return f"The rotor ends in {name}: it stays in contact with the touchdown bearing and {how}."


def _print_loads(console: Console, say: Wording, case: Case, motion: Trajectory) -> None:
    """Print the loads on the touchdown bearing, and the limits that are stated for it."""
    loads = touchdown_loads(motion)
    if loads.force > 0.0:
        power = f"friction power up to {say.power(loads.power)}"
        console.print(f"Lasting contact: normal force up to {say.force(loads.force)}, {power}.")
    goes_on = f"; it goes on with {say.power(loads.lasting_power)}" if loads.lasting_power > 0.0 else ""
    console.print(f"Heat of friction: {say.energy(loads.heat)}{goes_on}.")
    for check in check_loads(loads, case.limits):
        words = f"{check.words[0].upper()}{check.words[1:]}."
        console.print(Text(words, style="bold" if check.exceeded else ""))


def _motions(rows: list[MotionRow], title: str, width: int) -> Table:
    table = plain_table(title)
    if width < NARROW and all(row.state != "not possible" for row in rows):
        rows = [dataclasses.replace(row, remark="") for row in rows]
    headings = {
        "name": "motion",
        "state": "state",
        "period": "period",
        "size": "radius or impact speed",
        "impulse": "impulse per hit",
        "force": "force",
        "trials": "disturbances",
        "remark": "remark",
    }
    used = [entry.name for entry in fields(MotionRow) if any(getattr(row, entry.name) for row in rows)]
    for name in used:
        table.add_column(headings[name], no_wrap=name in ("state", "period", "impulse", "trials"))
    for row in rows:
        table.add_row(*(Text(getattr(row, name)) for name in used), style=_STYLES[row.state])
    return table


def _print_left_out(console: Console, orbits: OrbitSet, most_virtual: int = 8) -> None:
    virtual = sum(not orbit.admissible for orbit in orbits)
    if virtual > most_virtual:
        console.print(f"{virtual} orbits that are not possible are left out; --json lists them.")


def _thresholds(study: Study) -> Table:
    headings = ("motion", "exists", "quantity", "value", "dimensionless", "where")
    shown = [heading for heading in headings if heading != "value" or study.wording.scales is not None]
    table = plain_table(
        "Thresholds, each with all else as it is", *shown, right=["value"], no_wrap=("value", "dimensionless")
    )
    for row in threshold_rows(study):
        table.add_row(*(cell for heading, cell in zip(headings, row, strict=True) if heading in shown))
    return table


def _events(say: Wording, motion: Trajectory) -> Table:
    """Return the table of impacts and lasting contacts in order of time; the middle of a long log is left out."""
    speed, impulse, slip = (told(1.0).partition(" ")[2] for told in (say.velocity, say.impulse, say.slip))
    time = f"time, {'ms' if say.scales else '1/Ω'}"
    speeds, slips = f"speed towards wall, {speed}", f"slip, {slip}"
    normal, friction = f"normal impulse, {impulse}", f"friction impulse, {impulse}"
    angle = "angle" if weight_of(motion.rotor) is None else "fixed angle"
    numbers = (time, angle, speeds, normal, friction, slips)
    headings = (time, "contact", angle, speeds, "whirl", normal, friction, slips)
    table = plain_table("Contacts", *headings, right=numbers, no_wrap=(*numbers, "whirl"))
    rows = _event_rows(say, motion)
    hidden = len(rows) - FIRST_EVENTS - LAST_EVENTS
    if hidden > 1:
        rows = [*rows[:FIRST_EVENTS], ("…",), *rows[-LAST_EVENTS:]]
        table.caption, table.caption_justify = f"… {number(hidden, 12)} more: --csv FILE has all", "left"
    for row in rows:
        table.add_row(*row)
    return table


def _event_rows(say: Wording, motion: Trajectory) -> list[tuple[str, ...]]:
    log = motion.contacts
    # Weight has a direction in the fixed frame alone.
    angles = log.angle if weight_of(motion.rotor) is None else log.angle + motion.begins + log.time
    factor = 1.0 if say.scales is None else 1e3 * say.scales.time

    def moment(time: float) -> str:
        return number(factor * time, 7)

    entries: list[tuple[float, tuple[str, ...]]] = []
    for place, time in enumerate(log.time.tolist()):
        row = (
            moment(motion.begins + time),
            "impact",
            f"{math.degrees(math.remainder(angles[place], 2.0 * math.pi)):.1f}°",
            _number_of(say.velocity(float(log.radial_speed[place]))),
            "forward" if log.angular_speed[place] > -1.0 else "backward",
            _number_of(say.impulse(float(log.normal_impulse[place]))),
            _number_of(say.impulse(float(log.tangential_impulse[place]))),
            "stops" if log.sticks[place] else _number_of(say.slip(float(log.slip_after[place]))),
        )
        entries.append((time, row))
    if yields(motion.rotor.system, motion.plane):
        return _touch_rows(say, motion.touches, motion.begins, moment)
    for contact in motion.lasting_contacts:
        words = f"{contact.phase.label.replace('-', ' ')} for {say.time(contact.end - contact.start)}"
        entries.append((contact.start, (moment(motion.begins + contact.start), words)))
    return [row for _, row in sorted(entries, key=lambda entry: entry[0])]


def _touch_rows(
    say: Wording, touches: TouchLog, begins: float, moment: Callable[[float], str]
) -> list[tuple[str, ...]]:
    """Rows of contacts with a wall that gives way."""
    return [
        (
            moment(float(begins + touches.start[place])),
            f"{Phase(phase).label.replace('-', ' ')} for {say.time(float(touches.duration[place]))}",
            f"{math.degrees(touches.angle[place]):.1f}°",
            _number_of(say.velocity(float(touches.radial_speed[place]))),
            "forward" if touches.angular_speed[place] > -1.0 else "backward",
            _number_of(say.impulse(float(touches.normal_impulse[place]))),
            _number_of(say.impulse(float(touches.friction_impulse[place]))),
        )
        for place, phase in enumerate(touches.phase.tolist())
    ]


def _number_of(told: str) -> str:
    """The number of a size such as ``60 mm/s``, for a column whose heading has the unit."""
    return told.partition(" ")[0]


def _complex(value: complex) -> str:
    if value.imag == 0:
        return f"{value.real:.6g}"
    return f"{value.real:.6g} {'+' if value.imag >= 0 else '−'} {abs(value.imag):.6g}i"
