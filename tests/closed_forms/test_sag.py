"""Levitation as a circle about the static sag, against the matrices of the fixed frame and against simulation."""

import math

import numpy as np
import pytest
from linear_rotors import tilting

import carom as cm
from carom.closed_forms import levitation
from carom.models import Force, rotor_of

HEAVY = cm.load("examples/dropped-rotor.toml")
TILTING = tilting().model.under(Force(-1j, np.array([0.02 - 0.1j, 0.05])))


def test_the_sag_is_what_the_stiffness_holds():
    scales = HEAVY.parameters.scales
    held = levitation(HEAVY)
    assert held.sag == pytest.approx(-1j * 5.0 * 9.81 / 5e5 / scales.length, abs=1e-14)
    # The mass of the unbalance whirls as that without weight.
    assert held.whirl == pytest.approx(rotor_of(HEAVY).unforced.equilibrium, rel=1e-14)
    assert held.reach == pytest.approx(abs(held.sag) + abs(held.whirl), rel=1e-14)
    assert held.inside
    assert held.stable


@pytest.mark.parametrize("rotor", [rotor_of(HEAVY), TILTING], ids=["planar", "of two coordinates"])
def test_it_is_in_balance_in_the_fixed_frame(rotor):
    mass, damping, gyroscopic, stiffness, forcing = rotor.matrices
    held = levitation(rotor)
    sag, whirl = np.atleast_1d(held.sag), np.atleast_1d(held.whirl)
    assert stiffness @ sag == pytest.approx(mass @ rotor.acting.weight, abs=1e-12)
    assert (stiffness - mass + 1j * damping + gyroscopic) @ whirl == pytest.approx(forcing, abs=1e-12)


@pytest.mark.parametrize("rotor", [rotor_of(HEAVY), TILTING], ids=["planar", "of two coordinates"])
def test_a_kick_of_no_size_stays_on_it(rotor):
    held = levitation(rotor)
    motion = cm.simulate(rotor, cm.kick(0.0), 20.0)
    times = np.linspace(0.0, 20.0, 50)
    positions, _ = motion.at(times)
    turned = np.exp(1j * times).reshape(-1, *np.ones(positions.ndim - 1, int))
    assert positions * turned == pytest.approx(held.path(times), abs=1e-12)
    reached = max(
        np.abs(motion.seen_at(plane).at_plane(np.linspace(0.0, 20.0, 20_001))[0]).max()
        for plane in range(len(held.sags))
    )
    assert reached == pytest.approx(held.reach, abs=1e-6)
    assert rotor.system.rest_radius == pytest.approx(held.reach, rel=1e-14)


def test_the_weight_that_levitation_holds_is_that_at_which_it_reaches_the_wall():
    whirl = abs(levitation(HEAVY).whirl)
    most = (1.0 - whirl) * 0.25e-3 * 5e5 / 5.0
    assert levitation(HEAVY.replace(gravity=most * (1 - 1e-9))).inside
    assert not levitation(HEAVY.replace(gravity=most * (1 + 1e-9))).inside
    assert math.isclose(levitation(HEAVY.replace(gravity=most)).reach, 1.0, rel_tol=1e-12)
