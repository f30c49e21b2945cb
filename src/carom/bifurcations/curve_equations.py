"""What the equations of every bifurcation over a plane of two parameters have in common: how its curve is followed, and what is said of it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import ClassVar

import numpy as np

from carom.bifurcations.conditions import RESONANCES, TESTS
from carom.bifurcations.curve_results import Codimension2Point, Curve
from carom.bifurcations.planes import EDGE, Plane
from carom.continuation import Branch, Equations, Steps, Watch, continue_branch, refined_points
from carom.models import Rotor
from carom.orbits.names import CountedName, OrbitName
from carom.parameters import Numbers

Place = tuple[np.ndarray, float]
"""Unknowns, of which the last is the first parameter, and the second parameter."""
ROUNDING = 1e-6
"""Slack with which a bifurcation happens at a codimension-2 point."""


class CurveEquations(ABC):
    """The equations of a bifurcation, its unknowns at the start beside the first parameter, and what is watched along its curve."""

    usual_steps: ClassVar[Steps]
    bend: ClassVar[float]
    """Largest distance of the curve from the straight lines between its points, in widths of the plane."""
    slack: float = 0.0
    reach: Callable[[np.ndarray], float] | None = None
    kind: str
    plane: Plane
    base: Rotor | Numbers
    guess: Sequence[float] | np.ndarray
    watches: list[Watch]

    @abstractmethod
    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        """Left sides of the equations; ``nan`` where they are not defined."""

    @abstractmethod
    def orbit(self, u: np.ndarray, p: float) -> tuple[float, float]:
        """Period and radial speed; ``nan`` for equilibria."""

    @abstractmethod
    def happens(self, u: np.ndarray, p: float, slack: float) -> bool:
        """Whether it happens to a motion of the machine."""

    @abstractmethod
    def names(self, places: Sequence[Place]) -> tuple[OrbitName | CountedName, ...]:
        """Names of the orbits that bifurcate at places of the curve."""

    @abstractmethod
    def gives_up(self, reason: str, u: np.ndarray) -> str:
        """Why the continuation gave up, in terms of the motion."""

    def followed(self, steps: Steps | None) -> Curve:
        """The curve through the start, in both directions."""
        (first, second), sizes = self.plane.start_at(self.base)
        steps, known = steps or self.usual_steps, len(self.guess)
        equations = Equations(self.residual, None, np.array([*np.ones(known), *sizes]), steps)
        branch = continue_branch(
            equations,
            np.array([*self.guess, first]),
            float(second),
            self.plane.second_range,
            watches=[self.plane.edge, *self.watches],
            reach=self.reach,
            # A fold in the second parameter is only a turning point of the curve.
            folds="turning point",
        )
        shown = np.array([*np.full(known, np.inf), *self.plane.widths])
        rows = refined_points(equations, branch, widths=shown, bend=self.bend)
        return self._curve(branch, [(row[:-1], float(row[-1])) for row in rows], rows[:, -2:])

    def _curve(self, branch: Branch, places: Sequence[Place], points: np.ndarray) -> Curve:
        """The curve with what is known of its orbits."""
        periods, speeds = np.array([self.orbit(*place) for place in places]).T
        admissible = np.array([self.happens(*place, self.slack) for place in places])
        named = [place for place, is_real in zip(places, admissible, strict=True) if is_real or not admissible.any()]
        codimension2 = tuple(
            Codimension2Point(
                (point.kind,) if point.kind in RESONANCES else (self.kind, point.kind),
                (float(point.unknowns[-1]), point.parameter),
                *self.orbit(point.unknowns, point.parameter),
                self.happens(point.unknowns, point.parameter, ROUNDING),
            )
            for point in branch.special
            if point.kind in TESTS
        )
        stops = self._stop(branch, 0), self._stop(branch, -1)
        return Curve(self.kind, self.plane, points, periods, speeds, admissible, self.names(named), codimension2, stops)

    def _stop(self, branch: Branch, end: int) -> str:
        """Reason why the curve ends at its first or last point."""
        reason = branch.stops[end]
        if reason in ("end of domain", "step too small"):
            return self.gives_up(reason, branch.unknowns[end])
        return EDGE if reason == "parameter limit" else reason
