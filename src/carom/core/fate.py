"""Criteria that decide to which end a motion settles, and the memory they need.

- *Levitated*: at every contact plane, the sum of the moduli of the modes is smaller than the distance between the
  contact-free equilibrium and the wall.  This sum is a bound for all later time.  If damping is so weak that this takes
  long, a second criterion is used: the flight without damping stays inside the wall for one period after which its
  modes nearly repeat, and the drift over later periods, until the first criterion holds, is too small to reach the
  wall.  Both criteria are proofs.
- *Forward rub*: the state slides within ``NEAR`` of the synchronous rub that attracts sliding, or, if the rubs of a rotor
  are not known, changes by less than ``NEAR`` per unit time.  Or it lies in a
  neighbourhood of that rub which sliding never leaves, if the memory holds one; this is a proof
  (:mod:`carom.closed_forms.absorbing`).
- *Rolling*: if the memory holds a threshold speed, backward whirl slides faster than it and so certainly ends in
  rolling; this is a proof (:mod:`carom.closed_forms.whirl`).
- *Backward whirl*, *rolling* and forward rub that runs round the wall: after a full turn without flight the state has
  changed by less than ``NEAR`` and by less than ``NEAR`` per unit time, so a slow change is not taken for none.
- *Periodic*: the state at an impact recurs to within ``NEAR`` twice in a row after the same number of impacts.  The
  reference state is replaced after 1, 2, 4, 8 … impacts (Brent 1980), so no period is too long.  A motion that has
  recurred close to a repelling orbit only passes by it and is followed further (:mod:`carom.core.closing`).
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
    "at_rest",
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
"""Largest number of turns of the faster mode tried as a period after which the slower mode nearly repeats too."""
SLACK = 2e-4
"""Distance, in clearances, by which the path between two samples may lie further out than the samples."""

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
    resting: bool = False,
) -> np.record:
    """Memory of the criteria for one motion, and the options on how far to follow it.

    Parameters
    ----------
    modes : int
    rub_position : complex
        Position of the synchronous rub that attracts sliding; zero if there is none.
    patience : int
        Impacts without recurrence after which a motion counts as aperiodic; zero to test no criterion.
    recheck : float
        Time of free flight after which to test again whether the rotor levitates.
    stop_at_landing : bool
        End with ``CHATTER`` where bounces turn into lasting contact.
    rub_level : float
        Level of the function below which forward slip certainly ends in the rub; zero to skip this test.
    rub_shape : tuple of float
        The ``μ``, ``p`` and ``y₀`` of that function, see :mod:`carom.closed_forms.absorbing`.
    runaway : float
        Speed of backward whirl above which sliding certainly ends in permanent rolling; infinite to skip this test.
    resting : bool
        Whether lasting contact that is at rest counts as a synchronous rub; for rotors whose rubs are not known.  A rub
        that repels is marked by −1 until the motion has left it.
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
        resting=np.asarray(resting, np.int64),
        patience=np.asarray(patience, np.int64),
        recheck=np.asarray(recheck),
        stop_at_landing=np.asarray(stop_at_landing, np.int64),
        stalled=np.asarray(0, np.int64),
        lap=np.asarray(np.inf),
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
    """Whether the rotor can provably never reach any wall again."""
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
    """Whether a weakly damped flight provably stays inside the wall although the sum of its moduli reaches the wall.

    For a rotor with one plane and a pair of modes of equal decay, ``y = K + s (c₊e^{iω₊t} + c₋e^{iω₋t})`` with
    ``s = e^{−δt}``.  As ``s ≤ 1``, ``|y|`` is at most the greater of ``|K|`` and the modulus without damping.  The
    latter is bounded over one period ``P``, in which the faster mode makes a whole number of turns: by samples, and by
    the second derivative between them.  In each further period the phase of the slower mode, with frequency ``ω``,
    shifts by ``ω P`` mod 2π more.  This moves ``y`` by at most the shift times the amplitude of that mode.  The bound
    has to stay inside the wall until the sum of the moduli does.
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
    """The angle minus the nearest whole number of turns."""
    return angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi) + 0.5)


@kernel
def _farthest(centre, slow, fast, slow_rate, fast_rate, span, step):
    """Largest sample of ``|K + c₊e^{iω₊t} + c₋e^{iω₋t}|`` over a time span, at samples at most one step apart."""
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
    """Record the state at an impact; return whether the motion is periodic (``memory.period`` > 0) or aperiodic (0)."""
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
    """Number of impacts until the next one that :func:`recurs` has to record even if its state does not recur."""
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
    """Whether a sliding state has reached the synchronous rub that attracts it."""
    if memory.rub_position == 0.0:
        return False
    return math.sqrt(squared_modulus(position - memory.rub_position)) + abs(speed) < NEAR


@kernel
def at_rest(work):
    """Whether a motion, given by its Taylor series, is at rest in the co-rotating frame."""
    size, rate = 1.0, 0.0
    for m in range(work.series.shape[1]):
        size += math.sqrt(squared_modulus(work.series[0, m]))
        rate += math.sqrt(squared_modulus(work.series[1, m]))
    return rate <= NEAR * size


@kernel
def absorbed(memory, position, speed):
    """Whether a state in forward slip provably ends in the synchronous rub (:mod:`carom.closed_forms.absorbing`)."""
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
    """Record the position where a turn begins; later return whether the rotor is in the last quarter of a full turn."""
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
    """Reset a memory for another motion of the same rotor."""
    memory.events, memory.renewal, memory.since = 0, 1, 0
    memory.candidate, memory.period, memory.rubbed, memory.lifting = 0, 0, 0, 0
    memory.turning = NO_TURN
    memory.stalled, memory.lap = 0, math.inf


@kernel
def doubt(memory):
    """Discard a recurrence and look for another one: the motion only passes by a repelling orbit."""
    memory.candidate, memory.period = 0, 0


@kernel
def forget_rub(memory):
    """Restart the search for full turns along the wall."""
    memory.turning = NO_TURN
