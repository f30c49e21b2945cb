"""Response to the unbalance over the speed of the shaft: amplitude and phase, with limits and contact."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS
from carom.parameters.fields import RPM
from carom.plots.figure import StyledFigure
from carom.plots.plane import Floats, key, with_neighbours
from carom.plots.style import LOOKS, TWO_COLUMNS, ZONE_SHADES, Look, styled
from carom.plots.words import number

NO_LEVITATION = f"no {STEADY_WORDS['contact-free']}"
_FREE = replace(LOOKS["contact-free"], line="-", width=1.7)
_VIRTUAL = Look("#4d4d4d", "virtual: beyond the clearance", line=":", width=1.4)
_RUB = replace(LOOKS["rub"], words=f"{STEADY_WORDS['rub']}, stable", line="-", width=3.0)
_SADDLE = Look("#5c1f47", f"{STEADY_WORDS['rub']}, unstable", line="--", width=1.1)
_LIMIT = Look("#d55e00", "limit of API 617", line="-.", width=1.1)
PRESENT = Look("#1a1a1a", "present speed", line=(0.0, (4.0, 2.0)), width=0.9)
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
def unbalance_response(response: Any) -> Figure:
    """Draw amplitude and phase over the speed of the shaft in two panels.

    Upper: vibration in µm peak to peak, with the zones of ISO 14839-2 as bands, the wall, and the limit of API 617; counted
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


def _title(response: Any) -> str:
    """Write the vibration at the present speed with its zone."""
    width = 2e6 * float(response.now.touchdowns.major[0, response.worst])
    sag = 1e6 * float(response.now.sags[response.worst])
    zone = f"zone {response.zone_at(response.present)}{f' with the sag of {number(sag, 3)} µm' if sag else ''}"
    found = f"{number(width, 4)} µm peak to peak, {zone}" if response.now.reach.max() <= 1.0 else NO_LEVITATION
    return f"at {response.present / RPM:,.0f} rpm: {found}"


def _amplitudes(axes: Axes, response: Any, speeds: Floats, width: float) -> None:
    inside = response.reach <= 1.0
    top = _top(response)
    # Zones count sag and whirl, and the sag leaves so much less of each.
    sag = float((response.whirl.sags / response.whirl.clearances).max())
    limits = np.maximum(np.array([0.0, *response.case.zones.limits, 1.0]) - sag, 0.0)
    for low, high, shade, letter in zip(limits[:-1], limits[1:], ZONE_SHADES, response.case.zones.labels, strict=True):
        axes.axhspan(width * low, width * high, color=shade, lw=0.0, zorder=0)
        if low < 0.95 * top and high > low:
            corner = 0.008, width * min(high, top)  # at low speed, where the whirl is small
            below: dict[str, Any] = {"xytext": (0.0, -2.0), "textcoords": "offset points", "va": "top", "zorder": 4}
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
        dot: dict[str, Any] = {"marker": "o", "ms": 4.5, "color": _FREE.colour, "mec": "#1a1a1a", "mew": 0.8}
        for size in response.now.touchdowns.major[0].tolist():
            axes.plot(response.present / RPM, 2e6 * size, **dot, zorder=5)
    right = axes.secondary_yaxis(
        "right", functions=(lambda width: 0.5e-3 * np.asarray(width), lambda radius: 2e3 * np.asarray(radius))
    )
    right.set_ylabel("radius (mm)")


def _top(response: Any) -> float:
    """Largest amplitude shown, in the smallest clearance."""
    least, rubs = float(response.whirl.clearances.min()), response.rubs
    highest = max(float(response.allowed_si.max()), float(response.peak_to_peak_si.max())) / (2.0 * least)
    needed = max(1.15 * highest, _LOWEST)
    touches = float(response.reach.max()) > 0.8 or (rubs is not None and not np.isnan(rubs.radii).all())
    return min(max(needed, 1.1), _HIGHEST) if touches else min(needed, 1.1)


def _half_power(axes: Axes, response: Any, width: float, top: float) -> None:
    """Mark the widths of peaks at touchdown bearings, where they are on the page."""
    label: str | None = _HALF.words
    for each in () if response.whirl.sensors.forward.shape[1] else response.criticals:
        height = math.sqrt(2.0) * 1e6 * each.amplitude
        if each.half_power is not None and height < width * top:
            ends = [end / RPM for end in each.half_power]
            axes.plot(ends, [height] * 2, **_HALF.stroke, marker="|", ms=5.0, label=label, zorder=4)
            label = None


def _phases(axes: Axes, response: Any, speeds: Floats) -> None:
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
    axes.set_ylabel("lag behind the\nunbalance (degrees)")


def _marks(axes: Axes, response: Any) -> None:
    """Mark the present and the critical speed, and where no levitation is possible."""
    words = f"{NO_LEVITATION} possible"
    for stretch in response.stretches:
        if not stretch.what.contact_free:
            hatched: dict[str, Any] = {"fc": "none", "ec": "#d6d6d6", "hatch": "////", "lw": 0.0}
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
