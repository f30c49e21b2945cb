"""What moves the base of a levitating rotor: the parts that shocks and records share.

The acceleration of the base is a course of sections.  In each it is a half-sine, or a constant and a ramp, so that all sections have the same forcing modes
with other amplitudes, and the modes of the rotor are found once (:mod:`carom.disturbances.shocks`).
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.base.outcome import InputError
from carom.disturbances.coordinates import Starts, displaced
from carom.disturbances.model import Disturbance
from carom.disturbances.response_spectra import BaseCourse

if TYPE_CHECKING:
    from carom.models import Force, Rotor, Stage, Subject
    from carom.motions.starts import State


@dataclass(frozen=True)
class BaseMotion(Disturbance):
    """Base class of disturbances that move the base; their coordinates are the peak acceleration and an angle."""

    kind: ClassVar[str] = ""
    turns_with_shaft: ClassVar[bool] = True
    """Whether the angle counts from the axes that turn with the shaft, at the instant when it begins, or from those of the fixed frame."""

    def course(self, size: float, angle: float = 0.0, begun: float = 0.0) -> BaseCourse:
        """The acceleration of the base in the fixed frame, of a peak in ``c_r Ω²``, which begins at a time: all half-sines of one frequency, or all straight."""
        raise NotImplementedError

    def forces(self, rotor: Rotor, turn: complex) -> tuple[Force, ...]:
        """Forces of one on a rotor when the base moves along a direction, a complex number of modulus one.

        They are the two exponentials of a half-sine, or a force that grows: one along each axis of anisotropic bearings, whose conjugates are no multiples by
        complex numbers.
        """
        from carom.models import Force
        from carom.models.mode_arrays import STEADY

        if frequency := float(self.course(1.0).frequencies.max()):
            push = turn / 2j * rotor.carried_by_housing
            return Force(1j * (frequency - 1.0), -push), Force(-1j * (frequency + 1.0), push)
        along = -turn * rotor.carried_by_housing
        axes = (along, 1j * along) if rotor.is_anisotropic else (along,)
        return tuple(Force(STEADY, axis, axis) for axis in axes)

    def sections(self, rotor: Rotor) -> list[tuple[float, np.ndarray]]:
        """Duration of each section, and its values at its beginning for a peak of one and the forces on a rotor (:mod:`carom.models.forcing_modes`)."""
        course = self.course(1.0)
        if course.frequencies.any():
            values = np.sign(course.frequencies)[:, None]
        else:
            values = np.stack([course.slopes, course.values], axis=1)
            if rotor.is_anisotropic:
                values = np.concatenate([values.real, values.imag], axis=1)
        return list(zip(course.durations.tolist(), values, strict=True))

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """State at the end of the motion of the base, which begins at the instant."""
        from carom.disturbances.shocks import states_after
        from carom.models.stages import stages_of

        sizes, angles, begun = np.broadcast_arrays(*values, instant)
        if rotor.system.rest_radius >= 1.0:
            return displaced(rotor, np.zeros(sizes.shape, complex), np.zeros(sizes.shape), False)
        if rotor.system.is_externally_forced:
            rotor.system.refuse_non_stationary()
        *states, ended, touched = states_after(self, stages_of(rotor)[0].rotor, sizes, angles, begun)
        lasts = sum(self.course(1.0).durations.tolist())
        begins = begun + lasts if rotor.depends_on_instant else np.zeros(sizes.shape)
        return Starts(states[0], states[1], np.ones(sizes.shape, bool), ended, touched, begins)

    def apply(self, machine: Subject, *values: float | str, instant: float | str = 0.0) -> tuple[Rotor, State]:
        """Return the machine in a stage for each section and then without, and its start at levitation, for :func:`carom.simulate`.

        Contacts during the motion of the base are part of the motion.  Stages of the machine begin when it is over.  A machine with weight
        levitates about its static sag when it begins.

        Parameters
        ----------
        machine : Machine, Case, Parameters or model
        *values : float or str
            Peak acceleration, by default the largest, and angle, by default 0.
        instant : float or str
            Angle by which the shaft has turned when it begins, rad, since the frame that turns with it coincided with the fixed
            one: under weight it says where this points.

        Raises
        ------
        InputError
            The rotor cannot levitate inside the wall.
        """
        from carom.models import in_stages, rotor_of
        from carom.models.stages import stages_of
        from carom.motions.starts import State

        further = stages_of(rotor_of(machine))
        rotor = further[0].rotor
        size, angle, begun = self.whole(values, instant, rotor.scales)
        rotor.system.require_levitation()
        stages = self.stages_of_base(rotor, size, angle, begun)
        return in_stages((*stages, *further)), State.of(*rotor.system.kicked(0j, begun), time=begun)

    def stages_of_base(self, rotor: Rotor, size: float, angle: float, begun: float) -> list[Stage]:
        """The rotor, which levitates or falls, in a stage for each section.

        In free fall weight and a ramp drive the same velocity and displacement, so weight becomes part of the ramp; what that does to mounts, which have no
        weight, is taken back.

        Raises
        ------
        InputError
            It falls, and supports are anisotropic.
        """
        from carom.models import Force, Stage, Trigger
        from carom.models.forcing_modes import ForcingModes
        from carom.models.mode_arrays import STEADY

        forces = self.forces(rotor, cmath.rect(1.0, angle + begun * self.turns_with_shaft))
        weight, constant, along = rotor.acting.weight, 0.0 + 0j, forces[0].accelerations
        if forces[0].rates is not None and weight is not None and rotor.system.rest_radius == np.inf:
            if rotor.is_anisotropic:
                raise InputError(self.kind, self.noun, "isotropic supports in a drop; a shock may come to others")
            moves = rotor.system.translated
            constant = complex(np.vdot(moves, weight) / np.vdot(moves, along))
            rotor = rotor.unforced.under(Force(STEADY, weight - constant * along))
        moved = ForcingModes.of(rotor, forces)
        stages, time = list[Stage](), begun
        for duration, values in self.sections(rotor):
            shaken = size * values + (np.array([0.0, constant]) if constant else 0.0)
            stages.append(Stage(moved.at(shaken, time), Trigger(time=duration)))
            time += duration
        return stages
