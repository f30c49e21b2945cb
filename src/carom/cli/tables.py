"""Results as tables for the terminal: a study, orbits, and one motion with its contacts, its loads and its end."""

from __future__ import annotations

import cmath
import dataclasses
import math
from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from carom.attractors import MotionName
from carom.attractors.settled import settled_motion
from carom.base.outcome import Outcome, Phase
from carom.base.results import table_of
from carom.cli.logs import contact_rows
from carom.cli.screen import print_table
from carom.motions import Trajectory, drop_loads
from carom.parameters.formats import complex_words, format_angle, format_quantity, number, shown_from_si
from carom.parameters.indentation import indentation_of_impact
from carom.studies import LoadCheck, Study, Wording
from carom.studies.document import FOUND_ORBIT, MULTIPLIERS, ORBIT
from carom.studies.drops import checks_of_planes, load_tables
from carom.studies.findings import CHANGES
from carom.studies.questions import about, paragraphs
from carom.studies.summaries import (
    MOTION_COLUMNS,
    MotionRow,
    State,
    dimensionless_rows,
    motion_rows,
    simple_motion_rows,
)
from carom.studies.wording import counted, listed, no_rigid_wall

if TYPE_CHECKING:
    from carom.closed_forms.compliant_walls import SlippingWhirl
    from carom.closed_forms.equilibria import SteadyMotion
    from carom.models import Rotor
    from carom.orbits.orbit import Orbit
    from carom.orbits.single_impact import OrbitSet
    from carom.parameters import Case

MOST_NUMBERS = 40
"""Number of orbits above which the tables of numbers leave out virtual ones."""
TEXT_WIDTH = 110
"""Largest width of running text, in columns; longer lines are hard to read."""
NARROW = 116
"""Width in columns below which the table of motions leaves out remarks, unless a motion is not possible."""
_STYLES: dict[State, str] = {"stable": "bold", "seen": "bold", "not possible": "dim"}
_LEVELS = {
    "no-contact-free-motion": "bold red",
    "may-not-come-back": "bold yellow",
    "not-decided": "bold yellow",
    "all-tried-came-back": "bold green",
}


def print_study(console: Console, study: Study, out: str | None, long: bool) -> None:
    """Print the verdict and the recommendation of a study; if it is to be ``long``, all facts and the motions too."""
    verdict = study.verdict
    headline = Text(f"{study.case.name}: {verdict.lead}", style=_LEVELS[verdict.level])
    console.print(headline, width=min(console.width, TEXT_WIDTH))
    _print_facts(console, study, "Verdict", "What it survives")
    _print_facts(console, study, "Recommendation", "Recommendation")
    if long:
        _print_topics(console, study)
        console.print()
        print_motions(console, "Motions", motion_rows(study))
        _print_left_out(console, study.orbits)
    console.print()
    if not long:
        console.print("All results and the table of motions: --long")
    if out is None:
        console.print("Figures, study.json and report.html: add --out DIR")


def _print_topics(console: Console, study: Study) -> None:
    """Print the facts of all other topics as text."""
    for topic, texts in paragraphs(study.facts):
        console.print()
        console.print(Text(topic, style="bold"))
        shown = Padding(Text("\n".join(texts)), (0, 0, 0, 2), expand=False)
        console.print(shown, width=min(console.width, TEXT_WIDTH))


def _print_facts(console: Console, study: Study, topic: str, heading: str) -> None:
    """Print the facts of a topic with their labels, details indented."""
    facts = about(study.facts, topic)
    rows = [(f"  {fact.label}" if fact.detail else fact.label, fact.sentence) for fact in facts]
    print_rows(console, heading, rows, bold=CHANGES)


def print_rows(console: Console, title: str, rows: Iterable[tuple[str, str]], bold: Collection[str] = ()) -> None:
    """Print labels and what they say below a title: a table without lines; the words of the labels in ``bold`` stand out."""
    console.print()
    if title:
        console.print(Text(title, style="bold"))
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(no_wrap=True)
    table.add_column()
    for label, words in rows:
        table.add_row(Text(f"  {label}"), Text(words, style="bold" if label.strip() in bold else ""))
    console.print(table, width=min(console.width, TEXT_WIDTH))


def print_orbits(
    console: Console,
    case: Case,
    equilibria: tuple[SteadyMotion, ...],
    orbits: OrbitSet,
    whirls: Sequence[tuple[int, SlippingWhirl]],
) -> None:
    """Print equilibria and orbits, in units of the equations and in SI units; of compliant bearings slipping whirls too."""
    rotor, say = orbits.rotor, Wording(case.parameters.scales)
    _print_head(console, case, rotor)
    rows = simple_motion_rows(equilibria, orbits, say, most_virtual=40)
    if len(rotor.system.rest) > 1:
        for place, each in enumerate(equilibria):
            at = f" at touchdown bearing {listed([str(plane + 1) for plane in each.planes])}" if each.planes else ""
            rows[place] = dataclasses.replace(rows[place], name=f"{rows[place].name}{at}")
    for plane, whirl in whirls:
        speed, scales = whirl.speed, rotor.scales
        rate = f"{number(speed * scales.speed / math.tau, 4)} Hz" if scales else f"{number(speed, 4)} Ω"
        ends = "stability not judged" if whirl.slips else "rolls before it gets there"
        name = f"{Outcome.BACKWARD_WHIRL.words} at touchdown bearing {plane + 1}, {rate}; {ends}"
        size = f"r = {say.radius(whirl.radius)}"
        rows.append(MotionRow(name, "undecided", size=size, force=say.force(whirl.normal_force)))
    print_motions(console, "Equilibria and orbits with one impact a period", rows)
    _print_left_out(console, orbits, most_virtual=40)
    _print_numbers(console, [orbit for orbit in orbits if orbit.admissible or len(orbits) <= MOST_NUMBERS])
    if not rotor.has_closed_forms:
        console.print(f"{_why_only(rotor)} --impacts N searches longer, and for orbits with more impacts.")
    console.print(orbits.argument)


