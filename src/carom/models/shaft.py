"""A shaft whose speed changes: friction in contact brakes it, its drive turns it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.base.arguments import Positive, checked


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
    """

    inertia: Positive
    torque: float = 0.0

    def at_speed(self, factor: float) -> Shaft:
        """Return the same at a nominal speed that is larger by a factor."""
        return Shaft(self.inertia, self.torque / factor**2)


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
