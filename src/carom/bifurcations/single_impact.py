"""Special points of branches of orbits with one impact a period, as the closed form describes them."""

from __future__ import annotations

from carom.bifurcations.conditions import conditions_at, margins_of, name_of, orbits_joined_at, profile_at
from carom.bifurcations.points import Bifurcation
from carom.parameters import Numbers

EMERGING = 1e-4
"""Time of a maximum, in periods, below which its height is only rounding: the height grows with the cube of the time."""
SMALL = 1e-4
"""Radial speed of the orbit that represents those shrinking to a point."""


def special_orbit(
    kind: str, numbers: Numbers, pair: int, period: float, speed: float, parameter: str, place: float
) -> Bifurcation | None:
    """Special point from the parameters, the pair, the period and the radial speed of its orbit; ``None`` if it is none.

    Of the folds, those of two radial speeds of one period are distinguished from those of two periods.  Without rebound a maximum of the
    radius emerges from the impact, with its height zero, as lasting contact begins: no grazing.
    """
    at = numbers, period, speed
    if kind == "grazing" and not profile_at(*at).top > EMERGING * period:
        return None
    if kind == "fold":
        conditions = conditions_at(*at)
        kind = "speed-fold" if abs(conditions.speed_fold) < abs(conditions.period_fold) else kind
    name = orbits_joined_at(kind, name_of(numbers, pair, period, speed))[-1]
    value, admissible = numbers.value(parameter), _bounds_admissible(kind, *at)
    return Bifurcation(kind, *at, name, parameter, value, admissible, place=place)


def _bounds_admissible(kind: str, numbers: Numbers, period: float, speed: float) -> bool:
    """Whether the orbits on at least one side of a special point are motions of the machine."""
    if kind == "non-smooth-hopf":
        speed = SMALL
    slips = kind == "slip-stop" or margins_of(numbers, period, speed)["slip-stop"] > 0.0
    # At the onset of lasting contact the radius may have a maximum of zero height next to the impact.
    slack = 1e-9 if kind == "contact-onset" else 0.0
    inside = kind == "grazing" or not profile_at(numbers, period, speed).height >= slack
    return speed > 0.0 and slips and inside
