"""Windows of a parameter in which single-impact orbits are motions of the machine, and what ends each window.

At given values of the parameter all orbits are known in closed form.  Between two neighbours of which only one has an admissible, or a
stable, orbit the end of a window is found by bisection, and what happens there by comparing the orbits of both sides.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Literal, NamedTuple

import numpy as np

from carom.base.arguments import checked
from carom.base.progress import Reporter, ShowProgress
from carom.bifurcations.changes import CHANGED_BY, causes_of_orbits
from carom.bifurcations.conditions import (
    Solution,
    grazing_equations,
    is_admissible,
    orbit_solutions,
    orbits_joined_at,
    spectral_radii,
)
from carom.bifurcations.points import Bifurcation
from carom.models import Edge, Rotor, Span, Subject, axis, exact_rotor_of
from carom.models.axes import paired
from carom.orbits.admissibility import slip_stays_forward
from carom.orbits.single_impact import longest_within_reach

FAR = 1.0
"""Square of the radius beyond the wall from which an orbit is surely virtual."""
NARROW, EXACT = 1e-9, 1e-14
"""Relative widths of the bracket in which the orbits of both sides are compared, and of that in which a window ends."""
SHORT = 1e-3
"""Period, in ``1/Ω``, below which a window of an elastic rotor ends because the period vanishes."""

Level = Literal["orbits", "stable_orbits"]


@dataclass(frozen=True)
class OrbitWindows:
    """Windows of single-impact orbits along one parameter, in ascending order.

    Attributes
    ----------
    parameter : str
    values : tuple of float
        Values at which all orbits were searched.
    possible : tuple of Span
        Windows where some orbit is admissible, stable or not.
    stable : tuple of Span
        Windows where some admissible orbit is stable.
    """

    parameter: str
    values: tuple[float, ...]
    possible: tuple[Span, ...]
    stable: tuple[Span, ...]


class _Place(NamedTuple):
    """All orbits at a value, the admissible ones, and the stable ones of these."""

    value: float
    solutions: list[Solution]
    orbits: list[Solution]
    stable_orbits: list[Solution]
    levitates: bool


@checked
def orbit_windows(
    machine: Subject, parameter: str, values: Sequence[float], progress: ShowProgress = None
) -> OrbitWindows:
    """Find where along a parameter single-impact orbits are motions of the machine.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        The planar rotor, with positive damping at all values.
    parameter : str
        Dimensionless, or physical (in SI units; needs scales).
    values : sequence of float
        Values, in ascending order, at which all orbits are searched.  A window that lies between two of them is missed.
    """
    rotor, tell = exact_rotor_of(machine), Reporter.of(progress, "searching orbits")
    along, places = axis(rotor, parameter), list[_Place]()

    def at(value: float) -> _Place:
        return _place(along.move(rotor, value), value)

    for k, value in enumerate(values):
        places.append(at(value))
        tell((k + 1) / len(values))
    return OrbitWindows(parameter, tuple(values), _windows(places, "orbits", at), _windows(places, "stable_orbits", at))


def _place(rotor: Rotor, value: float) -> _Place:
    longest = longest_within_reach(rotor)
    solutions = orbit_solutions(rotor, longest)
    if not slip_stays_forward(rotor):
        solutions += orbit_solutions(rotor, longest, backward=True)
    found = [each for each in solutions if not _is_far_outside(each) and is_admissible(*each[1:])]
    radii = spectral_radii([each[1:] for each in found])
    stable = [each for each, radius in zip(found, radii, strict=True) if radius < 1.0]
    return _Place(value, solutions, found, stable, abs(rotor.equilibrium) < 1.0)


def _is_far_outside(solution: Solution) -> bool:
    """Whether some samples of the radius lie far beyond the wall.

    This is so for most orbits of long period, soon after the impact.  To find all extrema of their radius would take
    long.
    """
    _, numbers, period, speed = solution
    step = 0.5 / (1.0 + numbers.omega + numbers.gamma)
    times = np.arange(step, min(period, 60.0 * step), step)
    return any(grazing_equations(numbers, period, speed, time)[1] > FAR for time in times)


def _windows(places: Sequence[_Place], level: Level, at: Callable[[float], _Place]) -> tuple[Span, ...]:
    changes = [pair for pair in pairwise(places) if bool(getattr(pair[0], level)) != bool(getattr(pair[1], level))]
    ends = [_end(*pair, level, at) for pair in changes]
    first, last = ([Edge(place.value)] if getattr(place, level) else [] for place in (places[0], places[-1]))
    return paired([*first, *ends, *last])


def _end(low: _Place, high: _Place, level: Level, at: Callable[[float], _Place]) -> Edge:
    """End of a window between two values, and what happens there."""

    def narrowed(low: _Place, high: _Place, width: float) -> tuple[_Place, _Place]:
        while high.value - low.value > width * abs(high.value):
            middle = at(0.5 * (low.value + high.value))
            low, high = (middle, high) if bool(getattr(middle, level)) == bool(getattr(low, level)) else (low, middle)
        return low, high

    low, high = narrowed(low, high, NARROW)
    value = float(np.mean([place.value for place in narrowed(low, high, EXACT)]))
    below, above = ([each[1:] for each in side.solutions] for side in (low, high))
    causes = causes_of_orbits(below, above, low.levitates != high.levitates)
    causes = [each for each in causes if each.kind in CHANGED_BY[level] and each.period > SHORT]
    inside = getattr(low, level) or getattr(high, level)
    if not causes:  # of an elastic rotor
        shortest = min(inside, key=lambda each: each.period)
        return Edge(value, "vanishing-period", shortest.period, shortest.radial_speed, shortest.name)

    def apart(pair: tuple[Bifurcation, Solution]) -> float:
        cause, orbit = pair
        return abs(orbit.period - cause.period) + abs(orbit.radial_speed - cause.radial_speed)

    cause, orbit = min(product(causes, inside), key=apart)
    name = orbits_joined_at(cause.kind, orbit.name)[-1]
    return Edge(value, cause.kind, cause.period, cause.radial_speed, name)
