"""How a rotor levitates over the speed: its response to the unbalance, and of a flexible one the free whirls, their shapes and the sensitivity of its loops."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS
from carom.parameters.fields import RPM
from carom.plots.figure import TWO_COLUMNS, StyledFigure
from carom.plots.plane import Floats, key, one_axes, shade_zones, with_neighbours
from carom.plots.style import LOOKS, ZONE_SHADES, Drawn, Look, styled
from carom.plots.words import number

if TYPE_CHECKING:
    import carom.rotors
    from carom.rotors import Campbell, FlexibleMachine, Sensitivity, WhirlMode
    from carom.rotors.free_rotor import FreeRotor

    UnbalanceResponse = Any
    """That of :mod:`carom.studies`, which lies above: arguments are compared with its name."""

NO_LEVITATION = f"no {STEADY_WORDS['contact-free']}"
_FREE = replace(LOOKS["contact-free"], line="-", width=1.7)
_VIRTUAL = Look("#4d4d4d", "virtual: beyond the clearance", line=":", width=1.4)
_RUB = replace(LOOKS["rub"], words=f"{STEADY_WORDS['rub']}, stable", line="-", width=3.0)
_SADDLE = Look("#5c1f47", f"{STEADY_WORDS['rub']}, unstable", line="--", width=1.1)
_LIMIT = Look("#cc79a7", "API 617 limit", line="-.", width=1.1)
PRESENT = Look("#1a1a1a", "present speed", line=(0.0, (4.0, 2.0)), width=0.9)
LIMIT = Look("#cc79a7", "limit of speed", line="-", width=1.1)
CRITICAL = Look("#0072b2", "critical speed", line=(0.0, (1.0, 1.5)), width=1.1)
_HALF = Look("#0072b2", "0.707 of the peak, for the amplification factor", line="-", width=1.0)
_HIGHEST = 1.3
"""Largest amplitude shown, in clearances: what lies beyond is virtual."""
_BEARINGS = (
    _FREE,
    replace(_FREE, colour="#00392a", line="--", width=1.0),
    replace(_FREE, colour="#7fd3b8", line="-.", width=2.2),
    replace(_FREE, colour="#005f46", line=":", width=1.2),
)
"""Looks of the whirl at several touchdown bearings: of equal curves the later ones lie upon the earlier, which stay visible."""
_LOWEST = 0.05
"""Least top of the panel, in clearances."""


@checked
@styled
def unbalance_response(response: UnbalanceResponse) -> Figure:
    """Draw amplitude and phase over the speed of the shaft in two panels.

    Upper: vibration in µm peak to peak, with the zones of ISO 14839-2 as bands, the wall, and the API 617 limit; counted
    with the sag, on the right as radius in mm.  Where the contact-free response is virtual it is dotted, and these speeds are hatched.
    Rubs lie on the wall, an unstable one dashed upon the stable one.  Lower: the angle by which the rotor lags its
    unbalance.  The present and the critical speed are marked in both.
    """
    figure = StyledFigure(figsize=(TWO_COLUMNS, 0.78 * TWO_COLUMNS))
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.7, 1.0))
    speeds, width = response.speeds / RPM, 2e6 * float(response.whirl.clearances.min())
    _amplitudes(upper, response, speeds, width)
    _phases(lower, response, speeds)
    for axes in (upper, lower):
        _marks(axes, response)
        axes.set_xlim(response.interval[0] / RPM, response.interval[1] / RPM)
    lower.set_xlabel("speed of the shaft (rpm)")
    figure.align_ylabels([upper, lower])
    return key(figure, (upper, lower), columns=3, title=_title(response))


def _title(response: UnbalanceResponse) -> str:
    """Write the vibration at the present speed with its zone."""
    width = 2e6 * float(response.now.touchdowns.major[0, response.worst])
    sag = 1e6 * float(response.now.sags[response.worst])
    zone = f"zone {response.zone_at(response.present)}{f' including {number(sag, 3)} µm of static sag' if sag else ''}"
    found = f"{number(width, 4)} µm peak to peak, {zone}" if response.now.reach.max() <= 1.0 else NO_LEVITATION
    return f"at {response.present / RPM:,.0f} rpm: {found}"


def _amplitudes(axes: Axes, response: UnbalanceResponse, speeds: Floats, width: float) -> None:
    inside = response.reach <= 1.0
    top = _top(response)
    # Zones count sag and whirl, and the sag leaves so much less of each.
    sag = float((response.whirl.sags / response.whirl.clearances).max())
    limits = np.maximum(np.array([0.0, *response.case.zones.limits, 1.0]) - sag, 0.0)
    for low, high, shade, letter in zip(limits[:-1], limits[1:], ZONE_SHADES, response.case.zones.labels, strict=True):
        axes.axhspan(width * low, width * high, color=shade, lw=0.0, zorder=0)
        if low < 0.95 * top and high > low:
            corner = 0.008, width * min(high, top)  # at low speed, where the whirl is small
            below: Drawn = {"xytext": (0.0, -2.0), "textcoords": "offset points", "va": "top", "zorder": 4}
            axes.annotate(f"zone {letter}", corner, xycoords=axes.get_yaxis_transform(), **below)
            axes.axhline(width * low, color="#808080", lw=0.3, zorder=0)
    for place, sizes in enumerate(2e6 * response.whirl.touchdowns.major.T):
        line = _BEARINGS[place % len(_BEARINGS)].stroke
        words = _FREE.words if response.whirl.clearances.size == 1 else f"{_FREE.words}, bearing {place + 1}"
        axes.plot(speeds, np.where(inside, sizes, np.nan), **line, label=words, zorder=3)
        if not inside.all():
            there = np.where(with_neighbours(~inside), sizes, np.nan)
            axes.plot(speeds, there, **_VIRTUAL.stroke, label=None if place else _VIRTUAL.words, zorder=2)
    wall = LOOKS["wall"]
    if top > 1.0:
        axes.axhline(width * limits[-1], **wall.stroke, label="wall (touchdown bearing)", zorder=2)
        for look, radii in zip((_RUB, _SADDLE), response.rubs.radii if response.rubs else (), strict=False):
            if not np.isnan(radii).all():
                along = response.rubs.speeds / RPM if response.rubs else speeds
                axes.plot(along, width * radii, **look.stroke, label=look.words, zorder=2.5)
    limit = 1e6 * response.allowed_si
    axes.plot(speeds, limit, **_LIMIT.stroke, label=_LIMIT.words, zorder=2)
    _half_power(axes, response, width, top)
    axes.set(ylim=(0.0, width * top), ylabel="vibration (µm peak to peak)")
    if response.now.reach.max() <= 1.0 and response.interval[0] <= response.present <= response.interval[1]:
        dot: Drawn = {"marker": "o", "ms": 4.5, "color": _FREE.colour, "mec": "#1a1a1a", "mew": 0.8}
        for size in response.now.touchdowns.major[0].tolist():
            axes.plot(response.present / RPM, 2e6 * size, **dot, zorder=5)
    right = axes.secondary_yaxis(
        "right", functions=(lambda width: 0.5e-3 * np.asarray(width), lambda radius: 2e3 * np.asarray(radius))
    )
    right.set_ylabel("radius (mm)")


def _top(response: UnbalanceResponse) -> float:
    """Largest amplitude shown, in the smallest clearance."""
    least, rubs = float(response.whirl.clearances.min()), response.rubs
    highest = max(float(response.allowed_si.max()), float(response.peak_to_peak_si.max())) / (2.0 * least)
    needed = max(1.15 * highest, _LOWEST)
    touches = float(response.reach.max()) > 0.8 or (rubs is not None and not np.isnan(rubs.radii).all())
    return min(max(needed, 1.1), _HIGHEST) if touches else min(needed, 1.1)


def _half_power(axes: Axes, response: UnbalanceResponse, width: float, top: float) -> None:
    """Mark the widths of peaks at touchdown bearings, where they are on the page."""
    label: str | None = _HALF.words
    for each in () if response.whirl.sensors.forward.shape[1] else response.criticals:
        height = math.sqrt(2.0) * 1e6 * each.amplitude
        if each.half_power is not None and height < width * top:
            ends = [end / RPM for end in each.half_power]
            axes.plot(ends, [height] * 2, **_HALF.stroke, marker="|", ms=5.0, label=label, zorder=4)
            label = None


def _phases(axes: Axes, response: UnbalanceResponse, speeds: Floats) -> None:
    inside, rubs = response.reach <= 1.0, response.rubs
    lags = np.degrees(response.lags)
    lowest = 90.0 * math.floor(lags.min() / 90.0 + 0.01)
    highest = max(180.0, 90.0 * math.ceil(lags.max() / 90.0 - 0.01))
    for place, lag in enumerate(lags.T):
        line = _BEARINGS[place % len(_BEARINGS)].stroke
        axes.plot(speeds, np.where(inside, lag, np.nan), **line, zorder=3)
        axes.plot(speeds, np.where(with_neighbours(~inside), lag, np.nan), **_VIRTUAL.stroke, zorder=2)
    for look, rub in zip((_RUB, _SADDLE), np.degrees(rubs.lags) if rubs else (), strict=False):
        axes.plot(rubs.speeds / RPM if rubs else speeds, rub, **look.stroke, zorder=2)
        highest = max(highest, 270.0 if np.nanmax(np.append(rub, 0.0)) > 180.0 else 180.0)
    axes.set_ylim(lowest, highest)
    axes.set_yticks(np.arange(lowest, highest + 1.0, 90.0 if highest - lowest > 180.0 else 45.0))
    axes.set_ylabel("phase lag behind\nthe unbalance (degrees)")


def _marks(axes: Axes, response: UnbalanceResponse) -> None:
    """Mark the present and the critical speed, and where no levitation is possible."""
    words = f"{NO_LEVITATION} possible"
    for stretch in response.stretches:
        if not stretch.what.contact_free:
            hatched: Drawn = {"fc": "none", "ec": "#d6d6d6", "hatch": "////", "lw": 0.0}
            axes.axvspan(stretch.low / RPM, stretch.high / RPM, **hatched, label=words, zorder=0.5)
    rates = list(dict.fromkeys(f"{each.speed / RPM:,.0f}" for each in response.criticals))
    critical = f"critical speed{'s' if len(rates) > 1 else ''}, {', '.join(rates)} rpm"
    marked: list[tuple[Look, str | None, float]] = [
        (PRESENT, f"{PRESENT.words}, {response.present / RPM:,.0f} rpm", response.present)
    ]
    marked += [(CRITICAL, None if place else critical, each.speed) for place, each in enumerate(response.criticals)]
    for look, label, speed in marked:
        if response.interval[0] <= speed <= response.interval[1]:
            axes.axvline(speed / RPM, **look.stroke, label=label, zorder=1)


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
    goes backward.  Where it grows the triangles are hollow, and at a limit of speed levitation begins or ceases to be stable.  Dotted lines are where forward whirls meet the line on which unbalance excites them: undamped, these would be the critical speeds.
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
                words = f"{name} whirl{' (unstable)' if grows else ''}"
                look = LOOKS[name].mark(4.0, filled=not grows) | {"color": LOOKS[name].colour, "ls": line}
                look |= {"markevery": max(1, len(speeds) // MARKS), "label": words, "gid": words}
                upper.plot(speeds, np.where(those, np.abs(branch.imag) / _HERTZ, np.nan), **look)
                lower.plot(speeds, np.where(those, damping, np.nan), **look)
        criticals += _crossings(speeds, branch.imag / RPM - speeds)
    rates = ", ".join(f"{each:,.0f}" for each in sorted(criticals))
    for axes in (upper, lower):
        for each in criticals:
            axes.axvline(each, **CRITICAL.stroke, label=f"critical speeds of forward whirl: {rates} rpm")
        for limit in found.limits:
            axes.axvline(limit.speed / RPM, **LIMIT.stroke, label=f"limit of speed, {limit.speed / RPM:,.0f} rpm")
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
        figure.suptitle("The loop is unstable: ISO 14839-3 zones do not apply")
    top = max(_ROOM * float(found.peaks.max()), _ROOM * LIMITS["C"])
    shade_zones(axes, [0.0, *LIMITS.values(), top], "ABCD" if found.stable else "")
    for bearing, (peak, frequency) in enumerate(zip(found.peaks, found.peak_frequencies, strict=True)):
        words = f"bearing {bearing + 1}: {number(float(peak), 3)} at {number(float(frequency) / _HERTZ, 3)} Hz"
        look = LOOKS["unstable" if bearing % 2 else "stable"]
        line: Drawn = {"ls": _LINES[bearing % len(_LINES)], "label": words, "gid": f"bearing-{bearing}"}
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
_PLATE: Drawn = {"color": "#8c959f", "lw": 3.5, "solid_capstyle": "butt", "zorder": 0.5}
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
        axes.set_xlabel("position along the shaft (mm)")
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


def _shaft(axes: Axes, rotor: FreeRotor) -> None:
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
