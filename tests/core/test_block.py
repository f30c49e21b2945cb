"""The parts of the crossing search on a block, each alone, against numpy and closed forms."""

import numpy as np
import pytest
from flights import inside_task, plain_record, rotors

from carom.core import block, table
from carom.core.flow import fly_all
from carom.core.layout import DEGREE, LEVELS, NODES, TERMS, workspace


def loaded(seed):
    """A flight from inside, loaded into a workspace, and the displacement it starts from."""
    rotor, rng = rotors(seed, 1)[0]
    task, work = inside_task(rotor, rng), workspace(2)
    work.current[:] = task.amplitudes
    origin = complex(task.arrays.offsets[0] + task.arrays.rows[0] @ task.amplitudes)
    block.load_products(task.arrays, 0, origin, work)
    return rotor, task, work, origin


def derivatives_of_level(rotor, amplitudes):
    """``f = |y|² − 1`` and its first three derivatives, by Leibniz's rule from those of ``y``."""
    arrays = rotor.system.arrays
    y = arrays.offsets[0] + arrays.rows[0] @ amplitudes
    v, a, j = (rows[0] @ amplitudes for rows in (arrays.rate_rows, arrays.acceleration_rows, arrays.jerk_rows))
    products = [y * np.conj(y) - 1.0, 2.0 * y * np.conj(v), 2.0 * (y * np.conj(a) + v * np.conj(v))]
    products.append(2.0 * (y * np.conj(j) + 3.0 * v * np.conj(a)))
    return np.real(products)


