"""Which share of the disturbances ends on each attractor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.arguments import checked
from carom.plots.cells import looks_of
from carom.plots.plane import one_axes
from carom.plots.style import TWO_COLUMNS, styled

if TYPE_CHECKING:
    from carom.attractors import AttractorSet

_ROW, _EDGES = 0.26, 0.9
"""Height of a row and of everything else [inch]."""


@checked
@styled
def attractors(found: AttractorSet, title: str | None = None, *, axes: Axes | None = None) -> Figure:
    """Draw the share of the disturbances that end on each attractor, of any rotor.

    An attractor that only starts next to it have reached has no bar; motions that were given up are hatched.
    """
    figure, drawn = one_axes(axes, (TWO_COLUMNS, _EDGES + _ROW * len(found)))
    total = len(found.disturbances)
    looks = looks_of([member.name for member in found], [member.share_of_disturbances for member in found])
    by_row = sorted(looks, key=lambda look: look.index)
    for row, (member, look) in enumerate(zip(found, by_row, strict=True)):
        share, filled = 100.0 * member.share_of_disturbances, look.filled
        drawn.barh(row, share, 0.7, **filled if member.settled else filled | {"hatch": "////"}, lw=0.3)
        drawn.annotate(f"{member.count} of {total}", (share, row), (4, 0), textcoords="offset points", va="center")
    drawn.set_yticks(range(len(found)), [look.words for look in by_row])
    drawn.invert_yaxis()
    drawn.set(xlim=(0.0, 115.0), xticks=range(0, 101, 20), xlabel="share of the disturbances (%)")
    if title:
        drawn.set_title(title)
    return figure
