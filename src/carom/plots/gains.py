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
from carom.base.outcome import InputError
from carom.parameters import in_terms_of
from carom.parameters.formats import shown_in
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
_MEASURES = {
    "recovered": ("share of the disturbances that comes back", True),
    "smallest_unrecovered_kick": ("smallest kick tried that does not come back", False),
}
"""Measures that shades can show: their words, and whether they are shares."""
_NAMES = {"stiffness": "P gain", "damping": "D gain"}
"""What stiffness and damping are called; an entry of a machine's file that states them has its own name."""


@checked
@styled
def gain_map(
    found: GainMap,
    title: str | None = None,
    *,
    measure: str = "recovered",
    in_terms_of: Case | None = None,
) -> Figure:
    """Draw the share of disturbances that comes back, with contours and the present machine.

    A new figure is 126 mm wide.

    Parameters
    ----------
    measure : {"recovered", "smallest_unrecovered_kick"}
        The measure that the shades show; contours always show the share that comes back.
    in_terms_of : Case, optional
        A machine in whose terms and units both parameters are stated: ``derivative_gain`` in A s/m where its file has that.

    Raises
    ------
    InputError
        There is no such measure, or it is not defined for the disturbances of the map.
    """
    known = [name for name in _MEASURES if name in found.dataset]
    if measure not in known:
        raise InputError("measure", measure, f"one that this map has: {', '.join(known)}")
    figure, drawn = one_axes((0.7 * TWO_COLUMNS, 1.15 * ONE_COLUMN))
    stated = [_shown(axis, now, in_terms_of) for axis, now in zip(found.axes, found.present, strict=True)]
    x, y = (
        np.array([of(value) for value in found.dataset[axis.name].values.tolist()])
        for axis, (_, of) in zip(found.axes, stated, strict=True)
    )
    values = np.ma.masked_invalid(found.dataset[measure].values)
    bar = _MEASURES[measure][0]
    if measure == "smallest_unrecovered_kick":
        factor, unit = shown_in("velocity", found.rotor.scales)
        values, bar = factor * values, f"{bar} ({unit})"
    grounded = found.dataset["levitates"].values == 0.0
    edges = cell_edges(x), cell_edges(y)
    here = stated[0][1](found.present[0]), stated[1][1](found.present[1])
    replaced = {"none": "every kick tried comes back"}
    if found.present_share.count and _within(edges, here, grounded):
        # The star marks a machine that levitates; without these words its cell would seem to contradict it.
        replaced["no-levitation"] = "no levitation (in the middle of the cell)"
    blank, shown = np.ma.getmaskarray(values) & ~grounded, np.ma.masked_where(grounded, values)
    highest = 1.0 if _MEASURES[measure][1] else max(float(shown.filled(0.0).max()), 1e-3)
    reasons = {"no-levitation": grounded, "none": blank}
    colours = draw_map(drawn, edges, shown, bar, reasons, replaced, vmin=0.0, vmax=highest)
    if colours is not None and _MEASURES[measure][1]:
        colours.ax.yaxis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    _contours(drawn, x, y, np.ma.masked_where(grounded, found.dataset["recovered"].values))
    mark_present(drawn, here, f"present machine: {number(100.0 * found.present_share.fraction, 3)} % come back")
    drawn.set(xlabel=stated[0][0], ylabel=stated[1][0], xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    if title:
        drawn.set_title(title)
    key(figure, [drawn], columns=2)  # one where they have no room
    return figure


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
