"""Figures 2 to 6 of the source paper, from the results of :mod:`carom.reproductions.mora2014`.

All are 180 mm wide.  Stable is solid, unstable dashed, virtual faint; every kind of special point has its own marker.
"""

from carom.reproductions.mora2014.drawing.motions import figure_2
from carom.reproductions.mora2014.drawing.periods import figure_3
from carom.reproductions.mora2014.drawing.plane import figure_6
from carom.reproductions.mora2014.drawing.speeds import figure_4, figure_5

__all__ = ["figure_2", "figure_3", "figure_4", "figure_5", "figure_6"]
