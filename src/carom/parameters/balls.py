r"""Balls of a touchdown bearing: pressure and approach by Hertz, force of all balls, and inertia of what rolls.

*A contact.*  Two bodies touch in a point, with the relative curvatures ``A₁ ≥ A₂`` in two perpendicular directions.  A force ``F`` flattens them over
an ellipse with the semi-axes ``a ≥ b``, with the pressure ``p√(1 − x²/a² − y²/b²)``, ``p = 3F/(2πab)``.  That pressure moves the surface of
a half-space by a quadratic function of the place [1]_ (ch. 4), and it takes out the curvatures if

    A₂ = F R_D(0, b², a²)/(πE*),      A₁ = F R_D(0, a², b²)/(πE*),      1/E* = (1 − ν²)(1/E₁ + 1/E₂),

with Carlson's integral ``R_D(x, y, z) = 3/2 ∫₀^∞ dw/((w + z)√((w + x)(w + y)(w + z)))``.  ``A₁/A₂ = R_D(0, 1, κ²)/R_D(0, κ², 1)`` decides the
ratio ``κ = b/a``, then ``a³ = F R_D(0, κ², 1)/(πE*A₂)``.  The bodies approach by ``3F R_F(0, a², b²)/(2πE*)``, which grows like ``F^(2/3)``.

The curvatures of a ball of the diameter ``D``, on a pitch circle of the diameter ``d_m`` and under the contact angle ``α``, in a groove with the
radius ``fD``, are ``(2 − 1/f)/D`` across the race and ``2/D ± 2cos α/(d_m ∓ D cos α)`` along the inner (upper sign) and outer race.  Both
contacts together bear ``Q = Kδ^(3/2)``.

*All balls.*  The race is moved by ``x`` against a ball and by ``z`` along the axis.  With a diametral clearance ``P_d`` the ball at the angle ``ψ``
from that direction is pressed by ``δ = A cos ψ + B``, ``A = x cos α``, ``B = z sin α − ½P_d cos α``, where that is above zero.  The mean of the
force over all places of ``Z`` balls is

    F = Z K cos α (A + B)^(3/2) J(ε),      ε = (A + B)/(2A),

with Sjövall's integral [2]_ ``J(ε) = 1/(2π) ∮ max(1 − (1 − cos ψ)/(2ε), 0)^(3/2) cos ψ dψ``.  With ``sin ½ψ = √ε sin θ`` up to
``ε = 1``, and ``ψ = 2θ`` above, both parts become a sum of hypergeometric functions that are one:

    J(ε) = ⅜ √ε ₂F₁(−½, 3/2; 3; ε),  ε ≤ 1,      J(ε) = ⅜ ε⁻¹ ₂F₁(−½, 3/2; 3; 1/ε),  ε ≥ 1.

Without clearance and preload ``ε = ½``, ``J = 0.22883`` and the most loaded of many balls bears ``4.37 F/(Z cos α)`` (Stribeck).

*Inertia.*  The inner race turns at ``ω`` and touches the balls at the radius ``r = ½(d_m − D cos α)``; the outer race stands still.  A ball that rolls on it
turns about an axis through that contact at ``ωr/D``, so that with ``7/5`` of ``m(D/2)²`` about that axis its energy is ``½ · 0.35 m r² ω²``.  In terms of its
centre, ``½m(ω½r)² + ½J_b(ωr/D)²``: the spin that counts is that in space, not that in the cage.

Races stay round; balls stay evenly spaced; their weight, centrifugal force and gyroscopic moment, the cage, the oil film and the growth of the contact
angle under load are left out.

.. [1] Johnson, "Contact Mechanics", Cambridge University Press (1985).
.. [2] Sjövall, "The load distribution within ball and roller bearings under given external radial and axial load", Teknisk Tidskrift (1933).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.special import elliprd, elliprf, hyp2f1  # type: ignore[import-untyped]

from carom.base.arguments import NotNegative, Positive, checked
from carom.base.roots import bracketed_root
from carom.parameters.formats import number

STEEL = 208e9
"""Elastic modulus of bearing steel, Pa."""
POISSON = 0.3
CONFORMITY = 0.52
"""Radius of a groove over the ball diameter of a usual bearing."""
STATIC = 4.2e9
"""Pressure, Pa, by which ISO 76 defines the static rating of ball bearings."""
RANGE = 100.0
"""Largest force over the smallest between which a power law is fitted."""
_SAMPLES = 65
"""Forces at which the law is compared with the balls."""
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
    approach : float
        By how much distant points of the two bodies come closer.
    """

    pressure: float
    longer: float
    shorter: float
    approach: float


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
    if force == 0.0:
        return PointContact(0.0, longer, shorter, 0.0)
    approach = 1.5 * force * float(elliprf(0.0, longer**2, shorter**2)) / (math.pi * modulus)
    return PointContact(1.5 * force / (math.pi * longer * shorter), longer, shorter, approach)


