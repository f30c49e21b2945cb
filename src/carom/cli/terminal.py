"""Options, output and progress that the commands share."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress

__all__ = ["AsJson", "InterruptionError", "MachineFile", "Settings", "console", "print_document", "progress"]

MachineFile = Annotated[str, typer.Argument(metavar="MACHINE.toml", help="The machine file.")]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Set a parameter, with units or dimensionless, such as 'damping=2000 N s/m' or gamma=0.1; repeatable.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]

PIPE_WIDTH = 140
"""Width of tables, in columns, if the output is not a terminal."""
PATIENCE = 0.7
"""Seconds before a progress bar appears."""
_CLOCK = len("0:00:00")


class InterruptionError(Exception):
    """A command was interrupted; the message says what was kept and how to resume."""


def console(errors: bool = False) -> Console:
    """Return a console for the output or the errors; plain text if the stream is not a terminal."""
    from carom.cli.screen import Screen

    stream = sys.stderr if errors else sys.stdout
    width = None if stream.isatty() else PIPE_WIDTH
    return Screen(file=stream, markup=False, highlight=False, emoji=False, width=width)


def print_document(document: dict[str, Any]) -> None:
    """Print one JSON object."""
    from carom.studies import as_json

    sys.stdout.write(as_json(document) + "\n")


@contextmanager
def progress(words: str) -> Iterator[Callable[[float, str], None]]:
    """Show a progress bar on the error stream for longer tasks; nothing if that stream is not a terminal.

    Parameters
    ----------
    words : str
        Description of the first step.

    Yields
    ------
    callable
        To be called with the share done, 0 to 1, and a description of the next step.
    """
    if not sys.stderr.isatty():
        yield lambda share, words: None
        return
    bar = _bar()
    task = bar.add_task(words, total=1.0)
    timer = threading.Timer(PATIENCE, bar.start)
    timer.daemon = True
    timer.start()
    try:
        yield lambda share, words: bar.update(task, completed=share, description=words)
    finally:
        timer.cancel()
        timer.join()
        bar.stop()


def _bar() -> Progress:
    """Return a bar with clock and words; a narrow terminal shortens first the bar, then the words, never the clock."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
    from rich.table import Column

    clock = TimeElapsedColumn(table_column=Column(no_wrap=True, min_width=_CLOCK))
    columns = (BarColumn(bar_width=30), clock, TextColumn("{task.description}", markup=False))
    return Progress(*columns, console=console(errors=True), transient=True)
