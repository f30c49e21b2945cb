"""Where curves of Neimark–Sacker bifurcations begin: two multipliers meet at 1 (resonance 1:1) or at −1 (1:2)."""

from __future__ import annotations

import numpy as np

from carom.bifurcations.conditions import conditions_at
from carom.bifurcations.curves import Codimension2Point
from carom.bifurcations.derivatives import orbit_jacobian
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import Bifurcation
from carom.parameters import Numbers, Parameters

TURNS = {"resonance-1:1": 1.0, "resonance-1:2": -1.0}
"""Value of the double multiplier at each resonance."""
ASIDE = 1e-5
"""Distance of the pair's sum from ±2 at the start of the curve; on some curves it never exceeds 1e-4."""
ARRIVED, ITERATIONS = 1e-10, 20


def beside_resonance(parameters: Parameters, plane: Plane, point: Codimension2Point) -> Bifurcation | None:
    """A point of the Neimark–Sacker curve next to the resonance where it begins; ``None`` outside the plane.

    For the pair of multipliers ``e^{±iα}`` the sum ``2 cos α`` is prescribed; place, period and radial speed are the
    unknowns, found by Newton's method.
    """
    base = Numbers.of(parameters)
    plane.axes(parameters)
    wanted = TURNS[point.kind] * (2.0 - ASIDE)

    def numbers_at(x: float, y: float) -> Numbers:
        return plane.numbers_at(base, x, y)

    period, speed, place = point.period, point.radial_speed, point.value
    for _ in range(ITERATIONS):
        if not (period > 0.0 and np.isfinite(place).all()):
            return None
        numbers = numbers_at(*place)
        at = conditions_at(numbers, period, speed)
        value = [at.closing, at.balance, at.neimark_sacker, at.pair_sum - wanted]
        if np.abs(value).max() < ARRIVED:
            lows, highs = np.transpose([plane.first_range, plane.second_range])
            inside = ((lows <= place) & (place <= highs)).all()
            return Bifurcation("neimark-sacker", numbers, period, speed) if inside else None
        slopes = orbit_jacobian(numbers_at, place, period, speed, ("neimark-sacker", "pair-sum"))
        try:
            change = np.linalg.solve(slopes, value)
        except np.linalg.LinAlgError:
            return None
        period, speed, x, y = np.subtract([period, speed, *place], change).tolist()
        place = x, y
    return None
