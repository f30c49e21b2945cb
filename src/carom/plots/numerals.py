"""Names of the regions of a plane, placed clear of all curves; thin regions have numerals, beside them with a leader line."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from matplotlib.patheffects import Normal, Stroke

from carom.plots.figure import POINTS, gauge
from carom.plots.plane import Floats

if TYPE_CHECKING:
    from carom.bifurcations import RegionMap

_SIZE, _LINE = 7.0, 8.4
"""Size of the letters and height of a line [pt]."""
_MARGIN = 2.0
"""Least distance between a numeral and a line [pt]."""
_COLOUR = "#3d4f66"
_BETTER = 1.2
"""Factor by which another point must have more room than the point of the region itself."""
_RINGS, _DIRECTIONS = np.arange(3.0, 60.0, 3.0), np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
"""Distances [pt] and directions in which a place for the numeral of a thin region is searched."""
_LEADER, _APART = 12.0, 2.0
"""Least length of a leader line; least distance between a leader line and the curves that it does not cross [pt]."""


def name_regions(
    axes: Axes, found: RegionMap, units: Floats, names: Sequence[str], listed: Collection[int], *, virtual: bool = False
) -> set[int]:
    """Write the names of all regions into axes that are otherwise complete and laid out, clear of curves and points.

    A region without room for its name has its numeral, beside it if it is thin.

    Parameters
    ----------
    units : ndarray, shape (2,)
        Divisors of the two parameters.
    names : sequence of str
        Of each region; the parts of a name are separated by line breaks.
    listed : collection of int
        Numbers of the regions that are described elsewhere, and have their numeral only.
    virtual : bool
        Whether the curves of virtual motions are drawn too.

    Returns
    -------
    set of int
        Numbers of the regions that have no name in their area.
    """
    figure = axes.get_figure(root=True)
    if figure is None:
        return set()
    point = figure.dpi / POINTS
    taken = _drawn(axes, found, units, virtual) / point
    frame = np.reshape(axes.bbox.extents, (2, 2)) / point
    curves = taken
    slivers, without = [], set()
    for number, region in enumerate(found.regions, start=1):
        candidates = np.vstack([region.point, region.places]) / units
        places = axes.transData.transform(candidates) / point
        texts = [] if number in listed else _arranged(names[number - 1])
        for text in (*texts, str(number)):
            half = _half(text)
            room = _room(places, taken, frame, half)
            best = int(np.argmax(room))
            if room[best] >= 1.0:
                chosen = best if room[best] > _BETTER * room[0] else 0
                _write(axes, text, candidates[chosen])
                taken = np.vstack([taken, _outline(half, places[chosen])])
                break
        else:
            slivers.append((str(number), candidates[best], places[best]))
        if text == str(number):
            without.add(number)
    for text, foot, place in slivers:
        aside, within = _place_beside(place, curves, taken, frame, _half(text))
        there = axes.transData.inverted().transform(aside * point)
        _write(axes, text, *((there,) if within else (foot, there)))
        taken = np.vstack([taken, _outline(_half(text), aside)])
    return without


def _arranged(name: str) -> list[str]:
    """Return a name as one part a line, as two lines, and as one line."""
    parts = name.split("\n")
    middle = (len(parts) + 1) // 2
    two = "\n".join(", ".join(some) for some in (parts[:middle], parts[middle:]) if some)
    return list(dict.fromkeys([name, two, ", ".join(parts)]))


def _drawn(axes: Axes, found: RegionMap, units: Floats, virtual: bool) -> Floats:
    """Return the points of all curves, one per pixel, and their meeting points [pixels]."""
    lines = [np.zeros((0, 2))]
    for curve in found.curves:
        shown = curve.points if virtual else curve.points[curve.admissible]
        if not len(shown):
            continue
        places = axes.transData.transform(shown / units)
        along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1)))
        steps = np.linspace(0.0, along[-1], int(along[-1]) + 2)
        lines.append(np.transpose([np.interp(steps, along, part) for part in places.T]))
    marked = [point.value for point in found.codimension2] + [change.point for change in found.unexplained]
    marked += [] if found.present is None else [found.present]
    lines += [axes.transData.transform([np.array(place) / units]) for place in marked]
    return np.concatenate(lines)


def _half(text: str) -> Floats:
    """Return half of the width and height of a text with its margin [pt]."""
    font, lines = FontProperties(size=_SIZE), text.split("\n")
    width = max(gauge().get_text_width_height_descent(line, font, "$" in line)[0] for line in lines)
    return np.array([0.5 * width, 0.5 * _LINE * len(lines)]) + _MARGIN


def _room(places: Floats, taken: Floats, frame: Floats, half: Floats) -> Floats:
    """Return the factor by which a numeral at each place could grow until it meets a line; it fits from 1 on."""
    room: Floats = (np.minimum(places - frame[0], frame[1] - places) / half).min(axis=1)
    if len(taken):
        room = np.minimum(room, (np.abs(places[:, None] - taken) / half).max(axis=2).min(axis=1))
    return room


def _place_beside(place: Floats, curves: Floats, taken: Floats, frame: Floats, half: Floats) -> tuple[Floats, bool]:
    """Find the nearest place around a point with room for a numeral, and whether no curve lies between the two.

    A place without a curve in between is preferred.  If none has room, the one with the most room is returned.
    """
    ways = np.transpose([np.cos(_DIRECTIONS), np.sin(_DIRECTIONS)])
    around = place + _RINGS[:, None, None] * ways
    room = np.array([_room(ring, taken, frame, half) for ring in around])
    for chosen in np.argwhere(room >= 1.0):
        if _line_is_clear(place, around[tuple(chosen)], curves):
            return around[tuple(chosen)], True
    room[_RINGS < _LEADER] = -np.inf
    fit = np.flatnonzero(room.max(axis=1) >= 1.0)
    ring = fit[0] if len(fit) else int(np.argmax(room.max(axis=1)))
    return around[ring, int(np.argmax(room[ring]))], False


def _line_is_clear(first: Floats, second: Floats, curves: Floats) -> bool:
    """Whether the straight line between two places keeps clear of all curves."""
    # Only points in the bounding box of the line can be near it: few of the thousands of points of the curves.
    low, high = np.minimum(first, second) - _APART, np.maximum(first, second) + _APART
    near = curves[((curves >= low) & (curves <= high)).all(axis=1)]
    path = first + np.linspace(0.0, 1.0, 40)[:, None] * (second - first)
    return bool((np.abs(path[:, None] - near).max(axis=2) > _APART).all())


def _outline(half: Floats, place: Floats) -> Floats:
    """Return points of a grid over a text, which others must keep clear of; `half` includes its margin."""
    inner = half - _MARGIN
    columns, rows = (np.linspace(-extent, extent, int(extent / _MARGIN) + 3) for extent in inner)
    return np.asarray(place + np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2))


def _write(axes: Axes, words: str, foot: Floats, aside: Floats | None = None) -> None:
    """Write a name or a numeral at a point, or beside it with a thin line to a dot at the point."""
    leader = None
    if aside is not None:
        axes.plot(*foot, ls="none", marker=".", ms=3.0, mew=0.0, color=_COLOUR, zorder=7, gid="foot")
        leader = {"arrowstyle": "-", "lw": 0.5, "color": _COLOUR, "shrinkA": 0.0, "shrinkB": 0.0}
    text = axes.annotate(
        words,
        (float(foot[0]), float(foot[1])),
        None if aside is None else (float(aside[0]), float(aside[1])),
        textcoords="data",
        ha="center",
        va="center",
        fontsize=_SIZE,
        color=_COLOUR,
        zorder=7,
        arrowprops=leader,
        linespacing=1.15,
        gid="numeral" if words.isdigit() else "name",
    )
    text.set_path_effects([Stroke(linewidth=2.5, foreground="#ffffff"), Normal()])
