"""Every number that the source paper prints, compared with ours."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal
from typing import Literal

from carom.models import Jeffcott
from carom.orbits.single_impact import find_orbits
from carom.parameters import Machine
from carom.reproductions.mora2014.branches import FirstPair
from carom.reproductions.mora2014.plane import DampingStiffnessPlane
from carom.reproductions.mora2014.propositions import fixed_points
from carom.reproductions.mora2014.source import GIVEN, machine_at


@dataclass(frozen=True)
class PrintedNumber:
    """A number of the source paper and what carom computes for it.

    Attributes
    ----------
    place : str
        Where it is printed.
    quantity : str
    kind : {"computed", "counted", "given"}
        Given numbers are inputs: parameters of the machine, and those for which a figure is drawn.
    printed : str
        The number with the digits printed.
    unit : str
        Empty for dimensionless numbers.
    value : float
    note : str
    """

    place: str
    quantity: str
    kind: Literal["computed", "counted", "given"]
    printed: str
    unit: str
    value: float
    note: str = ""

    @property
    def shown(self) -> str:
        """The printed number with its unit."""
        return f"{self.printed} {self.unit}".rstrip()

    @property
    def printed_value(self) -> float:
        """The printed number."""
        return float(Decimal(self.printed))

    @property
    def difference(self) -> float:
        """Ours minus the printed one."""
        return self.value - self.printed_value

    @property
    def agrees(self) -> bool:
        """Whether ours, rounded to the digits printed, is the printed one."""
        half_a_unit = 0.5 * 10.0 ** int(Decimal(self.printed).as_tuple().exponent)
        return abs(self.difference) <= (0.0 if self.kind == "counted" else 1.001 * half_a_unit)


def numbers(pair: FirstPair, plane: DampingStiffnessPlane) -> tuple[PrintedNumber, ...]:
    """List the printed numbers in the order of the text; those on orbits come from figures 4 and 6b."""
    return (*_scaling(), *_along_damping(pair), *_counts(pair), *_in_the_plane(plane), *_given())


def _computed(place: str, quantity: str, printed: str, value: float, note: str = "") -> PrintedNumber:
    return PrintedNumber(place, quantity, "computed", printed, "", value, note)


def _counted(place: str, quantity: str, printed: str, value: int, note: str = "") -> PrintedNumber:
    return PrintedNumber(place, quantity, "counted", printed, "", value, note)


def _scaling() -> Iterator[PrintedNumber]:
    """Section 2: the dimensionless parameters, from the SI ones."""
    machine = Machine(**GIVEN).parameters
    yield _computed("section 2", "damping γ = c/(mΩ)", "0.152", machine.gamma)
    note = "the figures use the rounded value, and so do we"
    yield _computed("section 2", "stiffness ω = √(k/m)/Ω", "0.76", machine.omega, note)
    note = "3/7, cut off instead of rounded (0.429)"
    yield _computed("section 2", "unbalance ρ = e_c/c_r", "0.428", machine.rho, note)
    yield _computed("section 2", "radius of the rotor R/c_r", "57.143", machine.radius_ratio)


def _along_damping(branches: FirstPair) -> Iterator[PrintedNumber]:
    """Sections 3 and 4: special points of the first pair of orbits."""
    fold = branches.special("fold", "d")
    birth = branches.hopf.gamma
    boundary = "γ_DIB, where the contact-free equilibrium meets the wall"
    for place in ("figure 3b", "figure 4a, b", "figure 5a"):
        yield _computed(place, boundary, "0.072", birth, "√(ρ² − (1 − ω²)²)")
    meeting, note = "γ_F,1, where the orbits of the first pair meet", f"at T = {fold.period:.7f}"
    for place in ("section 4, below (4.8)", "figure 3b", "figure 5"):
        yield _computed(place, meeting, "0.178", fold.value, note)
    apart = branches.special("speed-fold", "c").value
    for place in ("section 4, below (4.9)", "figure 4a"):
        yield _computed(place, "γ_F⁻, where B1,a and B1,c meet", "-0.497", apart)
    grazing = branches.special("grazing", "d")
    for place in ("section 4, below Proposition 4.3", "figure 5b"):
        yield _computed(place, "γ_graze, where B1,d grazes", "0.0636", grazing.value, f"at T = {grazing.period:.7f}")
    extremum = branches.special("radius-extremum", "d").value
    yield _computed("figure 5b", "γ where r(t) on B1,d gains a maximum and a minimum", "0.0785", extremum)
    doubling = branches.special("period-doubling", "d").value
    note = "a multiplier −1: period doubling, which the text does not name"
    yield _computed("section 4a", "γ above which B1,d is stable", "0.083", doubling, note)
    yield _computed("figure 6a", "γ above which B1,d is stable", "0.0834", doubling, note)


def _counts(branches: FirstPair) -> Iterator[PrintedNumber]:
    """Numbers of orbits, and the bound of section 4 on the angular speed."""
    found = fixed_points(machine_at(0.1))
    yield _counted("section 4, notation", "N, pairs of periods at γ = 0.1", "1", found.pairs)
    most = "most fixed points for N = 1 (\u201cup to 2N\u201d)"
    yield _counted("Proposition 4.1", most, "2", found.total, "misprint: 4N")
    born = sum(cycle.criticality == "subcritical" for cycle in branches.hopf.cycles)
    small = [
        orbit
        for orbit in find_orbits(Jeffcott(machine_at(branches.hopf.gamma + 1e-6)))
        if orbit.name.pair == 1 and not orbit.name.faster
    ]
    unstable = sum(orbit.admissible and not orbit.stable for orbit in small)
    created, note = "limit cycles created at γ_DIB on the side of levitation", "of them unstable; the text has both so"
    yield _counted("Proposition 4.3, section 6", created, "2", born, f"{unstable} {note}")
    at = machine_at(0.1)
    bound = -(at.radius_ratio + 1.0) + at.mu * (1.0 + at.d) * 50.0
    note = "printed as sufficient, and it is; −42.5 without the 1 that (2.3) lacks"
    yield _computed("section 4, below (4.11)", "θ̇ above which slip stays forward for all ṙ < 50", "-40", bound, note)


def _in_the_plane(plane: DampingStiffnessPlane) -> Iterator[PrintedNumber]:
    """Section 4b: the point where the curves of figure 6b meet."""
    gamma, omega = plane.meeting("fold", "boundary-equilibrium").value
    yield _computed("section 4b", "γ where γ_F,1 and γ* coincide", "0.178", gamma)
    yield _computed("section 4b", "ω where γ_F,1 and γ* coincide", "0.781", omega)
    sources = {region.motions.source_region for region in plane.regions}
    yield _counted("section 4b", "regions R1 to R4", "4", len(sources), f"{len(plane.regions)} with ours")


_GIVEN_SI = (
    ("mass", "m", "50", "kg"),
    ("damping", "c", "1400", "N s/m"),
    ("stiffness", "k", "9.8e5", "N/m"),
    ("eccentricity", "e_c", "0.3e-3", "m"),
    ("clearance", "c_r", "0.7e-3", "m"),
    ("rotor_radius", "R", "0.4e-1", "m"),
    ("unbalance_phase", "φ", "0.21", "rad"),
    ("speed", "Ω", "184.2", "rad/s"),
    ("friction", "μ", "0.15", ""),
    ("restitution", "d", "0.95", ""),
)
_GIVEN_DAMPINGS = (
    ("figure 2a", "0.3"),
    ("figure 2b", "0.065"),
    ("figure 2c", "0.1"),
    ("figure 3a", "0.1"),
    ("figure 3a", "0.05"),
)


def _given() -> Iterator[PrintedNumber]:
    """Numbers that are used as given."""
    for name, symbol, printed, unit in _GIVEN_SI:
        yield PrintedNumber("section 2", symbol, "given", printed, unit, GIVEN[name])
    for place, printed in _GIVEN_DAMPINGS:
        yield PrintedNumber(place, "γ", "given", printed, "", machine_at(float(printed)).gamma)
    figures = machine_at(0.1)
    yield PrintedNumber("figures 2 to 6", "ω", "given", "0.76", "", figures.omega)
    yield PrintedNumber("figure 3, section 4b", "μ", "given", "0.15", "", figures.mu)
    yield PrintedNumber("figure 3, section 4b", "d", "given", "0.95", "", figures.d)
    yield PrintedNumber("section 4b", "ρ = 3/7", "given", str(Decimal(3) / Decimal(7)), "", figures.rho)
