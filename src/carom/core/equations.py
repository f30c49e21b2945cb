"""Linear equations in kernels."""

from __future__ import annotations

import numpy as np

from carom.core.compiling.decorators import kernel


@kernel
def solve(matrix):
    """Solve linear equations whose right side is the last column, which receives the solution; return whether there is one.

    Without one the last column is infinite.
    """
    n = matrix.shape[0]
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if not abs(matrix[best, k]) > 0.0:
            matrix[:, n] = np.inf
            return False
        if best != k:
            for j in range(k, n + 1):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        for i in range(k + 1, n):
            share = matrix[i, k] / matrix[k, k]
            if share != 0.0:
                for j in range(k + 1, n + 1):
                    matrix[i, j] -= share * matrix[k, j]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            matrix[k, n] -= matrix[k, j] * matrix[j, n]
        matrix[k, n] /= matrix[k, k]
    return True
