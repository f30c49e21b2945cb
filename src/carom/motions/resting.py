"""How a rotor that weighs something stays on its touchdown bearing: it goes round, or lies there, seen from the fixed frame.

Weight that turns in the frame of the rotor keeps whirl from repeating itself, and changes it less from turn to turn than what
:mod:`carom.core.fate` takes for a change that lasts.  So it counts as whirl that goes on after as many turns, whatever it changes.

In the frame that turns with the shaft a rotor that lies at the bottom of the wall goes round it once per turn, backward: a turn
that repeats is found there as whirl.  Without damping it does not come to rest but rocks about the place where it leans, for on a
slipping contact friction does not change its sense; such turns never repeat.
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.advance import advance
from carom.core.event_log import EventLog
from carom.core.fate import NO_TURN, TURNS, memory
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import lasts
from carom.models import Model
from carom.models.weight import weight_of
from carom.outcome import Outcome, Phase

FOLLOWED_TURNS = 64
"""Turns of the shaft over which the place of the contact is watched: whirl of 1/128 of the shaft speed goes half round the wall."""
LOGGED, MOST_LOGS = 8192, 32
"""Steps of lasting contact that are looked at together, and how often: of a rigid rotor a turn takes about eight, of one that bends hundreds."""


def goes_round(rotor: Model, amplitudes: np.ndarray, contact: np.ndarray, recollection: np.record) -> Outcome | None:
    """Whirl of a rotor that weighs something that has lasted for 1,024 turns along the wall, or of the shaft; else ``None``.

    Contact that has not gone round once in the frame of the shaft in so many of its turns keeps in step with it.  Where the shaft loses
    its speed, none of this has lasted.
    """
    if rotor.system.shaft is not None:
        return None
    in_step = recollection.turning != NO_TURN and recollection.turn_time >= 2 * TURNS * 2.0 * math.pi
    if not (in_step or recollection.turns >= 2 * TURNS) or (weight_of(rotor) is None and not rotor.system.limits):
        return None
    plane = next((place for place, each in enumerate(contact.tolist()) if lasts(each)), None)
    if plane is None:
        return None
    if in_step:
        return Outcome.FORWARD_RUB
    if contact[plane] == Phase.ROLLING and not recollection.turn_slipped:
        return Outcome.ROLLING
    position, velocity = rotor.system.at_plane(amplitudes, plane)
    backward = (position.conjugate() * velocity).imag < -1.0
    return Outcome.BACKWARD_WHIRL if backward else Outcome.FORWARD_RUB


def lies(rotor: Model, amplitudes: np.ndarray, contact: np.ndarray, recollection: np.record) -> bool:
    """Whether every contact that lasts goes on, within half the wall, for 64 turns of the shaft.

    Parameters
    ----------
    amplitudes : ndarray of complex, shape (N,)
    contact : ndarray of int, shape (P,)
        State of contact at each plane.
    recollection : record of :func:`carom.core.fate.memory`
    """
    touching = np.array([lasts(int(each)) for each in contact])
    if weight_of(rotor) is None or not touching.any():
        return False
    (arrays, table), (planes, modes) = rotor.system.own_records(), rotor.system.arrays["rows"].shape
    limits, state, contact = rotor.system.limits, amplitudes.copy(), contact.copy()
    log, own = EventLog.empty(LOGGED, modes, planes, limits), memory(modes, limits=limits)
    own.clock, own.limited[:] = recollection.clock, recollection.limited
    tools = own, workspace(modes), rub_workspace(modes, planes, limits)
    passed, angles, until = 0.0, [], 2.0 * math.pi * FOLLOWED_TURNS
    for _ in range(MOST_LOGS):
        outcome, time, count = advance(arrays, table, state, until - passed, contact, log, *tools)
        seen = log.first(count)
        if (seen.phases[:, touching] == Phase.FLIGHT).any():
            return False
        places = seen.after @ arrays["rows"][touching].T + arrays["offsets"][touching]
        angles.append(np.angle(places * np.exp(1j * (passed + seen.times))[:, None]))
        passed += time
        if outcome != Outcome.EVENT_LIMIT:
            turned = np.unwrap(np.concatenate(angles), axis=0)
            return outcome == Outcome.TIME_REACHED and bool((np.ptp(turned, axis=0) < math.pi).all())
    return False
