"""How far a wall of solid steel gives way at least: where that is much, a rigid wall is no model.

The package takes the wall for rigid: it gives way by much less than the clearance.  No wall of a touchdown bearing is
stiffer than a block of solid steel, ``E = 210 GPa``, and the line of contact is taken as long as the shaft is thick,
``2R``.  Its stiffness is then about ``k = 2RE``: for two cylinders pressed together along a line (Hertz; K. L. Johnson,
Contact Mechanics, 1985, section 5.6) the approach is ``F/(2RE)`` times one to about eight, the more the smaller the
contact.  So

    δ = F/(2RE)  under a force,      δ = v√(m/(2RE))  in a hit at the speed v  (all kinetic energy in the spring)

are what a wall gives way by at least.  Where that is more than a tenth of the clearance, forces that grow with the
radius of the whirl are wrong by as much, and real walls, which are softer by orders of magnitude, are far from rigid.
"""

from __future__ import annotations

import math

from carom.parameters.scaling import Parameters, Scales

__all__ = ["LARGEST", "STEEL", "gives_way", "indentation_of_force", "indentation_of_hit"]

STEEL = 2.1e11
"""Young's modulus of steel, Pa."""
LARGEST = 0.1
"""Share of the clearance up to which a wall that gives way by it passes for rigid."""


def indentation_of_force(parameters: Parameters, force: float) -> float:
    """Least indentation by a force on the wall.

    Parameters
    ----------
    parameters : Parameters
    force : float
        In ``m c_r Ω²``.

    Returns
    -------
    float
        In clearances; ``nan`` where mass, clearance and speed are not known.
    """
    scales = parameters.scales
    if scales is None:
        return math.nan
    return force * scales.force / (_stiffness(scales, parameters.radius_ratio) * scales.clearance)


def indentation_of_hit(parameters: Parameters, radial_speed: float) -> float:
    """Least indentation in an impact at this radial speed in ``c_r Ω``; in clearances, ``nan`` where scales are not known."""
    scales = parameters.scales
    if scales is None:
        return math.nan
    return radial_speed * scales.speed * math.sqrt(scales.mass / _stiffness(scales, parameters.radius_ratio))


def gives_way(indentation: float) -> bool:
    """Whether a wall that gives way by this much, in clearances, is no longer rigid; not where that is unknown."""
    return indentation > LARGEST


def _stiffness(scales: Scales, radius_ratio: float) -> float:
    """Of a wall of solid steel, N/m."""
    return 2.0 * radius_ratio * scales.clearance * STEEL
