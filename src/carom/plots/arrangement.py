"""Layout of the axes, legends and titles of a figure: measured without drawing, and then fixed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import cast

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine, PlaceHolderLayoutEngine
from matplotlib.ticker import ScalarFormatter

__all__ = ["arrange", "without_layout", "write_plain_ticks"]


def arrange(figure: Figure) -> None:
    """Lay out axes, legends, titles and ticks, and fix this layout.

    Later drawing neither moves anything nor creates ticks, which would take the settings of the user.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        A complete figure; call this under the style sheet.  If the figure has been laid out before, nothing is done.
    """
    if isinstance(figure.get_layout_engine(), PlaceHolderLayoutEngine):
        return
    write_plain_ticks(figure)
    engine = ConstrainedLayoutEngine()
    canvas = figure.canvas
    _Gauge(figure)
    # Spines do not extend beyond their axes, and measuring them would create all ticks again.
    spines = [spine for axes in _every_axes(figure) for spine in axes.spines.values() if spine.get_in_layout()]
    for spine in spines:
        spine.set_in_layout(False)
    try:
        engine.execute(figure)
        if not _settled(figure):
            engine.execute(figure)
    finally:
        figure.set_canvas(canvas)
        for spine in spines:
            spine.set_in_layout(True)
    for axis in _every_axis(figure):  # creates the missing ticks
        axis.get_major_ticks()
        axis.get_minor_ticks()
    figure.set_layout_engine("none")


def write_plain_ticks(figure: Figure) -> None:
    """Write numbers at ticks as plain text unless they need a power of ten.

    They look the same as mathematical text, which is parsed for each tick and each drawing: that would take most of the
    time of a figure.
    """
    for axis in _every_axis(figure):
        formatter = axis.get_major_formatter()
        if isinstance(formatter, ScalarFormatter) and 1e-3 <= np.abs(axis.get_view_interval()).max() < 1e6:
            formatter.set_useMathText(False)


@contextmanager
def without_layout(figure: Figure) -> Iterator[None]:
    """Let matplotlib save a figure with a fixed layout by drawing it once.

    Matplotlib draws every figure with a layout engine twice, even if the engine is the placeholder that does nothing.
    """
    engine = figure.get_layout_engine()
    if not isinstance(engine, PlaceHolderLayoutEngine):
        yield
        return
    with mpl.rc_context({"figure.constrained_layout.use": False, "figure.autolayout": False}):
        figure.set_layout_engine(None)
        try:
            yield
        finally:
            figure.set_layout_engine(engine)


def _settled(figure: Figure) -> bool:
    """Whether one layout pass was enough: no axes shrink to keep an aspect ratio, and none needs other ticks."""
    return all(axes.get_aspect() == "auto" for axes in figure.axes) and all(
        np.array_equal([tick.get_loc() for tick in axis.get_major_ticks()], axis.get_majorticklocs())
        for axis in _every_axis(figure)
    )


def _every_axis(figure: Figure) -> Iterator[Axis]:
    for axes in _every_axes(figure):
        yield from (axis for axis in (axes.xaxis, axes.yaxis) if axis.get_visible())


def _every_axes(figure: Figure) -> Iterator[Axes]:
    """Return all axes of a figure, including secondary axes and insets."""
    for axes in figure.axes:
        yield from _with_children(axes)


def _with_children(axes: Axes) -> Iterator[Axes]:
    yield axes
    for child in axes.child_axes:
        yield from _with_children(cast(Axes, child))


class _Gauge(FigureCanvasBase):
    """A canvas for measuring: a text that many figures show is measured once."""

    def get_renderer(self) -> RendererAgg:
        return _renderer(self.figure.dpi)


@lru_cache(4)
def _renderer(dpi: float) -> RendererAgg:
    """Return a cached renderer: matplotlib caches the sizes of texts by renderer."""
    return RendererAgg(1, 1, dpi)  # type: ignore[no-untyped-call]
