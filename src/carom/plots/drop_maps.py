"""Basins of drops: how each ends, and loads of the touchdown bearing, over two numbers of the release or of the machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.parameters.formats import number as plain
from carom.plots.cells import finish, looks_of, paint
from carom.plots.figure import StyledFigure
from carom.plots.maps import BLANKS, cell_edges, draw_map, mark_cells, mark_present
from carom.plots.style import TWO_COLUMNS, Look, styled
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
_QUARTERS = 90.0
"""Ticks of an angle over a whole turn, in degrees."""


@checked
@styled
def drop_map(found: DropMap, measure: str | None = None) -> Figure:
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
    paint(left, *edges, found.dataset["motion"].values, looks)
    mark_cells(left, edges, ~found.exists, BLANKS["no-levitation"], "no-levitation")
    left.set_title("(a) how the drop ends", loc="left", y=1.0)
    factor, unit = _SHOWN[name]
    values = np.ma.masked_invalid(factor * found.dataset[name].values)
    words = str(found.dataset[name].attrs["long_name"])
    grounded = {"no-levitation": ~found.exists}
    draw_map(right, edges, values, f"{words} ({unit})" if unit else words, grounded)
    by_load = name in ("force", "impulse", "depth", "pressure")
    right.set_title("(b) loads of the touchdown bearing" if by_load else "(b)", loc="left", y=1.0)
    limit = found.limits.get(name)
    if limit is not None:
        beyond = Look("none", f"above the limit {plain(factor * limit)} {unit}", hatch="////")
        mark_cells(right, edges, values.filled(0.0) > factor * limit, beyond, "beyond")
    here = [value / varied.field.usual_size for value, varied in zip(found.present, found.axes, strict=True)]
    for axes in (left, right):
        _axes(axes, first, second, edges)
        mark_present(axes, here, edges, "present machine and release")
    right.set_ylabel("")
    return finish(figure, looks, columns=3)


def _edges(varied: Axis, found: DropMap) -> Floats:
    """Edges of cells in the unit in which people say what is varied."""
    return cell_edges(found.dataset[varied.name].values / varied.field.usual_size)


def _axes(axes: Axes, first: Axis, second: Axis, edges: tuple[Floats, Floats]) -> None:
    """Set labels and limits; a whole turn has ticks at quarters."""
    for direction, varied, along in zip("xy", (first, second), edges, strict=True):
        axes.set(**{f"{direction}label": parameter_label(varied.field)})
        axes.set(**{f"{direction}lim": (along[0], along[-1])})
        if varied.field.usual_unit == "°" and abs(along[-1] - along[0] - 360.0) < 1e-6:
            axes.set(**{f"{direction}ticks": np.arange(0.0, 360.0 + _QUARTERS, _QUARTERS)})
