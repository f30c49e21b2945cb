"""``carom template``: a machine file with all its entries, to be filled in."""

from __future__ import annotations

from pathlib import Path

import typer

from carom.base.outcome import InputError, shown
from carom.cli.options import option

TEMPLATES = ("planar", "rigid", "flexible")
"""Kinds of machines, of which each has a file in the folder ``templates``: one mass in a plane, one that tilts, one that bends."""


KIND = typer.Argument(
    metavar="KIND", help="Kind of machine: planar (one mass), rigid (it tilts) or flexible (it bends)."
)
OUT = option("FILE", "Write it to this new file instead of the screen.", "--out", "-o")


def template(kind: str = KIND, out: str | None = OUT) -> None:
    """Print a working machine file with every entry explained: copy it and replace the values."""
    if kind not in TEMPLATES:
        raise InputError("KIND", shown(kind), f"one of {', '.join(TEMPLATES)}")
    text = Path(__file__).with_name("templates").joinpath(f"{kind}.toml").read_text(encoding="utf-8")
    if out is None:
        typer.echo(text, nl=False)
        return
    try:
        with Path(out).open("x", encoding="utf-8") as stream:
            stream.write(text)
    except FileExistsError:
        raise InputError("--out", shown(out), "a file that does not exist yet (nothing is overwritten)") from None
