"""The motion over a stretch of a record, from an unknown state in the fixed frame: what the sensors see of it, and where it ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from carom.base.outcome import CaromError, Outcome
from carom.core.flow import fly_all
from carom.fitting.records import Record
from carom.models import Rotor
from carom.motions.simulation import simulate
from carom.motions.starts import State

STEPS = (1e-5, 1e-7)
"""Steps of the central differences, relative to one: the first over which the events stay the same."""
MOST_EVENTS = 20_000
ON_WALL = 1.0 - 1e-9
"""Place in clearances of a state that would lie beyond a rigid wall."""
THIRDS = (0.0, 2.0 * np.pi / 3.0, 4.0 * np.pi / 3.0)
"""Angles of the shaft at which flights from rest are followed."""


@dataclass(frozen=True)
class StretchMotion:
    """What the sensors see of a motion, shape (m, c), in m; where it ends, as real numbers; its events, by their bearings; and how many contacts there are."""

    seen: np.ndarray
    end: np.ndarray
    events: tuple[int, ...]
    contacts: int

    @property
    def together(self) -> np.ndarray:
        """All its numbers."""
        return np.concatenate([self.seen.ravel(), self.end])


@dataclass(frozen=True, eq=False)
class Observed:
    """A rotor as sensors see it.

    States are real numbers: coordinates in the fixed frame and their rates, real parts before imaginary parts, in the clearance and
    speed of ``unit``, and the speeds of races that turn.

    Attributes
    ----------
    rotor : Rotor
    record : Record
    angle : float
        Angle by which the shaft has turned at the time zero of the record, rad.
    unit : tuple of float
        Length in m and speed in rad/s in which states are given.
    """

    rotor: Rotor
    record: Record
    angle: float
    unit: tuple[float, float]

    @cached_property
    def rows(self) -> np.ndarray:
        """Displacement of the sensors in m per coordinate in the fixed frame: their real parts are what is seen, shape (c, n)."""
        return np.array([each.row(self.rotor) * np.exp(-1j * each.direction) for each in self.record.channels])

    @property
    def places(self) -> int:
        """How many coordinates there are."""
        return len(self.rotor.system.rest)

    def radius(self, numbers: np.ndarray, sample: int) -> float:
        """Largest displacement at a rigid touchdown bearing, in its clearance, in a state at a sample; 0 without one."""
        system, start = self.rotor.system, self.state(numbers, float(self.record.times[sample]))
        amplitudes = system.amplitudes(start.position, start.velocity, start.time)
        displaced = np.abs(system.arrays["rows"] @ amplitudes + system.arrays["offsets"])
        return float(displaced[system.arrays["stiffness"] == 0.0].max(initial=0.0))

    @property
    def states(self) -> int:
        """How many numbers a state has."""
        return 4 * len(self.rotor.system.rest) + len(self.rotor.races) - self.rotor.races.count(None)

    @cached_property
    def _scales(self) -> tuple[float, float]:
        scales = self.rotor.scales
        if scales is None:
            raise CaromError("a rotor without scales")
        return scales.length, scales.speed

    def clock(self, time: float | np.ndarray) -> float | np.ndarray:
        """Angle by which the shaft has turned at a time of the record in s."""
        return self._scales[1] * time + self.angle

    def state(self, numbers: np.ndarray, time: float) -> State:
        """State of real numbers at a time in s."""
        return self._at_clock(numbers, float(self.clock(time)))

    def _at_clock(self, numbers: np.ndarray, begun: float) -> State:
        n, (length, speed) = len(self.rotor.system.rest), self._scales
        places = numbers[:n] + 1j * numbers[n : 2 * n]
        rates = numbers[2 * n : 3 * n] + 1j * numbers[3 * n : 4 * n]
        back = np.exp(-1j * begun) * self.unit[0] / length
        position = places * back
        velocity = rates * back * self.unit[1] / speed - 1j * position
        return State.of(position, velocity, tuple(numbers[4 * n :].tolist()), time=begun)

    def numbers(self, amplitudes: np.ndarray, clock: float) -> np.ndarray:
        """Real numbers of mode amplitudes (N,) when the shaft has turned by an angle."""
        system, (length, speed) = self.rotor.system, self._scales
        position, velocity = (np.atleast_1d(each) for each in system.state(amplitudes))
        turn = np.exp(1j * clock) * length / self.unit[0]
        places, rates = position * turn, (velocity + 1j * position) * turn * speed / self.unit[1]
        return np.concatenate([places.real, places.imag, rates.real, rates.imag, system.race_speeds(amplitudes)])

    def _seen(self, amplitudes: np.ndarray, clocks: np.ndarray) -> np.ndarray:
        """What the sensors see of amplitudes (m, N) at given clocks (m,), shape (m, c)."""
        position = self.rotor.system.state(amplitudes)[0].reshape(len(clocks), -1)
        seen: np.ndarray = ((position @ self.rows.T) * np.exp(1j * clocks)[:, None]).real
        return seen

    def follow(self, numbers: np.ndarray, first: int, last: int) -> StretchMotion | None:
        """The motion from a state at a sample up to another one, which is not seen any more; ``None`` if it goes beyond the model."""
        times, speed = self.record.times[first : last + 1], self._scales[1]
        farthest = self.radius(numbers, first)
        if farthest > 1.0:  # noise may put a state beyond the wall
            numbers = np.concatenate([numbers[: 2 * self.places] * (ON_WALL / farthest), numbers[2 * self.places :]])
        start = self.state(numbers, float(times[0]))
        try:
            motion = simulate(
                self.rotor, start, speed * float(times[-1] - times[0]), settle=False, max_events=MOST_EVENTS
            )
        except CaromError:
            return None
        if motion.outcome is not Outcome.TIME_REACHED:
            return None
        clocks = np.asarray(self.clock(times))
        amplitudes, _ = motion.amplitudes_at(np.minimum(speed * (times - times[0]), motion.time))
        events = tuple(motion.event_planes.tolist())
        return StretchMotion(
            self._seen(amplitudes[:-1], clocks[:-1]),
            self.numbers(amplitudes[-1], float(clocks[-1])),
            events,
            len(motion.contacts),
        )

    def flown(self, numbers: np.ndarray, first: int, samples: Sequence[int]) -> list[np.ndarray]:
        """States at some samples of a free flight from a state at a sample."""
        times = self.record.times
        start, clocks = self.state(numbers, float(times[first])), np.asarray(self.clock(times[list(samples)]))
        begun = self.rotor.system.amplitudes(start.position, start.velocity, start.time)
        elapsed = self._scales[1] * (times[list(samples)] - times[first])
        moved = fly_all(self.rotor.system.arrays, np.tile(begun, (len(elapsed), 1)), elapsed)
        return [self.numbers(each, float(clock)) for each, clock in zip(moved, clocks, strict=True)]

    def flights(self, width: int) -> tuple[np.ndarray, np.ndarray]:
        """What the sensors see of flights over some samples, in m, as if there were no touchdown bearing.

        Returns
        -------
        matrix : array, shape (width c, k)
            Per number of the state at the beginning.
        constants : array, shape (3, width c)
            Of a flight from rest in the centre: a constant part, and what comes with cosine and sine of the angle of the shaft at its beginning.
        """
        speed, c = self._scales[1], len(self.record.channels)
        elapsed = speed * (self.record.times[:width] - self.record.times[0])

        def fly(numbers: np.ndarray, clock: float) -> np.ndarray:
            start = self._at_clock(numbers, clock)
            begun = self.rotor.system.amplitudes(start.position, start.velocity, start.time)
            flown = fly_all(self.rotor.system.arrays, np.tile(begun, (width, 1)), elapsed)
            return self._seen(flown, clock + elapsed).ravel()

        zero, basis = np.zeros(self.states), np.eye(self.states)
        resting = [fly(zero, clock) for clock in THIRDS]
        constants = np.linalg.solve([[1.0, np.cos(clock), np.sin(clock)] for clock in THIRDS], resting)
        return np.array([fly(each, 0.0) - resting[0] for each in basis]).T.reshape(width * c, -1), constants


def derivative(along: Callable[[float], StretchMotion | None], events: tuple[int, ...]) -> np.ndarray | None:
    """Derivative of a motion along a change of its start or its rotor, by central differences of exact motions; ``None`` where it has none.

    Between motions with the same contacts it is smooth: contacts that come or go along a change have no derivative.
    """
    for step in STEPS:
        before, after = along(-step), along(step)
        if before and after and before.events == after.events == events:
            return (after.together - before.together) / (2.0 * step)
    return None
