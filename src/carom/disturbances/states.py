"""Disturbances that put the rotor into a state: releases from the wall, slices and all states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from carom.base.arguments import checked
from carom.disturbances.coordinates import (
    Coordinate,
    Starts,
    angle_coordinate,
    complex_of,
    displaced,
    length_coordinate,
    speed_coordinate,
    within,
)
from carom.disturbances.model import FASTEST, Disturbance

if TYPE_CHECKING:
    from carom.models import Rotor

Release = Literal["fixed", "rotating", "rolling"]


@checked
@dataclass(frozen=True)
class ContactRelease(Disturbance):
    """Levitation is switched on with the rotor on the wall, at any angle.

    A rotor of several coordinates or planes is displaced as a whole until the first plane touches.

    Attributes
    ----------
    motion : {"fixed", "rotating", "rolling"}
        The rotor centre is at rest, whirls in step with the shaft, or rolls on the bearing without slip.
    """

    motion: Release = "fixed"
    kind: ClassVar[str] = "release"
    noun: ClassVar[str] = "releases"

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Angle of the contact point on the wall."""
        return (angle_coordinate("angle", "place on the wall"),)

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """States on the wall, moving along it."""
        (angle,) = values
        cosine, sine = np.cos(angle), np.sin(angle)
        carried, surface_speed = rotor.system.planes_translated, rotor.system.arrays.surface_speed
        rate = {"fixed": 0.0, "rotating": 1.0, "rolling": 1.0 - float(surface_speed[carried.argmax()])}[self.motion]
        speed = rate / carried.max() if carried.any() else rate
        return displaced(rotor, complex_of(cosine, sine), complex_of(-speed * sine, speed * cosine)).at(instant)


@dataclass(frozen=True)
class StateSlice(Disturbance):
    """Any position inside the wall, at one velocity in the fixed frame.

    A rotor of several coordinates or planes is displaced as a whole; the position is that of the plane that moves farthest.

    Attributes
    ----------
    velocity : complex
        Velocity ``v`` in the fixed frame, in ``c_r Ω``, at the instant when both frames coincide: ``U̇ = v − iU``.  By default
        the rotor is released at rest.
    """

    velocity: complex = 0j
    kind: ClassVar[str] = "slice"
    noun: ClassVar[str] = "positions"
    measured_in: ClassVar[dict[str, str]] = {"velocity": "velocity"}

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Both components of the position."""
        return length_coordinate("x", "position Re U", -1.0, 1.0), length_coordinate("y", "position Im U", -1.0, 1.0)

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """All positions inside the wall."""
        x, y = np.broadcast_arrays(*values)
        positions = complex_of(x, y)
        there = within(positions)
        return displaced(rotor, np.where(there, positions, 0.0), np.full(positions.shape, self.velocity), there).at(
            instant
        )


@dataclass(frozen=True)
class AnyState(Disturbance):
    """Any position inside the wall and any velocity in the fixed frame up to a largest speed, both uniform over their discs.

    A rotor of several coordinates or planes is displaced as a whole; the position is that of the plane that moves farthest.

    Attributes
    ----------
    fastest : float
        Largest speed in the fixed frame, in ``c_r Ω``: ``|U̇ + iU|`` of the planar rotor.
    """

    fastest: float = FASTEST
    kind: ClassVar[str] = "state"
    noun: ClassVar[str] = "positions with velocities"
    measured_in: ClassVar[dict[str, str]] = {"fastest": "velocity"}

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Position and velocity, both by modulus and angle."""
        return (
            length_coordinate("radius", "distance from the centre of the bearing", 0.0, 1.0, over_disc=True),
            angle_coordinate("angle", "angle of the position"),
            speed_coordinate("speed", "speed in the fixed frame", 0.0, self.fastest, over_disc=True),
            angle_coordinate("direction", "direction of the velocity"),
        )

    @property
    def size(self) -> Coordinate:
        """Speed in the fixed frame."""
        return self.coordinates[2]

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """The given states, in the co-rotating frame."""
        radius, angle, speed, direction = np.broadcast_arrays(*values)
        return displaced(
            rotor,
            complex_of(radius * np.cos(angle), radius * np.sin(angle)),
            complex_of(speed * np.cos(direction), speed * np.sin(direction)),
        ).at(instant)
