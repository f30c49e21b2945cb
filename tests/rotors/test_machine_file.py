"""Flexible machines in machine files: what they say, what may be set, and errors that name the table."""

from pathlib import Path

import numpy as np
import pytest
from flexible_machines import munich
from machines import machine_text

import carom as cm
from carom.base.outcome import InputError
from carom.models import rotor_of
from carom.rotors import PID, FlexibleMachine, MatrixRotor, StateSpace, write_rotor

EXAMPLE = Path("examples/tum-flexible-rotor.toml")
SMALL = machine_text("flexible")


@pytest.fixture
def load(tmp_path):
    def read(text, *settings):
        path = tmp_path / "flexible.toml"
        path.write_text(text, encoding="utf-8")
        return cm.load(path, settings)

    return read


def test_the_example_is_the_rig_in_python():
    case = cm.load(EXAMPLE)
    machine = munich(0.702 / 32.0)
    expected = machine.reduce().linear
    assert case.parameters.planar is None
    assert case.parameters.scales == expected.scales
    for name in ("mass", "damping", "stiffness", "unlevitated", "forcing", "planes"):
        found, own = getattr(case.parameters.equations, name), getattr(expected.equations, name)
        # Lengths between nodes are rounded when they are written down.
        assert np.allclose(found, own, rtol=0, atol=1e-9 * np.abs(own).max())
    assert rotor_of(case).forces
    assert "Case tum-flexible-rotor" in repr(case)


def test_controllers_of_all_kinds_are_the_same(load):
    """``9000 + 10 s/(1 + 1e-4 s)``, by gains, as a quotient, and as matrices."""
    space = PID(9000.0, 0.0, 10.0, 1e-4).state_space
    assert isinstance(space, StateSpace)
    matrices = f"A = {space.A.tolist()}\nB = {space.B.tolist()}\nC = {space.C.tolist()}\nD = {space.D.tolist()}"
    quotient = "numerator = [10.9, 9000]\ndenominator = [1e-4, 1]"
    gains = "proportional = 9000\nderivative = 10\nfilter_time = '0.1 ms'"
    one = load(SMALL).parameters.system.exponents
    for way in (gains, matrices):
        other = load(SMALL.replace(quotient, way)).parameters.system.exponents
        for exponent in one:
            assert np.abs(other - exponent).min() < 1e-9 * (1.0 + abs(exponent))


CHAINS = (
    """sensor_gain = "10 V/mm"
amplifier_gain = "0.5 A/V"
proportional = 1.8
derivative = "2 ms"
filter_time = "0.1 ms"
[[magnetic_bearing.filter]]
notch_frequency = "850 Hz"
notch_floor = 0.2
[[magnetic_bearing.filter]]
lead_zero = "300 Hz"
lead_pole = "900 Hz\"""",
    """zeros = [[-900, 20]]
poles = [-10000, -9000]
gain = 1e6""",
    """sos = [[109000, -101000, 0, 1, -0.1, 0]]
sample_time = "20 us\"""",
)


@pytest.mark.parametrize("chain", CHAINS)
def test_every_controller_has_parameters_and_is_written_as_it_is_read(load, tmp_path, chain):
    quotient = "numerator = [10.9, 9000]\ndenominator = [1e-4, 1]"
    case = load(SMALL.replace(quotient, chain))
    reduced = case.parameters.finite_elements
    number = len(reduced.machine.bearings)
    again = load(reduced.to_toml()).parameters.finite_elements.machine.bearings
    assert [each.controller for each in again] == [each.controller for each in reduced.machine.bearings]
    names = [name for name in reduced.machine.varied if name.endswith(f"_{number}") and name in case.parameters.varied]
    for name in names:
        value = case.parameters.value(name)
        changed = case.parameters.replace(**{name: 1.001 * value})
        assert changed.value(name) == pytest.approx(1.001 * value, rel=1e-15), name
        assert load(SMALL.replace(quotient, chain), f"{name}={1.001 * value!r}").parameters.value(
            name
        ) == changed.value(name)
    of_loop = {"filter1_notch_floor": 2, "zero1_imaginary": 2, "sos1_b1": 2, "sample_time": 2}
    assert any(f"{name}_{number}" in names for name in of_loop)
    assert f"gain_factor_{number}" in names


