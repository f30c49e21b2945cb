"""Ends of the planar rotor's motions that are proven before they are reached.

- *Levitated*: the flight without damping stays inside the wall for one period after which its modes nearly repeat, and
  the drift over later periods is too small to reach the wall.
- *Forward rub*: the state lies in a neighbourhood of the synchronous rub which sliding never leaves
  (:mod:`carom.closed_forms.absorbing`).
- *Forward rub* or *backward whirl* that gains speed for ever: a rotor without friction and with negative damping.
- *Rolling*: backward whirl slides faster than a threshold speed (:mod:`carom.closed_forms.whirl`), or an impact stops the slip and
  leaves the wall so slowly that the bounces fade (:mod:`carom.closed_forms.whirl`).
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.compiling.decorators import kernel
from carom.core.flow import displacement, squared_modulus, velocity
from carom.core.friction import friction_margin
from carom.core.layout import RECURRENCE_RTOL
from carom.core.records import record
from carom.core.wall import wall_of

TURNS = 32
"""Largest number of turns of the faster mode tried as a period after which the slower mode nearly repeats too."""
SLACK = 2e-4
"""Distance, in clearances, by which the path between two samples may lie further out than the samples."""


def planar_proofs(
    level: float = 0.0,
    shape: tuple[float, float, float] = (0.0, 0.0, 0.0),
    runaway: float = np.inf,
    fading: float = 0.0,
    hastening: float = np.inf,
) -> np.record:
    """Constants of the proofs for one rotor; the defaults prove nothing.

    Parameters
    ----------
    level : float
        Level of the function below which forward slip certainly ends in the rub; zero to skip this test.
    shape : tuple of float
        The ``μ``, ``p`` and ``y₀`` of that function, see :mod:`carom.closed_forms.absorbing`.
    runaway : float
        Speed of backward whirl above which sliding certainly ends in permanent rolling; infinite to skip this test.
    fading : float
        Speed after an impact that has stopped the slip up to which bounces certainly fade to permanent rolling; zero to skip this
        test.
    hastening : float
        Speed of whirl in the fixed frame, either way round, above which sliding without friction certainly gains speed for ever;
        infinite to skip this test.
    """
    friction, strength, phase = shape
    return record(
        level=np.asarray(level, float),
        friction=np.asarray(friction, float),
        strength=np.asarray(strength, float),
        phase=np.asarray(phase, float),
        runaway=np.asarray(runaway, float),
        fading=np.asarray(fading, float),
        hastening=np.asarray(hastening, float),
    )


@kernel
def stays_inside(rotor, amplitudes):
    """Whether a weakly damped flight provably stays inside the wall although the sum of its moduli reaches the wall.

    For a rotor with one station and a pair of modes of equal decay, ``y = K + s (c₊e^{iω₊t} + c₋e^{iω₋t})`` with
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
    room = 1.0 - RECURRENCE_RTOL - math.sqrt(squared_modulus(centre))
    reach = math.sqrt(squared_modulus(slow)) + math.sqrt(squared_modulus(fast))
    if room <= 0.0 or reach <= 0.0:
        return False
    lasts = max(math.log(reach / room), 0.0) / decay
    rounding = 4e-16 * TURNS * (abs(slow_rate) + abs(fast_rate)) * lasts * reach
    bend = slow_rate * slow_rate * math.sqrt(squared_modulus(slow)) + fast_rate * fast_rate * math.sqrt(
        squared_modulus(fast)
    )
    least, limit = room, 1.0 - RECURRENCE_RTOL - SLACK
    for turns in range(1, TURNS + 1):
        span = 2.0 * math.pi * turns / abs(fast_rate)
        lag = abs(_wrapped(slow_rate * span))
        drift = math.sqrt(squared_modulus(slow)) * lag * lasts / span
        if drift + rounding < least:
            least = drift + rounding
            step = math.sqrt(8.0 * SLACK / bend)
            farthest = _farthest(centre, slow, fast, slow_rate, fast_rate, span, step, limit)
            if farthest >= limit:
                return False
            if farthest + drift + rounding < limit:
                return True
    return False


@kernel
def _wrapped(angle):
    """The angle minus the nearest whole number of turns."""
    return angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi) + 0.5)


@kernel
def _farthest(centre, slow, fast, slow_rate, fast_rate, span, step, limit):
    """Largest sample of ``|K + c₊e^{iω₊t} + c₋e^{iω₋t}|`` over a time span, at samples at most one step apart.

    The first sample that reaches the limit is enough.  Most flights that are asked about have just left the wall, or soon return.
    """
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
        if largest >= limit * limit:
            break
    return math.sqrt(largest)


@kernel
def absorbed(proofs, rub, position, speed):
    """Whether a state in forward slip provably ends in the synchronous rub at a position (:mod:`carom.closed_forms.absorbing`)."""
    if proofs.level <= 0.0:
        return False
    friction, phase = proofs.friction, proofs.phase
    apart = rub.conjugate() * position
    ahead = math.atan2(apart.imag, apart.real)
    if ahead < -math.pi - 2.0 * phase:
        ahead += 2.0 * math.pi
    elif ahead >= math.pi - 2.0 * phase:
        ahead -= 2.0 * math.pi
    value = 0.5 * speed * speed * math.exp(2.0 * friction * ahead)
    return value + _rub_potential(ahead, friction, proofs.strength, phase) < proofs.level


@kernel
def runs_away(proofs, speed):
    """Whether backward whirl that slides at this speed along growing angle provably ends in rolling."""
    return -(1.0 + speed) > proofs.runaway


@kernel
def hastens(proofs, speed):
    """Whether whirl that slides at this speed along growing angle provably gains speed for ever."""
    return abs(1.0 + speed) > proofs.hastening


@kernel
def fades_to_rolling(proofs, rotor, end):
    """Whether the impact of a state stops the slip, and the bounces from there provably fade to rolling."""
    if proofs.fading <= 0.0:
        return False
    local = displacement(rotor, 0, end).conjugate() * velocity(rotor, 0, end)
    wall = wall_of(rotor, 0)
    return friction_margin(local, wall) >= 0.0 and wall.restitution * local.real <= proofs.fading


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
