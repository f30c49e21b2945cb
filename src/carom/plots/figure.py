"""Figures that carry carom's style sheet to every file and notebook, whoever writes or shows them; files are the same bytes every time."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import numpy as np
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import PlaceHolderLayoutEngine
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.ticker import ScalarFormatter
from matplotlib.transforms import Bbox

from carom.base.arguments import checked
from carom.base.files import write_whole
from carom.base.outcome import InputError

Purpose = Literal["page", "column", "slide"]
Format = Literal["svg", "pdf", "png"]

ONE_COLUMN, TWO_COLUMNS = 88 / 25.4, 180 / 25.4
"""Widths of figures of one column and of two [inch]."""
_SHEETS = ["carom.plots.carom", "carom.plots.slide"]
_in_use = ContextVar("_in_use", default=False)
made_for: ContextVar[Purpose] = ContextVar("made_for", default="page")
"""What figures are made for now."""


@contextmanager
def applied() -> Iterator[None]:
    """Apply carom's style sheet inside a ``with`` block.

    The sheet starts from matplotlib's defaults, so a figure does not depend on the settings of the user.  When the
    block ends, ``matplotlib.rcParams`` is restored.  Inside such a block nothing is changed: changing all settings takes
    milliseconds.
    """
    if _in_use.get():
        yield
        return
    with style.context(_SHEETS[: 1 + (made_for.get() == "slide")], after_reset=True):
        before = _in_use.set(True)
        try:
            yield
        finally:
            _in_use.reset(before)


@contextmanager
def drawing() -> Iterator[None]:
    """Apply the style sheet for a drawing, with the garbage collector switched off.

    A figure consists of tens of thousands of small objects that refer to each other. Collecting garbage while they are
    created finds none, and takes a quarter of the time.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        with applied():
            yield
    finally:
        if collecting:
            gc.enable()


_heading: ContextVar[str] = ContextVar("_heading", default="")


@checked
@contextmanager
def heading(text: str) -> Iterator[None]:
    """Write a line above every figure made inside a ``with`` block, such as the name of the machine."""
    before = _heading.set(text)
    try:
        yield
    finally:
        _heading.reset(before)


_MARGIN = 3.0
"""Least distance of a title or a legend from the left and right edge of a figure [pt]."""
_SLIDES = (6.4, 3.6), (9.6, 5.4)
"""Sizes of slides [inch]: the second for figures that are higher on a page."""
_HIGH = 4.4
"""Height of a figure from which on it is one of these [inch]."""
_WIDE, _SIDE = 0.6, 0.36
"""Height over width from which on the legend of a slide stands on the right, and the largest share of the width that it takes there."""


@checked
@contextmanager
def figures_for(purpose: Purpose) -> Iterator[None]:
    """Make figures for a purpose inside a ``with`` block.

    Parameters
    ----------
    purpose : {"page", "column", "slide"}
        A page of print, as without; one column, readable on a telephone, with panels below each other; or a slide of 16:9 with large type.
    """
    before = made_for.set(purpose)
    try:
        yield
    finally:
        made_for.reset(before)


def narrow() -> bool:
    """Whether figures are made one column wide now."""
    return made_for.get() == "column"


class StyledFigure(Figure):
    """A figure that is drawn, saved and shown in carom's style, whatever the settings are at that time.

    Matplotlib reads many settings only when it draws or writes: the resolution and background of files, outlines for
    letters in SVG, the looks of ticks.  Its layout is fixed, so one drawing is enough for a file.
    """

    def __init__(self, figsize: tuple[float, float] | None = None, **kwargs: Any) -> None:
        self._purpose, self._aside = made_for.get(), False
        if self._purpose == "column" and figsize is not None:
            figsize = min(figsize[0], ONE_COLUMN), figsize[1]
        if self._purpose == "slide" and figsize is not None:
            self._aside = figsize[1] > _WIDE * figsize[0]
            figsize = _SLIDES[figsize[1] > _HIGH]
        super().__init__(figsize, layout="constrained", **kwargs)
        FigureCanvasAgg(self)
        # In a narrow figure the name has a line of its own: no unit stands alone on the next one.
        wide = self.get_figwidth() > 1.01 * ONE_COLUMN
        self._heading = _heading.get().replace(": ", ": " if wide else "\n", 1)
        if self._heading:
            super().suptitle(self._heading, wrap=True)

    def suptitle(self, t: str, **kwargs: object) -> Text:
        """Set the title as :meth:`matplotlib.figure.Figure.suptitle` does, below the heading, its lines broken where the figure ends."""
        return super().suptitle(f"{self._heading}\n{t}" if self._heading else t, **{"wrap": True} | kwargs)

    def legend(self, *args: Any, **kwargs: Any) -> Legend:
        """Add a legend as :meth:`matplotlib.figure.Figure.legend` does, in as many columns as the figure has room for."""
        columns = int(kwargs.get("ncols", 1))
        if self._purpose == "column":
            columns = 2
        if self._aside:
            legend = super().legend(*args, **kwargs | {"ncols": 1, "loc": "outside right center"})
            if self._holds(legend, _SIDE):
                return legend
            legend.remove()
        while True:
            legend = super().legend(*args, **kwargs | {"ncols": columns})
            if columns == 1 or self._holds(legend):
                return legend
            legend.remove()
            columns -= 1

    def _holds(self, legend: Legend, share: float = 1.0) -> bool:
        width = legend.get_window_extent(self.canvas.get_renderer()).width  # type: ignore[attr-defined]
        return bool(width <= share * self.bbox.width - 2.0 * _MARGIN * self.dpi / 72.0)

    def draw(self, renderer: RendererBase) -> None:
        """Draw as :meth:`matplotlib.figure.Figure.draw` does, under carom's style sheet."""
        with applied():
            super().draw(renderer)

    def get_tightbbox(self, *args: Any, **kwargs: Any) -> Bbox:
        """Measure as :meth:`matplotlib.figure.Figure.get_tightbbox` does, under carom's style sheet."""
        with applied():
            return super().get_tightbbox(*args, **kwargs)

    def savefig(self, fname: Any, **kwargs: Any) -> None:
        """Save as :meth:`matplotlib.figure.Figure.savefig` does, under carom's style sheet."""
        with drawing():
            # With an engine, matplotlib would draw twice, even with the one that does nothing.
            engine = self.get_layout_engine()
            self.set_layout_engine(None)
            try:
                super().savefig(fname, **kwargs)
            finally:
                self.set_layout_engine(engine)

    def _repr_png_(self) -> bytes:
        """The picture for notebooks, at the resolution of the screen."""
        buffer = BytesIO()
        self.savefig(buffer, format="png", dpi="figure")
        return buffer.getvalue()


