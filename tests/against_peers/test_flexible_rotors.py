"""Rotors that ROSS ships, by its own numbers: ``ross_rotors.json``, which ``ross_rotors.py`` has written with ROSS 2.3.0."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from carom.rotors import Disc, FlexibleRotor, Material, ModalDamping, Section

ROTORS = json.loads(Path(__file__).with_name("ross_rotors.json").read_text())


@pytest.fixture(params=ROTORS)
def ross(request):
    return ROTORS[request.param]


def rotor_of(ross):
    steel = Material(*ross["material"])
    sections = [Section(*each, steel) for each in ross["sections"]]
    return FlexibleRotor(sections, [Disc(*each) for each in ross["discs"]], ModalDamping(0.0), longest_element=100.0)


def on_springs(ross):
    """Mass, damping, stiffness and gyroscopic matrix of the rotor on its springs."""
    rotor = rotor_of(ross)
    stiffness, damping = rotor.stiffness_matrix.copy(), np.zeros_like(rotor.mass_matrix)
    for node, spring, damper in ross["springs"]:
        place = rotor.displacement_at(node)
        stiffness[place, place] += spring
        damping[place, place] += damper
    return rotor, rotor.mass_matrix, damping, stiffness, rotor.gyroscopic_matrix


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
        push[rotor.displacement_at(asked["node"])] = speed**2
        dynamic = stiffness - speed**2 * mass + 1j * speed * (damping - 1j * speed * gyroscopic)
        found = np.linalg.solve(dynamic, push)
        for node, x in zip(asked["at_nodes"], asked["x"], strict=True):
            assert found[rotor.displacement_at(node)] == pytest.approx(complex(*x[number]), rel=1e-8)
