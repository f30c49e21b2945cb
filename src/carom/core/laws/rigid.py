"""The rigid wall with Newton's restitution: the rebound has a constant share of the speed of the impact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from carom.base.arguments import checked
from carom.core.compiling.decorators import formula
from carom.core.laws.law import FromZeroToOne, Law


@formula
def impulse(speed, wall):
    """Impulse of an impact with a radial speed."""
    return (1.0 + wall.restitution) * speed


@formula
def impulse_by_speed(speed, wall):
    """Derivative of :func:`impulse` by the speed."""
    return 1.0 + wall.restitution


@formula
def impulse_by_restitution(speed, wall):
    """Derivative of :func:`impulse` by the restitution."""
    return speed


@checked
@dataclass(frozen=True)
class Rigid(Law):
    """A rigid wall: each rebound has a constant share of its speed .

    Attributes
    ----------
    restitution : float
        Coefficient of restitution ``d``, from 0 to 1.
    """

    restitution: FromZeroToOne

    law: ClassVar = "rigid"
    parameters: ClassVar = {"d": "restitution"}
    is_compliant: ClassVar = False

    def numbers(self, mass: float) -> dict[str, float]:
        """Numbers of its wall."""
        return {"restitution": self.restitution}

    def at_speed(self, factor: float) -> Rigid:
        """Return the same at another speed of the shaft."""
        return self
