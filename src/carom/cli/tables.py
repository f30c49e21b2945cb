"""Results as tables for the terminal."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Iterable, Sequence
from typing import TYPE_CHECKING

from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from carom.base.outcome import Outcome
from carom.cli.fitting import print_table
from carom.parameters.columns import table_of
from carom.parameters.formats import number
from carom.studies import Study, Wording
from carom.studies.advice_facts import CHANGES
from carom.studies.document import FOUND_ORBIT, MULTIPLIERS, ORBIT
from carom.studies.facts import Topic, about, paragraphs
from carom.studies.summaries import (
    MOTION_COLUMNS,
    MotionRow,
    State,
    dimensionless_rows,
    motion_rows,
    simple_motion_rows,
)
from carom.studies.wording import counted, listed

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
        console.print("All that was found, and the table of motions: --long")
    if out is None:
        console.print("Figures, study.json and report.html: add --out DIR")


def _print_topics(console: Console, study: Study) -> None:
    """Print the facts of all other topics as text."""
    for topic, texts in paragraphs(study.facts):
        console.print()
        console.print(Text(topic, style="bold"))
        shown = Padding(Text("\n".join(texts)), (0, 0, 0, 2), expand=False)
        console.print(shown, width=min(console.width, TEXT_WIDTH))


def _print_facts(console: Console, study: Study, topic: Topic, heading: str) -> None:
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
        return "On a spinning race, rubs and whirls are steady only where its torques balance: as orbits, if there are any."
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
    title = "Orbits in the units of the equations, just before the first impact"
    print_table(console, title, *table_of(ORBIT, shown, None), styles=styles)
    title = "Multipliers: a small disturbance is multiplied by these in a period"
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
        console.print(f"{virtual} orbits that are not possible are left out; --json lists them.")
