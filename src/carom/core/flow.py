"""Exact flight: sums of exponentials and their derivatives, free of cancellation.

All changes are formed from ``e^z − 1``, never from ``e^z``, so that the distance from the wall keeps its relative
accuracy in flights of any length, down to the last ones of a chatter.
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.compiling.decorators import inlined, kernel

THIRD = 1.0 / 3.0
RESONANT = 1e-9
"""Distance to which the exponent of the unbalance is kept from that of an undamped mode, whose forced response would be infinite."""


@inlined
def squared_modulus(z):
    """``|z|²``."""
    return z.real * z.real + z.imag * z.imag


@inlined
def complex_expm1(z):
    """``e^z − 1`` for complex ``z`` without cancellation at small ``|z|``."""
    growth = math.expm1(z.real)
    sine = math.sin(0.5 * z.imag)
    cosine_less_one = -2.0 * sine * sine
    return complex(growth + cosine_less_one * (1.0 + growth), 2.0 * (1.0 + growth) * sine * math.cos(0.5 * z.imag))


@inlined
def flight_increments(rotor, starts, time, increments):
    """Write ``c(time) − c(0)`` of flights of equal duration that start with these amplitudes; both of shape (D, N).

    A pair with exponents ``λ₋`` (driving, amplitude ``b``) and ``λ₊`` (driven, amplitude ``a``) moves as
    ``a e^{λ₊t} + b φ(t)`` with the divided difference ``φ = (e^{λ₊t} − e^{λ₋t})/(λ₊ − λ₋)``, written here as
    ``e^{λ₊t} (1 − e^{−(λ₊−λ₋)t})/(λ₊ − λ₋)``, which is accurate however close the exponents are.
    """
    flights, modes = starts.shape
    for k in range(modes):
        if k + 1 < modes and rotor.driven[k + 1]:
            continue
        growth = complex_expm1(rotor.exponents[k] * time)
        for i in range(flights):
            increments[i, k] = starts[i, k] * growth
        if k > 1 and rotor.driven[k] and rotor.driven[k - 1]:
            _chain_increments(rotor, starts, k, growth, time, increments)
        elif rotor.driven[k]:
            lag = complex_expm1(-rotor.gaps[k] * time)
            response = -lag * rotor.inverse_gaps[k]
            if rotor.gaps[k] == 0.0:
                response = complex(time, 0.0)
            for i in range(flights):
                increments[i, k] += starts[i, k - 1] * (1.0 + growth) * response
                increments[i, k - 1] = starts[i, k - 1] * (growth + lag + growth * lag)


@inlined
def _chain_increments(rotor, starts, last, growth, time, increments):
    """:func:`flight_increments` of a chain of equal exponents that ends with a mode: ``Σ_j c_{k−j} tʲ/j! e^{λt}``."""
    first = chain_start(rotor, last)
    for i in range(starts.shape[0]):
        for k in range(first, last + 1):
            increments[i, k] = starts[i, k] * growth
            factor = 1.0
            for j in range(1, k - first + 1):
                factor *= time / j
                increments[i, k] += starts[i, k - j] * ((1.0 + growth) * factor)


@inlined
def chain_start(rotor, mode):
    """First mode of the chain that a mode belongs to."""
    first = mode
    while rotor.driven[first]:
        first -= 1
    return first


@kernel
def fly_all(rotor, amplitudes, times):
    """Amplitudes (M, N) after flights of given times (M,), each from its own amplitudes (M, N)."""
    flown = np.empty_like(amplitudes)
    for i in range(times.shape[0]):
        fly(rotor, amplitudes[i : i + 1], times[i], flown[i : i + 1])
    return flown


@inlined
def fly(rotor, starts, time, flown):
    """Write the amplitudes (1, N) after a flight from others (1, N)."""
    flight_increments(rotor, starts, time, flown)
    if rotor.shaft.shape[0] > 0:
        _unbalance_increments(rotor, starts, time, flown)
    for k in range(starts.shape[1]):
        flown[0, k] += starts[0, k]


@kernel
def _unbalance_increments(rotor, starts, time, increments):
    """Add what the unbalance of a shaft contributes to a flight (:mod:`carom.core.shaft`)."""
    place, response, own = rotor.shaft[0], np.empty_like(starts), np.empty_like(starts)
    unbalance_response(rotor, starts[0], response[0])
    flight_increments(rotor, response, time, own)
    turn = complex_expm1(complex(0.0, (starts[0, place + 1].real - 1.0) * time))
    for k in range(starts.shape[1]):
        increments[0, k] += starts[0, place] * (response[0, k] * turn - own[0, k])
    increments[0, place] = starts[0, place] * turn


@inlined
def unbalance_response(rotor, amplitudes, response):
    """Write the forced response ``S = (iν − M)⁻¹uσ²`` to the unbalance at the speed that the shaft has."""
    speed = amplitudes[rotor.shaft[0] + 1].real
    for k in range(amplitudes.shape[0]):
        push = rotor.unbalance[k] * (speed * speed)
        if k > 0 and rotor.driven[k]:
            push += response[k - 1]
        gap = complex(0.0, speed - 1.0) - rotor.exponents[k]
        if squared_modulus(gap) < RESONANT * RESONANT:
            gap = complex(RESONANT, 0.0)
        response[k] = push / gap


@inlined
def unbalance_drive(rotor, amplitudes):
    """``σ²p``, by which the unbalance of a shaft drives the other modes at constant speed."""
    speed = amplitudes[rotor.shaft[0] + 1].real
    return amplitudes[rotor.shaft[0]] * (speed * speed)


@inlined
def nudge(rotor, amplitudes, time):
    """Advance amplitudes in place by a time so short that the fourth power of ``λ·time`` is below rounding."""
    driving, driving_rate, driving_second = 0j, 0j, 0j
    for k in range(amplitudes.shape[0]):
        if not rotor.driven[k]:
            driving, driving_rate, driving_second = 0j, 0j, 0j
        exponent = rotor.exponents[k]
        rate = exponent * amplitudes[k] + driving
        second = exponent * rate + driving_rate
        third = exponent * second + driving_second
        driving, driving_rate, driving_second = amplitudes[k], rate, second
        half, third_part = 0.5 * time, THIRD * time
        amplitudes[k] += complex(
            time * (rate.real + half * (second.real + third_part * third.real)),
            time * (rate.imag + half * (second.imag + third_part * third.imag)),
        )


@inlined
def copy(source, target):
    """Copy amplitudes."""
    for k in range(source.shape[0]):
        target[k] = source[k]


@inlined
def displacement(rotor, station, amplitudes):
    """Displacement ``y`` at a station, in its clearance."""
    total = rotor.offsets[station]
    for k in range(amplitudes.shape[0]):
        total += rotor.rows[station, k] * amplitudes[k]
    return total


@inlined
def velocity(rotor, station, amplitudes):
    """Velocity ``ẏ`` at a station."""
    total = 0j
    for k in range(amplitudes.shape[0]):
        total += rotor.rate_rows[station, k] * amplitudes[k]
    return total


@inlined
def acceleration(rotor, station, amplitudes):
    """Acceleration ``ÿ`` at a station."""
    total = 0j
    for k in range(amplitudes.shape[0]):
        total += rotor.acceleration_rows[station, k] * amplitudes[k]
    if rotor.shaft.shape[0] > 0:
        total += rotor.unbalance_rows[station] * unbalance_drive(rotor, amplitudes)
    return total
