"""Quadratic forms of the deviation from levitation that fall in flight, and the sets in which contact does not raise them either.

With ``u = z − Λe^{it}`` in the fixed frame, ``g = α − iβ`` and ``k > |g|²``,

    Q = |u̇|² + 2 Re(g ū u̇) + k|u|² = |ξ|² + (k − |g|²)|u|²,      ξ = u̇ + ḡu .

*Flight.*  ``Q̇/2 = −(γ − α)|u̇|² − αω²|u|² + Re((k − ω² − γg) ū u̇)``: negative for all states but levitation if ``0 < α < γ`` and
``|k − ω² − γg|² < 4α(γ − α)ω²``, and never positive where equality is allowed too.

*Contact.*  Turn the plane such that the rotor touches at ``z = 1``, with ``Λ = ℓe^{iψ}`` and the velocity ``v = a + ib``.  There ``ξ = v − v₀`` with
``v₀ = a₀ + ib₀ = −ḡ + (i + ḡ)Λ``.  An impact takes ``(1 + iτ)p``, ``p = (1 + d)a``, from the velocity, with ``|τ| ≤ μ`` whether slip goes on, stops, or is backward.  It changes
``Q`` by

    −2p(−a₀ + τ(b − b₀) + ea),      e = 1 − ½(1 + d)(1 + τ²),

and lasting contact of any kind by the same with ``a = 0`` and ``p = N dt``.  Where ``h = −a₀ > 0``, that is no rise for all ``a ≥ 0`` with

    |ξ|² ≤ K h²,      K = 1 + 1/μ² if e ≥ 0 for τ = μ, else (1 − e)²/(e² + μ²) with that e.

*Trap.*  So no motion leaves the set ``Q ≤ C`` if ``C < (k − |g|²)|1 − Λ|² + K max(h, 0)²`` at all angles ``ψ``; in it ``Q`` falls to zero.

The formulas serve balls as well as arrays of doubles.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from flint import arb

from carom.proofs.lines import Numbers

PARTS = 1024
"""Parts of a turn on which something is shown of all angles."""
_SLIPPERY = 1e-3
"""Friction that a bound for less of it assumes: without any, ``K`` would be infinite."""
_BELOW = 1 - 2.0**-20


class Surface(NamedTuple):
    """The numbers of a rotor at its wall, as balls or as doubles.

    Attributes
    ----------
    gamma, omega_squared, d, ratio : number
        As of the rotor; ``ratio`` is ``s = R/c_r``.
    radius : number
        ``ℓ``.
    grip : number
        ``μ(1 + d)``.
    hold : number
        ``K``.
    """

    gamma: Any
    omega_squared: Any
    d: Any
    ratio: Any
    radius: Any
    grip: Any
    hold: Any

    @classmethod
    def of(cls, n: Numbers) -> Surface:
        """The wall of a rotor whose numbers are balls."""
        friction = n.mu.max(arb(_SLIPPERY))
        e = 1 - (1 + n.d) * (1 + n.mu * n.mu) / 2
        if e >= 0:
            hold = 1 + 1 / (friction * friction)
        else:
            e = e.min(arb(0))
            hold = (1 - e) * (1 - e) / (e * e + friction * friction)
        return cls(n.gamma, n.omega_squared, n.d, n.radius_ratio, n.levitation, n.mu * (1 + n.d), hold)

    def plain(self) -> Surface:
        """The same in doubles."""
        return Surface(*(float(number.mid()) for number in self))

    def after(self, a: Any, b: Any) -> tuple[Any, Any]:
        """Velocity after an impact, in all cases of slip."""
        slip, most = self.ratio + b, self.grip * a
        taken = slip.min(most).max(-most) if isinstance(slip, arb) else np.clip(slip, -most, most)
        return -self.d * a, b - taken


class Form(NamedTuple):
    """A form by ``α``, ``β`` and ``k``: balls, or arrays of doubles for many forms at once."""

    alpha: Any
    beta: Any
    stiffness: Any

    @property
    def rest(self) -> Any:
        """``k − |g|²``."""
        return self.stiffness - self.alpha * self.alpha - self.beta * self.beta

    def slack(self, wall: Surface) -> Any:
        """``4α(γ − α)ω² − |k − ω² − γg|²``: not negative where ``Q`` does not rise in flight."""
        real = self.stiffness - wall.omega_squared - wall.gamma * self.alpha
        turning = wall.gamma * self.beta
        return 4 * self.alpha * (wall.gamma - self.alpha) * wall.omega_squared - real * real - turning * turning

    def falls(self, wall: Surface) -> bool:
        """Whether it falls in flight, of balls."""
        return bool(self.alpha > 0 and wall.gamma > self.alpha and self.slack(wall) > 0 and self.rest > 0)

    def centre(self, wall: Surface, sine: Any, cosine: Any) -> tuple[Any, Any]:
        """``a₀`` and ``b₀`` at an angle ``ψ``."""
        ahead = 1 + self.beta
        return (
            wall.radius * (self.alpha * cosine - ahead * sine) - self.alpha,
            wall.radius * (self.alpha * sine + ahead * cosine) - self.beta,
        )

    def away(self, wall: Surface, cosine: Any) -> Any:
        """``(k − |g|²)|1 − Λ|²``."""
        return self.rest * (1 + wall.radius * wall.radius - 2 * wall.radius * cosine)

    def size(self, wall: Surface, turn: tuple[Any, Any], a: Any, b: Any) -> Any:
        """``Q`` at the wall; ``turn`` holds sine and cosine of ``ψ``."""
        radial, along = self.centre(wall, *turn)
        x, y = a - radial, b - along
        return x * x + y * y + self.away(wall, turn[1])


def angles() -> list[tuple[Any, Any]]:
    """Sines and cosines of the parts of a turn, as balls."""
    width = arb.pi() / PARTS
    return [(width * (2 * k + arb(0, 1))).sin_cos() for k in range(PARTS)]


def level(form: Form, wall: Surface, turns: list[tuple[Any, Any]]) -> Any:
    """A level ``C`` below which a form makes a trap, as a ball without radius."""
    bounds = []
    for sine, cosine in turns:
        inward = (-form.centre(wall, sine, cosine)[0]).lower().max(arb(0))
        bounds.append((form.away(wall, cosine) + wall.hold * inward * inward).lower())
    return (min(bounds) * _BELOW).lower()


def highest(form: Form, wall: Surface, speed: Any, turns: list[tuple[Any, Any]]) -> Any:
    """A bound of a form over all states ``|z| ≤ 1``, ``|ż| ≤ speed``.

    The form is convex in ``(z, ż)``, so its largest value is at ``|z| = 1`` and ``|ż| = speed``, at most ``(speed + |v₀|)² + (k − |g|²)|1 − Λ|²``.
    """
    most = arb(0)
    for sine, cosine in turns:
        a, b = form.centre(wall, sine, cosine)
        reach = speed + (a * a + b * b).sqrt()
        most = most.max((reach * reach + form.away(wall, cosine)).upper())
    return most.upper()
