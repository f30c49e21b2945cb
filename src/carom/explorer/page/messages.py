"""Results as plain dictionaries of texts, numbers and arrays, for the browser."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from carom.basins.shares import percent
from carom.closed_forms import harmless_kick
from carom.explorer.computing.controls import Control
from carom.explorer.computing.diagrams import Picture
from carom.explorer.computing.kicked_motion import KickedMotion
from carom.explorer.computing.kicks import KickMap
from carom.explorer.computing.motions import MotionTable
from carom.models import Jeffcott
from carom.parameters import Scales
from carom.parameters.told import number, shown_in
from carom.plots.style import LOOKS
from carom.studies import Verdict, Wording

Message = dict[str, Any]


def control_message(control: Control) -> Message:
    """A control, as the page builds its slider from it."""
    return {**asdict(control), "shown": number(control.value, 5).replace(",", "")}


def units_message(scales: Scales | None) -> Message:
    """Factors and units of times, speeds and impulses on the page."""
    message: Message = {}
    for name, kind in (("time", "time"), ("speed", "velocity"), ("impulse", "impulse")):
        message[name], message[f"{name}_unit"] = shown_in(kind, scales)
    return message


def basin_message(found: KickMap, rotor: Jeffcott) -> Message:
    """The picture of a basin, its legend, and what is read off it."""
    say, share = Wording(rotor.scales), found.share
    units = units_message(rotor.scales)
    lost = found.smallest_lost
    return {
        "cells": found.cells,
        "size": len(found.cells),
        "largest": units["speed"] * found.fastest,
        "unit": units["speed_unit"],
        "rest": found.rest.words,
        "levitates": found.rest.levitates,
        "endings": [asdict(ending) for ending in found.endings],
        "share": percent(share.fraction),
        "share_remark": f"of {share.population.words}, by area: {share.count:,} of {share.total:,} cells of this picture",
        "sentence": _sentence(found),
        "harmless": harmless_kick(rotor) / found.fastest if found.rest.levitates else 0.0,
        "lost": "none" if lost is None else say.velocity(lost),
        "lost_remark": "no kick of the picture is lost"
        if lost is None
        else "smallest of the picture; a finer search follows",
        "rest_position": [found.rest.position.real, found.rest.position.imag],
        "outward": [found.rest.outward.real, found.rest.outward.imag],
        "legend_rest": LOOKS["contact-free"].colour if found.rest.levitates else LOOKS["rub"].colour,
    }


def _sentence(found: KickMap) -> str:
    if not found.rest.levitates:
        return f"It cannot levitate with these values. The kicks disturb {found.rest.words}."
    if found.share.count in (0, found.share.total):
        return f"{'Every' if found.share.count else 'No'} kick of this picture comes back to levitation."
    return f"{percent(found.share.fraction)} of {found.share.population.words} come back to levitation."


def motion_message(motion: KickedMotion, rotor: Jeffcott) -> Message:
    """A motion, with the factors of its axes."""
    say = Wording(rotor.scales)
    return {
        **{name: getattr(motion, name) for name in ("times", "x", "y")},
        **{name: getattr(motion, name) for name in ("impact_times", "impact_angles", "impact_speeds", "impulses")},
        "forward": motion.forward.astype("uint8"),
        "spans": [asdict(span) for span in motion.spans],
        **{name: getattr(motion, name) for name in ("whole", "outcome", "colour", "words", "hardest")},
        "hardest_words": say.impulse(motion.hardest) if motion.hardest else "no impact",
        **units_message(rotor.scales),
    }


def table_message(table: MotionTable) -> Message:
    """Rows of the table, and the argument that they are all."""
    return {"rows": [asdict(row) for row in table.rows], "argument": table.argument}


def verdict_message(found: Verdict) -> Message:
    """The verdict in a sentence, and what is survived of each kind of disturbance."""
    return {"lead": found.lead, "survived": list(found.survived)}


def diagram_message(picture: Picture) -> Message:
    """Lines, bars and points of a diagram, by column."""
    return {
        "name": picture.control.name,
        "words": picture.control.words,
        "unit": picture.control.unit,
        "low": picture.control.low,
        "high": picture.control.high,
        "speed_unit": picture.speed_unit,
        "top": picture.top,
        "lines": [asdict(line) for line in picture.lines],
        "bars": [asdict(bar) for bar in picture.bars],
        "points": _columns([asdict(point) for point in picture.points]),
    }


def _columns(rows: Sequence[Message]) -> Message:
    names = ("x", "y", "words", "colour", "admissible")
    return {name: [row[name] for row in rows] for name in names}
