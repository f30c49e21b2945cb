"""By how much a parameter of a box of rotors moves their flights: derivatives of the waves of :mod:`carom.proofs.patches` in balls.

With ``a = γ/2``, ``D = a² − ω²``, ``e = cosh(√D t)`` and ``o = sinh(√D t)/√D`` the responses are ``h₁ = e^{−at} o`` and ``h₀ = ḣ₁ + γh₁``, and

    ∂e/∂D = t o/2,      ∂o/∂D = (t e − o)/(2D),      dD = (γ/2) dγ − dω² .

Equations are differentiated, not the waves' balls, so that a box of rotors is bounded by what its parameters do and not by how often they are
written.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from flint import arb, arb_series

from carom.proofs.balls import hyperbolic
from carom.proofs.lines import LineNumbers

_NEAR = 0.25
"""``|D t²|`` below which ``t e − o`` would cancel."""
_FACTORS = [arb(k) / arb(2 * k + 1).fac() for k in range(1, 10)]
_LEFT_OUT = 2.0**-80
"""More than ``z¹⁰`` less nine powers of it leaves out: ``2·10/21!``, as each term is less than half the one before."""


class Side(NamedTuple):
    """Derivatives by a parameter, times half its width, on all of a box.

    Attributes
    ----------
    gamma, omega_squared, radius, restitution, grip, rim : arb
        Of ``γ``, ``ω²``, ``|U*|``, ``d``, ``μ(1 + d)`` and the rotor's radius in clearances.
    """

    gamma: arb
    omega_squared: arb
    radius: arb
    restitution: arb
    grip: arb
    rim: arb

    @classmethod
    def of(cls, numbers: LineNumbers[arb_series]) -> Side:
        """From numbers that are power series of two terms, the second one by half the width of the parameter."""
        n = numbers
        apart = ((n.omega_squared - 1) * (n.omega_squared - 1) + n.gamma * n.gamma).sqrt()
        found = n.gamma, n.omega_squared, n.rho / apart, n.d, n.mu * (1 + n.d), n.radius_ratio
        return cls(*(x[1] if isinstance(x, arb_series) else arb(0) for x in found))


class Responses(NamedTuple):
    """``h₀``, ``h₁`` and their rates at a time, differentiated by one parameter."""

    place: arb
    push: arb
    place_rate: arb
    push_rate: arb


def responses_by(numbers: LineNumbers[arb], sides: Sequence[Side], time: arb) -> list[Responses]:
    """The derivatives by each parameter at a time, or on an interval of times."""
    half, split, gamma, stiff = numbers.gamma / 2, numbers.split, numbers.gamma, numbers.omega_squared
    even, odd = hyperbolic(split, time)
    fade = (-half * time).exp()
    push, push_rate = fade * odd, fade * (even - half * odd)
    odd_by = _odd_by_split(split, time, even, odd)
    even_by = time * odd / 2
    found = []
    for side in sides:
        by_split = half * side.gamma - side.omega_squared
        slow = side.gamma / 2
        h = fade * odd_by * by_split - slow * time * push
        dh = fade * ((even_by - half * odd_by) * by_split - slow * odd) - slow * time * push_rate
        c = dh + side.gamma * push + gamma * h
        dc = -side.omega_squared * push - stiff * h
        found.append(Responses(c, h, dc, dh))
    return found


def _odd_by_split(split: arb, time: arb, even: arb, odd: arb) -> arb:
    """``∂o/∂D``; where ``t e − o`` would cancel as ``t³ Σ k z^{k−1}/(2k + 1)!``, ``z = D t²``."""
    square = split * time * time
    if not abs(square) < _NEAR:
        return (time * even - odd) / (2 * split)
    total = arb(0, _LEFT_OUT)
    for factor in reversed(_FACTORS):
        total = total * square + factor
    return total * time * time * time
