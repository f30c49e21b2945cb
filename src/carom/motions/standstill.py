"""Spin-down: a shaft without levitation, slowed down by friction in contact, windage and its drive until it stands still.

Friction in contact changes the speed within the motion.  All other torques act in steps, half of a step ahead of the motion, and gyroscopic
moments, and whatever else of the matrices depends on the speed, are those of the middle of each step of speed, so the error is of second order
in the step; it is estimated from steps twice as large.
Left out: the torque of the unbalance on the shaft, whose mean in each step is given; the torque ``I_p Ω̇`` about a tilted axis; and rolling
resistance, without which a rotor that stands rocks for ever.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from carom.base.arguments import Count, Whole, checked
from carom.base.outcome import InputError, Outcome, shown
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result
from carom.models import Rotor, Subject, rotor_of
from carom.models.planar import shaft_of
from carom.models.stages import stages_of
from carom.models.turning import Shaft
from carom.motions.budget import present_question
from carom.motions.descent import TINY, Descent, SteppedRotor, Torques
from carom.motions.load_sums import loads_of
from carom.motions.loads import DropLoads
from carom.motions.settling import PATIENCE
from carom.motions.simulation import Following, assembled
from carom.motions.starts import Beginning, Until
from carom.motions.trajectories import Trajectory
from carom.parameters import Case, Drive, Scales, own_time

LONGEST = 2e7
"""Time in ``1/Ω`` after which a shaft that has not come to a stand is given up."""
ERROR_FACTOR = 3.0
"""Estimated error, in the largest change with steps twice as large: contacts magnify changes, so that two motions may agree by chance."""


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
    motion : Trajectory or None
        Its first events, to be drawn, where they are kept.
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
    motion: Trajectory | None = None

    figure: ClassVar[str] = "standstill"

    @property
    def largest(self) -> tuple[tuple[float, float], ...]:
        """For each plane the largest distance from the centre of its bearing (0-to-peak, fixed frame), in its clearance, and the speed of the shaft then, in ``Ω``."""
        places = self.course[:, 2:-1]
        return tuple((float(radii.max()), float(self.course[radii.argmax(), 1])) for radii in places.T)

    @property
    def energy_into_bearings(self) -> tuple[float, ...]:
        """What each touchdown bearing takes, by friction and along the normal, in ``m c_r² Ω²``."""
        return tuple(each.heat + each.restitution_loss for each in self.loads.planes)

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
    keep: Whole = 0,
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
    keep : int
        Of so many the motion is kept, to be drawn or written.

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
        raise InputError("regained_after", "a time", "left out: a spin-down follows a shaft without levitation")
    if falling.is_anisotropic:
        raise InputError("supports", "anisotropic", "alike in both directions, in a spin-down")
    shaft, changes = shaft_and_changes(before, falling, drive or (machine.drive if isinstance(machine, Case) else None))
    limit = LONGEST if until is None else own_time("until", until, before.scales)
    question = present_question()
    following = Following(False, False, PATIENCE, int(min(max_events, question.left)), Reporter())
    tell = Reporter.of(progress, "slowing down")
    in_steps = changes is not None or not shaft.turns_freely
    if changes is not None:
        changes(0.5 / steps)  # refused at once where coefficients of a support are not known down to there

    def descent(steps: int, tell: Reporter) -> Descent:
        modes, torques = SteppedRotor(falling, shaft, changes, steps), Torques(shaft, 1.0 / steps)
        return Descent(modes, torques, limit, following, tell)

    kept: list[Trajectory] = []
    fine = descent(steps, tell.part(0.0, 0.5 if in_steps else 1.0))
    loads, error = replace(loads_of(_keeping(fine.follow(state), kept, keep)), shaft=None), None
    if in_steps:
        coarse = descent(max(steps // 2, 1), tell.part(0.5, 1.0))
        for _ in coarse.follow(state):
            pass
        error = ERROR_FACTOR * fine.change_to(coarse)
    question.follow(fine.events)
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
        motion=replace(assembled(kept), outcome=Outcome.TIME_REACHED) if kept else None,
    )


def _keeping(pieces: Iterable[Trajectory], kept: list[Trajectory], most: int) -> Iterator[Trajectory]:
    """Pieces of a motion as they pass, of which the first are kept, up to so many events."""
    for piece in pieces:
        if most > 0:
            kept.append(piece)
            most -= len(piece.segment_starts)
        yield piece


def shaft_and_changes(
    before: Rotor, falling: Rotor, drive: Drive | None
) -> tuple[Shaft, Callable[[float], np.ndarray] | None]:
    """The shaft, and what its speed adds to damping and stiffness without levitation, if that changes."""
    elements, own = before.finite_elements, before.equations.shaft
    inertia = None if elements is None else elements.machine.rotor.polar_inertia
    if own is None or drive is not None:
        if before.scales is None:
            raise InputError("machine", shown(before), "a machine in SI units, or a rotor with a carom.models.Shaft")
        own = shaft_of(drive or Drive(), before.scales, inertia)
    if own is None:
        raise InputError(
            "polar_inertia",
            None,
            "a shaft that slows down needs a table [drive] with it, such as polar_inertia = '0.02 kg m^2'",
        )
    if elements is not None:
        return own, elements.changes_at
    spin = -1j * falling.matrices.gyroscopic
    return own, (lambda speed: np.stack([(speed - 1.0) * spin, np.zeros_like(spin)])) if spin.any() else None
