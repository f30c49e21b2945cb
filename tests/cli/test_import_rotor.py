"""``carom import-rotor``: matrices, ROSS in a process of its own, and the machine file that is printed."""

import json
import sys

import numpy as np
import pytest
from flexible_machines import munich_rotor

import carom as cm
from carom.cli.app import BAD_INPUT, main
from carom.rotors import ross_import

SHAFT = munich_rotor(1.0)
ARRAYS = {name: 0.5 * (own + own.T) for name, own in zip("MKG", SHAFT.matrices, strict=True)} | {"nodes": SHAFT.places}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savez("given.npz", **ARRAYS)
    return tmp_path


def test_the_printed_file_loads_beside_the_matrices(folder, capsys):
    assert main(["import-rotor", "given.npz", "-o", "rotor.npz"]) == 0
    text = capsys.readouterr().out
    assert 'source = "rotor.npz"' in text
    assert text.count("ASSUMED") > 4
    (folder / "machine.toml").write_text(text, encoding="utf-8")
    case = cm.load(folder / "machine.toml")
    assert case.parameters.scales.mass == pytest.approx(SHAFT.mass, rel=1e-9)


def test_as_json(folder, capsys):
    assert main(["import-rotor", "given.npz", "-o", "rotor.npz", "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["mass_si"] == pytest.approx(SHAFT.mass, rel=1e-9)
    assert shown["free_frequencies_si"][0] == pytest.approx(SHAFT.free_modes.frequencies[2] / 2.0 / np.pi, rel=1e-6)
    assert shown["damped"] is False
    assert "[[touchdown]]" in shown["machine_file"]


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["none.npz"], "rotor file = none.npz: there is no such file"),
        (["none.py"], "source = none.py: there is no such file"),
        (["given.npz", "-o", "rotor.mat"], "rotor file = rotor.mat: a name that ends in .npz"),
        (["model.py", "--python", "no-such-python"], "python = no-such-python: a Python that has ROSS"),
        (["broken.py"], "source = broken.py: a file that ROSS can read; it ended with: ZeroDivisionError"),
        (["empty.py"], "rotors = none: one rotor of ROSS in empty.py, or --name"),
        (["empty.py", "--name", "one"], "name = one: the name of a rotor"),
        (["empty.py", "--name", "number"], "name = number, a int: a rotor of ROSS"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(folder, refused, words, says):
    """A package called ``ross`` stands in for ROSS where the program only has to begin with it."""
    (folder / "ross.py").write_text("class Rotor: pass\n")
    for name, text in {"model.py": "", "broken.py": "1 / 0\n", "empty.py": "number = 3\n"}.items():
        (folder / name).write_text(text)
    refused(says, "import-rotor", *(["-o", "rotor.npz"] if "-o" not in words else []), *words)


def test_without_ross_it_says_how_to_get_it(folder, capsys):
    (folder / "ross.py").write_text("raise ImportError('no ROSS here')\n")
    (folder / "model.py").write_text("")
    assert main(["import-rotor", "model.py", "-o", "rotor.npz"]) == BAD_INPUT
    assert "ross = no ROSS here: an installed ROSS: pip install 'carom[ross]', or --python" in capsys.readouterr().err


def test_bearings_without_gains_are_assumed_and_told(folder, capsys, monkeypatch):
    """A saved magnetic bearing has lost its gains, and a spring is no magnetic bearing."""
    np.savez("rotor.npz", **ARRAYS)
    magnet = {"node": 3, "tag": "AMB", "kind": "MagneticBearingElement", "ki": 50.0, "ks": -1e5}
    spring = {"node": 5, "tag": "Ball", "kind": "BearingElement", "stiffness": 2e6, "damping": 300.0, "alike": True}
    rotor, _ = ross_import._of_matrices(folder / "rotor.npz")
    for bearings, says in (
        ((magnet,), "the gains are not in the saved file"),
        ((spring,), "# Ball, a BearingElement at node 5"),
    ):
        found = ross_import.ImportedRotor(rotor, False, bearings, ("Mass 1: left out",), 300.0)
        monkeypatch.setattr("carom.rotors.ross_import.import_rotor", lambda *_, found=found: found)
        assert main(["import-rotor", "model.py", "-o", "rotor.npz", "--python", sys.executable]) == 0
        text = capsys.readouterr().out
        assert says in text
        assert 'speed = "300 rad/s"' in text
        assert "# Mass 1: left out" in text
        (folder / "machine.toml").write_text(text, encoding="utf-8")
        (bearing,) = cm.rotors.load_machine(folder / "machine.toml").bearings
        assert bearing.ki * bearing.controller.proportional + bearing.ks > 1e5


def test_seals_and_bearings_that_act_differently_in_two_directions_are_taken_over(folder, capsys, monkeypatch):
    np.savez("rotor.npz", **ARRAYS)
    numbers = {"kxx": 2e6, "kxy": 1e5, "kyx": -2e5, "kyy": 3e6, "cxx": 300.0, "cxy": 0.0, "cyx": 0.0, "cyy": 200.0}
    usual = {"stiffness": 2e6, "damping": 300.0, "coefficients": numbers}
    magnet = {"node": 3, "tag": "AMB", "kind": "MagneticBearingElement", "ki": 50.0, "ks": -1e5}
    film = {"node": 5, "tag": "Film", "kind": "BearingElement", "alike": False, **usual}
    seal = {"node": 2, "tag": "Seal", "kind": "SealElement", "alike": False, **usual}
    rotor, _ = ross_import._of_matrices(folder / "rotor.npz")
    for bearings, held, nodes in (
        ((magnet, film, seal), [3], [5, 2]),
        ((film, {**film, "node": 0}), [], [5, 0]),
        ((seal,), [0, len(rotor.nodes) - 1], [2]),
    ):
        found = ross_import.ImportedRotor(rotor, False, bearings, (), 300.0)
        monkeypatch.setattr("carom.rotors.ross_import.import_rotor", lambda *_, found=found: found)
        assert main(["import-rotor", "model.py", "-o", "rotor.npz", "--python", sys.executable]) == 0
        text = capsys.readouterr().out
        (folder / "machine.toml").write_text(text, encoding="utf-8")
        machine = cm.rotors.load_machine(folder / "machine.toml")
        assert [each.node for each in machine.bearings] == held
        assert [each.node for each in machine.supports] == nodes
        assert all(getattr(machine.supports[0], name) == value for name, value in numbers.items())
