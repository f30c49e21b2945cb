"""The highest point of a flight."""

import numpy as np
import pytest
from scipy.optimize import brentq

from carom.core.margins import highest_point
from carom.core.rub import wall_push
from carom.models import jeffcott
from tests.compilation import COMPILED, sized
from tests.core.test_segments import rotor_of
from tests.machines import PAPER


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


def test_a_low_bounce_just_after_an_impact_is_seen():
    """Pressed to the wall by a force ``N − js`` the rotor touches it again after ``3N/2j`` if it leaves with ``3N²/8j``."""
    rotor, found = jeffcott(PAPER), 0
    arrays, rng = rotor.system.arrays, np.random.default_rng(3)

    def pushed(position: complex, angular: float, radial: float = 0.0) -> np.ndarray:
        return rotor.system.amplitudes(position, complex(radial, angular) * position)

    while found < sized(30, 2):
        position, force = np.exp(2j * np.pi * rng.uniform()), 10.0 ** rng.uniform(-4.0, -2.0)
        angular = brentq(
            lambda each, at, n: wall_push(arrays, 0, pushed(at, each))[0] - n, -1.0, 9.0, (position, force)
        )
        fall = -wall_push(arrays, 0, pushed(position, angular))[1]
        if fall < 0.5:
            continue
        found += 1
        start = pushed(position, angular, -0.9 * 3.0 / 8.0 * force**2 / fall)
        times = np.linspace(0.5, 2.5, 401) * force / fall
        squares = np.abs(rotor.system.at_plane(rotor.system.fly(start, times), 0)[0]) ** 2 - 1.0
        height, top = highest_point(arrays, 0, start, 2.0)
        assert height >= squares.max() - 1e-15
        if top < times[-1]:
            assert top == pytest.approx(times[np.argmax(squares)], abs=0.01 * force / fall)
