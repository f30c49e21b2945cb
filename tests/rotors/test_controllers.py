"""Controllers in all forms, against SciPy and the quotients that define them."""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest
from refusals import assert_refused
from scipy import signal

from carom.base.outcome import InputError
from carom.rotors import (
    PID,
    LeadLag,
    LowPass,
    MagneticBearing,
    Notch,
    SecondOrderSections,
    Series,
    StateSpace,
    TransferFunction,
    VoltagePID,
    ZerosPolesGain,
)
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
    whole = np.block([[tame.A, tame.B], [tame.C, np.zeros((1, 1))]])
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


def test_zeros_poles_and_sections_are_those_of_scipy():
    poles, zeros = [-900.0, -40.0, -500 + 4000j, -500 - 4000j, -7.0], [-100.0, -50 + 300j, -50 - 300j, -60.0]
    found = ZerosPolesGain(zeros, poles, 3e4)
    expected = signal.ZerosPolesGain(zeros, poles, 3e4)
    _, values = signal.freqresp(expected, AT.imag)
    assert state_space_of(found).at(AT) == pytest.approx(values, rel=1e-11)
    assert state_space_of(expected).at(AT) == pytest.approx(values, rel=1e-11)
    upper = ZerosPolesGain([-100.0, [-50, 300], -60.0], [-900.0, -40.0, [-500, 4000], -7.0], 3e4)
    assert upper == found
    rows = signal.zpk2sos(zeros, poles, 3e4, analog=True)
    assert state_space_of(SecondOrderSections(rows)).at(AT) == pytest.approx(values, rel=1e-8)
    filters = [Notch("100 Hz", 0.2, 0.1), LeadLag("20 Hz", "80 Hz"), LowPass("1 kHz")]
    w, z, p, n = (2.0 * math.pi * each for each in (100.0, 20.0, 80.0, 1000.0))
    expected = (AT**2 + 0.04 * w * AT + w**2) / (AT**2 + 0.4 * w * AT + w**2) * (1 + AT / z) / (1 + AT / p)
    expected = 7.0 * expected * n**2 / (AT**2 + math.sqrt(2.0) * n * AT + n**2)
    assert state_space_of(Series(PID(7.0), filters)).at(AT) == pytest.approx(expected, rel=1e-11)


def test_the_chain_multiplies_and_an_ideal_derivative_passes_filters():
    law = VoltagePID("2.5", "30 1/s", "4 ms", 0)
    own = bearing(
        controller=law, sensor_gain="8 V/mm", amplifier_gain="0.5 A/V", amplifier_bandwidth=900.0, gain_factor=1.2
    )
    own = dataclasses.replace(own, sensor_bandwidth=7e3)
    expected = 1.2 * 8e3 * 0.5 * (2.5 + 30.0 / AT + 4e-3 * AT) / (1.0 + AT / 900.0) / (1.0 + AT / 7e3)
    assert own.loop.at(AT) == pytest.approx(expected, rel=1e-11)
    ideal = PID(3.0, 0.0, 2.0, 0).state_space
    assert ideal.at(AT) == pytest.approx(3.0 + 2.0 * AT, rel=1e-13)
    lowered = TransferFunction(NUMERATOR, DENOMINATOR).state_space.then(ideal)
    expected = (3.0 + 2.0 * AT) * np.polyval(NUMERATOR, AT) / np.polyval(DENOMINATOR, AT)
    with pytest.raises(InputError, match=r"^controller = two ideal derivatives"):
        ideal.then(ideal)
    proper = lowered.then(TransferFunction([1.0], [1e-5, 1.0]).state_space)
    assert proper.at(AT) == pytest.approx(expected / (1.0 + 1e-5 * AT), rel=1e-8)  # D of 3e8 loses digits


@pytest.mark.parametrize("order", [1, 4])
def test_a_sampled_controller_is_its_z_transform_with_its_hold(order):
    """Against ``C(e^{sT}) (1 − e^{−sT})/(sT)``; the error is that of Padé's approximation, of the seventh power of the frequency."""
    time = 50e-6
    rows = signal.butter(order, 0.1, output="sos")
    own = state_space_of(SecondOrderSections(rows, time))
    at = 1j * np.array([10.0, 1e3, 5e3, 1e4])
    exact = np.array([signal.sosfreqz(rows, [w * time])[1][0] for w in at.imag]) * -np.expm1(-at * time) / (at * time)
    error = SecondOrderSections(rows, time).state_space.sampling_error(1e4)
    assert np.abs(own.at(at) / exact - 1.0).max() == pytest.approx(error, rel=1e-3)
    assert error < 1e-5
    assert np.abs(own.at(at[:3]) / exact[:3] - 1.0).max() < 2e-8 + 1.1 * error / 2.0**7
    assert np.linalg.eigvals(own.A).real.max() < 0.0
    same = state_space_of(signal.TransferFunction(*signal.butter(order, 0.1), dt=time))
    assert same.at(at) == pytest.approx(own.at(at), rel=1e-8)
    assert TransferFunction([2.2, -2.1], [1.0, -1.0], time).state_space.sampling_error(0.1 / time) < 1e-9


