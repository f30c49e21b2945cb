"""Propositions 4.1 to 4.3 of the source paper as computations, each tested on a machine.

They concern single-impact orbits along the damping ``γ``, with ``γ* = √(ρ² − (1 − ω²)²)`` where the contact-free
equilibrium meets the wall and ``N`` pairs of periods.
"""

from __future__ import annotations

from dataclasses import dataclass

from carom.bifurcations import Bifurcation
from carom.bifurcations.words import continue_orbit
from carom.closed_forms.local import ContactSystem, LocalCycle, non_smooth_hopf
from carom.closed_forms.thresholds import ranges_of
from carom.models import jeffcott
from carom.orbits.names import combined
from carom.orbits.single_impact import find_orbits
from carom.outcome import CaromError, InputError
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

    @property
    def words(self) -> str:
        """The result, in a sentence."""
        return (
            f"{self.pairs} pair{'s' * (self.pairs != 1)} of periods give {self.total} fixed points, of which "
            f"{self.outward} meet the wall from inside and {self.admissible} stay inside it between impacts"
        )


@dataclass(frozen=True)
class SimultaneousFolds:
    """Two folds of a pair at one damping (Proposition 4.2).

    Attributes
    ----------
    pair : int
    lower, upper : Bifurcation
        Where ``a`` meets ``b`` and ``c`` meets ``d``.
    """

    pair: int
    lower: Bifurcation
    upper: Bifurcation

    @property
    def distance(self) -> float:
        """Their distance in ``γ``: only rounding errors, as ``F₁`` does not depend on the radial speed."""
        return abs(self.lower.value - self.upper.value)


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

    @property
    def subcritical(self) -> bool:
        """Whether there are cycles and all exist where the rotor levitates, as the text states."""
        return bool(self.cycles) and all(cycle.criticality == "subcritical" for cycle in self.cycles)


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


def simultaneous_folds(parameters: Parameters, pair: int = 1) -> SimultaneousFolds:
    """Find the dampings at which the orbits of a pair vanish as the damping grows.

    Parameters
    ----------
    parameters : Parameters
        With a damping at which the pair exists.

    Raises
    ------
    InputError
        There is no such pair at this damping.
    CaromError
        The pair does not end in two folds.
    """
    orbits = find_orbits(jeffcott(parameters))
    longer = [orbit for orbit in orbits if orbit.slip > 0 and orbit.name.pair == pair and orbit.name.longer]
    if len(longer) != 2:
        names = combined(orbit.name for orbit in orbits)
        raise InputError("pair", pair, f"a pair with orbits at gamma = {parameters.gamma:g}: {names or 'none'}")
    interval = (parameters.gamma, 2.0 * parameters.gamma + 10.0)
    folds = []
    for orbit in longer:
        branch = continue_orbit(orbit, "gamma", interval)
        found = [point for point in branch.special if point.kind == "fold"]
        if not found:
            raise CaromError(f"{orbit.name} meets no other orbit up to gamma = {interval[1]:g}")
        folds.append(found[0])
    return SimultaneousFolds(pair, *folds)


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
