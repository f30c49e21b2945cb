r"""Pressure between a ball and the inner race of a touchdown bearing, by Hertz.

Two bodies touch in a point, with the relative curvatures ``A₁ ≥ A₂`` in two perpendicular directions.  A force ``F`` flattens them over
an ellipse with the semi-axes ``a ≥ b``, with the pressure ``p√(1 − x²/a² − y²/b²)``, ``p = 3F/(2πab)``.  That pressure moves the surface of
a half-space by a quadratic function of the place [1]_ (ch. 4), and it takes out the curvatures if

    A₂ = F R_D(0, b², a²)/(πE*),      A₁ = F R_D(0, a², b²)/(πE*),      1/E* = (1 − ν²)(1/E₁ + 1/E₂),

with Carlson's integral ``R_D(x, y, z) = 3/2 ∫₀^∞ dw/((w + z)√((w + x)(w + y)(w + z)))``.  ``A₁/A₂ = R_D(0, 1, κ²)/R_D(0, κ², 1)`` decides the
ratio ``κ = b/a``, then ``a³ = F R_D(0, κ², 1)/(πE*A₂)``.

The curvatures of a ball of the diameter ``D`` on an inner race of the diameter ``d``, in a groove with the radius ``fD``, are
``A₁ = 2/D + 2/d`` along the race and ``A₂ = (2 − 1/f)/D`` across it.  Of ``Z`` balls under a radial force ``F`` the most loaded one bears
``5F/Z``: Stribeck's rule, which allows for usual internal clearance (4.37 without any) [2]_.  Inertia of balls and race, contact angle and
preload are left out.

.. [1] Johnson, "Contact Mechanics", Cambridge University Press (1985).
.. [2] Stribeck, "Kugellager für beliebige Belastungen", Zeitschrift des VDI 45 (1901).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.special import elliprd  # type: ignore[import-untyped]

from carom.base.arguments import NotNegative, Positive, checked
from carom.base.roots import bracketed_root
from carom.parameters import TouchdownBearing

STRIBECK = 5.0
"""Force on the most loaded ball, times the number of balls, over the radial force."""
STEEL = 208e9
"""Elastic modulus of bearing steel, Pa."""
POISSON = 0.3
CONFORMITY = 0.52
"""Radius of a groove over the ball diameter of a usual bearing."""
_FLATTEST = 1e-8
"""Ratio of the axes of an ellipse below which none is sought."""


@dataclass(frozen=True)
class PointContact:
    """An elastic contact in a point, in the units of what it was made from.

    Attributes
    ----------
    pressure : float
        Largest pressure, in the middle.
    longer, shorter : float
        Semi-axes of the ellipse.
    """

    pressure: float
    longer: float
    shorter: float


@checked
def point_contact(force: NotNegative, curvatures: tuple[Positive, Positive], modulus: Positive) -> PointContact:
    """Two bodies pressed on each other, in any units that fit together.

    Parameters
    ----------
    curvatures : tuple of float
        Relative curvatures in two perpendicular directions, the sums of those of both bodies.
    modulus : float
        Contact modulus ``E*``.
    """
    low, high = sorted(curvatures)

    def excess(logarithm: float) -> float:
        ratio = math.exp(logarithm)
        return math.log(elliprd(0.0, 1.0, ratio**2) / elliprd(0.0, ratio**2, 1.0)) - math.log(high / low)

    ratio = 1.0 if high == low else math.exp(bracketed_root(excess, math.log(_FLATTEST), 0.0))
    longer = (force * float(elliprd(0.0, ratio**2, 1.0)) / (math.pi * modulus * low)) ** (1.0 / 3.0)
    shorter = ratio * longer
    pressure = 1.5 * force / (math.pi * longer * shorter) if force > 0.0 else 0.0
    return PointContact(pressure, longer, shorter)


@checked
def ball_pressure(bearing: TouchdownBearing, force: NotNegative) -> float | None:
    """Largest pressure between the most loaded ball and the inner race, in Pa; ``None`` if the bearing does not state its balls.

    Parameters
    ----------
    force : float
        Radial force on the bearing, N.
    """
    if bearing.balls is None or bearing.ball_diameter is None or bearing.race_diameter is None:
        return None
    along = 2.0 / bearing.ball_diameter + 2.0 / bearing.race_diameter
    across = (2.0 - 1.0 / (bearing.conformity or CONFORMITY)) / bearing.ball_diameter
    moduli = (bearing.ball_modulus or STEEL, bearing.race_modulus or STEEL)
    modulus = 1.0 / ((1.0 - POISSON**2) * sum(1.0 / each for each in moduli))
    return point_contact(STRIBECK * force / bearing.balls, (along, across), modulus).pressure
