"""Backward whirl in lasting contact, in closed form: when sliding runs away to rolling, and what rolling requires.

On the wall the planar rotor obeys the components of the source paper's (2.13) along ``e^{iθ}`` and ``ie^{iθ}``.  With
``x = θ − φ``, the whirl speed in the fixed frame ``W = 1 + θ̇`` and the slip velocity ``v = s + W``,

    N = ρ cos x + W² − ω²,      W' = −γW − ρ sin x − μN sgn v,

and contact lasts while ``N > 0``.  Write ``w = −W`` for the speed of backward whirl and ``p = ρ√(1 + μ²)``.

*Sliding slower than rolling* (``w < s``) friction drives the whirl backward, and since ``|sin x + μ cos x| ≤ √(1 + μ²)``

    μ(w² − ω²) − γw − p  ≤  w'  ≤  μ(w² − ω²) − γw + p.

The lower bound is positive beyond its larger root ``w_c``, so from there on the whirl gains speed until it rolls.  There
``μ(w² − ω²) ≥ p`` (for ``γ ≥ 0``), hence ``N ≥ w² − ω² − ρ > 0``: contact cannot be lost.  Averaged over a turn the
unbalance drops out, and the threshold is the larger root for ``ρ = 0``.

*Rolling* (``w = s``) needs the friction force ``F = ρ sin x − γs`` along growing angle and has
``N = s² − ω² + ρ cos x``.  ``|F| ≤ μN`` at every angle is ``|γ|s + p ≤ μ(s² − ω²)``; for ``γ ≥ 0`` that is
``w_c ≤ s``.  Otherwise rolling is interrupted by a slide once a turn, if it lasts at all.

*Sliding faster than rolling* (``w > s``) friction slows the whirl: ``w' ≤ −γw − μ(w² − ω²) + p``.

*Which motions can be periodic*, for ``γ, μ ≥ 0`` and not both zero (``docs/theory/lasting-contact.md`` derives and
checks each step).  With the friction force ``G`` and ``E = ½θ̇² − ρ cos x`` the equation ``W' = −γW − ρ sin x + G``
gives ``E' = −(γW − G)θ̇``.

- A motion that slides with forward slip (``G = −μN``) has ``L' = −(γ + 2μ)θ̇²e^{2μx} ≤ 0`` for
  ``L = ½θ̇²e^{2μx} + ∫(γ + ρ sin x + μ(ρ cos x + 1 − ω²))e^{2μx} dx``.  So if it is periodic without making a turn in
  the co-rotating frame, it is a synchronous rub.
- If it is periodic with a turn instead, ``θ̇`` keeps its sign, as paths in the plane of ``x`` and ``θ̇`` do not cross.
  Over the turn ``∮(γW + μN) dθ = 0``, so the mean of ``γW`` over the angle is that of ``−μN``, below zero.  So apart from the
  synchronous rub there is no steady sliding whirl that is forward all the time, or forward in the mean over the angle.
- Backward whirl (``W < 0`` over the whole turn).  ``γw + G`` has the mean zero over the angle, ``w = −W``.  Let
  ``A = s² − ω²`` and ``γs > μA``.  Where slip is forward or none, ``γw + G ≥ h − μρ cos x`` with
  ``h = γw − μ(w² − ω²) > 0`` on ``0 ≤ w ≤ s``; where it is backward, ``γw + G = γw + μN``, which exceeds ``−μρ cos x``
  by ``γw + μN + μρ cos x > γs − μρ``.  For ``A ≥ ρ`` that is positive, and the mean is too.  For ``A < ρ`` contact at
  ``x = π`` requires ``w > s``, so slip is backward there and ``E ≥ ½(1 + √(ω² + ρ))² + ρ``, more than
  ``½(1 + s)² + ρ``, the most that ``E`` can be where slip turns backward; and ``E`` falls while it is.  So no backward
  whirl in lasting contact sustains itself for ``γ > μ(s² − ω²)/s``.

For lower damping there is a periodic sliding whirl near ``μ(w² − ω²) = γw``, but it is a repeller: the threshold
between runaway and decay.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.models import Jeffcott, Subject, model_of

__all__ = ["Rolling", "Runaway", "rolling", "rub_limit", "runaway_speed"]


@dataclass(frozen=True)
class Runaway:
    """Speed of backward whirl beyond which sliding friction feeds it until the rotor rolls.

    Speeds are ``w = −(1 + θ̇) > 0``: whirl in the fixed frame against the spin, in ``Ω``, and at the same time speed of
    the rotor centre in ``c_r Ω``.

    Attributes
    ----------
    certain : float
        Speed beyond which the whirl runs away from any angle; infinite without friction.
    average : float
        The same with the unbalance averaged over a turn: the threshold of a rotor with little unbalance.
    rolling_speed : float
        Speed at which the runaway ends, ``s``.
    """

    certain: float
    average: float
    rolling_speed: float

    @property
    def reaches_rolling(self) -> bool:
        """Whether there are sliding speeds below rolling from which the rotor surely goes over to rolling."""
        return self.certain < self.rolling_speed


@dataclass(frozen=True)
class Rolling:
    """Rolling on the bearing without slip, in backward whirl at ``1 + θ̇ = −s``.

    Attributes
    ----------
    speed : float
        Whirl speed ``s`` in ``Ω``, backward; speed of the rotor centre in ``c_r Ω``.
    least_force, largest_force : float
        Range of the normal force over a turn, ``s² − ω² ∓ ρ``, in ``m c_r Ω²``.
    largest_friction : float
        Largest friction force it needs, ``|γ|s + ρ``, in ``m c_r Ω²``.
    needed_friction : float
        Smallest coefficient of friction with which it holds; infinite if the rotor would leave the wall.
    largest_damping : float
        ``γ`` up to which it holds at every angle; not positive if friction is too weak for any damping.
    damping_bound : float
        ``γ`` beyond which no backward whirl in lasting contact can sustain itself, ``μ(s² − ω²)/s``, even with sliding
        during a part of each turn.
    largest_stiffness : float
        ``ω`` up to which it holds at every angle; 0 if it holds for no ``ω``.
    holds : bool
        Whether a rotor that rolls keeps rolling.
    """

    speed: float
    least_force: float
    largest_force: float
    largest_friction: float
    needed_friction: float
    largest_damping: float
    damping_bound: float
    largest_stiffness: float
    holds: bool

    @property
    def period(self) -> float:
        """Time of a turn in the co-rotating frame, ``2π/(1 + s)``, in ``1/Ω``."""
        return 2.0 * math.pi / (1.0 + self.speed)


def runaway_speed(machine: Subject) -> Runaway:
    """Threshold of the runaway from sliding backward whirl to rolling.

    ``w_c = (γ + √(γ² + 4μ(μω² + ρ√(1 + μ²))))/(2μ)``, the larger root of ``μ(w² − ω²) − γw − ρ√(1 + μ²)``; derived in
    :mod:`carom.closed_forms.whirl`.  With negative damping ``N > 0`` may need a higher speed, ``w² > ω² + ρ``.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model

    Returns
    -------
    Runaway
    """
    rotor = model_of(machine)
    parameters = rotor.parameters
    pull = parameters.rho * math.hypot(1.0, parameters.mu)
    certain = max(_balance(rotor, pull), math.hypot(parameters.omega, math.sqrt(parameters.rho)))
    return Runaway(certain, _balance(rotor, 0.0), parameters.radius_ratio)


def _balance(rotor: Jeffcott, pull: float) -> float:
    """Larger root of ``μ(w² − ω²) − γw − pull``."""
    gamma, omega, mu = rotor.parameters.gamma, rotor.parameters.omega, rotor.parameters.mu
    if mu == 0.0:
        return math.inf
    gain = 2.0 * mu * omega * omega + 2.0 * pull
    root = math.sqrt(gamma * gamma + 2.0 * mu * gain)
    # The form without cancellation for either sign of the damping.
    return (gamma + root) / (2.0 * mu) if gamma >= 0.0 else gain / (root - gamma)


def rolling(machine: Subject) -> Rolling:
    """Forces and limits of rolling on the bearing.

    From ``|γ|s + ρ√(1 + μ²) ≤ μ(s² − ω²)`` (see :mod:`carom.closed_forms.whirl`): the largest damping
    ``(μ(s² − ω²) − ρ√(1 + μ²))/s``, the largest ``ω² = s² − (|γ|s + ρ√(1 + μ²))/μ``, and the least friction coefficient,
    the root of the same condition, ``μ = (AB + ρ√(A² + B² − ρ²))/(A² − ρ²)`` with ``A = s² − ω²`` and ``B = |γ|s``.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model

    Returns
    -------
    Rolling
    """
    rotor = model_of(machine)
    parameters = rotor.parameters
    rho, mu, speed = parameters.rho, parameters.mu, parameters.radius_ratio
    push = (speed - parameters.omega) * (speed + parameters.omega)
    drag = abs(parameters.gamma) * speed
    pull = rho * math.hypot(1.0, mu)
    square = speed * speed - (drag + pull) / mu if mu > 0.0 else 0.0
    needed = math.inf
    if push > rho:
        root = math.sqrt((push - rho) * (push + rho) + drag * drag)
        needed = (push * drag + rho * root) / ((push - rho) * (push + rho))
    return Rolling(
        speed=speed,
        least_force=push - rho,
        largest_force=push + rho,
        largest_friction=drag + rho,
        needed_friction=needed,
        largest_damping=(mu * push - pull) / speed,
        damping_bound=mu * push / speed,
        largest_stiffness=math.sqrt(max(square, 0.0)),
        holds=push > rho and mu >= needed,
    )


def rub_limit(machine: Subject) -> float:
    """Damping up to which a stable synchronous rub exists, with the other parameters unchanged.

    The normal force ``N`` of a synchronous rub (:func:`~carom.closed_forms.equilibria.find_equilibria`) solves, with ``κ = 1 − ω²``,

        (1 + μ²)N² − 2(κ − μγ)N + κ² + γ² − ρ² = 0.

    Of its roots the larger is stable along the wall.  It is positive inside the disc ``κ² + γ² < ρ²``, and outside it
    where ``γ < κ/μ`` and the roots are real, ``γ + μκ ≤ ρ√(1 + μ²)``.  That line touches the circle at
    ``κ = ρμ/√(1 + μ²)``, ``γ = ρ/√(1 + μ²)``: for larger ``κ`` the rub ends in a fold on the line, for smaller ones its
    force vanishes on the circle, where the contact-free equilibrium reaches the wall.  Above the limit there is no
    stable rub; for positive damping below it there always is one.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model

    Returns
    -------
    float
        ``γ``; not positive if there is no rub with positive damping.
    """
    rotor = model_of(machine)
    parameters = rotor.parameters
    rho, mu = parameters.rho, parameters.mu
    kappa = (1.0 - parameters.omega) * (1.0 + parameters.omega)
    slope = math.hypot(1.0, mu)
    if kappa * slope >= rho * mu:
        return rho * slope - mu * kappa
    return float(np.sqrt(max(rho - kappa, 0.0) * max(rho + kappa, 0.0)))
