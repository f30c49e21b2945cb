"""Exact motion of a levitating rotor in a housing shaken by a half-sine pulse, contacts included.

The housing carries magnetic bearings and touchdown bearings.  With the coordinates ``Z`` of the rotor relative to it and the
translation ``t`` of the rotor as a whole, all masses feel its acceleration ``a(τ) = â sin(ντ) e^{iα}``, ``ν = π/T``,

    M Z̈ + (D − iG) Ż + K Z = F e^{iτ} − M t a(τ),

if moving as a whole bends no shaft and needs no gyroscopic moment (``G t = 0``).  So the accelerations of the coordinates
change by ``−t a``, and only the translation need be known.  In the co-rotating frame, for the mode amplitudes,

    ċ = Λc − b (â e^{iα}/2i)(e^{s₁τ} − e^{s₂τ}),   s₁ = i(ν − 1),  s₂ = −i(ν + 1),

with the change ``b`` of ``ċ`` by unit accelerations along ``t``: each exponential adds ``∓(â e^{iα}/2i) (s − Λ)⁻¹b`` times
itself.  They are two additional modes, with exponents of their own, that no impulse changes.  So
the certified flight, the impacts and the lasting contact of :mod:`carom.core` apply unchanged during the pulse.  At its
end the two modes are dropped, and position and velocity are kept: the housing then moves at constant velocity.

Limits: the housing is rigid and moves along a line; ``s − Λ`` is singular only for undamped levitation with a natural
frequency that is that of the pulse, which is refused.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from carom.core.advance import advance
from carom.core.event_log import EventLog
from carom.core.fate import forget, memory
from carom.core.layout import rotor_record, rub_workspace, workspace
from carom.core.phases import AWAY
from carom.core.wall import Wall
from carom.models import Model, System
from carom.motions.ensembles import MOST_EVENTS
from carom.outcome import InputError, Outcome

EVENT_LIMIT, TIME_REACHED = int(Outcome.EVENT_LIMIT), int(Outcome.TIME_REACHED)
LOGGED = 256
LEAST_DISTANCE = 1e-6
"""Least distance of the pulse from undamped resonance, relative to the frequency; below it too many digits cancel."""


def shaken(rotor: Model, duration: float) -> tuple[System, np.ndarray]:
    """The system with two more modes, the exponentials of a half-sine pulse of this duration in ``1/Ω``.

    Return also the share of each free mode in their motion, shape (N, 2).  Undamped levitation in resonance with the pulse
    is refused.
    """
    system, frequency = rotor.system, math.pi / duration
    arrays, free = system.arrays, system.exponents
    pulse = np.array([complex(0.0, frequency - 1.0), complex(0.0, -frequency - 1.0)])
    if (np.abs(pulse[:, None] - free) < LEAST_DISTANCE * np.abs(free + 1j)).any():
        raise InputError("duration", duration, "not half a natural period of undamped levitation, in 1/Omega")
    shares = np.array(
        [np.linalg.solve(s * np.eye(len(free)) - system.generator, system.base_excitation) for s in pulse]
    ).T
    shaken_arrays = rotor_record(
        exponents=np.concatenate([free, pulse]),
        driven=np.append(arrays.driven, [False, False]),
        offsets=arrays.offsets,
        rows=np.concatenate([arrays.rows, arrays.rows @ shares], axis=1),
        columns=np.concatenate([arrays.columns, np.zeros((2, len(arrays.rows)))]).astype(complex),
        **{name: arrays[name] for name in Wall._fields},
        masses=arrays.masses,
    )
    shapes = np.concatenate([system.shapes, system.shapes @ shares], axis=1)
    return System(shaken_arrays, system.rest, shapes), shares


def states_after_shocks(
    rotor: Model, peaks: np.ndarray, duration: float, directions: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """State at the end of half-sine pulses that hit a rotor that levitates inside the wall.

    Peak accelerations of the housing are in ``c_r Ω²``, directions in rad, the duration in ``1/Ω``.  Return positions
    (on the wall where the rotor is in contact then) and velocities in the co-rotating frame, for ``n > 1`` coordinates
    with a last axis of that length; whether the wall was
    grazed so nearly that double precision cannot decide, and whether it was reached during the pulse.
    """
    system, shares = shaken(rotor, duration)
    arrays, table = system.arrays, system.table
    planes, modes = arrays.rows.shape
    free, rest = shares.tolist(), system.rest.tolist()
    shapes, rates = system.shapes.tolist(), system.rates.tolist()
    log, work, rub = EventLog.empty(LOGGED, modes, planes), workspace(modes), rub_workspace(modes, planes)
    recollection, contact = memory(modes), np.empty(planes, np.int64)
    positions, velocities = np.empty((2, *peaks.shape, len(rest)), complex)
    undecided, touched = np.zeros((2, *peaks.shape), bool)
    for place in np.ndindex(peaks.shape):
        amplitudes = _at_rest(free, float(peaks[place]), float(directions[place]))
        forget(recollection)
        outcome, contact[:], events, time = EVENT_LIMIT, AWAY, 0, 0.0
        while outcome == EVENT_LIMIT and events < MOST_EVENTS:
            outcome, passed, count = advance(
                arrays, table, amplitudes, duration - time, contact, log, recollection, work, rub
            )
            events, time = events + count, time + passed
        values = amplitudes.tolist()
        for i, start in enumerate(rest):
            positions[place][i], velocities[place][i] = _sum(start, shapes[i], values), _sum(0j, rates[i], values)
        undecided[place], touched[place] = outcome != TIME_REACHED, events > 0
        if rotor.system.is_planar and contact[0] != AWAY:
            positions[place] /= abs(positions[place])
    if len(rest) == 1:
        positions, velocities = positions[..., 0], velocities[..., 0]
    return positions, velocities, undecided, touched


def _sum(start: complex, row: list[complex], amplitudes: list[complex]) -> complex:
    """Sum of products, term by term: the last bit of array arithmetic depends on the place in the array."""
    for weight, amplitude in zip(row, amplitudes, strict=True):
        start += weight * amplitude
    return start


def _at_rest(shares: list[list[complex]], peak: float, direction: float) -> np.ndarray:
    """Amplitudes of the levitating rotor when a pulse begins."""
    force = cmath.rect(peak, direction) / 2j
    return np.array([*(force * (first - second) for first, second in shares), -force, force])
