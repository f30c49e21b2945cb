"""Branches of solutions: step control, watched functions, and results."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.base.results import Result


@dataclass(frozen=True)
class Steps:
    """How to step along a branch, in units of the scaled unknowns.

    Attributes
    ----------
    first, smallest, largest : float
        Arclength of the first step, and limits of all steps.  Neighbouring points are at most 1.05 ``largest`` apart.
    tolerance : float
        Largest residual of an accepted point, or largest last correction where rounding leaves a larger residual.
    iterations : int
        Newton iterations without convergence after which a step is halved.
    sharpest_turn : float
        Largest angle between tangents of neighbouring points, in rad.
    most_points : int
        Number of points after which a direction is abandoned.
    resolution : float
        Arclength within which special points are located.
    """

    first: float = 0.01
    smallest: float = 1e-8
    largest: float = 0.05
    tolerance: float = 1e-12
    iterations: int = 8
    sharpest_turn: float = 0.2
    most_points: int = 5000
    resolution: float = 1e-14


@dataclass(frozen=True)
class Watch:
    """A function whose zeros on the branch are special points.

    Attributes
    ----------
    kind : str
        Name of the special point.
    function : callable
        Of ``u`` and ``p``; ``nan`` where it is not defined.  A jump from one sign to the other is not a zero.
    at_zero : {"pass", "end", "limit", "avoid"}
        Whether the branch goes on there or ends.  At a limit, too, it ends: it is followed only where the function is not
        negative, and ends at once if it begins on a zero and leaves.  What is to be avoided is another branch that crosses
        this one: a step to where the function is not positive is too long.
    """

    kind: str
    function: Callable[[np.ndarray, float], float]
    at_zero: Literal["pass", "end", "limit", "avoid"] = "pass"


@dataclass(frozen=True, eq=False, repr=False)
class SpecialPoint(Result):
    """A located zero of a watched function.

    Attributes
    ----------
    kind : str
    unknowns : ndarray, shape (n,)
    parameter : float
    place : float
        Position on the branch: index of the point before it plus the fraction of the step.
    """

    kind: str
    unknowns: np.ndarray
    parameter: float
    place: float


@dataclass(frozen=True, eq=False, repr=False)
class Branch(Result):
    """A curve of solutions in the order of arclength.

    Attributes
    ----------
    unknowns : ndarray, shape (m, n)
    parameters : ndarray, shape (m,)
    special : tuple of SpecialPoint
        In the order of ``place``.
    stops : tuple of two str
        Why the branch ends at its first and last point: ``"parameter limit"`` (the point lies on it exactly), the kind of
        the watch that ended it, ``"end of domain"`` (the equations are not defined beyond), ``"closed loop"`` (the last
        point is the first), ``"step too small"`` or ``"most points"``.
    """

    unknowns: np.ndarray
    parameters: np.ndarray
    special: tuple[SpecialPoint, ...]
    stops: tuple[str, str]

    def __len__(self) -> int:
        return len(self.parameters)

    def of_kind(self, kind: str) -> tuple[SpecialPoint, ...]:
        """Special points of one kind."""
        return tuple(point for point in self.special if point.kind == kind)
