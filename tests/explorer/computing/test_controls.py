"""Controls of a machine, and what people type into their boxes."""

import math

import pytest

import carom
from carom.explorer.computing.controls import controls_of, in_options, unit_of, values_of, with_settings


@pytest.fixture(scope="module")
def case():
    return carom.load("examples/keogh-cole.toml")


def test_settings_are_those_of_the_command_line(case):
    settings = {"damping": "2000 N s/m", "speed": "1500 rpm", "eccentricity": "0.2 mm"}
    texts = [f"{name}={text}" for name, text in settings.items()]
    assert with_settings(case, settings) == carom.load("examples/keogh-cole.toml", texts)


def test_a_number_without_a_unit_is_in_the_unit_beside_its_box(case):
    assert with_settings(case, {"speed": "1500"}) == with_settings(case, {"speed": "1500 rpm"})
    assert with_settings(case, {"eccentricity": " 2e-1 "}) == with_settings(case, {"eccentricity": "200 um"})
    assert unit_of("speed") == pytest.approx(math.pi / 30.0, rel=1e-15)


@pytest.mark.parametrize(
    ("name", "text", "setting"),
    [
        ("eccentricity", "90 g mm", "unbalance=90 g mm"),
        ("eccentricity", "G 2.5", "balance_grade=G 2.5"),
        ("stiffness", "6000 A/m", "proportional_gain=6000 A/m"),
        ("stiffness", "60 Hz", "natural_frequency=60 Hz"),
        ("damping", "7 A s/m", "derivative_gain=7 A s/m"),
        ("damping", "10 %", "damping_ratio=10 %"),
    ],
)
def test_what_engineers_state_instead_is_read_too(name, text, setting):
    path = "examples/tum-test-rig.toml"
    assert with_settings(carom.load(path), {name: text}).machine == carom.load(path, [setting]).machine


@pytest.fixture(scope="module")
def flexible():
    return carom.load("examples/tum-flexible-rotor.toml")


def test_parts_have_controls_of_all_together_and_of_each(flexible):
    controls = {control.name: control for control in controls_of(flexible)}
    assert list(controls)[:5] == ["speed", "unbalance", "proportional", "integral", "derivative"]
    assert (controls["proportional_2"].among, controls["proportional_2"].group) == (
        "proportional",
        "Each bearing by itself",
    )
    assert controls["delay"].value == 0.0 < controls["delay"].high
    changed = with_settings(flexible, {"proportional_2": "4500", "delay": "0.1 ms"})
    values = values_of(changed, controls)
    assert (values["proportional"], values["proportional_1"], values["proportional_2"]) == (None, 5000.0, 4500.0)
    assert values["delay_1"] == 0.1


def test_settings_of_parts_are_those_of_the_command_line(flexible):
    settings = {"derivative": "7", "unbalance": "40", "touchdown_stiffness": "2e7"}
    texts = [f"{name}={text}" for name, text in in_options(flexible, settings).items()]
    again = carom.load("examples/tum-flexible-rotor.toml", texts)
    assert values_of(again) == values_of(with_settings(flexible, settings))
    (unbalance,) = again.parameters.finite_elements.machine.unbalances
    assert unbalance.size == pytest.approx(4e-5, rel=1e-12)
