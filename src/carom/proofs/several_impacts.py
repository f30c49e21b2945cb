"""Claims about periodic motions with several impacts a period: those that a search finds are proven one by one.

They are shot from impact to impact, in forward slip.  The unknowns are, for each impact ``k``, the angle ``θ``, the speeds ``ṙ`` and ``θ̇`` just before it and the time ``T`` of the flight after
it.  The equations say that each flight ends in the state before the next impact.  The frame is turned such that the
contact-free equilibrium is at the real ``|U*|``.  With the velocity ``V`` after an impact and ``S``, ``P``, ``e``, ``o`` of
:mod:`carom.proofs.courses`,

    U' = |U*| + (e − So/2)(U − |U*|) + oV,      V' = −Po(U − |U*|) + (e + So/2)V .
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from flint import acb, arb, arb_mat

from carom.proofs.balls import Ball, ComplexBall, I, conjugate, decided, enclosure_of, imaginary, real, squared
from carom.proofs.claims import Claim, Document, Evidence, NotShownError, claim_of
from carom.proofs.courses import stays_inside
from carom.proofs.lines import LineNumbers
from carom.proofs.rotor import Invariants, ProvenRotor
from carom.proofs.seeds import shooting_seeds
from carom.proofs.zeros import found_zero, shown_zero

UNKNOWNS = ("angle", "radial_speed", "angular_speed", "duration")
"""Unknowns of each impact, in their order."""


def equations_of(n: LineNumbers[arb], *unknowns: Ball) -> list[Ball]:
    """Differences between the end of each flight and the state before the next impact."""
    impacts = [unknowns[k : k + 4] for k in range(0, len(unknowns), 4)]
    found = []
    for here, there in zip(impacts, [*impacts[1:], impacts[0]], strict=True):
        target = (there[0] * I).exp()
        away, velocity = n.fly(*_leaving(n, here), here[3])
        gap, speed = away + n.levitation - target, velocity - (there[1] + there[2] * I) * target
        found += [real(gap), imaginary(gap), real(speed), imaginary(speed)]
    return found


def _leaving(n: LineNumbers[arb], impact: Sequence[Ball]) -> tuple[ComplexBall, ComplexBall]:
    """Distance from the contact-free equilibrium, and velocity, just after an impact."""
    place = (impact[0] * I).exp()
    return place - n.levitation, (impact[1] + impact[2] * I - impact[1] * n.q) * place


@dataclass(frozen=True)
class ShootingOrbit:
    """A solution of the equations.

    Attributes
    ----------
    numbers : LineNumbers
        Balls.
    impacts : tuple of tuple of arb
        Enclosures of :data:`UNKNOWNS`.
    """

    numbers: LineNumbers[arb]
    impacts: tuple[tuple[arb, ...], ...]

    @property
    def period(self) -> arb:
        """Sum of the durations."""
        return sum((impact[3] for impact in self.impacts), arb(0))

    def outward(self) -> int:
        """Sign of the least radial speed and duration, 0 where it is open."""
        if all(impact[1] > 0 and impact[3] > 0 for impact in self.impacts):
            return 1
        return -1 if any(impact[1] < 0 or impact[3] < 0 for impact in self.impacts) else 0

    def slip_after(self) -> list[arb]:
        """Slip velocity after each impact."""
        n = self.numbers
        return [n.radius_ratio + 1 + a - n.mu * (1 + n.d) * r for _, r, a, _ in self.impacts]

    def stays_inside(self) -> bool | None:
        """Whether all flights stay inside the wall, by their radius."""
        found: list[bool | None] = []
        for here, there in zip(self.impacts, [*self.impacts[1:], self.impacts[0]], strict=True):
            found.append(self._flight_inside(here, there))
        return False if False in found else None if None in found else True

    def _flight_inside(self, here: Sequence[arb], there: Sequence[arb]) -> bool | None:
        n, target = self.numbers, (there[0] * I).exp()
        starts = _leaving(n, here), (target - n.levitation, (there[1] + there[2] * I) * target)

        def height(time: Ball, backward: bool) -> Ball:
            return squared(n.fly(*starts[backward], time)[0] + n.levitation) - 1

        return stays_inside(height, height, here[3], (2 * n.d * here[1], 2 * there[1]))

    def jacobian(self) -> arb_mat:
        """Derivative of the map over one period on the section before the first impact, over ``(θ, ṙ, θ̇)``; arb_mat."""
        product = arb_mat(3, 3, [1, 0, 0, 0, 1, 0, 0, 0, 1])
        for here, there in zip(self.impacts, [*self.impacts[1:], self.impacts[0]], strict=True):
            product = self._step(here, there) * product
        return product

    def _step(self, here: Sequence[arb], there: Sequence[arb]) -> arb_mat:
        """Derivative of the impact map, with the change of the time of impact."""
        n, place, target = self.numbers, (here[0] * I).exp(), (there[0] * I).exp()
        local = there[1] + there[2] * I
        velocity = local * target
        force = 2 * n.half * velocity - n.product * (target - n.levitation)
        columns = []
        for away, start in ((I * place, I * _leaving(n, here)[1]), (acb(0), (1 - n.q) * place), (acb(0), I * place)):
            moved, changed = n.fly(away, start, here[3])
            late = -real(conjugate(target) * moved) / there[1]
            turned = imaginary(conjugate(target) * (moved + velocity * late))
            change = conjugate(target) * (changed + force * late) - I * local * turned
            columns.append((turned, real(change), imaginary(change)))
        return arb_mat([[column[row] for column in columns] for row in range(3)])

    def margins(self) -> dict[str, arb]:
        """Conditions of stability (:attr:`~carom.proofs.rotor.Invariants.conditions`)."""
        n = self.numbers
        determinant = n.d ** (2 * len(self.impacts)) * (-2 * n.gamma * self.period).exp()
        return Invariants.of(self.jacobian().tolist(), determinant).conditions

    def repeats(self) -> bool | None:
        """Whether it may be a shorter orbit run several times; ``None`` if this is open, ``False`` if it is not."""
        count = len(self.impacts)
        for shorter in (m for m in range(1, count) if count % m == 0):
            pairs = zip(self.impacts[0][1:], self.impacts[shorter][1:], strict=True)
            if all(one.overlaps(other) for one, other in pairs):
                return None
        return False


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


def _searched(rotor: ProvenRotor, impacts: int) -> Iterator[Document]:
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


def _orbit_of(numbers: LineNumbers[arb], balls: Sequence[arb]) -> ShootingOrbit:
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


def _shown(numbers: LineNumbers[arb], name: str, entry: Document) -> ShootingOrbit:
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
