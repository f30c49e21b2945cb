"""A Kelvin–Voigt wall without tension: the force ``κδ + cδ̇`` while that is positive, on a plane that is ``δ`` deep in the wall.

Where the force vanishes before the depth does, wall and rotor separate: the wall comes back more slowly than the rotor leaves it.
"""

from __future__ import annotations

from carom.compiling.decorators import formula
from carom.core.laws.yielding import no_impulse

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
