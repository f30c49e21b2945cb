"""All solutions of the equations of single-impact orbits at some parameters, admissible or not."""

from __future__ import annotations

from typing import NamedTuple

from carom.bifurcations.axes import Numbers
from carom.bifurcations.conditions import conditions_at
from carom.closed_forms.periods import PeriodCondition
from carom.models import Jeffcott
from carom.orbits.single_impact import radial_speeds
from carom.parameters import Parameters

__all__ = ["Solution", "orbit_solutions"]


class Solution(NamedTuple):
    """A solution, without multipliers and without certified admissibility.

    Attributes
    ----------
    name : str
        Name of the orbit.
    numbers : Numbers
        Parameters; with negative ``mu`` for backward slip.
    period, radial_speed : float
        In ``1/Ω`` and ``c_r Ω``.
    """

    name: str
    numbers: Numbers
    period: float
    radial_speed: float


def orbit_solutions(
    parameters: Parameters, longest_period: float | None = None, *, backward: bool = False
) -> list[Solution]:
    """Solve the equations at all roots of ``F₁`` (:func:`carom.orbits.single_impact.find_orbits`).

    Parameters
    ----------
    parameters : Parameters
    longest_period : float, optional
        Longest period searched, in ``1/Ω``.
    backward : bool
        Whether to solve for orbits with backward slip instead of forward slip.

    Returns
    -------
    list of Solution
        Solutions with a positive radial speed, which meet the wall from inside.
    """
    rotor = Jeffcott(parameters)
    if rotor.equilibrium == 0.0:
        return []
    numbers = Numbers.of(parameters)
    if backward:
        numbers = numbers._replace(mu=-numbers.mu)
    roots = PeriodCondition(rotor.system, -1 if backward else 1).roots(longest_period)
    found = []
    for place, period in enumerate(roots.periods.tolist(), start=int(roots.starts_below)):
        pair, longer = divmod(place, 2)
        speeds = radial_speeds(rotor, conditions_at(numbers, period, 0.0).lever)
        for high, speed in enumerate(speeds):
            if speed > 0.0:
                name = f"{'R' if backward else 'B'}{pair + 1},{'abcd'[longer + 2 * high]}"
                found.append(Solution(name, numbers, period, speed))
    return found
