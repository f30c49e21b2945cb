"""``carom attractors``: the motions on which disturbances end."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from carom.base.outcome import IRREGULAR_BOUNCING
from carom.cli import options
from carom.cli.options import flag, option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine, write_output

if TYPE_CHECKING:
    from carom.attractors import AttractorSet
    from carom.orbits import LyapunovExponents
    from carom.parameters import Case


STARTS = option("N", "Number of disturbances to follow.", default=200, min=1, max=1_000_000)
EXPONENTS = flag("--exponents", "Show all Lyapunov exponents, with their standard errors.")


def attractors(
    machine: str = options.MACHINE,
    settings: list[str] | None = options.SETTINGS,
    starts: int = STARTS,
    seed: int | None = options.SEED,
    exponents: bool = EXPONENTS,
    out: str | None = options.OUT,
    as_json: bool = options.AS_JSON,
) -> None:
    """List the motions in which disturbances end: levitation, rest, rub, whirl, periodic and irregular bouncing.

    Irregular bouncing is followed further to measure how long it lasts, as it may be a
    transient.  Motions that no disturbance of the sample reaches are not listed.
    """
    case = read_machine(machine, settings)
    check_output(out)
    with progress("attractors (the kernels are compiled on first use)") as tell:
        from carom.attractors import DisturbanceSet, exponents_of, find_attractors
        from carom.studies.document import attractors_document

        tried = DisturbanceSet(starts, seed or 0, case.requirement.own(case.parameters.scales).kick)
        found = find_attractors(case, tried, progress=tell)
        known = [exponents_of(case, entry) for entry in found]
        document = cache(lambda: attractors_document(found, known if exponents else None))
        write_output(out, case, "attractors", document, {"attractors": found.plot})
    hand_over(document, as_json, lambda: _print(case, found, known, exponents), out)


def _print(case: Case, found: AttractorSet, known: list[LyapunovExponents | None], exponents: bool) -> None:
    """Print a table of the attractors, and what the rotor does on each below it."""
    from carom.base.results import table_of
    from carom.basins import share_of_kicks
    from carom.cli.screen import print_table
    from carom.studies.document import SEEN
    from carom.studies.summaries import ACROSS, MEASURED

    screen = console()
    measured = list(zip(found, known, strict=True))
    headings, rows = table_of(SEEN, found, found)
    across, cells = table_of(ACROSS, measured, found)
    screen.print(f"{case.name}: {found.words()}")
    screen.print()
    shown = [row + cell for row, cell in zip(rows, cells, strict=True)]
    print_table(screen, "Motions in which disturbances end", headings + across, shown)
    if share := share_of_kicks(found):
        screen.print(f"{share.words}.")
    for entry in found:
        screen.print(f"{entry.name.words}: {entry.words}")
    if found.transient:
        screen.print(f"{IRREGULAR_BOUNCING.capitalize()} of some disturbances ended: {found.transient.words}.")
    if exponents:
        screen.print()
        note = "In Ω, ± standard errors; -inf: contact removes this direction."
        print_table(screen, "Lyapunov exponents", *table_of(MEASURED, measured, found), note=note)
    screen.print()
    screen.print(found.argument)
