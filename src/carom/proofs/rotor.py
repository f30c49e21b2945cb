"""A rotor whose numbers are balls, and the conditions of stability.

The phase ``φ`` only turns motions, so every frame here is turned such that the impact of an orbit is at ``U = 1``.  With
``f(t) = e^{−it}h(t)``, ``h`` the response of the fixed frame to an impulse (:mod:`carom.proofs.steady`), and

    δ(T) = e^{−(γ+2i)T},      D(T) = det(1 − flow over T) = 1 − 2f'(T) − (γ + 2i)f(T) + δ(T),

the levers of the source paper's (4.1) are ``a₁₂ = f/D`` and ``a₂₂ = (f' − δ)/D``, and with ``q = (1 + d)(1 + iμ)``

    F₁ = 1 + Re(q a₂₂),      P = |D|²F₁ = Re((D + q(f' − δ)) D̄).

``P`` is entire and has the zeros of ``F₁`` where ``D`` is not zero, that is everywhere for ``γ > 0``.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Generic, NamedTuple

from flint import arb, ctx

from carom.proofs.balls import N, ball_of, enclosures_of
from carom.proofs.claims import Claim, claim_of
from carom.proofs.hypotheses import NUMBERS, Hypotheses
from carom.proofs.lines import LineNumbers

TOO_LARGE = "the product of its multipliers is 1 or more in modulus"


class Invariants(NamedTuple, Generic[N]):
    """Trace, sum of the principal minors and determinant of the derivative of the impact map on an orbit."""

    trace: N
    minors: N
    determinant: N

    @classmethod
    def of(cls, rows: list[list[N]], determinant: N) -> Invariants[N]:
        """Invariants of a matrix of balls whose determinant is known in closed form."""
        a, b, c = rows
        minors = (a[0] * b[1] - a[1] * b[0]) + (a[0] * c[2] - a[2] * c[0]) + (b[1] * c[2] - b[2] * c[1])
        return cls(a[0] + b[1] + c[2], minors, determinant)

    @property
    def at_one(self) -> N:
        """Characteristic polynomial at 1: zero at a fold."""
        return 1 - self.trace + self.minors - self.determinant

    @property
    def slope_at_one(self) -> N:
        """``3 − 2τ + m``, the derivative of that polynomial at 1: positive if all multipliers are inside the unit circle."""
        return 3 - self.trace * 2 + self.minors

    @property
    def at_minus_one(self) -> N:
        """``det(J + 1)``: zero at a period doubling."""
        return 1 + self.trace + self.minors + self.determinant

    @property
    def of_pairs(self) -> N:
        """Product of ``1 − λⱼλₖ`` over the pairs of multipliers: zero at a Neimark–Sacker bifurcation."""
        return 1 - self.minors + self.determinant * (self.trace - self.determinant)

    @property
    def conditions(self) -> dict[str, N]:
        """Conditions of Schur and Cohn: the orbit is stable if all are positive, unstable for this reason if one is negative."""
        return {
            TOO_LARGE: 1 - self.determinant,
            "a multiplier is above 1": self.at_one,
            "a multiplier is below -1": self.at_minus_one,
            "the product of two multipliers is above 1": self.of_pairs,
        }


class ProvenRotor:
    """Planar rotor whose numbers are balls at the precision at hand.

    Parameters
    ----------
    hypotheses : Hypotheses

    Attributes
    ----------
    bits : int
        Precision.
    numbers : LineNumbers
        The numbers of the equations.
    """

    def __init__(self, hypotheses: Hypotheses) -> None:
        self.hypotheses, self.bits = hypotheses, ctx.prec
        self.numbers = LineNumbers(*(ball_of(hypotheses.numbers[name]) for name in NUMBERS))

    @cached_property
    def on_the_wall(self) -> bool:
        """Whether ``|U*| = 1`` exactly."""
        given = self.hypotheses.rational("gamma", "omega_squared", "rho")
        return given is not None and given[2] ** 2 == (given[1] - 1) ** 2 + given[0] ** 2

    def pole_in(self, period: arb) -> bool:
        """Whether ``D`` is known to vanish once, inside a ball: at a resonance, without damping."""
        if self.hypotheses.rational("gamma") != (Fraction(0),):
            return False
        frequency = self.numbers.omega_squared.sqrt()
        turns = [period * (1 + sign * frequency) / (2 * arb.pi()) for sign in (1, -1)]
        whole = [turn.unique_fmpz() for turn in turns]
        apart = sum(not turn.contains_integer() for turn in turns) == 1
        return apart and any(
            number is not None and period.contains_interior(2 * arb.pi() * number / (1 + sign * frequency))
            for number, sign in zip(whole, (1, -1), strict=True)
        )

    def claim(self, about: str, kind: str, statement: str, sign: int, reason: str = "", **balls: arb) -> Claim:
        """Claim about it, with enclosures of those balls that are bounded; more bits may decide what is undecided of one machine."""
        values, limited = enclosures_of(**balls), self.hypotheses.exact
        return claim_of(about, kind, statement, sign, reason=reason, enclosures=values, limited=limited)
