"""Limits of standards, against values worked out by hand."""

import math

import numpy as np
import pytest

from carom.studies.critical_speeds import required_margin, vibration_limit


@pytest.mark.parametrize(
    ("rpm", "micrometres"), [(1000.0, 25.4), (12_000.0, 25.4), (24_000.0, 17.9605), (48_000.0, 12.7)]
)
def test_vibration_limit(rpm, micrometres):
    """1 mil up to 12,000 rpm, and half of it at four times that speed."""
    assert float(vibration_limit(np.array(rpm * math.pi / 30.0))) == pytest.approx(1e-6 * micrometres, rel=1e-5)


@pytest.mark.parametrize(
    ("factor", "below", "above"),
    [
        (None, 0.0, 0.0),
        (2.4999, 0.0, 0.0),
        (2.5, 0.0, 0.10),
        (5.0, 0.17 * 2.5 / 3.5, 0.10 + 0.17 * 2.5 / 3.5),
        (18.0, 0.17 * 15.5 / 16.5, 0.10 + 0.17 * 15.5 / 16.5),
        (25.0, 0.16, 0.26),
        (1e6, 0.16, 0.26),
        (math.inf, 0.16, 0.26),
    ],
)
def test_required_margin(factor, below, above):
    assert required_margin(factor, "below") == pytest.approx(below)
    assert required_margin(factor, "above") == pytest.approx(above)
    assert required_margin(factor, "inside") == pytest.approx(above)
