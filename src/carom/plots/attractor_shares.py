"""Which share of the disturbances ends on each attractor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.plots.cells import looks_of, share_bars
from carom.plots.plane import one_axes
from carom.plots.style import TWO_COLUMNS, styled

if TYPE_CHECKING:
    from carom.attractors import AttractorSet

_ROW, _EDGES = 0.26, 0.9
"""Height of a row and of everything else [inch]."""


@checked
@styled
def attractors(found: AttractorSet) -> Figure:
    """Draw the share of the disturbances that end on each attractor, of any rotor.

    An attractor that only starts next to it have reached has no bar.
    """
    figure, drawn = one_axes((TWO_COLUMNS, _EDGES + _ROW * len(found)))
    total = len(found.disturbances)
    looks = looks_of([member.name for member in found], [member.share_of_disturbances for member in found])
    by_row = sorted(looks, key=lambda look: look.index)
    counts = [f"{member.count} of {total}" for member in found]
    share_bars(drawn, by_row, counts, [100.0 * look.share for look in by_row])
    drawn.set_xlabel("share of the disturbances (%)")
    return figure
