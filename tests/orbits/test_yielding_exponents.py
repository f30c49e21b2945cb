"""Exponents of motions in walls that give way, and impulses of their contacts, by second routes."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from yielding_rotors import Yielding, packed

import carom as cm
from carom.models import HuntCrossley
from carom.orbits import Kind, lyapunov_exponents, orbit_exponents
from tests.orbits.test_yielding_orbits import CROSSLEY, CURVED, STICKING, VOIGT, settled

pytestmark = pytest.mark.jit_only


@pytest.mark.parametrize("rotor", [VOIGT, CROSSLEY, CURVED], ids=["voigt", "crossley", "curved"])
def test_exponents_of_an_orbit_add_up_to_the_growth_of_volumes(rotor):
    found = orbit_exponents(settled(rotor))
    assert found.lost == 0
    assert found.values.sum() == pytest.approx(found.volume, rel=1e-9)


def test_exponents_of_a_motion_are_those_of_the_orbit_to_which_it_settles():
    expected = orbit_exponents(settled(VOIGT))
    found = lyapunov_exponents(VOIGT.model, cm.State(0.2 + 0.1j, 1.0), 300, transient=200)
    assert found.values.sum() == pytest.approx(found.volume, rel=1e-9)
    assert found.values[1] == pytest.approx(expected.values[1], rel=1e-6)
    assert found.impacts == 300
    assert found.landings == 0


def test_rolling_takes_one_direction_away():
    found = orbit_exponents(settled(STICKING, -0.24555 - 0.77661j))
    assert found.lost == 1
    assert found.volume == -np.inf


def test_an_irregular_motion_has_a_positive_exponent_and_its_volumes_shrink_as_the_wall_says():
    found = lyapunov_exponents(
        dataclasses.replace(VOIGT, gamma=0.075).model, cm.State(0.2 + 0.1j, 1.0), 1000, transient=300
    )
    assert found.positive
    assert found.values[0] < 0.2
    assert found.values.sum() == pytest.approx(found.volume, rel=1e-7)


@pytest.mark.parametrize("rotor", [VOIGT, CROSSLEY], ids=["voigt", "crossley"])
def test_impulse_of_a_contact_is_the_integral_of_its_force(rotor):
    orbit = settled(rotor)
    (lift,) = np.flatnonzero(orbit.word.kinds == Kind.LIFT)

    def rates(_, state):
        moved = rotor.rates(state, "+")
        radius = np.hypot(*state[:2])
        return [*moved, rotor.force(radius - 1.0, (state[0] * state[2] + state[1] * state[3]) / radius)]

    start = np.append(packed(*orbit.nodes[0]), 0.0)
    pressed = solve_ivp(rates, (0.0, orbit.durations[0]), start, "DOP853", rtol=1e-12, atol=1e-13)
    assert orbit.impulse == pytest.approx(pressed.y[-1, -1], rel=1e-9)
    assert lift == len(orbit.word) - 1


def test_a_wall_without_damping_keeps_volumes():
    rotor = Yielding(HuntCrossley(2e3, 0.0, 1.0))
    found = orbit_exponents(settled(rotor))
    # Only the damping of the flight is left: 2 Re Σλ = −2γ.
    assert found.volume == pytest.approx(-2.0 * rotor.gamma, rel=1e-12)
    assert found.values.sum() == pytest.approx(found.volume, rel=1e-9)
