"""The highest point of a flight."""

from __future__ import annotations

import numpy as np
import pytest

from carom.core.margins import highest_point
from tests.compilation import COMPILED, sized
from tests.core.test_segments import rotor_of


def test_the_highest_point_is_that_of_fine_samples():
    rng = np.random.default_rng(5)
    rotor = rotor_of(4, 2, 2)
    fine = sized(20_001, 501)
    found = 0
    for _ in range(sized(40, 2)):
        start = 0.5 * (rng.normal(size=(4, 2)) @ [1.0, 1j])
        duration = rng.uniform(0.5, 12.0)
        height, top = highest_point(rotor.system.arrays, 1, start, duration)
        times = np.linspace(0.0, duration, fine)
        squares = np.abs(rotor.system.at_plane(rotor.system.fly(start, times), 1)[0]) ** 2 - 1.0
        inner = (squares[1:-1] > squares[:-2]) & (squares[1:-1] > squares[2:]) & (times[1:-1] > 0.05 * duration)
        if not inner.any() or (not np.isnan(top) and top < 0.06 * duration):
            continue
        found += 1
        # Samples miss a maximum by a curvature of some hundred times the square of their spacing.
        assert height == pytest.approx(squares[1:-1][inner].max(), abs=1e-3 * (20_001 / fine) ** 2)
        assert height >= squares[1:-1][inner].max() - 1e-12
    assert found > 0 or not COMPILED
