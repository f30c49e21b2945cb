"""The progress bar on narrow terminals."""

import io
import re

import pytest
from rich.console import Console

from carom.cli.terminal import _bar


@pytest.mark.parametrize(
    ("words", "width"),
    [
        ("1,234,000 of 10,000,000 points, 1,230 points/s, 4.3 days left, 12 failed", 80),
        ("following starts (the kernels are compiled on first use)", 80),
        ("loading", 30),
    ],
)
def test_clock_and_words_stay_whole(words, width):
    bar = _bar()
    bar.update(bar.add_task(words, total=1.0), completed=0.4)
    screen = Console(file=io.StringIO(), width=width)
    screen.print(bar.make_tasks_table(bar.tasks))
    (line,) = screen.file.getvalue().splitlines()

    assert len(line.rstrip()) <= width
    assert re.search(r"[0-9-]:[0-9-]{2}:[0-9-]{2} ", line)
    assert line.rstrip().endswith(words)
