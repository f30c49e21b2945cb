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

ROTORS = json.loads(Path(__file__).with_name("ross_rotors.json").read_text())


@pytest.fixture(params=ROTORS)
def ross(request):
    return ROTORS[request.param]


def rotor_of(ross):
    steel = Material(*ross["material"])
    sections = [ShaftSection(*each, steel) for each in ross["sections"]]
    return FlexibleRotor(sections, [Disc(*each) for each in ross["discs"]], ModalDamping(0.0), longest_element=100.0)


def on_springs(ross):
    """Mass, damping, stiffness and gyroscopic matrix of the rotor on its springs."""
    rotor = rotor_of(ross)
    stiffness, damping = rotor.matrices.stiffness.copy(), np.zeros_like(rotor.matrices.mass)
    for node, spring, damper in ross["springs"]:
        place = 2 * rotor.place_of(node)
        stiffness[place, place] += spring
        damping[place, place] += damper
    return rotor, rotor.matrices.mass, damping, stiffness, rotor.matrices.gyroscopic


def test_mass(ross):
    assert rotor_of(ross).mass == pytest.approx(ross["mass"], rel=1e-12)


def test_eigenvalues_at_speed(ross):
    """Forward whirls are those with positive imaginary part here; backward ones have a negative one, and ROSS lists their conjugates."""
    _, mass, damping, stiffness, gyroscopic = on_springs(ross)
    n = len(mass)
    for at in ross["eigenvalues"]:
        spin = damping - 1j * at["speed"] * gyroscopic
        accelerations = -np.linalg.solve(mass, np.concatenate([stiffness, spin], axis=1))
        values = np.linalg.eigvals(np.concatenate([np.eye(n, 2 * n, n), accelerations]))
        values = np.where(values.imag < 0.0, values.conj(), values)
        for expected in (complex(*pair) for pair in at["values"]):
            # Eigenvalues of pencils whose largest are 1e4 times as large.
            assert np.abs(values - expected).min() < 1e-8 * abs(expected)


def test_response_to_unbalance(ross):
    rotor, mass, damping, stiffness, gyroscopic = on_springs(ross)
    asked = ross["unbalance"]
    for number, speed in enumerate(asked["speeds"]):
        push = np.zeros(len(mass))
        push[2 * rotor.place_of(asked["node"])] = speed**2
        dynamic = stiffness - speed**2 * mass + 1j * speed * (damping - 1j * speed * gyroscopic)
        found = np.linalg.solve(dynamic, push)
        for node, x in zip(asked["at_nodes"], asked["x"], strict=True):
            assert found[2 * rotor.place_of(node)] == pytest.approx(complex(*x[number]), rel=1e-8)


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
