"""The way down of a shaft without levitation: all torques but friction in contact, gyroscopic moments in steps of speed, and what is passed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np

from carom.base.outcome import Outcome
from carom.base.progress import Reporter
from carom.models import Rotor, Trigger
from carom.models.turning import Shaft
from carom.motions.simulation import Following, follow_stage
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory

STILL = 1e-12
"""Speed, in the speed before, at which a shaft stands."""
LEAST = 0.05
"""Smallest duration of a step of torques, in that of a whole step of speed: without it they would shrink for ever."""
SEEN = np.arange(1, 65) * 0.5 * (math.sqrt(5.0) - 1.0) % 1.0
"""Where whirl and unbalance are looked at between events, as shares of a piece of motion: even, without a period."""
EDGE = 1e-9
"""Share of a step within which a speed is at its end."""
TINY = 1e-300


@dataclass
class Torques:
    """All torques but friction in contact: they act on the shaft, then the motion goes on, half of that time ahead of it and half behind.

    Attributes
    ----------
    shaft : Shaft
    step : float
        Of speed.
    ahead : float
        Time for which they have acted and the motion has not yet gone on.
    slowing : float
        Rate at which the speed falls, by them and by friction, in the step before.
    taken : float
        Energy that they have taken from the shaft.
    """

    shaft: Shaft
    step: float
    ahead: float = 0.0
    slowing: float = 0.0
    taken: float = 0.0

    def duration(self, speed: float) -> float:
        """Time for which the motion is to go on: in it the speed falls by no more than a step, as far as is known before."""
        torque = abs(self.shaft.rate(speed))
        self.slowing = max(torque, self.slowing)
        if torque == 0.0:
            return math.inf
        damping = (self.shaft.drag + 2.0 * self.shaft.windage * speed) / self.shaft.inertia
        return max(min(speed, self.step), LEAST * self.step) / max(self.slowing, damping * self.step)

    def act(self, speed: float, duration: float) -> float:
        """Let them act up to the middle of a time; return the speed after that, by a step of Runge and Kutta, or zero if it stands before."""
        time = 0.0 if duration == math.inf else max(0.5 * duration - self.ahead, 0.0)
        first = self.shaft.rate(speed)
        second = self.shaft.rate(speed + 0.5 * time * first)
        third = self.shaft.rate(speed + 0.5 * time * second)
        last = self.shaft.rate(speed + time * third)
        after = speed + time / 6.0 * (first + 2.0 * (second + third) + last)
        if after <= STILL:
            return 0.0
        self.ahead += time
        self._take(speed, after)
        return after

    def go_on(self, before: float, after: float, time: float) -> None:
        """Note that the motion has gone on, and how friction has changed the speed in that time."""
        self.ahead -= time
        self.slowing = max(before - after, 0.0) / max(time, TINY) - self.shaft.rate(before)

    def stop(self, speed: float) -> float:
        """Take all speed that is left; return the time in which it would have fallen to zero."""
        left = max(speed, 0.0) - self.shaft.rate(0.0) * self.ahead
        self._take(speed if speed > STILL else 0.0, 0.0)
        return left / self.slowing

    def of_motion(self, speed: float) -> float:
        """Speed without what they have done ahead of the motion."""
        return speed - self.shaft.rate(speed) * self.ahead

    def _take(self, before: float, after: float) -> None:
        self.taken += 0.5 * self.shaft.inertia * (before**2 - after**2)


@dataclass
class SteppedRotor:
    """A rotor in steps of speed, in each of which its matrices are those of the middle, and the critical speeds that are passed.

    Attributes
    ----------
    falling : Rotor
    shaft : Shaft
    changes : callable or None
        What a speed adds to damping and stiffness in the fixed frame, shape (2, n, n); ``None`` of a rotor of which they stay what they are.
    steps : int
    """

    falling: Rotor
    shaft: Shaft
    changes: Callable[[float], np.ndarray] | None
    steps: int
    criticals: list[float] = field(default_factory=list)
    number: int = 0
    rotor: Rotor | None = None
    above: np.ndarray = field(default_factory=lambda: np.zeros(0))

    def at(self, speed: float) -> tuple[Rotor, float]:
        """The rotor of the step in which a speed is, and the speed at which it ends."""
        number = max(math.ceil(speed * self.steps - EDGE), 1)
        if number != self.number:
            middle = (number - 0.5) / self.steps
            if self.rotor is None or self.changes is not None:
                self.rotor = turning_at(self.falling, middle, self.shaft, self.changes)
            self._pass(middle)
            self.number = number
        return cast("Rotor", self.rotor), (number - 1) / self.steps

    def _pass(self, middle: float) -> None:
        """Note the frequencies that the speed has passed since the step before."""
        system = cast("Rotor", self.rotor).system
        found = np.sort(system.arrays["exponents"][system.free].imag + 1.0)
        above = found[found > 0.5 / self.steps] - middle
        if len(above) == len(self.above):
            passed = (self.above < 0.0) & (above >= 0.0)
            self.criticals += (middle + above[passed] / (above[passed] - self.above[passed]) / self.steps).tolist()
        self.above = above


def turning_at(rotor: Rotor, speed: float, shaft: Shaft, changes: Callable[[float], np.ndarray] | None) -> Rotor:
    """The rotor with its shaft turning at about this speed, in ``Ω``, for which its matrices are; see :class:`SteppedRotor`."""
    equations = rotor.equations
    damping, stiffness = (0.0, 0.0) if changes is None else changes(speed)
    found = replace(
        equations,
        damping=equations.damping + damping,
        stiffness=equations.stiffness + stiffness + 1j * damping,
        touchdowns=[
            replace(each, bearing=rotor.definition.bearing_at(plane)) for plane, each in enumerate(equations.touchdowns)
        ],
        shaft=replace(shaft, torque=0.0, in_stages=True),
    )
    return replace(rotor, definition=found, forces=rotor.acting.forces, carried_by_bias=False)


@dataclass
class Descent:
    """A shaft on its way down: where it is, and what it has passed."""

    modes: SteppedRotor
    torques: Torques
    until: float
    following: Following
    tell: Reporter
    time: float = 0.0
    speed: float = 1.0
    turns: float = 0.0
    stands: bool = False
    events: int = 0
    course: list[list[float]] = field(default_factory=list)

    def follow(self, state: State) -> Iterator[Trajectory]:
        """Pieces of the motion, until the shaft stands or is given up."""
        torques, (self.speed, angle) = self.torques, state.shaft or (1.0, 0.0)
        while True:
            rotor, edge = self.modes.at(torques.of_motion(self.speed))
            duration = torques.duration(self.speed)
            before, begun = torques.act(self.speed, duration), self.time
            if not before:
                return self._stand()
            state = replace(state, shaft=(before, angle))
            lowest = max(min(edge, before - 0.25 * torques.step), STILL)
            trigger = Trigger(time=duration, shaft_speed=lowest)
            more = self.following._replace(max_events=self.following.max_events - self.events)
            radii, given = np.zeros(len(rotor.system.contacts)), 0.0
            for piece in follow_stage(rotor, state, self.until - begun, trigger, more):
                self._note(piece, begun)
                farthest, impulse = _seen(piece)
                radii, given = np.maximum(radii, farthest), given + impulse
                yield piece
            ended = piece.final
            torques.go_on(before, self.speed, self.time - begun)
            self.course.append([self.time, self.reached, *radii, given / max(self.time - begun, TINY)])
            self.tell(max(1.0 - self.speed, self.time / self.until, self.events / self.following.max_events))
            if piece.outcome is not Outcome.TRIGGERED:
                return
            if self.speed <= STILL:
                return self._stand()
            angle = ended.shaft[1]
            state = State.of(ended.position, ended.velocity, ended.races, time=piece.begins + piece.time)

    @property
    def reached(self) -> float:
        """Speed at the time reached; zero of a shaft that stands."""
        return self.torques.of_motion(self.speed) if self.speed > STILL else 0.0

    def change_to(self, other: Descent) -> float:
        """Largest relative change of time, turns and what torques have taken of the energy, or of the speed where one has not come to a stand."""
        if not (self.stands and other.stands):
            return abs(other.reached - self.reached) / max(self.reached, other.reached)
        energy = abs(other.torques.taken - self.torques.taken) / (0.5 * self.torques.shaft.inertia)
        return max(abs(other.time / self.time - 1.0), abs(other.turns / max(self.turns, TINY) - 1.0), energy)

    def _stand(self) -> None:
        """The shaft stands where a speed that falls as it did reaches zero."""
        self.time += self.torques.stop(self.speed)
        self.speed, self.stands = 0.0, self.torques.slowing > STILL

    def _note(self, piece: Trajectory, begun: float) -> None:
        """Add a piece to turns and time."""
        place = int(piece.rotor.system.arrays["shaft"][0]) + 1
        ends = np.append(piece.event_amplitudes[:, place], piece.last_amplitudes[place])
        both, durations = np.stack([piece.segment_amplitudes[:, place], ends]).real, piece.durations
        self.time, self.speed, self.events = begun + piece.time, piece.final.shaft[0], self.events + len(durations) - 1
        if self.speed <= STILL and len(durations) > 1 and both[1, -2] < 0.0 < both[0, -2]:
            late = both[1, -2] / (both[1, -2] - both[0, -2]) * durations[-2]
            self.time, durations[-2] = self.time - late, durations[-2] - late
        self.turns += float((both.mean(axis=0) * durations).sum()) / (2.0 * math.pi)


def _seen(piece: Trajectory) -> tuple[np.ndarray, float]:
    """Largest distances of the planes from the centre of their bearings in a piece, and the angular impulse that its unbalance takes from the shaft."""
    begun, rotor = piece.segment_starts[0], piece.rotor
    within, _ = piece.amplitudes_at(begun + (piece.time - begun) * SEEN)
    amplitudes = np.concatenate([piece.event_amplitudes, piece.last_amplitudes[None], within])
    planes = range(len(rotor.system.contacts))
    radii = np.array([np.abs(rotor.system.at_plane(amplitudes, plane)[0]).max() for plane in planes])
    place = int(rotor.system.arrays["shaft"][0])
    position, velocity = (np.reshape(each, (len(within), -1)) for each in rotor.system.state(within))
    # Power of the unbalance's force σ² F e^{iϑ} on the rotor, over σ: on the whole the force on the shaft is that of the same work.
    along = ((velocity + 1j * position) @ rotor.equations.forcing.conj()) * within[:, place].conj()
    return radii, float((within[:, place + 1].real * along.real).mean() * (piece.time - begun))
