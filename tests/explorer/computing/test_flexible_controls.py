"""Controls of a flexible machine: of all bearings together, and of each by itself."""

from __future__ import annotations

import dataclasses

import pytest
from flexible_machines import munich

from carom.explorer.computing.flexible_controls import (
    SINGLE,
    controls_of_machine,
    in_entries,
    machine_with,
    values_of_machine,
)
from carom.outcome import InputError
from carom.parameters import TouchdownBearing
from carom.rotors import TransferFunction


def named(machine):
    return {each.name: each for each in controls_of_machine(machine)}


def test_controls_are_in_units_of_engineers_and_hold_the_value_of_the_machine():
    found = named(munich())
    assert {name: (found[name].value, found[name].unit) for name in ("speed", "proportional", "filter_time", "unbalance")} == {
        "speed": (3000.0, "rpm"), "proportional": (5000.0, "A/m"), "filter_time": (0.1, "ms"), "unbalance": (20.0, "g mm"),
    }  # fmt: skip
    for control in found.values():
        assert control.low <= control.value <= control.high
        assert not control.logarithmic or control.low > 0.0


def test_single_bearings_come_last_and_belong_to_the_control_of_all():
    found = controls_of_machine(munich())
    single = [each for each in found if each.group == SINGLE]
    assert found[-len(single) :] == tuple(single)
    assert {each.among for each in single if each.name.startswith("derivative")} == {"derivative"}


def test_parts_that_differ_have_no_control_together():
    machine = munich().replace(derivative_2="4 A s/m")
    found = named(machine)
    assert "derivative" not in found
    assert (found["derivative_1"].value, found["derivative_2"].value) == (5.0, 4.0)
    assert found["derivative_2"].among == ""


def test_a_controller_that_is_no_pid_has_no_gains_to_move():
    machine = munich()
    other = TransferFunction([5e-3, 5.0], [1e-4, 1.0])
    bearings = [dataclasses.replace(each, controller=other) for each in machine.bearings]
    assert "proportional" not in named(dataclasses.replace(machine, bearings=bearings))


def test_settings_are_those_of_the_machine_and_numbers_are_in_the_unit_beside_the_box():
    machine = munich()
    controls = named(machine)
    changed = machine_with(machine, controls, {"proportional": "6000", "proportional_2": "5.5 A/mm", "speed": "4000"})
    same = machine.replace(proportional=6000.0, proportional_2=5500.0, speed="4000 rpm")
    assert (changed.bearings[1].controller, changed.speed) == (same.bearings[1].controller, same.speed)
    values = values_of_machine(changed, controls)
    assert (values["proportional"], values["proportional_1"], values["speed"]) == (None, 6000.0, 4000.0)


def test_what_cannot_be_used_is_named_all_at_once():
    machine = munich()
    with pytest.raises(InputError) as problem:
        machine_with(machine, named(machine), {"speed": "fast", "friction": "-1", "mass": "3 kg"})
    assert {each.field for each in problem.value.errors} == {"mass", "speed", "friction"}


def test_a_curved_stiffness_is_told_in_its_own_unit():
    curved = TouchdownBearing("hunt-crossley", stiffness=1e9, dissipation=1.0, exponent=1.5)
    machine = munich(touchdown=curved)
    controls = named(machine)
    assert controls["touchdown_stiffness"].unit == "N/m^1.5"
    for text in ("2e9", "2e9 N/m^1.5"):
        changed = machine_with(machine, controls, {"touchdown_stiffness": text})
        assert changed.touchdowns[0].bearing.stiffness == 2e9


@pytest.mark.parametrize(
    ("text", "eccentricity"), [("G 2.5", 2.5e-3 / 200.0), ("G2.5", 2.5e-3 / 200.0), ("20 um", 20e-6)]
)
def test_an_unbalance_may_be_typed_as_a_balance_grade_at_the_speed_set_or_as_an_eccentricity(text, eccentricity):
    machine, typed = munich(), {"unbalance": text, "speed": "200 rad/s"}
    found = machine_with(machine, named(machine), typed)
    assert found.unbalances[0].size == pytest.approx(
        machine.rotor.mass * eccentricity, rel=1e-8
    )  # nine digits are told
    told = in_entries(machine, named(machine), typed)["unbalance"]
    assert machine.replace(unbalance=told).unbalances == found.unbalances  # as the copied options say it


def test_of_several_unbalances_each_has_an_equal_part_of_a_grade():
    machine = munich()
    machine = dataclasses.replace(machine, unbalances=(machine.unbalances[0],) * 2)
    for name in ("unbalance", "unbalance_2"):
        found = machine_with(machine, named(machine), {name: "G 2.5"})
        assert found.unbalances[1].size == pytest.approx(0.5 * machine.rotor.mass * 2.5e-3 / machine.speed, rel=1e-8)
