"""The equations of multiple shooting, Newton's method for words of impacts with the flights after them, and derivatives of a period."""

from __future__ import annotations

import numpy as np

from carom.core.compiling.decorators import inlined, kernel
from carom.core.equations import solve
from carom.core.segments import follow_flights

LAST = 1e-6
"""Longest last step, relative to one plus the size of the nodes; a longer one comes from the singular derivative at a fold."""


@kernel
def close_flights(
    rotor,
    basis,
    to_modes,
    rest,
    kinds,
    stations,
    targets,
    nodes,
    durations,
    ends,
    values,
    slopes,
    tolerance,
    steps,
):
    """Correct nodes and durations in place until each segment ends at the next node; see :func:`follow_flights`.

    Parameters
    ----------
    tolerance : float
        Largest residual accepted, relative to one plus the size of the nodes; one more step follows, unless it is long.
    steps : int
        Number of steps after which to give up.

    Returns
    -------
    bool
        Whether it converged, to positive durations.
    """
    m, numbers = nodes.shape
    width = 2 * numbers + 1
    matrix = np.empty((m * width, m * width + 1))
    before = np.inf
    for _ in range(steps):
        follow_flights(rotor, basis, to_modes, rest, kinds, stations, targets, nodes, durations, ends, values, slopes)
        _assemble(nodes, ends, values, slopes, matrix)
        largest, size = 0.0, 1.0
        for row in range(m * width):
            largest = max(largest, abs(matrix[row, m * width]))
        for i in range(m):
            for k in range(numbers):
                size = max(size, 1.0 + abs(nodes[i, k]))
        # Rounding lets the residual fall no further: the last step has converged too.
        done = largest <= tolerance * size or (largest <= 1e3 * tolerance * size and largest >= 0.5 * before)
        if not (largest < np.inf and solve(matrix)):
            return False
        before, farthest = largest, 0.0
        for row in range(m * width):
            farthest = max(farthest, abs(matrix[row, m * width]))
        if done and farthest > LAST * size:
            return True
        for i in range(m):
            for k in range(numbers):
                nodes[i, k] -= complex(matrix[i * width + k, m * width], matrix[i * width + numbers + k, m * width])
            durations[i] -= matrix[i * width + 2 * numbers, m * width]
            if not durations[i] > 0.0:
                return False
        if done:
            return True
    return False


@kernel
def shooting_equations(nodes, ends, values, slopes):
    """Derivative of the left sides by nodes and durations, and the left sides as last column; see :func:`close_flights`."""
    size = nodes.shape[0] * slopes.shape[1]
    matrix = np.empty((size, size + 1))
    _assemble(nodes, ends, values, slopes, matrix)
    return matrix


@inlined
def _assemble(nodes, ends, values, slopes, matrix):
    """Write the equations: each segment ends at the next node, where its condition is fulfilled."""
    m, numbers = nodes.shape
    width = 2 * numbers + 1
    matrix[:] = 0.0
    for i in range(m):
        after = (i + 1) % m
        for row in range(width):
            for column in range(width):
                matrix[i * width + row, i * width + column] += slopes[i, row, column]
        for k in range(numbers):
            apart = ends[i, k] - nodes[after, k]
            matrix[i * width + k, after * width + k] -= 1.0
            matrix[i * width + numbers + k, after * width + numbers + k] -= 1.0
            matrix[i * width + k, m * width] = apart.real
            matrix[i * width + numbers + k, m * width] = apart.imag
        matrix[i * width + 2 * numbers, m * width] = values[i]


@kernel
def carry_through_segments(slopes):
    """Derivative of the end of each segment by its node if it ends where its condition is fulfilled, and their product."""
    m, last = slopes.shape[0], slopes.shape[1] - 1
    passages, product = np.empty((m, last, last)), np.empty((last, last))
    for row in range(last):
        for column in range(last):
            product[row, column] = 1.0 if row == column else 0.0
    for i in range(m):
        for row in range(last):
            for column in range(last):
                delay = -slopes[i, last, column] / slopes[i, last, last]
                passages[i, row, column] = slopes[i, row, column] + slopes[i, row, last] * delay
        before = product.copy()
        for row in range(last):
            for column in range(last):
                total = 0.0
                for k in range(last):
                    total += passages[i, row, k] * before[k, column]
                product[row, column] = total
    return passages, product
