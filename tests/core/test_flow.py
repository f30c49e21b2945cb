"""Exact flight against the matrix exponential and against many digits."""

import mpmath
import numpy as np
import pytest
from flights import parameters, plain_record
from scipy.linalg import expm

from carom.core.flow import (
    acceleration,
    complex_expm1,
    displacement,
    flight_increments,
    fly_all,
    nudge,
    squared_modulus,
    velocity,
)
from carom.models import jeffcott

EPSILON = 2.0**-52


def pair_rotor(lower, upper, rows=(0.7 - 0.2j, 0.4 + 1.1j)):
    """A rotor of one pair and one free-standing mode."""
    return plain_record(
        exponents=np.array([lower, upper, -0.3 + 1.1j]),
        driven=np.array([False, True, False]),
        offsets=np.array([0.1 - 0.3j]),
        rows=np.array([[*rows, 0.25j]]),
    )


def generator(arrays):
    """Matrix of ``ċ = M c``."""
    return np.diag(arrays.exponents) + np.diag(arrays.driven[1:].astype(complex), -1)


def exact_flight(arrays, amplitudes, time):
    """``e^{Mt} c`` to 60 digits, rounded at the end."""
    with mpmath.workdps(60):
        matrix = mpmath.matrix(generator(arrays).tolist()) * mpmath.mpf(float(time))
        flown = mpmath.expm(matrix) * mpmath.matrix([mpmath.mpc(complex(c)) for c in amplitudes])
        return np.array([complex(c) for c in flown])


PAIRS = [
    (-0.9 - 1j, -0.2 + 0.5j),
    (-0.5 - 1j, -0.5 - 1j),
    (-0.5 - 1j, -0.5 - 1j + 1e-13),
    (-0.5 - 1j, -0.5 - 1j + 1e-8j),
    (-0.5 - 1j, -0.5 - 1j + 1e-3),
    (-10.0 - 1j, -0.001 - 1j),
    (0.2 - 1j, 0.3 + 2j),
    (-1.0 + 0j, 0j),
]


@pytest.mark.parametrize(("lower", "upper"), PAIRS)
@pytest.mark.parametrize("time", [1e-9, 1e-3, 0.4, 2.7, 30.0])
def test_increments_against_many_digits(lower, upper, time):
    """Each amplitude is exact to a few roundings of its terms, and increments keep their digits in short flights."""
    arrays = pair_rotor(lower, upper)
    amplitudes = np.array([0.8 - 0.5j, -0.3 + 0.9j, 1.2 + 0.1j])
    increments = np.empty((1, 3), complex)
    flight_increments(arrays, amplitudes[None], time, increments)
    with mpmath.workdps(60):
        exact = exact_increments(arrays, amplitudes, time)
    rates = np.abs(generator(arrays)) @ np.abs(amplitudes)
    growth = np.exp(np.maximum(0.0, arrays.exponents.real).max() * time)
    phase = 1.0 + np.abs(arrays.exponents).max() * time
    allowed = 8 * EPSILON * phase * growth * np.minimum(rates * time, np.abs(amplitudes) + np.abs(exact) + rates)
    assert np.all(np.abs(increments[0] - exact) <= allowed)


def exact_increments(arrays, amplitudes, time):
    """``(e^{Mt} − 1) c`` with 60 digits before the subtraction."""
    matrix = mpmath.matrix(generator(arrays).tolist()) * mpmath.mpf(float(time))
    start = mpmath.matrix([mpmath.mpc(complex(c)) for c in amplitudes])
    return np.array([complex(c) for c in mpmath.expm(matrix) * start - start])


@pytest.mark.parametrize("gamma", [1e-3, 0.1, 1.5, 1.52, 1.52 + 1e-12, 1.53, 10.0])
def test_planar_rotor_against_scipy(gamma):
    machine = parameters(gamma, 0.76)
    rotor = jeffcott(machine)
    stiffness = complex(machine.omega**2 - 1.0, gamma)
    matrix = np.array([[0.0, 1.0], [-stiffness, -(gamma + 2j)]])
    position, speed = 0.3 - 0.2j, -0.4 + 0.7j
    for time in (0.1, 1.0, 7.0):
        expected = expm(matrix * time) @ [position - rotor.equilibrium, speed] + [rotor.equilibrium, 0.0]
        flown = rotor.system.fly(rotor.system.amplitudes(position, speed), np.array(time))
        # The scaling and squaring of expm loses a few digits.
        assert np.allclose(rotor.system.state(flown), expected, rtol=0, atol=1e-13 * (1.0 + abs(rotor.equilibrium)))


