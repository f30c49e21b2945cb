"""Least indentation of a wall of solid steel: where it is large, a rigid wall is not a valid model.

The package treats the wall as rigid: its indentation is assumed to be much smaller than the clearance.  No wall of a
touchdown bearing is stiffer than a block of solid steel, ``E = 210 GPa``.  The length of the line of contact is taken
as the shaft diameter, ``2R``.  The stiffness is then about ``k = 2RE``: for two cylinders pressed together along a line
(Hertz; K. L. Johnson, Contact Mechanics, 1985, section 5.6) the approach is ``F/(2RE)`` times a factor of one to about
eight, which is larger for a smaller contact.  So lower bounds of the indentation are

    δ = F/(2RE)  under a force,      δ = v√(m/(2RE))  in an impact at the speed v  (all kinetic energy in the spring)

If a bound exceeds a tenth of the clearance, forces that grow with the radius of the whirl have errors of that order.
Real walls are softer by orders of magnitude, so they are then far from rigid.
"""

from __future__ import annotations

import math

from carom.parameters.numbers import Parameters
from carom.parameters.scaling import Scales

STEEL = 2.1e11
"""Young's modulus of steel, Pa."""
LARGEST = 0.1
"""Largest indentation, as a share of the clearance, at which a wall counts as rigid."""


def indentation_of_force(parameters: Parameters | None, force: float) -> float:
    """Least indentation of the wall, in clearances, under a force in ``m c_r Ω²``; ``nan`` without scales, or parameters of the planar rotor."""
    if not isinstance(parameters, Parameters) or parameters.scales is None:
        return math.nan
    scales = parameters.scales
    return force * scales.force / (_stiffness(scales, parameters.radius_ratio) * scales.clearance)


def indentation_of_impact(parameters: Parameters | None, radial_speed: float) -> float:
    """Least indentation, in clearances, in an impact at a radial speed in ``c_r Ω``; ``nan`` without these too."""
    if not isinstance(parameters, Parameters) or parameters.scales is None:
        return math.nan
    scales = parameters.scales
    return radial_speed * scales.speed * math.sqrt(scales.mass / _stiffness(scales, parameters.radius_ratio))


def is_compliant(indentation: float) -> bool:
    """Whether an indentation, in clearances, is too large for a rigid wall; false if it is unknown (``nan``)."""
    return indentation > LARGEST


def _stiffness(scales: Scales, radius_ratio: float) -> float:
    """Stiffness of a wall of solid steel, N/m."""
    return 2.0 * radius_ratio * scales.clearance * STEEL
