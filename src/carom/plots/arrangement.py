"""Where the axes, legends and titles of a figure go: measured without drawing, and then kept."""

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
    """Give axes, legends and titles their places and the axes their ticks, and keep them so.

    Drawing later neither moves anything nor makes ticks, which would get the settings of the user.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        A figure with all that takes room; to be called under the style sheet.  If it has its places, nothing is done.
    """
    if isinstance(figure.get_layout_engine(), PlaceHolderLayoutEngine):
        return
    write_plain_ticks(figure)
    engine = ConstrainedLayoutEngine()
    canvas = figure.canvas
    _Gauge(figure)
    # Spines reach no farther than their axes, and asking them makes all ticks again.
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
    for axis in _every_axis(figure):  # makes the ticks that are missing
        axis.get_major_ticks()
        axis.get_minor_ticks()
    figure.set_layout_engine("none")


def write_plain_ticks(figure: Figure) -> None:
    """Write numbers at ticks as text where they need no power of ten.

    They look the same; parsing each of them as mathematics, time and again, would take most of the time of a figure.
    """
    for axis in _every_axis(figure):
        formatter = axis.get_major_formatter()
        if isinstance(formatter, ScalarFormatter) and 1e-3 <= np.abs(axis.get_view_interval()).max() < 1e6:
            formatter.set_useMathText(False)


@contextmanager
def without_layout(figure: Figure) -> Iterator[None]:
    """Let matplotlib write a figure that keeps its places by one drawing.

    It draws all figures with a layout engine twice, even with the engine that stands for none.
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
    """Whether room was made for what is there: no axes take less than they were given, and none wants other ticks."""
    return all(axes.get_aspect() == "auto" for axes in figure.axes) and all(
        np.array_equal([tick.get_loc() for tick in axis.get_major_ticks()], axis.get_majorticklocs())
        for axis in _every_axis(figure)
    )


def _every_axis(figure: Figure) -> Iterator[Axis]:
    for axes in _every_axes(figure):
        yield from (axis for axis in (axes.xaxis, axes.yaxis) if axis.get_visible())


def _every_axes(figure: Figure) -> Iterator[Axes]:
    """All axes of a figure, with second axes and enlarged views inside others."""
    for axes in figure.axes:
        yield from _with_children(axes)


def _with_children(axes: Axes) -> Iterator[Axes]:
    yield axes
    for child in axes.child_axes:
        yield from _with_children(cast(Axes, child))


class _Gauge(FigureCanvasBase):
    """A canvas to measure on: a text that many figures show is measured once."""

    def get_renderer(self) -> RendererAgg:
        return _renderer(self.figure.dpi)


@lru_cache(4)
def _renderer(dpi: float) -> RendererAgg:
    """Matplotlib keeps the measures of texts with the renderer that took them, so this one is kept."""
    return RendererAgg(1, 1, dpi)  # type: ignore[no-untyped-call]
