"""A restitution that falls with speed: its derivatives, and its limits."""

import mpmath
import numpy as np
import pytest

from carom.core.laws import falling, rigid
from carom.core.laws.choice import LAWS, impulse
from carom.core.wall import Wall

NUMBER = LAWS.index("falling")


@pytest.mark.parametrize("speed", [0.0, 1e-9, 0.3, 7.0, -0.2])
@pytest.mark.parametrize(("restitution", "number"), [(0.9, 0.5), (0.3, 20.0), (0.0, 1.0)])
def test_derivatives_against_many_digits(speed, restitution, number):
    wall = Wall(0.1, restitution, 5.0, NUMBER, number)
    with mpmath.workdps(40):
        exact = lambda v, d: v + d * v / (1 + number * abs(v))  # noqa: E731
        by_speed = mpmath.diff(lambda v: exact(v, mpmath.mpf(restitution)), speed) if speed else 1 + restitution
        by_restitution = speed / (1 + mpmath.mpf(number) * abs(speed))
        value = exact(mpmath.mpf(speed), mpmath.mpf(restitution))
    assert falling.impulse(speed, wall) == pytest.approx(float(value), rel=1e-14)
    assert falling.impulse_by_speed(speed, wall) == pytest.approx(float(by_speed), rel=1e-12)
    assert falling.impulse_by_restitution(speed, wall) == pytest.approx(float(by_restitution), rel=1e-14)


def test_slow_arrivals_are_those_of_a_rigid_wall_and_no_rebound_is_faster_than_its_limit():
    wall = Wall(0.1, 0.8, 5.0, NUMBER, 4.0)
    assert falling.impulse(1e-12, wall) == pytest.approx(rigid.impulse(1e-12, wall), rel=1e-11)
    speeds = np.geomspace(1e-3, 1e6, 50)
    rebounds = falling.impulse(speeds, wall) - speeds
    assert (np.diff(rebounds) > 0.0).all()
    assert rebounds[-1] == pytest.approx(0.8 / 4.0, rel=1e-5)


def test_the_law_of_a_wall_is_chosen_by_its_number():
    for law, module in (("rigid", rigid), ("falling", falling)):
        wall = Wall(0.1, 0.8, 5.0, LAWS.index(law), 4.0)
        assert impulse(2.0, wall) == module.impulse(2.0, wall)
    assert impulse(2.0, Wall(0.1, 0.8, 5.0, NUMBER, 4.0)) < impulse(2.0, Wall(0.1, 0.8, 5.0))
