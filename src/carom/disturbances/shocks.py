"""Exact motion of the levitating rotor in a housing shaken by a half-sine pulse, contacts included.

The housing carries magnetic bearings and touchdown bearing.  Relative to it, its acceleration
``a(t) = â sin(νt) e^{iα}``, ``ν = π/T``, acts on a rigid rotor as a force ``−a`` per mass.  In the co-rotating frame
that is

    Ü + (γ + 2i)U̇ + (ω² − 1 + iγ)U = ρe^{iφ} − (â e^{iα}/2i)(e^{s₁t} − e^{s₂t}),   s₁ = i(ν − 1),  s₂ = −i(ν + 1),

so each of the two exponentials adds ``∓â e^{iα}/(2i D(s))`` times itself to the motion, with
``D(s) = (s − λ₋)(s − λ₊)``.  They are two additional modes, with exponents of their own, that no impulse changes.  So
the certified flight, the impacts and the lasting contact of :mod:`carom.core` apply unchanged during the pulse.  At its
end the two modes are dropped, and position and velocity are kept: the housing then moves at constant velocity.

Limits: the housing is rigid and moves along a line; ``D(s)`` vanishes only for undamped levitation whose natural
frequency is that of the pulse, which is refused.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from carom.core.advance import advance
from carom.core.contact_series import AWAY
from carom.core.fate import forget, memory
from carom.core.layout import rotor_record, rub_workspace, workspace
from carom.models import Jeffcott, System
from carom.motions.trajectories import EventLog
from carom.outcome import InputError, Outcome

MODES = 4
EVENT_LIMIT, TIME_REACHED = int(Outcome.EVENT_LIMIT), int(Outcome.TIME_REACHED)
LOGGED = 256
MOST_EVENTS = 1_000_000
LEAST_DISTANCE = 1e-6
"""Least distance ``|D|/ω²`` of the pulse from undamped resonance; below it too many digits cancel."""


def shaken(rotor: Jeffcott, duration: float) -> System:
    """A system of four modes: free flight, and the two exponentials of a half-sine pulse of this duration in ``1/Ω``.

    Undamped levitation in resonance with the pulse is refused.
    """
    arrays = rotor.system.arrays
    frequency = math.pi / duration
    pulse = (complex(0.0, frequency - 1.0), complex(0.0, -frequency - 1.0))
    free = tuple(complex(value) for value in arrays.exponents)
    nearest = min(abs((s - free[0]) * (s - free[1])) for s in pulse)
    if nearest < LEAST_DISTANCE * abs(free[0] + 1j) * abs(free[1] + 1j):
        raise InputError("duration", duration, "not half a natural period of undamped levitation, in 1/Omega")
    shaken_arrays = rotor_record(
        exponents=np.array([*free, *pulse], np.complex128),
        driven=np.array([False, True, False, False]),
        offsets=arrays.offsets,
        rows=np.array([[0.0, 1.0, 1.0, 1.0]], np.complex128),
        columns=np.array([[1.0], [0.0], [0.0], [0.0]], np.complex128),
        friction=arrays.friction,
        restitution=arrays.restitution,
        drive=arrays.drive,
    )
    return System(shaken_arrays, arrays.offsets, shaken_arrays.rows)


def states_after_shocks(
    rotor: Jeffcott, peaks: np.ndarray, duration: float, directions: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """State at the end of half-sine pulses that hit a rotor that levitates inside the wall.

    Peak accelerations of the housing are in ``c_r Ω²``, directions in rad, the duration in ``1/Ω``.  Return positions
    (on the wall where the rotor is in contact then) and velocities in the co-rotating frame, whether the wall was
    grazed so nearly that double precision cannot decide, and whether it was met during the pulse.
    """
    system = shaken(rotor, duration)
    arrays, table = system.arrays, system.table
    rest, exponents = rotor.equilibrium, arrays.exponents.tolist()
    rows, rate_rows = arrays.rows[0].tolist(), arrays.rate_rows[0].tolist()
    log, work, rub = EventLog.empty(LOGGED, MODES), workspace(MODES), rub_workspace(MODES)
    recollection, contact = memory(MODES), np.empty(1, np.int64)
    positions, velocities = np.empty((2, *peaks.shape), complex)
    undecided, touched = np.zeros((2, *peaks.shape), bool)
    for place in np.ndindex(peaks.shape):
        amplitudes = _at_rest(exponents, float(peaks[place]), float(directions[place]))
        forget(recollection)
        outcome, contact[0], events, time = EVENT_LIMIT, AWAY, 0, 0.0
        while outcome == EVENT_LIMIT and events < MOST_EVENTS:
            outcome, passed, count = advance(
                arrays, table, amplitudes, duration - time, contact, *log, recollection, work, rub
            )
            events, time = events + count, time + passed
        values = amplitudes.tolist()
        position = _sum(rest, rows, values)
        positions[place] = position / abs(position) if contact[0] != AWAY else position
        velocities[place] = _sum(0j, rate_rows, values)
        undecided[place], touched[place] = outcome != TIME_REACHED, events > 0
    return positions, velocities, undecided, touched


def _sum(start: complex, row: list[complex], amplitudes: list[complex]) -> complex:
    """Sum of products, term by term: the last bit of array arithmetic depends on the place in the array."""
    for weight, amplitude in zip(row, amplitudes, strict=True):
        start += weight * amplitude
    return start


def _at_rest(exponents: list[complex], peak: float, direction: float) -> np.ndarray:
    """Amplitudes of the levitating rotor when a pulse begins."""
    lower, upper, first, second = exponents
    force = cmath.rect(peak, direction) / 2j
    shares = [-force / ((first - lower) * (first - upper)), force / ((second - lower) * (second - upper))]
    driven = -(shares[0] + shares[1])
    driving = -(first * shares[0] + second * shares[1]) - upper * driven
    return np.array([driving, driven, *shares])
