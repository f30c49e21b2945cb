"""What touchdown bearings bear in a motion, for the terminal."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from rich.table import Table
from rich.text import Text

from carom.cli.tables import TEXT_WIDTH

if TYPE_CHECKING:
    from rich.console import Console

    from carom.studies import LoadCheck


def print_tables(console: Console, tables: Iterable[tuple[str, list[tuple[str, str]]]]) -> None:
    """Print the rows of each plane under its title."""
    for title, rows in tables:
        console.print()
        if title:
            console.print(Text(title, style="bold"))
        table = Table.grid(padding=(0, 2, 0, 0))
        table.add_column(no_wrap=True)
        table.add_column()
        for label, told in rows:
            table.add_row(Text(f"  {label}"), Text(told))
        console.print(table, width=min(console.width, TEXT_WIDTH))


def print_checks(console: Console, checks: Iterable[LoadCheck]) -> None:
    """Print loads against the limits that are stated; nothing if none is."""
    for number, check in enumerate(checks):
        if not number:
            console.print()
            console.print(Text("Limits of the touchdown bearing", style="bold"))
        words = Text(f"  {check.words}", style="bold" if check.exceeded else "")
        console.print(words, width=min(console.width, TEXT_WIDTH))