@pytest.mark.parametrize("seed", range(4))
def test_look_at_a_node_and_move_to_any_time_agree_with_the_flight(seed):
    rotor, task, work, origin = loaded(50 + seed)
    level = abs(origin) ** 2 - 1.0
    for node in (0, 1, NODES // 2, NODES):
        time = node * task.table.spacing
        expected = derivatives_of_level(rotor, rotor.system.fly(task.amplitudes, np.array(time)))
        found = block.look_at_node(task.table, node, origin, level, work)
        np.testing.assert_allclose(found, expected, rtol=1e-11, atol=1e-11)
    for time in task.table.durations[0] * np.array([0.0, 0.013, 0.31, 0.77, 1.0]):
        block.move_to(task.arrays, task.table, time, work)
        flown = rotor.system.fly(task.amplitudes, np.array(time))
        np.testing.assert_allclose(work.end, flown, rtol=0.0, atol=1e-13 * np.abs(flown).max())
        np.testing.assert_allclose(work.increments, flown - task.amplitudes, rtol=0.0, atol=1e-13 * np.abs(flown).max())


def test_the_nearest_node_is_within_half_a_spacing():
    _, task, _, _ = loaded(60)
    spacing = task.table.spacing
    for time in np.linspace(-3.0, NODES + 3.0, 997) * spacing:
        nearest = int(np.argmin(np.abs(np.arange(NODES + 1) * spacing - time)))
        assert abs(block.nearest_node(task.table, time) - nearest) <= (abs(time / spacing % 1.0 - 0.5) < 1e-9)


def some_modes(seed, modes=4):
    """A rotor with a pair between two free-standing modes, or two of those, its table, and a flight loaded into a workspace."""
    random = np.random.default_rng(seed)
    exponents = random.uniform(-1.0, 0.3, modes) + 1j * random.uniform(-3.0, 3.0, modes)
    exponents[1:3] = sorted(exponents[1:3], key=lambda value: value.real)
    driven = np.arange(modes) == 2
    arrays = plain_record(
        exponents=exponents,
        driven=driven,
        offsets=np.array([0.1 - 0.2j]),
        rows=random.normal(size=(1, modes)) + 1j * random.normal(size=(1, modes)),
    )
    work = workspace(modes)
    work.current[:] = random.normal(size=modes) + 1j * random.normal(size=modes)
    origin = complex(arrays.offsets[0] + arrays.rows[0] @ work.current)
    block.load_products(arrays, 0, origin, work)
    return arrays, table.flight_table(exponents, driven), work, origin


def levels_of(arrays, amplitudes, times):
    """``|y|² − 1`` along a flight."""
    flown = fly_all(arrays, np.tile(amplitudes, (len(times), 1)), times)
    return np.abs(arrays.offsets[0] + flown @ arrays.rows[0]) ** 2 - 1.0


@pytest.mark.parametrize("seed", range(3))
def test_the_level_is_linear_in_the_products(seed):
    """The factors of the table times the products of the amplitudes add up to the change of ``|y|²``."""
    arrays, tables, work, origin = some_modes(seed)
    times = np.linspace(0.05, 1.0, 9) * tables.durations[0]
    factors = table._rows(arrays.exponents, arrays.driven.astype(bool), times) * times
    expected = levels_of(arrays, work.current, times) - (abs(origin) ** 2 - 1.0)
    np.testing.assert_allclose(work.products @ factors, expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("depth", range(LEVELS))
def test_the_polynomial_that_is_loaded_is_near_the_flight(depth):
    for seed in range(3):
        arrays, tables, work, origin = some_modes(seed, 2)
        level = abs(origin) ** 2 - 1.0
        remainder = block.load_polynomial(tables, depth, level, work)
        assert remainder == pytest.approx(np.abs(work.products) @ tables.errors[depth], rel=1e-12)
        np.testing.assert_allclose(
            work.polynomial, level + work.products @ tables.coefficients[depth], rtol=0.0, atol=1e-12
        )
        shares = np.linspace(0.0, 1.0, 33)
        values = [bernstein(np.append(level, work.polynomial), share) for share in shares]
        found = levels_of(arrays, work.current, shares * tables.durations[depth])
        assert np.all(np.abs(values - found) <= remainder * shares + 1e-12)


def bernstein(coefficients, share):
    """Value of a polynomial, by de Casteljau's scheme."""
    while len(coefficients) > 1:
        coefficients = (1.0 - share) * coefficients[:-1] + share * coefficients[1:]
    return coefficients[0]


@pytest.mark.parametrize("seed", range(3))
def test_many_modes_are_moved_to_any_time(seed):
    arrays, tables, work, origin = some_modes(seed)
    level = abs(origin) ** 2 - 1.0
    for share in (0.0, 0.004, 0.5, 0.993, 1.0):
        time = share * float(tables.durations[0])
        flown = fly_all(arrays, work.current[None], np.array([time]))[0]
        block.move_to(arrays, tables, time, work)
        np.testing.assert_allclose(work.end, flown, rtol=0.0, atol=1e-13 * np.abs(flown).max())
        np.testing.assert_allclose(work.increments, flown - work.current, rtol=0.0, atol=1e-13 * np.abs(flown).max())
    for node in (0, 1, NODES // 3, NODES):
        flown = fly_all(arrays, work.current[None], np.array([node * float(tables.spacing)]))[0]
        y, v, a, j = (
            arrays.offsets[0] + arrays.rows[0] @ flown,
            *(rows[0] @ flown for rows in (arrays.rate_rows, arrays.acceleration_rows, arrays.jerk_rows)),
        )
        expected = [abs(y) ** 2 - 1.0, 2 * y * np.conj(v), 2 * (y * np.conj(a) + v * np.conj(v))]
        expected.append(2 * (y * np.conj(j) + 3 * v * np.conj(a)))
        found = block.look_at_node(tables, node, origin, level, work)
        np.testing.assert_allclose(found, np.real(expected), rtol=1e-11, atol=1e-10)


def test_a_power_series_is_the_sum_of_its_terms():
    random = np.random.default_rng(9)
    series = random.normal(size=(TERMS + 2, 3)) + 1j * random.normal(size=(TERMS + 2, 3))
    for time in (0.0, 0.2, -0.7, 1.5):
        expected = time ** np.arange(1.0, TERMS + 1) @ series[:TERMS]
        found = [block._power_series(series, column, time) for column in range(3)]
        np.testing.assert_allclose(found, expected, rtol=1e-13)


def bernstein_of_line(start, slope):
    """Coefficients ``b₁ … b_n`` of ``start + slope t``; ``b₀`` is the start."""
    return start + slope * np.arange(1, DEGREE + 1) / DEGREE


def test_the_root_of_a_line_is_found_where_it_is():
    for root in (0.03, 0.26, 0.5, 0.71, 0.999):
        line = bernstein_of_line(-root, 1.0)
        changes, first = block.sign_changes(line, -root, 0.0, 0.0)
        assert changes == 1
        assert block.rough_root(line, -root, first) == pytest.approx(root, abs=1e-14)


def test_in_a_flight_from_the_wall_the_root_at_the_start_is_divided_out():
    """``t(t − root)`` of degree two, written in the degree of the block."""
    j, n = np.arange(1, DEGREE + 1), DEGREE
    for root in (0.07, 0.3, 0.45):
        square = j * (j - 1) / (n * (n - 1)) - root * j / n
        changes, first = block.sign_changes(square, 0.0, 0.0, 0.0)
        assert changes == 1
        if first <= n // 2:
            assert block.rough_root(square, 0.0, first) == pytest.approx(root, abs=1e-13)


def test_sign_changes_are_counted_with_the_error_of_the_polynomial():
    inside = np.full(DEGREE, -1.0)
    assert block.sign_changes(inside, -1.0, 0.1, 0.1) == (0, DEGREE)
    # The error grows from the floor at the start to floor and remainder at the end.
    assert block.sign_changes(inside, -1.0, 0.5, 0.49)[0] == 0
    assert block.sign_changes(inside, -1.0, 0.5, 0.5) == (1, DEGREE - 1)
    assert block.sign_changes(inside, -1.0, 0.0, DEGREE / (DEGREE - 1.0)) == (1, DEGREE - 2)
    # Two stretches above, and a start within its rounding, are not to be decided.
    twice = inside.copy()
    twice[[1, 3]] = 1.0
    assert block.sign_changes(twice, -1.0, 0.0, 0.0) == (2, 1)
    twice[2] = 1.0
    assert block.sign_changes(twice, -1.0, 0.0, 0.0) == (1, 1)
    assert block.sign_changes(inside, -0.1, 0.1, 0.0)[0] == 2
    assert block.sign_changes(inside, -0.1, 0.09, 0.0)[0] == 0
    # From the wall: the first coefficient, which is the slope, decides whether it leaves.
    leaving = inside.copy()
    assert block.sign_changes(leaving, 0.0, 0.1, 0.0)[0] == 0
    leaving[0] = 1.0
    assert block.sign_changes(leaving, 0.0, 0.1, 0.0) == (2, 0)
    # A start inside may be all above with its error, and then falls or not; one above the wall is not to be decided.
    above = np.full(DEGREE, 1.0)
    assert block.sign_changes(above, -1.0, 0.0, 0.0) == (1, 0)
    assert block.sign_changes(above, 1e-9, 0.0, 0.0) == (2, 0)
    assert block.sign_changes(above, 0.0, 0.0, 0.0) == (2, 0)
    assert block.sign_changes(inside, 1e-9, 0.0, 0.0)[0] == 2
    # A coefficient that is zero with its error counts as above; so does the last alone.
    touching = inside.copy()
    touching[-1] = 0.0
    assert block.sign_changes(touching, -1.0, 0.0, 0.0) == (1, DEGREE - 1)
    apart = inside.copy()
    apart[[0, -1]] = 1.0
    assert block.sign_changes(apart, -1.0, 0.0, 0.0) == (2, 0)


def test_a_rough_root_lies_between_the_coefficients_that_change_sign():
    n = DEGREE
    steps = np.where(np.arange(1, n + 1) <= 3, -1.0, 3.0)
    # Between b₃ = −1 and b₄ = 3, a quarter of the way; from the start, between b₀ and b₁.
    assert block.rough_root(steps, -1.0, 3) == pytest.approx(3.25 / n)
    assert block.rough_root(np.full(n, 3.0), -1.0, 0) == pytest.approx(0.25 / n)
    # From the wall, between b₃n/3 and b₄n/4 of the polynomial that is left, of one degree less.
    assert block.rough_root(steps, 0.0, 3) == pytest.approx((2.0 + 4.0 / 13.0) / (n - 1))
    # In the second half of a block the root at the start is far.
    late = np.where(np.arange(1, n + 1) <= 6, -1.0, 3.0)
    assert block.rough_root(late, 0.0, 6) == pytest.approx(6.25 / n)
    # A coefficient that is above with its error alone: at the end of the interval, or where there is no rise midway.
    barely = np.full(n, -1.0)
    barely[3] = -0.5
    assert block.rough_root(barely, -1.0, 3) == pytest.approx(4.0 / n)
    assert block.rough_root(np.full(n, -1.0), -1.0, 3) == pytest.approx(3.5 / n)
    barely[3] = -1.5
    assert block.rough_root(barely, -1.0, 3) == pytest.approx(3.5 / n)