@pytest.mark.parametrize(("rule", "share"), [(None, 1.0), ("tustin", 0.5)])
@pytest.mark.parametrize(("integral", "late"), [(900.0, 2e-4), (0.0, 3e-5), (900.0, 0.0)])
def test_sampled_gains_are_their_rule_with_one_hold(rule, share, integral, late):
    time, at = 5e-5, 1j * np.array([10.0, 1e3, 5e3, 1e4])
    if not late and rule:
        assert_refused(
            lambda: PID(5e3, integral, 5.0, late, time, rule), r"^filter_time = 0: above 0 with Tustin's rule"
        )
        return
    own = PID(5e3, integral, 5.0, late, "50 us", rule)
    z = np.exp(at * time)
    s = (z - 1.0) / (time * (share * z + 1.0 - share))
    digital = SecondOrderSections(signal.butter(2, 0.2, output="sos"), time)
    whole = Series(own, [digital, LowPass("3 kHz")])
    exact = (5e3 + integral / s + 5.0 * s / (1.0 + late * s)) * -np.expm1(-at * time) / (at * time)
    both = exact * signal.sosfreqz(digital.sos, at.imag * time)[1] * LowPass("3 kHz").state_space.at(at)
    slower = dataclasses.replace(whole, sample_time=2.0 * time)
    assert [each.sample_time for each in (slower.controller, slower.filters[0])] == [2.0 * time] * 2
    for found, expected in ((own, exact), (whole, both)):
        error = getattr(found, "sampled", found.state_space).sampling_error(1e4)
        assert np.abs(state_space_of(found).at(at) / expected - 1.0).max() < 1.01 * error + 1e-12
        assert error < 2e-5


def test_sampled_integrators_leave_no_undamped_states():
    """The shift by Padé's approximation is one at √60/T too, where the hold is zero: such a state would never come to rest."""
    lag = TransferFunction([2.0, -1.9], [1.0, -0.7], 1e-4)
    for system in (PID(5e3, 900.0, 5.0, 2e-4, 1e-4), Series(PID(5e3, 900.0, sample_time=1e-4), [lag]).sampled):
        own = state_space_of(system)
        poles = np.linalg.eigvals(own.A)
        assert np.abs(poles[poles.real > -1.0]).max() < 1e-6
        at = 1j * np.array([10.0, 1e3, 5e3])
        z = np.exp(1e-4 * at)
        exact = system.state_space.at(z) * -np.expm1(-1e-4 * at) / (1e-4 * at)
        assert own.at(at) == pytest.approx(exact, rel=1e-4)


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
            lambda: bearing(controller=signal.TransferFunction([1.0], [1.0, 0.5], dt=True)),
            r"^controller = a system in discrete time without a time step: one with its time step dt",
        ),
        (
            lambda: bearing(controller=SimpleNamespace(num=[[[1], [2]]], den=[[[1], [2]]])),
            r"^controller = several inputs or outputs: one input and one output",
        ),
        (lambda: bearing(controller=StateSpace([], [], [], np.eye(2))), r"^controller = several inputs or outputs"),
        (
            lambda: ZerosPolesGain([-1.0, -2.0], [-3.0], 1.0),
            r"^controller zeros = 2 zeros: at most as many as poles, 1",
        ),
        (lambda: ZerosPolesGain([], [-3j, 4j], 1.0), r"^controller poles = \[.*: numbers, or pairs \[re, im\]"),
        (lambda: SecondOrderSections([[1.0, 2.0]]), r"^controller sos = an array of shape \(1, 2\): rows of six"),
        (lambda: TransferFunction([1.0], [1.0, 0.5], "0 s"), r"^sample_time = 0 s: must be a time"),
        (lambda: PID(1.0, sampling="tustin"), r"^sampling = tustin: one of backward-euler, tustin, beside sample_time"),
        (lambda: bearing(controller=TransferFunction([1.0], [1.0, 1.0], 1e-4)), r"^controller = a pole at z = -1"),
        (
            lambda: Series(PID(1.0), [TransferFunction([1.0], [1.0, 0.5], 1e-4)]),
            r"^filter = with a sample time of 0.0001 s: filters in continuous time",
        ),
        (lambda: Notch("850 m"), r"^notch_frequency = 850 m: must be an angular frequency"),
        (lambda: bearing(sensor_gain="1 V/mm"), r"^amplifier_gain = nothing given: stated beside sensor_gain"),
        (lambda: bearing(sensor_gain=1e3, amplifier_gain=1.0), r"^controller = PID: carom.rotors.VoltagePID with"),
        (lambda: bearing(sensor_nodes=[True]), r"^sensor node = true: the number of a node"),
        (lambda: bearing(ks=1e5), r"^ks = 100000.0: must be a stiffness"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(make, says):
    assert_refused(make, says)
