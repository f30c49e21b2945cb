"""The constants of a block of flight: its polynomial is as near as its error bound says, its derivatives below theirs."""

import math

import mpmath
import numpy as np
import pytest
from flights import parameters, plain_record
from reference import Flight, plane_flight

from carom.core import table as tables
from carom.core.lanes import REACH
from carom.core.layout import DEGREE, LANE_NODES, LANE_TERMS, LEVELS, NODES, TERMS
from carom.core.table import flight_table
from carom.models import jeffcott

EPSILON = 2.0**-52
MACHINES = [
    (0.1, 0.76),
    (1e-3, 1.0),
    (0.0, 3.0),
    (10.0, 0.1),
    (10.0, 3.0),
    (1.52, 0.76),
    (1.52 * (1 + 1e-12), 0.76),
    (1e3, 1e3),
    (-0.5, 0.8),
    (-10.0, 0.5),
]


def general_arrays(seed: int, modes: int):
    """Modes with a pair, of four of them, or free-standing; they may grow."""
    random = np.random.default_rng(seed)
    exponents = random.uniform(-1.0, 0.5, modes) + 1j * random.uniform(-3.0, 3.0, modes)
    exponents[:2] = sorted(exponents[:2], key=lambda value: value.real)
    return plain_record(
        exponents=exponents,
        driven=np.arange(modes) == (1 if modes > 2 else -1),
        offsets=np.array([0.2 + 0.1j]),
        rows=random.normal(size=(1, modes)) + 1j * random.normal(size=(1, modes)),
    )


def all_arrays():
    yield from (jeffcott(parameters(*machine)).system.arrays for machine in MACHINES)
    yield from (general_arrays(seed, modes) for modes in (2, 4) for seed in range(4))


@pytest.fixture(params=range(len(MACHINES) + 8))
def arrays(request):
    return list(all_arrays())[request.param]


def test_more_modes_than_two_have_no_polynomials():
    arrays = general_arrays(0, 4)
    table = flight_table(arrays.exponents, arrays.driven.astype(bool))
    assert table.coefficients.shape == (LEVELS, 0, DEGREE)


@pytest.fixture(params=range(len(MACHINES) + 4))
def two_modes(request):
    return list(all_arrays())[request.param]


def polynomial_of(arrays, table, depth, amplitudes):
    """Bernstein coefficients 0 … DEGREE of ``|y|² − 1`` on a block, and the bound of their error at its end.

    Written down from the sum in the docstring of the module, not from the kernel.
    """
    offset = arrays.offsets[0]
    weights = arrays.rows[0] * amplitudes
    for k in np.flatnonzero(arrays.driven):
        weights[k] += arrays.rows[0, k - 1] * amplitudes[k - 1]
        gap = arrays.exponents[k] - arrays.exponents[k - 1]
        weights[k - 1] = (arrays.rows[0, k] - gap * arrays.rows[0, k - 1]) * amplitudes[k - 1]
    start = offset + arrays.rows[0] @ amplitudes
    products = []
    for weight in weights:
        products += [(start.conjugate() * weight).real, (start.conjugate() * weight).imag]
    for j, first in enumerate(weights):
        products.append(abs(first) ** 2)
        for second in weights[j + 1 :]:
            pair = first * second.conjugate()
            products += [pair.real, pair.imag]
    products = np.array(products)
    level = abs(start) ** 2 - 1.0
    return np.append(level, level + products @ table.coefficients[depth]), np.abs(products) @ table.errors[depth]


def bernstein(coefficients, share):
    degree = len(coefficients) - 1
    j = np.arange(degree + 1)
    binomials = np.array([math.comb(degree, i) for i in j])
    return float((coefficients * binomials * share**j * (1.0 - share) ** (degree - j)).sum())


def flight_of(arrays, amplitudes) -> Flight:
    driven = arrays.driven.astype(bool)
    return plane_flight(arrays.offsets[0], arrays.rows[0], arrays.exponents, driven, amplitudes)


