"""Labels that do not overlap: move them apart along a line or around a circle, as little as possible."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def spread(wanted: ArrayLike, gap: float, low: float = -np.inf, high: float = np.inf) -> NDArray[np.float64]:
    """Return positions at least `gap` apart, in the order of the wanted ones and nearest in the least-squares sense.

    With ``y_i = x_i - i gap`` the task is to find the non-decreasing sequence nearest to y: isotonic regression by
    pooling adjacent violators.  The limits hold if there is room for all; otherwise the positions start at `low`.
    """
    positions = np.asarray(wanted, dtype=float)
    order = np.argsort(positions, kind="stable")
    offsets = gap * np.arange(len(positions))
    pools: list[tuple[float, int]] = []
    for value in positions[order] - offsets:
        mean, count = float(value), 1
        while pools and pools[-1][0] > mean:
            before, size = pools.pop()
            mean, count = (before * size + mean * count) / (size + count), size + count
        pools.append((mean, count))
    flat = np.repeat([mean for mean, _ in pools], [count for _, count in pools])
    placed = np.empty_like(positions)
    # Limits on the spread sequence become limits on the flattened one y, whose last member is shifted the most.
    placed[order] = np.maximum(np.minimum(flat, high - (offsets[-1] if len(offsets) else 0.0)), low) + offsets
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
