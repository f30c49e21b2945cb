"""Intervals of probabilities that were seen in a sample."""

from __future__ import annotations

from carom.base.arguments import Whole, checked
from carom.base.outcome import InputError

CONFIDENCE = 0.95


@checked
def exact_interval(count: Whole, total: Whole) -> tuple[float, float]:
    """Interval that contains a probability with at least 95 % confidence, from ``count`` successes in ``total`` trials.

    C. J. Clopper, E. S. Pearson, Biometrika 26, 404 (1934): with a probability outside it so many successes, or so few, would
    be seen in less than 2.5 % of all samples.  So it covers whatever the probability is.  Wilson's interval (1927), which
    covers 95 % on average over all probabilities, covers 84 % of the samples where nearly all or nearly none succeed.
    """
    if count > total:
        raise InputError("count", count, f"at most {total}, the number of trials")
    from scipy.special import betaincinv  # type: ignore[import-untyped]

    rare = 0.5 * (1.0 - CONFIDENCE)
    low = float(betaincinv(count, total - count + 1, rare)) if count else 0.0
    high = 1.0 - float(betaincinv(total - count, count + 1, rare)) if count < total else 1.0
    return low, high
