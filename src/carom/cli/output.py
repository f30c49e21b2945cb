"""What a command hands over: a directory of figures and numbers, all of them or none, and then one object of JSON or a text."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from carom.base.progress import Reporter
from carom.cli.terminal import console, print_document

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from carom.parameters import Case

_NO_FILES: Mapping[str, Callable[[Path], None]] = MappingProxyType({})


def write_output(
    out: str | None,
    case: Case,
    name: str,
    document: dict[str, Any],
    figures: Mapping[str, Callable[[], Figure]],
    *,
    files: Mapping[str, Callable[[Path], None]] = _NO_FILES,
    tell: Reporter | None = None,
) -> None:
    """Fill the directory of ``--out``, if one is given, with figures, files and the document.

    Figures show the name and the present values of the machine.
    """
    if out is None:
        return
    from carom import plots
    from carom.base.files import staged_directory, write_json
    from carom.base.files.directory import FIGURES
    from carom.studies.wording import machine_heading

    tell = tell or Reporter()
    with staged_directory(out, "--out") as directory, plots.heading(machine_heading(case)):
        for place, (figure, draw) in enumerate(figures.items()):
            tell(place / len(figures), "drawing")
            plots.save(draw(), directory / FIGURES / figure)
        tell(1.0, "writing")
        for file, write in files.items():
            write(directory / file)
        write_json(directory / f"{name}.json", document)


def hand_over(
    document: Callable[[], dict[str, Any]], as_json: bool, show: Callable[[], None], out: str | None, *files: str
) -> None:
    """Print the document, or what ``show`` prints; then where the files are, if ``--out`` is given: beside JSON on the error stream."""
    if as_json:
        print_document(document())
    else:
        show()
    for line in () if out is None else files or (f"Written to {out}",):
        console(errors=as_json).print(line, soft_wrap=True)
