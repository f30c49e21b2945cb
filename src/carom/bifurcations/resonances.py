"""Where curves of Neimark–Sacker bifurcations begin: two multipliers meet at 1 (resonance 1:1) or at −1 (1:2)."""

from __future__ import annotations

import numpy as np

from carom.bifurcations.conditions import conditions_at
from carom.bifurcations.curve_results import Codimension2Point
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import Bifurcation
from carom.continuation.branch import Steps
from carom.continuation.equations import Equations
from carom.parameters import Numbers, Parameters

TURNS = {"resonance-1:1": 1.0, "resonance-1:2": -1.0}
"""Value of the double multiplier at each resonance."""
FROM_RESONANCE = 1e-5
"""Distance of the pair's sum from ±2 at the start of the curve; on some curves it never exceeds 1e-4."""
ARRIVED, ITERATIONS = 1e-10, 20


def beside_resonance(parameters: Parameters, plane: Plane, point: Codimension2Point) -> Bifurcation | None:
    """A point of the Neimark–Sacker curve next to the resonance where it begins; ``None`` outside the plane.

    For the pair of multipliers ``e^{±iα}`` the sum ``2 cos α`` is prescribed; place, period and radial speed are the
    unknowns, found by Newton's method.
    """
    base, place = Numbers.of(parameters), np.array(point.value)
    plane.axes(parameters)
    wanted = TURNS[point.kind] * (2.0 - FROM_RESONANCE)

    def conditions(u: np.ndarray, y: float) -> np.ndarray:
        period, speed, x = u.tolist()
        if not (period > 0.0 and np.isfinite((x, y)).all()):
            return np.full(4, np.nan)
        at = conditions_at(plane.numbers_at(base, x, y), period, speed)
        return np.array([at.closing, at.balance, at.neimark_sacker, at.pair_sum - wanted])

    scales = np.array([1.0, 1.0, *np.maximum(np.abs(place), 0.1 * plane.widths)])
    equations = Equations(conditions, None, scales, Steps())
    unknowns = np.array([point.period, point.radial_speed, *place]) / scales
    for _ in range(ITERATIONS):
        value = equations.value(unknowns)
        if not np.isfinite(value).all():
            return None
        period, speed, x, y = (unknowns * scales).tolist()
        if np.abs(value).max() < ARRIVED:
            lows, highs = np.transpose([plane.first_range, plane.second_range])
            inside = ((lows <= (x, y)) & ((x, y) <= highs)).all()
            return Bifurcation("neimark-sacker", plane.numbers_at(base, x, y), period, speed) if inside else None
        try:
            unknowns -= np.linalg.solve(equations.jacobian(unknowns), value)
        except np.linalg.LinAlgError:
            return None
    return None
