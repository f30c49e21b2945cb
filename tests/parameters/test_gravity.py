"""The table ``[gravity]`` of a machine file, and the setting beside it."""

import math
from pathlib import Path

import pytest

from carom.base.outcome import InputError
from carom.loading import load
from carom.parameters import Case, Gravity, Scales, Zones

REAL, PURE, HEAVY = "examples/keogh-cole.toml", "examples/source-paper.toml", "examples/dropped-rotor.toml"


@pytest.fixture
def write(tmp_path):
    def written(gravity: str, base: str = REAL):
        path = tmp_path / "machine.toml"
        path.write_text(f"{Path(base).read_text(encoding='utf-8')}\n{gravity}\n", encoding="utf-8")
        return path

    return written


def test_values_with_units_and_their_defaults(write):
    assert load(REAL).gravity is None
    assert load(write("[gravity]")).gravity == Gravity(9.81, -0.5 * math.pi)
    text = '[gravity]\nacceleration = "162 cm/s^2"\ndirection = "-60 deg"'
    gravity = load(write(text)).gravity
    assert (gravity.acceleration, gravity.direction) == pytest.approx((1.62, -math.pi / 3))
    assert gravity.words == "1.62 m/s² at -60°"


def test_gravity_of_zero_is_none(write):
    assert load(write("[gravity]\nacceleration = 0")).gravity is None
    assert load(HEAVY, ["gravity=0"]).gravity is None


def test_it_is_set_like_other_values(write):
    path = write('[gravity]\ndirection = "-60 deg"')
    moon = load(path, ["gravity=1.62 m/s^2", "damping=900"])
    assert moon.gravity == Gravity(1.62, "-60 deg")
    assert moon == load(path).replace(gravity="1.62 m/s^2", damping=900)
    assert load(REAL, ["gravity=9.81"]).gravity == Gravity()
    assert moon.replace(speed="3000 rpm").gravity == moon.gravity


def test_written_gravity_is_read_as_the_same(write):
    gravity = Gravity(0.1 + 0.2, -1.1)
    assert load(write(gravity.to_toml())).gravity == gravity


def test_a_case_says_what_acts_on_the_rotor():
    assert ("gravity", "9.81 m/s² at -90°") in load(HEAVY).rows()
    assert "gravity" not in dict(load(REAL).rows())


def test_in_units_of_the_equations_it_points_where_it_says():
    scales = Scales(5.0, 0.25e-3, 1000.0)
    assert Gravity().pull(scales) == pytest.approx(-1j * 9.81 / 250.0)


@pytest.mark.parametrize(
    ("gravity", "words"),
    [
        ("[gravity]\naceleration = 9.81", "aceleration = 9.81: unknown name in [gravity]; did you mean acceleration?"),
        ('[gravity]\nacceleration = "9.81 m/s"', "acceleration = 9.81 m/s: must be an acceleration in m/s^2"),
        ("[gravity]\nacceleration = -9.81", "acceleration = -9.81: must be an acceleration in m/s^2, >= 0"),
        ('[gravity]\ndirection = "down"', "direction = down: must be an angle in rad"),
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


def test_a_setting_that_is_none_is_told_by_its_name():
    with pytest.raises(InputError, match=r"^gravity = heavy: must be an acceleration in m/s\^2"):
        load(REAL, ["gravity=heavy"])
