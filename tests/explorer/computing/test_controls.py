"""Controls of a machine, and what people type into their boxes."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import carom
from carom.base.outcome import InputError
from carom.explorer.computing.controls import controls_of, in_options, unit_of, values_of, with_settings

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture(scope="module")
def case():
    return carom.load(EXAMPLES / "keogh-cole.toml")


@pytest.fixture(scope="module")
def dimensionless():
    return carom.load(EXAMPLES / "source-paper.toml")


def test_controls_are_in_units_of_engineers(case):
    found = {control.name: (control.unit, control.value) for control in controls_of(case)}
    assert list(found) == ["speed", "eccentricity", "stiffness", "damping", "friction", "restitution"]
    assert found["eccentricity"] == ("mm", 0.3)
    assert found["speed"][0] == "rpm"
    assert found["speed"][1] == pytest.approx(184.2 * 30.0 / math.pi, rel=1e-11)


def test_sliders_hold_the_value_of_the_machine(case, dimensionless):
    for control in (*controls_of(case), *controls_of(dimensionless)):
        assert control.low <= control.value <= control.high
        assert not control.logarithmic or control.low > 0.0


@pytest.mark.parametrize("name", ["damping", "eccentricity", "friction", "restitution"])
def test_a_control_whose_value_is_zero_has_a_slider(case, name):
    (control,) = (one for one in controls_of(case.replace(**{name: 0.0})) if one.name == name)
    assert control.low == 0.0 < control.high
    assert not control.logarithmic


def test_machines_without_units_show_their_numbers(dimensionless):
    assert [control.name for control in controls_of(dimensionless)] == ["rho", "omega", "gamma", "mu", "d"]
    assert with_settings(dimensionless, {"gamma": "0.2"}).parameters == dimensionless.parameters.replace(gamma=0.2)


def test_settings_are_those_of_the_command_line(case):
    settings = {"damping": "2000 N s/m", "speed": "1500 rpm", "eccentricity": "0.2 mm"}
    texts = [f"{name}={text}" for name, text in settings.items()]
    assert with_settings(case, settings) == carom.load(EXAMPLES / "keogh-cole.toml", texts)


def test_a_number_without_a_unit_is_in_the_unit_beside_its_box(case):
    assert with_settings(case, {"speed": "1500"}) == with_settings(case, {"speed": "1500 rpm"})
    assert with_settings(case, {"eccentricity": " 2e-1 "}) == with_settings(case, {"eccentricity": "200 um"})
    assert unit_of("speed") == pytest.approx(math.pi / 30.0, rel=1e-15)


def test_every_wrong_value_is_named_in_a_line_of_its_own(case):
    with pytest.raises(InputError) as caught:
        with_settings(case, {"damping": "a lot", "speed": "-3", "friction": "0.2"})
    first, second = str(caught.value).split("\n")
    assert first.startswith("damping = a lot: must be a damping in N s/m, ")
    assert second.startswith("speed = -3 rpm: must be an angular speed in rad/s, > 0 ")
    assert "(a number without a unit is in rpm)" in second


@pytest.mark.parametrize("text", ["", "nan", "1e999", "1 m", "<b>1</b>", "1\n2", "１", "0x10", "--set", "1 rpm; 2"])
def test_nothing_else_is_taken_for_a_number(case, text):
    with pytest.raises(InputError, match=r"^damping = [^\n]*$"):
        with_settings(case, {"damping": text})


def test_only_controls_can_be_set(case):
    with pytest.raises(InputError, match="clearance = 1 mm: one of: speed, eccentricity"):
        with_settings(case, {"clearance": "1 mm"})


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
    path = EXAMPLES / "tum-test-rig.toml"
    assert with_settings(carom.load(path), {name: text}).machine == carom.load(path, [setting]).machine


def test_a_gain_without_a_magnetic_bearing_is_refused_by_the_box_it_stands_in(case):
    with pytest.raises(
        InputError, match=r"^stiffness = 6000 A/m: is a proportional gain[^\n]*force_current_factor[^\n]*$"
    ):
        with_settings(case, {"stiffness": "6000 A/m"})


@pytest.fixture(scope="module")
def flexible():
    return carom.load(EXAMPLES / "tum-flexible-rotor.toml")


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
    settings = {"derivative": "7", "unbalance": "G 2.5", "touchdown_stiffness": "2e7"}
    texts = [f"{name}={text}" for name, text in in_options(flexible, settings).items()]
    again = carom.load(EXAMPLES / "tum-flexible-rotor.toml", texts)
    assert values_of(again) == values_of(with_settings(flexible, settings))
    # e ω = 2.5 mm/s of the whole rotor, in one part.
    machine = again.parameters.finite_elements.machine
    assert sum(each.size for each in machine.unbalances) * machine.speed / machine.rotor.mass == pytest.approx(
        2.5e-3, rel=1e-8
    )


def test_a_gain_that_does_not_hold_the_rotor_can_be_set(flexible):
    assert not carom.models.rotor_of(with_settings(flexible, {"proportional": "1500"})).system.levitates
