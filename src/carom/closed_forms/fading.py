"""Rolling in bounces: how fast a rotor may leave the wall, without slip, so that its bounces certainly fade to rolling.

Between bounces the planar rotor obeys the source paper's (2.13).  With ``u = 1 − r``, the backward angular momentum
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

from carom.base.arguments import checked
from carom.closed_forms.whirl import rolling
from carom.models import Subject, exact_rotor_of
from carom.parameters import Parameters

HIGHEST = 0.05
"""Height of a bounce up to which bounds are sought."""
HALVINGS = 60
SLOWEST = 1e-9
"""Speed, in ``c_r Ω``, below which no bounce can be distinguished from rolling: if even that is too fast, nothing is proven."""


@checked
def fading_speed(machine: Subject) -> float:
    """Speed off the wall up to which a rotor that an impact has left without slip certainly goes over to rolling.

    From there on friction stops the slip in every impact, every bounce is lower than the one before, and what they approach
    is rolling that lasts; derived in :mod:`carom.closed_forms.fading`.

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
