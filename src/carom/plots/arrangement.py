"""Layout of the axes, legends and titles of a figure: measured without drawing, and then fixed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backend_bases import FigureCanvasBase, RendererBase
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine, PlaceHolderLayoutEngine
from matplotlib.ticker import ScalarFormatter
from matplotlib.transforms import Bbox

from carom.plots.figure import POINTS, gauge


def arrange(figure: Figure) -> None:
    """Lay out axes, legends, titles and ticks of a complete figure, under the style sheet, and fix this layout.

    Later drawing neither moves anything nor creates ticks, which would take the settings of the user.  A figure that
    has been laid out before stays as it is.
    """
    if isinstance(figure.get_layout_engine(), PlaceHolderLayoutEngine):
        return
    write_plain_ticks(figure)
    engine = ConstrainedLayoutEngine()
    with _measuring(figure), _measured_once(figure):
        engine.execute(figure)
        if any(axes.get_aspect() != "auto" for axes in figure.axes):  # they have shrunk to keep it
            engine.execute(figure)
        for axes in figure.axes:
            _place_children(axes)
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


def _every_axis(figure: Figure) -> Iterator[Axis]:
    for axes in figure.axes:
        yield from _axis_pairs(axes)


def _axis_pairs(axes: Axes) -> Iterator[Axis]:
    """Return the visible axis objects of axes and of their secondary axes and insets."""
    for member in _with_children(axes):
        yield from (axis for axis in (member.xaxis, member.yaxis) if axis.get_visible())


def _place_children(axes: Axes) -> None:
    """Move secondary axes and insets to where their parents are."""
    for child in axes.child_axes:
        locator = cast(Any, child.get_axes_locator())
        child.apply_aspect(locator(axes, gauge()) if locator else None)
        _place_children(cast(Axes, child))


def _with_children(axes: Axes) -> Iterator[Axes]:
    yield axes
    for child in axes.child_axes:
        yield from _with_children(cast(Axes, child))


@contextmanager
def _measuring(figure: Figure) -> Iterator[None]:
    """Give a figure a canvas for measuring, and leave the spines of its axes out."""
    canvas, dpi = figure.canvas, figure.dpi
    # Spines do not extend beyond their axes, and measuring them would create all ticks again.
    spines = [
        spine
        for top in figure.axes
        for axes in _with_children(top)
        for spine in axes.spines.values()
        if spine.get_in_layout()
    ]
    for spine in spines:
        spine.set_in_layout(False)
    _Gauge(figure)
    figure.dpi = POINTS
    try:
        yield
    finally:
        figure.dpi = dpi
        figure.set_canvas(canvas)
        for spine in spines:
            spine.set_in_layout(True)


@contextmanager
def _measured_once(figure: Figure) -> Iterator[None]:
    """Measure what surrounds each axes once, although the layout engine asks for it each time it has moved them."""
    free = [axes for axes in figure.axes if axes.get_axes_locator() is None]
    for axes in free:
        axes.get_tightbbox = _Surroundings(axes)  # type: ignore[method-assign]
    try:
        yield
    finally:
        for axes in free:
            del axes.get_tightbbox  # that of the class is left


class _Surroundings:
    """Bounding box of axes with their labels, which are measured again only if the ticks have changed."""

    def __init__(self, axes: Axes) -> None:
        self.axes, self.measure = axes, axes.get_tightbbox
        self.ticks: list[list[float]] = []
        self.margins = np.zeros(4)

    def __call__(self, renderer: RendererBase | None = None, **options: Any) -> Bbox | None:
        self.axes.apply_aspect()
        _place_children(self.axes)
        frame = np.array(self.axes.bbox.extents)
        ticks = [list(axis.get_majorticklocs()) for axis in _axis_pairs(self.axes)]
        if ticks != self.ticks:
            box = self.measure(renderer, **options)
            if box is None:
                return None
            self.ticks, self.margins = ticks, np.array(box.extents) - frame
        return Bbox.from_extents(*(frame + self.margins))


class _Gauge(FigureCanvasBase):
    """A canvas that measures without drawing."""

    def get_renderer(self) -> RendererBase:
        return gauge()
