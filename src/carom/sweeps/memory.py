"""The results of a sweep in memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.sweeps.chunk import MOST_FAILURES, Chunk
from carom.sweeps.layout import coordinates_of, description_of
from carom.sweeps.plan import SweepPlan

if TYPE_CHECKING:
    import xarray


class SweepMemory(nullcontext[None]):
    """The results of a plan, with the methods of :class:`~carom.sweeps.store.SweepStore`."""

    path = None
    damaged = ()
    is_whole = True

    def __init__(self, plan: SweepPlan) -> None:
        super().__init__()
        self.plan = plan
        self._chunks: dict[int, Chunk] = {}

    @property
    def done(self) -> int:
        """Number of points that were computed without failure."""
        return sum(map(self.plan.size, self._chunks)) - self.failed

    @property
    def failed(self) -> int:
        """Number of points that failed."""
        return sum(len(chunk.failures) for chunk in self._chunks.values())

    def waiting(self, retry_failed: bool = False) -> Iterator[int]:
        """Yield the chunks that are not finished, in order."""
        yield from (number for number in range(self.plan.chunks) if number not in self._chunks)

    def write(self, chunk: Chunk) -> None:
        """Keep a chunk."""
        self._chunks[chunk.number] = chunk

    def failures(self) -> list[dict[str, Any]]:
        """Return the first failed points: index in the grid, parameters and error of each."""
        found = [asdict(failure) for number in sorted(self._chunks) for failure in self._chunks[number].failures]
        return found[:MOST_FAILURES]

    def dataset(self) -> xarray.Dataset:
        """Return the results computed so far, as :func:`~carom.sweeps.open_sweep` returns those of a store."""
        import xarray

        plan, names = self.plan, [axis.name for axis in self.plan.axes]
        variables = {}
        for one in plan.variables:
            values = np.full(plan.shape + one.shape, one.fill, one.dtype)
            for number, chunk in self._chunks.items():
                values[plan.region(number)] = chunk.arrays[one.name]
            variables[one.name] = [*names, one.along.name] if one.along else names, values, one.attributes
        coordinates = {name: (name, *given) for name, given in coordinates_of(plan).items()}
        data = xarray.decode_cf(xarray.Dataset(variables, coords=coordinates, attrs=description_of(plan)))
        processors = dict.fromkeys(chunk.processor for chunk in self._chunks.values() if chunk.processor)
        data.attrs["versions"] = data.attrs["versions"] | {"processors": list(processors)}
        return data
