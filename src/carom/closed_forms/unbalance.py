"""Contact-free unbalance response of the planar rotor over the speed of the shaft.

Mass, damping, stiffness and eccentricity are fixed in SI units, so that ``γ = c/(mΩ)`` and ``ω = ω_n/Ω`` change with the
speed and ``ρ`` does not.  With ``y = (ω_n/Ω)²``, ``ω_n = √(k/m)`` and ``ζ = c/(2√(km))`` the displacement along the
unbalance is ``U*e^{−iφ} = ρ/(y − 1 + 2iζ√y)`` and

    (ρ/|U*|)² = y² − 2by + 1,      b = 1 − 2ζ²,

a quadratic in ``y``.  So the peak is at ``y = b``, where ``(ρ/|U*|)² = 1 − b² = 4ζ²(1 − ζ²)``, and the speeds at which the
amplitude has any given value ``a`` are its two roots for ``ρ²/a²``.

Where steady motions in contact begin and end is a quadratic too, in ``u = 1/Ω``: a rub in a fold at
``c u/m + μ(1 − ω_n²u²) = ±ρ√(1 + μ²)``, rolling at ``μ(s² − ω_n²u²) − |c|su/m = ρ√(1 + μ²)``
(:mod:`carom.closed_forms.thresholds`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.base.arguments import Positive, Reals, checked
from carom.base.outcome import InputError, shown
from carom.base.results import Result
from carom.closed_forms.thresholds import largest_excitation
from carom.models import Rotor, Subject, jeffcott, rotor_of


@dataclass(frozen=True, eq=False, repr=False)
class SpeedResponse(Result):
    """Contact-free response to the unbalance at any speed; speeds are in rad/s, amplitudes in clearances.

    Attributes
    ----------
    rotor : Rotor
        The rotor at its present speed.
    natural_frequency : float
        ``ω_n = √(k/m)``, rad/s.
    damping_ratio : float
        ``ζ = c/(2√(km))``.
    critical_speed : float or None
        Speed of the largest amplitude, ``ω_n/√(1 − 2ζ²)``; ``None`` if ``ζ ≥ 1/√2``, where the amplitude only grows.
    peak : float
        Amplitude there, ``ρ/(2ζ√(1 − ζ²))``; without a critical speed its limit at high speed, ``ρ``.
    half_power : tuple of float, or None
        Speeds below and above the critical one at which the amplitude is ``1/√2`` of the peak.  The upper one is infinite
        if the amplitude does not fall so far (``ζ ≥ sin(π/8)``).  ``None`` without a critical speed.
    amplification_factor : float or None
        Critical speed over the difference of these two speeds: the definition of API 617 and API RP 684, where 0.707
        stands for ``1/√2``.  Infinite without damping; ``None`` if there is no critical speed or the upper one of the two is
        infinite.
    """

    rotor: Rotor
    natural_frequency: float
    damping_ratio: float
    critical_speed: float | None
    peak: float
    half_power: tuple[float, float] | None
    amplification_factor: float | None

    @checked
    def beyond(self, radius: Positive) -> tuple[float, float] | None:
        """Range of speeds at which the amplitude exceeds a radius above 0; its end may be infinite.  ``None``: nowhere."""
        return _range(self.natural_frequency, self.damping_ratio, self.rotor.parameters.rho / radius)

    @checked
    def rub_angles(self, speeds: Reals) -> np.ndarray:
        """Angles ``x`` of the synchronous rubs relative to the unbalance, in rad, shape (2, n) for speeds of shape (n,).

        With ``p = ρ√(1 + μ²)`` and ``δ = atan μ`` they solve ``p sin(x + δ) = −γ − μ(1 − ω²)``.  First the one with
        ``cos(x + δ) > 0``, to which sliding returns where ``γ + 2μ > 0``; then the saddle.  ``nan`` where there is none, or
        the wall would have to pull: ``ρ cos x + 1 − ω² ≤ 0``.
        """
        at = self.rotor.parameters
        ratio = self.natural_frequency / np.asarray(speeds, float)
        gap, friction_angle, excitation = 1.0 - ratio * ratio, math.atan(at.mu), largest_excitation(at)
        with np.errstate(divide="ignore", invalid="ignore"):
            turned = -np.arcsin((2.0 * self.damping_ratio * ratio + at.mu * gap) / excitation)
        angles = np.array([turned - friction_angle, math.pi - turned - friction_angle])
        return np.where(at.rho * np.cos(angles) + gap > 0.0, angles, np.nan)

    def contact_changes(self) -> tuple[float, ...]:
        """Speeds at which steady motions in contact can begin or end, in ascending order.

        Levitation meets the wall, two rubs meet in a fold, or rolling begins or ceases to hold at every angle.  Between
        two neighbours the steady motions are the same; not every one of these speeds changes them.
        """
        at, rigidity = self.rotor.parameters, self.natural_frequency**2
        rate, excitation = 2.0 * self.damping_ratio * self.natural_frequency, largest_excitation(at)
        found = list(self.beyond(1.0) or ())
        for edge in (excitation, -excitation):
            found += _inverses(-at.mu * rigidity, rate, at.mu - edge)
        slip = at.radius_ratio
        found += _inverses(-at.mu * rigidity, -abs(rate) * slip, at.mu * slip * slip - excitation)
        return tuple(sorted({speed for speed in found if 0.0 < speed < math.inf}))


@checked
def speed_response(machine: Subject) -> SpeedResponse:
    """Response to the unbalance over the speed of the shaft, without contact, in closed form.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        A rotor with one mass, clearance and speed; its weight, touchdown bearing and limits do not matter.

    Raises
    ------
    InputError
        A rotor with more modes, or a rotor without scales: its damping and stiffness are not known apart from its speed.
    """
    at = rotor_of(machine).planar
    if at is None:
        raise InputError("machine", shown(machine), "a rotor with one mass; carom.studies.unbalance_response takes any")
    rotor = jeffcott(at)
    if at.scales is None:
        allowed = "needed for a response over speed: use a file with a [machine] table, or parameters with scales"
        raise InputError("scales", None, allowed)
    natural, ratio = at.omega * at.scales.speed, 0.5 * at.gamma / at.omega
    least = 1.0 - 2.0 * ratio * ratio
    if least <= 0.0:
        return SpeedResponse(rotor, natural, ratio, None, at.rho, None, None)
    critical = natural / math.sqrt(least)
    depth = 2.0 * abs(ratio) * math.sqrt((1.0 - ratio) * (1.0 + ratio))
    peak = at.rho / depth if depth else (math.inf if at.rho else 0.0)
    half = _range(natural, ratio, math.sqrt(2.0) * depth) or (critical, critical)
    width = half[1] - half[0]
    factor = None if width == math.inf else critical / width if width else math.inf
    return SpeedResponse(rotor, natural, ratio, critical, peak, half, factor)


def _range(natural: float, ratio: float, factor: float) -> tuple[float, float] | None:
    """Speeds between which ``y² − 2by + 1`` is less than the square of a factor."""
    middle = 1.0 - 2.0 * ratio * ratio
    depth = 4.0 * ratio * ratio * (1.0 - ratio) * (1.0 + ratio)
    inside = factor * factor - depth
    if inside <= 0.0:
        return None
    reach, product = math.sqrt(inside), (1.0 - factor) * (1.0 + factor)
    # The root of larger modulus, and the other one from their product: without cancellation.
    if middle >= 0.0:
        upper = middle + reach
        lower = product / upper
    else:
        lower = middle - reach
        upper = product / lower
    if upper <= 0.0:
        return None
    return natural / math.sqrt(upper), natural / math.sqrt(lower) if lower > 0.0 else math.inf


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
