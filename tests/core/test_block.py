"""The parts of the crossing search on a block, each alone, against numpy and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from flights import inside_task, rotors

from carom.core import block
from carom.core.layout import DEGREE, NODES, workspace


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
    arrays = rotor.arrays
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
        expected = derivatives_of_level(rotor, rotor.fly(task.amplitudes, np.array(time)))
        found = block.look_at_node(task.table, node, origin, level, work)
        np.testing.assert_allclose(found, expected, rtol=1e-11, atol=1e-11)
    for time in task.table.durations[0] * np.array([0.0, 0.013, 0.31, 0.77, 1.0]):
        block.move_to(task.arrays, task.table, time, work)
        flown = rotor.fly(task.amplitudes, np.array(time))
        np.testing.assert_allclose(work.arrival, flown, rtol=0.0, atol=1e-13 * np.abs(flown).max())
        np.testing.assert_allclose(work.increments, flown - task.amplitudes, rtol=0.0, atol=1e-13 * np.abs(flown).max())


def test_the_nearest_node_is_within_half_a_spacing():
    _, task, _, _ = loaded(60)
    spacing = task.table.spacing
    for time in np.linspace(-1.0, NODES + 1.0, 997) * spacing:
        nearest = int(np.argmin(np.abs(np.arange(NODES + 1) * spacing - time)))
        assert abs(block.nearest_node(task.table, time) - nearest) <= (abs(time / spacing % 1.0 - 0.5) < 1e-9)


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
