r"""Exact relations between restitution and what a compliant wall dissipates, of a free mass that it throws back.

A mass ``m`` meets the wall at the speed ``v``; nothing else acts on it.  ``δ`` is its indentation, positive in contact,
and the restitution ``d`` is the share of ``v`` with which it leaves.  The wall pushes and never pulls.

*Kelvin–Voigt*, ``m δ̈ = −kδ − cδ̇``.  With ``ω₀ = √(k/m)``, ``ζ = c/(2√(km)) = cos ψ`` and ``λ = ω₀e^{i(π−ψ)}``,

    δ = (v/(ω₀ sin ψ)) Im e^{λt},      δ̇ = (v/(ω₀ sin ψ)) Im λe^{λt},      kδ + cδ̇ = −(mv/(ω₀ sin ψ)) Im λ²e^{λt}.

The contact ends where the *force* vanishes, as a wall cannot pull: at ``ω₀t sin ψ = 2ψ``, while the wall is still indented.
There ``δ̇ = −ve^{−ζω₀t}``, so with ``f(ζ) = ψ/sin ψ``

    d = e^{−2ζf(ζ)},      f(ζ) = acos ζ/√(1 − ζ²).

(Where ``δ`` vanishes instead the wall has pulled, and ``d = e^{−πζ/√(1 − ζ²)}`` is another number: zero for ``ζ ≥ 1``.)  Above
critical damping ``ψ`` is imaginary and ``f = acosh ζ/√(ζ² − 1)``.  In terms of ``h = (1 − ζ)/2``, which has no rounding error
near critical damping, ``f = asin√h/√(h(1 − h))``, and ``asinh√−h/√(−h(1 − h))`` where it is negative.  ``f`` falls from
``π/2`` to 1 at ``ζ = 1``; ``ζf`` grows, and with ``u = acosh ζ`` it is ``u coth u``, between ``u`` and ``u + 1``.  So with
``l = −ln d`` the damping ratio is between ``l/π`` and ``l/2`` for ``l ≤ 2``, else between ``e^{l/2−1}/2`` and ``e^{l/2}``.

*Hunt–Crossley*, ``m δ̈ = −kδⁿ(1 + χδ̇)``.  With ``u = δ̇`` it separates, ``mu du/(1 + χu) = −kδⁿ dδ``.  The integral over
``δ`` is the same on the way in and out, whatever ``k`` and ``n`` are, so with ``p = χv`` and ``q = dp``

    p − ln(1 + p) = −q − ln(1 − q),      thus      ln[(1 + χv)/(1 − χdv)] = χ(1 + d)v.

``q < 1``: the force never needs to be clipped, and contact ends where ``δ`` does.  Call either side ``s = p + q``; then
``(1 + p)/(1 − q) = e^s``, and both follow from ``s``:

    p = (s − 1 + e^{−s})/(1 − e^{−s}),      d = (1 − (1 + s)e^{−s})/(s − 1 + e^{−s}),
    (1 − d)/d = (s − 2 + (s + 2)e^{−s})/(1 − (1 + s)e^{−s}).

Times ``e^s`` the three sums are ``Σ sᵏ/k!``, ``Σ (k − 1)sᵏ/k!`` and ``Σ (k − 2)sᵏ/k!`` from ``k = 2`` on, without cancellation
for small ``s``.  As ``q ≤ p`` and ``q < 1``, ``s`` is between ``p`` and both ``2p`` and ``p + 1``.  The last quotient is
between ``s/3`` and ``s``: ``2eˢ − (s² + 2s + 2)`` and ``(2s − 6)eˢ + s² + 4s + 6`` have no negative coefficient.

Often used in place of these, and wrong by as much as ``1 − d`` grows: ``χv = 3(1 − d)/2`` (Hunt and Crossley; its wall of
"0.76" restitutes 0.80573) and ``χv = 3(1 − d²)/4`` (Lankarani and Nikravesh; "0.5" restitutes 0.7252).  They are not offered.
"""

from __future__ import annotations

import math
from typing import Annotated

from carom.base.arguments import ArgumentKind, Positive, checked
from carom.base.roots import bracketed_root

Restitution = Annotated[float, ArgumentKind(lambda number: 0.0 < number <= 1.0, "a number above 0, at most 1")]

