"""Which disturbances are tried, grids and seeded samples, and what is measured of where they end."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple, Self, TypeAlias

import numpy as np

from carom.base.arguments import Count, Seed, Whole, checked
from carom.base.outcome import InputError
from carom.disturbances.coordinates import INSTANT, Starts
from carom.disturbances.model import Disturbance
from carom.parameters import Scales
from carom.parameters.formats import format_angle

if TYPE_CHECKING:
    from carom.models import Rotor


ANY_INSTANT, ITS_INSTANT = "at any instant of the turn", "at its own random instant of the turn"
INSTANTS = 1
"""Stream of random numbers of instants: sizes and directions are the same on machines on which the instant does not matter."""


class Quantity(NamedTuple):
    """Unit and words of what is measured, and the property of the scales that converts it to SI units, if that is not 1."""

    unit: str
    words: str
    scale: str = ""


SHARES = {
    "recovered": Quantity("1", "share of the disturbances that comes back to levitation, by area"),
    "recovered_low": Quantity("1", "lower end of its 95 % confidence interval (of a grid: the share)"),
    "recovered_high": Quantity("1", "upper end of its 95 % confidence interval (of a grid: the share)"),
    "unresolved": Quantity("1", "share whose end is unknown: given up, or beyond the model"),
}
SMALLEST = "smallest_unrecovered_kick"
KICKS = {
    SMALLEST: Quantity("c_r Omega", "smallest kick tried that does not come back", "velocity"),
    f"{SMALLEST}_angle": Quantity("rad", "its direction, from the real axis of the co-rotating frame"),
    f"{SMALLEST}_instant": Quantity("rad", INSTANT.words),
}


@dataclass(frozen=True)
class _Plan:
    model: Disturbance

    @checked
    def rescaled(self, before: Scales | None, after: Scales | None) -> Self:
        """Return the plan that is the same in SI units for a machine with other scales."""
        return replace(self, model=self.model.rescaled(before, after))


@checked
@dataclass(frozen=True)
class Grid(_Plan):
    """Cells of equal width along every coordinate, each represented by its middle; by size and direction they weigh by area.

    Attributes
    ----------
    model : Disturbance
    shape : tuple of int
        Cells along each coordinate.
    instant : float, optional
        Angle in rad by which the shaft has turned when they come, on a machine on which that matters; by default each cell has one of
        its own, drawn at random, so that shares are averages over the turn.

    See Also
    --------
    carom.disturbances.Sample : a seeded random sample instead
    carom.map_basins, carom.map_gains : follow a plan

    Examples
    --------
    >>> import carom as cm
    >>> cm.Grid(cm.disturbances.VelocityKick(0.5), (20, 36)).count
    720
    """

    shape: tuple[int, ...]
    instant: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "shape", tuple(map(int, self.shape)))  # as JSON and hashes need them, not NumPy's
        names = [coordinate.name for coordinate in self.model.coordinates]
        if len(self.shape) != len(names) or any(cells < 1 for cells in self.shape):
            given = "x".join(map(str, self.shape)) or None
            raise InputError("grid", given, f"numbers of cells, one for each of {', '.join(names)}")

    @property
    def count(self) -> int:
        """Number of cells."""
        return math.prod(self.shape)

    def values(self) -> tuple[np.ndarray, ...]:
        """Middles of the cells along each coordinate, one-dimensional."""
        return tuple(
            coordinate.middles(cells) for coordinate, cells in zip(self.model.coordinates, self.shape, strict=True)
        )

    def weights(self) -> np.ndarray:
        """Weight of each cell in shares, of the shape of the grid, one on average: in discs by area."""
        axes = zip(self.model.coordinates, self.shape, strict=True)
        along = np.meshgrid(*(coordinate.weights(cells) for coordinate, cells in axes), indexing="ij")
        found: np.ndarray = np.prod(along, axis=0)
        return found

    def fresh(self, number: int) -> Self:
        """Return the same grid: it draws nothing."""
        return self

    def starts(self, rotor: Rotor) -> Starts:
        """Starts, arrays of the shape of the grid."""
        from carom.models import rotor_of

        values = np.meshgrid(*self.values(), indexing="ij")
        return _begun(self.model, rotor_of(rotor), values, self.instants().reshape(self.shape))

    def instants(self) -> np.ndarray:
        """Instant of each cell, one-dimensional."""
        if self.instant is not None:
            return np.full(self.count, float(self.instant))
        return INSTANT.at(np.random.default_rng([0, INSTANTS]).random(self.count))


@checked
@dataclass(frozen=True)
class Sample(_Plan):
    """A seeded random sample; a longer one of the same seed begins with the shorter.

    It is uniform in every coordinate, and in the instant where that matters, but uniform over the area where sizes in all directions fill a disc (kicks, shocks,
    states).

    Attributes
    ----------
    model : Disturbance
    count : int
    seed : int

    See Also
    --------
    carom.Grid : cells of a grid instead

    Examples
    --------
    >>> import carom as cm
    >>> cm.disturbances.Sample(cm.disturbances.VelocityKick(0.5), 200, seed=1).count
    200
    """

    count: Count
    seed: Seed = 0

    def __post_init__(self) -> None:
        for name in ("count", "seed"):
            object.__setattr__(self, name, int(getattr(self, name)))  # as JSON needs it, not NumPy's

    def values(self) -> tuple[np.ndarray, ...]:
        """Value of each coordinate at each start, shape (count,)."""
        return self.model.drawn(np.random.default_rng(self.seed).random((self.count, len(self.model.coordinates))))

    def weights(self) -> np.ndarray:
        """Weight of each start in shares: ones."""
        return np.ones(self.count)

    @checked
    def fresh(self, number: Whole) -> Self:
        """Return a sample of the same model that is independent of this one, and of those with other numbers."""
        seeds = np.random.SeedSequence(self.seed, spawn_key=(number,))
        return replace(self, seed=int(seeds.generate_state(1, np.uint64)[0]))

    def starts(self, rotor: Rotor) -> Starts:
        """Starts, arrays of shape (count,)."""
        from carom.models import rotor_of

        return _begun(self.model, rotor_of(rotor), self.values(), self.instants())

    def instants(self) -> np.ndarray:
        """Instant of each start, shape (count,), on a machine on which that matters."""
        return INSTANT.at(np.random.default_rng([self.seed, INSTANTS]).random(self.count))


def _begun(model: Disturbance, rotor: Rotor, values: Sequence[np.ndarray], instants: np.ndarray) -> Starts:
    """Starts by values of the coordinates, at instants where these matter."""
    known = len(model.coordinates_on(rotor)) > len(values)
    return model.starts_on(rotor, *values, *((instants,) if known else ()))


Plan: TypeAlias = Grid | Sample


def instants_words(rotor: Rotor, plan: Plan | None = None) -> str:
    """At which instants of the turn disturbances come, where these matter, of a plan or of any sample; else nothing."""
    if not rotor.depends_on_instant:
        return ""
    if isinstance(plan, Grid) and plan.instant is not None:
        return f"at the instant at which the shaft has turned by {format_angle(plan.instant)}"
    return ANY_INSTANT


def plan_words(
    plan: Plan, before: float | None, scales: Scales | None, *, drawn: str | None = None, at: str = ""
) -> str:
    """Say which disturbances a plan tries on a machine with an eccentricity ``before`` them, in clearances, if there is one.

    ``drawn`` says how a sample is drawn where its own seed does not count, ``at`` at which instants they come.
    """
    if isinstance(plan, Grid):
        how = f"a grid of {' x '.join(map(str, plan.shape))}"
    else:
        how = drawn or f"a sample (seed {plan.seed})"
    when = f", {f'each {ITS_INSTANT}' if at == ANY_INSTANT else at}" if at else ""
    sizes = plan.model.up_to_words(before, scales)
    return ", ".join(filter(None, (f"{plan.count} {plan.model.noun}{when}", how, sizes)))
