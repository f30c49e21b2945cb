"""Lyapunov exponents of a motion of any machine, by the derivatives of the flow that the simulator follows."""

from __future__ import annotations

import math

import numpy as np

from carom.base.outcome import CaromError, Phase
from carom.models import Rotor
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.flow import Flow, FlowBudget
from carom.orbits.happenings import happenings

STRETCH = 2.0
"""Time of a stretch, in ``1/Ω``, after which directions are made orthogonal."""
NOTHING = 1e-7
"""Factor in a stretch below which a direction is taken away: it is the error of the derivatives."""
EVENTS = 7e6
"""Events (:class:`~carom.orbits.flow.FlowBudget`) after which no further stretch is measured."""
MOST = 100_000
WALL_DISTANCE, CUTS = 1e-3, 41
"""Distance from a rigid wall, in clearances, that is next to it, and times tried at which a stretch may end."""


class Grown:
    """What the stretches of a motion say: logarithms of the growth of each direction, durations, impacts and landings.

    Attributes
    ----------
    logarithms : ndarray, shape (m, n)
    durations : ndarray, shape (m,)
    impacts, landings : int
    along : float
        Logarithm of the growth of a delay, over all of them; 0 where something stands in the fixed frame.
    """

    def __init__(self, rotor: Rotor, state: State, impacts: int, transient: int) -> None:
        self.rotor, self.budget = rotor, FlowBudget(EVENTS / 4)
        motion = simulate(rotor, state, 0.5 * STRETCH, settle=False)
        self.flow, self.vector = Flow.at(motion, _cut(motion), self.budget)
        self.directions = np.linalg.qr(np.random.default_rng(0).normal(size=(len(self.vector),) * 2))[0]
        self._measure(transient)
        self.budget.left = EVENTS  # a long transient must leave something to be measured
        before = self._speed()
        self.durations, self.logarithms, (self.impacts, self.landings) = self._measure(impacts)
        self.along = 0.0 if rotor.system.is_time_dependent else math.log(self._speed() / before)

    def _speed(self) -> float:
        return float(np.linalg.norm(self.flow.rate(self.vector, 0.0)))

    def _measure(self, impacts: int) -> tuple[np.ndarray, np.ndarray, tuple[int, int]]:
        """Follow the motion for a number of impacts and landings, or as long as there is time."""
        found: list[np.ndarray] = []
        durations: list[float] = []
        impacts_seen = landed = 0
        while impacts_seen + landed < impacts and len(found) < MOST and not self.budget.spent:
            motion = self.flow.follow(self.vector, STRETCH)
            if motion is not None and (length := _cut(motion)) < STRETCH:
                motion = self.flow.follow(self.vector, length)
            if motion is None:
                raise CaromError("the motion goes beyond the model: it has no exponents")
            happened = happenings(motion)
            if not happened and not impacts_seen + landed and len(found) > 50:
                raise CaromError("the motion stops hitting the wall: it has no exponents of impacts")
            slopes = self.flow.derivative(self.vector, motion)
            if not np.isfinite(slopes).all():
                raise CaromError("no exponents: a motion that starts next to this one leaves the range of the model")
            self.directions, triangle = np.linalg.qr(slopes @ self.directions)
            found.append(np.log(np.maximum(np.abs(np.diag(triangle)), NOTHING)))
            durations.append(motion.time)
            impacts_seen += sum(each.begins_contact for each in happened)
            landed += sum(each.label == "land" for each in happened)
            self.flow, self.vector = Flow.at(motion, motion.time, self.budget)
        return np.array(durations), np.array(found).reshape(len(found), -1), (impacts_seen, landed)


def _cut(motion: Trajectory) -> float:
    """Time near the end of a stretch at which no plane flies next to a rigid wall, beyond which no motion beside it could begin."""
    system = motion.rotor.system
    times = motion.time * np.linspace(1.0, 0.5, CUTS)
    amplitudes, phases = motion.amplitudes_at(times)
    radii = np.array(
        [[abs(system.at_plane(each, plane)[0]) for plane in range(phases.shape[1])] for each in amplitudes]
    )
    beside = (phases == Phase.FLIGHT) & (system.arrays["stiffness"] == 0.0) & (radii > 1.0 - WALL_DISTANCE)
    clear = np.flatnonzero(~beside.any(axis=1))
    return float(times[clear[0]]) if len(clear) else motion.time
