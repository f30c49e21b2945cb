"""The progress bar on narrow terminals, and no control character of a text on any."""

import io
import json
import re

import pytest
from rich.console import Console
from rich.table import Table
from rich.text import Text

from carom.base.progress import _bar
from carom.cli.app import app, main
from carom.cli.screen import Screen
from carom.cli.terminal import hand_over


@pytest.mark.parametrize(
    ("words", "width"),
    [
        ("1,234,000 of 10,000,000 points, 1,230 points/s, 4.3 days left, 12 failed", 80),
        ("following starts (the kernels are compiled on first use)", 80),
        ("loading", 60),
    ],
)
def test_clocks_stay_whole_and_words_are_shortened_at_their_end(words, width):
    screen = Console(file=io.StringIO(), width=width)
    bar = _bar(screen)
    bar.update(bar.add_task(words, total=1.0), completed=0.4)
    screen.print(bar.make_tasks_table(bar.tasks))
    (line,) = screen.file.getvalue().splitlines()

    assert len(line.rstrip()) <= width
    assert re.search(r" 40% 0:00:00 -:--:-- ", line)
    shown = line.rstrip().rpartition("-:--:-- ")[2].rstrip("…")
    assert words.startswith(shown)
    assert len(shown) >= min(len(words), 30)


@pytest.mark.parametrize("columns", ["80", "100"])
@pytest.mark.parametrize("command", ["", *(entry.name for entry in app.registered_commands)])
def test_help_is_not_cut_off(monkeypatch, capsys, command, columns):
    monkeypatch.setenv("COLUMNS", columns)
    assert main([*command.split(), "--help"]) == 0
    text = capsys.readouterr().out

    assert max(map(len, text.splitlines())) <= int(columns)
    assert "…" not in text
    assert "..." not in text.replace("[ARGS]...", "")
    plain = " ".join(text.split())
    listed = app.registered_commands if not command else ()
    assert all(str(entry.short_help) in plain for entry in listed)


EVIL = "a\x1b[2J\u202e\x9b\x7fb"
SHOWN = "a\\x1b[2J\\u202e\\x9b\\x7fb"


def test_a_printed_text_is_one_printable_line():
    screen = Screen(file=io.StringIO(), width=80)
    screen.print(f"Written to {EVIL}\n\u2028x")

    assert screen.file.getvalue() == f"Written to {SHOWN}\\n\\u2028x\n"


def test_texts_in_tables_and_bars_are_printable():
    screen = Screen(file=io.StringIO(), width=80)
    table = Table(title=EVIL)
    table.add_column(EVIL)
    table.add_row(EVIL)
    table.add_row(Text(EVIL, style="bold"))
    bar = _bar(screen)
    bar.update(bar.add_task(EVIL, total=1.0), completed=0.4)
    screen.print(table)
    screen.print(bar.make_tasks_table(bar.tasks))
    text = screen.file.getvalue()

    assert text.replace("\n", "").isprintable()
    assert text.count("a\\x1b") == 5


def test_json_is_printable_and_holds_what_was_given(capsys):
    hand_over(lambda: {EVIL: [f"{EVIL}\n\ud800\U000e0001", "γ"]}, True, lambda: None, None)
    text = capsys.readouterr().out

    assert text.replace("\n", "").isprintable()
    assert "γ" in text
    assert json.loads(text) == {EVIL: [f"{EVIL}\n\ud800\U000e0001", "γ"]}
