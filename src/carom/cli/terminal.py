"""Options, output and progress that the commands share."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from carom.base.progress import Reporter, bar

if TYPE_CHECKING:
    from rich.console import Console

    from carom.parameters import Case

WIDTH = 80
"""Width of texts and tables, in columns, if the output is no terminal and ``COLUMNS`` is not set."""


class InterruptionError(Exception):
    """A command was interrupted; the message says what was kept and how to resume."""


def console(errors: bool = False) -> Console:
    """Return a console for the output or the errors; plain text if the stream is not a terminal."""
    from carom.cli.screen import Screen

    stream = sys.stderr if errors else sys.stdout
    columns = os.environ.get("COLUMNS", "")
    # Without a width rich takes that of any terminal it finds, also if the output goes elsewhere.
    width = None if stream.isatty() else int(columns) if columns.isdecimal() and int(columns) else WIDTH
    return Screen(file=stream, markup=False, highlight=False, emoji=False, width=width)


def check_output(out: str | None, option: str = "--out") -> None:
    """Refuse early a directory for output that cannot be written."""
    if out is not None:
        from carom.base.files import check_directory

        check_directory(out, option)


def print_document(document: dict[str, object]) -> None:
    """Print one JSON object."""
    from carom.base.files import as_json

    sys.stdout.write(as_json(document) + "\n")


@contextmanager
def progress(step: str) -> Iterator[Reporter]:
    """Show a bar on the error stream for longer tasks; nothing if that stream is not a terminal.

    `step` describes the first step.  The reporter can be handed on as ``progress``.
    """
    if not sys.stderr.isatty():
        yield Reporter()
        return
    with bar(step, console(errors=True)) as shown:
        yield shown


def read_machine(machine: str, settings: list[str] | None) -> Case:
    """Load a machine file with the settings of ``--set``; of a flexible machine this takes seconds."""
    with progress("reading the machine"):
        from carom.loading import load

        return load(machine, settings or ())
