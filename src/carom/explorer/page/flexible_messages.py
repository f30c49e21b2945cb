"""What is found of a flexible machine as plain dictionaries of texts, numbers and arrays, for the browser."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from carom.explorer.computing.flexible_kicks import KickPicture
from carom.explorer.computing.flexible_levitation import Levitating
from carom.explorer.computing.flexible_motion import AtPlane, FlexibleMotion
from carom.explorer.page.messages import WAITS, sentence, shown_share, units_message
from carom.models import Rotor
from carom.outcome import STEADY_WORDS
from carom.parameters.fields import RPM
from carom.parameters.told import shown_in, told
from carom.plots.style import LOOKS
from carom.results import fields_of

Message = dict[str, Any]
MICRON = 1e-6
LITTLE = 0.4
"""Share of the clearance up to which the figure of the response leaves the clearance out."""
FEW = 5
"""Kicks up to what must be survived below which the sentence tells of the whole picture."""


def levitation_message(found: Levitating, speed: float) -> Message:
    """How the machine levitates; speeds in rpm, radii in µm."""
    own = fields_of(
        found, "lead", "more", "stable", "holds", "damping", "damping_remark", "clearance", "clearance_remark"
    )
    radii = [each.radii / MICRON for each in found.curves]
    most = max((float(each.max()) for each in radii), default=0.0)
    return {
        **own,
        "whirls": [asdict(each) for each in found.whirls],
        "orbits": [asdict(each) for each in found.orbits],
        "speeds": (found.speeds / RPM).tolist(),
        "curves": [
            {"place": each.place, "radii": values.tolist(), "dashed": each.dashed}
            for each, values in zip(found.curves, radii, strict=True)
        ],
        "walls": [each / MICRON for each in found.walls],
        "speed": speed / RPM,
        "top": _top(most, [each / MICRON for each in found.walls]),
    }


def _top(most: float, walls: list[float]) -> float:
    """End of the axis of the response: with the clearances, unless the whirl is much smaller."""
    if most < LITTLE * min(walls):
        return 1.15 * most or 1.0
    return 1.1 * max(*walls, min(most, 1.6 * max(walls)))


def picture_message(found: KickPicture, rotor: Rotor, required: float, begun: float) -> Message:
    """The picture of kicks as far as it is filled in; `required` is in units of the equations, `begun` is the first range in the unit that people are told."""
    factor, unit = shown_in("velocity", rotor.scales)
    cells, endings = found.cells
    coarse = not found.whole
    lost, whole = None if coarse else found.smallest_lost, found.share_up_to(np.inf)
    judged, share = required, found.share_up_to(required * (1.0 + 1e-9))
    if required > found.largest * (1.0 + 1e-9) or share.total < FEW:
        judged, share = found.largest, whole
    so_far = " so far" if coarse else ""
    words = f"kicks up to {told(judged, 'velocity', rotor.scales)}"
    return {
        "kind": "kick",
        "coarse": coarse,
        "nouns": ["kick", "kicks"],
        "axes": ["kick to the right", "kick upward"],
        "cells": cells,
        "size": len(cells),
        "largest": factor * found.largest,
        "unit": unit,
        "required": factor * required,
        "rest": STEADY_WORDS["contact-free"],
        "levitates": True,
        "endings": [asdict(ending) for ending in endings],
        "share": shown_share(found.share, coarse) if whole.total else "–",
        "share_remark": f"by area, of kicks up to {told(found.largest, 'velocity', rotor.scales)}: {whole.total:,} followed{so_far}",
        "sentence": sentence(share, words, coarse) if share.total else f"Following {words} …",
        "harmless": 0.0,
        "lost_size": 0.0 if lost is None else factor * lost,
        "lost": "–" if coarse else "none" if lost is None else told(lost, "velocity", rotor.scales),
        "lost_remark": WAITS if coarse else f"of {whole.total:,} kicks followed; smaller ones may be lost too",
        "rest_position": [0.0, 0.0],
        "outward": [1.0, 0.0],
        "legend_rest": LOOKS["contact-free"].colour,
        "opening": begun,
    }


def flexible_motion_message(motion: FlexibleMotion, rotor: Rotor) -> Message:
    """A motion at each plane, with the factors of the axes; forces in N, times in ms."""
    return {
        **fields_of(motion, "times", "whole", "outcome", "colour", "words"),
        "planes": [_plane(each, plane, rotor) for plane, each in enumerate(motion.planes)],
        **units_message(rotor.scales),
    }


def _plane(found: AtPlane, plane: int, rotor: Rotor) -> Message:
    force, unit = shown_in("force", rotor.system.scales_at(plane, rotor.scales))
    return {
        **vars(found),
        "force": found.force * np.float32(force),
        "force_unit": unit,
        "forward": found.forward.astype("uint8"),
        "spans": [asdict(span) for span in found.spans],
    }
