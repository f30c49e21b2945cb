"""Basins of drops: how each ends, and how hard it strikes, over two numbers of the release or of the machine."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from carom.arguments import checked
from carom.outcome import InputError
from carom.parameters.told import number as plain
from carom.plots.cells import finish, looks_of, paint
from carom.plots.figure import StyledFigure
from carom.plots.style import TWO_COLUMNS, styled
from carom.plots.sweeps import blank_cells, cell_edges, colour_bar, shaded_cells
from carom.plots.words import parameter_label

if TYPE_CHECKING:
    from carom.basins import DropMap
    from carom.models import Axis
    from carom.plots.plane import Floats

_SHOWN = {
    "force": (1e-3, "kN"),
    "impulse": (1.0, "N s"),
    "depth": (1e6, "µm"),
    "heat": (1.0, "J"),
    "power": (1e-3, "kW"),
    "pressure": (1e-9, "GPa"),
    "contacts": (1.0, ""),
    "contact_time": (1e3, "ms"),
    "settled_at": (1e3, "ms"),
    "time": (1e3, "ms"),
    "whirl": (1.0, "Hz"),
}
"""Units of the loads in figures."""
_PARTS = 8
"""Parts along each side into which a cell is divided for its hatching."""
_QUARTERS = 90.0
"""Ticks of an angle over a whole turn, in degrees."""


@checked
@styled
def drop_map(found: DropMap, measure: str | None = None, title: str | None = None) -> Figure:
    """Draw how drops end, and beside it a load of the touchdown bearing, with its limit where one is stated.

    Parameters
    ----------
    measure : str, optional
        A variable of the map in the right panel; by default the peak force, or on a rigid wall the largest impulse.

    Raises
    ------
    InputError
        The map has no such measure, or no drop has one.
    """
    known = [name for name in _SHOWN if np.isfinite(found.dataset[name].values).any()]
    name = found.hardest if measure is None else measure
    if name not in known:
        raise InputError("measure", name, f"one that this map has: {', '.join(known)}")
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.5 * TWO_COLUMNS))
    left, right = figure.subplots(1, 2, sharey=True)
    first, second = found.axes
    edges = _edges(first, found), _edges(second, found)
    looks = looks_of(found.motions, [found.fractions[motion] for motion in found.motions])
    # Hatching ends halfway between the nodes of an area: in parts of cells it fills these.
    index = np.repeat(np.repeat(found.dataset["motion"].values, _PARTS, axis=0), _PARTS, axis=1)
    paint(left, _divided(edges[0]), _divided(edges[1]), index, looks)
    left.set_title("(a) how the drop ends", loc="left", y=1.0)
    handles: list[Artist] = []
    factor, unit = _SHOWN[name]
    values = np.ma.masked_invalid(factor * found.dataset[name].values)
    words = str(found.dataset[name].attrs["long_name"])
    colour_bar(figure, right, shaded_cells(right, edges, values), f"{words} ({unit})" if unit else words)
    right.set_title(
        "(b) how hard it strikes" if name in ("force", "impulse", "depth", "pressure") else "(b)", loc="left", y=1.0
    )
    limit = found.limits.get(name)
    if limit is not None:
        handles += _limit(right, edges, values, factor * limit, f"limit {plain(factor * limit)} {unit}")
    for axes in (left, right):
        handles += blank_cells(axes, edges, {"no-levitation": ~found.exists}, {})[: 1 if axes is left else 0]
        _axes(axes, first, second, edges)
    right.set_ylabel("")
    handles += _present(left, right, found)
    return finish(figure, looks, title, handles, columns=3)


def _edges(varied: Axis, found: DropMap) -> Floats:
    """Edges of cells in the unit in which people say what is varied."""
    return cell_edges(found.dataset[varied.name].values / varied.field.usual_size)


def _divided(edges: Floats) -> Floats:
    """Edges of the parts of cells."""
    return np.interp(np.arange(_PARTS * (len(edges) - 1) + 1) / _PARTS, np.arange(len(edges)), edges)


def _axes(axes: Axes, first: Axis, second: Axis, edges: tuple[Floats, Floats]) -> None:
    """Set labels and limits; a whole turn has ticks at quarters."""
    for direction, varied, along in zip("xy", (first, second), edges, strict=True):
        axes.set(**{f"{direction}label": parameter_label(varied.field) if varied.field.symbol else _label(varied)})
        axes.set(**{f"{direction}lim": (along[0], along[-1])})
        if varied.field.usual_unit == "°" and abs(along[-1] - along[0] - 360.0) < 1e-6:
            axes.set(**{f"{direction}ticks": np.arange(0.0, 360.0 + _QUARTERS, _QUARTERS)})


def _label(varied: Axis) -> str:
    """Words and unit of what has no symbol."""
    return f"{varied.field.words} ({varied.field.usual_unit})"


def _limit(
    axes: Axes, edges: tuple[Floats, Floats], values: np.ma.MaskedArray, limit: float, words: str
) -> list[Artist]:
    """Outline the cells that exceed a limit; return the legend entry."""
    beyond = np.where(values.filled(0.0) > limit, 1.0, 0.0)
    look: dict[str, Any] = {"color": "#d55e00", "lw": 1.3}
    if not beyond.any():
        return []
    for axis, lines in ((0, axes.vlines), (1, axes.hlines)):
        sides = np.diff(np.pad(beyond, [(1, 1) if axis == place else (0, 0) for place in (0, 1)]), axis=axis) != 0.0
        for x, y in zip(*np.nonzero(sides), strict=True):
            along = edges[1][y : y + 2] if axis == 0 else edges[0][x : x + 2]
            lines(edges[axis][x if axis == 0 else y], *along, **look)
    return [Line2D([], [], label=f"above the {words}", **look)]


def _present(left: Axes, right: Axes, found: DropMap) -> list[Artist]:
    """Mark the present machine and release, if they lie in the map."""
    here = [value / varied.field.usual_size for value, varied in zip(found.present, found.axes, strict=True)]
    limits = left.get_xlim(), left.get_ylim()
    if not all(low <= value <= high for value, (low, high) in zip(here, limits, strict=True)):
        return []
    star: dict[str, Any] = {"marker": "*", "ms": 9.0, "mfc": "white", "mec": "#1a1a1a", "mew": 0.7, "ls": "none"}
    for axes in (left, right):
        axes.plot(*here, **star, gid="present", clip_on=False, zorder=4)
    return [Line2D([], [], label="present machine and release", **star)]
