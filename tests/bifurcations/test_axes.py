"""Parameters that are varied, against the machine they belong to."""

from __future__ import annotations

import numpy as np
import pytest
from machines import PAPER

from carom import Machine
from carom.bifurcations import value_of, vary
from carom.outcome import InputError
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, Scales

MACHINE = Machine.from_parameters(PAPER, Scales(50.0, 0.7e-3, 184.2))


@pytest.mark.parametrize("name", MACHINE_FIELDS)
def test_physical_parameters_move_what_the_machine_moves(name):
    for factor in (0.7, 0.99):
        value = factor * getattr(MACHINE, name)
        expected = MACHINE.replace(**{name: value}).parameters
        got = vary(MACHINE.parameters, name, value)
        assert got.as_dict() == pytest.approx(expected.as_dict(), rel=1e-13)
        assert got.scales is not None
        assert vars(got.scales) == pytest.approx(vars(expected.scales), rel=1e-13)
        assert value_of(got, name) == pytest.approx(value, rel=1e-13)


@pytest.mark.parametrize("name", DIMENSIONLESS_FIELDS)
def test_dimensionless_parameters_move_alone(name):
    got = vary(PAPER, name, 0.8)
    assert got == PAPER.replace(**{name: 0.8})
    assert value_of(got, name) == 0.8


def test_names_that_cannot_be_varied():
    with pytest.raises(InputError, match="did you mean gamma"):
        vary(PAPER, "gama", 0.1)
    with pytest.raises(InputError, match="mass, clearance and speed are not known"):
        vary(PAPER, "speed", 100.0)
    with pytest.raises(InputError, match="d = "):
        vary(PAPER, "d", 1.2)
    with pytest.raises(InputError):
        value_of(PAPER, "stiffness")
    assert np.isfinite(value_of(MACHINE.parameters, "stiffness"))