def test_derivatives_at_a_plane():
    arrays = pair_rotor(-0.9 - 1j, -0.2 + 0.5j)
    amplitudes = np.array([0.8 - 0.5j, -0.3 + 0.9j, 1.2 + 0.1j])
    matrix = generator(arrays)
    row = arrays.rows[0]
    assert displacement(arrays, 0, amplitudes) == pytest.approx(arrays.offsets[0] + row @ amplitudes, abs=1e-15)
    assert velocity(arrays, 0, amplitudes) == pytest.approx(row @ matrix @ amplitudes, abs=1e-15)
    assert acceleration(arrays, 0, amplitudes) == pytest.approx(row @ matrix @ matrix @ amplitudes, abs=1e-15)


def test_fly_all_flies_each_from_its_own_amplitudes():
    arrays = pair_rotor(*PAIRS[0])
    random = np.random.default_rng(1)
    starts = random.normal(size=(20, 3)) + 1j * random.normal(size=(20, 3))
    times = random.uniform(0.0, 5.0, 20)
    kept = starts.copy()
    flown = fly_all(arrays, starts, times)
    assert np.array_equal(starts, kept)
    for start, time, end in zip(starts, times, flown, strict=True):
        assert np.allclose(end, exact_flight(arrays, start, time), rtol=0, atol=1e-14)


@pytest.mark.parametrize(("lower", "upper"), PAIRS)
def test_nudge_is_exact_to_third_order(lower, upper):
    """The error of a nudge falls with the fourth power of its time."""
    arrays = pair_rotor(lower, upper)
    start = np.array([0.8 - 0.5j, -0.3 + 0.9j, 1.2 + 0.1j])
    fastest = np.abs(arrays.exponents).max()
    errors = []
    for time in (0.04 / fastest, 0.02 / fastest):
        moved = start.copy()
        nudge(arrays, moved, time)
        errors.append(np.abs(moved - exact_flight(arrays, start, time)).max())
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.01)


def test_nudge_backward_undoes_a_nudge():
    arrays = pair_rotor(*PAIRS[1])
    start = np.array([0.8 - 0.5j, -0.3 + 0.9j, 1.2 + 0.1j])
    moved = start.copy()
    nudge(arrays, moved, 1e-5)
    nudge(arrays, moved, -1e-5)
    assert np.allclose(moved, start, rtol=0, atol=4 * EPSILON)


@pytest.mark.parametrize("size", [1e-300, 1e-16, 1e-8, 1e-3, 0.5, 3.0, 40.0])
def test_complex_expm1_keeps_its_digits(size):
    for angle in np.linspace(0.0, 2.0 * np.pi, 13):
        z = complex(size * np.exp(1j * angle))
        with mpmath.workdps(360):
            exact = complex(mpmath.exp(mpmath.mpc(z)) - 1)
        # Near 2πi n the real part is a difference whatever the algorithm, so it is the modulus that counts.
        assert abs(complex_expm1(z) - exact) <= 4 * EPSILON * (abs(exact) + abs(z) * abs(exact + 1) * EPSILON)


def test_squared_modulus():
    assert squared_modulus(3.0 - 4.0j) == 25.0


@pytest.mark.parametrize(
    ("gamma", "omega"),
    [
        (0.1, 0.76),
        (1.52, 0.76),
        (1.52 + 1e-14, 0.76),
        (10.0, 0.1),
        (1e3, 1e-3),
        (-10.0, 0.1),
        (-0.1, 0.76),
        (2.35, 1.0),
    ],
)
def test_exponents_keep_all_digits(gamma, omega):
    """Also where one of them is the small difference of two large numbers."""
    found = jeffcott(parameters(gamma, omega)).system.exponents
    with mpmath.workdps(60):
        g, w = mpmath.mpf(gamma), mpmath.mpf(omega)
        split = mpmath.sqrt(g * g - 4 * w * w)
        for value, exact in zip(found, ((-g - split) / 2 - 1j, (-g + split) / 2 - 1j), strict=True):
            assert abs(mpmath.mpf(value.real) - exact.real) <= 4 * EPSILON * abs(exact.real)
            assert abs(mpmath.mpf(value.imag) - exact.imag) <= 4 * EPSILON * max(1.0, omega)


def test_exactly_critical_exponents_are_equal():
    for omega in (0.1, 0.7, 1.0, 3.0):
        rotor = jeffcott(parameters(2.0 * omega, omega))
        assert rotor.system.exponents[0] == rotor.system.exponents[1]
        assert rotor.system.arrays.gaps[1] == 0.0
