"""One chunk of a sweep: computed from its number alone, so that its arrays are the same on every worker and in every run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.base.outcome import CaromError
from carom.base.results import Result
from carom.sweeps.plan import SweepPlan
from carom.sweeps.variables import Status

_LONGEST_MESSAGE = 500
MOST_FAILURES = 20
"""Largest number of failed points that results list."""


@dataclass(frozen=True, eq=False, repr=False)
class Chunk(Result):
    """The results at the points of a chunk."""

    number: int
    arrays: dict[str, np.ndarray]
    """One for each variable, and ``status``.  Shape: that of the chunk, followed by the variable's own dimension."""
    failures: list[dict[str, object]]
    """Of each point that could not be computed its index in the grid, the values of the parameters that vary, and the error, on one line."""


def compute_chunk(plan: SweepPlan, number: int) -> Chunk:
    """Compute all points of a chunk; a point that fails is recorded, and the others are still computed.

    The chunk depends on the plan and its number, from 0 to ``plan.chunks - 1``, alone, bit for bit.
    """
    arrays = _empty(plan, number)
    corner = tuple(part.start for part in plan.region(number))
    failures = []
    for point in plan.points_of(number):
        place = tuple(at - start for at, start in zip(point, corner, strict=True))
        try:
            found = plan.task.evaluate(plan.case_at(point), plan.seed_of(point))
        except Exception as problem:  # noqa: BLE001  (any error is recorded, and the sweep continues)
            arrays["status"][place] = Status.FAILED
            words = str(problem) if isinstance(problem, CaromError) else f"{type(problem).__name__}: {problem}"
            line = " ".join(words.split())[:_LONGEST_MESSAGE]
            failures.append(_failure(plan, point, line))
            continue
        for name, value in found.items():
            arrays[name][place] = value
        arrays["status"][place] = Status.DONE
    return Chunk(number, arrays, failures)


def failed_chunk(plan: SweepPlan, number: int, error: str) -> Chunk:
    """Return a chunk whose points all failed with the same error, because its worker was lost."""
    arrays = _empty(plan, number)
    arrays["status"][...] = Status.FAILED
    return Chunk(number, arrays, [_failure(plan, point, error) for point in plan.points_of(number)])


def _failure(plan: SweepPlan, point: tuple[int, ...], error: str) -> dict[str, object]:
    return {"point": list(point), "values": plan.values(point), "error": error}


def _empty(plan: SweepPlan, number: int) -> dict[str, np.ndarray]:
    shape = tuple(part.stop - part.start for part in plan.region(number))
    return {
        variable.name: np.full(shape + variable.shape, variable.fill, variable.dtype) for variable in plan.variables
    }
