"""Results as plain dictionaries of texts, numbers and arrays, for the browser."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from carom.basins import Share
from carom.basins.shares import percent
from carom.basins.sizes import contact_free_size
from carom.explorer.computing.controls import Control
from carom.explorer.computing.kicks import KickMap
from carom.explorer.computing.planes import DisturbancePlane
from carom.models import Rotor
from carom.parameters import Scales
from carom.parameters.fields import RPM
from carom.parameters.formats import format_quantity, number, shown_in
from carom.plots.style import LOOKS
from carom.rotors.synchronous import SynchronousResponse

Message = dict[str, Any]
FEW = 12
"""Cells up to what must be survived below which the sentence tells of the whole picture."""
LITTLE = 0.4
"""Share of the clearance up to which the figure of the response leaves the clearance out."""
MANY = 1e8
"""Size of numbers from which boxes have them with an exponent; ``controls.js`` does the same."""


def control_message(control: Control) -> Message:
    """A control, as the page builds its slider from it."""
    return {**asdict(control), "shown": _typed(control.value)}


def _typed(value: float) -> str:
    """A number as one types it."""
    if abs(value) < MANY:
        return number(value, 5).replace(",", "")
    digits, exponent = f"{value:.5g}".split("e")
    return f"{digits}e{int(exponent)}"


def plane_message(plane: DisturbancePlane, scales: Scales | None) -> Message:
    """A kind of disturbances, as the page offers it."""
    lasting = (
        f" of {format_quantity(plane.duration / (scales.time if scales else 1.0), 'time', scales)}"
        if plane.duration
        else ""
    )
    return {"name": plane.name, "words": f"{plane.nouns[1]}{lasting}"}


def units_message(scales: Scales | None) -> Message:
    """Factors and units of times, speeds and impulses on the page."""
    message: Message = {}
    for name, kind in (("time", "time"), ("speed", "velocity"), ("impulse", "impulse")):
        message[name], message[f"{name}_unit"] = shown_in(kind, scales)
    return message


WAITS = "stated when the picture is fine"
"""What a coarse picture says of the smallest that is lost."""


def basin_message(found: KickMap, rotor: Rotor, coarse: bool = False) -> Message:
    """The picture of a basin, its legend, and what is read off it; sizes in the unit that people see."""
    plane, scales = found.plane, rotor.scales
    factor, unit = plane.shown(scales)
    lost, (share, words) = None if coarse else found.smallest_lost, judged_share(found, rotor)
    required = None if plane.required is None else plane.own(plane.required, scales)
    contact_free = contact_free_size(rotor, plane.by_size(rotor, found.largest)) if found.rest.levitates else 0.0
    return {
        "kind": plane.name,
        "coarse": coarse,
        "nouns": list(plane.nouns),
        "axes": list(plane.axes),
        "cells": found.cells,
        "size": len(found.cells),
        "largest": factor * found.largest,
        "unit": unit,
        "required": 0.0 if required is None else factor * required,
        "rest": found.rest.words,
        "levitates": found.rest.levitates,
        "endings": found.endings,
        "share": shown_share(share, coarse),
        "share_remark": f"of {words}, by area: {share.count:,} of {share.total:,} cells of {'a coarse' if coarse else 'this'} picture",
        "sentence": sentence(share, words, coarse)
        if found.rest.levitates
        else f"It cannot levitate with these values. The kicks disturb {found.rest.words}.",
        "contact_free": contact_free / found.largest,
        "lost_size": 0.0 if lost is None else factor * lost,
        "lost": "–" if coarse else "none" if lost is None else format_quantity(lost, plane.scale, scales),
        "lost_remark": WAITS if coarse else f"of {found.share.total:,} {plane.nouns[1]} tried; a finer search follows",
        "rest_position": [found.rest.place.real, found.rest.place.imag],
        "outward": [found.rest.outward.real, found.rest.outward.imag] if plane.name == "kick" else [1.0, 0.0],
        "legend_rest": LOOKS["contact-free"].colour if found.rest.levitates else LOOKS["rub"].colour,
    }


def judged_share(found: KickMap, rotor: Rotor) -> tuple[Share, str]:
    """Recovery rate within the required range (or within the plotted range, if smaller), and what it is a share of."""
    required = None if found.plane.required is None else found.plane.own(found.plane.required, rotor.scales)
    if required is not None and required <= found.largest * (1.0 + 1e-9):
        # A little above, for rounding where the picture ends with it.
        share = found.share_up_to(required * (1.0 + 1e-9))
        if share.total >= FEW:
            return share, found.plane.words_up_to(required, rotor.scales)
    return found.share, found.plane.words_up_to(found.largest, rotor.scales)


def sentence(share: Share, words: str, coarse: bool) -> str:
    """What comes back of those that were tried; a coarse picture says nothing of all or none."""
    tried = f"of {share.total:,} {words} that were tried"
    if coarse:
        return f"Coarse so far: {share.count:,} {tried} came back to levitation."
    if share.count in (0, share.total):
        whole = "All" if share.count else "None"
        return f"{whole} {tried} {'come' if share.count else 'comes'} back to levitation."
    return f"{percent(share.fraction)} {tried} come back to levitation."


def shown_share(share: Share, coarse: bool) -> str:
    """A share as a large number: one of a coarse picture that is nothing or all is no per cent."""
    if coarse and share.count in (0, share.total):
        return f"{share.count:,} of {share.total:,}"
    return percent(share.fraction)


def response_message(found: SynchronousResponse, words: dict[str, tuple[str, ...]], rotor: Rotor) -> Message:
    """Amplitudes 0-to-peak in µm over speeds in rpm, and what is said of them."""
    walls = sorted({1e6 * each for each in found.clearances.tolist()})
    most = 1e6 * float(found.touchdowns.major.max())
    # With the clearances, unless the whirl is much smaller.
    top = 1.15 * most or 1.0 if most < LITTLE * walls[0] else 1.1 * max(walls[-1], min(most, 1.6 * walls[-1]))
    return {
        "speeds": (found.speeds / RPM).tolist(),
        "touchdowns": (1e6 * found.touchdowns.major.T).tolist(),
        "sensors": (1e6 * found.sensors.major.T).tolist(),
        "walls": walls,
        "speed": rotor.scales.speed / RPM if rotor.scales else 0.0,
        "top": top,
        "stated": words,
    }
