"""Fits: what was measured, the fitted motion, and what is left between both."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.plane import key
from carom.plots.style import LOOKS, Drawn, styled

if TYPE_CHECKING:
    from carom.fitting import Fit

_HEIGHT, _RATIOS = 0.17, (3.0, 1.3)
"""Height of the panels of a channel over the width of the figure, and those of motion and residuals."""
_MOST_DOTS = 1500
"""Samples of a channel above which they are thinned."""
_MEASURED: Drawn = {"ls": "none", "marker": "o", "ms": 1.6, "mew": 0.0, "color": "#7f7f7f"}
_LEFT: Drawn = {"ls": "none", "marker": ".", "ms": 2.0, "color": "#0072b2"}


@checked
@styled
def fit(found: Fit) -> Figure:
    """Draw each channel of a record with the fitted motion, and below it the residuals, over time."""
    channels = found.record.channels
    rows = 2 * len(channels)
    figure = StyledFigure(figsize=(TWO_COLUMNS, _HEIGHT * TWO_COLUMNS * rows * 0.75))
    panels = figure.subplots(rows, 1, sharex=True, squeeze=False, height_ratios=_RATIOS * len(channels))
    first, last = found.first, found.first + len(found.residuals)
    times = 1e3 * found.record.times[first:last]
    thin = slice(None, None, max(1, len(times) // _MOST_DOTS))
    for number, channel in enumerate(channels):
        measured, left = 1e6 * found.record.values[first:last, number], 1e6 * found.residuals[:, number]
        motion, residuals = panels[2 * number, 0], panels[2 * number + 1, 0]
        motion.plot(times[thin], measured[thin], **_MEASURED, label="measured", gid="measured")
        motion.plot(times, measured + left, lw=0.8, color=LOOKS["path"].colour, label="fitted motion", gid="fitted")
        motion.set_ylabel(f"{channel.text} (µm)")
        residuals.plot(times[thin], left[thin], **_LEFT, label="fitted minus measured", gid="residuals")
        residuals.axhline(0.0, lw=0.5, color="0.6")
        reach = max(3.5e6 * found.noise, 1.05 * np.abs(left).max())
        residuals.set(ylim=(-reach, reach), ylabel="left (µm)")
    panels[-1, 0].set_xlabel("time (ms)")
    return key(figure, panels.ravel().tolist(), columns=3)
