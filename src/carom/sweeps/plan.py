"""The plan of a sweep: a grid of machines, what is computed for each, and how the grid is divided into chunks."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from carom.outcome import InputError
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, Case, Field

if TYPE_CHECKING:
    from carom.sweeps.variables import Dimension, Variable

__all__ = ["MOST_CHUNKS", "GridAxis", "SweepPlan", "Task", "cut"]

MOST_CHUNKS = 1_000_000
"""Largest number of chunks of a sweep: each chunk is several files."""
SECONDS_A_CHUNK = 4.0
"""Estimated computing time of a chunk whose size is not given."""

Spacing = Literal["linear", "log", "list"]


class Task(Protocol):
    """What is computed at each point of a grid."""

    @property
    def kind(self) -> str:
        """Name of its table in the sweep file."""

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What is stored for each point."""

    @property
    def dimensions(self) -> tuple[Dimension, ...]:
        """Dimensions of the variables besides the axes."""

    @property
    def starts(self) -> int:
        """Motions at each point."""

    @property
    def seconds(self) -> float:
        """Estimated computing time of a point, in seconds."""

    def describe(self) -> dict[str, Any]:
        """Return what identifies the task, as plain data for JSON."""

    def evaluate(self, case: Case, seed: np.random.SeedSequence) -> dict[str, Any]:
        """Compute the values of one machine by variable name."""


@dataclass(frozen=True)
class GridAxis:
    """Values of one parameter.

    Attributes
    ----------
    name : str
        A field of a machine, or a dimensionless parameter.
    spacing : {"linear", "log", "list"}
    given : tuple of float
        First and last value, or all values of a list; in SI units or dimensionless.
    count : int
    """

    name: str
    spacing: Spacing
    given: tuple[float, ...]
    count: int

    @cached_property
    def values(self) -> np.ndarray:
        """All values, shape (count,)."""
        if self.spacing == "list":
            return np.array(self.given)
        low, high = self.given
        return (np.linspace if self.spacing == "linear" else np.geomspace)(low, high, self.count)

    @property
    def field(self) -> Field:
        """Words, symbol and unit of the parameter."""
        return {**DIMENSIONLESS_FIELDS, **MACHINE_FIELDS}[self.name]

    def describe(self) -> dict[str, Any]:
        """Return what identifies the axis, as plain data for JSON."""
        return {"name": self.name, "spacing": self.spacing, "values": list(self.given), "count": self.count}


@dataclass(frozen=True)
class SweepPlan:
    """What a sweep does.  Its memory use does not depend on the number of points or chunks.

    Attributes
    ----------
    case : Case
        The machine whose parameters the axes vary.
    axes : tuple of GridAxis
    task : Task
    chunk_shape : tuple of int
        Points of a chunk along each axis.
    seed : int
        The random numbers of a point follow from this seed and the number of the point alone.
    fixed : mapping of str to float
        Dimensionless numbers that were set.  They keep their values when the axes change mass, clearance or speed.
    sources : mapping of str to str
        Texts of the sweep file and of the machine file, which the store keeps.
    """

    case: Case
    axes: tuple[GridAxis, ...]
    task: Task
    chunk_shape: tuple[int, ...]
    seed: int = 0
    fixed: Mapping[str, float] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict, compare=False)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the grid."""
        return tuple(axis.count for axis in self.axes)

    @property
    def points(self) -> int:
        """Number of points of the grid."""
        return math.prod(self.shape)

    @property
    def chunk_grid(self) -> tuple[int, ...]:
        """Number of chunks along each axis."""
        return tuple(-(-count // chunk) for count, chunk in zip(self.shape, self.chunk_shape, strict=True))

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return math.prod(self.chunk_grid)

    def place(self, number: int) -> tuple[int, ...]:
        """Return the index of a chunk in the grid of chunks."""
        return tuple(int(place) for place in np.unravel_index(number, self.chunk_grid))

    def region(self, number: int) -> tuple[slice, ...]:
        """Return the part of the grid that a chunk covers."""
        return tuple(
            slice(place * chunk, min((place + 1) * chunk, count))
            for place, chunk, count in zip(self.place(number), self.chunk_shape, self.shape, strict=True)
        )

    def size(self, number: int) -> int:
        """Return the number of points of a chunk."""
        return math.prod(part.stop - part.start for part in self.region(number))

    def points_of(self, number: int) -> Iterator[tuple[int, ...]]:
        """Yield the indices of the points of a chunk in the grid; the last axis varies fastest."""
        region = self.region(number)
        for place in np.ndindex(*(part.stop - part.start for part in region)):
            yield tuple(part.start + step for part, step in zip(region, place, strict=True))

    def values(self, point: tuple[int, ...]) -> dict[str, float]:
        """Return the values of the parameters that vary, at a point of the grid."""
        return {axis.name: float(axis.values[place]) for axis, place in zip(self.axes, point, strict=True)}

    def case_at(self, point: tuple[int, ...]) -> Case:
        """Return the machine at a point, bit for bit the same as with ``--set``.

        Raises
        ------
        InputError
            The parameters of this point do not describe a machine.
        """
        case, values = self.case, {**self.fixed, **self.values(point)}
        numbers = {name: value for name, value in values.items() if name in DIMENSIONLESS_FIELDS}
        if case.machine is None:
            return Case(case.name, case.parameters.replace(**numbers), None, case.zones)
        machine = case.machine.replace(**values)
        return Case(case.name, machine.parameters.replace(**numbers), machine, case.zones)

    def seed_of(self, point: tuple[int, ...]) -> np.random.SeedSequence:
        """Return the seed of a point, which does not depend on its chunk or worker."""
        number = int(np.ravel_multi_index(point, self.shape))
        return np.random.SeedSequence(self.seed, spawn_key=(number,))

    def describe(self) -> dict[str, Any]:
        """Return what identifies the plan: two plans with the same description have the same results."""
        scales = self.case.parameters.scales
        return {
            "parameters": self.case.parameters.as_dict(),
            "scales": None if scales is None else [scales.mass, scales.clearance, scales.speed],
            "fixed": dict(self.fixed),
            "axes": [axis.describe() for axis in self.axes],
            "task": self.task.describe(),
            "chunk": list(self.chunk_shape),
            "seed": self.seed,
        }

    @property
    def digest(self) -> str:
        """Hash of the description."""
        return hashlib.sha256(json.dumps(self.describe(), sort_keys=True).encode()).hexdigest()


def cut(shape: tuple[int, ...], task: Task, chunk: int | None) -> tuple[int, ...]:
    """Return the shape of the chunks of a grid; a chunk extends along the last axes first.

    Parameters
    ----------
    shape : tuple of int
        Shape of the grid.
    task : Task
    chunk : int, optional
        Largest number of points of a chunk.  By default a chunk takes some seconds, and there are fewer chunks than
        allowed.

    Raises
    ------
    InputError
        There would be too many chunks.
    """
    points = math.prod(shape)
    wanted = chunk or max(int(SECONDS_A_CHUNK / task.seconds), -(-points // (MOST_CHUNKS // 4)), 1)
    sizes = []
    for count in reversed(shape):
        size = min(count, wanted)
        sizes.append(size)
        wanted = max(wanted // size, 1)
    sizes.reverse()
    chunks = math.prod(-(-count // size) for count, size in zip(shape, sizes, strict=True))
    if chunks > MOST_CHUNKS:
        least = -(-points // MOST_CHUNKS)
        raise InputError(
            "chunk", chunk, f"gives {chunks} chunks, at most {MOST_CHUNKS} are allowed; {least} or more points"
        )
    return tuple(sizes)