def without(text, line):
    assert line in text
    return text.replace(line, "")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (SMALL.replace('length = "0.4 m"', 'lenght = "0.4 m"'), r"\[\[section\]\] 2: lenght = .*did you mean length"),
        (without(SMALL, "node = 3\n"), r"^\[\[disc\]\] 1: node = nothing given: must be stated$"),
        (SMALL.replace("node = 3", "node = 4"), r"^disc node = 4: a node of the shaft: 0 to 3"),
        (SMALL.replace("node = 2", "node = 7"), r"^\[\[magnetic_bearing\]\] 2: node = 7: a node of the shaft: 0 to 3"),
        (
            SMALL.replace("proportional = 9000", "proportional = 9000\nA = [[1]]"),
            r"^\[\[magnetic_bearing\]\] 1: controller = proportional, A: one of: proportional",
        ),
        (SMALL.replace("friction = 0.1", "friction = -1"), r"^\[\[touchdown\]\] 1: friction = -1: must be a number"),
        (
            SMALL.replace('law = "kelvin-voigt"', 'law = "rigid"'),
            r"^\[\[touchdown\]\] 1: law = rigid: must be one of kelvin-v",
        ),
        (SMALL[: SMALL.index("[[touchdown]]")], r"^\[\[touchdown\]\] = nothing given: one or more tables"),
        (
            SMALL[: SMALL.index("[[section]]")] + SMALL[SMALL.index("[[disc]]") :],
            r"^\[\[section\]\] = nothing given: one",
        ),
        (SMALL.replace("-1e5 N/m", "1e5 N/m"), r"1: ks = 1e5 N/m: must be a stiffness in N/m, <= 0 \(0, or -1e"),
        (SMALL.replace("damping_ratio = 0.01", ""), r"^damping = nothing given: one of: damping_ratio"),
        (SMALL.replace("accuracy = 0.5", "damping_of_mass = 1"), r"^damping = both: one of: damping_ratio"),
        (SMALL.replace("accuracy", "acuracy"), r"^acuracy = 0.5: .*did you mean accuracy"),
        (
            SMALL + "[machine]\nmass = 1\n",
            r"must hold a \[machine\], a \[dimensionless\] or a \[rotor\] table, one of them",
        ),
        (
            "[rotor]\nspeed = 1\n[section]\nlength = 1\n",
            r"^section = .*: must be tables that start with the line \[\[section\]\]",
        ),
        ("[machine]\nmass = 1\n[[section]]\nlength = 1\n", r"section = .*: belongs to a file with a \[rotor\] table"),
        (
            SMALL.replace("ki = 50", "ki = 5", 1).replace("ki = 50", "ki = 5"),
            r"^levitation = unstable: a displacement to",
        ),
    ],
)
def test_what_cannot_be_used_is_refused_by_its_table(load, text, says):
    with pytest.raises(InputError, match=says):
        load(text)


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        ("mass=3 kg", r"^mass = 3 kg: unknown name in this machine.*; allowed: speed, clearance, "),
        ("speed", r"^--set = speed: must be name=value"),
        ("gravity=up", r"^gravity = up: must be an acceleration"),
    ],
)
def test_what_cannot_be_set_is_refused(load, setting, says):
    with pytest.raises(InputError, match=says):
        load(SMALL, setting)


UBERLANDIA = "examples/uberlandia-flexible-rotor.toml"


def test_the_rig_of_uberlandia_has_the_dimensions_of_its_source():
    """Mass, centre and laminations by sums over the cylinders of the source, whose laminations are eight discs at each end."""
    machine = cm.rotors.load_machine(UBERLANDIA)
    ends = [0, 12, 92, 165.4, 190.5, 358, 370.5, 535.6, 560.7, 634.1, 646.1]
    diameters = [6.35, 32, 34.8, 49.9, 19.05, 54, 19.05, 49.9, 34.8, 6.35]
    bodies = [(7850.0, 0.0, d, b - a, 0.5 * (a + b)) for a, b, d in zip(ends[:-1], ends[1:], diameters, strict=True)]
    bodies += [(7850.0, 54.0, 120.0, width, place) for width, place in ((4, 358), (7, 364), (14, 370.5))]
    bodies += [(7700.0, 34.8, 49.8, 53.3, place) for place in (138.7, 587.4)]
    masses = np.array(
        [density * np.pi / 4.0 * (outer**2 - inner**2) * length * 1e-9 for density, inner, outer, length, _ in bodies]
    )
    assert machine.rotor.mass == pytest.approx(masses.sum(), rel=1e-12)
    assert machine.rotor.centre == pytest.approx(
        1e-3 * (masses @ [each[-1] for each in bodies]) / masses.sum(), rel=1e-12
    )
    # Force of a pair of magnets at 0.392 rad, linearised: Schweitzer and Maslen, Magnetic Bearings, 2009, section 3.1.
    gap, factor = 0.432e-3, 4e-7 * np.pi * 138**2 * 470.3e-6 * np.cos(0.392)
    for each in machine.bearings:
        assert each.ki == pytest.approx(factor / gap**2, rel=1e-3)  # rounded to three digits in the file
        assert each.ks == pytest.approx(-factor / gap**3, rel=1e-3)


def test_a_machine_with_all_modes_is_read_with_its_settings(tmp_path):
    machine = cm.rotors.load_machine(EXAMPLE, ["speed=6000 rpm", "gravity=1.62 m/s^2"])
    assert machine.speed == pytest.approx(200.0 * np.pi)
    assert machine.gravity.acceleration == 1.62
    case = cm.load(EXAMPLE, ["speed=6000 rpm"])
    assert np.allclose(
        machine.reduce().linear.equations.stiffness, case.parameters.equations.stiffness, rtol=1e-12, atol=0
    )
    with pytest.raises(
        InputError, match=r"^machine file = examples/keogh-cole.toml: a \[rotor\] table; it holds \[machine\]$"
    ):
        cm.rotors.load_machine("examples/keogh-cole.toml")


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
        case = cm.load(path, settings)
        assert_same(cm.load(write(case.to_toml())), case)


def test_a_rotor_of_a_file_of_matrices_is_written_with_that_file(write, tmp_path):
    rotor = cm.load("examples/tum-flexible-rotor.toml").parameters.finite_elements.machine.rotor
    size = len(rotor.matrices.mass)
    matrices = MatrixRotor(*rotor.matrices[:2], rotor.matrices.gyroscopic, rotor.places, np.zeros((size, size)))
    write_rotor(matrices, tmp_path / "rotor.npz")
    text = machine_text("of-matrices")
    case = cm.load(write(text), ["clearance_1=0.25 mm", "modes=7"])
    assert_same(cm.load(write(case.to_toml())), case)
    assert case.replace(clearance=0.0004).to_toml().count("clearance") == 1  # of all, in [rotor]
    unsaved = FlexibleMachine(matrices, 300.0, 2e-4, (), case.parameters.finite_elements.machine.touchdowns)
    assert unsaved.with_modes(4).to_toml() == ""