@pytest.mark.parametrize("depth", range(LEVELS))
def test_the_polynomial_errs_by_less_than_its_bound(two_modes, depth):
    """At any time of the block, in proportion to that time."""
    table = flight_table(two_modes.exponents, two_modes.driven.astype(bool))
    duration = float(table.durations[depth])
    random = np.random.default_rng(5)
    modes = len(two_modes.exponents)
    for _ in range(20):
        amplitudes = random.normal(size=modes) + 1j * random.normal(size=modes)
        coefficients, error = polynomial_of(two_modes, table, depth, amplitudes)
        flight = flight_of(two_modes, amplitudes)
        rounding = 64 * EPSILON * flight.spread(duration) ** 2
        for share in (*np.linspace(0.0, 1.0, 41), 1e-3, 1e-6, 1.0 - 1e-6):
            exact = float(flight.level(share * duration)[0])
            assert abs(bernstein(coefficients, share) - exact) <= error * share + rounding


@pytest.mark.parametrize("depth", range(LEVELS))
def test_each_row_errs_by_less_than_its_bound_and_not_by_much_less(two_modes, depth):
    """Rows that are not all rounding come within a factor of 100 of their bound: the bound is of use."""
    table = flight_table(two_modes.exponents, two_modes.driven.astype(bool))
    duration = table.durations[depth]
    times = np.linspace(0.0, 1.0, 2001)[1:]
    exact = tables._rows(two_modes.exponents, two_modes.driven.astype(bool), times * duration) * duration * times
    j = np.arange(1, DEGREE + 1)
    binomials = np.array([math.comb(DEGREE, i) for i in j])
    basis = binomials * times[:, None] ** j * (1.0 - times[:, None]) ** (DEGREE - j)
    worst = np.abs(basis @ table.coefficients[depth].T - exact.T).max(axis=0)
    assert np.all(worst <= table.errors[depth])
    telling = table.errors[depth] > 1e-9 * np.abs(exact).max(axis=1)
    assert np.all(worst[telling] >= 0.01 * table.errors[depth][telling])


def test_basis_functions_against_many_digits(arrays):
    driven = arrays.driven.astype(bool)
    table = flight_table(arrays.exponents, driven)
    times = np.array([1e-6, 0.1, 0.6, 1.0]) * table.durations[0]
    for k, values in enumerate(tables._basis(arrays.exponents, driven, times)):
        for time, value in zip(times, values, strict=True):
            exact = derivative_of_basis(arrays, k, 0, float(time))
            assert abs(value - exact) <= 32 * EPSILON * max(abs(exact), abs(arrays.exponents[k]) * time * abs(exact))


