"""Intervals of probabilities cover them as stated."""

import numpy as np
import pytest
from scipy.stats import binom, binomtest

from carom.attractors import exact_interval


@pytest.mark.parametrize(("count", "total"), [(0, 10), (3, 10), (10, 10), (499, 1000), (1, 100_000), (70_000, 70_001)])
def test_the_interval_is_that_of_clopper_and_pearson(count, total):
    expected = binomtest(count, total).proportion_ci(0.95, method="exact")
    # Logarithms of factorials of 1e5 are 1e6: some 1e-10 of the probabilities is lost to rounding.
    assert exact_interval(count, total) == pytest.approx((expected.low, expected.high), rel=1e-8)
    low, high = exact_interval(count, total)
    assert low <= count / total <= high


@pytest.mark.parametrize("total", [20, 69, 100])
def test_every_probability_is_covered(total):
    """Summed over all samples, not drawn; Wilson's interval covers as few as 84 % where few succeed."""
    counts, probabilities = np.arange(total + 1), np.linspace(0.0, 1.0, 20_001)
    chances = binom.pmf(counts[:, None], total, probabilities)
    covered = {}
    for name, intervals in (
        ("exact", [exact_interval(count, total) for count in counts.tolist()]),
        ("wilson", [binomtest(count, total).proportion_ci(0.95, method="wilson") for count in counts.tolist()]),
    ):
        low, high = np.array([tuple(one)[:2] for one in intervals]).T[:, :, None]
        covered[name] = np.where((low <= probabilities) & (probabilities <= high), chances, 0.0).sum(axis=0)
    assert covered["exact"].min() >= 0.95
    assert covered["wilson"].min() < 0.85
