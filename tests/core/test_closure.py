"""The linear equations of Newton's method; the iteration is tested with orbits."""

import numpy as np
import pytest

from carom.core.closure import shooting_equations
from carom.core.compiling.decorators import kernel
from carom.core.equations import solve

SEGMENTS, ENTRIES = 3, 3
WIDTH = 2 * ENTRIES + 1


@kernel
def solved(matrix):
    return solve(matrix)


def test_equations_are_solved_with_pivots():
    rng = np.random.default_rng(2)
    for size in (1, 2, 5, 15):
        matrix, right = rng.normal(size=(size, size)), rng.normal(size=size)
        if size > 1:
            matrix[0, 0] = 0.0
        both = np.column_stack([matrix, right])
        assert solved(both)
        assert np.abs(both[:, -1] - np.linalg.solve(matrix, right)).max() < 1e-11


def test_equations_without_a_solution_are_told():
    assert not solved(np.array([[1.0, 2.0, 1.0], [2.0, 4.0, 1.0]]))
    assert not solved(np.array([[np.nan, 1.0]]))


def residual(nodes, durations, slopes):
    ends = [
        slope @ np.concatenate([node.real, node.imag, [duration]])
        for node, duration, slope in zip(nodes, durations, slopes, strict=True)
    ]
    arrivals = np.array([end[:ENTRIES] + 1j * end[ENTRIES:-1] for end in ends])
    return shooting_equations(nodes, arrivals, np.array([end[-1] for end in ends]), slopes)


def test_the_matrix_is_the_derivative_of_the_left_sides():
    # Nodes, arrivals, values and slopes of segments that follow from their nodes by given slopes.
    random = np.random.default_rng(4)
    nodes = random.normal(size=(SEGMENTS, ENTRIES, 2)) @ [1.0, 1j]
    slopes = random.normal(size=(SEGMENTS, WIDTH, WIDTH))
    parts = nodes, np.ones(SEGMENTS), slopes
    nodes, durations, slopes = parts
    matrix = residual(nodes, durations, slopes)[:, :-1]
    step, columns = 1e-6, []
    for place in range(SEGMENTS * WIDTH):
        segment, entry = divmod(place, WIDTH)
        sides = []
        for sign in (1.0, -1.0):
            moved, lasted = nodes.copy(), durations.copy()
            if entry == WIDTH - 1:
                lasted[segment] += sign * step
            else:
                moved[segment, entry % ENTRIES] += sign * step * (1j if entry >= ENTRIES else 1.0)
            sides.append(residual(moved, lasted, slopes)[:, -1])
        columns.append((sides[0] - sides[1]) / (2.0 * step))
    assert matrix == pytest.approx(np.transpose(columns), abs=1e-8)
