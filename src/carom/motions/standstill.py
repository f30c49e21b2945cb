"""Spin-down: a shaft without levitation, slowed down by friction in contact, windage and its drive until it stands still.

Friction in contact changes the speed within the motion.  All other torques act in steps, half of a step ahead of the motion, and gyroscopic
moments are those of the middle of each step of speed, so the error is of second order in the step; it is estimated from steps twice as large.
Left out: the torque ``I_p Ω̇`` about a tilted axis, the torque of the unbalance on the shaft, and rolling resistance, without which a rotor that
stands rocks for ever.
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
        Change of the time to standstill, or of the speed at the end in its place, relative to it, with steps twice as large; ``None`` where steps
        change nothing, as friction alone slows down a rotor without gyroscopic moments.
    course : ndarray, shape (k, 2 + P)
        At the end of each step the time in ``1/Ω``, the speed in ``Ω``, and the largest distance of each plane from the centre of its bearing within the
        step, in its clearance.
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
        """For each plane the largest distance from the centre of its bearing, in clearances, and the speed of the shaft then, in ``Ω``."""
        places = self.course[:, 2:]
        return tuple((float(radii.max()), float(self.course[radii.argmax(), 1])) for radii in places.T)

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
    fine = _Descent(falling, shaft, gyroscopic, steps, limit, following, tell.part(0.0, 0.5 if in_steps else 1.0))
    loads = replace(loads_of(fine.follow(state)), shaft=None)
    error = None
    if in_steps:
        coarse = _Descent(falling, shaft, gyroscopic, max(steps // 2, 1), limit, following, tell.part(0.5, 1.0))
        for _ in coarse.follow(state):
            pass
        error = (
            abs(coarse.time / fine.time - 1.0)
            if fine.stands and coarse.stands
            else abs(coarse.speed - fine.speed) / max(fine.speed, STILL)
        )
    return SpinDown(
        loads=loads,
        time=fine.time,
        stands=fine.stands,
        turns=fine.turns,
        speed_at_end=fine.speed,
        braked=fine.braked,
        steps=steps,
        error=error,
        course=np.array(fine.course),
        criticals=tuple(fine.criticals),
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
class _Descent:
    """A shaft on its way down."""

    falling: Rotor
    shaft: Shaft
    gyroscopic: np.ndarray
    steps: int
    until: float
    following: Following
    tell: Reporter
    time: float = 0.0
    speed: float = 1.0
    turns: float = 0.0
    braked: float = 0.0
    stands: bool = False
    events: int = 0
    course: list[list[float]] = field(default_factory=list)
    criticals: list[float] = field(default_factory=list)
    number: int = 0
    rotor: Rotor | None = None
    above: np.ndarray = field(default_factory=lambda: np.zeros(0))

    def follow(self, state: State) -> Iterator[Trajectory]:
        """Pieces of the motion, until the shaft stands or is given up."""
        ahead, slowing, step = 0.0, 0.0, 1.0 / self.steps
        self.speed, angle = state.shaft or (1.0, 0.0)
        while True:
            torque = abs(self.shaft.rate(self.speed))
            rotor, edge = self._step(self.speed + torque * ahead)
            fastest, duration = max(torque, slowing), math.inf
            if torque > 0.0:
                damping = (self.shaft.drag + 2.0 * self.shaft.windage * self.speed) / self.shaft.inertia
                duration = max(min(self.speed, step), LEAST * step) / max(fastest, damping * step)
                after = self._turned(max(0.5 * duration - ahead, 0.0))
                if after <= STILL:
                    return self._stand(ahead, fastest)
                ahead = max(ahead, 0.5 * duration)
                self._brake(after)
            before, begun = self.speed, self.time
            state = replace(state, shaft=(before, angle))
            trigger = Trigger(time=duration, shaft_speed=max(min(edge, before - 0.25 * step), STILL))
            more = self.following._replace(max_events=self.following.max_events - self.events)
            radii = np.zeros(len(rotor.system.contacts))
            for piece in follow_stage(rotor, state, self.until - begun, trigger, more):
                radii = np.maximum(radii, self._note(piece, begun))
                yield piece
            passed, ended = self.time - begun, piece.final
            self.course.append([self.time, max(self.speed, 0.0), *radii])
            self.tell(max(1.0 - self.speed, self.time / self.until, self.events / self.following.max_events))
            if piece.outcome is not Outcome.TRIGGERED:
                return
            ahead, slowing = ahead - passed, torque + max(before - self.speed, 0.0) / max(passed, TINY)
            if self.speed <= STILL:
                return self._stand(ahead, slowing)
            angle = ended.shaft[1]
            state = State.of(ended.position, ended.velocity, ended.races, time=piece.begins + piece.time)

    def _step(self, speed: float) -> tuple[Rotor, float]:
        """The rotor of the step in which a speed is, and the speed at which it ends."""
        number = max(math.ceil(speed * self.steps - EDGE), 1)
        middle = (number - 0.5) / self.steps
        if number != self.number:
            more = middle - 1.0 if self.gyroscopic.any() else 0.0
            if self.rotor is None or more:
                equations = self.falling.equations
                found = replace(
                    equations,
                    damping=equations.damping - 1j * more * self.gyroscopic,
                    stiffness=equations.stiffness + more * self.gyroscopic,
                    touchdowns=[
                        replace(each, bearing=self.falling.definition.bearing_at(plane))
                        for plane, each in enumerate(equations.touchdowns)
                    ],
                    shaft=replace(self.shaft, torque=0.0, in_stages=True),
                )
                self.rotor = replace(self.falling, definition=found)
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

    def _turned(self, duration: float) -> float:
        """Speed after all torques but friction have acted for a while, by a step of Runge and Kutta."""
        first = self.shaft.rate(self.speed)
        second = self.shaft.rate(self.speed + 0.5 * duration * first)
        third = self.shaft.rate(self.speed + 0.5 * duration * second)
        last = self.shaft.rate(self.speed + duration * third)
        return self.speed + duration / 6.0 * (first + 2.0 * (second + third) + last)

    def _brake(self, after: float) -> None:
        self.braked += 0.5 * self.shaft.inertia * (self.speed**2 - after**2)
        self.speed = after

    def _stand(self, ahead: float, slowing: float) -> None:
        """The shaft stands where a speed that falls so fast reaches zero; torques have acted ahead of the motion."""
        self.time += (max(self.speed, 0.0) + abs(self.shaft.rate(0.0)) * ahead) / slowing
        if self.speed > STILL:
            self._brake(0.0)
        self.speed, self.stands = 0.0, slowing > STILL

    def _note(self, piece: Trajectory, begun: float) -> np.ndarray:
        """Add a piece to turns and time; return the largest distances of the planes from the centre of their bearings."""
        place = int(piece.rotor.system.arrays["shaft"][0]) + 1
        starts, ends = piece.segment_amplitudes, np.concatenate([piece.event_amplitudes, piece.last_amplitudes[None]])
        both, durations = np.stack([starts, ends])[..., place].real, piece.durations
        self.time, self.speed, self.events = begun + piece.time, piece.final.shaft[0], self.events + len(durations) - 1
        if self.speed <= STILL and len(durations) > 1 and both[1, -2] < 0.0 < both[0, -2]:
            late = both[1, -2] / (both[1, -2] - both[0, -2]) * durations[-2]
            self.time, durations[-2] = self.time - late, durations[-2] - late
        self.turns += float((both.mean(axis=0) * durations).sum()) / (2.0 * math.pi)
        planes = range(len(piece.rotor.system.contacts))
        return np.array([np.abs(piece.rotor.system.at_plane(ends, plane)[0]).max() for plane in planes])
