"""How a flexible rotor levitates: its free whirls over the speed, and the sensitivity of its loops."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.parameters.fields import RPM
from carom.plots.figure import StyledFigure
from carom.plots.plane import key, one_axes
from carom.plots.responses import CRITICAL, PRESENT
from carom.plots.style import LOOKS, TWO_COLUMNS, ZONE_SHADES, styled
from carom.plots.words import number

if TYPE_CHECKING:
    from carom.rotors import Campbell, Sensitivity

_HERTZ = 2.0 * math.pi
_LINES = ("-", "--", "-.", ":")
MARKS = 15
"""Marks along a whirl, so that its sense is seen."""
_ROOM = 1.15
"""Height of the axes over what is drawn."""


@checked
@styled
def campbell(found: Campbell) -> Figure:
    """Draw the frequencies of free whirls over the speed of the shaft, and below them their damping ratios.

    Each whirl is a line: solid and with triangles that point up where it goes forward, broken and with triangles that point down where it
    goes backward.  Where it grows the triangles are hollow.  Dotted lines are where forward whirls meet the line on which unbalance excites them: undamped, these would be the critical speeds.
    """
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.8 * TWO_COLUMNS))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.7, 1.0))
    order = np.argsort(found.speeds)
    speeds, exponents, ratios = found.speeds[order] / RPM, found.exponents[order], found.damping_ratios[order]
    ends = np.array([0.0, speeds[-1]])
    upper.plot(ends, ends * RPM / _HERTZ, color="#1a1a1a", lw=0.9, label="speed of the shaft", gid="synchronous")
    criticals = list[float]()
    for branch, damping in zip(exponents.T, ratios.T, strict=True):
        for name, line, goes in (("forward", "-", branch.imag > 0.0), ("backward", "--", branch.imag <= 0.0)):
            for grows in (False, True):
                those = goes & ((branch.real >= 0.0) == grows)
                if not those.any():
                    continue
                words = f"{name} whirl{' that grows' if grows else ''}"
                look = LOOKS[name].mark(4.0, filled=not grows) | {"color": LOOKS[name].colour, "ls": line}
                look |= {"markevery": max(1, len(speeds) // MARKS), "label": words, "gid": words}
                upper.plot(speeds, np.where(those, np.abs(branch.imag) / _HERTZ, np.nan), **look)
                lower.plot(speeds, np.where(those, damping, np.nan), **look)
        criticals += _crossings(speeds, branch.imag / RPM - speeds)
    rates = ", ".join(f"{each:,.0f}" for each in sorted(criticals))
    for axes in (upper, lower):
        for each in criticals:
            axes.axvline(each, **CRITICAL.stroke, label=f"forward whirl meets the speed: {rates} rpm")
        present = found.machine.speed / RPM
        axes.axvline(present, **PRESENT.stroke, label=f"present speed, {present:,.0f} rpm", gid="present")
    lower.axhline(0.0, color="#1a1a1a", lw=0.5)
    upper.set(xlim=ends, ylim=(0.0, _ROOM * float(np.nanmax(np.abs(found.frequencies), initial=0.0))))
    upper.set_ylabel("frequency of the free whirl (Hz)")
    lower.set(xlabel="speed of the shaft (rpm)", ylabel="damping ratio")
    figure.align_ylabels([upper, lower])
    return key(figure, [upper], columns=3)


def _crossings(along: np.ndarray, heights: np.ndarray) -> list[float]:
    """Places at which a line through points changes its sign."""
    at = np.flatnonzero(heights[:-1] * heights[1:] < 0.0)
    steps = heights[at] / (heights[at] - heights[at + 1])
    return [float(each) for each in along[at] + steps * (along[at + 1] - along[at])]


@checked
@styled
def sensitivity(found: Sensitivity) -> Figure:
    """Draw the size of the sensitivity of each loop over the frequency, with its peak and the zones of ISO 14839-3, which an unstable loop has not."""
    from carom.rotors.loop_sensitivity import LIMITS

    figure, axes = one_axes((TWO_COLUMNS, 0.62 * TWO_COLUMNS))
    if not found.stable:
        figure.suptitle("The loop is unstable: it has no zones of ISO 14839-3")
    top = max(_ROOM * float(found.peaks.max()), _ROOM * LIMITS["C"])
    edges = [0.0, *LIMITS.values(), top]
    for zone, low, high, shade in zip("ABCD" if found.stable else "", edges[:-1], edges[1:], ZONE_SHADES, strict=False):
        axes.axhspan(low, high, color=shade, lw=0.0)
        axes.text(0.995, (low + high) / 2.0, zone, transform=axes.get_yaxis_transform(), ha="right", va="center")
    for bearing, (peak, frequency) in enumerate(zip(found.peaks, found.peak_frequencies, strict=True)):
        words = f"bearing {bearing + 1}: {number(float(peak), 3)} at {number(float(frequency) / _HERTZ, 3)} Hz"
        look = LOOKS["unstable" if bearing % 2 else "stable"]
        line: dict[str, Any] = {"ls": _LINES[bearing % len(_LINES)], "label": words, "gid": f"bearing-{bearing}"}
        axes.plot(found.frequencies / _HERTZ, np.abs(found.values[:, bearing]), **line, color=look.colour)
        axes.plot([frequency / _HERTZ], [peak], marker="o", ms=4.0, color=look.colour)
    ends = found.frequencies[0] / _HERTZ, found.frequencies[-1] / _HERTZ
    axes.set(xscale="log", xlim=ends, ylim=(0.0, top), xlabel="frequency (Hz)", ylabel="sensitivity (no unit)")
    return key(figure, [axes], columns=2)
