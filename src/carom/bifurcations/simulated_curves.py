"""Folds, period doublings and Neimark–Sacker bifurcations of the periodic motions of any machine, over a plane of two parameters.

The equations are those of the closed path and the function that vanishes at the bifurcation; all derivatives are differences.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from carom.base.outcome import InputError
from carom.bifurcations.curve_equations import CurveEquations, Place
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.simulated import MOST_NUMBERS, begun_at_least_radius
from carom.bifurcations.simulated_family import Place as Values
from carom.bifurcations.simulated_family import SimulatedFamily
from carom.continuation import Steps, Watch
from carom.orbits.flow import Flow, FlowBudget
from carom.orbits.names import CountedName
from carom.orbits.simulated import SimulatedOrbit

KINDS = ("fold", "period-doubling", "neimark-sacker")


class SimulatedCurve(CurveEquations):
    """The equations of one of these bifurcations."""

    bend = np.inf
    usual_steps = Steps(
        first=0.02, largest=0.2, smallest=1e-3, sharpest_turn=0.4, most_points=80, tolerance=1e-7, resolution=1e-8
    )

    def __init__(self, point: Bifurcation, plane: Plane, budget: FlowBudget | None) -> None:
        if point.kind not in KINDS:
            raise InputError("kind", point.kind, f"one of: {', '.join(KINDS)}")
        orbit: SimulatedOrbit = point.shot
        numbers = len(Flow.vector(orbit.start))
        if numbers > MOST_NUMBERS:
            allowed = f"one of a rotor with at most {MOST_NUMBERS}"
            raise InputError("bifurcation", f"{numbers} numbers of a state", allowed)
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
    def _over_plane(test: Callable[[np.ndarray, Values], float]) -> Callable[[np.ndarray, float], float]:
        """A test of a family as a function of the unknowns of a curve and the second parameter."""
        return lambda u, p: test(u[:-1], (float(u[-1]), p))

    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        """Left sides of the equations; ``nan`` where they are not defined."""
        unknowns, place = u[:-1], (float(u[-1]), p)
        closing = self.family.residual(unknowns, place)
        return np.append(closing, self.test(unknowns, place) if np.isfinite(closing).all() else np.nan)

    def _moved(self, u: np.ndarray, p: float) -> SimulatedOrbit:
        """The orbit at a place of the curve."""
        place = float(u[-1]), p
        flow = self.family.flow(place)
        if flow is None:
            raise RuntimeError("a curve is followed where there is a rotor")
        return self.family.orbit.moved(flow, *self.family.split(u[:-1]), np.empty(0), self.name)

    def orbit(self, u: np.ndarray, p: float) -> tuple[float, float]:
        """Period and radial speed."""
        orbit = self._moved(u, p)
        return orbit.period, orbit.radial_speed

    def happens(self, u: np.ndarray, p: float, slack: float) -> bool:
        """All are motions of the machine."""
        return True

    def names(self, places: Sequence[Place]) -> tuple[CountedName, ...]:
        """Name of the orbit that was followed."""
        return (self.name,)

    def gives_up(self, reason: str, u: np.ndarray) -> str:
        """Why the continuation gave up: its budget may be spent."""
        return "more would take too long" if self.family.budget.spent else reason
