"""The equations of a branch in scaled unknowns ``x``, and Newton's method for a point of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from carom.continuation.branch import Steps

Function = Callable[[np.ndarray, float], np.ndarray]
Solver = Callable[[np.ndarray, float], np.ndarray | None]

DIFFERENCE = 6e-6
"""Step of central differences in scaled unknowns: the cube root of the rounding error."""
UPRIGHT = 0.2
"""Share of the parameter in the tangent above which points are sought at fixed parameter, if there is a solver for that."""


@dataclass(eq=False)
class Point:
    """A point of the branch, with Jacobian, tangent and watched values there."""

    x: np.ndarray
    jacobian: np.ndarray
    tangent: np.ndarray
    watched: np.ndarray = field(default_factory=lambda: np.empty(0))

    @cached_property
    def inverse(self) -> np.ndarray | None:
        """Inverse of the Jacobian bordered by the tangent."""
        return applied(np.linalg.inv, self.jacobian, self.tangent)


@dataclass(frozen=True, eq=False)
class Equations:
    """The equations of a branch, and how it is stepped along.

    Attributes
    ----------
    residual : callable
        ``F(u, p)`` with as many equations as unknowns; ``nan`` where it is not defined.
    slopes : callable, optional
        Exact derivatives of ``F`` by ``u`` and ``p``, shape (n, n + 1); ``nan`` where ``F`` is not defined.  By default
        central differences are taken.
    scales : ndarray, shape (n + 1,), or float
        Typical sizes of the unknowns and the parameter, in which arclength is measured.
    steps : Steps
    solver : callable, optional
        Of ``u`` and ``p``: the solution next to ``u`` at this parameter, or ``None``.  It is asked where the branch is not
        close to a fold, and saves evaluations where the equations at another parameter take long to set up.
    """

    residual: Function
    slopes: Function | None = None
    scales: np.ndarray | float = 1.0
    steps: Steps = field(default_factory=Steps)
    solver: Solver | None = None

    def plain(self, x: np.ndarray) -> tuple[np.ndarray, float]:
        """Unknowns and parameter without scaling."""
        y = x * self.scales
        return y[:-1], float(y[-1])

    def value(self, x: np.ndarray) -> np.ndarray:
        """Residual."""
        return np.asarray(self.residual(*self.plain(x)), float)

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """Derivatives in scaled unknowns, shape (n, n + 1)."""
        if self.slopes is not None:
            return np.asarray(self.slopes(*self.plain(x)), float) * self.scales
        changes = DIFFERENCE * np.eye(len(x))
        return np.array([self.value(x + change) - self.value(x - change) for change in changes]).T / (2.0 * DIFFERENCE)

    def correct(self, guess: np.ndarray, normal: np.ndarray, inverse: np.ndarray | None) -> np.ndarray | None:
        """Point of the branch in the hyperplane through ``guess``; ``None`` if the iteration does not converge.

        The inverse of a bordered Jacobian nearby is kept as long as the residual falls by a factor of 30 in each iteration.
        """
        x, previous, correction = guess, np.inf, np.inf
        right = np.empty(len(guess))
        for _ in range(self.steps.iterations):
            value = self.value(x)
            sizes = [abs(entry) for entry in value.tolist()]
            if not all(map(math.isfinite, sizes)):
                return None
            size = max(sizes)
            good = size <= self.steps.tolerance or correction <= self.steps.tolerance
            if size > previous / 30.0 and not good:
                inverse = self.inverse(x, normal)
            if inverse is None:
                return x if good else None
            right[:-1], right[-1] = -value, normal @ (guess - x)
            change = inverse @ right
            if good:
                return x if size > self.steps.tolerance else x + change
            x, previous, correction = x + change, size, max(map(abs, change.tolist()))
        return None

    def near(self, guess: np.ndarray, here: Point, fixed: bool = False) -> np.ndarray | None:
        """Point of the branch next to a guess ahead of a point: at the parameter of the guess, or in the normal hyperplane."""
        if self.solver is not None and (fixed or abs(here.tangent[-1]) >= UPRIGHT):
            found = self.solver(*self.plain(guess))
            if found is not None:
                return np.append((np.append(found, 0.0) / self.scales)[:-1], guess[-1])
        return self.correct(guess, here.tangent, here.inverse)

    def near_fold(self, guess: np.ndarray, here: Point) -> np.ndarray | None:
        """The same beside a fold, in the normal hyperplane: by Newton's method, for the direction of the branch has to be exact."""
        return self.correct(guess, here.tangent, self.inverse(guess, here.tangent))

    def inverse(self, x: np.ndarray, normal: np.ndarray) -> np.ndarray | None:
        """Inverse of the Jacobian at a point, bordered by a normal."""
        return applied(np.linalg.inv, self.jacobian(x), normal)

    def tangent(self, jacobian: np.ndarray, along: np.ndarray) -> np.ndarray | None:
        """Unit tangent on the side of ``along``."""
        ahead = np.zeros(len(along))
        ahead[-1] = 1.0
        direction = applied(np.linalg.solve, jacobian, along, ahead)
        return None if direction is None else direction / math.sqrt(direction @ direction)


def applied(
    method: Callable[..., np.ndarray], jacobian: np.ndarray, normal: np.ndarray, *right: np.ndarray
) -> np.ndarray | None:
    """Solution or inverse of the bordered Jacobian; ``None`` if it is singular."""
    try:
        found = method(bordered(jacobian, normal), *right)
    except np.linalg.LinAlgError:
        return None
    return found if all(map(math.isfinite, found.ravel().tolist())) else None


def bordered(jacobian: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """The Jacobian with one more row."""
    matrix = np.empty((len(normal), len(normal)))
    matrix[:-1], matrix[-1] = jacobian, normal
    return matrix
