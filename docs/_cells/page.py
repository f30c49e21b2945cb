"""What the cells of the documentation share: tables in Markdown, numbers as text, figures as vectors."""

from __future__ import annotations

import io
import os
import shlex
import subprocess
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from IPython import get_ipython
from IPython.display import Markdown
from matplotlib.figure import Figure

__all__ = ["checks", "command_help", "number", "table", "terminal"]

ROOT = Path(__file__).parent.parent.parent
"""Folder in which the commands of the documentation are run."""


def number(value: object, digits: int = 10) -> str:
    """A number with that many significant digits, yes or no; anything else as it is."""
    if value is None:
        return "–"
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if not isinstance(value, (int, float, complex)):
        return str(value)
    if isinstance(value, complex):
        return f"{value.real:.{digits}g} {'+' if value.imag >= 0 else '−'} {abs(value.imag):.{digits}g} i"
    return f"{value + 0.0:.{digits}g}".replace("-", "−")


def table(headings: Sequence[str], rows: Iterable[Sequence[object]], digits: int = 10) -> Markdown:
    """A Markdown table.  Vertical bars in headings and entries are escaped."""

    def line(entries: Iterable[str]) -> str:
        return "| " + " | ".join(entry.replace("|", "\\|").replace("\n", " ") for entry in entries) + " |"

    stated = (line(number(entry, digits) for entry in row) for row in rows)
    return Markdown("\n".join([line(headings), "|" + "---|" * len(headings), *stated]))


def checks(rows: Iterable[tuple[str, float, float]]) -> Markdown:
    """A table of claims, each with its largest error and the error allowed; an error above it stops the build."""
    shown = []
    for words, error, allowed in rows:
        if not abs(error) <= allowed:
            raise ArithmeticError(f"{words}: error {error:.3g}, allowed {allowed:.3g}")
        shown.append((words, f"{abs(error):.1e}" if error else "0", f"{allowed:.0e}" if allowed else "0"))
    return table(("checked here", "largest error", "allowed"), shown)


def command_help(*words: str) -> str:
    """What a command prints with ``--help``."""
    command = [sys.executable, "-m", "carom", *words, "--help"]
    return subprocess.run(command, capture_output=True, text=True, check=True, env=_plain_terminal()).stdout


def terminal(command: str, *, lines: int | None = None, folder: Path = ROOT) -> None:
    """Run a command line that begins with ``carom``, and print it with what it prints, or with its first lines."""
    program, *words = shlex.split(command)
    if program != "carom":
        raise ValueError(f"a command of carom is expected: {command}")
    call = [sys.executable, "-m", "carom", *words]
    done = subprocess.run(call, capture_output=True, text=True, check=False, env=_plain_terminal(), cwd=folder)
    if done.returncode:
        raise RuntimeError(f"{command}\n{done.stderr}")
    shown = [line.rstrip() for line in done.stdout.splitlines()]
    print("\n".join([f"$ {command}", *(shown if lines is None or len(shown) <= lines else [*shown[:lines], "…"])]))


def _plain_terminal() -> dict[str, str]:
    return {**os.environ, "COLUMNS": "100", "TERM": "dumb", "NO_COLOR": "1"}


def _as_svg(figure: Figure) -> str:
    content = io.StringIO()
    figure.savefig(content, format="svg", metadata={"Date": None})
    return content.getvalue()


if shell := get_ipython():
    shell.display_formatter.formatters["image/svg+xml"].for_type(Figure, _as_svg)
