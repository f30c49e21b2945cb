"""Integrity: the size of balls of starts that all come back.

J. M. T. Thompson, "Chaotic phenomena triggering the escape from a potential well", Proc. R. Soc. A 421, 195 (1989);
S. Lenci, G. Rega, "Optimal control of nonregular dynamics in a Duffing oscillator", Nonlinear Dynamics 33, 71 (2003).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.arguments import checked
from carom.basins.classification import Basin
from carom.disturbances import BaseShock, Coordinate, Grid, KickPlane, StateSlice, VelocityKick
from carom.outcome import InputError

BLOCK = 64
"""Columns of a grid whose distances are computed at a time."""


@dataclass(frozen=True)
class Integrity:
    """Largest balls of starts in which none of those tried is lost.

    Attributes
    ----------
    local : float
        Radius of the largest ball about levitation (no disturbance), as a fraction of ``whole``: local integrity measure.
    largest : float
        Radius of the largest ball anywhere inside the range of the disturbances, as a fraction of ``whole``: integrity
        factor.  ``nan`` where only balls about levitation make sense.
    centre : tuple of float
        Centre of that ball; empty where there is none.
    whole : float
        Radius of the largest ball that fits into the range, dimensionless.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("thompson1989", "lenci2003")

    local: float
    largest: float
    centre: tuple[float, ...]
    whole: float


@checked
def integrity(basin: Basin) -> Integrity:
    """Integrity of the starts of a basin.

    For kicks and shocks by size and direction the ball ends before the smallest lost start; in a plane balls contain no
    lost cell.  For a sample the nearest lost start limits the ball, so the ball shrinks as the sample grows.  Starts
    that were given up count as lost.

    Raises
    ------
    InputError
        The disturbances have no size that is zero in levitation, or they are states of four coordinates, where a sample
        is too sparse to measure a ball.

    See Also
    --------
    carom.basins.basin_entropy : how mixed the ends are
    carom.basins.smallest_loss : a search instead of a grid

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> basin = cm.map_basins(machine, cm.Grid(kicks, (10, 12)))
    >>> print(round(cm.basins.integrity(basin).local, 3))
    0.05
    """
    model, plan = basin.plan.model, basin.plan
    lost = basin.exists & ~basin.recovered
    if isinstance(model, VelocityKick | BaseShock):
        size = model.coordinates[0]
        if isinstance(plan, Grid):
            reach = safe_size(size, lost)
        else:
            reach = float(plan.values()[0][lost].min(initial=size.high))
        return Integrity(reach / size.high, math.nan, (), size.high)
    if isinstance(model, KickPlane | StateSlice) and isinstance(plan, Grid):
        rest = complex(basin.rotor.system.arrays.offsets[0])
        centre = (0.0, 0.0) if isinstance(model, KickPlane) else (rest.real, rest.imag)
        return _in_plane(basin, plan, centre)
    if isinstance(model, KickPlane | StateSlice):
        return _in_sample(basin, lost)
    raise InputError("basin", model.kind, "disturbances with a size that is zero in levitation: kick, shock or slice")


def safe_size(size: Coordinate, lost: np.ndarray) -> float:
    """Largest size tried up to which no start of a grid is lost; the first axis of ``lost`` is the size."""
    bad = lost.reshape(len(lost), -1).any(axis=1)
    if not bad.any():
        return size.high
    first = int(bad.argmax())
    return float(size.middles(len(lost))[first - 1]) if first else 0.0


def _in_plane(basin: Basin, plan: Grid, centre: tuple[float, float]) -> Integrity:
    x, y = plan.values()
    first, second = plan.model.coordinates
    whole = min(first.high - first.low, second.high - second.low) / 2.0
    barred = ~basin.recovered
    cells = (first.high - first.low) / len(x), (second.high - second.low) / len(y)
    nearest = np.maximum(_distances(barred, x, y) - 0.5 * max(cells), 0.0)
    edge = np.minimum(
        np.minimum(x - first.low, first.high - x)[:, None], np.minimum(y - second.low, second.high - y)[None, :]
    )
    radius = np.where(barred, 0.0, np.minimum(nearest, edge))
    best = np.unravel_index(int(radius.argmax()), radius.shape)
    away = np.hypot(
        np.maximum(np.abs(x - centre[0]) - 0.5 * cells[0], 0.0)[:, None],
        np.maximum(np.abs(y - centre[1]) - 0.5 * cells[1], 0.0)[None, :],
    )
    room = min(centre[0] - first.low, first.high - centre[0], centre[1] - second.low, second.high - centre[1])
    local = min(float(away[barred].min(initial=math.inf)), room)
    return Integrity(local / whole, float(radius[best]) / whole, (float(x[best[0]]), float(y[best[1]])), whole)


def _distances(barred: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Exact Euclidean distance of every cell to the nearest barred one, computed first along ``x``, then across it."""
    places = np.where(barred, x[:, None], np.nan)
    below, above = np.full(barred.shape, -np.inf), np.full(barred.shape, np.inf)
    for row in range(len(x)):
        below[row] = np.where(barred[row], places[row], below[row - 1] if row else -np.inf)
    for row in reversed(range(len(x))):
        above[row] = np.where(barred[row], places[row], above[row + 1] if row + 1 < len(x) else np.inf)
    along = np.minimum(x[:, None] - below, above - x[:, None]) ** 2
    squares = np.empty(barred.shape)
    for first in range(0, len(y), BLOCK):
        across = (y[None, first : first + BLOCK] - y[:, None]) ** 2
        squares[:, first : first + BLOCK] = (along[:, :, None] + across[None]).min(axis=1)
    return np.sqrt(squares)


def _in_sample(basin: Basin, lost: np.ndarray) -> Integrity:
    """Distance of the nearest lost start from levitation in the plane."""
    dataset, rest = basin.dataset, complex(basin.rotor.system.arrays.offsets[0])
    if isinstance(basin.plan.model, KickPlane):
        apart, whole = np.hypot(dataset["start_vx"].values, dataset["start_vy"].values), basin.coordinates[0].high
    else:
        apart = np.hypot(dataset["start_x"].values - rest.real, dataset["start_y"].values - rest.imag)
        whole = max(1.0 - abs(rest), 0.0)
    nearest = float(apart[lost].min(initial=whole))
    return Integrity(nearest / whole if whole else 0.0, math.nan, (), whole)
