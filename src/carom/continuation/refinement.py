"""Points of a branch, dense enough to draw it with straight lines."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from carom.continuation.branch import Branch
from carom.continuation.equations import Equations

HALVINGS = 6
"""Largest number of times that a step is halved to insert points."""


def refined_points(equations: Equations, branch: Branch, *, widths: np.ndarray, bend: float) -> np.ndarray:
    """Points and special points of a branch, and as many points in between as needed to draw it with straight lines.

    Parameters
    ----------
    equations : Equations
    widths : ndarray, shape (n + 1,)
        Ranges of the picture; ``inf`` for a quantity it does not show.
    bend : float
        Largest distance of the branch from the straight line half way between neighbouring points, in ``widths``.

    Returns
    -------
    ndarray, shape (m, n + 1)
        Unknowns and parameter, in the order of the branch.
    """
    scales = equations.scales
    places = np.concatenate([np.arange(len(branch.parameters)), [point.place for point in branch.special]])
    own = np.column_stack([branch.unknowns, branch.parameters])
    special = np.array([[*point.unknowns, point.parameter] for point in branch.special]).reshape(-1, own.shape[1])
    points = np.concatenate([own, special])[np.argsort(places, kind="stable")] / scales

    def between(first: np.ndarray, last: np.ndarray, halvings: int) -> list[np.ndarray]:
        chord, middle = last - first, 0.5 * (first + last)
        if not halvings:
            return []
        length = float(np.linalg.norm(chord))
        normal = chord / length
        found = equations.correct(middle, normal, equations.inverse(middle, normal))
        if found is None or np.linalg.norm(found - middle) > 0.5 * length:
            return []
        if np.linalg.norm((found - middle) * scales / widths) <= bend:
            return []
        return [*between(first, found, halvings - 1), found, *between(found, last, halvings - 1)]

    # A special point that ends the branch is listed twice.
    apart = np.linalg.norm(np.diff(points, axis=0), axis=1) > equations.steps.smallest
    points = points[np.append(True, apart)]
    rows = [points[0]]
    for first, last in pairwise(points):
        rows += [*between(first, last, HALVINGS), last]
    return np.array(rows) * scales
