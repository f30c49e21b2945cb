"""Maps of the plane of two parameters: curves of bifurcations, their meeting points, and the regions between."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import Normal, Stroke

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS
from carom.plots.diagrams import CURVES, curve_line
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.style import Drawn, styled
from carom.plots.words import label_parameter, with_symbols

if TYPE_CHECKING:
    from carom.bifurcations import Region, RegionMap

_BLACK, _MACHINE, _UNEXPLAINED = "#1a1a1a", "#f0e442", "#cc0000"
_LONGEST_HALF = 100
"""Number of characters of a region's description that fit in half of the width."""
_HEIGHT, _LINE = 0.6, 0.135
"""Height of the figure without the list of regions, relative to its width, and height of a line of this list [inch]."""

_TOP_AXIS = 0.34
"""Height of the ticks and the label of an axis at the top [inch]."""


@checked
@styled
def region_map(found: RegionMap) -> Figure:
    """Draw the curves of bifurcations in the plane of two parameters, the points where they meet and the regions.

    Each region has its number in the JSON document, by which it is described below the axes, without the motions of all regions.
    """
    lines = [f"{number}: {_name(found, region)}" for number, region in enumerate(found.regions, start=1)]
    if found.everywhere:
        lines.append(f"everywhere: {', '.join(found.everywhere)}")
    columns = 2 if max(map(len, lines), default=0) <= _LONGEST_HALF else 1
    figure = StyledFigure(figsize=(TWO_COLUMNS, _HEIGHT * TWO_COLUMNS + _LINE * -(-len(lines) // columns)))
    drawn = figure.subplots()
    units = np.array([axis.field.usual_size for axis in found.axes])
    if not found.model.has_closed_forms:
        _draw_cells(drawn, found, units)
    # The broad line of non-smooth Hopf bifurcations lies below all others.
    for curve in sorted(found.curves, key=lambda curve: curve.kind != "non-smooth-hopf"):
        curve_line(drawn, curve, units, virtual=False)
    for number, region in enumerate(found.regions, start=1):
        _write(drawn, str(number), tuple(np.array(region.point) / units), "numeral", ha="center", va="center")
    scales = found.model.scales
    aside = label_parameter(drawn, "x", found.axes[0].field, scales, own=drawn)
    label_parameter(drawn, "y", found.axes[1].field, scales, own=drawn)
    drawn.set(xlim=np.array(found.plane.first_range) / units[0], ylim=np.array(found.plane.second_range) / units[1])
    # Above the axes and their labels at the top: one of the figure would overlap the title.
    above = _TOP_AXIS / float(drawn.bbox.height / figure.dpi) if aside else 0.0
    handles = [*_curve_key(found), *_mark_points(drawn, found, units)]
    drawn.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0 + above), ncols=3)
    handles = [Line2D([], [], ls="none", label=with_symbols(line)) for line in lines]
    figure.legend(handles=handles, loc="outside lower center", ncols=columns, handlelength=0.0, fontsize=6.5)
    return figure


def _write(axes: Axes, words: str, place: tuple[float, float], gid: str, shift: float = 0.0, **options: Any) -> None:
    """Write words at a place, or shifted from it to the left and downward, readable upon lines."""
    outline = [Stroke(linewidth=2.5, foreground="#ffffff"), Normal()]
    look = options | {"textcoords": "offset points", "fontsize": 7, "zorder": 8, "path_effects": outline}
    axes.annotate(words, place, (-shift, -shift), gid=gid, **look)


def _draw_cells(axes: Axes, found: RegionMap, units: np.ndarray) -> None:
    """Shade the cells of a grid by region, where no curves are followed between these."""
    places = np.concatenate([region.places for region in found.regions])
    numbers = np.concatenate([np.full(len(region.places), number) for number, region in enumerate(found.regions)])
    xs, ys = (np.unique(places[:, k]) for k in (0, 1))
    cells = np.full((len(ys), len(xs)), np.nan)
    cells[np.searchsorted(ys, places[:, 1]), np.searchsorted(xs, places[:, 0])] = numbers
    axes.pcolormesh(
        xs / units[0], ys / units[1], cells, cmap="Pastel1", vmin=0, vmax=9, shading="nearest", rasterized=True
    )


def _name(found: RegionMap, region: Region) -> str:
    """Return the motions that a region has and not all have."""
    absent = ("no ", f"{STEADY_WORDS['contact-free']} virtual")
    parts = [part for part in region.motions.parts if part not in found.everywhere and not part.startswith(absent)]
    lines = [line for part in parts for line in part.removeprefix("stable ").split(" and ")]
    return ", ".join(lines) or "none of these motions"


def _curve_key(found: RegionMap) -> list[Line2D]:
    """Return the legend entries of the curves, with their orbits."""
    lines = []
    shown = [curve for curve in found.curves if np.any(curve.admissible)]
    for kind, look in CURVES.items():
        if any(curve.kind == kind for curve in shown):
            orbits = found.orbits_of(kind)
            lines.append(look.entry(f"{look.words}: {with_symbols(orbits)}" if orbits else ""))
    return lines


def _mark_points(axes: Axes, found: RegionMap, units: np.ndarray) -> list[Line2D]:
    """Mark meeting points, resonances, changes without a curve and the machine; return their legend entries."""
    entries: dict[str, Line2D] = {}

    def mark(place: tuple[float, float], words: str, marker: str, size: float, face: str, edge: str = _BLACK) -> None:
        x, y = np.array(place) / units
        look: Drawn = {"ls": "none", "marker": marker, "ms": size, "mfc": face, "mec": edge, "zorder": 6}
        (entries[words],) = axes.plot([x], [y], **look, gid=words, label=words)

    for point in found.codimension2:
        if not point.admissible:
            continue
        resonance = point.resonance
        look = ("resonance of the multipliers", "D", 4.0) if resonance else ("two at once", "o", 4.5)
        mark(point.value, *look, _BLACK)
        if resonance:
            _write(axes, resonance, tuple(np.array(point.value) / units), "resonance", 4.0, ha="right", va="top")
    for change in found.unexplained:
        mark(change.point, "change of motions not explained by a curve", "x", 4.0, _UNEXPLAINED, _UNEXPLAINED)
    if found.present is not None:
        mark(found.present, "the machine as it is", "*", 9.0, _MACHINE)
    return list(entries.values())
