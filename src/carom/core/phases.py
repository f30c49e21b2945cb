"""States of contact of a station, as integers for kernels."""

from __future__ import annotations

from carom.base.outcome import Phase
from carom.core.compiling.decorators import inlined
from carom.core.friction import BACKWARD, FORWARD, STOPPED

FLIGHT, FORWARD_SLIP, BACKWARD_SLIP, ROLLING, SEPARATED = (
    int(Phase.FLIGHT),
    int(Phase.FORWARD_SLIP),
    int(Phase.BACKWARD_SLIP),
    int(Phase.ROLLING),
    int(Phase.SEPARATED),
)
AWAY = -1
"""State of contact of a station that is not on its wall; on the wall it is a :class:`~carom.base.outcome.Phase`."""


@inlined
def lasts(phase):
    """Whether a station is in lasting contact."""
    return phase in (FORWARD_SLIP, BACKWARD_SLIP, ROLLING)


@inlined
def stays(phase):
    """Whether a station stays at its wall: in lasting contact, or separated from a wall that has not yet come back."""
    return lasts(phase) or phase == SEPARATED


@inlined
def sense_of_phase(phase):
    """Sense of the slip in lasting contact."""
    if phase == ROLLING:
        return STOPPED
    return FORWARD if phase == FORWARD_SLIP else BACKWARD


@inlined
def phase_of_slip(sense):
    """Phase of lasting contact with this sense of the slip."""
    if sense == STOPPED:
        return ROLLING
    return FORWARD_SLIP if sense == FORWARD else BACKWARD_SLIP
