"""Gain maps: what share of the disturbances comes back, against two parameters of the machine."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import PercentFormatter

from carom.plots.plane import one_axes
from carom.plots.style import ONE_COLUMN, TWO_COLUMNS, styled
from carom.plots.words import number, parameter_label, parameter_unit

if TYPE_CHECKING:
    from carom.basins import GainChange, GainMap
    from carom.bifurcations import Axis

__all__ = ["gain_map"]

_LEVELS = MappingProxyType({0.5: ":", 0.9: "--", 0.99: "-"})
"""Shares at which contours are drawn, and their lines."""
_NAMES = {"stiffness": "P gain", "damping": "D gain"}
_GROUND = "#e6e6e6"
"""Ground of machines that cannot levitate."""
_SHADES = "cividis"
"""Told apart by all eyes and in grey (Nuñez, Anderton, Renslow 2018)."""


@styled
def gain_map(
    found: GainMap, change: GainChange | None = None, title: str | None = None, *, axes: Axes | None = None
) -> Figure:
    """Draw the share of disturbances that comes back, with contours, the present machine and the least change.

    Parameters
    ----------
    found : carom.basins.GainMap
    change : carom.basins.GainChange, optional
        Least change that reaches a wanted share, to be drawn as an arrow.
    title : str, optional
    axes : matplotlib.axes.Axes, optional
        Axes to draw into.  Default: a new figure, 126 mm wide.

    Returns
    -------
    matplotlib.figure.Figure
        Both axes in SI units where the parameters are physical.
    """
    figure, drawn = one_axes(axes, (0.7 * TWO_COLUMNS, 1.15 * ONE_COLUMN))
    units = [parameter_unit(axis) for axis in found.axes]
    x, y = (found.dataset[axis.name].values / unit for axis, unit in zip(found.axes, units, strict=True))
    share = found.dataset["recovered"].values
    mesh = drawn.pcolormesh(x, y, share.T, cmap=_SHADES, vmin=0.0, vmax=1.0, shading="nearest", rasterized=True)
    handles: list[Line2D | Patch] = []
    grounded = found.dataset["levitates"].values == 0.0
    if grounded.any():
        drawn.pcolormesh(
            x,
            y,
            np.ma.masked_where(~grounded, np.ones(grounded.shape)).T,
            cmap=ListedColormap([_GROUND]),
            shading="nearest",
            rasterized=True,
        )
        handles.append(Patch(facecolor=_GROUND, edgecolor="#a6a6a6", lw=0.4, label="no levitation without contact"))
    lines = _contours(drawn, x, y, np.ma.masked_where(grounded, share))
    here = [value / unit for value, unit in zip(found.present, units, strict=True)]
    now = found.present_share
    drawn.plot(*here, marker="*", ms=9.0, mfc="white", mec="#1a1a1a", mew=0.7, ls="none", gid="present", clip_on=False)
    words = f"present machine: {number(100.0 * now.fraction, 3)} % come back"
    handles += lines
    handles.append(Line2D([], [], marker="*", ms=9.0, mfc="white", mec="#1a1a1a", mew=0.7, ls="none", label=words))
    if change is not None and change.size > 0.0:
        there = [value / unit for value, unit in zip(change.values, units, strict=True)]
        drawn.annotate(
            "",
            (there[0], there[1]),
            (here[0], here[1]),
            arrowprops={"arrowstyle": "-|>", "color": "white", "lw": 1.6, "shrinkA": 4},
        )
        drawn.annotate(
            "",
            (there[0], there[1]),
            (here[0], here[1]),
            arrowprops={"arrowstyle": "-|>", "color": "#d55e00", "lw": 0.9, "shrinkA": 4},
        )
        changes = ", ".join(
            f"{_NAMES.get(axis.name, axis.name)} {100.0 * part:+.3g} %".replace("-", "\N{MINUS SIGN}")
            for axis, part in zip(found.axes, change.changes, strict=True)
        )
        label = f"least change found for {100 * change.wanted:g} %: {changes}"
        handles.append(Line2D([], [], color="#d55e00", lw=1.2, marker=">", markevery=[1], ms=4, label=label))
    drawn.set_xlabel(_label(found.axes[0]))
    drawn.set_ylabel(_label(found.axes[1]))
    drawn.set_xlim(x[0], x[-1])
    drawn.set_ylim(y[0], y[-1])
    bar = figure.colorbar(mesh, ax=drawn, format=PercentFormatter(1.0), pad=0.02)
    bar.set_label("share of the disturbances that comes back")
    bar.outline.set_linewidth(0.5)
    if title:
        drawn.set_title(title)
    figure.legend(handles=handles, loc="outside lower center", ncols=2)
    return figure


def _contours(axes: Axes, x: np.ndarray, y: np.ndarray, share: np.ndarray) -> list[Line2D]:
    """Contours of the share, dark with a white rim so that they show on every shade; their entries in the legend."""
    levels = {level: line for level, line in _LEVELS.items() if share.min() < level <= share.max()}
    if not levels:
        return []
    lines = axes.contour(x, y, share.T, levels=list(levels), colors="#1a1a1a", linestyles=list(levels.values()))
    lines.set_linewidth(0.9)
    lines.set_path_effects([withStroke(linewidth=2.2, foreground="white")])
    return [
        Line2D([], [], color="#1a1a1a", ls=line, lw=0.9, label=f"{100 * level:g} % come back")
        for level, line in levels.items()
    ]


def _label(axis: Axis) -> str:
    """Words of a parameter; those of a position controller have names of their own."""
    name = _NAMES.get(axis.name)
    return f"{name}: {parameter_label(axis)}" if name else parameter_label(axis)