@checked
def load_integral(load_zone: Positive) -> float:
    """Sjövall's integral ``J(ε)`` of point contacts: the radial force over that of all balls if each bore the largest load.

    Parameters
    ----------
    load_zone : float
        ``ε``, the part of the diameter over which balls are pressed; above 1 all are.

    Examples
    --------
    >>> from carom.closed_forms import load_integral
    >>> round(load_integral(0.5), 4), round(load_integral(1.0), 4)
    (0.2288, 0.2546)
    """
    turned, factor = (load_zone, math.sqrt(load_zone)) if load_zone <= 1.0 else (1.0 / load_zone, 1.0 / load_zone)
    return 0.375 * factor * float(hyp2f1(-0.5, 1.5, 3.0, turned))


class PowerLaw(NamedTuple):
    """The force ``kδⁿ`` nearest to that of all balls, in SI units."""

    stiffness: float
    exponent: float
    error: float
    """Largest difference of the force of all balls, with a ball or a gap in its direction, over that of the law."""
    lowest: float
    highest: float
    """Forces between which that holds, N: at the highest one the most loaded ball reaches the static pressure."""

    @property
    def words(self) -> str:
        """Stiffness and exponent, how near they are, and where."""
        return (
            f"{number(self.stiffness, 4)} N/m^{number(self.exponent, 4)}, within {number(100.0 * self.error, 2)} % "
            f"of the force of all balls from {number(self.lowest, 3)} to {number(self.highest, 3)} N"
        )


