"""The synchronous rub of the larger normal force: what acts along the wall on a motion next to it.

With ``δ = x − x*``, ``y = θ̇``, ``k = 2μ`` and ``T(δ) = K sin δ − (γ + μκ)(cos δ − 1)`` a slide obeys ``y' = −(γ + k)y − μy² − T``, and

    V = ½y²e^{kδ} + Π(δ),      Π = ∫₀^δ T(ξ)e^{kξ}dξ,      V' = −(γ + k)y²e^{kδ}.

Let ``T(A) > 0 > T(−A)`` with ``A ≤ π/2``, and ``c`` be the less of ``Π(±A)``.  Where ``V < c`` and ``|δ| ≤ A`` no slide gets out, and
``|y| ≤ √(2c)e^{μA}``.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb

from carom.proofs.lines import LineNumbers
from carom.proofs.steady import rub_balance, rub_discriminant


@dataclass(frozen=True)
class Rub:
    """The stable rub: numbers of the machine, its normal force ``N*`` and its stiffness ``K`` along the wall."""

    numbers: LineNumbers
    force: arb
    stiffness: arb

    @classmethod
    def of(cls, n: LineNumbers) -> Rub:
        """That of the larger normal force."""
        root = rub_discriminant(n).sqrt()
        return cls(n, (rub_balance(n) + root) / (1 + n.mu * n.mu), root)

    @property
    def exists(self) -> bool:
        """Whether there is one that presses on the wall."""
        return bool(self.stiffness > 0 and self.force > 0)

    def torque(self, off: arb) -> arb:
        """``T(δ)``."""
        return self.stiffness * off.sin() - self._push * (off.cos() - 1)

    def torque_slope(self, off: arb) -> arb:
        """``T'(δ)``."""
        return self.stiffness * off.cos() + self._push * off.sin()

    @property
    def place(self) -> tuple[arb, arb]:
        """``ρ cos x*`` and ``ρ sin x*``."""
        n = self.numbers
        return self.force - 1 + n.omega_squared, -n.gamma - n.mu * self.force

    def potential(self, off: arb) -> arb:
        """``Π(δ)``."""
        rate = 2 * self.numbers.mu
        growth, below = (rate * off).exp(), 1 + rate * rate
        sine = (growth * (rate * off.sin() - off.cos()) + 1) / below
        cosine = (growth * (rate * off.cos() + off.sin()) - rate) / below
        whole = off if rate.is_zero() else (rate * off).expm1() / rate
        return self.stiffness * sine - self._push * (cosine - whole)

    @property
    def _push(self) -> arb:
        n = self.numbers
        return n.gamma + n.mu * (1 - n.omega_squared)
