"""What a machine must survive: the table ``[survive]``, options and defaults."""

import pytest

from carom.parameters import Scales, load, usual_kick

REAL = "examples/keogh-cole.toml"


def test_usual_kick_is_a_fall_through_the_diametral_clearance():
    scales = load(REAL).parameters.scales
    # Fall from rest through twice 0.7 mm: t = sqrt(2 h / g), v = g t.
    height, gravity = 2 * 0.7e-3, 9.80665
    speed = gravity * (2 * height / gravity) ** 0.5
    assert usual_kick(scales) * scales.velocity == pytest.approx(speed, rel=1e-15)  # a few roundings
    assert usual_kick(None) == 1.0


@pytest.mark.parametrize("factor", [0.1, 3.0])
def test_usual_kick_in_si_units_does_not_depend_on_speed_and_mass(factor):
    slow, fast = Scales(2.0, 0.25e-3, 300.0), Scales(2.0 * factor, 0.25e-3, 300.0 * factor)
    kicks = [usual_kick(scales) * scales.velocity for scales in (slow, fast)]
    assert kicks[0] == pytest.approx(kicks[1], rel=1e-15)  # a few roundings
