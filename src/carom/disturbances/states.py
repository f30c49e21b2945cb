"""Disturbances that put the rotor into a state: releases from the wall, slices, all states, single ones and whirls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.disturbances.coordinates import Coordinate, Starts, angle_coordinate, complex_of, displaced, within
from carom.disturbances.model import FASTEST, Disturbance
from carom.disturbances.single import Echo, Part, Single, angles_words, moving

if TYPE_CHECKING:
    from carom.models import Rotor, Subject
    from carom.motions.starts import State
    from carom.parameters import Scales

Release = Literal["fixed", "rotating", "rolling"]
PLACE = tuple(Coordinate(name, f"position {part} U", -1.0, 1.0, "length") for name, part in (("x", "Re"), ("y", "Im")))
"""Both components of a position inside the wall."""


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
        return PLACE

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
            Coordinate("radius", "distance from the centre of the bearing", 0.0, 1.0, "length", over_disc=True),
            angle_coordinate("angle", "angle of the position"),
            Coordinate("speed", "speed in the fixed frame", 0.0, self.fastest, "velocity", over_disc=True),
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


@dataclass(frozen=True)
class GivenState(Disturbance):
    """A state of the planar rotor in the co-rotating frame."""

    kind: ClassVar[str] = "start"
    noun: ClassVar[str] = "states"
    bare: ClassVar[bool] = True
    many: ClassVar[bool] = False
    parts: ClassVar = (
        Part("x", "RE", "length", optional=False),
        Part("y", "IM", "length", optional=False),
        Part("velocity_x", "VRE", "velocity", optional=False),
        Part("velocity_y", "VIM", "velocity", optional=False),
    )
    example: ClassVar = "0.5,0,0,0.1 or '0.3 mm,0 mm,5 mm/s,0 m/s'"

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Both components of the position and of the velocity."""
        speeds = (
            Coordinate(f"velocity_{axis}", f"velocity along {axis}", -FASTEST, FASTEST, "velocity") for axis in "xy"
        )
        return *PLACE, *speeds

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """The given states."""
        x, y, vx, vy = np.broadcast_arrays(*values)
        positions = complex_of(x, y)
        return Starts.of(positions, complex_of(vx, vy), within(positions)).at(instant)

    def apply(self, machine: Subject, *values: float | str, instant: float | str = 0.0) -> tuple[Rotor, State]:
        """See :meth:`carom.disturbances.Disturbance.apply`; the state may lie in a compliant touchdown bearing."""
        from carom.models import rotor_of
        from carom.motions.starts import State

        rotor = rotor_of(machine)
        x, y, vx, vy, begun = self.whole(values, instant, rotor.scales)
        if (radius := math.hypot(x, y)) > 1.0 + 1e-12 and not rotor.system.arrays.stiffness.any():
            raise InputError(
                "start", f"|U| = {radius:.6g}", f"must lie inside the wall, |U| <= 1 (here |U| = {radius:.6g})"
            )
        return rotor, State(complex(x, y), complex(vx, vy), time=begun)

    def echo(self, rotor: Rotor, *values: float) -> Echo:
        """See :meth:`carom.disturbances.Disturbance.echo`."""
        x, y, vx, vy = values
        begun = moving(complex(x, y), complex(vx, vy), rotor.scales)
        counted = angles_words(rotor.unbalance_phase, " at the start")
        return Echo(self.kind, f"Start: {begun.words}; {counted}", begun.sizes)


@dataclass(frozen=True)
class Whirl(Disturbance):
    """A whirl about the centre of the bearing, as it is at one instant, when the co-rotating frame coincides with the fixed one.

    What does not move with the rotor, such as a mount, is at rest.
    """

    kind: ClassVar[str] = "whirl"
    noun: ClassVar[str] = "whirls"
    many: ClassVar[bool] = False
    parts: ClassVar = (
        Part("radius", "RADIUS", "length", optional=False),
        Part("speed", "SPEED", "speed", optional=False),
        Part("angle", "ANGLE", "angle", 0.0),
    )
    example: ClassVar = "'0.1 mm,-80 Hz,30 deg'"

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Radius, speed (negative for backward whirl), and where the rotor is."""
        return (
            Coordinate("radius", "radius of the whirl", 0.0, 1.0, "length", over_disc=True),
            Coordinate("speed", "speed of the whirl", -1.0, 1.0, "speed"),
            angle_coordinate("angle", "angle of the position"),
        )

    def whole(
        self, values: Sequence[float | str], instant: float | str = 0.0, scales: Scales | None = None
    ) -> tuple[float, ...]:
        """See :meth:`carom.disturbances.Disturbance.whole`."""
        found = super().whole(values, instant, scales)
        if not 0.0 <= found[0] <= 1.0:
            raise InputError("whirl radius", values[0], "must be from 0 to the clearance")
        return found

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """The rotor displaced and moving as a whole."""
        radius, speed, angle = np.broadcast_arrays(*values)
        cosine, sine, moves = np.cos(angle), np.sin(angle), rotor.system.translated
        places, speeds = complex_of(radius * cosine, radius * sine), radius * (speed - 1.0)
        found = Starts.of(places, complex_of(-speeds * sine, speeds * cosine), within(places)).at(instant)
        each = moves if len(moves) > 1 else moves[0]
        positions, velocities = (np.multiply.outer(one, each) for one in (found.positions, found.velocities))
        return found._replace(positions=positions, velocities=velocities)


@checked
def whirl(radius: float | str, speed: float | str, angle: float | str = 0.0) -> Single:
    """Whirl about the centre of the bearing, as it is at one instant.

    Parameters
    ----------
    radius : float or str
        In clearances, or text with a unit, such as ``"0.1 mm"``.
    speed : float or str
        In ``Ω``, or text with a unit, such as ``"80 Hz"``; negative for backward whirl.
    angle : float or str
        Where the rotor is, in the fixed frame: in rad, or text with a unit.
    """
    return Single(Whirl(), (radius, speed, angle))
