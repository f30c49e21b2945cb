"""Gain maps: the share of the disturbances that comes back, over two parameters of the machine."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import PercentFormatter

from carom.base.arguments import checked
from carom.parameters import in_terms_of
from carom.parameters.in_terms import EXACT
from carom.plots.maps import cell_edges, draw_map, mark_present
from carom.plots.plane import Floats, key, one_axes
from carom.plots.style import ONE_COLUMN, TWO_COLUMNS, styled
from carom.plots.words import number, parameter_label

if TYPE_CHECKING:
    from carom.basins import GainMap
    from carom.models import Axis
    from carom.parameters import Case

_LEVELS = MappingProxyType({0.5: ":", 0.9: "--", 0.99: "-"})
"""Shares at which contours are drawn, and their line styles."""
_WORDS = "share of the disturbances that comes back"
_NAMES = {"stiffness": "P gain", "damping": "D gain"}
"""What stiffness and damping are called; an entry of a machine's file that states them has its own name."""


@checked
@styled
def gain_map(found: GainMap, *, in_terms_of: Case | None = None) -> Figure:
    """Draw the share of disturbances that comes back, with contours and the present machine.

    A new figure is 126 mm wide.

    Parameters
    ----------
    in_terms_of : Case, optional
        A machine in whose terms and units both parameters are stated: ``derivative_gain`` in A s/m where its file has that.
    """
    figure, drawn = one_axes((0.7 * TWO_COLUMNS, 1.15 * ONE_COLUMN))
    stated = [_shown(axis, now, in_terms_of) for axis, now in zip(found.axes, found.present, strict=True)]
    x, y = (
        np.array([of(value) for value in found.dataset[axis.name].values.tolist()])
        for axis, (_, of) in zip(found.axes, stated, strict=True)
    )
    grounded = found.dataset["levitates"].values == 0.0
    edges = cell_edges(x), cell_edges(y)
    here = stated[0][1](found.present[0]), stated[1][1](found.present[1])
    replaced = {}
    if found.present_share.count and _within(edges, here, grounded):
        # The star marks a machine that levitates; without these words its cell would seem to contradict it.
        replaced["no-levitation"] = "no levitation (in the middle of the cell)"
    share = np.ma.masked_where(grounded, found.dataset["recovered"].values)
    colours = draw_map(drawn, edges, share, _WORDS, {"no-levitation": grounded}, replaced, vmin=0.0, vmax=1.0)
    if colours is not None:
        colours.ax.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    _contours(drawn, x, y, share)
    words = f"present machine: {number(100.0 * found.present_share.fraction, 3)} % come back"
    mark_present(drawn, here, edges, words)
    drawn.set(xlabel=stated[0][0], ylabel=stated[1][0], xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    return key(figure, [drawn], columns=2)


def _within(edges: tuple[Floats, Floats], place: tuple[float, float], cells: np.ndarray) -> bool:
    """Whether a point lies in one of these cells."""
    row, column = (int(np.searchsorted(along, value)) - 1 for along, value in zip(edges, place, strict=True))
    return 0 <= row < cells.shape[0] and 0 <= column < cells.shape[1] and bool(cells[row, column])


def _contours(axes: Axes, x: np.ndarray, y: np.ndarray, share: np.ndarray) -> None:
    """Draw contours of the share, dark with a white outline, visible on every shade."""
    levels = {level: line for level, line in _LEVELS.items() if share.min() < level <= share.max()}
    if not levels:
        return
    lines = axes.contour(x, y, share.T, levels=list(levels), colors="#1a1a1a", linestyles=list(levels.values()))
    lines.set_linewidth(0.9)
    lines.set_path_effects([withStroke(linewidth=2.2, foreground="white")])
    for level, line in levels.items():
        axes.plot([], [], color="#1a1a1a", ls=line, lw=0.9, label=f"{100 * level:g} % come back")


def _shown(axis: Axis, now: float, case: Case | None) -> tuple[str, Callable[[float], float]]:
    """Label of a parameter in the terms of a machine's file, and a value in its unit; stiffness and damping are named as gains of a position controller."""
    unit, field, name = axis.field.usual_size, axis.field, _NAMES.get(axis.name, "")
    if case is None:
        label = parameter_label(field)
        return f"{name}: {label}" if name else label, lambda value: value / unit
    stated = in_terms_of(case, axis.name, now)
    label = parameter_label(stated.field, stated.unit)
    return (
        f"{name}: {label}" if name and stated.entry == axis.name else label,
        lambda value: in_terms_of(case, axis.name, value, digits=EXACT).value,
    )
