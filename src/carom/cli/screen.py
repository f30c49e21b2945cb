"""Output to the terminal: safe for any names and file contents, and tables that fit into a narrow one, in which no word and no number is cut."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment
from rich.text import Text

from carom.base.outcome import printable


class Screen(Console):
    """A console that shows control characters in texts as escapes; its own colours and cursor control still work.

    A plain text is printed as one line.  Line breaks inside tables and other renderables are kept.
    """

    def print(self, *objects: object, **options: Any) -> None:
        """Print as :meth:`rich.console.Console.print` does."""
        super().print(*(printable(thing) if isinstance(thing, str) else thing for thing in objects), **options)

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """Render as :meth:`rich.console.Console.render` does."""
        for segment in super().render(renderable, options):
            if segment.control or segment.text.isprintable():
                yield segment
            else:
                yield Segment("\n".join(map(printable, segment.text.split("\n"))), segment.style)


_NUMBER = re.compile(r"([-+−]?(\d|inf\b|nan\b)|up to \d|-$|…$)")
_LONGEST = 24
"""Characters of a number with its unit and its interval; what is longer is text."""
_GAPS = (2, 1)
"""Columns of the terminal between those of a table, on a wide and on a narrow one."""


def print_table(
    screen: Console,
    title: str,
    headings: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    styles: Sequence[str] = (),
    note: str = "",
    spare: Sequence[str] = (),
) -> None:
    """Print rows of text below their headings.

    A column that is empty in all rows is left out; one of numbers is flush right.  Cells never wrap: where the screen has no room, columns
    that can be spared are left out in their order, and then the widest stand below their row, each with its heading.
    """
    columns = {heading: [row[place] for row in rows] for place, heading in enumerate(headings)}
    columns = {heading: cells for heading, cells in columns.items() if any(cells)}
    widths = {heading: _widest([*cells, *heading.split()]) for heading, cells in columns.items()}
    for heading in spare:
        if _room(screen.width, widths, _GAPS[-1]) < 0:
            widths.pop(heading, None)
    below: list[str] = []
    while (room := _room(screen.width, widths, _GAPS[-1])) < 0 and len(widths) > 1:
        others = list(widths)[1:]
        below.append(max(others, key=lambda heading: widths[heading]))
        del widths[below[-1]]
    gap = next((each for each in _GAPS if _room(screen.width, widths, each) >= 0), _GAPS[-1])
    room = _room(screen.width, widths, gap)
    for heading in widths:  # a heading wraps only where the screen has no room for it
        more = min(max(0, cell_len(heading) - widths[heading]), max(0, room))
        widths[heading], room = widths[heading] + more, room - more
    flush = {
        heading
        for heading in widths
        if all(len(cell) <= _LONGEST and _NUMBER.match(cell) for cell in columns[heading] if cell)
    }

    def line(cells: Sequence[str]) -> str:
        padded = []
        for (heading, width), cell in zip(widths.items(), cells, strict=True):
            blank = " " * (width - cell_len(cell))
            padded.append(blank + cell if heading in flush else cell + blank)
        return (" " * gap).join(padded).rstrip()

    if title:
        screen.print(Text(title, style="bold"))
    wrapped = [textwrap.wrap(heading, widths[heading]) or [""] for heading in widths]
    depth = max(map(len, wrapped), default=0)
    for at in range(depth):
        screen.print(line([lines[at - depth + len(lines)] if at >= depth - len(lines) else "" for lines in wrapped]))
    screen.print("─" * min(screen.width, sum(widths.values()) + gap * (len(widths) - 1)))
    order = sorted(below, key=list(columns).index)
    for place in range(len(rows)):
        style = styles[place] if styles else ""
        screen.print(Text(line([columns[heading][place] for heading in widths]), style=style))
        for heading in order:
            if cell := columns[heading][place]:
                text = f"{heading}: {cell}" if heading else cell
                screen.print(Text(textwrap.indent(textwrap.fill(text, max(20, screen.width - 4)), "    "), style=style))
    if note:
        screen.print(note)
    screen.print()


def _widest(texts: Sequence[str]) -> int:
    return max(map(cell_len, texts), default=1)


def _room(width: int, widths: dict[str, int], gap: int) -> int:
    """What is left of the width of a screen beside columns; negative if they do not fit."""
    return width - sum(widths.values()) - gap * (len(widths) - 1)
