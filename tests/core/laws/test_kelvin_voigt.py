"""A Kelvin–Voigt wall: force, series, stored energy and bounds of rounding errors against the formula in many digits."""

import mpmath
import numpy as np
import pytest

from carom.core.laws import choice, kelvin_voigt
from carom.core.layout import ORDER
from carom.core.wall import Wall

WALL = Wall(0.2, 0.0, 5.0, choice.LAWS.index("kelvin_voigt"), 0.0, 3e4, 70.0)


def exact(depth, rate):
    """The force in many digits."""
    return mpmath.mpf(WALL.stiffness) * depth + mpmath.mpf(WALL.loss) * rate


def test_force_and_its_series_are_those_of_a_spring_and_a_damper():
    random = np.random.default_rng(0)
    depth, rate, power = random.normal(size=(3, ORDER + 1))
    for k in range(ORDER + 1):
        expected = float(exact(mpmath.mpf(depth[k]), mpmath.mpf(rate[k])))
        for coefficient in (kelvin_voigt.force_coefficient, choice.force_coefficient):
            assert coefficient(k, depth, rate, power, WALL) == pytest.approx(expected, rel=1e-14)
        assert choice.press_coefficient(k, depth, rate, WALL) == pytest.approx(expected, rel=1e-14)
    assert choice.force(depth[0], rate[0], WALL) == kelvin_voigt.force_coefficient(0, depth, rate, power, WALL)
    assert choice.edge(1e-12, -1.0, WALL) == 0.0


def test_it_stores_the_work_of_its_spring():
    with mpmath.workdps(30):
        for depth in (1e-9, 0.003, 0.4):
            work = mpmath.quad(lambda at: exact(at, 0), [0, mpmath.mpf(depth)])
            assert choice.stored_energy(depth, WALL) == pytest.approx(float(work), rel=1e-15)


def test_rounding_errors_of_depth_and_rate_change_the_force_by_less_than_the_bound():
    random = np.random.default_rng(1)
    for _ in range(200):
        depth, rate = 10.0 ** random.uniform(-9, -0.5), random.normal() * 5.0
        errors = 10.0 ** random.uniform(-16, -12, 2)
        bound = choice.force_rounding(*errors, WALL)
        with mpmath.workdps(40):
            at = mpmath.mpf(depth), mpmath.mpf(rate)
            moved = max(
                abs(exact(at[0] + i * errors[0], at[1] + j * errors[1]) - exact(*at)) for i in (-1, 1) for j in (-1, 1)
            )
        assert moved <= bound * (1.0 + 1e-12)
        assert choice.press_rounding(*errors, WALL) == bound


def test_an_arrival_has_no_impulse():
    for function in (choice.impulse, choice.impulse_by_speed, choice.impulse_by_restitution):
        assert function(1.3, WALL) == 0.0
