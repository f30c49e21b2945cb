"""The loss of a blade of a flexible machine changes the unbalance at its own node."""

import cmath
import dataclasses
import math

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import InputError
from carom.models import rotor_of
from carom.rotors import Unbalance

BEFORE = (Unbalance(1, 20e-6, 0.0), Unbalance(3, 19e-6, math.pi))


@pytest.fixture(scope="module")
def couple():
    """Two unbalances that nearly cancel as a force and leave a couple."""
    machine = rotor_of(cm.load("examples/uberlandia-flexible-rotor.toml")).finite_elements.machine
    return dataclasses.replace(machine, unbalances=BEFORE).with_modes(2).model


def test_only_the_node_of_the_blade_changes_by_a_vector(couple):
    scales = couple.finite_elements.scales
    change = cmath.rect(4e-6 / scales.unbalance, 0.5)
    after, turned = couple.with_changed_unbalance(change, 3)
    machine = after.finite_elements.machine
    other, own = machine.unbalances
    assert turned == 0.0
    assert other == BEFORE[0]
    # Its phase counts from the unbalance there.
    expected = cmath.rect(19e-6, math.pi) + cmath.rect(4e-6, math.pi + 0.5)
    assert cmath.rect(own.size, own.angle) == pytest.approx(expected, rel=1e-12)
    made = dataclasses.replace(couple.finite_elements.machine, unbalances=machine.unbalances)
    whole = couple.finite_elements.of(made).model
    np.testing.assert_allclose(after.system.rest, whole.system.rest, rtol=1e-9)


def test_the_node_must_be_said_where_several_have_an_unbalance(couple):
    with pytest.raises(InputError, match="blade_loss_node"):
        couple.with_changed_unbalance(0.1)
    with pytest.raises(InputError, match="blade_loss_node = 99"):
        couple.with_changed_unbalance(0.1, 99)
