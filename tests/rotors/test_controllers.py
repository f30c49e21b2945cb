"""Controllers in all forms, against SciPy and the quotients that define them."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from refusals import assert_refused
from scipy import signal

from carom.rotors import PID, MagneticBearing, StateSpace, TransferFunction
from carom.rotors.controllers import state_space_of
from carom.rotors.state_spaces import delay

AT = 1j * np.array([-3e4, -200.0, 1.0, 30.0, 900.0, 2e4])
GAINS = {"proportional": "5000 A/m", "integral": 1500.0, "derivative": 5.0, "filter_time": "0.1 ms"}
NUMERATOR, DENOMINATOR = [3e-4, 2.0, 5e3, 1e6], [1e-12, 3e-8, 4e-4, 1.0]


def test_a_pid_is_its_formula():
    found = state_space_of(PID(**GAINS)).at(AT)
    assert found == pytest.approx(5000.0 + 1500.0 / AT + 5.0 * AT / (1.0 + 1e-4 * AT), rel=1e-13)
    assert state_space_of(PID(5000.0)).states == 0
    assert state_space_of(PID(5000.0)).at(AT) == pytest.approx(np.full(6, 5000.0))


@pytest.mark.parametrize(
    "controller",
    [
        TransferFunction(NUMERATOR, DENOMINATOR),
        signal.TransferFunction(NUMERATOR, DENOMINATOR),
        signal.TransferFunction(NUMERATOR, DENOMINATOR).to_ss(),
        signal.TransferFunction(NUMERATOR, DENOMINATOR).to_zpk(),
        SimpleNamespace(num=[[np.array(NUMERATOR)]], den=[[np.array(DENOMINATOR)]], dt=0),
    ],
    ids=["own", "SciPy, quotient", "SciPy, matrices", "SciPy, zeros", "as of python-control"],
)
def test_a_quotient_is_the_same_in_all_forms(controller):
    expected = np.polyval(NUMERATOR, AT) / np.polyval(DENOMINATOR, AT)
    # Roots of polynomials, which SciPy's zeros and poles are, lose digits.
    assert state_space_of(controller).at(AT) == pytest.approx(expected, rel=1e-9)


def test_balancing_changes_sizes_and_nothing_else():
    wild = StateSpace([[0.0, 1.0], [-1e12, -1e3]], [0.0, 1e9], [1e-3, 0.0], 0.1)
    tame = wild.balanced()
    assert tame.at(AT) == pytest.approx(wild.at(AT), rel=1e-12)
    # Osborne's balance: beside the diagonal, what comes into each state is of the size of what goes out of it; of all
    # states together, where the entries of B and C decide, a few sweeps come within 2.2 %.
    whole = np.block([[tame.A, tame.B[:, None]], [tame.C[None], np.zeros((1, 1))]])
    np.fill_diagonal(whole, 0.0)
    for state in range(2):
        assert np.linalg.norm(whole[state]) == pytest.approx(np.linalg.norm(whole[:, state]), rel=0.03)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_a_delay_keeps_sizes_and_turns_phases(order):
    """Padé: all-pass, with an error of the power ``2n + 1`` of the frequency."""
    found = delay(50e-6, order).at(AT)
    assert np.abs(found) == pytest.approx(np.ones(6), rel=1e-12)
    turns = np.abs(AT.imag) * 50e-6
    leading = math.factorial(order) ** 2 / (math.factorial(2 * order) * math.factorial(2 * order + 1))
    errors = np.abs(found - np.exp(-AT * 50e-6))
    assert (errors <= 1.2 * leading * turns ** (2 * order + 1) + 1e-13).all()
    assert errors.max() > 0.3 * (leading * turns ** (2 * order + 1)).max()


def test_a_bearing_has_controller_delay_and_amplifier_in_a_row():
    bearing = MagneticBearing(3, "50 N/A", "-1e5 N/m", PID(**GAINS), (1, 4), delay="20 us", amplifier_bandwidth="1 kHz")
    expected = state_space_of(PID(**GAINS)).at(AT) * delay(20e-6, 3).at(AT) / (1.0 + AT / (2e3 * math.pi))
    assert bearing.loop.at(AT) == pytest.approx(expected, rel=1e-11)
    assert bearing.sensor_nodes == (1, 4)
    assert MagneticBearing(3, 50.0, 0.0, PID(1.0)).sensor_nodes == (3,)


def bearing(**changes):
    return MagneticBearing(**{"node": 0, "ki": 50.0, "ks": -1e5, "controller": PID(1.0), **changes})


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: PID(1.0, derivative=1.0), r"^filter_time = nothing given: a derivative needs the time of its filter"),
        (
            lambda: TransferFunction([1.0, 0.0, 0.0], [1.0, 1.0]),
            r"^controller numerator = a polynomial of degree 2: a proper transfer function, degree of the numerator at most 1",
        ),
        (lambda: TransferFunction([1.0], [0.0]), r"^controller denominator = \[0.0\]: a polynomial that is not zero"),
        (lambda: StateSpace(np.eye(2), [1.0], [1.0, 1.0], 0.0), r"^controller B = an array of shape \(1,\): 2 numbers"),
        (lambda: StateSpace([[1j]], [1.0], [1.0], 0.0), r"^controller A = \[\[1j\]\]: finite real numbers"),
        (
            lambda: bearing(controller=signal.TransferFunction([1.0], [1.0, 0.5], dt=1e-4)),
            r"^controller = a system with a time step of 0.0001",
        ),
        (
            lambda: bearing(controller=SimpleNamespace(num=[[[1], [2]]], den=[[[1], [2]]])),
            r"^controller = several inputs or outputs: one input and one output",
        ),
        (lambda: bearing(sensor_nodes=[True]), r"^sensor node = true: the number of a node"),
        (lambda: bearing(ks=1e5), r"^ks = 100000.0: must be a stiffness"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(make, says):
    assert_refused(make, says)
