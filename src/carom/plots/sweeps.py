"""Maps of sweeps: one of the stored numbers or flags against the parameters that were varied."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis as AnyAxis
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter

from carom.outcome import InputError
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS
from carom.plots.plane import one_axes
from carom.plots.style import ONE_COLUMN, TWO_COLUMNS, styled
from carom.plots.words import parameter_label, parameter_unit

if TYPE_CHECKING:
    import xarray

__all__ = ["sweep_map"]

_GROUND = "#e6e6e6"
"""Where there is no number: not computed, failed, or none exists."""
_SHADES = "cividis"
_PLAIN, _PLAIN_RATIO = (1e-3, 1e5), 300.0
"""Numbers on a logarithmic axis that are written plainly, and the largest ratio of its ends with such ticks."""
_FLAGS = ("#dbe4f0", "#56739f", "#e8c26a", "#7a4f1d")
"""Colours of the values of a flag: told apart by all eyes, and in grey."""


@styled
def sweep_map(data: xarray.Dataset, name: str, title: str | None = None, *, axes: Axes | None = None) -> Figure:
    """Draw a variable of a sweep over its two axes, or over its only one.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`carom.open_sweep`; of more than two axes, choose values first: ``data.sel(friction=0.15)``.
    name : str
        The variable.
    title : str, optional
    axes : matplotlib.axes.Axes, optional
        Axes to draw into.  Default: a new figure, 126 mm wide.

    Returns
    -------
    matplotlib.figure.Figure
        Axes in SI units where the parameters are physical, logarithmic where the sweep is.

    Raises
    ------
    InputError
        No such variable, or one with another number of dimensions.
    """
    if name not in data:
        raise InputError("name", name, f"one of: {', '.join(map(str, data.data_vars))}")
    values, plan = data[name], json.loads(data.attrs["plan"])
    spacings = {axis["name"]: axis["spacing"] for axis in plan["axes"]}
    dimensions = [str(dimension) for dimension in values.dims]
    if not 1 <= len(dimensions) <= 2 or not set(dimensions) <= spacings.keys():
        remedy = "a variable over one or two axes of the sweep; choose values of the other dimensions first, with sel"
        raise InputError("name", f"{name} over {', '.join(dimensions) or 'nothing'}", remedy)
    figure, drawn = one_axes(axes, (0.7 * TWO_COLUMNS, 1.15 * ONE_COLUMN))
    places = []
    for dimension, direction in zip(dimensions, "xy", strict=False):
        varied: Any = SimpleNamespace(name=dimension, field={**DIMENSIONLESS_FIELDS, **MACHINE_FIELDS}[dimension])
        places.append(data[dimension].values / parameter_unit(varied))
        set_up = {f"{direction}label": parameter_label(varied)}
        if spacings[dimension] == "log":
            set_up[f"{direction}scale"] = "log"
        drawn.set(**set_up)
        if spacings[dimension] == "log":
            _plain_ticks(drawn.xaxis if direction == "x" else drawn.yaxis, places[-1])
    if len(dimensions) == 1:
        drawn.plot(places[0], values.values, marker=".")
        drawn.set_ylabel(_label(values))
    else:
        drawn.set_facecolor(_GROUND)
        _shades(figure, drawn, places, values)
    if title:
        drawn.set_title(title)
    return figure


def _plain_ticks(axis: AnyAxis, values: np.ndarray) -> None:
    """Ticks at 1, 2, 5, 10, ..., written as plain numbers; a range of many decades keeps its powers of ten."""
    low, high = float(values.min()), float(values.max())
    if _PLAIN[0] <= low and high <= min(_PLAIN[1], _PLAIN_RATIO * low):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(lambda value, _: f"{value:g}")
        axis.set_minor_formatter(NullFormatter())


def _shades(figure: Figure, axes: Axes, places: list[np.ndarray], values: xarray.DataArray) -> None:
    """Shades of a number with their bar, or colours of a flag with their legend; the ground where there is neither."""
    shown = np.ma.masked_invalid(np.asarray(values.values, float)).T
    look: dict[str, Any] = {"cmap": _SHADES}
    meanings = str(values.attrs.get("flag_meanings", "")).split()
    if meanings:
        look = {"cmap": ListedColormap(_FLAGS[: len(meanings)]), "vmin": -0.5, "vmax": len(meanings) - 0.5}
    mesh = axes.pcolormesh(*places, shown, shading="nearest", rasterized=True, **look)
    handles = [
        Patch(color=colour, label=word.replace("_", " ")) for colour, word in zip(_FLAGS, meanings, strict=False)
    ]
    if not meanings:
        bar = figure.colorbar(mesh, ax=axes, pad=0.02)
        bar.set_label(_label(values))
        bar.outline.set_linewidth(0.5)
    if shown.mask.any():
        handles.append(Patch(facecolor=_GROUND, edgecolor="#a6a6a6", lw=0.4, label="no value"))
    if handles:
        title = values.attrs["long_name"] if meanings else None
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), title=title)


def _label(values: xarray.DataArray) -> str:
    """Words and unit of a variable."""
    words, unit = values.attrs["long_name"], values.attrs.get("units", "1")
    own = {"c_r": r"$c_\mathrm{r}$", "Omega^2": r"$\Omega^2$", "Omega": r"$\Omega$", "m": "$m$"}
    if unit == "1":
        return str(words)
    si = values.name is not None and str(values.name).endswith("_si")
    return f"{words} ({unit if si else ' '.join(own.get(part, part) for part in unit.split())})"
