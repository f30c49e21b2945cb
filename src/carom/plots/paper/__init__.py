"""Figures 2 to 6 of the source paper, from the results of :mod:`carom.paper`.

All are 180 mm wide.  Stable is solid, unstable dashed, virtual faint; every kind of special point has its own marker.
"""

from carom.plots.paper.motions import figure_2
from carom.plots.paper.periods import figure_3
from carom.plots.paper.plane import figure_6
from carom.plots.paper.speeds import figure_4, figure_5

__all__ = ["figure_2", "figure_3", "figure_4", "figure_5", "figure_6"]
