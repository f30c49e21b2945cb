"""The table ``[gravity]`` of a machine file, and the setting beside it."""

import math
import tomllib

import pytest

from carom.base.outcome import InputError
from carom.loading import load
from carom.models import rotor_from, rotor_of
from carom.parameters import Case, Gravity, Zones

REAL, PURE, HEAVY = "examples/keogh-cole.toml", "examples/source-paper.toml", "examples/dropped-rotor.toml"


def test_values_with_units_and_their_defaults(write):
    assert load(REAL).gravity is None
    assert load(write("[gravity]")).gravity == Gravity(9.81, -0.5 * math.pi)
    text = '[gravity]\nacceleration = "162 cm/s^2"\ndirection = "-60 deg"'
    gravity = load(write(text)).gravity
    assert (gravity.acceleration, gravity.direction) == pytest.approx((1.62, -math.pi / 3))
    assert gravity.words == "1.62 m/s² at -60°"


def test_along_the_axis_of_a_vertical_shaft(write):
    vertical = load(write('[gravity]\ndirection = "axial"'))
    assert vertical.gravity.words == "9.81 m/s² along the axis"
    assert (
        vertical.gravity == Gravity(9.81, "axial") == Gravity.of(tomllib.loads(vertical.gravity.to_toml())["gravity"])
    )
    rotor = rotor_of(vertical.replace(gravity=1.62))
    assert rotor.is_vertical
    assert rotor.acting.weight is None
    assert rotor.has_closed_forms
    assert rotor_from(rotor.attributes()) == rotor.replace(gamma=0.5).replace(gamma=rotor.value("gamma"))


def test_it_is_set_like_other_values(write):
    path = write('[gravity]\ndirection = "-60 deg"')
    moon = load(path, ["gravity=1.62 m/s^2", "damping=900"])
    assert moon.gravity == Gravity(1.62, "-60 deg")
    assert moon == load(path).replace(gravity="1.62 m/s^2", damping=900)
    assert load(REAL, ["gravity=9.81"]).gravity == Gravity()
    assert moon.replace(speed="3000 rpm").gravity == moon.gravity


@pytest.mark.parametrize(
    ("gravity", "words"),
    [
        ("[gravity]\naceleration = 9.81", "aceleration = 9.81: unknown name in [gravity]; did you mean acceleration?"),
        ('[gravity]\nacceleration = "9.81 m/s"', "acceleration = 9.81 m/s: must be an acceleration in m/s^2"),
        ("[gravity]\nacceleration = -9.81", "acceleration = -9.81: must be an acceleration in m/s^2, >= 0"),
        ('[gravity]\ndirection = "down"', "direction = down: must be an angle in rad"),
        ('[gravity]\ndirection = "Axial"', "direction = Axial: must be an angle in rad"),
    ],
)
def test_what_cannot_be_gravity(write, gravity, words):
    with pytest.raises(InputError) as problem:
        load(write(gravity))
    assert str(problem.value).startswith(words)


def test_it_is_a_table_and_no_value(write):
    path = write("")
    path.write_text(f"gravity = 9.81\n{path.read_text(encoding='utf-8')}", encoding="utf-8")
    with pytest.raises(InputError) as problem:
        load(path)
    assert str(problem.value).startswith("gravity = 9.81: must be a table that starts with the line [gravity]")


def test_it_needs_a_machine(write):
    allowed = r"^gravity = .*: not allowed beside \[dimensionless\]: .* need a \[machine\] table with mass, clearance and speed$"
    with pytest.raises(InputError, match=allowed):
        load(write("[gravity]", PURE))
    with pytest.raises(InputError, match=allowed):
        load(PURE, ["gravity=9.81"])
    with pytest.raises(InputError, match=allowed):
        load(PURE).replace(gravity=9.81)
    with pytest.raises(InputError, match=allowed):
        Case("pure", load(PURE).parameters, None, Zones(), gravity=Gravity())
