"""Every number that the source paper prints, compared with ours."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from typing import Literal

from carom.models import jeffcott
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import find_orbits
from carom.parameters import Machine
from carom.reproductions.mora2014.branches import FirstPair
from carom.reproductions.mora2014.plane import DampingStiffnessPlane
from carom.reproductions.mora2014.propositions import fixed_points
from carom.reproductions.mora2014.source import GIVEN, machine_at, printed_texts


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
    fold, grazing = pair.special("fold", "d"), pair.special("grazing", "d")
    small = _small_orbits(pair)
    found = {
        "fold_period": f"{fold.period:.7f}",
        "grazing_period": f"{grazing.period:.7f}",
        "unstable": str(sum(orbit.admissible and not orbit.stable for orbit in small)),
        "regions": str(len(plane.regions)),
    }
    machine, figures, orbits = Machine(**GIVEN).parameters, machine_at(0.1), fixed_points(machine_at(0.1))
    gamma, omega = plane.meeting("fold", "boundary-equilibrium").value
    values = {
        **machine.as_dict(),
        **GIVEN,
        "figure_omega": figures.omega,
        "figure_rho": figures.rho,
        "birth": pair.hopf.gamma,
        "fold": fold.value,
        "apart": pair.special("speed-fold", "c").value,
        "grazing": grazing.value,
        "extremum": pair.special("radius-extremum", "d").value,
        "doubling": pair.special("period-doubling", "d").value,
        "pairs": orbits.pairs,
        "total": orbits.total,
        "born": sum(cycle.criticality == "subcritical" for cycle in pair.hopf.cycles),
        "bound": -(figures.radius_ratio + 1.0) + figures.mu * (1.0 + figures.d) * 50.0,
        "meeting_gamma": gamma,
        "meeting_omega": omega,
        "sources": len({region.motions.source_region for region in plane.regions}),
    }
    usual = {"kind": "computed", "unit": ""}
    return tuple(
        PrintedNumber(**usual | row | {"value": values[row["value"]] if "value" in row else float(row["printed"])})
        for row in printed_texts("numbers", found)
    )


def _small_orbits(branches: FirstPair) -> list[Orbit]:
    """Return the orbits just after their birth."""
    orbits = find_orbits(jeffcott(machine_at(branches.hopf.gamma + 1e-6)))
    return [orbit for orbit in orbits if orbit.name.pair == 1 and not orbit.name.faster]
