"""Steady motions in contact of the planar rotor over the speed of the shaft.

Mass, damping, stiffness and eccentricity are fixed in SI units, so that ``γ = c/(mΩ)`` and ``ω = ω_n/Ω`` change with the
speed and ``ρ`` does not.  With ``y = (ω_n/Ω)²``, ``ω_n = √(k/m)`` and ``ζ = c/(2√(km))`` the displacement along the
unbalance is ``U*e^{−iφ} = ρ/(y − 1 + 2iζ√y)`` and

    (ρ/|U*|)² = y² − 2by + 1,      b = 1 − 2ζ²,

a quadratic in ``y``, whose roots for ``ρ²`` are the speeds at which levitation meets the wall.

Where steady motions in contact begin and end is a quadratic too, in ``u = 1/Ω``: a rub in a fold at
``c u/m + μ(1 − ω_n²u²) = ±ρ√(1 + μ²)``, rolling at ``μ(s² − ω_n²u²) − |c|su/m = ρ√(1 + μ²)``
(:mod:`carom.closed_forms.thresholds`).
"""

from __future__ import annotations

import math

import numpy as np

from carom.base.arguments import Reals, checked
from carom.base.outcome import InputError
from carom.closed_forms.thresholds import largest_excitation
from carom.models import Subject, exact_rotor_of
from carom.parameters import Parameters


@checked
def rub_angles(machine: Subject, speeds: Reals) -> np.ndarray:
    """Angles ``x`` of the synchronous rubs of the planar rotor relative to the unbalance, in rad, shape (2, n) for speeds in rad/s of shape (n,).

    With ``p = ρ√(1 + μ²)`` and ``δ = atan μ`` they solve ``p sin(x + δ) = −γ − μ(1 − ω²)``.  First the one with
    ``cos(x + δ) > 0``, to which sliding returns where ``γ + 2μ > 0``; then the saddle.  ``nan`` where there is none, or
    the wall would have to pull: ``ρ cos x + 1 − ω² ≤ 0``.

    Raises
    ------
    InputError
        Another rotor, or one without scales: its damping and stiffness are not known apart from its speed.
    """
    at, natural, damping_ratio = _over_speed(machine)
    ratio = natural / np.asarray(speeds, float)
    gap, friction_angle, excitation = 1.0 - ratio * ratio, math.atan(at.mu), largest_excitation(at)
    with np.errstate(divide="ignore", invalid="ignore"):
        turned = -np.arcsin((2.0 * damping_ratio * ratio + at.mu * gap) / excitation)
    angles = np.array([turned - friction_angle, math.pi - turned - friction_angle])
    return np.where(at.rho * np.cos(angles) + gap > 0.0, angles, np.nan)


@checked
def contact_changes(machine: Subject) -> tuple[float, ...]:
    """Speeds in rad/s at which steady motions in contact of the planar rotor can begin or end, in ascending order.

    Levitation meets the wall, two rubs meet in a fold, or rolling begins or ceases to hold at every angle.  Between
    two neighbours the steady motions are the same; not every one of these speeds changes them.

    Raises
    ------
    InputError
        See :func:`rub_angles`.
    """
    at, natural, damping_ratio = _over_speed(machine)
    rigidity, rate, excitation = natural**2, 2.0 * damping_ratio * natural, largest_excitation(at)
    found = _edges(natural, damping_ratio, at.rho)
    for edge in (excitation, -excitation):
        found += _inverses(-at.mu * rigidity, rate, at.mu - edge)
    slip = at.radius_ratio
    found += _inverses(-at.mu * rigidity, -abs(rate) * slip, at.mu * slip * slip - excitation)
    return tuple(sorted({speed for speed in found if 0.0 < speed < math.inf}))


def _over_speed(machine: Subject) -> tuple[Parameters, float, float]:
    """Parameters at the present speed, the natural frequency in rad/s and the damping ratio."""
    at = exact_rotor_of(machine).parameters
    if at.scales is None:
        allowed = "needed for a response over speed: use a file with a [machine] table, or parameters with scales"
        raise InputError("scales", None, allowed)
    return at, at.omega * at.scales.speed, 0.5 * at.gamma / at.omega


def _edges(natural: float, ratio: float, factor: float) -> list[float]:
    """Speeds at the ends of the range in which ``y² − 2by + 1`` is less than the square of a factor."""
    middle = 1.0 - 2.0 * ratio * ratio
    inside = factor * factor - 4.0 * ratio * ratio * (1.0 - ratio) * (1.0 + ratio)
    if inside <= 0.0:
        return []
    # The root of larger modulus, and the other one from their product: without cancellation.
    larger = middle + math.copysign(math.sqrt(inside), middle)
    roots = larger, (1.0 - factor) * (1.0 + factor) / larger
    return [natural / math.sqrt(root) for root in roots if root > 0.0]


def _inverses(square: float, linear: float, constant: float) -> list[float]:
    """``1/u`` for the positive roots of ``square u² + linear u + constant``: roots of the reversed polynomial."""
    if constant == 0.0:
        return [-square / linear] if linear else []
    inside = linear * linear - 4.0 * square * constant
    if inside < 0.0:
        return []
    larger = -0.5 * (linear + math.copysign(math.sqrt(inside), linear))
    roots = [larger / constant, square / larger if larger else 0.0]
    return [root for root in roots if root > 0.0]
