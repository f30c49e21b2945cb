"""Folds, period doublings and Neimark–Sacker bifurcations of the periodic motions of any machine, over a plane of two parameters.

The equations are those of the closed path and the function that vanishes at the bifurcation; all derivatives are differences.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from carom.base.outcome import InputError
from carom.bifurcations.curve_results import Codimension2Point, Curve
from carom.bifurcations.planes import EDGE, Plane
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.simulated import MOST_NUMBERS, begun_at_least_radius
from carom.bifurcations.simulated_family import Place, SimulatedFamily
from carom.continuation import Branch, Steps, Watch
from carom.orbits.flow import Flow, FlowBudget

STEPS = Steps(
    first=0.02, largest=0.2, smallest=1e-3, sharpest_turn=0.4, most_points=80, tolerance=1e-7, resolution=1e-8
)
KINDS = ("fold", "period-doubling", "neimark-sacker")


class SimulatedCurve:
    """The equations of one of these bifurcations, its unknowns at the start, and what is watched along its curve."""

    bend = np.inf
    steps = STEPS
    reach = None

    def __init__(self, point: Bifurcation, plane: Plane, budget: FlowBudget | None) -> None:
        if point.kind not in KINDS:
            raise InputError("kind", point.kind, f"one of: {', '.join(KINDS)}")
        orbit: Any = point.orbit
        numbers = len(Flow.vector(orbit.start))
        if numbers > MOST_NUMBERS:
            raise InputError(
                "bifurcation", f"{numbers} numbers of a state", f"one of a rotor with at most {MOST_NUMBERS}"
            )
        self.kind, self.plane, self.name = point.kind, plane, orbit.name
        begun = begun_at_least_radius(orbit) if orbit.repeats is None else orbit
        self.family = SimulatedFamily(begun, plane, plane.second_range, budget or FlowBudget())
        plane.axes(orbit.rotor)
        self.base, vector = orbit.rotor, Flow.vector(begun.start)
        self.guess = np.append(vector, begun.period) if self.family.free else vector
        tests = {"fold": self.family.fold, "period-doubling": self.family.doubling, "neimark-sacker": self.family.torus}
        self.test = tests.pop(self.kind)
        others = () if self.kind == "neimark-sacker" else tuple(name for name in tests if name != "neimark-sacker")
        self.watches = [Watch(name, self._over_plane(tests[name])) for name in others]

    @staticmethod
    def _over_plane(test: Callable[[np.ndarray, Place], float]) -> Callable[[np.ndarray, float], float]:
        """A test of a family as a function of the unknowns of a curve and the second parameter."""
        return lambda u, p: test(u[:-1], (float(u[-1]), p))

    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        """Left sides of the equations; ``nan`` where they are not defined."""
        unknowns, place = u[:-1], (float(u[-1]), p)
        closing = self.family.residual(unknowns, place)
        return np.append(closing, self.test(unknowns, place) if np.isfinite(closing).all() else np.nan)

    def curve(self, branch: Branch, rows: np.ndarray) -> Curve:
        """The curve with the period and speed of its orbits."""
        orbits = [self._orbit(row) for row in rows]
        return Curve(
            kind=self.kind,
            plane=self.plane,
            points=rows[:, -2:],
            periods=np.array([orbit.period for orbit in orbits]),
            radial_speeds=np.array([orbit.radial_speed for orbit in orbits]),
            admissible=np.ones(len(rows), bool),
            orbits=(self.name,),
            codimension2=tuple(
                Codimension2Point(
                    (self.kind, point.kind),
                    (float(point.unknowns[-1]), point.parameter),
                    *self._speeds(np.append(point.unknowns, point.parameter)),
                    True,
                )
                for point in branch.special
                if point.kind in KINDS
            ),
            stops=(self._stop(branch.stops[0]), self._stop(branch.stops[1])),
        )

    def _orbit(self, row: np.ndarray) -> Any:
        place = float(row[-2]), float(row[-1])
        vector, period = self.family.split(row[:-2])
        flow: Any = self.family.flow(place)
        return self.family.orbit.moved(flow, vector, period, np.empty(0), self.name)

    def _speeds(self, row: np.ndarray) -> tuple[float, float]:
        orbit = self._orbit(row)
        return orbit.period, orbit.radial_speed

    def _stop(self, reason: str) -> str:
        if self.family.budget.spent and reason in ("end of domain", "step too small"):
            return "more would take too long"
        return EDGE if reason == "parameter limit" else reason
