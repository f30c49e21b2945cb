"""Controllers of several bearings: translation and tilt of a vertical flywheel, and matrices over all sensors and magnets, against SciPy."""

import dataclasses

import numpy as np
import pytest
from machines import machine_text
from refusals import assert_refused
from scipy.linalg import eigvals

import carom as cm
from carom.rotors import PID, ForcePID, MomentPID, SharedController, StateSpace, load_machine, sensitivity

FILE = machine_text("flywheel")
MASS, TILTED, POLAR, SPEED = 293.1, 36.8927, 5.4238, 1000.0 * np.pi
AT, KS = np.array([0.650, -0.825]), 1.348e7
ROWS = np.stack([np.ones(2), AT], axis=1)
MATRIX = np.diag([MASS, TILTED])


@pytest.fixture
def flywheel(tmp_path):
    path = tmp_path / "flywheel.toml"
    path.write_text(FILE, encoding="utf-8")
    return path


def test_the_flywheel_of_the_literature_goes_into_a_file_as_it_stands(flywheel):
    """Total force and moment of the controller are met by both magnets; poles without control as printed."""
    magnets = -KS * ROWS.T @ ROWS
    falls = np.sqrt(np.sort(eigvals(-np.linalg.solve(MATRIX, magnets)).real)) / (2.0 * np.pi)
    assert falls == pytest.approx([47.836, 101.249], abs=5e-4)
    alone = np.sqrt([2.0 * KS / MASS, KS * (AT @ AT) / TILTED]) / (2.0 * np.pi)
    assert alone == pytest.approx([48.269, 101.043], abs=5e-4)
    machine = load_machine(flywheel)
    off = dataclasses.replace(
        machine, bearings=[dataclasses.replace(each, gain_factor=1e-6) for each in machine.bearings]
    )
    found = np.sort(off.whole.equations.exponents(1e-6)[0].real)[-2:]  # a controller of a millionth
    assert found / (2.0 * np.pi) == pytest.approx([47.836, 101.249], abs=1.5e-3)
    spring, damper = np.diag([1.2639e8, 7.6992e7]) + magnets, np.diag([252790.0, 80294.0])
    spin = damper - 1j * SPEED * np.diag([0.0, POLAR])
    inner = -np.linalg.solve(MATRIX, np.concatenate([spring, spin], axis=1))
    expected = np.sort_complex(eigvals(np.concatenate([np.eye(2, 4, 2), inner])))
    assert np.sort_complex(machine.whole.equations.exponents(SPEED)[0]) == pytest.approx(expected, rel=1e-10)
    case = cm.load(flywheel)
    model = case.parameters.system.exponents * SPEED + 1j * SPEED
    assert np.sort_complex(model) == pytest.approx(expected, rel=1e-10)
    # One direction at a sensor, by all loops: S = 1 − (row)(…)⁻¹(gain), of the forward and the backward whirl.
    s, gain = 400j, np.diag([1.2639e8 + 400j * 252790.0, 7.6992e7 + 400j * 80294.0])
    shares = np.linalg.inv(ROWS.T)

    def seen(sense):
        dynamic = MATRIX * s**2 + magnets - 1j * sense * SPEED * s * np.diag([0.0, POLAR]) + gain
        return 1.0 - np.diag(ROWS @ np.linalg.solve(dynamic, ROWS.T @ shares @ gain @ np.linalg.inv(ROWS)))

    both = 0.5 * (seen(1.0) + seen(-1.0))
    assert sensitivity(machine, [399.0, 400.0, 401.0]).values[1] == pytest.approx(both, rel=1e-9)
    assert len(cm.simulate(case, cm.drop(), "30 ms").contacts)


def test_its_gains_are_parameters_and_it_is_written_as_it_is_read(flywheel, tmp_path):
    case = cm.load(flywheel)
    changed = case.parameters.replace(tilt_derivative="90000 N m s/rad", translation_proportional=1.3e8)
    path = tmp_path / "again.toml"
    path.write_text(changed.finite_elements.to_toml(), encoding="utf-8")
    again = cm.load(path).parameters
    assert again.value("tilt_derivative") == 9e4
    assert np.sort_complex(again.system.exponents) == pytest.approx(
        np.sort_complex(changed.system.exponents), rel=1e-12
    )
    set_there = cm.load(flywheel, ["tilt_derivative=9e4", "translation_proportional=1.3e8"]).parameters
    assert np.array_equal(set_there.equations.damping, changed.equations.damping)


