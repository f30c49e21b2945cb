"""Spin-down: a shaft without levitation, slowed down by friction in contact, windage and its drive until it stands still.

Friction in contact changes the speed within the motion.  All other torques act in steps, half of a step ahead of the motion, and gyroscopic
moments are those of the middle of each step of speed, so the error is of second order in the step; it is estimated from steps twice as large.
Left out: the torque of the unbalance on the shaft, whose mean in each step is told; the torque ``I_p Ω̇`` about a tilted axis; and rolling
resistance, without which a rotor that stands rocks for ever.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np

from carom.base.arguments import Count, checked
from carom.base.outcome import InputError, Outcome, shown
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result
from carom.models import Rotor, Subject, Trigger, rotor_of
from carom.models.planar import shaft_of
from carom.models.stages import stages_of
from carom.models.turning import Shaft
from carom.motions.load_sums import loads_of
from carom.motions.loads import DropLoads
from carom.motions.settling import PATIENCE
from carom.motions.simulation import Following, follow_stage
from carom.motions.starts import Beginning, State, Until
from carom.motions.trajectories import Trajectory
from carom.parameters import Case, Drive, Scales, own_time

STILL = 1e-12
"""Speed, in the speed before, at which a shaft stands."""
LEAST = 0.05
"""Smallest duration of a step of torques, in that of a whole step of speed: without it they would shrink for ever."""
LONGEST = 2e7
"""Time in ``1/Ω`` after which a shaft that has not come to a stand is given up."""
ERROR_FACTOR = 3.0
"""Error that is told, in the largest change with steps twice as large: contacts magnify changes, so that two motions may agree by chance."""
SEEN = np.arange(1, 65) * 0.5 * (math.sqrt(5.0) - 1.0) % 1.0
"""Where whirl and unbalance are looked at between events, as shares of a piece of motion: even, without a period."""
EDGE = 1e-9
"""Share of a step within which a speed is at its end."""
TINY = 1e-300


@dataclass(frozen=True, eq=False, repr=False)
class SpinDown(Result):
    """A shaft that slows down, from the loss of levitation to standstill or to where it was given up.

    Attributes
    ----------
    loads : DropLoads
        What the touchdown bearings bear; ``heat`` of each is the work of friction, and ``restitution_loss`` that along the normal.
    time : float
        Time to standstill, or to where the shaft was given up, in ``1/Ω``.
    stands : bool
        Whether the shaft has come to a stand: its speed is zero for the first time.
    turns : float
        Turns of the shaft until then.
    speed_at_end : float
        In ``Ω``.
    braked : float
        Energy that drag, windage, brake and drive have taken from the shaft, in ``m c_r² Ω²``; negative if the drive has given more.
    steps : int
        Steps from the speed of the machine to zero.
    error : float or None
        Estimated error by steps, relative: three times the largest change of time, turns and ``braked`` (of that, in the energy of the shaft), or of the
        speed at the end in their place, with steps twice as large; ``None`` where steps change nothing, as friction alone slows down a rotor
        without gyroscopic moments.
    course : ndarray, shape (k, 3 + P)
        At the end of each step the time in ``1/Ω``, the speed in ``Ω``, the largest distance of each plane from the centre of its bearing within the
        step, in its clearance, as seen at events and at 64 more times, and the mean of the torque of the unbalance on the shaft, in ``m c_r² Ω²``, which
        is left out: with it the shaft would slow down more where it is positive.
    criticals : tuple of float
        Speeds passed on the way down, in ``Ω``, at which the free rotor has a forward mode of the same frequency.
    scales : Scales or None
    """

    loads: DropLoads
    time: float
    stands: bool
    turns: float
    speed_at_end: float
    braked: float
    steps: int
    error: float | None
    course: np.ndarray
    criticals: tuple[float, ...]
    scales: Scales | None = None

    @property
    def largest(self) -> tuple[tuple[float, float], ...]:
        """For each plane the largest distance from the centre of its bearing (0-to-peak, fixed frame), in its clearance, and the speed of the shaft then, in ``Ω``."""
        places = self.course[:, 2:-1]
        return tuple((float(radii.max()), float(self.course[radii.argmax(), 1])) for radii in places.T)

    @property
    def unbalance_torque(self) -> tuple[float, float, float]:
        """Largest torque of the unbalance in the mean of a step, the speed of the shaft then, and the energy that it would take from the shaft in all."""
        times, speeds, torques = self.course[:, 0], self.course[:, 1], self.course[:, -1]
        place = int(np.abs(torques).argmax())
        return (
            float(torques[place]),
            float(speeds[place]),
            float((torques * speeds * np.diff(times, prepend=0.0)).sum()),
        )

    @property
    def remaining(self) -> float:
        """Time in ``1/Ω`` until standstill if the shaft went on slowing down as in its last steps; infinite if it does not slow down."""
        last = self.course[-2:] if len(self.course) > 1 else np.vstack([[0.0, 1.0, *self.course[0, 2:]], self.course])
        slowing = (last[0, 1] - last[1, 1]) / max(last[1, 0] - last[0, 0], TINY)
        return 0.0 if self.stands else self.speed_at_end / slowing if slowing > 0.0 else math.inf


@checked
@shows_progress
def spin_down(
    machine: Subject,
    start: Beginning,
    until: Until | None = None,
    *,
    drive: Drive | None = None,
    steps: Count = 200,
    max_events: Count = 1_000_000,
    progress: ShowProgress = None,
) -> SpinDown:
    """Follow a rotor that has lost its levitation until its shaft stands still.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    start : Drop
        How levitation is lost, as :func:`carom.drop`.
    until : float or str, optional
        Time after which to give up, in ``1/Ω`` or text with a unit; by default 2e7/Ω.
    drive : Drive, optional
        Inertia of the shaft and torques on it; by default those of the machine file.  A flexible or rigid ``[rotor]`` knows its inertia.
    steps : int
        Steps of speed, from the speed of the machine to zero: in each gyroscopic moments, and torques other than friction in contact, are those of
        its middle.
    max_events : int
        Impacts and steps of lasting contact after which to give up.

    Raises
    ------
    InputError
        The inertia is not known, the supports are anisotropic, or levitation is regained.

    See Also
    --------
    carom.motions.follow_loads : a drop in which the speed hardly changes

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/touchdown-balls.toml")
    >>> drive = cm.parameters.Drive("2e-5 kg m^2", brake="0.05 N m")
    >>> found = cm.motions.spin_down(machine, cm.drop(), drive=drive)
    >>> found.stands
    True
    """
    before = rotor_of(machine)
    falling, state = start.stages(machine)
    if len(stages_of(falling)) > 1:
        raise InputError("start", shown(start), "a drop without regained levitation")
    shaft, gyroscopic = _shaft_and_moments(
        before, falling, drive or (machine.drive if isinstance(machine, Case) else None)
    )
    limit = LONGEST if until is None else own_time("until", until, before.scales)
    following = Following(False, False, PATIENCE, max_events, Reporter())
    tell = Reporter.of(progress, "slowing down")
    in_steps = not shaft.turns_freely or bool(gyroscopic.any())

    def descent(steps: int, tell: Reporter) -> _Descent:
        modes, torques = _Modes(falling, shaft, gyroscopic, steps), _Torques(shaft, 1.0 / steps)
        return _Descent(modes, torques, limit, following, tell)

    fine = descent(steps, tell.part(0.0, 0.5 if in_steps else 1.0))
    loads, error = replace(loads_of(fine.follow(state)), shaft=None), None
    if in_steps:
        coarse = descent(max(steps // 2, 1), tell.part(0.5, 1.0))
        for _ in coarse.follow(state):
            pass
        error = ERROR_FACTOR * fine.change_to(coarse)
    return SpinDown(
        loads=loads,
        time=fine.time,
        stands=fine.stands,
        turns=fine.turns,
        speed_at_end=fine.reached,
        braked=fine.torques.taken,
        steps=steps,
        error=error,
        course=np.array(fine.course),
        criticals=tuple(fine.modes.criticals),
        scales=before.scales,
    )


def _shaft_and_moments(before: Rotor, falling: Rotor, drive: Drive | None) -> tuple[Shaft, np.ndarray]:
    """The shaft, and the gyroscopic matrix, which grows with its speed."""
    elements, own = before.finite_elements, before.equations.shaft
    inertia = None if elements is None else elements.machine.rotor.polar_inertia
    if own is None or drive is not None:
        if before.scales is None:
            raise InputError("machine", shown(before), "a machine in SI units, or a rotor with a carom.models.Shaft")
        own = shaft_of(drive or Drive(), before.scales, inertia)
    if own is None:
        raise InputError(
            "polar_inertia", None, "a spin-down needs a table [drive] with it, such as polar_inertia = '0.02 kg m^2'"
        )
    # Cross-coupled damping of supports counts as gyroscopic in the matrices of the fixed frame, but does not grow with the speed.
    return own, falling.matrices.gyroscopic if elements is None else elements.equations.gyroscopic


@dataclass
class _Torques:
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
        self.slowing = abs(self.shaft.rate(before)) + max(before - after, 0.0) / max(time, TINY)

    def stop(self, speed: float) -> float:
        """Take all speed that is left; return the time in which it would have fallen to zero."""
        left = max(speed, 0.0) + abs(self.shaft.rate(0.0)) * self.ahead
        self._take(speed if speed > STILL else 0.0, 0.0)
        return left / self.slowing

    def of_motion(self, speed: float) -> float:
        """Speed without what they have done ahead of the motion."""
        return speed + abs(self.shaft.rate(speed)) * self.ahead

    def _take(self, before: float, after: float) -> None:
        self.taken += 0.5 * self.shaft.inertia * (before**2 - after**2)


@dataclass
class _Modes:
    """A rotor in steps of speed, in each of which gyroscopic moments are those of its middle, and the critical speeds that are passed."""

    falling: Rotor
    shaft: Shaft
    gyroscopic: np.ndarray
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
            if self.rotor is None or self.gyroscopic.any():
                self.rotor = self._turning_at(middle)
            self._pass(middle)
            self.number = number
        return cast("Rotor", self.rotor), (number - 1) / self.steps

    def _turning_at(self, speed: float) -> Rotor:
        more, equations = (speed - 1.0) * self.gyroscopic, self.falling.equations
        found = replace(
            equations,
            damping=equations.damping - 1j * more,
            stiffness=equations.stiffness + more,
            touchdowns=[
                replace(each, bearing=self.falling.definition.bearing_at(plane))
                for plane, each in enumerate(equations.touchdowns)
            ],
            shaft=replace(self.shaft, torque=0.0, in_stages=True),
        )
        return replace(self.falling, definition=found)

    def _pass(self, middle: float) -> None:
        """Note the frequencies that the speed has passed since the step before."""
        system = cast("Rotor", self.rotor).system
        found = np.sort(system.arrays["exponents"][system.free].imag + 1.0)
        above = found[found > 0.5 / self.steps] - middle
        if len(above) == len(self.above):
            passed = (self.above < 0.0) & (above >= 0.0)
            self.criticals += (middle + above[passed] / (above[passed] - self.above[passed]) / self.steps).tolist()
        self.above = above


@dataclass
class _Descent:
    """A shaft on its way down: where it is, and what it has passed."""

    modes: _Modes
    torques: _Torques
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

    def change_to(self, other: _Descent) -> float:
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
        starts, ends = piece.segment_amplitudes, np.concatenate([piece.event_amplitudes, piece.last_amplitudes[None]])
        both, durations = np.stack([starts, ends])[..., place].real, piece.durations
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
