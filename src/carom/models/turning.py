"""What turns, and changes its speed by friction: a shaft, which its drive turns, and the races of touchdown bearings, which drag slows down."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from carom.base.arguments import NotNegative, Positive, checked


@checked
@dataclass(frozen=True)
class Shaft:
    """What turns with the shaft, and its drive; without it the speed of a rotor never changes.

    In contact the torque of friction, at the rotor's radius, and that of the drive change the speed.  In flight the speed stays as it
    is; the energy ledger says what the drive would do there.  The unbalance follows the speed; the torque with which it acts back on the shaft
    is left out.

    Attributes
    ----------
    inertia : float
        Polar moment of inertia in ``m c_r²``, with the unit ``m`` of the rotor's masses.
    torque : float
        Torque of the drive in contact, in ``m c_r² Ω²``.
    brake, drag, windage : float
        Torques against the rotation that count in a spin-down alone (:func:`carom.motions.spin_down`): one that is constant, in ``m c_r² Ω²``, and
        what others are per speed, in ``m c_r² Ω``, and per squared speed, in ``m c_r²``.
    in_stages : bool
        Whether the modes are those of one speed, from which that of the shaft departs little: gyroscopic moments are those of that speed.
    """

    inertia: Positive
    torque: float = 0.0
    brake: NotNegative = 0.0
    drag: NotNegative = 0.0
    windage: NotNegative = 0.0
    in_stages: bool = False

    def at_speed(self, factor: float) -> Shaft:
        """Return the same at a nominal speed that is larger by a factor."""
        return replace(self, torque=self.torque / factor**2, brake=self.brake / factor**2, drag=self.drag / factor)

    @property
    def turns_freely(self) -> bool:
        """Whether nothing but friction in contact changes its speed."""
        return not (self.torque or self.brake or self.drag or self.windage)

    def rate(self, speed: float) -> float:
        """Rate of the speed by all torques but friction in contact, in ``Ω²``."""
        return (self.torque - self.brake - (self.drag + self.windage * speed) * speed) / self.inertia


@dataclass(frozen=True, eq=False)
class ShaftModes:
    """The two modes of a shaft: the direction of its unbalance, and its speed; neither moves a plane.

    Attributes
    ----------
    shaft : Shaft
    accelerations : ndarray of complex, shape (n,)
        Of the coordinates by the unbalance at the nominal speed.
    """

    shaft: Shaft
    accelerations: np.ndarray

    @property
    def drive(self) -> float:
        """Rate of the speed by the torque of the drive."""
        return self.shaft.torque / self.shaft.inertia

    def gains(self, masses: np.ndarray, radii: np.ndarray) -> np.ndarray:
        """Change of the speed by a friction impulse that changes the velocity of a plane with such a mass by one, shape (P,)."""
        return masses * radii / self.shaft.inertia


@checked
@dataclass(frozen=True)
class Race:
    """The inner race of a touchdown bearing, with the balls or rollers that turn with it.

    Attributes
    ----------
    inertia : float
        Moment of inertia about its axis in ``m c_r²``, with the unit ``m`` of the rotor's masses.
    radius : float
        Radius at which it touches the rotor, in clearances.
    drag : float
        Torque that slows it down, by its speed, in ``m c_r² Ω``.
    speed : float
        Speed at the beginning of a motion, in ``Ω``, in the fixed frame.
    """

    inertia: Positive
    radius: Positive
    drag: NotNegative = 0.0
    speed: float = 0.0

    @property
    def exponent(self) -> float:
        """Exponent with which its speed decays without contact, in ``Ω``."""
        return -self.drag / self.inertia

    @property
    def surface_speed(self) -> float:
        """Speed of its surface at the beginning of a motion, in ``c_r Ω``."""
        return self.radius * self.speed

    def gain(self, mass: float) -> float:
        """Change of the speed of its surface by a friction impulse that changes the velocity of a plane with this mass by one."""
        return mass * self.radius**2 / self.inertia

    def at_speed(self, factor: float) -> Race:
        """Return the same at a speed of the shaft that is larger by a factor."""
        return Race(self.inertia, self.radius, self.drag / factor, self.speed / factor)
