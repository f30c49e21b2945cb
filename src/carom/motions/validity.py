"""How far the model of a rotor in its touchdown bearings holds: the one place that decides from where on a motion is no longer followed.

A wall that gives way is a spring however deep the rotor is in it, and a magnet is linear however near the rotor comes.  Neither holds far
beyond the clearance.  The air gap of a magnet usually is twice the clearance of its touchdown bearing, so a rotor as deep as one clearance
strikes the magnet; of a rotor wider than ten clearances that is less than a tenth of its radius, which is the arm of the friction.
"""

from __future__ import annotations

import numpy as np

from carom.core.event_log import EventLog
from carom.models import System

MOST_DEPTH = 1.0
"""Depth in a touchdown bearing, in its clearances, up to which the model holds."""


def first_beyond(system: System, log: EventLog) -> int | None:
    """The first event of a motion at which a plane is deeper in its wall than the model holds; ``None`` if none is.

    Contact has some steps each, so that this is seen within a step.
    """
    found = []
    for plane, contact in enumerate(system.contacts):
        if contact.wall.stiffness > 0.0:
            place, _ = system.at_plane(log.before, plane)
            found += np.flatnonzero(np.abs(place) > 1.0 + MOST_DEPTH)[:1].tolist()
    return min(found, default=None)
