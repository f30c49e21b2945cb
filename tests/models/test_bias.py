"""Weight that bias currents carry: the rotor levitates in the centre, and the weight acts where levitation is lost."""

import dataclasses
import math

import numpy as np
import pytest
from limited_reference import clipped, follow

import carom as cm
from carom.base.outcome import InputError
from carom.models import rotor_of
from carom.models.documents import document_of, part_from
from carom.parameters import Gravity
from carom.rotors import synchronous_response

SAGGING = cm.load("examples/dropped-rotor.toml")
FOUR_DEGREES = "tests/machine_files/four-degrees.toml"


def held(case, **changes):
    """The case with a weight that bias currents carry."""
    return dataclasses.replace(case, gravity=Gravity(case.gravity.acceleration, case.gravity.direction)).replace(
        **changes
    )


def test_bias_is_the_default_and_the_word_is_checked():
    assert Gravity() == Gravity(carried_by="bias") != Gravity(carried_by="stiffness")
    assert Gravity.of({"carried_by": "stiffness"}).to_toml().splitlines()[1] == 'carried_by = "stiffness"'
    with pytest.raises(InputError, match=r'^carried_by = spring: must be "bias" or "stiffness"$'):
        Gravity(carried_by="spring")


def test_the_planar_rotor_levitates_as_without_weight_and_falls_with_it():
    bias, without = held(SAGGING), SAGGING.replace(gravity=0)
    assert cm.closed_forms.levitation(bias).reach == cm.closed_forms.levitation(without).reach
    assert rotor_of(bias).has_closed_forms
    kicked = [cm.simulate(each, cm.kick("50 mm/s")).contacts.time for each in (bias, without)]
    assert np.array_equal(*kicked)
    # From rest in the centre the fall takes sqrt(2 c_r / g), as where levitation is the same.
    fallen = cm.simulate(bias.replace(eccentricity=0.0), cm.drop())
    assert fallen.contacts.time[0] * fallen.rotor.scales.time == pytest.approx(7.139215615e-3, rel=1e-9)
    # Regained, the currents are back: the motion settles in the centre.
    back = cm.simulate(bias.replace(eccentricity=0.0), cm.drop(regained_after="5 ms"))
    assert back.outcome.label == "levitated"
    assert back.rotor.acting.weight is None


def test_it_is_kept_by_changes_and_by_documents():
    rotor = rotor_of(held(SAGGING))
    moved = rotor.replace(gravity="1.62 m/s^2", speed="6000 rpm")
    assert moved.carried_by_bias
    assert moved.without_levitation().acting.weight == pytest.approx(
        rotor_of(held(SAGGING, gravity=1.62, speed="6000 rpm")).acting.whole_weight
    )
    again = part_from(document_of(rotor))
    assert again.carried_by_bias
    assert again.acting.whole_weight == rotor.acting.whole_weight
    assert "gravity" not in rotor.varied


def test_limits_have_the_less_to_spare():
    """Along the weight ``|k_c z + mg| ≤ F``: against a general integrator that clips the whole force."""
    case = held(SAGGING, force_limit="70 N", unbalance_phase="0.3 rad")
    rotor, si = rotor_of(case), case.si
    scales = rotor.scales
    start = cm.State(0.25 + 0.3j, 0.15 - 0.1j)
    motion = cm.simulate(rotor, start, 12.0)
    assert not len(motion.contacts)
    stiffness, damping = si["stiffness"] / scales.stiffness, si["damping"] / (scales.mass * scales.speed)
    bound, weight = 70.0 / scales.force, -1j * 9.81 / scales.acceleration
    push = si["eccentricity"] / scales.length * np.exp(0.3j)

    def rates(time, state):
        place, speed = state
        return np.array(
            [speed, push * np.exp(1j * time) + weight - clipped(stiffness * place + damping * speed + weight, bound)]
        )

    (place, _), _ = follow(rates, np.array([0.25 + 0.3j, 0.15 - 0.1j + 1j * (0.25 + 0.3j)]), 12.0)
    assert motion.position(12.0, "fixed") == pytest.approx(place, abs=1e-9)
    # It matters here: without weight the rotor is elsewhere.
    light = cm.simulate(rotor_of(case.replace(gravity=0)), start, 12.0)
    assert abs(light.position(12.0, "fixed") - place) > 1e-3


def test_what_the_response_says_of_a_limit():
    found = synchronous_response(held(SAGGING, force_limit="100 N", unbalance="1e-6 g mm"), [900.0])
    assert found.saturation[0, 0] == pytest.approx(5.0 * 9.81 / 100.0, rel=1e-6)
    assert found.sags[0] == 0.0


def test_a_tilting_rotor_is_held_by_its_sensors_and_levers_share_the_weight():
    case = cm.load(FOUR_DEGREES)
    rotor = rotor_of(case)
    assert cm.closed_forms.levitation(case).sags == pytest.approx([0.0, 0.0], abs=1e-14)
    assert rotor.acting.weight is None
    reduced = rotor.finite_elements
    pull = np.zeros(len(reduced.equations.mass), complex)
    pull[0] = -1j * 9.81 * math.sqrt(12.0)
    left, currents = reduced.held_by_bias(pull)
    assert np.abs(left + pull).max() < 1e-12 * abs(pull[0])
    # f_1 = mg b/(a + b), f_2 = mg a/(a + b) with a = 0.12 m, b = 0.15 m, and f = −ki i.
    shares = 12.0 * 9.81 / 0.27 * np.array([0.15, 0.12])
    assert currents == pytest.approx(-1j * shares / 100.0, rel=1e-10)


def test_a_bending_shaft_keeps_its_sensors_in_the_centre_as_a_slow_integrator_would():
    integrating, biased = (cm.load("examples/tum-flexible-rotor.toml", settings) for settings in ([], ["integral=0"]))
    both = [cm.closed_forms.levitation(each).sags for each in (integrating, biased)]
    assert both[1] == pytest.approx(both[0], rel=1e-9)
    sagging = dataclasses.replace(biased, gravity=Gravity(carried_by="stiffness"))
    assert cm.closed_forms.levitation(sagging).sags != pytest.approx(both[0], rel=0.5)
