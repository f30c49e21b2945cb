"""Disturbances that provably never bring the rotor to the wall, and the smallest of those tried that is lost."""

from __future__ import annotations

import math

import numpy as np

from carom.models import Jeffcott, Subject, model_of
from carom.outcome import InputError, Outcome

__all__ = ["harmless_kick", "harmless_shock", "harmless_step", "lost", "smallest_lost"]


def harmless_kick(machine: Subject) -> float:
    """Speed up to which a kick out of levitation provably never reaches the wall, in ``c_r Ω``.

    In the fixed frame the deviation from the levitation whirl obeys ``ü + γu̇ + ω²u = 0``, whose coefficients are real:
    a kick of speed ``v`` moves the rotor along its own direction, by at most ``v g``.  For ``γ < 2ω`` the largest
    response ``g = e^{−γτ/2}/ω`` is that of the first turning point ``τ = arctan(2w/γ)/w``, ``w = √(ω² − γ²/4)``;
    above critical damping the hyperbolic form holds.  Contact is impossible while ``v g < 1 − |U*|``.

    Zero where the rotor cannot levitate inside the wall or its levitation is unstable.
    """
    rotor = model_of(machine)
    numbers = rotor.parameters
    gap = 1.0 - abs(rotor.equilibrium)
    gamma, omega = numbers.gamma, numbers.omega
    if gap <= 0.0 or gamma < 0.0:
        return 0.0
    return max(0.0, gap * (1.0 - 1e-9) / _largest_response(gamma, omega))


def harmless_shock(machine: Subject, duration: float) -> float:
    """Peak acceleration up to which a half-sine shock of the base provably never brings the rotor to the wall.

    The deviation is the convolution of the shock with the response to a kick, which is at most ``g``
    (:func:`harmless_kick`).  So it is no larger than ``g`` times the change of velocity over the pulse, ``2âT/π``.
    This bound is sharp for short pulses.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    duration : float
        ``T``, in ``1/Ω``.

    Returns
    -------
    float
        Peak acceleration in ``c_r Ω²``.
    """
    rotor = model_of(machine)
    if not (np.isfinite(duration) and duration > 0.0):
        raise InputError("duration", duration, "a time above 0, in 1/Omega")
    return harmless_kick(rotor) * math.pi / (2.0 * duration)


def harmless_step(rotor: Jeffcott) -> float:
    """Change of the eccentricity up to which a step of the unbalance provably never brings the rotor to the wall.

    A change ``Δ`` shifts the levitation whirl by ``u₀ = Δ/(ω² − 1 + iγ)`` in the co-rotating frame.  This is the
    deviation at the step; its velocity in the fixed frame is ``iu₀``.  There the deviation obeys ``ü + γu̇ + ω²u = 0``,
    whose energy ``|u̇|² + ω²|u|²`` does not grow, so the deviation stays below ``|u₀|√(1 + 1/ω²)``.  This bound is not
    sharp.

    Returns
    -------
    float
        Change in ``c_r``; zero where the rotor cannot levitate inside the wall or its levitation is unstable.
    """
    numbers = rotor.parameters
    gap = 1.0 - abs(rotor.equilibrium)
    if gap <= 0.0 or numbers.gamma < 0.0 or numbers.omega == 0.0:
        return 0.0
    stiffness = math.hypot((numbers.omega - 1.0) * (numbers.omega + 1.0), numbers.gamma)
    return gap * (1.0 - 1e-9) * stiffness / math.hypot(1.0, 1.0 / numbers.omega)


def _largest_response(gamma: float, omega: float) -> float:
    """Largest deviation after a kick of speed 1."""
    half = gamma / 2.0
    square = (omega - half) * (omega + half)
    if abs(square) <= 1e-12 * omega**2:
        moment = 1.0 / half
    elif square > 0.0:
        moment = math.atan2(math.sqrt(square), half) / math.sqrt(square)
    else:
        rate = math.sqrt(-square)
        moment = math.log((half + rate) ** 2 / omega**2) / (2.0 * rate)
    return math.exp(-half * moment) / omega


def lost(outcomes: np.ndarray) -> np.ndarray:
    """Which outcomes are not levitation; those that double precision cannot decide do not count as lost."""
    return (outcomes != Outcome.LEVITATED) & (outcomes != Outcome.GRAZING)


def smallest_lost(velocities: np.ndarray, outcomes: np.ndarray) -> tuple[float, float] | None:
    """Speed and direction of the smallest lost kick among kicks to these velocities; ``None`` if none is lost."""
    gone = velocities[lost(outcomes)]
    if not gone.size:
        return None
    smallest = gone[np.abs(gone).argmin()]
    return float(abs(smallest)), float(np.angle(smallest))
