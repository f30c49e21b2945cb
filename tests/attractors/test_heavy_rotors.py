"""Attractors of rotors that weigh something: motions of whole turns, levitation about the sag, rest on the bearing, tori."""

import math

import numpy as np
import pytest
from heavy_rotors import PARTING, RIGID, of_two_coordinates
from scipy.optimize import brentq

import carom as cm
from carom.attractors import Attractor, exponents_of, find_attractors
from carom.base.outcome import Outcome
from carom.models import Force, Rigid, jeffcott, rotor_of
from carom.parameters import Parameters

pytestmark = pytest.mark.jit_only
HEAVY = cm.load("examples/dropped-rotor.toml")


def touched(found) -> list[Attractor]:
    return [each for each in found if each.count and each.name.outcome is not Outcome.LEVITATED]


@pytest.mark.parametrize(
    ("name", "impacts", "turns"), [("three", 3, 1), ("six", 6, 2), ("landing", 20, 2), ("plastic", 2, 2)]
)
def test_bouncing_is_closed_and_told_to_take_whole_turns(name, impacts, turns):
    rotor = RIGID[name]
    (bouncing,) = touched(find_attractors(rotor, count=20))
    assert bouncing.name.multiplicity == impacts
    assert bouncing.period == pytest.approx(math.tau * turns)
    assert bouncing.orbit.turns == turns
    assert exponents_of(rotor, bouncing).across[0] < 0.0


@pytest.mark.parametrize(
    ("rotor", "counts"),
    [
        pytest.param(PARTING[0], {2, 3}, id="soft"),
        pytest.param(of_two_coordinates(Rigid(0.5), 0.38), {2, 3, 4}, id="two", marks=pytest.mark.deep),
    ],
)
def test_motions_that_coexist_are_told_apart(rotor, counts):
    found = touched(find_attractors(rotor, count=40))
    assert {each.name.multiplicity for each in found} == counts
    for each in found:
        # Its own orbit, not that of another phase of the weight.
        assert each.orbit.impacts == each.name.multiplicity
        assert each.orbit.admissible
        assert each.orbit.stable


def test_levitation_goes_round_once_a_turn():
    found = find_attractors(HEAVY, count=20)
    levitation = found["levitation"]
    assert levitation.count == 20
    assert levitation.period == pytest.approx(math.tau)
    rotor = rotor_of(HEAVY)
    later = cm.simulate(rotor, levitation.state, math.tau).final
    assert later.position == pytest.approx(levitation.state.position, abs=1e-12)
    assert (exponents_of(HEAVY, levitation).values < 0.0).all()


def test_rest_on_the_bearing_is_sliding_that_repeats_every_turn():
    lying = HEAVY.replace(gravity=30)
    (rest,) = touched(find_attractors(lying, count=12))
    assert rest.name.outcome is Outcome.AT_REST
    assert rest.orbit.segments == "slides forward throughout"
    assert rest.orbit.turns == 1
    assert rest.orbit.stable
    rotor, scales = rotor_of(lying), lying.parameters.scales
    # It rocks with the unbalance about the place where friction holds it on the slope, against weight and spring.
    fixed = rest.orbit.trajectory().position(np.linspace(0.0, math.tau, 400), "fixed")
    assert abs(fixed) == pytest.approx(1.0, abs=1e-9)
    weight, friction, spring = 30.0 / scales.acceleration, rotor.value("mu"), rotor.value("omega") ** 2
    leans = brentq(lambda lean: weight * np.sin(lean) - friction * (weight * np.cos(lean) - spring), 0.0, 1.0)
    # The surface moves forward at the bottom: friction pushes the rotor back.  It rocks by the size of the unbalance, its mean by the square.
    assert np.angle(1j * fixed).mean() == pytest.approx(-leans, abs=rotor.value("rho") ** 2)
    assert np.ptp(np.angle(1j * fixed)) < 3.0 * rotor.value("rho")


def test_a_bounce_that_does_not_keep_time_with_the_shaft_neither_repeats_nor_separates():
    rotor = jeffcott(Parameters(0.15, 0.76, 3 / 7, 0.21, 0.15, 0.95, 400 / 7)).under(Force(-1j, np.array([-1e-3j])))
    bounce = cm.find_orbits(rotor.unforced)["B1,d"]
    found = find_attractors(rotor, [bounce.departure], known=False, patience=2000)
    (irregular,) = touched(found)
    assert irregular.name.irregular
    assert exponents_of(rotor, irregular, 12_000).across[0] == pytest.approx(0.0, abs=3e-3)
