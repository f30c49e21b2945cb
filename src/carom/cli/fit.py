"""``carom fit``: parameters of a machine from measured displacements, through contact."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from carom.base.outcome import InputError
from carom.cli import options
from carom.cli.options import flag, option
from carom.cli.terminal import check_output, console, hand_over, progress, read_machine, write_output

if TYPE_CHECKING:
    from carom.fitting import Fit
    from carom.parameters import Case

DATA = typer.Argument(metavar="DATA", help="Displacements over time: a .csv, .mat or .nc file.")
FREE = option("NAMES", "Fit these parameters, such as friction,restitution,damping.", default="friction,restitution")
COLUMNS = option(
    "TEXT",
    "What the columns are, such as 'time [s], x [um], y at bearing 2 [um]', in their order or as name = what; by default their headings say so.",
)
DROPPED = flag("--dropped", "Levitation is lost all along the record.")
FITTED = "fitted.toml"
"""Name of the machine file with the fitted values."""


def fit(
    machine: str = options.MACHINE,
    data: str = DATA,
    settings: list[str] | None = options.SETTINGS,
    free: str = FREE,
    columns: str | None = COLUMNS,
    dropped: bool = DROPPED,
    out: str | None = options.OUT,
    as_json: bool = options.AS_JSON,
) -> None:
    """Fit parameters to measured displacements, through all contacts in them: values with intervals, and what the data do not determine."""
    case = read_machine(machine, settings)
    names = [each.strip() for each in free.split(",") if each.strip()]
    if not names:
        raise InputError("--free", free, "names of parameters, such as friction,restitution")
    check_output(out)
    with progress("fitting") as tell:
        from carom.fitting import fit as fitted
        from carom.fitting import read_record

        found = fitted(case, read_record(data, columns), names, dropped=dropped, progress=tell.part(0.0, 0.9))
        document = cache(lambda: {"name": case.name, **found.to_dict()})

        def write(path: Path) -> None:
            path.write_text(case.replace(**found.values).to_toml(), encoding="utf-8")

        write_output(out, case, "fit", document, {"fit": found.plot}, files={FITTED: write}, tell=tell.part(0.9, 1.0))
    hand_over(document, as_json, lambda: _print(case, found, out), out)


def _print(case: Case, found: Fit, out: str | None) -> None:
    from carom.base.results import table_of
    from carom.cli.screen import print_table
    from carom.fitting.fitted import ESTIMATE

    screen = console()
    screen.print(f"{case.name}: fit to {found.record.name}")
    screen.print()
    print_table(screen, "", *table_of(ESTIMATE, found.members, found))
    for sentence in found.sentences:
        screen.print(sentence)
    if out is None:
        screen.print(f"Figure, fit.json and {FITTED}: add --out DIR")
