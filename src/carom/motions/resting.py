"""How a rotor that weighs something stays on its touchdown bearing: it goes round, or lies there, seen from the fixed frame.

Weight that turns in the frame of the rotor keeps whirl from repeating itself, and changes it less from turn to turn than what
:mod:`carom.core.settling` takes for a change that lasts.  So it counts as whirl that goes on after as many turns, whatever it changes.

In the frame that turns with the shaft a rotor that lies at the bottom of the wall goes round it once per turn, backward: a turn
that repeats is found there as whirl.  Without damping it does not come to rest but rocks about the place where it leans, for on a
slipping contact friction does not change its sense; such turns never repeat.
"""

from __future__ import annotations

import math

import numpy as np

from carom.base.outcome import Outcome, Phase
from carom.core.advance import advance
from carom.core.event_log import EventLog
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import lasts
from carom.core.settling import BLOCK, NO_TURN, TURNS, memory
from carom.models import Rotor

STEADY = 1e-3
"""Relative change of the means of a block of turns, from one block to the next, below which backward whirl is steady."""
FOLLOWED_TURNS = 64
"""Turns of the shaft over which the place of the contact is watched: whirl of 1/128 of the shaft speed goes half round the wall."""
LOGGED, MOST_LOGS = 2048, 128
"""Steps of lasting contact that are looked at together, and how often: of a rigid rotor a turn takes about eight, of one that bends hundreds."""


def goes_round(rotor: Rotor, amplitudes: np.ndarray, contact: np.ndarray, recollection: np.record) -> Outcome | None:
    """Whirl of a rotor that weighs something that has lasted for 1,024 turns along the wall, or of the shaft; else ``None``.

    Contact that has not gone round once in the frame of the shaft in so many of its turns keeps in step with it.  Where the shaft loses
    its speed, none of this has lasted.
    """
    if rotor.system.shaft is not None:
        return None
    in_step = recollection.turning != NO_TURN and recollection.turn_time >= 2 * TURNS * 2.0 * math.pi
    lasts_on = recollection.turns >= 2 * TURNS or _steady(recollection)
    if not (in_step or lasts_on) or (rotor.weight is None and not rotor.system.is_time_dependent):
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


def _steady(recollection: np.record) -> bool:
    """Whether whirl that is backward in the fixed frame goes on as it is: over three blocks of turns, by their duration and radii."""
    if recollection.turns < 3 * BLOCK:
        return False
    blocks = recollection.blocks
    steady = np.abs(np.diff(blocks, axis=0)) <= STEADY * blocks[1:]
    return bool(blocks[-1, 0] < 2.0 * math.pi and steady.all())


def lies(rotor: Rotor, amplitudes: np.ndarray, contact: np.ndarray, recollection: np.record) -> bool:
    """Whether every contact that lasts goes on, within half the wall, for 64 turns of the shaft.

    Parameters
    ----------
    amplitudes : ndarray of complex, shape (N,)
    contact : ndarray of int, shape (P,)
        State of contact at each plane.
    recollection : record of :func:`carom.core.settling.memory`
    """
    touching = np.array([lasts(int(each)) for each in contact])
    if rotor.weight is None or not touching.any():
        return False
    (arrays, table), (planes, modes) = rotor.system.own_records(), rotor.system.arrays["rows"].shape
    limits, state, contact = rotor.system.limits, amplitudes.copy(), contact.copy()
    log, own = EventLog.empty(LOGGED, modes, planes, limits), memory(modes, limits=limits)
    own.clock, own.limited[:] = recollection.clock, recollection.limited
    tools = own, workspace(modes), rub_workspace(modes, planes, limits)
    passed, until = 0.0, 2.0 * math.pi * FOLLOWED_TURNS
    reached = np.zeros((0, np.count_nonzero(touching)))
    for _ in range(MOST_LOGS):
        outcome, time, count = advance(arrays, table, state, until - passed, contact, log, *tools)
        seen = log.first(count)
        if (seen.phases[:, touching] == Phase.FLIGHT).any():
            return False
        places = seen.after @ arrays["rows"][touching].T + arrays["offsets"][touching]
        angles = np.angle(places * np.exp(1j * (passed + seen.times))[:, None])
        turned = np.unwrap(np.concatenate([reached, angles]), axis=0)
        passed += time
        if len(turned):
            # Of the past the extremes are enough, and where it has come to.
            reached = np.stack([turned.min(axis=0), turned.max(axis=0), turned[-1]])
            if (np.ptp(reached, axis=0) >= math.pi).any():
                return False
        if outcome != Outcome.EVENT_LIMIT:
            return outcome == Outcome.TIME_REACHED
    return False
