"""A Kelvin–Voigt wall without tension: the force ``κδ + cδ̇`` while that is positive, on a station that is ``δ`` deep in the wall.

Where the force vanishes before the depth does, wall and rotor separate: the wall comes back more slowly than the rotor leaves it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from carom.base.arguments import NotNegative, Positive, checked
from carom.core.compiling.decorators import formula
from carom.core.laws.compliant import no_impulse
from carom.core.laws.law import Law

impulse = impulse_by_speed = impulse_by_restitution = no_impulse


@formula
def edge(depth, rate, wall):
    """Depth at which the series of the force takes another form; there is none."""
    return 0.0


@formula
def force(depth, rate, wall):
    """Normal force at a depth that grows at a rate."""
    return wall.stiffness * depth + wall.loss * rate


@formula
def force_coefficient(k, depth, rate, power, wall):
    """Taylor coefficient ``k`` of the force from those of depth and rate up to it; the law needs no other series."""
    return wall.stiffness * depth[k] + wall.loss * rate[k]


@formula
def force_change(k, depth, rate, power, depth_change, rate_change, power_change, wall):
    """Coefficient ``k`` of the change of the force, from those of the changes of depth and rate; the law needs no other series."""
    return wall.stiffness * depth_change[k] + wall.loss * rate_change[k]


@formula
def press_coefficient(k, depth, rate, wall):
    """Taylor coefficient ``k`` of what vanishes with the force, at any depth: the force itself."""
    return wall.stiffness * depth[k] + wall.loss * rate[k]


@formula
def press_rounding(of_depth, of_rate, wall):
    """Rounding error of :func:`press_coefficient`, from those of depth and rate."""
    return wall.stiffness * of_depth + wall.loss * of_rate


force_rounding = press_rounding


@formula
def stored_energy(depth, wall):
    """Energy of the wall's spring."""
    return 0.5 * wall.stiffness * depth * depth


@checked
@dataclass(frozen=True)
class KelvinVoigt(Law):
    """A wall on a spring and a damper, which cannot pull: the force ``kδ + cδ̇`` at the depth ``δ`` .

    Attributes
    ----------
    stiffness : float
       ``k`` in ``m Ω²``, with the unit ``m`` of the rotor's masses.
    damping : float
       ``c`` in ``m Ω``.
    """

    stiffness: Positive
    damping: NotNegative

    law: ClassVar = "kelvin_voigt"
    parameters: ClassVar = {"wall_stiffness": "stiffness", "wall_damping": "damping"}

    def numbers(self, mass: float) -> dict[str, float]:
        """Numbers of its wall."""
        return {"stiffness": self.stiffness / mass, "loss": self.damping / mass}

    def at_speed(self, factor: float) -> KelvinVoigt:
        """Return the same at another speed of the shaft."""
        return KelvinVoigt(self.stiffness / factor**2, self.damping / factor)
