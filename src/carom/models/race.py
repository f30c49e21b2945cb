"""The race of a touchdown bearing that turns: friction spins it up, drag slows it down."""

from __future__ import annotations

from dataclasses import dataclass

from carom.base.arguments import NotNegative, Positive, checked


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
