"""What a sweep of studies computes at a point of its grid: a fixed set of numbers and flags."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from carom.base.arguments import Whole, checked
from carom.base.outcome import STEADY_WORDS
from carom.base.results import in_si, record
from carom.parameters import Case, Zones
from carom.sweeps.variables import LEVITATES, Variable, with_si

if TYPE_CHECKING:
    from carom.models import Rotor
    from carom.orbits.single_impact import OrbitSet

RUB = STEADY_WORDS["rub"]
_SIMPLE = (
    LEVITATES,
    Variable("levitation_radius", "radius of levitation", scale="length"),
    Variable("levitation_decay", "slowest decay of disturbances in levitation", unit="Omega"),
    Variable("zone", "zone of the amplitude of levitation", "flag", flags=("A", "B", "C", "D")),
    Variable("rubs", f"{RUB}s", "count"),
    Variable("rub_stable", f"whether a stable {RUB} exists", "flag", flags=("no", "yes")),
    Variable("rub_force", f"normal force of the stable {RUB}", scale="force"),
    Variable("orbits", "orbits with one impact a period", "count"),
    Variable("stable_orbits", "stable orbits with one impact a period", "count"),
    Variable("orbits_complete", "whether there are provably no more of them", "flag", flags=("no", "yes")),
    Variable("orbit_impulse", "largest normal impulse of the stable orbits", scale="impulse"),
    Variable("rolling_holds", f"whether {STEADY_WORDS['rolling']} sustains itself", "flag", flags=("no", "yes")),
    Variable("runaway_speed", "speed of backward whirl that surely runs away to rolling", unit="Omega"),
)
_SIMULATED = (
    Variable("attractors", "motions in which simulated disturbances ended", "count"),
    Variable("recovered", "share of kicks up to the required size that came back to levitation, by area"),
    Variable("recovered_low", "lower end of its 95 % confidence interval (Clopper and Pearson)"),
    Variable("recovered_high", "upper end of its 95 % confidence interval (Clopper and Pearson)"),
    Variable("smallest_unrecovered_kick", "smallest simulated kick that did not come back", scale="velocity"),
)
_COST = 0.01
_COST_OF_DISTURBANCE = 0.0001


@checked
@dataclass(frozen=True)
class StudyTask:
    """A study at each point of the grid.

    Attributes
    ----------
    disturbances : int
        Number simulated at each point with :func:`~carom.find_attractors`; zero for closed forms only.
    zone_limits : tuple of float
        Limits of the amplitude zones; :func:`plan_sweep` sets those of the machine.
    has_scales : bool
        Whether mass, clearance and speed are known, so that results are stored in SI units too; set by
        :func:`plan_sweep`.
    """

    disturbances: Whole = 0
    zone_limits: tuple[float, float, float] = Zones().limits
    has_scales: bool = False

    kind: ClassVar[str] = "study"

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What is stored for each point."""
        return with_si(_SIMPLE + _SIMULATED if self.disturbances else _SIMPLE, self.has_scales)

    @property
    def words(self) -> str:
        """Say which disturbances are tried at each point."""
        if not self.disturbances:
            return "none, closed forms only"
        kinds = "kicks of the levitating rotor and starts anywhere in the clearance"
        up_to = "at up to the speed that must be survived, in the fixed frame"
        return f"{self.disturbances} at each point: {kinds}, {up_to}"

    @property
    def seconds(self) -> float:
        """Estimated computing time of a point, in seconds."""
        return _COST + self.disturbances * _COST_OF_DISTURBANCE

    @property
    def starts(self) -> int:
        """Number of motions simulated at each point."""
        return self.disturbances

    def describe(self) -> dict[str, object]:
        """Return what identifies the task, as plain data for JSON."""
        return record(self, "kind disturbances zone_limits")

    def evaluate(self, machine: Case | Rotor, seed: np.random.SeedSequence) -> dict[str, object]:
        """Compute the values of one machine by variable name; a variable without a value is left out.

        Parameters
        ----------
        seed : SeedSequence
            Seed of this point.
        """
        from carom.models import rotor_of
        from carom.parameters import Requirement

        case = machine if isinstance(machine, Case) else None
        rotor = rotor_of(machine)
        found = self._closed_forms(rotor, case.zones if case else Zones())
        number = int(seed.generate_state(1)[0])
        if self.disturbances:
            required = (case.requirement if case else Requirement()).own(rotor.scales)
            found |= self._simulated(rotor, required.kick, number)
        scaled = {each.name: each.scale for each in self.variables if each.scale and each.name in found}
        return found | in_si(found, rotor.scales, **scaled)

    def _closed_forms(self, rotor: Rotor, zones: Zones) -> dict[str, Any]:
        from carom.closed_forms.equilibria import steady_motions
        from carom.closed_forms.exact_results import exact_results
        from carom.orbits.single_impact import orbits_within_reach

        levitation, *rubs = steady_motions(rotor)
        there = [rub for rub in rubs if rub.status == "admissible"]
        known = exact_results(rotor)
        found = {
            "levitates": levitation.status == "admissible" and levitation.stable,
            "levitation_radius": levitation.radius,
            "levitation_decay": -float(levitation.eigenvalues.real.max()),
            "rubs": len(there),
            "rub_stable": any(rub.stable for rub in there),
            "rub_force": next((rub.normal_force for rub in there if rub.stable), math.nan),
        }
        if known.rolls and known.whirl:
            found |= {"rolling_holds": known.rolls.holds, "runaway_speed": known.whirl.certain}
        if known.orbits:
            found |= _orbits(orbits_within_reach(rotor))
        if levitation.status != "virtual":
            found["zone"] = zones.labels.index(zones.zone(min(levitation.radius, 1.0)))
        return found

    def _simulated(self, rotor: Rotor, fastest: float, seed: int) -> dict[str, object]:
        from carom.attractors import DisturbanceSet, find_attractors
        from carom.basins import share_of_kicks
        from carom.motions.budget import Budget
        from carom.studies.questions import DESCRIBED, events_for
        from carom.studies.survives import comes_to_rest

        names = ("recovered", "recovered_low", "recovered_high")
        if not rotor.system.is_planar and not comes_to_rest(rotor):
            return {"attractors": 0, **dict.fromkeys(names, 0.0)}
        with Budget().question(DESCRIBED, events_for(rotor, DESCRIBED)):
            found = find_attractors(rotor, DisturbanceSet(self.disturbances, seed, fastest), threads=1)
        smallest, share = found.smallest_unrecovered_kick, share_of_kicks(found)
        back = (share.fraction, share.low, share.high) if share else (0.0, 0.0, 0.0)
        return {
            "attractors": sum(member.count > 0 for member in found),
            **dict(zip(names, back, strict=True)),
            "smallest_unrecovered_kick": math.nan if smallest is None else smallest,
        }


def _orbits(found: OrbitSet) -> dict[str, Any]:
    there = [orbit for orbit in found if orbit.admissible]
    stable = [orbit for orbit in there if orbit.stable]
    impulses = [(1.0 + orbit.rotor.parameters.d) * orbit.radial_speed for orbit in stable]
    return {
        "orbits": len(there),
        "stable_orbits": len(stable),
        "orbits_complete": found.complete,
        "orbit_impulse": max(impulses, default=math.nan),
    }
