"""``carom drop --recovery``: the share of drops that come back with each recovery of the file, and without its action."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from carom.cli.options import flag, option
from carom.cli.terminal import console, hand_over, progress, write_output

if TYPE_CHECKING:
    from rich.console import Console

    from carom.basins import Recoveries
    from carom.parameters import Case

RECOVERY = flag(
    "--recovery",
    "Compare the tables [[recovery]] of the file: the share of many drops that comes back, with each action and without.",
)
DROPS = option("N", "With --recovery: number of drops; 100 by default.", min=1)
KICKS_UP_TO = option(
    "SPEED",
    "With --recovery: each drop begins with a kick of up to this speed, such as '100 mm/s'; by default with none.",
)


def compare_recoveries(
    case: Case,
    drops: int | None,
    kicks: str | None,
    seed: int | None,
    until: str | None,
    out: str | None,
    as_json: bool,
) -> None:
    """Follow the drops by each recovery, and tell how many come back."""
    from carom.cli.starts import read_positive, read_time

    scales = case.parameters.scales
    fastest = 0.0 if kicks is None else read_positive("--kicks-up-to", kicks, "velocity", scales)
    end = read_time(until, scales)
    with progress("following drops (the kernels are compiled on first use)") as tell:
        from carom.basins.recoveries import DROPS, compare_recoveries

        found = compare_recoveries(
            case, (), drops or DROPS, kicks_up_to=fastest, until=end, seed=seed or 0, progress=tell
        )
        document = cache(lambda: {"name": case.name, **found.document()})
        write_output(out, case, "recovery", document, {})
    hand_over(document, as_json, lambda: _print(console(), found), out)


def _print(screen: Console, found: Recoveries) -> None:
    """Print the table, and what each recovery is."""
    from carom.cli.screen import print_table
    from carom.cli.tables import TEXT_WIDTH

    width = min(screen.width, TEXT_WIDTH)
    screen.print(f"{found.words}.", width=width)
    print_table(screen, "", *found.table())
    for row in found.each:
        screen.print(f"{row.recovery.name}: {row.recovery.words}.", width=width)
