"""Output, progress and the machine that is read; what a command hands over: a directory of figures and numbers, and then JSON or a text."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from carom.base.progress import Reporter, bar

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

    from carom.parameters import Case

    Drawings = dict[str, Callable[[], Figure]]

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


def write_output(
    out: str | None,
    case: Case,
    name: str,
    document: Callable[[], dict[str, object]],
    figures: Drawings,
    *,
    files: Mapping[str, Callable[[Path], None]] = MappingProxyType({}),
    tell: Reporter | None = None,
) -> None:
    """Fill the directory of ``--out``, if one is given, with figures, files and the document.

    Figures show the name and the present values of the machine.
    """
    if out is None:
        return
    from carom import plots
    from carom.base.files import FIGURES, staged_directory, write_json
    from carom.studies.wording import machine_heading

    tell = tell or Reporter()
    with staged_directory(out, "--out") as directory, plots.heading(machine_heading(case)):
        for place, (figure, draw) in enumerate(figures.items()):
            tell(place / len(figures), "drawing")
            plots.save(draw(), directory / FIGURES / figure)
        tell(1.0, "writing")
        for file, write in files.items():
            write(directory / file)
        write_json(directory / f"{name}.json", document())


def hand_over(
    document: Callable[[], dict[str, object]], as_json: bool, show: Callable[[], None], out: str | None, *files: str
) -> None:
    """Print the document, or what ``show`` prints; then where the files are, if ``--out`` is given: beside JSON on the error stream."""
    if as_json:
        from carom.base.files import as_json as in_json

        sys.stdout.write(in_json(document()) + "\n")
    else:
        show()
    for line in () if out is None else files or (f"Written to {out}",):
        console(errors=as_json).print(line, soft_wrap=True)
