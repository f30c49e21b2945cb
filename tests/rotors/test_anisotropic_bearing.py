"""Magnetic bearings whose two axes differ, against real equations of both axes in SciPy."""

import dataclasses

import numpy as np
import pytest
from machines import machine_text
from refusals import assert_refused
from scipy.linalg import eigvals

import carom as cm
from carom.rotors import load_machine, sensitivity

FILE = machine_text("flywheel")
FIRST = FILE[: FILE.index("[[shared_controller]]")]
REST = FILE[FILE.index("[[touchdown]]") :]
GAINS = 'proportional = "7e4 A/m"\nintegral = "1e5 A/m/s"\nderivative = "140 A s/m"\nfilter_time = "0.2 ms"\naxis_angle = "25 deg"\n'
SECOND = '[magnetic_bearing.y]\nks = "-1.1e7 N/m"\nproportional = "1e5 A/m"\nderivative = "90 A s/m"\nfilter_time = "0.1 ms"\namplifier_bandwidth = "3 kHz"\n[[magnetic_bearing.y.filter]]\nlead_zero = "2 kHz"\nlead_pole = "3 kHz"\n'
HEAD, ONE, TWO = FIRST.split("[[magnetic_bearing]]\n")
TEXT = f"{HEAD}[[magnetic_bearing]]\n{ONE}{GAINS}{SECOND}[[magnetic_bearing]]\n{TWO}{GAINS}{REST}"
MASS, TILTED, POLAR, SPEED, AT, KI = 293.1, 36.8927, 5.4238, 1000.0 * np.pi, (0.650, -0.825), 819.10


@pytest.fixture
def path(tmp_path):
    found = tmp_path / "axes.toml"
    found.write_text(TEXT, encoding="utf-8")
    return found


def real_matrix(machine):
    """Rates of ``(x, θ_x, y, θ_y)``, their rates, and the states of all controllers, axis by axis."""
    axes = []
    for bearing in machine.bearings:
        along = np.array([np.cos(bearing.axis_angle), np.sin(bearing.axis_angle)])
        second = bearing if bearing.y is None else bearing.y
        axes += [(bearing, bearing.loop, along), (bearing, second.loop, np.array([-along[1], along[0]]))]
        axes[-1] = (dataclasses.replace(bearing, ks=second.ks, y=None), *axes[-1][1:])
    size = 8 + sum(loop.states for _, loop, _ in axes)
    matrix, first, places = np.zeros((size, size)), 8, dict(enumerate(AT))
    matrix[:4, 4:8] = np.eye(4)
    inertia = np.diag([1.0 / MASS, 1.0 / TILTED] * 2)
    spin = np.zeros((4, 4))
    spin[1, 3], spin[3, 1] = -SPEED * POLAR, SPEED * POLAR  # I θ̈ − iΩJ θ̇ = 0
    matrix[4:8, 4:8] = inertia @ spin
    for number, (bearing, loop, along) in enumerate(axes):
        row, own = np.kron(along, [1.0, places[number // 2]]), slice(first, first + loop.states)
        forces = -np.outer(row, np.concatenate([(KI * loop.D[0, 0] + bearing.ks) * row]))
        matrix[4:8, :4] += inertia @ forces
        matrix[4:8, own] -= inertia @ np.outer(row, KI * loop.C[0])
        matrix[own, :4], matrix[own, own] = np.outer(loop.B[:, 0], row), loop.A
        first = own.stop
    return matrix


def test_exponents_are_those_of_both_axes(path):
    machine = load_machine(path)
    expected = eigvals(real_matrix(machine))
    found = machine.whole.equations.both.exponents(SPEED)[0]
    for each in expected:
        assert np.abs(found - each).min() < 1e-8 * (1.0 + abs(each))
    case = cm.load(path)
    for each in expected[expected.imag >= 0.0]:
        assert np.abs(case.parameters.system.exponents * SPEED + 1j * SPEED - each).min() < 1e-8 * SPEED


def test_sensitivity_is_that_of_the_real_loops(path):
    """A signal added to what a controller sees comes back to it through all loops."""
    machine = load_machine(path)
    matrix, s = real_matrix(machine), 400j
    found = sensitivity(machine, [399.0, 400.0, 401.0]).values[1]
    first = 8
    for number, bearing in enumerate(machine.bearings):
        sizes = []
        for axis, loop in enumerate((bearing.loop, (bearing.y or bearing).loop)):
            angle = bearing.axis_angle + axis * np.pi / 2.0
            row, added = np.kron([np.cos(angle), np.sin(angle)], [1.0, AT[number]]), np.zeros(len(matrix))
            added[4:8] = -np.array([1.0 / MASS, 1.0 / TILTED] * 2) * row * KI * loop.D[0, 0]
            added[first : first + loop.states] = loop.B[:, 0]
            sizes.append(abs(1.0 + row @ np.linalg.solve(s * np.eye(len(matrix)) - matrix, added)[:4]))
            first += loop.states
        assert np.abs(np.array(sizes) / abs(found[number]) - 1.0).min() < 1e-8


def test_equal_axes_are_those_of_one_controller(path):
    same = TEXT.replace(SECOND, "")
    path.write_text(same, encoding="utf-8")
    one = load_machine(path)
    twice = [dataclasses.replace(each, y=each) for each in one.bearings]
    other = dataclasses.replace(one, bearings=twice)
    assert not other.whole.equations.is_anisotropic
    assert np.array_equal(other.whole.equations.stiffness, one.whole.equations.stiffness)


def test_levitation_is_lost_along_both_axes_and_regained(path):
    case = cm.load(path)
    lost = case.parameters.equations.without_levitation()
    assert lost.conjugate is None
    dropped = cm.simulate(case, cm.drop(), "20 ms")
    assert len(dropped.contacts)
    back = cm.simulate(case, cm.drop(regained_after="2 ms"), "40 ms")
    assert back.rotor.system.is_anisotropic
    assert np.abs(back.final.position[0]) < 0.3  # it comes back from 0.1 clearances
    changed = case.parameters.replace(y_proportional_1=9e4)
    assert changed.value("y_proportional_1") == 9e4
    path.write_text(changed.finite_elements.to_toml(), encoding="utf-8")
    assert np.sort_complex(cm.load(path).parameters.system.exponents) == pytest.approx(
        np.sort_complex(changed.system.exponents), rel=1e-9
    )


def test_what_a_second_axis_cannot_be_is_refused(path):
    path.write_text(TEXT.replace(SECOND, '[magnetic_bearing.y]\ncurrent_limit = "5 A"\n'), encoding="utf-8")
    assert_refused(
        lambda: cm.load(path), r"^\[\[magnetic_bearing\]\] 1: y = None, 5.0, None: limits as along the first axis"
    )
