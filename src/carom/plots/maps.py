"""Maps of a number over two parameters, in shades with the machine as it is: what share comes back, and loads of drops."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import PercentFormatter

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS, InputError
from carom.parameters import in_terms_of
from carom.parameters.formats import number as plain
from carom.parameters.in_terms import EXACT
from carom.plots.cells import cells_path, finish, looks_of, paint
from carom.plots.figure import ONE_COLUMN, TWO_COLUMNS, StyledFigure
from carom.plots.plane import Floats, key, one_axes
from carom.plots.style import Drawn, Look, styled
from carom.plots.words import number, parameter_label

if TYPE_CHECKING:
    from carom.basins import DropMap, GainMap
    from carom.models import Axis
    from carom.parameters import Case
    from carom.plots.plane import Floats

BLANKS = MappingProxyType(
    {
        "no-levitation": Look("#e6e6e6", f"no {STEADY_WORDS['contact-free']}", hatch=r"\\"),
        "none": Look("#ffffff", "no such value", hatch="////"),
        "waiting": Look("#ffffff", "not computed yet", hatch="...."),
        "failed": Look("#ffffff", "failed", hatch="xxxx"),
    }
)
"""Why a cell has no value: distinguished by hatching, also in greyscale and for colour-blind readers."""
SHADES = "cividis"
"""Colour map that can be read by colour-blind readers and in greyscale (Nuñez, Anderton, Renslow 2018)."""
_INK = "#8c8c8c"
"""Colour of the hatching and edges of cells without a value."""


def cell_edges(values: Floats, logarithmic: bool = False) -> Floats:
    """Return the edges of the cells around values: halfway between them on their axis."""
    along = np.log(values) if logarithmic else np.asarray(values, float)
    steps = np.diff(along) if len(along) > 1 else np.ones(1)
    edges = np.concatenate(
        [[along[0] - 0.5 * steps[0]], along[:-1] + 0.5 * np.diff(along), [along[-1] + 0.5 * steps[-1]]]
    )
    return np.exp(edges) if logarithmic else edges


def draw_map(
    axes: Axes,
    edges: tuple[Floats, Floats],
    values: np.ma.MaskedArray,
    words: str,
    reasons: Mapping[str, np.ndarray],
    replaced: Mapping[str, str] = MappingProxyType({}),
    **look: Any,
) -> Colorbar | None:
    """Draw cells, values of shape (n, m) between n + 1 and m + 1 edges, in shades with a colour bar; masked ones by why they have no value.

    Parameters
    ----------
    words : str
        Label of the colour bar; without words there is none.
    reasons, replaced : mapping
        Cells without a value, and words instead of those of the looks, by keys of :data:`BLANKS`.
    **look
        Colour map and its limits, as for ``pcolormesh``.
    """
    mesh = axes.pcolormesh(*edges, values.T, rasterized=True, gid="cells", **{"cmap": SHADES, **look})
    for reason, cells in reasons.items():
        mark_cells(
            axes, edges, cells, replace(BLANKS[reason], words=replaced.get(reason, BLANKS[reason].words)), reason
        )
    if not words:
        return None
    bar = axes.figure.colorbar(mesh, ax=axes, pad=0.02, label=words)
    bar.outline.set_linewidth(0.5)
    return bar


def mark_cells(axes: Axes, edges: tuple[Floats, Floats], cells: np.ndarray, look: Look, gid: str) -> None:
    """Fill or hatch cells with a look, whose words stand in the legend."""
    if cells.any():
        drawn: Drawn = {"facecolor": look.colour, "hatch": look.hatch, "edgecolor": _INK, "zorder": 1.5}
        axes.add_patch(PathPatch(cells_path(np.meshgrid(*edges), cells), lw=0.0, gid=gid, label=look.words, **drawn))


def mark_present(axes: Axes, place: Sequence[float], edges: Sequence[Floats], words: str) -> None:
    """Mark the machine as it is, if it lies between edges of cells."""
    if not all(min(along) <= value <= max(along) for value, along in zip(place, edges, strict=True)):
        return
    star: Drawn = {"marker": "*", "ms": 9.0, "mfc": "white", "mec": "#1a1a1a", "mew": 0.7, "ls": "none"}
    axes.plot(*place, **star, gid="present", clip_on=False, zorder=4, label=words)


_LEVELS = MappingProxyType({0.5: ":", 0.9: "--", 0.99: "-"})
"""Shares at which contours are drawn, and their line styles."""
_WORDS = "share of disturbances that come back"
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
        replaced["no-levitation"] = "no levitation (at the cell centre)"
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


_SHOWN = {
    "N": (1e-3, "kN"),
    "m": (1e6, "µm"),
    "W": (1e-3, "kW"),
    "Pa": (1e-9, "GPa"),
    "degC": (1.0, "°C"),
    "s": (1e3, "ms"),
}
"""Units of loads in figures, by their SI units."""
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
    loads = {name: values for name, values in found.dataset.items() if "units" in values.attrs}
    known = [str(name) for name, values in loads.items() if np.isfinite(values.values).any()]
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
    stated = str(loads[name].attrs["units"])
    factor, unit = (100.0, "%") if name.endswith("_share") else _SHOWN.get(stated, (1.0, stated.removeprefix("1")))
    values = np.ma.masked_invalid(factor * loads[name].values)
    words = str(loads[name].attrs["long_name"])
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
