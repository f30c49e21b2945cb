"""Labels that do not overlap: move them apart along a line or around a circle, as little as possible."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import isotonic_regression  # type: ignore[import-untyped]


def spread(wanted: ArrayLike, gap: float) -> NDArray[np.float64]:
    """Return positions at least `gap` apart, in the order of the wanted ones and nearest in the least-squares sense.

    With ``y_i = x_i - i gap`` the task is to find the non-decreasing sequence nearest to y: isotonic regression.
    """
    positions = np.asarray(wanted, dtype=float)
    order, offsets = np.argsort(positions, kind="stable"), gap * np.arange(len(positions))
    placed = np.empty_like(positions)
    placed[order] = isotonic_regression(positions[order] - offsets).x + offsets
    return placed


def spread_angles(wanted: ArrayLike, gap: float) -> NDArray[np.float64]:
    """Return the same around a circle [rad]; the circle is cut in the widest gap between labels."""
    angles = np.asarray(wanted, dtype=float)
    if len(angles) < 2:
        return angles.copy()
    turned = np.sort(np.mod(angles, 2.0 * np.pi))
    spaces = np.diff(np.append(turned, turned[0] + 2.0 * np.pi))
    cut = turned[np.argmax(spaces)] + spaces.max() / 2.0
    return spread(np.mod(angles - cut, 2.0 * np.pi), gap) + cut
