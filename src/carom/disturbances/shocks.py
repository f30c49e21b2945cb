"""Exact motion of a levitating rotor in a housing shaken by a half-sine pulse, contacts included.

The housing carries magnetic bearings and touchdown bearings.  With the coordinates ``Z`` of the rotor relative to it and the
translation ``t`` of the rotor as a whole, all masses feel its acceleration ``a(τ) = â sin(ντ) e^{iα}``, ``ν = π/T``,

    M Z̈ + (D − iG) Ż + K Z = F e^{iτ} − M t a(τ),

if moving as a whole bends no shaft and needs no gyroscopic moment (``G t = 0``).  Mounts of touchdown bearings are shaken too: ``t`` is the translation of
all that the housing carries.  So the accelerations of the coordinates
change by ``−t a``, and only that need be known.  In the co-rotating frame, with ``t â e^{iα}/2i`` from the two exponentials of a sine, these are two forces with exponents of
their own (:mod:`carom.models.forcing`),

    −t (â e^{iα}/2i) e^{s₁τ} + t (â e^{iα}/2i) e^{s₂τ},   s₁ = i(ν − 1),  s₂ = −i(ν + 1).

So the certified flight, the impacts and the lasting contact of :mod:`carom.core` apply unchanged during the pulse, which is a
stage of the motion.  At its end position and velocity are kept: the housing then moves at constant velocity.

Limits: the housing is rigid and moves along a line.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from carom.base.outcome import Outcome
from carom.core.event_log import EventLog
from carom.core.in_turn import advance_in_turn
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import AWAY
from carom.core.settling import memory
from carom.models import Force, Rotor, System
from carom.models.mode_arrays import EQUAL, STEADY
from carom.motions.ensembles import MOST_EVENTS

LOGGED = 256
TURN = 2.0 * math.pi
TOGETHER = 64
"""Shocks in one compiled call, in which Ctrl-C is not heard."""


def shaken(rotor: Rotor, duration: float, size: complex, begins: float = 0.0) -> Rotor:
    """The rotor under the two forces of a half-sine pulse of this duration in ``1/Ω``, with ``size = â e^{iα}/2i``, from a time."""
    frequency, push = math.pi / duration, size * rotor.carried_by_housing
    exponents = 1j * (frequency - 1.0), -1j * (frequency + 1.0)
    first, second = (Force(each, cmath.exp(-each * begins) * push) for each in exponents)
    return rotor.under(first._replace(accelerations=-first.accelerations), second)


def states_after_shocks(
    rotor: Rotor, peaks: np.ndarray, duration: float, directions: np.ndarray, begins: np.ndarray | float = 0.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """State at the end of half-sine pulses on a rotor that levitates inside the wall.

    Peak accelerations of the housing are in ``c_r Ω²``, directions in rad, durations and times at which the pulses begin in ``1/Ω``.  Return positions
    (on the wall where the rotor is in contact then) and velocities in the co-rotating frame, for ``n > 1`` coordinates
    with a last axis of that length; the outcome that has ended the motion during the pulse, ``CLEAR`` where none has, and whether the wall was
    reached during the pulse.
    """
    begins = np.broadcast_to(begins, peaks.shape)
    if rotor.system.is_anisotropic or rotor.system.shaft is not None:
        return _states_one_by_one(rotor, peaks, duration, directions, begins)
    system = shaken(rotor, duration, 1.0).system
    at_rest = np.append(rotor.system.rest, np.zeros_like(rotor.system.rest))
    # Levitation under weight goes round a circle; its amplitudes are those of the weight, whatever the shock.
    (whole,) = system.amplitudes_of(np.concatenate(rotor.system.kicked(0.0))[None])
    steady = np.where(np.abs(system.arrays["exponents"] - STEADY) <= EQUAL, system.outer, 0.0)
    unit, weight = (whole - steady).tolist(), steady.tolist()
    # Number by number: the last bit of array arithmetic depends on the place in the array.
    sizes = [cmath.rect(*pair) / 2j for pair in zip(peaks.ravel().tolist(), directions.ravel().tolist(), strict=True)]
    turns = [cmath.exp(STEADY * time) for time in begins.ravel().tolist()]
    each = [
        [size * value + turn * constant for value, constant in zip(unit, weight, strict=True)]
        for size, turn in zip(sizes, turns, strict=True)
    ]
    motions = np.array(each, complex).reshape(-1, system.modes)
    contacts, outcomes, events = _follow(system, motions, begins.ravel(), duration)
    positions, velocities = np.split(_states(system.basis, motions) + at_rest, 2, axis=1)
    if rotor.system.is_planar:
        touches = contacts[:, 0] != AWAY
        positions[touches] /= np.abs(positions[touches])
    shape = peaks.shape + (rotor.system.rest.shape if len(rotor.system.rest) > 1 else ())
    ended, touched = outcomes.reshape(peaks.shape), (events > 0).reshape(peaks.shape)
    return positions.reshape(shape), velocities.reshape(shape), ended, touched


def _states_one_by_one(
    rotor: Rotor, peaks: np.ndarray, duration: float, directions: np.ndarray, begins: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """:func:`states_after_shocks` where bearings are anisotropic or the shaft changes its speed: the motion is no multiple of that of another shock."""
    found, ended, touched = [], [], []
    for peak, direction, begun in zip(*(each.ravel().tolist() for each in (peaks, directions, begins)), strict=True):
        system = shaken(rotor, duration, cmath.rect(peak, direction) / 2j, begun).system
        motion = system.amplitudes_of(np.concatenate(rotor.system.kicked(0.0, begun))[None], begun)
        _, outcomes, events = _follow(system, motion, np.array([begun]), duration)
        found.append(system.states_of(motion)[0])
        ended.append(outcomes[0])
        touched.append(events[0] > 0)
    positions, velocities = np.split(np.reshape(found, (-1, 2 * len(rotor.system.rest))), 2, axis=1)
    shape = peaks.shape + (rotor.system.rest.shape if len(rotor.system.rest) > 1 else ())
    shaped = np.reshape(ended, peaks.shape), np.reshape(touched, peaks.shape)
    return positions.reshape(shape), velocities.reshape(shape), *shaped


def _follow(
    system: System, motions: np.ndarray, begins: np.ndarray, duration: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Follow amplitudes (m, N) through a pulse, in place; contacts (m, P) at its end, how it was ended, and numbers of events, both (m,)."""
    planes, clocks = len(system.arrays["rows"]), np.mod(begins, TURN)
    contacts = np.full((len(motions), planes), AWAY)
    outcomes, events = np.zeros((2, len(motions)), np.int64)
    tools = (
        EventLog.empty(LOGGED, system.modes, planes, system.limits),
        memory(system.modes, limits=system.limits),
        workspace(system.modes),
        rub_workspace(system.modes, planes, system.limits),
    )
    for first in range(0, len(motions), TOGETHER):
        here = slice(first, first + TOGETHER)
        given = clocks[here], duration, MOST_EVENTS, contacts[here]
        advance_in_turn(system.arrays, system.table, motions[here], *given, *tools, outcomes[here], events[here])
    outcomes[outcomes == Outcome.TIME_REACHED] = Outcome.CLEAR
    return contacts, outcomes, events


def _states(basis: np.ndarray, amplitudes: np.ndarray) -> np.ndarray:
    """States of amplitudes (M, N), summed mode by mode: the last bit of a product of matrices depends on the place in it."""
    states = np.zeros((len(amplitudes), len(basis)), complex)
    for column, values in zip(basis.T, amplitudes.T, strict=True):
        states += values[:, None] * column
    return states
