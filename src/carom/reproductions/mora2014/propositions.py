"""Propositions 4.1 and 4.3 of the source paper as computations, each tested on a machine.

They concern single-impact orbits along the damping ``γ``, with ``γ* = √(ρ² − (1 − ω²)²)`` where the contact-free
equilibrium meets the wall and ``N`` pairs of periods.
"""

from __future__ import annotations

from dataclasses import dataclass

from carom.base.outcome import InputError
from carom.closed_forms.local import ContactSystem, LocalCycle, non_smooth_hopf
from carom.closed_forms.thresholds import ranges_of
from carom.models import jeffcott
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
    levitates : bool
        Whether the contact-free equilibrium is admissible.
    """

    pairs: int
    total: int
    outward: int
    admissible: int
    levitates: bool


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
    rotor = jeffcott(parameters)
    found = find_orbits(rotor)
    orbits = [orbit for orbit in found if orbit.slip > 0]
    return FixedPoints(
        pairs=(len(found.periods) + 1) // 2,
        total=len(orbits),
        outward=sum(orbit.radial_speed > 0.0 for orbit in orbits),
        admissible=sum(orbit.admissible for orbit in orbits),
        levitates=abs(rotor.equilibrium) < 1.0,
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
    system = ContactSystem.of_rotor(parameters.replace(gamma=wall.value))
    hopf = non_smooth_hopf(system, -1j * system.equilibrium / system.stiffness)
    return HopfSide(wall.value, hopf.cycles)
