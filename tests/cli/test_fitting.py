"""Tables on narrow terminals."""

from __future__ import annotations

import io
import re

import pytest
from rich import box
from rich.console import Console
from rich.table import Table

from carom.cli.fitting import fitted

ROWS = (
    ("levitation", "5.81 ms", "116 of 200", "disturbances grow steadily to one side"),
    ("boundary equilibrium (persistence)", "12.6 ms", "", "friction keeps the rotor rolling"),
)


def shown(width, rows=ROWS):
    screen = Console(file=io.StringIO(), width=width)
    table = Table(box=box.SIMPLE_HEAD)
    for place, heading in enumerate(("what happens", "period", "disturbances", "remark")):
        table.add_column(heading, no_wrap=place in (1, 2))
    for row in rows:
        table.add_row(*row)
    screen.print(fitted(screen, table))
    return screen.file.getvalue()


@pytest.mark.parametrize("width", [140, 100, 80, 60, 51])
def test_no_word_and_no_number_is_cut(width):
    text = shown(width)
    assert max(map(len, text.splitlines())) <= width
    assert "…" not in text
    words = set(re.findall(r"[^\s─]+", text))
    assert words >= {word for row in ROWS for cell in row for word in cell.split()}
    for number in ("5.81 ms", "12.6 ms", "116 of 200"):
        assert number in text


def test_nothing_is_lost_where_words_cannot_stay_whole():
    text = shown(30)
    assert max(map(len, text.splitlines())) <= 30
    assert "…" not in text
    letters = sorted(re.sub(r"[\s─]", "", text))
    headings = "what happens period disturbances remark"
    expected = "".join(cell for row in ROWS for cell in row) + headings
    assert letters == sorted(re.sub(r"\s", "", expected))


def test_an_empty_column_takes_no_words():
    screen = Console(file=io.StringIO(), width=40)
    table = Table(box=box.SIMPLE_HEAD)
    for heading in ("what happens", "", "remark"):
        table.add_column(heading)
    table.add_row("boundary equilibrium (persistence)", "", "friction keeps the rotor rolling")
    screen.print(fitted(screen, table))
    text = screen.file.getvalue()

    assert max(map(len, text.splitlines())) <= 40
    assert "equilibrium" in text


def test_a_table_with_room_is_left_as_it_is():
    screen, table = Console(file=io.StringIO(), width=80), Table(box=box.SIMPLE_HEAD)
    table.add_column("speed")
    table.add_row("1.29 mm/s")
    before = (table.padding, table.pad_edge)
    fitted(screen, table)
    assert (table.padding, table.pad_edge) == before
    assert table.columns[0].width is None
