"""Rotors that ROSS ships, by its own numbers: ``ross_rotors.json``, which ``ross_rotors.py`` has written with ROSS 2.3.0."""

import json
from pathlib import Path

import numpy as np
import pytest

from carom.parameters import TouchdownBearing
from carom.rotors import (
    PID,
    Disc,
    FlexibleMachine,
    FlexibleRotor,
    MagneticBearing,
    Material,
    ModalDamping,
    ShaftSection,
    TouchdownPlane,
    Unbalance,
)
from carom.rotors.synchronous import synchronous_response

from .ross_springs import OnSprings

ROTORS = json.loads(Path(__file__).with_name("ross_rotors.json").read_text())


@pytest.fixture(params=ROTORS)
def ross(request):
    return ROTORS[request.param]


def rotor_of(ross):
    steel = Material(*ross["material"])
    sections = [ShaftSection(*each, steel) for each in ross["sections"]]
    return FlexibleRotor(sections, [Disc(*each) for each in ross["discs"]], ModalDamping(0.0), longest_element=100.0)


def test_mass_eigenvalues_at_speed_and_response_to_unbalance(ross):
    rotor = rotor_of(ross)
    assert rotor.mass == pytest.approx(ross["mass"], rel=1e-12)
    on_springs = OnSprings(rotor, ross["springs"], np.zeros_like(rotor.matrices.mass))
    on_springs.assert_eigenvalues(ross["eigenvalues"])
    on_springs.assert_response(ross["unbalance"])


def test_response_on_magnetic_bearings():
    """ROSS has them as stiffness and damping at the frequency of the unbalance, here they are controllers with states."""
    (ross,) = (each for each in ROTORS.values() if "magnetic" in each)
    asked = ross["magnetic"]
    controller = PID(asked["kp_pid"], asked["ki_pid"], asked["kd_pid"], 1.0 / asked["n_f"])
    nodes = [node for node, _, _ in ross["springs"]]
    wall = TouchdownBearing("kelvin-voigt", stiffness=1e8, damping=100.0)
    machine = FlexibleMachine(
        rotor_of(ross),
        100.0,
        1e-3,
        [MagneticBearing(node, asked["ki"], asked["ks"], controller) for node in nodes],
        [TouchdownPlane(node, wall, 0.02, 0.1) for node in asked["at_nodes"]],
        [Unbalance(asked["node"], 1.0)],
    )
    expected = np.array([[complex(*pair) for pair in row] for row in asked["x"]]).T
    assert synchronous_response(machine, asked["speeds"]).touchdowns.forward == pytest.approx(expected, rel=1e-8)
