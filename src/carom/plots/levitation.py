"""How a flexible rotor levitates: its free whirls over the speed, and the sensitivity of its loops."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.parameters.fields import RPM
from carom.plots.plane import key, one_axes
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
    """Draw the frequencies of free whirls over the speed of the shaft, with the line on which unbalance excites them.

    Each whirl is a line: solid and with triangles that point up where it goes forward, broken and with triangles that point down where it
    goes backward.  Where it grows the triangles are hollow.
    """
    figure, axes = one_axes(None, (TWO_COLUMNS, 0.62 * TWO_COLUMNS))
    order = np.argsort(found.speeds)
    speeds, exponents = found.speeds[order] / RPM, found.exponents[order]
    every = max(1, len(speeds) // MARKS)
    shown: set[str] = set()
    for branch in exponents.T:
        for name, line, goes in (("forward", "-", branch.imag > 0.0), ("backward", "--", branch.imag <= 0.0)):
            heights = np.where(goes, np.abs(branch.imag) / _HERTZ, np.nan)
            for grows in (False, True):
                words = f"{name} whirl{' that grows' if grows else ''}"
                those = np.where((branch.real >= 0.0) == grows, heights, np.nan)
                if np.isnan(those).all():
                    continue
                axes.plot(
                    speeds,
                    those,
                    linestyle=line,
                    lw=0.9,
                    marker=LOOKS[name].marker,
                    markersize=4.0,
                    markevery=every,
                    color=LOOKS[name].colour,
                    markerfacecolor="none" if grows else LOOKS[name].colour,
                    label=None if words in shown else words,
                    gid=words,
                )
                shown.add(words)
    ends = np.array([0.0, found.speeds.max()])
    axes.plot(ends / RPM, ends / _HERTZ, color="#1a1a1a", lw=0.9, label="speed of the shaft", gid="synchronous")
    axes.set_xlim(0.0, found.speeds.max() / RPM)
    axes.set_ylim(0.0, _ROOM * float(np.nanmax(np.abs(found.frequencies), initial=0.0)))
    axes.set_xlabel("speed of the shaft (rpm)")
    axes.set_ylabel("frequency of the free whirl (Hz)")
    key(figure, [axes], columns=3)
    return figure


@checked
@styled
def sensitivity(found: Sensitivity) -> Figure:
    """Draw the size of the sensitivity of each loop over the frequency, with its peak and the zones of ISO 14839-3, which an unstable loop has not."""
    from carom.rotors.loop_sensitivity import LIMITS

    figure, axes = one_axes(None, (TWO_COLUMNS, 0.62 * TWO_COLUMNS))
    if not found.stable:
        figure.suptitle("The loop is unstable: it has no zones of ISO 14839-3")
    top = max(_ROOM * float(found.peaks.max()), _ROOM * LIMITS["C"])
    edges = [0.0, *LIMITS.values(), top]
    for zone, low, high, shade in zip("ABCD" if found.stable else "", edges[:-1], edges[1:], ZONE_SHADES, strict=False):
        axes.axhspan(low, high, color=shade, lw=0.0)
        axes.text(0.995, (low + high) / 2.0, zone, transform=axes.get_yaxis_transform(), ha="right", va="center")
    for bearing, (peak, frequency) in enumerate(zip(found.peaks, found.peak_frequencies, strict=True)):
        words = f"bearing {bearing + 1}: {number(float(peak), 3)} at {number(float(frequency) / _HERTZ, 3)} Hz"
        (line,) = axes.plot(
            found.frequencies / _HERTZ,
            np.abs(found.values[:, bearing]),
            linestyle=_LINES[bearing % len(_LINES)],
            color=LOOKS["stable"].colour if bearing % 2 == 0 else LOOKS["unstable"].colour,
            label=words,
            gid=f"bearing-{bearing}",
        )
        axes.plot([frequency / _HERTZ], [peak], marker="o", markersize=4.0, color=line.get_color())
    axes.set_xscale("log")
    axes.set_xlim(found.frequencies[0] / _HERTZ, found.frequencies[-1] / _HERTZ)
    axes.set_ylim(0.0, top)
    axes.set_xlabel("frequency (Hz)")
    axes.set_ylabel("sensitivity (no unit)")
    key(figure, [axes], columns=2)
    return figure
