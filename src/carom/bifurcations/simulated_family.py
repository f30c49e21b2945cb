"""The equations of a periodic motion of any machine along a parameter or over a plane of two, and what vanishes at its special points.

A period of any length begins where the radius is least; one of whole turns at its instant.
"""

from __future__ import annotations

from functools import cache, cached_property, lru_cache
from itertools import combinations
from typing import Any

import numpy as np

from carom.base.outcome import InputError
from carom.continuation import Watch
from carom.motions.trajectories import Trajectory
from carom.orbits.closing import multipliers_from
from carom.orbits.flow import Flow, FlowBudget
from carom.orbits.names import CountedName
from carom.orbits.simulated import SimulatedOrbit

DIFFERENCE = 1e-6
"""Step of the differences by the parameter, relative to its size."""
REMEMBERED = 64
"""Motions that are kept: each is asked for by the equations, their derivatives and all watches."""
LEADING = 0.2
"""Size of the multipliers that are watched in pairs."""


Place = float | tuple[float, float]
"""Value of the parameter, or of both parameters of a plane."""


class SimulatedFamily:
    """The equations of a periodic motion in the numbers of its state and, where it is free, its period; ``along`` is an axis or a plane."""

    def __init__(self, orbit: SimulatedOrbit, along: Any, limits: tuple[float, float], budget: FlowBudget) -> None:
        self.budget = budget
        self.orbit, self.along, self.limits = orbit, along, limits
        self.free, self.plane = orbit.repeats is None, orbit.leading_plane
        self.flow = lru_cache(REMEMBERED)(self._flow)
        self._known = lru_cache(REMEMBERED)(self._followed)
        # Of every point of a branch: its orbits ask for them again.
        self._slopes = cache(self._derived)

    @cached_property
    def size(self) -> float:
        """Typical size of the parameter."""
        return max(abs(self.along.value(self.orbit.rotor)), 0.1 * (self.limits[1] - self.limits[0]))

    def _flow(self, p: Place) -> Flow | None:
        """The flow at a place; ``None`` where there is no such rotor."""
        try:
            rotor = self.along.move(self.orbit.rotor, p)
        except InputError:
            return None
        return Flow(rotor, self.orbit.start.time, self.orbit.rests, self.budget)

    def split(self, u: np.ndarray) -> tuple[np.ndarray, float]:
        """State and period of the unknowns."""
        return (u[:-1], float(u[-1])) if self.free else (u, self.orbit.period)

    def motion(self, u: np.ndarray, p: Place) -> Trajectory | None:
        """One period from the unknowns."""
        return self._known(u.tobytes(), p)

    def _followed(self, unknowns: bytes, p: Place) -> Trajectory | None:
        flow, (vector, period) = self.flow(p), self.split(np.frombuffer(unknowns))
        return None if flow is None or period <= 0.0 else flow.follow(vector, period)

    def residual(self, u: np.ndarray, p: Place) -> np.ndarray:
        """How far the end is from the start, and the radial speed there if the period is free."""
        motion, flow = self.motion(u, p), self.flow(p)
        if motion is None or flow is None:
            return np.full(len(u), np.nan)
        vector, _ = self.split(u)
        apart = flow.vector(motion.final) - vector
        return np.append(apart, self._radial(flow, vector)) if self.free else apart

    def _radial(self, flow: Flow, vector: np.ndarray) -> float:
        system, state = flow.rotor.system, flow.state(vector)
        amplitudes = system.amplitudes(state.position, state.velocity, flow.begins)
        place, moving = system.at_plane(amplitudes, self.plane)
        return float((np.conj(place) * moving).real)

    def flow_slopes(self, u: np.ndarray, p: Place) -> np.ndarray:
        """Derivative of the end of the period by its start."""
        return self._slopes(u.tobytes(), p)

    def _derived(self, unknowns: bytes, p: Place) -> np.ndarray:
        u = np.frombuffer(unknowns)
        motion, flow, (vector, _) = self.motion(u, p), self.flow(p), self.split(u)
        return (
            np.full((len(vector),) * 2, np.nan) if motion is None or flow is None else flow.derivative(vector, motion)
        )

    def jacobian(self, u: np.ndarray, p: float) -> np.ndarray:
        """Derivatives of the residual by the unknowns and the parameter."""
        flow, (vector, period), n = self.flow(p), self.split(u), len(u)
        slopes = np.zeros((n, n + 1))
        if flow is None:
            return np.full((n, n + 1), np.nan)
        m = len(vector)
        slopes[:m, :m] = self.flow_slopes(u, p) - np.eye(m)
        if self.free:
            slopes[:m, m] = flow.rate(vector, period)
            sides = DIFFERENCE * np.eye(m)
            slopes[m, :m] = [
                (self._radial(flow, vector + side) - self._radial(flow, vector - side)) / (2.0 * DIFFERENCE)
                for side in sides
            ]
        step = DIFFERENCE * self.size
        low, high = max(p - step, self.limits[0]), min(p + step, self.limits[1])
        slopes[:, -1] = (self.residual(u, high) - self.residual(u, low)) / (high - low)
        return slopes

    def multipliers(self, u: np.ndarray, p: Place) -> np.ndarray:
        """Non-trivial multipliers; ``nan`` where they are not defined."""
        slopes = self.flow_slopes(u, p)
        if not np.isfinite(slopes).all():
            return np.full(len(slopes) - int(self.free), np.nan, complex)
        return multipliers_from(slopes, free=self.free)

    def fold(self, u: np.ndarray, p: Place) -> float:
        """Product of ``1 − μ`` over the non-trivial multipliers ``μ``, which vanishes at a fold, without computing any of them."""
        apart = np.eye(len(self.split(u)[0])) - self.flow_slopes(u, p)
        if not self.free:
            return float(np.linalg.det(apart))
        minors = (np.delete(np.delete(apart, i, 0), i, 1) for i in range(len(apart)))
        return float(sum(map(np.linalg.det, minors)))

    def doubling(self, u: np.ndarray, p: Place) -> float:
        """Product of ``1 + μ``, which vanishes at a period doubling."""
        return float(np.prod(1.0 + self.multipliers(u, p)).real)

    def torus(self, u: np.ndarray, p: Place) -> float:
        """Product of ``μν − 1`` over the pairs of multipliers that are not small, which vanishes at a Neimark–Sacker bifurcation."""
        leading = [each for each in self.multipliers(u, p).tolist() if not abs(each) < LEADING]
        return float(np.prod([first * second - 1.0 for first, second in combinations(leading, 2)]).real)

    def watches(self) -> list[Watch]:
        """Functions that vanish at period doublings and Neimark–Sacker bifurcations."""
        return [Watch("period-doubling", self.doubling), Watch("neimark-sacker", self.torus)]

    def orbit_at(self, u: np.ndarray, p: Place, name: CountedName) -> SimulatedOrbit | None:
        """The orbit of the unknowns."""
        flow, (vector, period) = self.flow(p), self.split(u)
        values = self.multipliers(u, p)
        if flow is None or not np.isfinite(values).all():
            return None
        return self.orbit.moved(flow, vector, period, values, name)
