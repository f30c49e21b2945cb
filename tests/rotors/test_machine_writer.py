"""Machine files that cases write: what is read from them is the same case, to the last bit."""

from pathlib import Path

import numpy as np
import pytest
from machines import machine_text

from carom.loading import load
from carom.models import rotor_of
from carom.rotors import FlexibleMachine, MatrixRotor, write_rotor

FILES = [path for folder in ("examples", "tests/machines") for path in sorted(Path(folder).glob("*.toml"))]
OTHERS = (
    [],
    ["speed=1234 rpm", "gravity=1.62 m/s^2", "mu=0.21", "damping_ratio=0.07"],
    ["speed=2345 rpm", "gravity=1.62 m/s^2", "friction=0.21", "accuracy=0.2", "clearance=0.3 mm"],
)


@pytest.fixture
def write(tmp_path):
    """Write the text of a machine file and return its path."""

    def write(text):
        path = tmp_path / "again.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def assert_same(again, case):
    """Whether two cases are equal to the last bit, of a rotor of parts by all data that define it."""
    beside = ("zones", "limits", "requirement", "gravity", "touchdown", "drive", "machine")
    assert [getattr(again, name) for name in beside] == [getattr(case, name) for name in beside]
    assert again.parameters.scales == case.parameters.scales
    assert again.parameters.attributes() == case.parameters.attributes()
    one, other = (rotor_of(each).system.arrays for each in (again, case))
    for name in one.dtype.names:
        np.testing.assert_array_equal(one[name], other[name])


@pytest.mark.parametrize(
    "path", [path for path in FILES if not path.name.startswith("sweep")], ids=lambda path: path.stem
)
def test_a_case_writes_a_file_that_is_read_as_the_same_case(path, write):
    with_parts = "[rotor]" in path.read_text(encoding="utf-8")
    for settings in (
        OTHERS[::2] if with_parts else OTHERS[:2] if "[machine]" in path.read_text(encoding="utf-8") else [[]]
    ):
        if path.stem == "overhung-rotor":  # it has no accuracy, for it has all its modes
            settings = [each for each in settings if "accuracy" not in each]
        case = load(path, settings)
        assert_same(load(write(case.to_toml())), case)


def test_a_rotor_of_a_file_of_matrices_is_written_with_that_file(write, tmp_path):
    rotor = load("examples/tum-flexible-rotor.toml").parameters.finite_elements.machine.rotor
    size = len(rotor.matrices.mass)
    matrices = MatrixRotor(*rotor.matrices[:2], rotor.matrices.gyroscopic, rotor.places, np.zeros((size, size)))
    write_rotor(matrices, tmp_path / "rotor.npz")
    text = machine_text("of-matrices")
    case = load(write(text), ["clearance_1=0.25 mm", "modes=7"])
    assert_same(load(write(case.to_toml())), case)
    assert case.replace(clearance=0.0004).to_toml().count("clearance") == 1  # of all, in [rotor]
    unsaved = FlexibleMachine(matrices, 300.0, 2e-4, (), case.parameters.finite_elements.machine.touchdowns)
    assert unsaved.with_modes(4).to_toml() == ""
