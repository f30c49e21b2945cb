"""Tables on narrow terminals: text columns wrap and gaps shrink, but no word and no number is cut."""

from __future__ import annotations

import textwrap
from collections.abc import Collection
from typing import TYPE_CHECKING

from rich import box
from rich.cells import cell_len
from rich.table import Table

if TYPE_CHECKING:
    from rich.console import Console

_PADDINGS = ((0, 1, 0, 0), (0, 0))
"""Paddings between columns, from wide to narrow; the box adds one to each."""


def plain_table(title: str, *headings: str, right: Collection[str] = (), no_wrap: Collection[str] = ()) -> Table:
    """Return a table with a title and headings; the columns in `right` are flush right."""
    table = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, pad_edge=False)
    for heading in headings:
        table.add_column(heading, justify="right" if heading in right else "left", no_wrap=heading in no_wrap)
    return table


def fitted(screen: Console, table: Table) -> Table:
    """Fit a table of plain text, with all its rows, to the screen: choose column widths at which words stay whole.

    Columns that do not wrap keep their cells in one line; their headings wrap.  Return the same table.
    """
    if screen.measure(table, options=screen.options.update(width=10_000)).maximum <= screen.width:
        return table
    texts = [[str(column.header), *map(str, column.cells)] for column in table.columns]
    most = [max(_widest(text.splitlines()) for text in column) for column in texts]
    least = [
        max(
            _widest(text.splitlines() if place and whole.no_wrap else text.split()) for place, text in enumerate(column)
        )
        for column, whole in zip(texts, table.columns, strict=True)
    ]
    gaps = 2 + len(least) - 1
    table.pad_edge = False
    for padding in _PADDINGS:
        table.padding = padding
        room = screen.width - gaps - sum(padding[1::2]) * (len(least) - 1)
        if sum(least) <= room:
            break
    else:
        # Not even the words fit: the longest ones are broken, but no text is lost.
        while sum(least) > max(room, len(least)):
            least[least.index(max(least))] -= 1
    widths = _widened(least, most, room)
    for column, width in zip(table.columns, widths, strict=True):
        column.width, column.overflow, column.no_wrap = width, "fold", False
        column.header = textwrap.fill(str(column.header), width)
    return table


def _widest(parts: list[str]) -> int:
    return max(map(cell_len, parts), default=0) or 1  # a column may be empty


def _widened(least: list[int], most: list[int], room: int) -> list[int]:
    """Widen columns to use the available width: each step widens the column that would have the most lines."""
    widths = list(least)
    for _ in range(room - sum(widths)):
        crowded = [high / width if width < high else 0.0 for width, high in zip(widths, most, strict=True)]
        if not any(crowded):
            break
        widths[crowded.index(max(crowded))] += 1
    return widths