def test_force_and_moment_are_met_with_sensors_elsewhere_and_amplifiers(flywheel):
    """Currents of all magnets by ``z`` and ``θ``: force and moment are the controllers', each behind its amplifier."""
    text = FILE.replace(
        'ki = "819.10 N/A"', 'ki = "500 N/A"\namplifier_bandwidth = "2 kHz"\nsensor_positions = [0.4, 0.7]', 1
    )
    text = text.replace(
        'ki = "819.10 N/A"',
        'ki = "819.10 N/A"\namplifier_bandwidth = "2 kHz"\ndelay = "20 us"\ncurrent_limit = "20 A"',
        1,
    )
    flywheel.write_text(text, encoding="utf-8")
    machine = load_machine(flywheel)
    shared = machine.shared_controllers[0]
    s, seen = 700j, np.array([[1.0, 0.55], [1.0, -0.825]])
    forces = np.array([500.0, 819.1])[:, None] * shared.system(machine.rotor, machine.bearings).at(np.array(s)) @ seen
    behind = np.array([1.0, 1.0 / shared_delay(s)]) * (1.0 + s / (4e3 * np.pi))
    found = ROWS.T @ (behind[:, None] * forces)
    expected = np.diag([1.2639e8 + s * 252790.0, 7.6992e7 + s * 80294.0])
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-1)
    amplifier = machine.whole.equations.amplifiers
    assert amplifier.tolist() == [len(machine.whole.equations.mass) - 2, len(machine.whole.equations.mass) - 1]
    (limit,) = machine.whole.limits
    with_rates = limit.displacement[:2] + limit.velocity[:2]
    assert with_rates.any()


def shared_delay(s):
    turned = 20e-6 * s
    odd, even = turned / 2.0 + turned**3 / 120.0, 1.0 + turned**2 / 10.0
    return (even - odd) / (even + odd)


def test_matrices_over_all_bearings_are_their_own_controllers(flywheel):
    laws = [PID(3e5, 1e5, 400.0, 2e-4), PID(2.5e5, 0.0, 300.0, 1e-4)]
    machine = load_machine(flywheel)
    own = [dataclasses.replace(each, controller=law) for each, law in zip(machine.bearings, laws, strict=True)]
    apart = dataclasses.replace(machine, bearings=own, shared_controllers=())
    spaces = [law.state_space for law in laws]
    A = np.zeros((3, 3))
    A[:2, :2], A[2:, 2:] = spaces[0].A, spaces[1].A
    B, C = np.zeros((3, 2)), np.zeros((2, 3))
    B[:2, :1], B[2:, 1:], C[:1, :2], C[1:, 2:] = spaces[0].B, spaces[1].B, spaces[0].C, spaces[1].C
    together = SharedController(matrices=StateSpace(A, B, C, np.diag([float(each.D[0, 0]) for each in spaces])))
    one, other = (
        np.sort_complex(each.whole.equations.exponents(SPEED)[0])
        for each in (apart, dataclasses.replace(machine, shared_controllers=[together]))
    )
    assert other == pytest.approx(one, rel=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            "[[shared_controller]]\n",
            "[[shared_controller]]\nbearings = [1]\n",
            r"^shared_controller: bearings = \[1\]: two or more",
        ),
        (
            "filter_time = 0\n[shared",
            "filter_tame = 0\n[shared",
            r"shared_controller\]\] 1: filter_tame .*unknown name",
        ),
        (
            'ki = "819.10 N/A"',
            'proportional = 5\nki = "819.10 N/A"',
            r"^\[\[magnetic_bearing\]\] 1: controller = several: one controller",
        ),
        (
            '"1.2639e8 N/m"',
            '"1.2639e8 A/m"',
            r"shared_controller\]\] 1: proportional = 1.2639e8 A/m: must be a gain in N/m",
        ),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(flywheel, old, new, says):
    assert old in FILE
    flywheel.write_text(FILE.replace(old, new, 1), encoding="utf-8")
    assert_refused(lambda: load_machine(flywheel), says)


def test_gains_in_wrong_units_are_refused():
    assert_refused(
        lambda: SharedController(translation=ForcePID(1.0), tilt=ForcePID(1.0)),
        r"^tilt = ForcePID: carom.rotors.MomentPID",
    )
    assert_refused(
        lambda: SharedController(tilt=MomentPID(1.0)),
        r"^shared_controller = tilt: translation and tilt, or A, B, C and D",
    )
