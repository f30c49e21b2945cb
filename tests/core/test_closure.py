"""The linear equations of Newton's method; the iteration itself is tested with orbits."""

from __future__ import annotations

import numpy as np

from carom.compiling.decorators import kernel
from carom.core.equations import solve


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
