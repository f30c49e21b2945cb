"""Intervals of probabilities that were seen in a sample."""

from __future__ import annotations

import math

from carom.arguments import Whole, checked
from carom.outcome import InputError

CONFIDENCE = 0.95
_HALVINGS = 60
_SMALL = 1e-300


@checked
def exact_interval(count: Whole, total: Whole) -> tuple[float, float]:
    """Interval that contains a probability with at least 95 % confidence, from ``count`` successes in ``total`` trials.

    C. J. Clopper, E. S. Pearson, Biometrika 26, 404 (1934): with a probability outside it so many successes, or so few, would
    be seen in less than 2.5 % of all samples.  So it covers whatever the probability is.  Wilson's interval (1927), which
    covers 95 % on average over all probabilities, covers 84 % of the samples where nearly all or nearly none succeed.
    """
    if count > total:
        raise InputError("count", count, f"at most {total}, the number of trials")
    rare = 0.5 * (1.0 - CONFIDENCE)
    low = _quantile(count, total - count + 1, rare) if count else 0.0
    high = 1.0 - _quantile(total - count, count + 1, rare) if count < total else 1.0
    return low, high


def _quantile(a: int, b: int, chance: float) -> float:
    """Number below which a beta variable of parameters ``a``, ``b`` lies with a probability of less than a third."""
    low, high = 0.0, a / (a + b)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _incomplete_beta(a, b, middle) < chance else (low, middle)
    return 0.5 * (low + high)


def _incomplete_beta(a: int, b: int, x: float) -> float:
    """Regularised incomplete beta function ``I_x(a, b)``, 0 < x < 1, by its continued fraction (DLMF 8.17.22)."""
    if x > (a + 1.0) / (a + b + 2.0):
        return 1.0 - _incomplete_beta(b, a, 1.0 - x)
    log_front = math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x)
    # Lentz's algorithm: the fraction is the product of the ratios of successive numerators and denominators.
    above, below = 1.0, 1.0 / _not_zero(1.0 - (a + b) * x / (a + 1.0))
    fraction, change, m = below, math.inf, 0
    while abs(change - 1.0) > 1e-15 and m < 100_000:
        m += 1
        for factor in (
            m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)),
        ):
            below = 1.0 / _not_zero(1.0 + factor * below)
            above = _not_zero(1.0 + factor / above)
            change = above * below
            fraction *= change
    return math.exp(log_front) * fraction / a


def _not_zero(value: float) -> float:
    return value if abs(value) > _SMALL else _SMALL
