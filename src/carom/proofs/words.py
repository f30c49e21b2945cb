"""Periodic motions with several impacts a period, in forward slip: shooting from impact to impact.

The unknowns are, for each impact ``k``, the angle ``θ``, the speeds ``ṙ`` and ``θ̇`` just before it and the time ``T`` of the flight after
it.  The equations say that each flight ends in the state before the next impact.  The frame is turned such that the
contact-free equilibrium is at the real ``|U*|``.  With the velocity ``V`` after an impact and ``S``, ``P``, ``e``, ``o`` of
:mod:`carom.proofs.courses`,

    U' = |U*| + (e − So/2)(U − |U*|) + oV,      V' = −Po(U − |U*|) + (e + So/2)V .
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flint import acb, arb, arb_mat

from carom.proofs.flights import stays_inside
from carom.proofs.lines import LineNumbers
from carom.proofs.rotor import Invariants
from carom.proofs.series import Ball, I, conjugate, imaginary, real, squared

UNKNOWNS = ("angle", "radial_speed", "angular_speed", "duration")
"""Unknowns of each impact, in their order."""


def equations_of(n: LineNumbers, *unknowns: Ball) -> list[Ball]:
    """Differences between the end of each flight and the state before the next impact."""
    impacts = [unknowns[k : k + 4] for k in range(0, len(unknowns), 4)]
    found = []
    for here, there in zip(impacts, [*impacts[1:], impacts[0]], strict=True):
        target = (there[0] * I).exp()
        away, velocity = n.fly(*_leaving(n, here), here[3])
        gap, speed = away + n.levitation - target, velocity - (there[1] + there[2] * I) * target
        found += [real(gap), imaginary(gap), real(speed), imaginary(speed)]
    return found


def _leaving(n: LineNumbers, impact: Sequence[Any]) -> tuple[Any, Any]:
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

    numbers: LineNumbers
    impacts: tuple[tuple[Any, ...], ...]

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

    def _flight_inside(self, here: Sequence[Any], there: Sequence[Any]) -> bool | None:
        n, target = self.numbers, (there[0] * I).exp()
        starts = _leaving(n, here), (target - n.levitation, (there[1] + there[2] * I) * target)

        def height(time: Any, backward: bool) -> Any:
            return squared(n.fly(*starts[backward], time)[0] + n.levitation) - 1

        return stays_inside(height, height, here[3], (2 * n.d * here[1], 2 * there[1]))

    def jacobian(self) -> arb_mat:
        """Derivative of the map over one period on the section before the first impact, over ``(θ, ṙ, θ̇)``; arb_mat."""
        product = arb_mat(3, 3, [1, 0, 0, 0, 1, 0, 0, 0, 1])
        for here, there in zip(self.impacts, [*self.impacts[1:], self.impacts[0]], strict=True):
            product = self._step(here, there) * product
        return product

    def _step(self, here: tuple[arb, arb, arb, arb], there: tuple[arb, arb, arb, arb]) -> arb_mat:
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

    def margins(self) -> dict[str, Any]:
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
