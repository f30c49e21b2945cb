"""Rotors that ROSS ships, as ``carom import-rotor`` has read them, by the numbers of ROSS itself: ``ross_imports.py`` has written both with ROSS 2.3.0.

Where ROSS can be imported, or ``CAROM_ROSS_PYTHON`` names a Python that can, the first rotor is imported again.
"""

import json
import os
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from carom.parameters import TouchdownBearing
from carom.rotors import (
    PID,
    FlexibleMachine,
    MagneticBearing,
    TouchdownPlane,
    Unbalance,
    import_rotor,
    load_machine,
    read_rotor,
)
from carom.rotors.ross_import import USUAL, ImportedRotor
from carom.rotors.starter import starter_text
from carom.rotors.synchronous import synchronous_response

from .ross_springs import OnSprings

FOLDER = Path(__file__).with_name("ross_imports")
COMPUTED = json.loads((FOLDER / "computed.json").read_text())
PYTHON = os.environ.get("CAROM_ROSS_PYTHON") or (sys.executable if find_spec("ross") else None)
WALL = TouchdownBearing("kelvin-voigt", stiffness=1e8, damping=100.0)


def rotor_of(name):
    with np.load(FOLDER / f"{name}.npz") as arrays:
        return read_rotor(FOLDER / f"{name}.npz", None if "D" in arrays else USUAL)


@pytest.mark.parametrize("name", COMPUTED)
def test_mass_eigenvalues_at_speed_and_response_to_unbalance(name):
    rotor, ross = rotor_of(name), COMPUTED[name]
    assert rotor.mass == pytest.approx(ross["mass"], rel=1e-12)
    damping = np.zeros_like(rotor.damping_matrix) if rotor.own_damping else rotor.damping_matrix
    on_springs = OnSprings(rotor, ross["springs"], damping)
    on_springs.assert_eigenvalues(ross["eigenvalues"])
    on_springs.assert_response(ross["unbalance"])


def magnetic(name):
    """The imported rotor on the magnets of its source."""
    magnets = COMPUTED[name]["bearings"]
    nodes = COMPUTED[name]["unbalance"]["at_nodes"]
    return FlexibleMachine(
        rotor_of(name),
        100.0,
        1e-3,
        [
            MagneticBearing(
                each["node"],
                each["ki"],
                each["ks"],
                PID(each["proportional"], 0.0, each["derivative"], each["filter_time"]),
            )
            for each in magnets
        ],
        [TouchdownPlane(node, WALL, 0.02, 0.1) for node in nodes],
        [Unbalance(nodes[0], 1.0)],
    )


def test_response_on_the_magnetic_bearings_of_the_source():
    """ROSS has them as stiffness and damping at the frequency of the unbalance, here they are controllers with states."""
    asked = COMPUTED["rotor_amb_example"]["magnetic"]
    found = synchronous_response(
        magnetic("rotor_amb_example"), [each["speeds"][0] for each in asked]
    ).touchdowns.forward
    expected = [[complex(*x[0]) for x in each["x"]] for each in asked]
    assert found == pytest.approx(np.array(expected), rel=1e-8)


@pytest.mark.parametrize("name", COMPUTED)
def test_the_machine_file_that_is_printed_has_the_bearings_of_the_source(name, tmp_path):
    rotor = rotor_of(name)
    found = ImportedRotor(rotor, rotor.own_damping is None, tuple(COMPUTED[name]["bearings"]))
    path = tmp_path / "machine.toml"
    path.write_text(starter_text(found, str(FOLDER.resolve() / f"{name}.npz")), encoding="utf-8")
    machine = load_machine(path)
    assert [each.node for each in machine.bearings] == [each["node"] for each in COMPUTED[name]["bearings"]]
    if name == "rotor_amb_example":
        exact = magnetic(name)
        one, other = (at.bearings[0].loop.at(np.array([3j, 3000j])) for at in (machine, exact))
        assert one == pytest.approx(other, rel=1e-12)
        # The magnets of this example hold nothing: their stiffness at rest is 0 (docs/decisions/flexible-rotors.md).
        assert exact.bearings[0].ki * 1000.0 + exact.bearings[0].ks == pytest.approx(0.0, abs=1e-9)
    else:
        assert max(machine.reduce(0.5).linear.system.exponents.real) < 0.0


@pytest.mark.skipif(PYTHON is None, reason="ROSS is not installed: pip install 'carom[ross]', or set CAROM_ROSS_PYTHON")
def test_ross_gives_the_same_again(tmp_path):
    program = tmp_path / "model.py"
    program.write_text("import ross\n\nrotor = ross.rotor_example()\nother = ross.coaxrotor_example\n")
    found, kept = import_rotor(program, None, PYTHON), rotor_of("rotor_example")
    for name in ("M", "K", "G", "nodes"):
        own = getattr(kept, name)
        assert np.allclose(getattr(found.rotor, name), own, rtol=0, atol=1e-12 * np.abs(own).max())
    assert list(found.bearings) == COMPUTED["rotor_example"]["bearings"]
