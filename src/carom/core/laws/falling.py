"""A restitution that falls with the speed ``ṙ`` of the impact: ``d/(1 + ṙ/v)``, as of a wall that dissipates more in a faster impact.

The law's own number is ``1/v``.  No rebound is faster than ``dv``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from carom.base.arguments import Positive, checked
from carom.core.compiling.decorators import formula
from carom.core.laws.law import FromZeroToOne, Law


@formula
def impulse(speed, wall):
    """Impulse of an impact with a radial speed."""
    return speed + wall.restitution * impulse_by_restitution(speed, wall)


@formula
def impulse_by_speed(speed, wall):
    """Derivative of :func:`impulse` by the speed."""
    less = 1.0 + wall.law_number * abs(speed)
    return 1.0 + wall.restitution / (less * less)


@formula
def impulse_by_restitution(speed, wall):
    """Derivative of :func:`impulse` by the restitution."""
    return speed / (1.0 + wall.law_number * abs(speed))


@checked
@dataclass(frozen=True)
class FallingRestitution(Law):
    """A wall that dissipates more in a faster impact: a restitution ``d/(1 + ṙ/v)`` .

    Attributes
    ----------
    restitution : float
        Coefficient of restitution ``d`` of slow impacts, from 0 to 1.
    speed : float
        Speed ``v`` of the impact at which it is half of that, in ``c_r Ω``.
    """

    restitution: FromZeroToOne
    speed: Positive

    law: ClassVar = "falling"
    parameters: ClassVar = {"d": "restitution"}
    is_compliant: ClassVar = False

    def numbers(self, mass: float) -> dict[str, float]:
        """Numbers of its wall."""
        return {"restitution": self.restitution, "law_number": 1.0 / self.speed}

    def at_speed(self, factor: float) -> FallingRestitution:
        """Return the same at another speed of the shaft."""
        return FallingRestitution(self.restitution, self.speed / factor)
