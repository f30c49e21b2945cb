"""A flexible machine by a few vectors, as a model that all of carom takes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.models import Limited, LinearRotor, Model, Touchdown
from carom.models.in_bearing import law_of, race_of
from carom.models.weight import weighted
from carom.outcome import InputError
from carom.parameters import Scales
from carom.results import Result
from carom.rotors.attachments import TouchdownPlane
from carom.rotors.bearing_limits import limits_of_bearings
from carom.rotors.equations import Equations, equations_of, loops_of
from carom.rotors.reduction import Basis

if TYPE_CHECKING:
    from carom.rotors.flexible_machine import FlexibleMachine


@dataclass(frozen=True, eq=False, repr=False)
class ReducedMachine(Result):
    """A flexible machine by a few vectors: modes of the free rotor, and what all others give way where forces act (Rubin).

    Attributes
    ----------
    machine : FlexibleMachine
    basis : Basis
        The vectors.
    error : float
        Change of the force in a touchdown bearing with half as many vectors more, relative to that force, as the root of the means of the squares while
        the first contact lasts, when the free rotor comes straight with all its mass; the largest of all planes; 0 of all modes.
        A rotor that comes tilted or bends on its way may differ by more: see whether results stay with a smaller accuracy.
    """

    machine: FlexibleMachine
    basis: Basis
    error: float

    shown: ClassVar = ("vectors", "modes", "error", "states")
    rests_on: ClassVar = ()

    @property
    def vectors(self) -> int:
        """Number of vectors."""
        return len(self.basis.frequencies)

    @property
    def modes(self) -> int:
        """How many of them are modes of the free rotor, two of which are rigid."""
        return self.basis.modes

    @property
    def states(self) -> int:
        """Number of complex states: displacements and velocities of all vectors, and states of controllers."""
        return len(self.equations.mass) + int(self.equations.mass.any(axis=1).sum())

    @cached_property
    def scales(self) -> Scales:
        """Mass of the rotor, clearance and speed: the units of the model."""
        machine = self.machine
        return Scales(machine.rotor.mass, machine.clearance, machine.speed)

    @cached_property
    def equations(self) -> Equations:
        """Equations of motion in SI units."""
        at = self.machine
        return equations_of(at.rotor, self.basis, at.bearings, at.touchdowns, at.unbalances, restart=at.speed)

    @cached_property
    def linear(self) -> LinearRotor:
        """The levitating rotor without weight, in units of the equations.

        Raises
        ------
        InputError
            There are magnetic bearings, and a motion on them grows.
        """
        rotor = self._rotor()
        if self.machine.bearings and (rate := rotor.system.decay) <= 0.0:
            worst = rotor.system.exponents[rotor.system.exponents.real.argmax()] + 1j
            speed = self.machine.speed
            hertz = worst.imag * speed / (2.0 * math.pi)
            grows = f"unstable: a whirl of {hertz:.4g} Hz grows with {-rate * speed:.4g} 1/s"
            raise InputError("levitation", grows, "controllers that hold the rotor at this speed")
        return rotor

    @cached_property
    def limited(self) -> LinearRotor | Limited:
        """The levitating rotor without weight, with the limits of its magnetic bearings if these have any.

        Raises
        ------
        InputError
            As for :attr:`linear`.
        """
        at, given = self.machine, self.equations
        pulls = np.zeros_like(given.currents)
        pulls[:, : self.vectors] = loops_of(at.rotor, at.bearings, at.touchdowns).bearings @ self.basis.shapes
        limits = limits_of_bearings(given, tuple(at.bearings), pulls, self.scales)
        return Limited(self.linear, limits) if limits else self.linear

    @cached_property
    def model(self) -> Model:
        """The levitating rotor with its weight, if it has one, as all verbs take it; ``carom.drop`` takes its levitation away.

        The first coordinates are those of the vectors, the first of which is the translation of the whole rotor.

        Raises
        ------
        InputError
            As for :attr:`linear`.
        """
        gravity = self.machine.gravity
        return self.limited if gravity is None or not gravity.acceleration else weighted(self.limited, gravity)

    def _rotor(self) -> LinearRotor:
        given, scales, at = self.equations, self.scales, self.machine
        heavy = given.mass.any(axis=1)
        # Coordinates without mass have equations of first order, which have another unit.
        once = np.where(heavy, 1.0 / scales.speed, 1.0)[:, None]
        twice = np.where(heavy, 1.0 / scales.speed**2, 1.0 / scales.speed)[:, None]
        size = math.sqrt(scales.mass)
        planes = zip(at.touchdowns, size * given.planes, strict=True)
        return LinearRotor.in_fixed_frame(
            mass=given.mass,
            damping=once * given.damping,
            stiffness=twice * given.stiffness,
            gyroscopic=given.gyroscopic,
            forcing=given.forcing / (scales.length * size),
            touchdowns=[self._touchdown(plane, row) for plane, row in planes],
            translation=np.eye(len(given.mass))[0],
            scales=scales,
            unlevitated=np.stack([once * given.unlevitated[0], twice * given.unlevitated[1]]),
        )

    def _touchdown(self, plane: TouchdownPlane, row: np.ndarray) -> Touchdown:
        scales, bearing = self.scales, plane.bearing
        ratio = plane.rotor_radius / scales.length
        return Touchdown(row, law_of(bearing, scales), plane.friction, ratio + 1.0, race_of(bearing, ratio, scales))
