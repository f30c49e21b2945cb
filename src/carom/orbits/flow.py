"""The flow of any machine over a time, as a map of real numbers: where a simulated motion ends, and how that depends on its start.

A state is its coordinates and their rates, real parts before imaginary parts, and the speeds of races that turn.  Derivatives through flights and
impacts on rigid walls are exact, by the saltation matrix of each impact.  All others (lasting contact, compliant bearings, several
bearings with impacts in one instant, limits) are central differences of the certified flow, of which the motion between tells whether they are one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from carom.base.outcome import CaromError, Outcome, Phase
from carom.core.limits import LOWER, UPPER
from carom.core.rub import rest_on_wall
from carom.core.variation import carry_through_impacts
from carom.models import Rotor
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory

STEPS = (3e-6, 1e-6, 1e-7, 1e-8, 1e-9)
"""Steps of the central differences, relative to one plus the size of the state: the first that is short enough."""
BEND = 3e-3
"""Largest difference of the derivatives to both sides, relative to the larger of the derivative and one; the error of their mean is some square of it."""
ALONE = 1e-9
"""Distance, relative to one plus the size of the amplitudes, of the state after an impact from that of an impact on one bearing alone."""
MOST_EVENTS = 40_000
"""Events of a period."""
TURN, QUARTER = 2.0 * math.pi, 0.5 * math.pi
BEGINNING, MODES = 250, 16
"""Events that the beginning of a motion counts for, and modes with which each event counts twice."""


@dataclass(eq=False)
class FlowBudget:
    """Events that motions may take: what a search finds must not depend on how fast a computer is.

    Attributes
    ----------
    left : float
        Events that are left; below zero they are spent.
    binding : bool
        Whether no motion of a flow is followed any more once they are spent.
    """

    left: float = math.inf
    binding: bool = False

    @property
    def spent(self) -> bool:
        """Whether nothing is left."""
        return self.left <= 0.0

    def pay(self, motion: Trajectory) -> Trajectory:
        """Take off what a motion has cost."""
        self.left -= (BEGINNING + len(motion.event_planes)) * (1.0 + motion.rotor.system.modes / MODES)
        return motion


@dataclass(frozen=True)
class Flow:
    """The flow of a rotor from a time on.

    Attributes
    ----------
    rotor : Rotor
    begins : float
        Time at which motions begin, in ``1/Ω``.
    rests : tuple of (int, bool)
        Contact planes that lie on rigid walls at the beginning, and whether they roll: states are put there before they are followed.
    budget : FlowBudget
        What the motions are paid from; unlimited by default.
    """

    rotor: Rotor
    begins: float = 0.0
    rests: tuple[tuple[int, bool], ...] = ()
    budget: FlowBudget = field(default_factory=FlowBudget, compare=False, repr=False)

    @classmethod
    def at(cls, motion: Trajectory, time: float, budget: FlowBudget | None = None) -> tuple[Flow, np.ndarray]:
        """The flow from an instant of a motion, and the state there."""
        system = motion.rotor.system
        amplitudes, phases = (found[0] for found in motion.amplitudes_at(np.array([time])))
        rigid = (phases != Phase.FLIGHT) & (system.arrays["stiffness"] == 0.0)
        rests = tuple((int(plane), bool(phases[plane] == Phase.ROLLING)) for plane in np.flatnonzero(rigid))
        begins = motion.begins + time if system.is_time_dependent else 0.0
        flow = cls(motion.rotor, begins, rests, budget or FlowBudget())
        position, velocity = system.state(amplitudes)
        return flow, flow.vector(State.of(position, velocity, system.race_speeds(amplitudes)))

    @staticmethod
    def vector(state: State) -> np.ndarray:
        """Real numbers of a state."""
        values = np.concatenate([np.atleast_1d(state.position), np.atleast_1d(state.velocity)])
        return np.concatenate([values.real, values.imag, state.races])

    def state(self, vector: np.ndarray) -> State:
        """State of real numbers, on the walls where it begins there."""
        system = self.rotor.system
        n = len(system.rest)
        values = vector[: 2 * n] + 1j * vector[2 * n : 4 * n]
        position, velocity = values[:n], values[n:]
        if self.rests:
            amplitudes = system.amplitudes(position, velocity, self.begins)
            for plane, rolls in self.rests:
                rest_on_wall(system.arrays, plane, amplitudes, rolls)
            position, velocity = (np.atleast_1d(each) for each in system.state(amplitudes))
        races = tuple(vector[4 * n :].tolist())
        if n == 1:
            return State(complex(position[0]), complex(velocity[0]), races, time=self.begins)
        return State(position, velocity, races, time=self.begins)

    def follow(self, vector: np.ndarray, duration: float) -> Trajectory | None:
        """Motion from a state; ``None`` if it goes beyond the model, or has too many events."""
        if self.budget.binding and self.budget.spent:
            return None
        try:
            motion = simulate(self.rotor, self.state(vector), duration, settle=False, max_events=MOST_EVENTS)
        except CaromError:
            return None
        return self.budget.pay(motion) if motion.outcome is Outcome.TIME_REACHED else None

    def end(self, vector: np.ndarray, duration: float) -> np.ndarray:
        """State after a time; ``nan`` where the motion is not known."""
        motion = self.follow(vector, duration)
        return np.full(len(vector), np.nan) if motion is None else self.vector(motion.final)

    def change(self, vector: np.ndarray, direction: np.ndarray, motion: Trajectory) -> np.ndarray:
        """Derivative of the end of a motion by its start along a direction, by differences; ``nan`` where it has none."""
        size, longest = 1.0 + float(np.abs(vector).max()), float(np.abs(direction).max())
        end = self.vector(motion.final)
        for step in STEPS:
            share = step * size / longest
            first, last = (self.end(vector + sign * share * direction, motion.time) - end for sign in (1.0, -1.0))
            if float(np.abs(first + last).max()) <= BEND * max(float(np.abs(first - last).max()), 2.0 * step * size):
                return (first - last) / (2.0 * share)
        return np.full(len(vector), np.nan)

    def derivative(self, vector: np.ndarray, motion: Trajectory) -> np.ndarray:
        """Derivative of the end of a motion by its start, shape (n, n)."""
        exact = self._through_impacts(vector, motion)
        if exact is not None:
            return exact
        return np.array([self.change(vector, direction, motion) for direction in np.eye(len(vector))]).T

    def _through_impacts(self, vector: np.ndarray, motion: Trajectory) -> np.ndarray | None:
        """The exact derivative of a motion of flights and impacts on rigid walls, each on one of them; ``None`` of another."""
        system = motion.rotor.system
        if system.is_anisotropic or system.races is not None or system.shaft is not None or saturates(motion):
            return None
        if (motion.segment_phases != Phase.FLIGHT).any():
            return None
        planes, after = np.where(motion.is_impact, motion.event_planes, -1), motion.segment_amplitudes[1:]
        start = self.amplitudes(vector)
        directions = np.array([self.amplitudes(vector + each) - start for each in np.eye(len(vector))])
        apart = carry_through_impacts(
            system.arrays, planes, motion.event_amplitudes, after, motion.durations, directions
        )
        if apart > ALONE * (1.0 + float(np.abs(after).max(initial=0.0))):
            return None
        rest = self.vector(State.of(*system.state(np.zeros(system.modes, complex))))
        return np.array([self.vector(State.of(*system.state(each))) - rest for each in directions]).T

    def amplitudes(self, vector: np.ndarray) -> np.ndarray:
        """Mode amplitudes of a state."""
        state = self.state(vector)
        return self.rotor.system.amplitudes(state.position, state.velocity, self.begins)

    def rate(self, vector: np.ndarray, duration: float) -> np.ndarray:
        """Rate of change of the end with the time that is followed."""
        step = STEPS[0] * max(1.0, duration)
        motion = self.follow(vector, duration + step)
        if motion is None:
            return np.full(len(vector), np.nan)
        before = duration if duration < step else duration - step
        system, times = self.rotor.system, np.array([before, duration + step])
        amplitudes, _ = motion.amplitudes_at(times)
        ends = [self.vector(State.of(*system.state(each), system.race_speeds(each))) for each in amplitudes]
        return (ends[1] - ends[0]) / float(np.ptp(times))


def saturates(motion: Trajectory) -> bool:
    """Whether a magnetic bearing is at a limit at some time of a motion."""
    return bool(np.isin(motion.segment_limits, (UPPER, LOWER)).any())


def repeats_after(motion: Trajectory) -> float | None:
    """Time of which the period of a motion is a multiple, in ``1/Ω``; ``None`` where it can have any.

    Whole turns of the shaft where something stands in the fixed frame; quarters of a turn where only saturation does, as limits are alike along
    both axes.
    """
    system = motion.rotor.system
    if system.outer.any() or system.is_anisotropic:
        return TURN
    return QUARTER if saturates(motion) else None


def krylov(apply: Callable[[np.ndarray], np.ndarray], start: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Arnoldi's basis (n, k) of the space that a linear map spans from a start, and the map in it, shape (k + 1, k)."""
    basis = [start / np.linalg.norm(start)]
    columns: list[np.ndarray] = []
    for _ in range(min(size, len(start))):
        moved = apply(basis[-1])
        column = np.zeros(len(basis) + 1)
        for _ in range(2):
            for place, each in enumerate(basis):
                part = float(each @ moved)
                column[place] += part
                moved = moved - part * each
        column[-1] = np.linalg.norm(moved)
        columns.append(column)
        if not column[-1] > KRYLOV_END * np.linalg.norm(column):
            break
        basis.append(moved / column[-1])
    known = len(columns)
    matrix = np.zeros((known + 1, known))
    for place, column in enumerate(columns):
        matrix[: len(column), place] = column
    return np.array(basis[:known]).T, matrix


KRYLOV_END = 1e-7
"""Part of a new direction, relative to the whole, below which it is the error of the differences."""