@dataclass(frozen=True)
class BallRing:
    """The balls of a bearing between round races under a radial force, in SI units.

    Attributes
    ----------
    balls, rows : int
        Number of balls in all rows, and of rows, which share the force evenly.
    ball_diameter, race_diameter : float
        Diameter of a ball, and of the inner race at the bottom of its groove, m.
    contact_angle : float
        Rad.
    conformities : tuple of float
        Radii of the grooves of inner and outer race over the diameter of a ball.
    internal_clearance : float
        Diametral, m.
    preload : float
        Axial force on each row, N.  The axial position that it gives stays under the radial force.
    moduli : tuple of float
        Elastic moduli of balls and races, Pa.
    """

    balls: int
    ball_diameter: float
    race_diameter: float
    contact_angle: float = 0.0
    conformities: tuple[float, float] = (CONFORMITY, CONFORMITY)
    internal_clearance: float = 0.0
    preload: float = 0.0
    rows: int = 1
    moduli: tuple[float, float] = (STEEL, STEEL)

    @property
    def pitch_diameter(self) -> float:
        """``d_m``, m."""
        return self.race_diameter + self.ball_diameter

    @property
    def _steepness(self) -> float:
        return math.cos(self.contact_angle)

    @cached_property
    def _contacts(self) -> tuple[PointContact, PointContact]:
        """Contacts of a ball with the inner and the outer race under 1 N."""
        modulus = 1.0 / ((1.0 - POISSON**2) * sum(1.0 / each for each in self.moduli))
        size = self.ball_diameter
        inner, outer = (
            point_contact(1.0, (2.0 / size + 2.0 * side / (self.pitch_diameter / self._steepness - side * size), (2.0 - 1.0 / conformity) / size), modulus)
            for side, conformity in zip((1.0, -1.0), self.conformities, strict=True)
        )  # fmt: skip
        return inner, outer

    @cached_property
    def ball_stiffness(self) -> float:
        """``K`` of the force ``Kδ^(3/2)`` between the races at one ball, N/m^1.5."""
        return float(sum(each.approach for each in self._contacts) ** -1.5)

    @cached_property
    def closure(self) -> float:
        """``B``: by how much each ball is pressed in where the race is centred, m; negative with clearance."""
        if self.preload == 0.0:
            return -0.5 * self.internal_clearance * self._steepness
        on_ball = self.preload * self.rows / (self.balls * math.sin(self.contact_angle))
        return float((on_ball / self.ball_stiffness) ** (2.0 / 3.0))

    @property
    def is_overloaded(self) -> bool:
        """Whether the preload alone presses the balls with 4.2 GPa (ISO 76)."""
        return self.pressure(0.0) >= STATIC

    @checked
    def force(self, depth: NotNegative) -> float:
        """Return the radial force, N, as its mean over all places of the balls.

        Parameters
        ----------
        depth : float
            Displacement of the race, m, from where the first ball is pressed: from the centre, or with clearance from its end.
        """
        moved, largest = (depth * self._steepness + max(sign * self.closure, 0.0) for sign in (-1.0, 1.0))
        if depth == 0.0:
            return 0.0
        whole = self.balls * self.ball_stiffness * self._steepness
        return whole * largest**1.5 * load_integral(largest / (2.0 * moved))

    @checked
    def ball_loads(self, depth: NotNegative, turned: float = 0.0) -> np.ndarray:
        """Return the load of each ball of a row, N, at the displacement in :meth:`force`; the first ball is at the angle ``turned`` from its direction, rad."""
        places, gap = self._places(turned), max(-self.closure, 0.0)
        pressed = depth * self._steepness * np.cos(places) - 2.0 * gap * np.sin(0.5 * places) ** 2
        pressed += max(self.closure, 0.0)
        return np.asarray(self.ball_stiffness * np.maximum(pressed, 0.0) ** 1.5)

    def _places(self, turned: float) -> np.ndarray:
        return turned + np.arange(self.balls // self.rows) * (2.0 * math.pi * self.rows / self.balls)

    def _sum(self, depth: float, turned: float) -> float:
        """Radial force of the balls at these places, N."""
        loads = self.ball_loads(depth, turned)
        return self.rows * self._steepness * float(loads @ np.cos(self._places(turned)))

    @checked
    def largest_load(self, force: NotNegative) -> float:
        """Return the largest load of a ball, N, under a radial force, N: with a ball in its direction, which is the worst place of five balls or more."""
        if force == 0.0:
            return float(self.ball_loads(0.0)[0])
        # One ball alone would have to be pressed in further.
        alone = force / (self.rows * self.ball_stiffness * self._steepness) + max(self.closure, 0.0) ** 1.5
        deepest = (alone ** (2.0 / 3.0) - max(self.closure, 0.0)) / self._steepness
        depth = bracketed_root(lambda depth: self._sum(depth, 0.0) - force, 0.0, deepest * (1.0 + 1e-9))
        return float(self.ball_loads(depth)[0])

    @checked
    def pressure(self, force: NotNegative) -> float:
        """Return the largest pressure between a ball and a race, Pa, under a radial force, N."""
        return self.pressure_of(self.largest_load(force))

    def pressure_of(self, load: float) -> float:
        """Pressure, Pa, at a ball with this load, N."""
        return float(max(each.pressure for each in self._contacts) * load ** (1.0 / 3.0))

    @cached_property
    def law(self) -> PowerLaw:
        """The power law between the force at which a ball reaches 4.2 GPa (ISO 76) and a hundredth of it; exactly 3/2 without clearance and preload.

        Its exponent is that between the ends, at least 1, its stiffness halves the largest error of the mean over all places of the balls.
        """
        bound = (STATIC / self.pressure_of(1.0)) ** 3
        deepest = ((bound / self.ball_stiffness) ** (2.0 / 3.0) - max(self.closure, 0.0)) / self._steepness
        highest = self.force(deepest)
        least = bracketed_root(lambda depth: self.force(depth) - highest / RANGE, 0.0, deepest)
        depths = np.geomspace(least, deepest, _SAMPLES)
        forces = np.array([self.force(depth) for depth in depths.tolist()])
        # Below 1, of a preload that balls on the other side leave, the force would begin with an infinite slope.
        exponent = 1.5 if self.closure == 0.0 else max(math.log(RANGE) / math.log(deepest / least), 1.0)
        ratios = forces / depths**exponent
        stiffness = math.sqrt(float(ratios.min() * ratios.max()))
        errors = [
            abs(self._sum(depth, turned) / (stiffness * depth**exponent) - 1.0)
            for depth in depths.tolist()
            for turned in (0.0, math.pi * self.rows / self.balls)
        ]
        return PowerLaw(stiffness, exponent, max(errors), highest / RANGE, highest)

    @checked
    def inertia(self, density: Positive) -> float:
        """Return the moment of inertia, kg m², that all balls of a density, kg/m³, add to the inner race, rolling on an outer race that stands still."""
        mass = self.balls * density * math.pi / 6.0 * self.ball_diameter**3
        return 0.35 * mass * (0.5 * (self.pitch_diameter - self.ball_diameter * self._steepness)) ** 2
