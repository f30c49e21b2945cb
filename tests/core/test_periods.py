"""Sums over the modes, their bounds and the search for roots, against many digits and for any number of modes."""

import mpmath
import numpy as np
import pytest
from compilation import sized
from machines import PAPER, exact_return, random_parameters
from scipy.linalg import expm

from carom.core.periods import ROUNDING, flight_return, isolate, longest_period, returns, roots_on
from carom.core.planar import planar_exponents


def factor_of(parameters) -> complex:
    return (1.0 + parameters.d) * complex(1.0, parameters.mu)


def pair_of(parameters) -> np.ndarray:
    """The planar rotor as a driven pair, in the form that the kernels take."""
    first, second = planar_exponents(parameters.gamma, parameters.omega)
    return np.array([[first, 0.0, 0.0], [second, 0.0, 1.0]], complex)


def singles_of(parameters) -> np.ndarray:
    """The same rotor as two modes by themselves."""
    first, second = planar_exponents(parameters.gamma, parameters.omega)
    residue = 1.0 / (second - first)
    return np.array([[first, -residue, 0.0], [second, residue, 0.0]], complex)


def flight_returns(modes: np.ndarray, times: np.ndarray) -> np.ndarray:
    return np.array([flight_return(modes, float(time))[:3] for time in times])


def machines(count: int, seed: int, sign: float = 1.0):
    random = np.random.default_rng(seed)
    for _ in range(count):
        parameters = random_parameters(random)
        yield parameters.replace(gamma=sign * parameters.gamma), random


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["damped", "growing"])
def test_returns_of_a_pair_keep_their_digits(sign):
    for parameters, random in machines(sized(100, 30), 4, sign):
        period = float(10 ** random.uniform(-6, 1.3))
        exponents = np.array(planar_exponents(parameters.gamma, parameters.omega))
        got = returns(*exponents, period)[:3]
        with mpmath.workdps(60):
            value, rate = exact_return(parameters, period)
            exact = [complex(value[0, 1]), complex(value[1, 1]), complex(rate[1, 1])]
        # A change of the exponents' last digit is felt after many turns, and near a resonance of the free motion.
        distance = np.abs(np.expm1(-sign * exponents * period)).min() / min(1.0, period)
        turned = 1.0 + np.abs(exponents).max() * period
        assert np.abs(np.subtract(got, exact) / exact).max() < 5e-14 * turned / min(1.0, distance) ** 2


def test_the_error_of_a_sum_is_as_large_as_its_terms():
    worst = 0.0
    for parameters, random in machines(sized(100, 30), 5):
        if random.random() < 0.3:
            parameters = PAPER.replace(gamma=float(10 ** random.uniform(-4, 0)))
        period = float(40.0 * random.random() ** 2)
        _, a22, _, size = flight_return(pair_of(parameters), period)
        with mpmath.workdps(40):
            exact = complex(exact_return(parameters, period)[0][1, 1])
        worst = max(worst, abs(a22 - exact) / (ROUNDING * (1.0 + size)))
    assert worst < 0.5


def test_any_number_of_modes_agrees_with_matrices():
    """Five modes, two of them a pair, whose impulse does not move the contact at once."""
    random = np.random.default_rng(8)
    exponents = -random.uniform(0.05, 0.6, 5) + 1j * random.uniform(-3.0, 3.0, 5)
    exponents[1:3] = sorted(exponents[1:3], key=lambda value: value.real)
    row, column = random.normal(size=(2, 5)) + 1j * random.normal(size=(2, 5))
    column[4] -= (row @ column) / row[4]
    generator = np.diag(exponents)
    generator[2, 1] = 1.0
    modes = np.array([exponents, row * column, [0.0, 0.0, row[2] * column[1], 0.0, 0.0]]).T.copy()
    times = np.array([1e-4, 0.03, 0.4, 1.7, 6.0, 30.0])
    for time, found in zip(times, flight_returns(modes, times), strict=True):
        back = np.linalg.inv(expm(-generator * time) - np.eye(5))
        slope = generator @ generator @ back @ (np.eye(5) + back)
        exact = row @ back @ column, row @ generator @ back @ column, row @ slope @ column
        # The inverse is as large as 1/T.
        np.testing.assert_allclose(found, exact, rtol=1e-9, atol=1e-14 / time**3 + 1e-12)
    found, ends = roots(modes, 1.9 + 0.4j)
    assert len(found) > 1
    fine = np.linspace(1e-3, ends, 40_001)
    values = 1.0 + ((1.9 + 0.4j) * flight_returns(modes, fine)[:, 1]).real
    assert len(found) == np.count_nonzero((values[1:] > 0) != (values[:-1] > 0))


def roots(modes: np.ndarray, factor: complex, end: float | None = None) -> tuple[np.ndarray, float]:
    """All roots, and the end of the range searched."""
    end = longest_period(modes, factor) if end is None else end
    intervals, complete = isolate(modes, factor, end, int(4.0 * end) + 1, 100_000)
    assert complete
    return roots_on(modes, factor, intervals)[0], end


@pytest.mark.parametrize("gamma", [0.03, 0.1, 0.3])
def test_roots_do_not_depend_on_how_modes_are_written(gamma):
    parameters = PAPER.replace(gamma=gamma, mu=0.4)
    factor = factor_of(parameters)
    pair, end = roots(pair_of(parameters), factor)
    singles, far = roots(singles_of(parameters.replace(gamma=gamma * (1.0 + 1e-14))), factor, end)
    assert far == end
    assert len(pair) > 0
    np.testing.assert_allclose(pair, singles, rtol=1e-10)


def test_intervals_hold_all_roots_and_tell_the_doubtful():
    """At the largest damping at which two roots are found next to the fold of the source paper's machine."""
    low, high, factor = 0.178, 0.1781, factor_of(PAPER)
    while low < 0.5 * (low + high) < high:
        middle = 0.5 * (low + high)
        low, high = (
            (middle, high) if len(roots(pair_of(PAPER.replace(gamma=middle)), factor, 3.0)[0]) else (low, middle)
        )
    modes = pair_of(PAPER.replace(gamma=low))
    intervals, complete = isolate(modes, factor, 3.0, 13, 1000)
    assert complete
    assert (intervals[:, 1] > intervals[:, 0]).all()
    assert (intervals[1:, 0] >= intervals[:-1, 1]).all()
    doubtful = intervals[intervals[:, 2] != 0.0]
    assert len(doubtful) == 1
    assert 0.0 < doubtful[0, 1] - doubtful[0, 0] < 1e-4
    found, _, starts_below = roots_on(modes, factor, intervals)
    np.testing.assert_allclose(found, 1.6408219835, atol=1e-6)
    assert len(found) == 2
    assert not starts_below


def test_a_root_at_zero_is_told_apart():
    for gamma, below in ((0.1, True), (0.31, False)):
        parameters = PAPER.replace(d=1.0, gamma=gamma)
        modes, factor = pair_of(parameters), factor_of(parameters)
        with np.errstate(all="ignore"):  # without the compiler, the pole of a₁₂ at T = 0 is noticed
            found, _, starts_below = roots_on(modes, factor, isolate(modes, factor, 30.0, 120, 1000)[0])
        assert starts_below == below
        assert len(found) == int(below)
