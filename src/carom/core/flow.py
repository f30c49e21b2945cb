"""Exact flight: sums of exponentials and their derivatives, free of cancellation.

All changes are formed from ``e^z − 1``, never from ``e^z``, so that the distance from the wall keeps its relative
accuracy in flights of any length, down to the last ones of a chatter.
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.layout import kernel

__all__ = [
    "acceleration",
    "complex_expm1",
    "displacement",
    "flight_increments",
    "fly_all",
    "nudge",
    "squared_modulus",
    "velocity",
]


@kernel
def squared_modulus(z):
    """``|z|²``."""
    return z.real * z.real + z.imag * z.imag


@kernel
def complex_expm1(z):
    """``e^z − 1`` for complex ``z`` without cancellation at small ``|z|``."""
    growth = math.expm1(z.real)
    sine = math.sin(0.5 * z.imag)
    cosine_less_one = -2.0 * sine * sine
    return complex(growth + cosine_less_one * (1.0 + growth), 2.0 * (1.0 + growth) * sine * math.cos(0.5 * z.imag))


@kernel
def flight_increments(rotor, amplitudes, time, increments):
    """Write ``c(time) − c(0)`` of a flight that starts with these amplitudes.

    A pair with exponents ``λ₋`` (driving, amplitude ``b``) and ``λ₊`` (driven, amplitude ``a``) moves as
    ``a e^{λ₊t} + b φ(t)`` with the divided difference ``φ = (e^{λ₊t} − e^{λ₋t})/(λ₊ − λ₋)``, written here as
    ``e^{λ₊t} (1 − e^{−(λ₊−λ₋)t})/(λ₊ − λ₋)``, which is accurate however close the exponents are.
    """
    modes = amplitudes.shape[0]
    for k in range(modes):
        if k + 1 < modes and rotor.driven[k + 1]:
            continue
        growth = complex_expm1(rotor.exponents[k] * time)
        increments[k] = amplitudes[k] * growth
        if rotor.driven[k]:
            lag = complex_expm1(-rotor.gaps[k] * time)
            response = -lag * rotor.inverse_gaps[k]
            if rotor.gaps[k] == 0.0:
                response = complex(time, 0.0)
            increments[k] += amplitudes[k - 1] * (1.0 + growth) * response
            increments[k - 1] = amplitudes[k - 1] * (growth + lag + growth * lag)


@kernel
def fly_all(rotor, amplitudes, times):
    """Amplitudes (M, N) after flights of given times (M,), each from its own amplitudes (M, N)."""
    flown = np.empty_like(amplitudes)
    for i in range(times.shape[0]):
        flight_increments(rotor, amplitudes[i], times[i], flown[i])
        for k in range(amplitudes.shape[1]):
            flown[i, k] += amplitudes[i, k]
    return flown


@kernel
def nudge(rotor, amplitudes, time):
    """Advance amplitudes in place by a time so short that the fourth power of ``λ·time`` is below rounding."""
    for k in range(amplitudes.shape[0] - 1, -1, -1):
        z = rotor.exponents[k] * time
        change = amplitudes[k] * z * (1.0 + 0.5 * z * (1.0 + z / 3.0))
        if rotor.driven[k]:
            w = rotor.exponents[k - 1] * time
            change += amplitudes[k - 1] * time * (1.0 + 0.5 * (z + w) + (z * z + z * w + w * w) / 6.0)
        amplitudes[k] += change


@kernel
def displacement(rotor, plane, amplitudes):
    """Displacement ``y`` at a plane, in its clearance."""
    total = rotor.offsets[plane]
    for k in range(amplitudes.shape[0]):
        total += rotor.rows[plane, k] * amplitudes[k]
    return total


@kernel
def velocity(rotor, plane, amplitudes):
    """Velocity ``ẏ`` at a plane."""
    total = 0j
    for k in range(amplitudes.shape[0]):
        total += rotor.rate_rows[plane, k] * amplitudes[k]
    return total


@kernel
def acceleration(rotor, plane, amplitudes):
    """Acceleration ``ÿ`` at a plane."""
    total = 0j
    for k in range(amplitudes.shape[0]):
        total += rotor.acceleration_rows[plane, k] * amplitudes[k]
    return total
