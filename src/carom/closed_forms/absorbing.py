"""A neighbourhood of the synchronous rub that sliding never leaves, proven by a Lyapunov function.

While the rotor slides with forward slip, ``θ̈ = −γ(1 + θ̇) − ρ sin x − μN`` with ``x = θ − φ`` and
``N = ρ cos x + (1 + θ̇)² − ω²`` (components of the source paper's (2.13) along the wall).  With ``w = θ̇``,
``p = ρ√(1 + μ²)``, ``y = x + arctan μ`` and the stable rub at ``p sin y₀ = −γ − μ(1 − ω²)``, ``cos y₀ > 0``,

    ẇ = −(γ + 2μ)w − μw² − p(sin y − sin y₀).

An integrating factor absorbs the quadratic term of friction: with ``s = y − y₀``,

    V = ½w²e^{2μs} + p ∫₀ˢ (sin(y₀ + σ) − sin y₀) e^{2μσ} dσ,      V̇ = −(γ + 2μ) w² e^{2μs} ≤ 0.

The part of ``V < c`` around the rub is bounded while ``c`` is below ``V`` at both saddles ``s = ±π − 2y₀``.  If on all of it
the wall pushes (``N > 0``) and slip is forward (``s_r + 1 + w > 0``), sliding cannot end there, and by LaSalle's principle
every state in it converges to the rub, the only invariant set with ``w = 0``.  The largest such ``c`` follows from the least
``V`` on the curves ``N = 0`` and ``s_r + 1 + w = 0``, bounded from below interval by interval.

None of this depends on the restitution: it holds for a restitution of one too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.base.arguments import Reals, checked
from carom.closed_forms.equilibria import Equilibrium, find_equilibria
from carom.closed_forms.thresholds import largest_excitation
from carom.core.planar_proofs import rub_potentials
from carom.models import Rotor, Subject, exact_rotor_of

INTERVALS = 4000
"""With ten times as many the level would be two or three thousandths higher, at nearly ten times the cost."""
GIVEN_UP = 1e-9
"""Relative safety margin of a threshold for rounding errors."""
ROUNDING = 64 * np.finfo(float).eps
"""Rounding error of ``V`` next to the rub, where its terms cancel, relative to ``p``."""


@dataclass(frozen=True)
class RubNeighbourhood:
    """Set of sliding states that are proven to converge to the synchronous rub.

    Attributes
    ----------
    angle : float
        Angle of the rub in rad.
    level : float
        States with ``V`` below it belong to the neighbourhood.
    rounding : float
        Rounding error of ``V``, by which the level has been lowered.
    limit : {"saddle", "lift-off", "slip"}
        The condition that limits the level.
    friction, strength, phase : float
        ``μ``, ``p`` and ``y₀``.
    """

    angle: float
    level: float
    rounding: float
    limit: str
    friction: float
    strength: float
    phase: float

    @checked
    def value(self, angles: Reals, rates: Reals) -> np.ndarray:
        """``V`` of sliding states: angles in rad, angular speeds in the co-rotating frame in ``Ω``.

        Angles are reduced to the turn between the two saddles.
        """
        low = -math.pi - 2.0 * self.phase
        ahead = np.mod(np.asarray(angles, float) - self.angle - low, 2.0 * math.pi) + low
        weight = np.exp(2.0 * self.friction * ahead)
        potential = rub_potentials(np.ravel(ahead), self.friction, self.strength, self.phase).reshape(ahead.shape)
        return 0.5 * np.asarray(rates, float) ** 2 * weight + potential

    @checked
    def contains(self, angles: Reals, rates: Reals) -> np.ndarray:
        """Whether sliding states (on the wall, without radial speed) belong to it."""
        return self.value(angles, rates) < self.level


@checked
def rub_neighbourhood(machine: Subject) -> RubNeighbourhood | None:
    """Largest proven neighbourhood of the synchronous rub that attracts sliding; ``None`` if there is no such rub."""
    rotor = exact_rotor_of(machine)
    rub = next((entry for entry in find_equilibria(rotor) if entry.attracts_sliding), None)
    return neighbourhood_of(rotor, rub) if rub else None


def neighbourhood_of(rotor: Rotor, rub: Equilibrium) -> RubNeighbourhood | None:
    """Largest proven neighbourhood of a rub that attracts sliding; ``None`` where double precision can prove none."""
    numbers = rotor.parameters
    gamma, mu = numbers.gamma, numbers.mu
    if gamma + 2.0 * mu <= 0.0:
        return None
    strength = largest_excitation(numbers)
    phase = math.remainder(rub.angle - numbers.phi + math.atan(mu), 2.0 * math.pi)
    if math.cos(phase) <= 0.0:
        return None
    low, high = -math.pi - 2.0 * phase, math.pi - 2.0 * phase
    edges = np.linspace(low, high, INTERVALS + 1)
    potential = rub_potentials(edges, mu, strength, phase)
    # The potential falls to zero at the rub and rises from there: its least value on an interval is at an end.
    least = np.minimum(potential[:-1], potential[1:])
    least[(edges[:-1] <= 0.0) & (edges[1:] >= 0.0)] = 0.0
    weight = np.exp(2.0 * mu * edges[:-1])
    middles, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * (high - low) / INTERVALS
    excitation = numbers.omega**2 - numbers.rho * np.cos(middles + phase - math.atan(mu)) + numbers.rho * half
    lifting = np.minimum(0.0, np.sqrt(np.maximum(excitation, 0.0)) - 1.0)
    lifts = np.where(excitation > 0.0, least + 0.5 * lifting**2 * weight, np.inf)
    stops = least + 0.5 * (1.0 + numbers.radius_ratio) ** 2 * weight
    levels = {
        "saddle": float(min(potential[0], potential[-1])),
        "lift-off": float(lifts.min()),
        "slip": float(stops.min()),
    }
    limit = min(levels, key=lambda name: levels[name])
    rounding = GIVEN_UP * levels[limit] + ROUNDING * strength
    if levels[limit] <= 2.0 * rounding:
        return None
    return RubNeighbourhood(rub.angle, levels[limit] - rounding, rounding, limit, mu, strength, phase)
