"""Figures of a report: drawn into files, and embedded in its page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from carom import plots
from carom.base.files.directory import FIGURES
from carom.base.progress import Reporter
from carom.report.html import InlineFigure, inline_figure


@dataclass(frozen=True)
class ReportPicture:
    """A figure to draw.

    Attributes
    ----------
    name : str
        File name without ending.
    section : str
        Section of the page in which it stands.
    caption : str
        What to see, in a sentence.
    draw : callable
        Returns the figure.
    """

    name: str
    section: str
    caption: str
    draw: Callable[[], Figure]


def draw_figures(wanted: Sequence[ReportPicture], place: Path, tell: Reporter) -> tuple[list[InlineFigure], list[str]]:
    """Draw figures into a directory, as SVG and PNG; return them for the page, and the names of their files."""
    (place / FIGURES).mkdir()
    inline, names = list[InlineFigure](), list[str]()
    for done, picture in enumerate(wanted):
        tell(done / len(wanted), f"figure {done + 1} of {len(wanted)}")
        paths = plots.save(picture.draw(), place / FIGURES / picture.name)
        names += [f"{FIGURES}/{path.name}" for path in paths]
        text = paths[0].read_text(encoding="utf-8")
        inline.append(inline_figure(picture.section, picture.caption, text, f"f{done + 1}-"))
    return inline, names
