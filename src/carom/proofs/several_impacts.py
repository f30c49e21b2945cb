"""Claims about periodic motions with several impacts a period: those that a search finds are proven one by one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

from flint import arb

from carom.proofs.balls import decided, enclosure_of
from carom.proofs.claims import Claim, claim_of
from carom.proofs.evidence import Evidence, NotShownError
from carom.proofs.krawczyk import found_zero, shown_zero
from carom.proofs.lines import LineNumbers
from carom.proofs.rotor import ProvenRotor
from carom.proofs.seeds import shooting_seeds
from carom.proofs.words import UNKNOWNS, ShootingOrbit, equations_of

MOST_IMPACTS = 24
"""Impacts a period up to which orbits can be proven."""


def several_impact_claims(rotor: ProvenRotor, evidence: Evidence, options: Mapping[str, float | str]) -> list[Claim]:
    """Claims about periodic motions with 2 to ``impacts`` impacts a period, an option."""
    found = evidence.take("orbits", lambda: list(_searched(rotor, int(options["impacts"]))))
    if any(len(entry["centre"]) > 4 * int(options["impacts"]) for entry in found):
        raise NotShownError("the certificate has an orbit with more impacts than its options")
    claims: list[Claim] = []
    known: list[ShootingOrbit] = []
    for number, entry in enumerate(found, 1):
        orbit = _shown(rotor.numbers, f"orbit {number}", entry)
        if any(_same(orbit, other) for other in known):
            raise NotShownError(f"the certificate lists an orbit twice: orbit {number}")
        known.append(orbit)
        claims += _claims_of(f"orbit {number}", orbit)
    return claims


def _searched(rotor: ProvenRotor, impacts: int) -> Iterator[dict[str, Any]]:
    """Centres and widths of boxes with exactly one solution, each orbit once."""
    known: list[ShootingOrbit] = []
    system = partial(equations_of, rotor.numbers)
    for guess in shooting_seeds(rotor.hypotheses, impacts):
        found = found_zero(system, guess)
        if found is None:
            continue
        orbit = _orbit_of(rotor.numbers, found[1])
        if orbit.outward() <= 0 or orbit.repeats() is not False or any(_same(orbit, other) for other in known):
            continue
        known.append(orbit)
        yield found[0]


def _orbit_of(numbers: LineNumbers, balls: Sequence[arb]) -> ShootingOrbit:
    return ShootingOrbit(numbers, tuple(tuple(balls[k : k + 4]) for k in range(0, len(balls), 4)))


def _same(one: ShootingOrbit, other: ShootingOrbit) -> bool:
    """Whether two enclosures may be of one orbit, from whichever impact they begin."""
    count = len(one.impacts)
    if count != len(other.impacts):
        return False
    for shift in range(count):
        turned = [other.impacts[(k + shift) % count] for k in range(count)]
        if all(
            a.overlaps(b) or abs(a - b) < 1e-9
            for x, y in zip(one.impacts, turned, strict=True)
            for a, b in zip(x[1:], y[1:], strict=True)
        ):
            return True
    return False


def _shown(numbers: LineNumbers, name: str, entry: Mapping[str, Any]) -> ShootingOrbit:
    """Enclosure of the orbit of an entry of the evidence."""
    if set(entry) != {"centre", "width"}:
        raise NotShownError(f"the certificate must give a centre and a width of {name}")
    if len(entry["centre"]) % 4 or not 8 <= len(entry["centre"]) <= 4 * MOST_IMPACTS:
        raise NotShownError(f"the certificate has no orbit of 2 to {MOST_IMPACTS} impacts as {name}")
    found = shown_zero(partial(equations_of, numbers), entry)
    if found is None:
        raise NotShownError(f"the certificate does not show {name}")
    return _orbit_of(numbers, found)


def _claims_of(name: str, orbit: ShootingOrbit) -> list[Claim]:
    count = len(orbit.impacts)
    enclosures = {"period": enclosure_of(orbit.period)}
    for number, impact in enumerate(orbit.impacts, 1):
        enclosures |= {f"{what} {number}": enclosure_of(ball) for what, ball in zip(UNKNOWNS, impact, strict=True)}
    repeats = orbit.repeats()
    exists = claim_of(
        name,
        "exists",
        f"The closing conditions of a motion with {count} impacts a period and forward slip have a solution with these values, "
        f"the only one in a box around it, and it is no shorter orbit run several times. Angles count from that of the contact-free equilibrium.",
        1 if repeats is False else 0,
        reason="it may be a shorter orbit run several times",
        enclosures=enclosures,
    )
    return [exists, _admissible_claim(name, orbit), _stable_claim(name, orbit)]


def _admissible_claim(name: str, orbit: ShootingOrbit) -> Claim:
    signs = {"it would meet the wall from outside": orbit.outward()}
    if not orbit.numbers.mu.is_zero():
        signs["friction would stop its slip, or its slip is backward"] = min(map(decided, orbit.slip_after()))
    if min(signs.values()) > 0:
        signs["it would cross the wall between its impacts"] = {True: 1, False: -1, None: 0}[orbit.stays_inside()]
    statement = "It is a motion of the machine: it stays inside the wall strictly between its impacts, and its slip stays forward."
    return _claim_by_signs(name, "admissible", statement, signs)


def _stable_claim(name: str, orbit: ShootingOrbit) -> Claim:
    signs = {reason: decided(margin) for reason, margin in orbit.margins().items()}
    statement = "All three multipliers of the map over a period lie inside the unit circle."
    return _claim_by_signs(name, "stable", statement, signs)


def _claim_by_signs(name: str, kind: str, statement: str, signs: Mapping[str, int]) -> Claim:
    """Claim that needs all signs to be positive, each with the reason why it may not be."""
    sign = min(signs.values())
    words = "; ".join(reason for reason, value in signs.items() if value == sign)
    return claim_of(name, kind, statement, sign, reason=words if sign < 0 else f"open: {words}")
