"""Basin entropy: a measure of how unpredictable the end of a disturbance is.

A. Daza, A. Wagemakers, B. Georgeot, D. Guéry-Odelin, M. A. F. Sanjuán, "Basin entropy: a new tool to analyze uncertainty
in dynamical systems", Scientific Reports 6, 31416 (2016).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.arguments import Count, checked
from carom.basins.classification import Basin
from carom.disturbances import Grid
from carom.outcome import InputError

IN_A_BOX = 25
"""Approximate number of starts in a box, as the authors recommend."""


@dataclass(frozen=True)
class BasinEntropy:
    """Basin entropy of a grid.

    Attributes
    ----------
    whole : float
        ``S_b``: mean of ``−Σ p ln p`` over all boxes, ``p`` the shares of the motions in a box; boxes, and starts in them,
        weigh by their area.
    boundary : float
        ``S_bb``: the same mean over boxes with more than one motion; ``nan`` if there are none.
    side : int
        Starts along the side of a box.
    boxes, mixed : int
        Number of boxes, and of boxes with more than one motion.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("daza2016",)

    whole: float
    boundary: float
    side: int
    boxes: int
    mixed: int

    @property
    def fractal(self) -> bool:
        """Whether ``S_bb > ln 2``: then the boundary cannot be smooth (a sufficient condition)."""
        return self.boundary > math.log(2.0)


@checked
def basin_entropy(basin: Basin, side: Count | None = None) -> BasinEntropy:
    """Basin entropy and boundary basin entropy of starts on a grid.

    Parameters
    ----------
    side : int, optional
        Starts along the side of a box; by default chosen so that a box has about 25.

    Raises
    ------
    InputError
        The starts are a sample, or too few for a box.

    See Also
    --------
    carom.basins.integrity : the largest ball of starts that come back

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> basin = cm.map_basins(machine, cm.Grid(kicks, (10, 12)))
    >>> print(cm.basins.basin_entropy(basin).boxes)
    4
    """
    if not isinstance(basin.plan, Grid):
        raise InputError("basin", "a sample", "starts on a grid, of which boxes can be made")
    return entropies(basin.dataset["motion"].values, basin.plan.weights(), side)


def usual_side(dimensions: int) -> int:
    """Starts along the side of a box, where it is not chosen."""
    return max(2, round(IN_A_BOX ** (1.0 / dimensions)))


def entropies(labels: np.ndarray, weights: np.ndarray | None = None, side: int | None = None) -> BasinEntropy:
    """Basin entropy of labels on a grid with room for a box; boxes with a negative label are left out.

    Cells weigh alike unless weights are given.
    """
    side = side or usual_side(labels.ndim)
    counts = [cells // side for cells in labels.shape]
    if side < 2 or not all(counts):
        raise InputError("side", side, f"2 to {min(labels.shape)}, the smallest side of the grid")
    boxes = _boxes(labels, counts, side)
    weights = _boxes(np.ones(labels.shape) if weights is None else weights, counts, side)
    inside = (boxes >= 0).all(axis=1)
    boxes, weights = boxes[inside], weights[inside]
    if not len(boxes):
        return BasinEntropy(math.nan, math.nan, side, 0, 0)
    values, whole = np.zeros(len(boxes)), weights.sum(axis=1)
    for label in np.unique(boxes):
        share = np.where(boxes == label, weights, 0.0).sum(axis=1) / whole
        values -= share * np.log(np.where(share > 0.0, share, 1.0))
    mixed = boxes.min(axis=1) != boxes.max(axis=1)
    values[~mixed] = 0.0  # free of the rounding of the sums
    boundary = float(np.average(values[mixed], weights=whole[mixed])) if mixed.any() else math.nan
    return BasinEntropy(float(np.average(values, weights=whole)), boundary, side, len(boxes), int(mixed.sum()))


def _boxes(cells: np.ndarray, counts: list[int], side: int) -> np.ndarray:
    """Cells box by box, shape (boxes, cells of a box); those beyond the last whole box are left out."""
    trimmed = cells[tuple(slice(count * side) for count in counts)]
    split = trimmed.reshape([part for count in counts for part in (count, side)])
    order = [*range(0, 2 * cells.ndim, 2), *range(1, 2 * cells.ndim, 2)]
    return split.transpose(order).reshape(math.prod(counts), -1)
