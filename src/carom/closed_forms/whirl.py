"""Backward whirl in lasting contact, in closed form: when sliding or bouncing becomes rolling, and what that requires.

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

*Rolling in bounces*: how fast a rotor may leave the wall, without slip, so that its bounces certainly fade to rolling.  Between bounces the planar rotor obeys the source paper's (2.13).  With ``u = 1 − r``, the backward angular momentum
``λ = −r²(1 + θ̇)`` about the centre of the bearing, ``x = θ − φ`` and ``γ ≥ 0``,

    u'' = −N,   N = λ²/r³ − ω²r + γu' + ρ cos x,      λ' = −γλ + ρ r sin x.

An impact that stops the slip leaves ``λ = s`` and ``u' = v``.  As long as ``N ≥ n > 0`` the flight rises once and falls once: it
lasts at most ``τ = 2v/n`` and rises to at most ``h = v²/(2n)``, with ``λ`` between ``se^{−γτ} − ρτ`` and ``s + ρτ``, so that
``n = λ_min² − ω² − ρ − 2γv`` holds if the speed does not exceed ``2v``.

*The speed of the return* ``v₁``.  From ``u'u'' = −Nu'`` half of ``v₁² − v²`` is the integral over the depth ``u`` of the excess
of ``N`` at this depth on the way back over that on the way in.  Its part ``γu'`` is not positive.  The others change at the
rates ``2λλ'/r³``, with the ``r`` of the depth, and ``−ρθ̇ sin x``, together by at most ``g = b − 2γλ_min²`` in unit time with
``b = ρ(1 + 3λ_max(1 − h)⁻³)``.  Integrated over time and depth,

    v₁² ≤ v² + 2g ∫u dt,      ∫u dt ≤ hτ.

So bounces of an elastic wall fade if ``g < 0``: damping takes more of the whirl than the unbalance gives back at the least
favourable angle.  With ``d < 1`` it suffices that ``d²(1 + 2gv/n²) < 1``.

*Friction stops the slip again*: until then it has grown to at most ``(γλ_max + ρ)τ``, and friction can stop ``μ(1 + d)v₁``.  In the
same way ``v₁² ≥ v²f²`` with ``f² = 1 − 2(b + 2γλ_max²/(1 − h)³)v/n² − 8γv/n``.

All these conditions are kept by a smaller ``v``.  So if they hold for one bounce they hold for all later ones: the speed falls
to zero, in finite time for ``d < 1``, and along ``e^{−γt}`` or so in infinitely many bounces for ``d = 1``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from carom.base.arguments import checked
from carom.closed_forms.thresholds import (
    largest_excitation,
    mean_rolling_force,
    rolling_condition,
    rolling_damping,
    rolling_friction,
    rolling_stiffness,
    sustaining_speed,
    whirl_damping,
)
from carom.models import Subject, exact_rotor_of
from carom.parameters import Parameters


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
        """Whether there are sliding speeds below that of rolling from which the rotor is certain to run away to rolling."""
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


@checked
def runaway_speed(machine: Subject) -> Runaway:
    """Threshold of the runaway from sliding backward whirl to rolling.

    ``w_c = (γ + √(γ² + 4μ(μω² + ρ√(1 + μ²))))/(2μ)``, the larger root of ``μ(w² − ω²) − γw − ρ√(1 + μ²)``; derived in
    :mod:`carom.closed_forms.whirl`.  With negative damping ``N > 0`` may need a higher speed, ``w² > ω² + ρ``.

    See Also
    --------
    carom.closed_forms.rolling : where the runaway ends

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> print(f"{cm.closed_forms.runaway_speed(machine).average:.9f}")
    1.163219537
    """
    at = exact_rotor_of(machine).parameters
    certain = max(sustaining_speed(at, largest_excitation(at)), math.hypot(at.omega, math.sqrt(at.rho)))
    return Runaway(certain, sustaining_speed(at), at.radius_ratio)


def hastening_speed(machine: Subject) -> float:
    """Speed of whirl in the fixed frame, in ``c_r Ω``, beyond which sliding gains speed for ever; infinite if there is none.

    Without friction ``W' = −γW − ρ sin x``: with ``γ < 0`` the speed ``|W|`` grows wherever it exceeds ``ρ/|γ|``, and contact
    lasts where ``W² > ω² + ρ``.  With friction it grows no further than to where ``μN`` balances the damping.
    """
    at = exact_rotor_of(machine).parameters
    if at.mu > 0.0 or at.gamma >= 0.0:
        return math.inf
    return max(at.rho / -at.gamma, math.hypot(at.omega, math.sqrt(at.rho)))


@checked
def rolling(machine: Subject) -> Rolling:
    """Forces and limits of rolling on the bearing.

    From ``|γ|s + ρ√(1 + μ²) ≤ μ(s² − ω²)`` (see :mod:`carom.closed_forms.whirl`), solved for each parameter in
    :mod:`carom.closed_forms.thresholds`.

    See Also
    --------
    carom.closed_forms.runaway_speed : speed from which a sliding rotor runs away to it

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> cm.closed_forms.rolling(machine).holds
    True
    """
    at = exact_rotor_of(machine).parameters
    force = mean_rolling_force(at)
    return Rolling(
        speed=at.radius_ratio,
        least_force=force - at.rho,
        largest_force=force + at.rho,
        largest_friction=abs(at.gamma) * at.radius_ratio + at.rho,
        needed_friction=rolling_friction(at),
        largest_damping=rolling_damping(at),
        damping_bound=whirl_damping(at),
        largest_stiffness=rolling_stiffness(at),
        holds=force > at.rho and rolling_condition(at) >= 0.0,
    )


HIGHEST = 0.05
"""Height of a bounce up to which bounds are sought."""
HALVINGS = 60
SLOWEST = 1e-9
"""Speed, in ``c_r Ω``, below which no bounce can be distinguished from rolling: if even that is too fast, nothing is proven."""


@checked
def fading_speed(machine: Subject) -> float:
    """Speed off the wall up to which a rotor that an impact has left without slip certainly goes over to rolling.

    From there on friction stops the slip in every impact, every bounce is lower than the one before, and what they approach
    is rolling that lasts; derived in this module.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        The planar rotor.

    Returns
    -------
    float
        In ``c_r Ω``; zero where nothing is proven: where rolling does not last, for negative damping, and for ``d = 1`` unless
        damping outweighs the unbalance.

    See Also
    --------
    carom.closed_forms.rolling : what the bounces fade to
    carom.closed_forms.runaway_speed : speed from which a rotor that slides runs away to rolling

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> print(f"{cm.closed_forms.fading_speed(machine):.6f}")
    18.033539
    """
    at = exact_rotor_of(machine).parameters
    if at.gamma < 0.0 or not rolling(at).holds or not _fades(at, SLOWEST):
        return 0.0
    low, high = SLOWEST, math.sqrt(2.0 * HIGHEST) * at.radius_ratio
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _fades(at, middle) else (low, middle)
    return low * (1.0 - 1e-9)


def _fades(at: Parameters, speed: float) -> bool:
    """Whether a bounce at this speed, and so every later one, is lower than the one before and ends without slip."""
    gamma, rho, d, s = at.gamma, at.rho, at.d, at.radius_ratio
    guess = 0.9 * (s * s - at.omega**2 - rho)
    if guess <= 0.0:
        return False
    longest = 2.0 * speed / guess
    least, most = s * math.exp(-gamma * longest) - rho * longest, s + rho * longest
    push = least**2 - at.omega**2 - rho - 2.0 * gamma * speed
    if least <= 0.0 or push < guess:
        return False
    duration, height = 2.0 * speed / push, 0.5 * speed**2 / push
    if height > HIGHEST:
        return False
    steep = (1.0 - height) ** -3
    swing = rho * (1.0 + 3.0 * most * steep)
    gain = swing - 2.0 * gamma * least**2
    growth = 1.0 + 2.0 * gain * speed / push**2 if gain > 0.0 else 1.0
    share = 1.0 - 2.0 * (swing + 2.0 * gamma * most**2 * steep) * speed / push**2 - 8.0 * gamma * speed / push
    falls = d * d * growth < 1.0 or gain < 0.0
    stops = share > 0.0 and (gamma * most + rho) * duration <= at.mu * (1.0 + d) * math.sqrt(share) * speed
    return falls and growth < 4.0 and stops
