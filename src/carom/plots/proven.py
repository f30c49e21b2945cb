"""What is proven along a parameter: a bar and the marks of points, in a row of their own or on a line of a plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

if TYPE_CHECKING:
    from carom.proofs.proven_lines import ProvenLine

_COLOUR, _THICK = "#4d4d4d", 2.4
_POINT: dict[str, Any] = {"ls": "none", "marker": "d", "ms": 5.0, "mfc": "#ffffff", "mec": "#1a1a1a", "mew": 0.8}


def proven_line(
    axes: Axes, line: ProvenLine, words: str, height: float, unit: float, upright: bool = False
) -> list[Line2D]:
    """Draw the stretches and the points at a height, or at an abscissa if upright; return their legend entries.

    `words` say what is proven on the stretches.  `unit` is the divisor of the parameter.
    """
    here = [height, height]
    bar: dict[str, Any] = {"color": _COLOUR, "lw": _THICK, "solid_capstyle": "butt"}
    for stretch in line.stretches:
        ends = [stretch.low / unit, stretch.high / unit]
        axes.plot(*((here, ends) if upright else (ends, here)), **bar, gid="proven")
    places = [value / unit for value in line.points]
    heights = [height] * len(places)
    axes.plot(*((heights, places) if upright else (places, heights)), **_POINT, zorder=4.5, gid="proven point")
    entries = []
    if line.stretches:
        words += "" if line.slip else ", but where impacts stop the slip"
        entries.append(Line2D([], [], **bar, label=words))
    if line.points:
        entries.append(Line2D([], [], **_POINT, label="proven point"))
    return entries