def test_nodes_and_power_series_against_many_digits(arrays):
    """At the nodes the basis functions and three derivatives; the power series reach rounding half a spacing away."""
    driven = arrays.driven.astype(bool)
    table = flight_table(arrays.exponents, driven)
    fastest = np.abs(arrays.exponents).max()
    assert math.frexp(table.spacing)[0] * 2**24 % 1.0 == 0.0
    rest = 0.5 * float(table.spacing)
    powers = rest ** np.arange(1, TERMS + 1)
    for k, exponent in enumerate(arrays.exponents):
        for order in range(4):
            for node in (0, 1, 7, NODES // 2, NODES):
                exact = derivative_of_basis(arrays, k, order, node * float(table.spacing))
                size = max(abs(exact), fastest**order * min(1.0, fastest * node * float(table.spacing)))
                assert abs(table.basis[node, order, k] - exact) <= 64 * EPSILON * size
        assert np.all(table.basis[0, 0] == 0.0)
        with mpmath.workdps(50):
            growth = complex(mpmath.expm1(mpmath.mpc(complex(exponent)) * rest))
        assert abs(powers @ table.growth_series[:TERMS, k] - growth) <= 4 * EPSILON * abs(growth)
        exact = derivative_of_basis(arrays, k, 0, rest)
        assert abs(powers @ table.basis_series[:TERMS, k] - exact) <= 4 * EPSILON * abs(exact)
    assert np.allclose(table.growth[:, driven], table.basis[:, 0, driven], rtol=0, atol=4 * EPSILON)


def test_nodes_of_lanes_against_many_digits(arrays):
    """At the nodes, which begin at the start and reach the end; and the series, as far away as lanes use them."""
    table = flight_table(arrays.exponents, arrays.driven.astype(bool))
    spacing = float(table.lane_spacing)
    assert math.frexp(spacing)[0] * 2**24 % 1.0 == 0.0
    assert 0.0 <= float(table.durations[0]) - (LANE_NODES - 1) * spacing < 0.01 * spacing
    rest = REACH * spacing
    powers = rest ** np.arange(1, LANE_TERMS + 1)
    for k, exponent in enumerate(arrays.exponents):
        assert np.all(table.lane_basis[k, :, 0] == 0.0)
        for node in (1, LANE_NODES // 2, LANE_NODES - 1):
            exact = derivative_of_basis(arrays, k, 0, node * spacing)
            size = max(abs(exact), min(1.0, abs(exponent) * node * spacing))
            assert abs(complex(*table.lane_basis[k, :, node]) - exact) <= 64 * EPSILON * size
        exact = derivative_of_basis(arrays, k, 0, rest)
        assert abs(powers @ table.basis_series[:, k] - exact) <= 4 * EPSILON * abs(exact)


def test_what_lanes_choose_from_is_the_same_table(two_modes):
    """Each block's coefficients; and errors by moduli bound those of any product's real and imaginary part."""
    table = flight_table(two_modes.exponents, two_modes.driven.astype(bool))
    modes = len(two_modes.exponents)
    assert np.array_equal(
        np.moveaxis(table.lane_coefficients[..., :LEVELS], -1, 0), table.coefficients.transpose(0, 2, 1)
    )
    assert np.array_equal(table.lane_durations[:LEVELS], table.durations)
    rng = np.random.default_rng(7)
    products = rng.normal(size=modes + modes * (modes + 1) // 2) * np.exp(
        1j * rng.uniform(0, 7, modes + modes * (modes + 1) // 2)
    )
    parts, row = [], 0
    for j in range(2 * modes):
        for other in range(j, j + 1 if j < modes else 2 * modes):
            alone = j >= modes and other == j
            parts += [abs(products[row])] if alone else [abs(products[row].real), abs(products[row].imag)]
            row += 1
    bound = np.abs(products) @ table.lane_errors[:, :LEVELS] * table.durations
    assert np.all(table.errors @ parts <= bound * (1 + 4 * EPSILON))


def derivative_of_basis(arrays, k: int, order: int, time: float) -> complex:
    """``order``-th derivative of a basis function, with 50 digits."""
    with mpmath.workdps(50):
        rate = mpmath.mpc(complex(arrays.exponents[k]))
        if k + 1 < len(arrays.exponents) and arrays.driven[k + 1]:
            upper = mpmath.mpc(complex(arrays.exponents[k + 1]))
            if upper == rate:
                term = order * rate ** (order - 1) if order else 0
                return complex((rate**order * time + term) * mpmath.exp(rate * time))
            powers = upper**order * mpmath.exp(upper * time) - rate**order * mpmath.exp(rate * time)
            return complex(powers / (upper - rate))
        return complex(rate**order * mpmath.exp(rate * time) - (0 if order else 1))


def test_derivative_bounds_bound(arrays):
    table = flight_table(arrays.exponents, arrays.driven.astype(bool))
    for k in range(len(arrays.exponents)):
        for order in (1, 2, 3):
            for share in np.linspace(0.0, 1.0, 21):
                value = derivative_of_basis(arrays, k, order, share * float(table.durations[0]))
                assert abs(value) <= table.bounds[order - 1, k] * (1 + 4 * EPSILON)


@pytest.mark.parametrize(
    ("lower", "upper"), [(0.3, 0.3), (1.5, 1.5), (0.1, 1.0), (-1.0, 0.8), (1.2j, 1.2j), (2j, -1.5j)]
)
def test_derivative_bounds_of_pairs_after_a_slow_mode(lower, upper):
    """They bound, and are met at the end of the block by a pair that grows with one exponent."""
    exponents, driven = np.array([0.01, lower, upper], complex), np.array([False, False, True])
    pair = plain_record(
        exponents=exponents,
        driven=driven,
        offsets=np.zeros(1, complex),
        rows=np.ones((1, 3), complex),
    )
    table = flight_table(exponents, driven)
    end = float(table.durations[0])
    for k in range(3):
        assert table.basis[-1, 0, k] == pytest.approx(derivative_of_basis(pair, k, 0, end), rel=1e-12)
        for order in (1, 2, 3):
            values = [abs(derivative_of_basis(pair, k, order, share * end)) for share in np.linspace(0.0, 1.0, 11)]
            assert max(values) <= table.bounds[order - 1, k] * (1 + 8 * EPSILON)
            if k == 0 or (lower == upper and np.isreal(lower)):
                assert max(values) == pytest.approx(table.bounds[order - 1, k], rel=1e-13)


@pytest.mark.parametrize("depth", range(LEVELS))
def test_the_computed_tail_is_the_whole_tail(two_modes, depth):
    """With twice as many Chebyshev points the error bounds do not change: nothing hides behind the last one."""
    table = flight_table(two_modes.exponents, two_modes.driven.astype(bool))
    duration = float(table.durations[depth])
    points = 2 * tables.SAMPLES
    # Whole turns are taken off in whole numbers, which keeps the cosines exact to rounding.
    turns = np.outer(2 * np.arange(points) + 1, np.arange(points)) % (4 * points)
    cosines = np.cos(np.pi * turns / (2 * points))
    times = (0.5 + 0.5 * cosines[:, 1]) * duration
    rows = tables._rows(two_modes.exponents, two_modes.driven.astype(bool), times) * duration
    series = np.abs(rows @ cosines) * 2.0 / points
    tail = 2.0 * series[:, DEGREE:].sum(axis=1)
    # Each of the coefficients carries a rounding error of the whole; a real part that of its imaginary part, next to it.
    size = np.abs(rows).max(axis=1)
    size = np.max([size, np.roll(size, 1), np.roll(size, -1)], axis=0)
    rounding = 4.0 * points * EPSILON * size
    whole = series.sum(axis=1)
    assert np.all(np.abs(table.errors[depth] - tail - tables.ROUNDED * whole) <= rounding + 1e-14 * whole)


def test_blocks_are_short_enough_for_the_fastest_mode(arrays):
    table = flight_table(arrays.exponents, arrays.driven.astype(bool))
    assert 0.0 < table.durations[0] <= tables.LONGEST_BLOCK
    assert np.abs(arrays.exponents).max() * table.durations[0] <= tables.LARGEST_PHASE * (1 + EPSILON)


def test_a_rotor_at_rest_has_a_table():
    with np.errstate(divide="raise"):
        table = flight_table(np.zeros(1, complex), np.zeros(1, bool))
    assert table.durations[0] == tables.LONGEST_BLOCK
    assert not table.coefficients.any()


def test_arrays_have_the_shapes_that_are_documented(arrays):
    table, modes = flight_table(arrays.exponents, arrays.driven.astype(bool)), len(arrays.exponents)
    assert table.basis.shape == (NODES + 1, 4, modes)
    assert table.growth.shape == (NODES + 1, modes)
    assert table.bounds.shape == (3, modes)


def test_the_chebyshev_transform_of_each_chebyshev_polynomial_is_its_own_coefficient():
    """They are sampled from the start of the block to its end; the sampled polynomial of order zero is constant."""
    points = tables._chebyshev_points(tables.SAMPLES)
    assert np.all(np.diff(points) > 0.0)
    sampled = np.polynomial.chebyshev.chebvander(2.0 * points - 1.0, tables.SAMPLES - 1)
    assert tables._chebyshev_transform() @ sampled == pytest.approx(np.eye(tables.SAMPLES), abs=1e-12)
