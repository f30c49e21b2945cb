"""Maps of sweeps: one of the stored numbers or flags over the parameters that were varied."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, PercentFormatter

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS, InputError
from carom.parameters import SETTINGS, Field
from carom.parameters.formats import shown_from_si
from carom.plots.figure import ONE_COLUMN, TWO_COLUMNS
from carom.plots.maps import BLANKS, SHADES, cell_edges, draw_map, mark_present
from carom.plots.plane import Floats, one_axes
from carom.plots.style import styled
from carom.plots.words import formula, parameter_label

if TYPE_CHECKING:
    import xarray

_NONE = MappingProxyType(
    {
        "smallest_unrecovered_kick": "every kick tried came back",
        "smallest_unrecovered_kick_angle": "every kick tried came back",
        "rub_force": f"no stable {STEADY_WORDS['rub']}",
        "orbit_impulse": "no stable orbit with one impact",
    }
)
"""What it means if a number does not exist, or is infinite, for a machine that was computed."""
_LEVITATING = ("zone", "smallest_unrecovered_kick", "smallest_unrecovered_kick_angle")
"""Variables that have values only for machines that levitate."""
_SHARES = MappingProxyType(
    {
        "recovered": "",
        "recovered_low": "share that came back to levitation, lower end of 95 % confidence",
        "recovered_high": "share that came back to levitation, upper end of 95 % confidence",
    }
)
"""Numbers shown in percent, and their words if the stored words refer to another variable."""
_MOST_STEPS = 9
"""Largest count up to which each number has a shade of its own."""
_PRESENT = "the machine as it is"
_LONGEST = 70
"""Letters of a line that fit along the side of a figure."""
_PLAIN, _PLAIN_RATIO = (1e-3, 1e5), 300.0
"""Range of plain numbers on a logarithmic axis, and largest ratio of its ends with such ticks."""
_FLAGS = ("#e9eff7", "#a9c3e0", "#cc8e3c", "#6b3f12")
"""Colours of the values of a flag, darker from each to the next: distinguishable by colour-blind readers and in greyscale."""


@checked
@styled
def sweep_map(data: xarray.Dataset, name: str, *, present: Mapping[str, float] | None = None) -> Figure:
    """Draw a variable of a sweep over its two axes, or over its only one.

    The axes are logarithmic if the sweep is.  A new figure is 126 mm wide.

    Parameters
    ----------
    data : xarray.Dataset
        From :func:`carom.open_sweep`.  If it has more than two axes, select values first: ``data.sel(friction=0.15)``.
    name : str
        The variable.
    present : mapping of str to float, optional
        Values of the axes, in their units in `data`, of the machine as it is; they are marked.

    Raises
    ------
    InputError
        There is no such variable, or it has another number of dimensions.
    """
    if name not in data:
        raise InputError("name", name, f"one of: {', '.join(map(str, data.data_vars))}")
    values, plan = _in_display_unit(data[name]), json.loads(data.attrs["plan"])
    spacings = {axis["name"]: axis["spacing"] for axis in plan["axes"]}
    dimensions = [str(dimension) for dimension in values.dims]
    if not 1 <= len(dimensions) <= 2 or not set(dimensions) <= spacings.keys():
        remedy = "a variable over one or two axes of the sweep; choose values of the other dimensions first, with sel"
        raise InputError("name", f"{name} over {', '.join(dimensions) or 'nothing'}", remedy)
    figure, drawn = one_axes((0.7 * TWO_COLUMNS, 1.15 * ONE_COLUMN))
    places, sizes = [], []
    for dimension, direction in zip(dimensions, "xy", strict=False):
        varied = _field(data[dimension])
        sizes.append(varied.usual_size)
        places.append(data[dimension].values / sizes[-1])
        drawn.set(**{f"{direction}label": parameter_label(varied)})
        if spacings[dimension] == "log":
            drawn.set(**{f"{direction}scale": "log"})
            _plain_ticks(getattr(drawn, f"{direction}axis"), places[-1])
    if len(dimensions) == 1:
        drawn.plot(places[0], values.values, marker=".")
        drawn.set_ylabel(_label(values))
        _ticks(drawn.yaxis, values)
    else:
        x, y = (cell_edges(along, spacings[name] == "log") for along, name in zip(places, dimensions, strict=True))
        _shades(drawn, (x, y), values, _reasons(data, values))
    if present is not None:
        here = [present[name] / size for name, size in zip(dimensions, sizes, strict=True)]
        if all(along.min() <= value <= along.max() for value, along in zip(here, places, strict=True)):
            if len(here) == 1:
                drawn.axvline(here[0], color="#1a1a1a", lw=0.8, ls=(0, (1, 1.5)), gid="present", label=_PRESENT)
            else:
                mark_present(drawn, here, places, _PRESENT)
    handles, labels = drawn.get_legend_handles_labels()
    if handles:
        meanings = len(dimensions) == 2 and len(figure.axes) == 1  # no colour bar says what is shown
        title_of_legend = values.attrs["long_name"] if meanings else None
        figure.legend(handles, labels, loc="outside lower center", ncols=min(len(handles), 4), title=title_of_legend)
    return figure


def _in_display_unit(values: xarray.DataArray) -> xarray.DataArray:
    """Return a variable in the unit in which it is shown: speeds in mm/s."""
    if "si_of" not in values.attrs:
        return values
    factor, unit = shown_from_si(values.attrs.get("units", "1"))
    return (factor * values).assign_attrs(values.attrs | {"units": unit}).rename(values.name)


def _field(coordinate: xarray.DataArray) -> Field:
    """The parameter of a coordinate; one of another model than the planar rotor has its name for a symbol."""
    name, words, unit = str(coordinate.name), coordinate.attrs["long_name"], coordinate.attrs["units"]
    own = Field(name, name.replace("_", r"\_"), words, "a number", "" if unit == "1" else unit, -np.inf, np.inf, "")
    return SETTINGS.get(name, own)


def _plain_ticks(axis: Axis, values: np.ndarray) -> None:
    """Set ticks at 1, 2, 5, 10, ... as plain numbers; a range of many decades keeps powers of ten."""
    low, high = float(values.min()), float(values.max())
    if _PLAIN[0] <= low and high <= min(_PLAIN[1], _PLAIN_RATIO * low):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(lambda value, _: f"{value:g}")
        axis.set_minor_formatter(NullFormatter())


def _ticks(axis: Axis, values: xarray.DataArray) -> None:
    """Set ticks: of a share in percent, of a count at whole numbers."""
    if values.name in _SHARES:
        axis.set_major_formatter(PercentFormatter(1.0, symbol=" %"))
    elif _counts(values):
        axis.set_major_locator(MaxNLocator(nbins=8, steps=[1, 2, 5, 10], integer=True))


def _counts(values: xarray.DataArray) -> bool:
    """Whether a variable is a count."""
    known = values.values[np.isfinite(values.values)]
    return values.attrs.get("units") == "1" and bool((known == np.round(known)).all())


def _reasons(data: xarray.Dataset, values: xarray.DataArray) -> dict[str, np.ndarray]:
    """Return the cells without a value, by the key of :data:`carom.plots.maps.BLANKS` that says why."""
    blank, status = ~np.isfinite(np.asarray(values.values, float)), data["status"].transpose(*values.dims).values
    reasons = {"waiting": blank & (status == 0), "failed": blank & (status == 2)}
    rest = blank & (status == 1)
    grounded = np.zeros(rest.shape, bool)
    if "possible" in data:  # Kicks and similar disturbances start from levitation, so none is possible without it.
        grounded = rest & (data["possible"].values == 0)
    elif values.attrs.get("si_of", values.name) in _LEVITATING:
        grounded = rest & (data["levitates"].values == 0)
    return {"no-levitation": grounded, "none": rest & ~grounded, **reasons}


def _shades(
    axes: Axes,
    edges: tuple[Floats, Floats],
    values: xarray.DataArray,
    reasons: Mapping[str, np.ndarray],
) -> None:
    """Draw a number as shades with a colour bar, or a flag as colours."""
    shown = np.ma.masked_invalid(np.asarray(values.values, float))
    look: dict[str, object] = {}
    meanings = str(values.attrs.get("flag_meanings", "")).split()
    if meanings:
        look = {"cmap": ListedColormap(_FLAGS[: len(meanings)]), "vmin": -0.5, "vmax": len(meanings) - 0.5}
    elif values.name in _SHARES:
        look = {"vmin": 0.0, "vmax": 1.0}
    elif _counts(values):
        most = max(int(shown.filled(0.0).max()), 1)
        look = {"vmin": 0.0, "vmax": most}
        if most <= _MOST_STEPS:
            look = {"cmap": colormaps[SHADES].resampled(most + 1), "vmin": -0.5, "vmax": most + 0.5}
    words = "" if meanings or not shown.count() else _label(values)
    none = _NONE.get(values.attrs.get("si_of", values.name), BLANKS["none"].words)
    bar = draw_map(axes, edges, shown, words, reasons, {"none": none}, **look)
    if bar is not None:
        _ticks(bar.ax.yaxis, values)
    for colour, word in zip(_FLAGS, meanings, strict=False):
        axes.fill_between([], [], fc=colour, ec="#8c8c8c", lw=0.4, label=word.replace("_", " "))


def _label(values: xarray.DataArray) -> str:
    """Return the words and the unit of a variable."""
    words, unit = _SHARES.get(str(values.name)) or values.attrs["long_name"], values.attrs.get("units", "1")
    lines = textwrap.fill(str(words), _LONGEST)
    return lines if unit == "1" else f"{lines} ({formula(unit)})"
