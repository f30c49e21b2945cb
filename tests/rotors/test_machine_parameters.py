"""Named parameters of flexible machines: of all parts and of one, in files, settings and models."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from flexible_machines import symmetric
from refusals import assert_refused

import carom as cm
from carom.base.outcome import InputError
from carom.models import LinearEquations, Rotor

EXAMPLE = Path("examples/tum-flexible-rotor.toml")
SETTINGS = (
    "proportional=5500 A/m",
    "derivative_2=4 A s/m",
    "gravity=0",
    "touchdown_stiffness=2e7 N/m",
    "friction_1=0.2",
)


@pytest.fixture(scope="module")
def case():
    return cm.load(EXAMPLE, ["accuracy=0.5"])


def test_settings_name_entries_of_all_parts_or_of_one():
    machine = cm.rotors.load_machine(EXAMPLE, SETTINGS)
    assert [each.controller.proportional for each in machine.bearings] == [5500.0, 5500.0]
    assert [each.controller.derivative for each in machine.bearings] == [5.0, 4.0]
    assert [each.bearing.stiffness for each in machine.touchdowns] == [2e7, 2e7]
    assert [each.friction for each in machine.touchdowns] == [0.2, 0.15]
    assert machine.gravity.acceleration == 0.0


def test_a_case_has_the_parameters_of_its_machine(case):
    changed = case.replace(proportional="5.5e3 A/m", touchdown_dissipation_2=2.0, gravity=1.62)
    assert changed.parameters.value("proportional") == 5500.0
    assert changed.parameters.value("touchdown_dissipation_1") == 1.0
    assert changed.gravity.acceleration == 1.62
    same = cm.load(EXAMPLE, ["accuracy=0.5", "proportional=5.5e3 A/m", "touchdown_dissipation_2=2 s/m"]).parameters
    for name in ("mass", "damping", "stiffness", "unlevitated", "forcing", "planes"):
        assert np.array_equal(getattr(changed.parameters.equations, name), getattr(same.equations, name))


@pytest.mark.parametrize(
    "changes",
    [
        {"speed": 250.0},
        {"clearance": 3e-4},
        {"proportional": 4800.0, "integral_1": 900.0},
        {"derivative": 6.0, "filter_time": 2e-4},
        {"ki_2": 55.0, "ks": -9e4},
        {"friction": 0.3, "rotor_radius_2": 6e-3},
        {"touchdown_stiffness_1": 3e7, "touchdown_dissipation": 0.4},
    ],
)
def test_a_model_changed_is_that_of_the_changed_machine(case, changes):
    model, machine = case.parameters, case.parameters.finite_elements.machine
    changed, made = model.replace(**changes), machine.replace(**changes).with_modes(model.finite_elements.modes).linear
    assert changed.finite_elements is not None
    assert changed.scales == made.scales
    for name in ("mass", "damping", "stiffness", "unlevitated", "forcing", "planes"):
        own, other = getattr(changed.equations, name), getattr(made.equations, name)
        assert np.allclose(own, other, rtol=0.0, atol=1e-12 * np.abs(other).max())
    assert [each.wall(1.0) for each in changed.equations.touchdowns] == [
        each.wall(1.0) for each in made.equations.touchdowns
    ]
    for name, value in changes.items():
        assert changed.value(name) == value
    back = changed.replace(**{name: model.value(name) for name in changes})
    assert back.equations.stiffness == pytest.approx(model.equations.stiffness)


def test_numbers_of_the_equations_are_told_to_the_machine(case):
    model = case.parameters
    turned = model.replace(rho=2.0 * model.value("rho"), phi=0.3, mu=0.25, radius_ratio_2=30.0)
    machine = turned.finite_elements.machine
    (unbalance,), (own,) = machine.unbalances, model.finite_elements.machine.unbalances
    assert unbalance.size == pytest.approx(2.0 * own.size, rel=1e-14)
    assert unbalance.angle - own.angle == pytest.approx(0.3 - model.unbalance_phase, abs=1e-14)
    assert [each.friction for each in machine.touchdowns] == [0.25, 0.25]
    assert machine.touchdowns[1].rotor_radius == pytest.approx(30.0 * machine.clearance, rel=1e-14)
    own = {field.name: getattr(model.equations, field.name) for field in dataclasses.fields(LinearEquations)}
    other = Rotor(LinearEquations(**own)).replace(rho=2.0 * model.value("rho"), phi=0.3, mu=0.25, radius_ratio_2=30.0)
    assert np.allclose(turned.equations.forcing, other.equations.forcing, rtol=1e-13)
    assert [each.surface_speed for each in turned.equations.touchdowns] == pytest.approx(
        [each.surface_speed for each in other.equations.touchdowns]
    )


def test_a_model_keeps_its_states():
    """What would add or take away states of a controller is for the machine: disturbances and branches keep their coordinates."""
    machine = symmetric()
    model = machine.reduce(0.5).linear
    assert "integral" not in model.varied
    assert "integral" in machine.varied
    with pytest.raises(InputError, match=r"^integral = 100.0: left as it is: where it is 0"):
        model.replace(integral=100.0)
    with pytest.raises(InputError, match=r"^derivative = 0.0: must be a gain"):
        model.replace(derivative=0.0)
    assert len(machine.replace(integral=100.0).reduce(0.5).linear.equations.mass) == len(model.equations.mass) + 2


def test_an_unstable_levitation_is_refused_where_a_machine_is_read(case):
    with pytest.raises(
        InputError,
        match=r"^levitation = unstable: a displacement to one side grows with .* 1/s, 3 more slowly: controllers that",
    ):
        cm.load(EXAMPLE, ["proportional=1000 A/m"])
    model = case.parameters.replace(proportional=1000.0)
    assert not model.system.levitates
    assert case.parameters.system.levitates


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        (
            "proportional_3=3",
            r"^proportional_3 = 3: unknown name .*one part by its number, such as proportional_2; did you mean",
        ),
        ("proportional=3 N/m", r"^proportional = 3 N/m: must be a gain in A/m.*'N/m' is not a unit of gain"),
        ("touchdown_damping=3", r"^touchdown_damping = 3: unknown name in this machine"),
    ],
)
def test_what_cannot_be_set_gets_one_line(setting, says):
    assert_refused(lambda: cm.load(EXAMPLE, [setting]), says)
