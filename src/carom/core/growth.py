"""Growth of directions along a motion: products of derivatives with the directions made orthogonal again and again."""

from __future__ import annotations

import math

import numpy as np

from carom.compiling.decorators import kernel


@kernel
def carry_orthogonal(passages, directions, factors):
    """Carry orthonormal directions through derivatives, by a QR decomposition after each.

    Parameters
    ----------
    passages : array, shape (m, n, n)
        Derivatives, the first one first.
    directions : array, shape (n, k)
        Orthonormal columns; overwritten.  A column that is taken away becomes zero.
    factors : array, shape (m, k)
        Overwritten: diagonal of each triangular factor, the growth of each direction.
    """
    size, count = directions.shape
    moved = np.empty(size)
    for i in range(passages.shape[0]):
        for column in range(count):
            for row in range(size):
                moved[row] = 0.0
                for k in range(size):
                    moved[row] += passages[i, row, k] * directions[k, column]
            # The columns before are new ones already.  Gram-Schmidt twice is orthogonal to rounding.
            for _ in range(2):
                for other in range(column):
                    along = 0.0
                    for row in range(size):
                        along += directions[row, other] * moved[row]
                    for row in range(size):
                        moved[row] -= along * directions[row, other]
            length = 0.0
            for row in range(size):
                length += moved[row] * moved[row]
            length = math.sqrt(length)
            factors[i, column] = length
            for row in range(size):
                directions[row, column] = moved[row] / length if length > 0.0 else 0.0