def _why_only(rotor: Rotor) -> str:
    """Which motions are no steady ones of a rotor without closed forms."""
    if rotor.system.is_anisotropic:
        return "Where bearings are anisotropic, rubs and whirls are not steady motions; carom attractors finds where motions end."
    if rotor.system.races is not None:
        return "On a spinning race, rubs and whirls are steady only where the torques on the race balance; they are listed as orbits."
    if rotor.system.forced is not None:
        return "Under gravity, rubs and whirls are not steady motions; --set gravity=0 shows those without weight."
    return "Whirls are those of the balanced rotor touching the bearing named alone; other bearings are not checked."


def print_found_orbits(console: Console, case: Case, found: OrbitSet) -> None:
    """Print the orbits with at most a number of impacts."""
    _print_head(console, case, found.rotor)
    title = f"Orbits with at most {counted(found.impacts, 'impact')} a period"
    if found.members:
        print_table(console, title, *table_of(FOUND_ORBIT, found, found))
    else:
        console.print(f"No orbit with at most {counted(found.impacts, 'impact')} a period was found.")
    _print_numbers(console, list(found))
    console.print(found.argument)


def _print_head(console: Console, case: Case, rotor: Rotor) -> None:
    """Print the name of a machine, and its dimensionless parameters or what it is in words."""
    parameters = ", ".join(f"{symbol} = {value}" for symbol, value in dimensionless_rows(case))
    words = parameters if rotor.has_closed_forms else rotor.words
    console.print(Text(f"{case.name}: {words}" if words else case.name))
    console.print()


def _print_numbers(console: Console, shown: Sequence[Orbit]) -> None:
    """Print states and multipliers of orbits."""
    if not shown:
        return
    styles = ["" if orbit.admissible else "dim" for orbit in shown]
    title = "Orbits in dimensionless units, just before the first impact"
    print_table(console, title, *table_of(ORBIT, shown, None), styles=styles)
    title = "Multipliers: growth factors of a small disturbance over one period"
    print_table(console, title, *table_of(MULTIPLIERS, shown, None), styles=styles)


def print_motions(console: Console, title: str, rows: Sequence[MotionRow]) -> None:
    """Print a table of motions; of a narrow screen remarks are left out, unless a motion is not possible."""
    if console.width < NARROW and all(row.state != "not possible" for row in rows):
        rows = [dataclasses.replace(row, remark="") for row in rows]
    cells = [[getattr(row, name) for name in MOTION_COLUMNS] for row in rows]
    print_table(
        console, title, list(MOTION_COLUMNS.values()), cells, styles=[_STYLES.get(row.state, "") for row in rows]
    )


def _print_left_out(console: Console, orbits: OrbitSet, most_virtual: int = 8) -> None:
    virtual = sum(not orbit.admissible for orbit in orbits)
    if virtual > most_virtual:
        console.print(f"{virtual} virtual orbits are left out; --json lists them.")


_SPARE = ("duration", "friction_impulse", "slip_after")
"""Columns of contacts that a narrow terminal leaves out, the first one first."""
FIRST_EVENTS, LAST_EVENTS = 20, 8
"""Numbers of contacts shown at the beginning and at the end of a long log."""


_FIRST = {"drop": "The fall:", "shock": "During the shock:"}
"""What the first stage of a motion is called, by the kind of the disturbance."""
_SINCE = {"drop": "the release", "shock": "the shock began", "kick": "the kick", "blade-loss": "the loss"}
"""From what times count."""


MOST_PARTS = 12
"""Stages of a motion that are shown one by one; of more only the last."""


def print_parts(console: Console, case: Case, motion: Trajectory, kind: str) -> None:
    """Print how a motion after a disturbance of a kind ended, and its contacts, stage by stage; then what the bearing bears in all."""
    parts = motion.parts if len(motion.parts) <= MOST_PARTS else motion.parts[-1:]
    if before := len(motion.parts) - len(parts):
        count = sum(len(seen.contacts) for part in motion.earlier for seen in part.at_each)
        console.print(f"In the {before} stages before: {counted(count, 'contact')}; --csv FILE has all.")
    for part in parts:
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
    if motion.scales or motion.rotor.acting.weight is not None or len(motion.rotor.system.rest) > 1:
        for seen in motion.at_each:
            console.print(_final_words(say, seen))
        return
    final = motion.final
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
    """Where the rotor is in a bearing at the end, and how fast, in the fixed frame."""
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
    if motion.rotor.acting.weight is not None:
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
        turned = 0.0 if motion.rotor.acting.weight is None else row["time"] / period
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