def frames(count: int) -> tuple[Figure, list[Axes]]:
    """Make a figure of so many square panels beside each other, or below each other where figures are narrow."""
    if narrow() or count == 1:
        figure = StyledFigure(figsize=(ONE_COLUMN, 1.18 * count * ONE_COLUMN))
        return figure, list(figure.subplots(count, 1, squeeze=False)[:, 0])
    figure = StyledFigure(figsize=(TWO_COLUMNS, 1.16 * ONE_COLUMN))
    return figure, list(figure.subplots(1, count))


def arrange(figure: Figure) -> None:
    """Lay out axes, legends and titles of a complete figure, under the style sheet, and fix this layout; a figure laid out before stays as it is."""
    if isinstance(figure.get_layout_engine(), PlaceHolderLayoutEngine):
        return
    write_plain_ticks(figure)
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        if any(axes.get_aspect() != "auto" for axes in figure.axes):  # they have shrunk to keep it
            engine.execute(figure)
    figure.set_layout_engine("none")


def write_plain_ticks(figure: Figure) -> None:
    """Write numbers at ticks as plain text unless they need a power of ten: mathematical text looks the same and takes much longer."""
    for axes in [each for parent in figure.axes for each in (parent, *parent.child_axes)]:
        for axis in (axes.xaxis, axes.yaxis):
            formatter = axis.get_major_formatter()
            if isinstance(formatter, ScalarFormatter) and 1e-3 <= np.abs(axis.get_view_interval()).max() < 1e6:
                formatter.set_useMathText(False)


# Without these settings a file would contain the date of its creation.
_UNDATED: dict[Format, dict[str, str | None]] = {
    "svg": {"Date": None, "Creator": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    "png": {"Software": None},
}

_FAST = {"compress_level": 1}
"""Of PNG: packing them tighter takes nearly half of the time and saves 7 % of the space."""


@checked
def save(figure: Figure, path_stem: str | os.PathLike[str], formats: Sequence[Format] = ("svg", "png")) -> list[Path]:
    """Write a figure in several formats; return the files in the order of `formats`.

    All formats are drawn in memory before the first byte is written, and each file appears under its name only when it
    is complete.  The same figure gives the same bytes on every call: no dates, fixed identifiers.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Figure to write; PNG at 300 dots per inch.
    path_stem : path-like
        Path without the file ending, which is appended: ``"out/orbit"`` gives ``out/orbit.svg``.  Missing folders are
        created.
    formats : sequence of {"svg", "pdf", "png"}
        Formats to write.

    Raises
    ------
    InputError
        If a format is none of the three.
    OSError
        If the folder cannot be written; no partial file is left.
    """
    stem = Path(path_stem)
    if not stem.name:
        raise InputError("path_stem", path_stem, "a path that ends with a name")
    contents = {stem.with_name(f"{stem.name}.{name}"): _rendered(figure, name) for name in formats}
    stem.parent.mkdir(parents=True, exist_ok=True)
    for target, content in contents.items():
        write_whole(target, content)
    return list(contents)


def _rendered(figure: Figure, name: Format) -> bytes:
    buffer = BytesIO()
    options: dict[str, Any] = {"pil_kwargs": _FAST} if name == "png" else {}
    with drawing():
        figure.savefig(buffer, format=name, metadata=_UNDATED[name], **options)
    return buffer.getvalue()
