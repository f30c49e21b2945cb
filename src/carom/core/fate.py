"""Where a motion ends: criteria that settle it, and the memory they need.

- *Levitated*: the sum of the moduli of the modes at every contact plane, a bound for all later time, is smaller than
  the room between the contact-free equilibrium and the wall.  Where damping is so weak that this takes long: the flight
  without damping stays inside the wall for one turn of its modes against each other, and the turns that follow until
  then differ too little from it.  Either is a proof.
- *Forward rub*: the state slides within ``NEAR`` of the synchronous rub that attracts sliding; or, where the memory holds
  one, it lies in a neighbourhood of that rub which sliding never leaves.  This is a proof too (:mod:`carom.closed_forms.absorbing`).
- *Rolling*: where the memory holds the speed of a certain runaway, backward whirl slides faster.  A proof
  (:mod:`carom.closed_forms.whirl`).
- *Backward whirl*, *rolling* and forward rub that runs round the wall: after a turn without flight the state has changed
  by less than ``NEAR`` and by less than ``NEAR`` per unit time, so slow changes do not pass for none.
- *Periodic*: the state at an impact recurs to within ``NEAR`` twice in a row after the same number of impacts.  The
  reference is renewed after 1, 2, 4, 8 … impacts (Brent 1980), so no period is too long.  A motion that has recurred next
  to an orbit that repels only passes by, and is followed on (:mod:`carom.core.closing`).
- *Aperiodic*: ``patience`` impacts have passed without recurrence.
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.block import basis_amplitudes
from carom.core.flow import squared_modulus
from carom.core.layout import kernel, record

__all__ = [
    "NEAR",
    "absorbed",
    "approaches_turn",
    "doubt",
    "forget",
    "forget_rub",
    "impacts_until_noted",
    "levitates",
    "memory",
    "near_rub",
    "recurs",
    "rub_potentials",
    "same_state",
    "stays_inside",
]

NEAR = 1e-9
"""Distance, relative to one plus the size of the state, below which two states are the same."""

TURNS = 32
"""Turns of the faster mode that are tried for one after which the other mode is back too."""
SLACK = 2e-4
"""Distance, in clearances, by which the path between two samples of a turn may bulge."""

NO_TURN, SET_OUT, ROUND = 0, 1, 2


def memory(
    modes: int,
    rub_position: complex = 0j,
    patience: int = 0,
    recheck: float = np.inf,
    stop_at_landing: bool = False,
    rub_level: float = 0.0,
    rub_shape: tuple[float, float, float] = (0.0, 0.0, 0.0),
    runaway: float = np.inf,
) -> np.record:
    """Memory of a motion, and how far to follow it.

    Parameters
    ----------
    modes : int
    rub_position : complex
        Position of the synchronous rub that attracts sliding; zero if there is none.
    patience : int
        Impacts without recurrence after which a motion counts as aperiodic; zero to settle nothing.
    recheck : float
        Time of free flight after which to look again whether the rotor levitates.
    stop_at_landing : bool
        End with ``CHATTER`` where bounces go over into lasting contact.
    rub_level : float
        Level of the function below which forward slip surely goes over to the rub; zero not to ask.
    rub_shape : tuple of float
        The ``μ``, ``p`` and ``y₀`` of that function, see :mod:`carom.closed_forms.absorbing`.
    runaway : float
        Speed of backward whirl from which on sliding surely goes over to rolling for good; infinite not to ask.
    """
    friction, strength, phase = rub_shape
    return record(
        reference=np.zeros(modes, np.complex128),
        attracted=np.full(modes, np.nan, np.complex128),
        rub_position=np.asarray(rub_position, np.complex128),
        rub_level=np.asarray(rub_level, float),
        rub_friction=np.asarray(friction, float),
        rub_strength=np.asarray(strength, float),
        rub_phase=np.asarray(phase, float),
        runaway=np.asarray(runaway, float),
        patience=np.asarray(patience, np.int64),
        recheck=np.asarray(recheck),
        stop_at_landing=np.asarray(stop_at_landing, np.int64),
        events=np.asarray(0, np.int64),
        renewal=np.asarray(1, np.int64),
        since=np.asarray(0, np.int64),
        candidate=np.asarray(0, np.int64),
        period=np.asarray(0, np.int64),
        rubbed=np.asarray(0, np.int64),
        lifting=np.asarray(0, np.int64),
        turning=np.asarray(NO_TURN, np.int64),
        turn_time=np.asarray(0.0),
        turn_slipped=np.asarray(0, np.int64),
        turn_position=np.asarray(0, np.complex128),
        turn_state=np.zeros(modes, np.complex128),
    )


@kernel
def levitates(rotor, amplitudes, work):
    """Whether no later flight can reach any wall."""
    modes = amplitudes.shape[0]
    for plane in range(rotor.rows.shape[0]):
        basis_amplitudes(rotor, plane, amplitudes, work.amplitudes)
        reach = math.sqrt(squared_modulus(rotor.offsets[plane]))
        for k in range(modes):
            if rotor.exponents[k].real > 0.0:
                return False
            if k + 1 < modes and rotor.driven[k + 1]:
                continue
            size = math.sqrt(squared_modulus(work.amplitudes[k]))
            if rotor.driven[k]:
                driving = work.amplitudes[k - 1]
                share = driving * rotor.inverse_gaps[k]
                apart = math.sqrt(squared_modulus(work.amplitudes[k] + share)) + math.sqrt(squared_modulus(share))
                size += math.sqrt(squared_modulus(driving)) * rotor.largest_response[k]
                if rotor.gaps[k] != 0.0:
                    size = min(size, apart)
            reach += size
        if reach >= 1.0 - NEAR:
            return False
    return True


@kernel
def stays_inside(rotor, amplitudes):
    """Whether a weakly damped flight surely stays inside the wall, though its modes are large enough to reach it together.

    For a rotor with one plane and a pair of modes that decay alike, ``y = K + s (c₊e^{iω₊t} + c₋e^{iω₋t})`` with
    ``s = e^{−δt}``.  As ``s ≤ 1``, ``|y|`` is at most the greater of ``|K|`` and the modulus without damping.  That one is bounded
    over one time ``P`` in which the faster mode turns a whole number of times, by samples and by the second derivative
    in between; over the next, the slower mode lags by ``ω P`` mod 2π more, which moves ``y`` by no more than that times its
    amplitude.  This has to stay inside until the sum of the moduli does by itself.
    """
    if rotor.exponents.shape[0] != 2 or rotor.rows.shape[0] != 1 or not rotor.driven[1]:
        return False
    decay = -rotor.exponents[1].real
    if decay <= 0.0 or rotor.gaps[1] == 0.0 or abs(decay + rotor.exponents[0].real) > 1e-15 * decay:
        return False
    share = amplitudes[0] * rotor.inverse_gaps[1]
    slow, fast = amplitudes[1] + share, -share
    slow_rate, fast_rate = rotor.exponents[1].imag, rotor.exponents[0].imag
    if abs(slow_rate) > abs(fast_rate):
        slow, fast, slow_rate, fast_rate = fast, slow, fast_rate, slow_rate
    centre = rotor.offsets[0]
    room = 1.0 - NEAR - math.sqrt(squared_modulus(centre))
    reach = math.sqrt(squared_modulus(slow)) + math.sqrt(squared_modulus(fast))
    if room <= 0.0 or reach <= 0.0:
        return False
    lasts = max(math.log(reach / room), 0.0) / decay
    rounding = 4e-16 * TURNS * (abs(slow_rate) + abs(fast_rate)) * lasts * reach
    bend = slow_rate * slow_rate * math.sqrt(squared_modulus(slow)) + fast_rate * fast_rate * math.sqrt(
        squared_modulus(fast)
    )
    least = room
    for turns in range(1, TURNS + 1):
        span = 2.0 * math.pi * turns / abs(fast_rate)
        lag = abs(_wrapped(slow_rate * span))
        drift = math.sqrt(squared_modulus(slow)) * lag * lasts / span
        if drift + rounding < least:
            least = drift + rounding
            farthest = _farthest(centre, slow, fast, slow_rate, fast_rate, span, math.sqrt(8.0 * SLACK / bend))
            if farthest + SLACK + drift + rounding < 1.0 - NEAR:
                return True
    return False


@kernel
def _wrapped(angle):
    """The angle less the nearest whole number of turns."""
    return angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi) + 0.5)


@kernel
def _farthest(centre, slow, fast, slow_rate, fast_rate, span, step):
    """Largest of samples of ``|K + c₊e^{iω₊t} + c₋e^{iω₋t}|`` over a time, not more than a step apart."""
    count = int(span / step) + 1
    largest = 0.0
    for i in range(count + 1):
        time = span * i / count
        first, second = slow_rate * time, fast_rate * time
        place = (
            centre
            + slow * complex(math.cos(first), math.sin(first))
            + fast * complex(math.cos(second), math.sin(second))
        )
        largest = max(largest, squared_modulus(place))
    return math.sqrt(largest)


@kernel
def recurs(memory, amplitudes):
    """Note the state at an impact; whether the motion has proved periodic (``memory.period`` impacts) or aperiodic (0)."""
    memory.events += 1
    if memory.events > 1:
        memory.since += 1
        if same_state(memory.reference, amplitudes, NEAR):
            if memory.candidate == memory.since:
                memory.period = memory.since
                return True
            memory.candidate = memory.since
            _renew(memory, amplitudes)
            return False
        if memory.candidate > 0 and memory.since >= memory.candidate:
            memory.candidate = 0
        if memory.since < memory.renewal:
            return memory.events >= memory.patience
        memory.renewal *= 2
    memory.candidate = 0
    _renew(memory, amplitudes)
    memory.rubbed = 0
    return memory.events >= memory.patience


@kernel
def impacts_until_noted(memory):
    """Number of the next impact, from now, that :func:`recurs` has to see even if its state recurs to nothing."""
    if memory.events == 0:
        return 1
    number = min(memory.renewal - memory.since, memory.patience - memory.events)
    return min(number, memory.candidate - memory.since) if memory.candidate > 0 else number


@kernel
def _renew(memory, amplitudes):
    memory.since = 0
    for k in range(amplitudes.shape[0]):
        memory.reference[k] = amplitudes[k]


@kernel
def same_state(first, second, tolerance):
    """Whether the distance of two states, relative to one plus their size, is within a tolerance."""
    size = 1.0
    distance = 0.0
    for k in range(first.shape[0]):
        size += math.sqrt(squared_modulus(second[k]))
        distance += math.sqrt(squared_modulus(first[k] - second[k]))
    return distance <= tolerance * size


@kernel
def near_rub(memory, position, speed):
    """Whether a sliding state is at the synchronous rub that attracts it."""
    if memory.rub_position == 0.0:
        return False
    return math.sqrt(squared_modulus(position - memory.rub_position)) + abs(speed) < NEAR


@kernel
def absorbed(memory, position, speed):
    """Whether a state that slides forward lies where it surely goes over to the synchronous rub (:mod:`carom.closed_forms.absorbing`)."""
    if memory.rub_level <= 0.0:
        return False
    friction, phase = memory.rub_friction, memory.rub_phase
    apart = memory.rub_position.conjugate() * position
    ahead = math.atan2(apart.imag, apart.real)
    if ahead < -math.pi - 2.0 * phase:
        ahead += 2.0 * math.pi
    elif ahead >= math.pi - 2.0 * phase:
        ahead -= 2.0 * math.pi
    value = 0.5 * speed * speed * math.exp(2.0 * friction * ahead)
    return value + _rub_potential(ahead, friction, memory.rub_strength, phase) < memory.rub_level


@kernel
def rub_potentials(ahead, friction, strength, phase):
    """``p ∫₀ˢ (sin(y₀ + σ) − sin y₀) e^{2μσ} dσ`` at angles ``s`` ahead of the rub, shape (M,)."""
    potentials = np.empty_like(ahead)
    for i in range(ahead.shape[0]):
        potentials[i] = _rub_potential(ahead[i], friction, strength, phase)
    return potentials


@kernel
def _rub_potential(ahead, friction, strength, phase):
    rate = 2.0 * friction
    swing = math.exp(rate * ahead) * (rate * math.sin(phase + ahead) - math.cos(phase + ahead))
    start = rate * math.sin(phase) - math.cos(phase)
    steady = math.expm1(rate * ahead) / rate if rate > 0.0 else ahead
    return strength * ((swing - start) / (1.0 + rate * rate) - math.sin(phase) * steady)


@kernel
def approaches_turn(memory, position, amplitudes, speed):
    """Note a position on the wall; whether the rotor has been round and is within a quarter turn of it again."""
    if memory.turning == NO_TURN:
        memory.turn_position = position
        memory.turn_time = 0.0
        memory.turn_slipped = 0
        for k in range(amplitudes.shape[0]):
            memory.turn_state[k] = amplitudes[k]
        memory.turning = SET_OUT
        return False
    ahead = memory.turn_position.conjugate() * position
    if ahead.real < 0.0:
        memory.turning = ROUND
        return False
    return memory.turning == ROUND and ahead.imag * speed < 0.0


@kernel
def forget(memory):
    """Make a memory ready for another motion of the same rotor."""
    memory.events, memory.renewal, memory.since = 0, 1, 0
    memory.candidate, memory.period, memory.rubbed, memory.lifting = 0, 0, 0, 0
    memory.turning = NO_TURN


@kernel
def doubt(memory):
    """Look for another recurrence: what has recurred only passes by an orbit."""
    memory.candidate, memory.period = 0, 0


@kernel
def forget_rub(memory):
    """Start to look for turns along the wall anew."""
    memory.turning = NO_TURN
