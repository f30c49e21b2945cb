"""A rotor of ROSS on anisotropic bearings, by the numbers of ROSS itself: ``ross_supports.py`` has written them with ROSS 2.3.0."""

import json
from pathlib import Path

import numpy as np
import pytest

from carom.parameters import TouchdownBearing
from carom.rotors import (
    FlexibleMachine,
    ModalDamping,
    Support,
    TouchdownPlane,
    Unbalance,
    find_whirls,
    read_rotor,
)
from carom.rotors.synchronous import synchronous_response

FOLDER = Path(__file__).parent
COMPUTED = json.loads((FOLDER / "ross_supports.json").read_text())
ASKED = COMPUTED["unbalance"]
WALL = TouchdownBearing("kelvin-voigt", stiffness=1e8, damping=100.0)
MACHINE = FlexibleMachine(
    read_rotor(FOLDER / "ross_imports" / "rotor_example.npz", ModalDamping(0.0)),
    100.0,
    1e-3,
    [],
    [TouchdownPlane(node, WALL, 0.02, 0.1) for node in ASKED["at_nodes"]],
    [Unbalance(ASKED["node"], 1.0)],
    supports=[Support(**numbers) for numbers in COMPUTED["supports"]],
)


def numbers(pairs):
    return np.array([complex(*pair) for pair in pairs])


@pytest.mark.parametrize("at", COMPUTED["eigenvalues"], ids=lambda at: f"{at['speed']:g}")
def test_eigenvalues_at_speed(at):
    expected = numbers(at["values"])
    found = find_whirls(MACHINE, at["speed"], len(expected))
    # Eigenvalues of pencils whose largest are 1e4 times as large.
    assert [each.exponent.real for each in found] == pytest.approx(expected.real, abs=1e-8 * expected.imag.max())
    assert [abs(each.exponent.imag) for each in found] == pytest.approx(expected.imag, rel=1e-8)
    assert {each.sense for each in found} == {"forward", "backward"}


def test_response_to_unbalance():
    found = synchronous_response(MACHINE, ASKED["speeds"]).touchdowns
    for place in range(len(ASKED["at_nodes"])):
        # x = Re(X e^{iΩt}) and y = Re(Y e^{iΩt})
        along, across = numbers(ASKED["x"][place]), numbers(ASKED["y"][place])
        assert found.forward[:, place] == pytest.approx(0.5 * (along + 1j * across), rel=1e-8)
        assert found.backward[:, place] == pytest.approx(0.5 * (along - 1j * across).conj(), rel=1e-8)
