"""The planar rotor: what its parameters make of it."""

import numpy as np
import pytest
from machines import PAPER

from carom.base.outcome import InputError
from carom.models import jeffcott
from carom.parameters import Scales


def test_replacing_a_parameter_replaces_all_that_follows_from_it():
    rotor = jeffcott(PAPER)
    other = rotor.replace(gamma=0.3)
    assert other.parameters == PAPER.replace(gamma=0.3)
    assert other.system.exponents.real == pytest.approx([-0.15, -0.15])
    assert rotor.parameters is PAPER
    with pytest.raises(InputError, match="gama"):
        rotor.replace(gama=0.3)


def test_equilibrium_solves_the_equation():
    equilibrium = jeffcott(PAPER).equilibrium
    force = PAPER.rho * np.exp(1j * PAPER.phi)
    assert complex(PAPER.omega**2 - 1.0, PAPER.gamma) * equilibrium == pytest.approx(force, abs=1e-15)


def test_scales_are_those_of_the_parameters():
    scales = Scales(50.0, 0.7e-3, 184.2)
    assert jeffcott(PAPER.replace(scales=scales)).scales == scales
    assert jeffcott(PAPER).scales is None
