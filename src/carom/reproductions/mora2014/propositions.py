"""Propositions 4.1 and 4.3 of the source paper as computations, each tested on a machine.

They concern single-impact orbits along the damping ``γ``, with ``γ* = √(ρ² − (1 − ω²)²)`` where the contact-free
equilibrium meets the wall and ``N`` pairs of periods.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import Literal

from carom.base.outcome import InputError
from carom.closed_forms.small_cycles_at_walls import SmallCycle, small_cycles
from carom.closed_forms.thresholds import ranges_of
from carom.models import Rotor, jeffcott
from carom.orbits.single_impact import find_orbits
from carom.parameters import Parameters


@dataclass(frozen=True)
class FixedPoints:
    """Number and admissibility of the fixed points of the impact map (Proposition 4.1).

    Attributes
    ----------
    pairs : int
        ``N``.
    total : int
        Fixed points, virtual ones included: ``4N`` unless two radial speeds have coalesced (the text says ``2N``).
    outward : int
        Those with a positive radial speed: ``2N`` if the contact-free equilibrium is virtual, because the two speeds of
        a period then have opposite signs.
    admissible : int
        Those that are motions of the machine.  The text takes all outward ones as admissible, but some pass beyond the
        wall.
    """

    pairs: int
    total: int
    outward: int
    admissible: int


@dataclass(frozen=True)
class LocalCycle:
    """A family of small impacting cycles, to first order in the distance ``ε`` of a parameter from the bifurcation.

    Attributes
    ----------
    period : float
        ``T``, the same for all sizes.
    radial_slope, angular_slope, angle_slope : float
        ``dṙ/dε``, ``dθ̇/dε`` and ``dθ₀/dε`` of the state just before the impact.
    criticality : {"subcritical", "supercritical"}
        Subcritical: the cycles exist on the side where the contact-free equilibrium is admissible.
    """

    period: float
    radial_slope: float
    angular_slope: float
    angle_slope: float
    criticality: Literal["subcritical", "supercritical"]


@dataclass(frozen=True)
class HopfSide:
    """The non-smooth Hopf bifurcation at ``γ*`` and its side (Proposition 4.3).

    Attributes
    ----------
    gamma : float
        ``γ*``.
    cycles : tuple of LocalCycle
        The cycles that are born, with their slopes along ``γ`` and their criticality.
    """

    gamma: float
    cycles: tuple[LocalCycle, ...]


def fixed_points(parameters: Parameters) -> FixedPoints:
    """Count the fixed points of the impact map with forward slip, and the admissible ones among them."""
    found = find_orbits(jeffcott(parameters))
    orbits = [orbit for orbit in found if orbit.slip > 0]
    return FixedPoints(
        pairs=(len(found.periods) + 1) // 2,
        total=len(orbits),
        outward=sum(orbit.radial_speed > 0.0 for orbit in orbits),
        admissible=sum(orbit.admissible for orbit in orbits),
    )


def hopf_side(parameters: Parameters) -> HopfSide:
    """Find the cycles born where levitation meets the wall as the damping varies, and their side.

    Raises
    ------
    InputError
        The unbalance is too small: the equilibrium meets the wall at no damping.
    """
    ((wall, _),) = ranges_of("contact-free", parameters, "gamma")
    if not wall.kind:
        raise InputError("rho", parameters.rho, f"above |1 - omega^2| = {abs(1.0 - parameters.omega**2):.6g}")
    at = parameters.replace(gamma=wall.value)
    return HopfSide(wall.value, cycles_at_wall(at, -1j / complex(at.omega**2 - 1.0, at.gamma)))


def cycles_at_wall(parameters: Parameters, rate: complex) -> tuple[LocalCycle, ...]:
    """Cycles that are born where levitation meets the wall, as a parameter varies.

    Parameters
    ----------
    parameters : Parameters
        Those there: ``|K| = 1`` for the equilibrium ``K``.
    rate : complex
        ``K'/K`` by the parameter.  Its real part ``κ`` is the rate at which the equilibrium leaves the wall.
    """
    rotor = jeffcott(parameters)
    return tuple(_along(rotor, cycle, rate) for cycle in small_cycles(rotor).cycles)


def _along(rotor: Rotor, cycle: SmallCycle, rate: complex) -> LocalCycle:
    """A small cycle, which is known by the distance of the equilibrium from the wall, by a parameter."""
    arrays = rotor.system.arrays
    normal = cmath.exp(-1j * cmath.phase(rotor.equilibrium))
    outward = -rate.real if cycle.levitating_side else rate.real
    displacement, velocity = (complex(normal * (row @ cycle.state)) for row in (arrays.rows[0], arrays.rate_rows[0]))
    return LocalCycle(
        period=cycle.period,
        radial_slope=outward * velocity.real,
        angular_slope=outward * velocity.imag,
        angle_slope=rate.imag + outward * displacement.imag,
        criticality=cycle.criticality,
    )
