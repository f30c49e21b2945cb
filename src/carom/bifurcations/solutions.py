"""All solutions of the equations of single-impact orbits at some parameters, admissible or not."""

from __future__ import annotations

from typing import NamedTuple

from carom.closed_forms.periods import PeriodCondition
from carom.models import Subject, jeffcott_of
from carom.orbits.names import OrbitName
from carom.orbits.single_impact import orbits_of_roots
from carom.parameters import Numbers


class Solution(NamedTuple):
    """A solution, without multipliers and without certified admissibility."""

    name: OrbitName
    numbers: Numbers
    """Parameters; with negative ``mu`` for backward slip."""
    period: float
    radial_speed: float
    """In ``1/Ω`` and ``c_r Ω``."""


def orbit_solutions(machine: Subject, longest_period: float | None = None, *, backward: bool = False) -> list[Solution]:
    """Solve the equations at all roots of ``F₁`` up to a longest period, in ``1/Ω``, with forward or backward slip.

    Only solutions with a positive radial speed, which meet the wall from inside; see
    :func:`carom.orbits.single_impact.find_orbits`.
    """
    rotor = jeffcott_of(machine)
    if rotor.equilibrium == 0.0:
        return []
    numbers = Numbers.of(rotor.parameters)
    if backward:
        numbers = numbers._replace(mu=-numbers.mu)
    roots = PeriodCondition.planar(rotor.parameters, -1 if backward else 1).roots(longest_period)
    periods: list[float] = roots.periods.tolist()
    orbits = orbits_of_roots(rotor, roots, -1 if backward else 1)
    return [Solution(name, numbers, periods[root], speed) for name, root, speed in orbits if speed > 0.0]
