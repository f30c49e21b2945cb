"""Where curves of Neimark–Sacker bifurcations begin: two multipliers meet at 1 (resonance 1:1) or at −1 (1:2)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom.bifurcations.axes import Numbers
from carom.bifurcations.conditions import conditions_at
from carom.bifurcations.curves import Codimension2Point
from carom.bifurcations.passing import Cause
from carom.bifurcations.planes import Plane
from carom.parameters import Parameters

__all__ = ["TURNS", "beside_resonance"]

TURNS = {"resonance-1:1": 1.0, "resonance-1:2": -1.0}
"""Value of the double multiplier at each resonance."""
ASIDE = 1e-5
"""Distance of the pair's sum from ±2 at the start of the curve; on some curves it never exceeds 1e-4."""
ARRIVED, ITERATIONS = 1e-10, 20
DIFFERENCE = 6e-6
"""Step of central differences: the cube root of the rounding error."""


def beside_resonance(
    parameters: Parameters, plane: Plane, point: Codimension2Point
) -> tuple[tuple[float, float], Cause] | None:
    """A point of the Neimark–Sacker curve next to the resonance where it begins.

    For the pair of multipliers ``e^{±iα}`` the sum ``2 cos α`` is prescribed; place, period and radial speed are the
    unknowns.

    Returns
    -------
    tuple or None
        Place and bifurcation; ``None`` if there is none in the plane.
    """
    base = Numbers.of(parameters)
    first, second = plane.axes(parameters)
    sizes = np.array([*plane.widths, point.period, max(abs(point.radial_speed), 0.1)])
    wanted = TURNS[point.kind] * (2.0 - ASIDE)

    def residual(scaled: np.ndarray) -> np.ndarray:
        x, y, period, speed = (scaled * sizes).tolist()
        if not period > 0.0:
            return np.full(4, np.nan)
        at = conditions_at(second.set(first.set(base, x), y), period, speed)
        return np.array([at.closing, at.balance, at.neimark_sacker, at.pair_sum - wanted])

    start = np.array([*point.value, point.period, point.radial_speed]) / sizes
    found = _newton(residual, start)
    if found is None:
        return None
    x, y, period, speed = (found * sizes).tolist()
    lows, highs = np.transpose([plane.first_range, plane.second_range])
    inside = ((lows <= (x, y)) & ((x, y) <= highs)).all()
    return ((x, y), Cause("neimark-sacker", period, speed)) if inside else None


def _newton(residual: Callable[[np.ndarray], np.ndarray], guess: np.ndarray) -> np.ndarray | None:
    """Root of a function by Newton's method with central differences; ``None`` if it does not converge."""
    shifts = DIFFERENCE * np.eye(len(guess))
    for _ in range(ITERATIONS):
        value = residual(guess)
        if not np.isfinite(value).all():
            return None
        if np.abs(value).max() < ARRIVED:
            return guess
        slopes = [(residual(guess + shift) - residual(guess - shift)) / (2.0 * DIFFERENCE) for shift in shifts]
        try:
            guess = guess - np.linalg.solve(np.transpose(slopes), value)
        except np.linalg.LinAlgError:
            return None
    return None
