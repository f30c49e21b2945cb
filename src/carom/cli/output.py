"""The directory into which a command writes its figures and its document, all of them or none."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom.cli.terminal import console

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from carom.parameters import Case


@dataclass(frozen=True)
class Output:
    """A directory that is being filled."""

    directory: Path

    def figure(self, name: str, figure: Figure) -> None:
        """Write a figure as SVG and PNG."""
        from carom import plots
        from carom.base.files.directory import FIGURES

        plots.save(figure, self.directory / FIGURES / name)

    def document(self, name: str, document: dict[str, Any]) -> None:
        """Write a document as JSON."""
        from carom.base.files import write_json

        write_json(self.directory / f"{name}.json", document)


@contextmanager
def output_directory(out: str, case: Case) -> Iterator[Output]:
    """Fill the directory of ``--out``; figures made meanwhile show the name and the present values of the machine."""
    from carom.base.files import staged_directory
    from carom.plots import heading
    from carom.studies.wording import machine_heading

    with staged_directory(out, "--out") as directory, heading(machine_heading(case)):
        yield Output(directory)


def say_where(out: str | None) -> None:
    """Say where the files are, on the error stream."""
    if out is not None:
        console(errors=True).print(f"Written to {out}", soft_wrap=True)
