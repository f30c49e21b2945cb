"""How a flexible machine levitates, as the page tells it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from flexible_machines import munich
from flexible_pages import opened, reduced

from carom.closed_forms import synchronous_response
from carom.explorer.computing.flexible_levitation import levitating, told_more
from carom.rotors import find_whirls


@pytest.fixture(scope="module")
def machine():
    return reduced()


def test_a_machine_that_levitates_is_told_by_its_whirls_and_its_room(machine):
    found = levitating(opened().case, machine, 1.5 * machine.machine.speed)
    worst = min(find_whirls(machine.machine, count=10), key=lambda each: each.damping_ratio)
    assert (found.stable, found.holds, len(found.whirls)) == (True, True, 10)
    assert float(found.damping) == pytest.approx(worst.damping_ratio, rel=5e-3)  # three digits are told
    assert found.lead.startswith("It levitates")
    assert found.clearance == f"{100.0 * machine.model.system.rest_radius:.3g} %"
    # The curve passes through the response at the speed of the machine, whichever of both computes it.
    at_speed = np.abs(synchronous_response(machine.machine, [machine.machine.speed]).touchdowns.forward[0])
    for curve, radius in zip(found.curves, at_speed, strict=False):
        between = np.interp(machine.machine.speed, found.speeds, curve.radii)
        assert between == pytest.approx(radius, rel=1e-2)  # by a straight line between speeds that are 5 rad/s apart


def test_a_whirl_that_grows_is_said_and_nothing_of_the_response_is_told(machine):
    late = machine.of(machine.machine.replace(delay="2 ms"))
    found = levitating(opened().case, late, 500.0)
    assert (found.stable, found.holds, found.curves, found.orbits) == (False, False, (), ())
    assert found.lead.startswith("It does not levitate: a ")
    assert " whirl of " in found.lead
    assert min(row.ratio for row in found.whirls) < 0.0


def test_bearings_that_push_are_no_whirl(machine):
    weak = machine.of(machine.machine.replace(proportional="1000 A/m", integral=0.0))
    found = levitating(opened().case, weak, 500.0)
    assert not found.stable
    assert (found.damping, found.damping_remark) == ("–", "a motion grows")


def test_too_large_an_unbalance_is_no_levitation_without_contact(machine):
    found = levitating(opened().case, machine.of(machine.machine.replace(unbalance="2 kg mm")), 500.0)
    assert (found.stable, found.holds) == (True, False)
    assert found.lead.startswith("Cannot run without contact")
    assert len(found.curves) == 4


def test_without_an_unbalance_there_is_no_response(machine):
    assert levitating(opened().case, machine.of(machine.machine.replace(unbalance=0.0)), 500.0).holds
    bare = machine.of(dataclasses.replace(machine.machine, unbalances=()))
    assert not levitating(opened().case, bare, 500.0).curves


def test_more_is_told_by_headings():
    machine = munich(longest_element=0.2).with_modes(8)
    told = told_more(machine)
    assert list(told) == ["Critical speeds", "Magnetic bearings", "Accuracy"]
    assert any("API 617" in text for text in told["Critical speeds"])
    assert f"{machine.vectors} vectors" in told["Accuracy"][0]
    assert "Along a motion the error may be larger" in told["Accuracy"][1]
