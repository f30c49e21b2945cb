"""Tables on narrow terminals."""

import io
import re

import pytest
from rich.console import Console

from carom.cli.screen import print_table

HEADINGS = ("what happens", "period", "disturbances", "note", "remark")
ROWS = (
    ("levitation", "5.81 ms", "116 of 200", "", "disturbances grow steadily to one side"),
    ("boundary equilibrium (persistence)", "12.6 ms", "", "", "friction keeps the rotor rolling"),
)


def shown(width):
    screen = Console(file=io.StringIO(), width=width)
    print_table(screen, "", HEADINGS, ROWS)
    return screen.file.getvalue()


@pytest.mark.parametrize("width", [140, 100, 80, 60, 51])
def test_no_cell_wraps_and_none_is_cut(width):
    text = shown(width)
    assert max(map(len, text.splitlines())) <= width
    for cell in filter(None, (cell for row in ROWS for cell in row)):
        assert cell in text


def test_nothing_is_lost_where_not_even_a_cell_fits():
    text = shown(30)
    assert max(map(len, text.splitlines())) <= 30
    words = set(re.findall(r"[^\s─]+", text))
    assert words >= {word for row in ROWS for cell in row for word in cell.split()}


def test_a_column_that_is_empty_is_left_out():
    assert "note" not in shown(140)
    assert "remark" in shown(140)


@pytest.mark.parametrize(("width", "left"), [(120, True), (80, False)])
def test_a_column_that_can_be_spared_is_left_out_where_there_is_no_room(width, left):
    screen = Console(file=io.StringIO(), width=width)
    print_table(screen, "", HEADINGS, ROWS, spare=("remark",))
    assert ("remark" in screen.file.getvalue()) == left
