"""Bifurcation points of levitation and of synchronous rubs along a parameter: their equations, and what happens there."""

from __future__ import annotations

from typing import Any

from flint import arb_series

from carom.proofs.balls import decided, enclosure_of
from carom.proofs.claims import Claim, claim_of
from carom.proofs.lines import Line
from carom.proofs.series import terms

_BALANCES = {
    1: (
        "non-smooth fold",
        "It is a non-smooth fold: a synchronous rub, a saddle along the wall, exists on the side where the rotor levitates.",
    ),
    -1: (
        "persistence",
        "It is persistence: a synchronous rub pressed on the wall exists where the contact-free equilibrium is outside.",
    ),
    0: ("kind", "It is a non-smooth fold or persistence."),
}


def boundary(line: Line, value: Any) -> tuple[Any, ...]:
    """``|U*|² = 1``, without the common denominator."""
    n = line.at(value)
    return ((n.omega_squared - 1) * (n.omega_squared - 1) + n.gamma * n.gamma - n.rho * n.rho,)


def rub_fold(line: Line, value: Any) -> tuple[Any, ...]:
    """Discriminant of the two synchronous rubs."""
    n = line.at(value)
    pull = n.gamma + n.mu * (1 - n.omega_squared)
    return (n.rho * n.rho * (1 + n.mu * n.mu) - pull * pull,)


def steady_claims(line: Line, kind: str, label: str, value: Any) -> list[Claim]:
    """Claims about transversality and about the motions on both sides of a point of a kind.

    ``label`` is the motion that the point belongs to, ``value`` a ball that encloses the point.
    """
    equations = boundary if kind == "boundary-equilibrium" else rub_fold
    with terms(2):
        slope = equations(line, arb_series([value, 1]))[0][1]
    transversal = claim_of(
        kind,
        f"of {label} transversal",
        f"The condition vanishes with this slope by {line.name}, which is not zero.",
        abs(decided(slope)),
        reason="the sign of the slope is open",
        enclosures={"slope": enclosure_of(slope)},
        limited=False,
    )
    if kind == "rub-fold":
        return [transversal]
    n = line.at(value)
    balance = 1 - n.omega_squared - n.mu * n.gamma
    sign = decided(balance)
    words, statement = _BALANCES[sign]
    values = {"balance": enclosure_of(balance)}
    nature = claim_of(
        kind,
        f"of {label} {words}",
        statement,
        abs(sign),
        reason="this is open",
        enclosures=values,
        limited=False,
    )
    return [transversal, nature]
