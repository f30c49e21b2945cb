"""The one kind of rotor that is handled: whatever takes a rotor is given nothing else."""

import dataclasses

import numpy as np
import pytest

import carom
from carom.core.layout import rotor_record
from carom.core.planar import planar_exponents
from carom.outcome import InputError
from carom.parameters import Parameters
from carom.rotors import jeffcott
from carom.shocks import shaken

PAPER = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)


def arrays(modes=2, planes=1, **changes):
    """Arrays of a rotor, the planar one with as many modes and planes."""
    given = {
        "exponents": np.resize(np.array(planar_exponents(PAPER.gamma, PAPER.omega)), modes),
        "driven": np.arange(modes) % 2 == 1,
        "offsets": np.full(planes, 0.1 + 0.2j),
        "rows": np.tile(np.resize([0j, 1.0], modes), (planes, 1)),
        "columns": np.tile(np.resize([1.0, 0j], (modes, 1)), (1, planes)),
        "friction": np.full(planes, 0.15),
        "restitution": np.full(planes, 0.95),
        "drive": np.full(planes, 58.0),
    }
    return rotor_record(**given | changes)


@pytest.mark.parametrize(
    ("record", "given"),
    [
        (arrays(4), "4 modes and 1 contact planes"),
        (shaken(jeffcott(PAPER), 1.0), "4 modes and 1 contact planes"),
        (arrays(planes=2), "2 modes and 2 contact planes"),
        (arrays(4, 3), "4 modes and 3 contact planes"),
        (arrays(1), "1 modes and 1 contact planes"),
        (arrays(0), "0 modes and 1 contact planes"),
        (arrays(planes=0), "2 modes and 0 contact planes"),
        (arrays(driven=np.array([False, False])), "2 modes and 1 contact planes, not as of a planar rotor"),
        (arrays(rows=np.array([[0.0, 2.0 + 0j]])), "2 modes and 1 contact planes, not as of a planar rotor"),
        (arrays(columns=np.array([[1.0], [0.5 + 0j]])), "2 modes and 1 contact planes, not as of a planar rotor"),
    ],
)
def test_another_rotor_is_refused(record, given):
    for make in (carom.Rotor, lambda record, parameters: dataclasses.replace(jeffcott(parameters), arrays=record)):
        with pytest.raises(InputError) as caught:
            make(record, PAPER)
        assert str(caught.value) == (
            f"rotor = {given}: 2 modes that are a pair and 1 contact plane are handled, as carom.jeffcott makes them"
        )


def test_the_planar_rotor_is_handled():
    assert carom.Rotor(arrays(), PAPER).parameters is PAPER
