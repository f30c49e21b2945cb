"""Derivatives of the force of each compliant law, against differences of the force."""

import math
from importlib import import_module

import numpy as np
import pytest

from carom.core.laws.choice import LAWS, force_change, force_coefficient
from carom.core.wall import Wall

YIELDING = [number for number, law in enumerate(LAWS) if hasattr(import_module(f"carom.core.laws.{law}"), "force")]
ORDER = 12


def series(function):
    """Taylor coefficients of a function at zero, by the values on a circle."""
    points = 0.3 * np.exp(2j * math.pi * np.arange(64) / 64)
    return (np.fft.fft([function(point) for point in points]).real / 64)[:ORDER] / 0.3 ** np.arange(ORDER)


@pytest.mark.parametrize("number", YIELDING)
@pytest.mark.parametrize("exponent", [1.0, 10 / 9, 1.5, 2.0])
@pytest.mark.parametrize("size", [1.0, 5e-10], ids=["deep", "where contact begins"])
def test_against_differences_of_the_series_of_the_force(number, exponent, size):
    wall = Wall(0.1, 0.0, 5.0, number, exponent, 50.0, 0.2)
    depth = series(lambda t: size * (0.4 + 0.3 * t - 0.2 * t**2))
    depth_change = series(lambda t: size * (np.cos(t) + t))
    rate, rate_change = (np.append(np.arange(1, ORDER) * each[1:], 0.0) for each in (depth, depth_change))

    def forces(step):
        power = np.zeros(ORDER)
        moved = depth + step * depth_change, rate + step * rate_change
        return np.array([force_coefficient(k, *moved, power, wall) for k in range(ORDER)]), power

    _, power = forces(0.0)
    changes = np.zeros(ORDER)
    found = [force_change(k, depth, rate, power, depth_change, rate_change, changes, wall) for k in range(ORDER)]
    near, far = (forces(step)[0] - forces(-step)[0] for step in (1e-3, 2e-3))
    expected = (8.0 * near - far) / 12e-3
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-7 * np.abs(expected).max())


def test_there_are_laws_that_give_way():
    assert {LAWS[number] for number in YIELDING} >= {"kelvin_voigt", "hunt_crossley"}