SMALL = 2.0
"""Sum ``s`` below which the series are summed; above it the closed forms lose no more than a digit."""
_RECIPROCALS = tuple(1.0 / math.factorial(k) for k in range(2, 30))
"""``1/k!``: the last term of the series is far below rounding up to ``SMALL``."""


# ------------------------------------------------------------------------------------------------ Kelvin–Voigt


def half_contact(damping_ratio: float) -> float:
    """``f(ζ) = acos ζ/√(1 − ζ²)``: half of the time of contact, and the time of the deepest point, in ``√(m/k)``."""
    half = 0.5 * (1.0 - damping_ratio)
    root = math.sqrt(abs(half))
    if root == 0.0:
        return 1.0
    return (math.asin(root) if half > 0.0 else math.asinh(root)) / (root * math.sqrt(1.0 - half))


@checked
def damping_ratio_of(restitution: Restitution) -> float:
    """Damping ratio of the Kelvin–Voigt wall without tension that restitutes a free mass as stated.

    Parameters
    ----------
    restitution : float
        ``d``; zero would take infinite damping and is refused.

    Returns
    -------
    float
        ``ζ = c/(2√(km))`` with the mass ``m`` of that body: the root of ``ln d = −2ζf(ζ)``, derived in :mod:`carom.parameters.restitution`.

    Raises
    ------
    InputError
        The restitution is not above 0 and at most 1.

    See Also
    --------
    carom.parameters.restitution.dissipation_of : the same of a Hunt–Crossley wall

    Examples
    --------
    >>> from carom.parameters.restitution import damping_ratio_of
    >>> round(damping_ratio_of(0.95), 7)
    0.0164982
    """
    loss = -math.log(restitution)
    if loss == 0.0:
        return 0.0
    low, high = (
        (loss / math.pi, loss / 2.0) if loss <= 2.0 else (math.exp(loss / 2.0 - 1.0) / 2.0, math.exp(loss / 2.0))
    )
    # A rounding error more on both sides, as the bounds meet for small and for critical damping.
    margin = 1e-12
    return bracketed_root(
        lambda ratio: 2.0 * ratio * half_contact(ratio) - loss, low * (1.0 - margin), high * (1.0 + margin)
    )


# ------------------------------------------------------------------------------------------------ Hunt–Crossley


@checked
def dissipation_of(restitution: Restitution, speed: Positive) -> float:
    """Dissipation of the Hunt–Crossley wall that restitutes a free mass as stated at one speed.

    Parameters
    ----------
    restitution : float
        ``d``; zero would take infinite dissipation and is refused.
    speed : float
        Speed ``v`` of the impact at which the wall restitutes this share: slower impacts give back more, faster ones less.

    Returns
    -------
    float
        ``χ``, in the unit of one over the speed: the root of ``ln[(1 + χv)/(1 − χdv)] = χ(1 + d)v``, derived in :mod:`carom.parameters.restitution`.

    Raises
    ------
    InputError
        The restitution is not above 0 and at most 1, or the speed not positive.

    See Also
    --------
    carom.parameters.restitution.damping_ratio_of : the same of a Kelvin–Voigt wall

    Examples
    --------
    >>> from carom.parameters.restitution import dissipation_of
    >>> round(dissipation_of(0.95, 2.0), 7)
    0.0394633
    """
    loss = (1.0 - restitution) / restitution
    if loss == 0.0:
        return 0.0
    total = bracketed_root(lambda s: _relative_loss(s) - loss, loss * (1.0 - 1e-12), 3.0 * loss * (1.0 + 1e-12))
    return _product(total) / speed


def _product(s: float) -> float:
    """``p = χv`` of a sum ``s``."""
    if s < SMALL:
        return s * (s / math.expm1(s)) * _series(s, 1)
    return (s - 1.0 + math.exp(-s)) / -math.expm1(-s)


def _relative_loss(s: float) -> float:
    """``(1 − d)/d`` of a sum ``s``."""
    if s < SMALL:
        return _series(s, 2) / _series(s)
    return (s - 2.0 + (s + 2.0) * math.exp(-s)) / (1.0 - (1.0 + s) * math.exp(-s))


def _series(s: float, drop: int | None = None) -> float:
    """``Σ s^{k−2}/k!`` from ``k = 2`` on; with ``drop`` each term ``k − drop`` times."""
    total = 0.0
    for k in range(len(_RECIPROCALS) + 1, 1, -1):
        total = total * s + _RECIPROCALS[k - 2] * (1.0 if drop is None else k - drop)
    return total
