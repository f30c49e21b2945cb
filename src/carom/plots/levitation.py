"""How a flexible rotor levitates: its free whirls over the speed and along the shaft, and the sensitivity of its loops."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.parameters.fields import RPM
from carom.plots.figure import StyledFigure
from carom.plots.plane import Floats, key, one_axes
from carom.plots.responses import CRITICAL, PRESENT
from carom.plots.style import LOOKS, TWO_COLUMNS, ZONE_SHADES, Look, styled
from carom.plots.words import number

if TYPE_CHECKING:
    import carom.rotors
    from carom.rotors import Campbell, FlexibleMachine, Sensitivity, WhirlMode

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


_COLUMNS, _ROW = 2, 0.165
"""Columns of panels, and height of a row, in widths of the figure."""
_REACH, _MARKED = 1.35, -1.12
"""Height of a panel over the largest displacement, and where bearings and sensors are marked in it."""
_ROUND = 0.05
"""Share of the other direction in a shape from which on it does not lie in one plane."""
_SHAFT, _DISC = 0.12, 0.6
"""Half heights at which the widest section of the shaft and discs are drawn; their lengths are to scale."""
_PLATE: dict[str, Any] = {"color": "#8c959f", "lw": 3.5, "solid_capstyle": "butt", "zorder": 0.5}
"""Look of a disc."""
_MILLIMETRES = 1e3
_PARTS = (
    ("magnet", Look("#1a1a1a", "magnet", marker="s")),
    ("sensor", Look("#1a1a1a", "sensor", marker="o")),
    ("touchdown", Look("#a52f74", "touchdown bearing", marker="|")),
)


@checked
@styled
def mode_shapes(flexible: FlexibleMachine, whirls: Sequence[carom.rotors.WhirlMode]) -> Figure:
    """Draw the shapes of free whirls along the shaft, one panel each, with the shaft, its discs, magnets, sensors and touchdown bearings.

    Lines are the displacement in the plane in which the whirl is widest, and, dotted, across it; the largest displacement is 1.  Whirls are
    from :func:`carom.rotors.find_whirls`.
    """
    rows = -(-len(whirls) // _COLUMNS)
    figure = StyledFigure(figsize=(TWO_COLUMNS, (0.12 + _ROW * rows) * TWO_COLUMNS))
    panels = figure.subplots(rows, _COLUMNS, sharex=True, sharey=True, squeeze=False).ravel()
    places = _MILLIMETRES * flexible.rotor.places
    for axes, whirl in zip(panels, whirls, strict=False):
        _shape(axes, places, whirl)
        _parts(axes, flexible)
        _shaft(axes, flexible.rotor)
        axes.set(xlim=(places[0], places[-1]), ylim=(-_REACH, _REACH), yticks=[-1.0, 0.0, 1.0])
    for axes in panels[len(whirls) :]:
        axes.remove()
    for axes in panels[max(len(whirls) - _COLUMNS, 0) : len(whirls)]:
        axes.tick_params(labelbottom=True)
        axes.set_xlabel("place along the shaft (mm)")
    for axes in panels[::_COLUMNS]:
        axes.set_ylabel("displacement")
    return key(figure, panels[: len(whirls)], columns=4)


def _shape(axes: Axes, places: Floats, whirl: WhirlMode) -> None:
    # The square of a rotating number tells the plane in which the shape is widest, whatever its sign.
    turned = whirl.widest * cmath.exp(-0.5j * cmath.phase(complex((whirl.widest**2).sum())))
    turned *= 1.0 if turned.real[np.abs(turned.real).argmax()] > 0.0 else -1.0
    look = LOOKS["backward" if whirl.sense == "backward" else "forward"]
    axes.axhline(0.0, color="#a6a6a6", lw=0.6)
    axes.plot(places, turned.real, color=look.colour, lw=1.4, label=f"{whirl.sense} whirl", gid="along")
    if np.abs(turned.imag).max() > _ROUND:
        axes.plot(places, turned.imag, color=look.colour, lw=1.0, ls=":", label=f"{whirl.sense}, across", gid="across")
    title = f"{number(whirl.frequency, 4)} Hz, {whirl.sense}, damping ratio {number(whirl.damping_ratio, 2)}"
    axes.set_title(title, fontsize="small")


def _shaft(axes: Axes, rotor: Any) -> None:
    """Draw the sections of the shaft and the places of its discs, of a rotor that is known by these."""
    sections = getattr(rotor, "sections", ())
    ends = _MILLIMETRES * np.cumsum([0.0, *(section.length for section in sections)])
    widest = max((section.outer_diameter for section in sections), default=1.0)
    for begin, end, section in zip(ends[:-1], ends[1:], sections, strict=True):
        half = _SHAFT * section.outer_diameter / widest
        axes.fill_between([begin, end], -half, half, fc="#e4e7ea", ec="#a6a6a6", lw=0.4, zorder=0, gid="shaft")
    discs, along = getattr(rotor, "discs", ()), _MILLIMETRES * rotor.node_places
    for disc in discs:
        axes.plot([along[disc.node]] * 2, [-_DISC, _DISC], **_PLATE, label="disc", gid="disc")


def _parts(axes: Axes, machine: FlexibleMachine) -> None:
    """Mark where bearings and sensors are, below the shape."""
    nodes = {
        "magnet": [bearing.node for bearing in machine.bearings],
        "sensor": [node for bearing in machine.bearings for node in bearing.sensor_nodes],
        "touchdown": [plane.node for plane in machine.touchdowns],
    }
    along = _MILLIMETRES * machine.rotor.node_places
    for name, look in _PARTS:
        at = along[nodes[name]]
        if len(at):
            drawn = look.mark(8.0 if name == "touchdown" else 4.5, filled=name != "sensor")
            axes.plot(at, np.full(len(at), _MARKED), **drawn, label=look.words, gid=name, clip_on=False)
