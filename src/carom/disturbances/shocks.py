"""Exact motion of a levitating rotor in a housing that is shaken, contacts included: by half-sine pulses, or as recorded.

The housing carries magnetic bearings and touchdown bearings.  With the coordinates ``Z`` of the rotor relative to it and the
translation ``t`` of the rotor as a whole, all masses feel its acceleration ``a(τ) = â sin(ντ) e^{iα}``, ``ν = π/T``,

    M Z̈ + (D − iG) Ż + K Z = F e^{iτ} − M t a(τ),

if moving as a whole bends no shaft and needs no gyroscopic moment (``G t = 0``).  Mounts of touchdown bearings are shaken too: ``t`` is the translation of
all that the housing carries.  So the accelerations of the coordinates
change by ``−t a``, and only that need be known.  In the co-rotating frame, with ``t â e^{iα}/2i`` from the two exponentials of a sine, these are two forces with exponents of
their own (:mod:`carom.models.forcing`),

    −t (â e^{iα}/2i) e^{s₁τ} + t (â e^{iα}/2i) e^{s₂τ},   s₁ = i(ν − 1),  s₂ = −i(ν + 1).

Of a record ``a`` is a constant and a ramp between two samples, a chain of two modes.  So the certified flight, the impacts and the lasting contact of
:mod:`carom.core` apply unchanged during each section, which is a stage of one motion; many motions of one rotor are followed through the sections side by side,
with the amplitudes of the forcing modes set where one begins.  At the end position and velocity are kept: the housing then moves at constant velocity.

Limit: the housing is rigid.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np

from carom.base.outcome import Outcome
from carom.core.event_log import EventLog
from carom.core.in_turn import advance_in_turn
from carom.core.phases import AWAY
from carom.core.settling import memory
from carom.disturbances.base_motion import BaseMotion
from carom.models import Rotor
from carom.models.forcing_modes import ForcingModes
from carom.motions.ensembles import MOST_EVENTS
from carom.motions.simulation import tools

LOGGED = 256
TURN = 2.0 * math.pi
TOGETHER = 64
"""Shocks in one compiled call, in which Ctrl-C is not heard."""


def states_after(
    motion: BaseMotion, rotor: Rotor, sizes: np.ndarray, angles: np.ndarray, begins: np.ndarray | float = 0.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """State at the end of motions of the base of a rotor that levitates inside the wall.

    Peak accelerations are in ``c_r Ω²``, angles in rad, times at which they begin in ``1/Ω``.  Return positions
    (on the wall where the rotor is in contact then) and velocities in the co-rotating frame, for ``n > 1`` coordinates
    with a last axis of that length; the outcome that has ended the motion during it, ``CLEAR`` where none has, and whether the wall was
    reached during it.
    """
    shape, turns = sizes.shape, motion.turns_with_shaft
    each = zip(*(part.ravel().tolist() for part in np.broadcast_arrays(sizes, angles, begins)), strict=True)
    # Number by number: the last bit of array arithmetic depends on the place in the array.
    given = [(size, cmath.rect(1.0, angle + begun * turns), begun) for size, angle, begun in each]
    if rotor.system.is_anisotropic or rotor.system.shaft is not None:  # a direction is no factor then
        groups = [(turn, [(size, begun)]) for size, turn, begun in given]
    else:
        groups = [(1.0, [(size * turn, begun) for size, turn, begun in given])] if given else []
    found = [_after(motion, rotor, *group) for group in groups]
    states, ended, touched = map(np.concatenate, zip(*found, strict=True)) if found else np.zeros((3, 0))
    n = len(rotor.system.rest)
    positions, velocities = np.split(np.reshape(states, (-1, 2 * n)), 2, axis=1)
    whole = shape + ((n,) if n > 1 else ())
    return positions.reshape(whole), velocities.reshape(whole), ended.reshape(shape), touched.reshape(shape)


def _after(
    motion: BaseMotion, rotor: Rotor, turn: complex, given: Sequence[tuple[complex, float]]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """States (m, 2n), outcomes and whether the wall was reached after motions along a direction, of these sizes from these times."""
    sections, moved = motion.sections(rotor), ForcingModes.of(rotor, motion.forces(rotor, turn))
    system, (sizes, begins) = moved.rotor.system, map(np.array, zip(*given, strict=True))
    quiet = moved.at(0.0 * sections[0][1], 0.0).system
    motions = np.array(
        [quiet.amplitudes_of(np.concatenate(rotor.system.kicked(0.0, begun))[None], begun)[0] for begun in begins]
    )
    contacts = np.full((len(motions), len(system.arrays["rows"])), AWAY)
    outcomes, events, times = np.zeros(len(motions), np.int64), np.zeros(len(motions), np.int64), begins.copy()
    for duration, values in sections:
        on = np.flatnonzero(outcomes == Outcome.CLEAR)
        going = moved.set_in(motions[on], sizes[on, None] * values, times[on])
        touching = contacts[on]
        outcomes[on], more = _follow(moved.rotor, going, touching, times[on], duration)
        motions[on], contacts[on] = going, touching
        events[on] += more
        times += duration
    states = system.states_of(motions)
    if rotor.system.is_planar:
        touches = contacts[:, 0] != AWAY
        states[touches, 0] /= np.abs(states[touches, 0])
    return states, outcomes, events > 0


def _follow(
    rotor: Rotor, motions: np.ndarray, contacts: np.ndarray, begins: np.ndarray, duration: float
) -> tuple[np.ndarray, np.ndarray]:
    """Follow amplitudes (m, N) and contacts (m, P) through a section, in place; how it was ended, and numbers of events, both (m,)."""
    system, clocks = rotor.system, np.mod(begins, TURN)
    outcomes, events = np.zeros((2, len(motions)), np.int64)
    arrays, table, work, rub = tools(rotor)
    room = EventLog.empty(LOGGED, system.modes, contacts.shape[1], system.limits)
    own = room, memory(system.modes, limits=system.limits), work, rub
    for first in range(0, len(motions), TOGETHER):
        here = slice(first, first + TOGETHER)
        given = motions[here], clocks[here], duration, MOST_EVENTS, contacts[here]
        advance_in_turn(arrays, table, *given, *own, outcomes[here], events[here])
    outcomes[outcomes == Outcome.TIME_REACHED] = Outcome.CLEAR
    return outcomes, events
