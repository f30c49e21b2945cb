"""What a study has found of a machine, before it is stated in words; and what the limits of its magnetic bearings do in its motions.

A limit of force or current acts in the motion (:mod:`carom.models.limits`): which disturbances come to it, and how many of these come back, is counted.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from carom.attractors import AttractorSet
from carom.base.results import Result, record
from carom.basins import Share
from carom.closed_forms import Equilibrium
from carom.closed_forms.equilibria import SteadyMotion
from carom.closed_forms.exact_results import ExactResults, exact_results
from carom.core.limits import WITHIN
from carom.models import Rotor, rotor_of
from carom.motions import SpinDown, simulate
from carom.motions.budget import Question
from carom.orbits import Orbit, OrbitSet
from carom.parameters import DIMENSIONLESS_FIELDS, Case, ControlLimit, Required
from carom.studies.advice import Recommendation
from carom.studies.drops import DropStudy
from carom.studies.levitating import Levitating
from carom.studies.questions import Kind
from carom.studies.recovery import MotionRange, Recovery
from carom.studies.survives import FullSize, Survives, unrecovered_kinds
from carom.studies.trials import Check
from carom.studies.wording import Wording

SHORTEST = 1e-6
"""Time for which a disturbance is followed whose end is known at once."""


@dataclass(frozen=True)
class BearingDemand:
    """What the largest control force of the magnetic bearings does in the motions of a study.

    Attributes
    ----------
    control : ControlLimit
        That force.
    at_limit, came_back_at_limit, total : int
        Numbers of the disturbances that come to it, of those among them that come back, and of all.
    """

    control: ControlLimit
    at_limit: int
    came_back_at_limit: int
    total: int

    @property
    def words(self) -> str:
        """What the limit does in the motions."""
        back = f", and {self.came_back_at_limit} of these came back" if self.at_limit else ""
        return (
            f"The magnetic bearings are limited to {self.control.words}, which every simulated motion respects. "
            f"{self.at_limit or 'None'} of {self.total} disturbances reach this limit{back}."
        )

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return {
            "control": record(self.control, "force_si=force pull_si=pull"),
            "disturbances": record(self, "at_limit came_back_at_limit"),
        }


def bearing_demand(case: Case, found: AttractorSet) -> BearingDemand | None:
    """What the limit of the magnetic bearings does in motions; ``None`` if they have none."""
    control, tried = rotor_of(case).limits, found.disturbances
    if not isinstance(control, ControlLimit):
        return None
    # Until their ends are known.
    motions = ((each, simulate(each.rotor, each.start.state, max(each.time, SHORTEST))) for each in tried)
    back = [each.recovered for each, motion in motions if (motion.segment_limits > WITHIN).any()]
    return BearingDemand(control, len(back), sum(back), len(tried))


@dataclass(frozen=True, eq=False, repr=False)
class StudyData(Result):
    """Every simple motion of a machine, and the endings of a sample of disturbances.

    Attributes
    ----------
    levitating : Levitating
        Whirls and stability margins; of a flexible machine from all its modes.
    equilibria : tuple of Equilibrium or Levitation
        The contact-free one, then the synchronous rubs; under weight levitation about the static sag alone.
    orbits : OrbitSet
        Orbits with one impact a period: all of the planar rotor, those that a search finds of other models.
    attractors : AttractorSet
        The motions in which simulated disturbances, and starts next to the known motions, end.
    survives : Survives or None
        The sizes of kicks, shocks and losses of a blade up to which none is lost; ``None`` where there is no stable levitation.
    present : Check or None
        Fresh disturbances of what must be survived, at the machine's own gains; ``None`` where there is no stable levitation.
    full_size : tuple of FullSize
        What must be survived at its full size in all directions, and what the touchdown bearings bear in it; empty without stable levitation.
    drop : DropStudy or None
        Levitation lost, with the weight that is stated, or that of free fall; ``None`` where none is possible.
    spin_down : carom.motions.SpinDown or None
        The same followed until the shaft stands, within the events of the study; ``None`` also without a table ``[drive]``.
    recoveries : tuple of Recovery
        Along damping and along stiffness, or other parameters: for which values each motion exists, and at which all that must be survived came back.
    recommendation : Recommendation
        The least change that leaves only recovery, with its margin and how sure it is.
    unfinished : tuple of Question
        The questions for which the budget of events, or a time limit, did not suffice.
    proof : carom.proofs.Proof or None
        Theorems about equilibria and orbits, if they were asked for.
    kicks : carom.proofs.ProvenKicks or None
        What is proven of the kicks that must be survived, or of faster ones where these never touch, if it was asked for and there is stable
        levitation.
    """

    case: Case
    rotor: Rotor
    levitating: Levitating
    equilibria: tuple[SteadyMotion, ...]
    orbits: OrbitSet
    attractors: AttractorSet
    recommendation: Recommendation
    recoveries: tuple[Recovery, ...] = ()
    survives: Survives | None = None
    present: Check | None = None
    full_size: tuple[FullSize, ...] = ()
    drop: DropStudy | None = None
    spin_down: SpinDown | None = None
    unfinished: tuple[Question, ...] = ()
    proof: Any = None
    kicks: Any = None

    @property
    def known(self) -> ExactResults:
        """Exact results of the model."""
        return exact_results(self.rotor)

    @property
    def rubs(self) -> tuple[Equilibrium, ...]:
        """The synchronous rubs, virtual ones included."""
        return tuple(each for each in self.equilibria[1:] if isinstance(each, Equilibrium))

    @property
    def stable_rub(self) -> Equilibrium | None:
        """The stable, admissible synchronous rub, which can hold the rotor, if there is one."""
        return next((rub for rub in self.rubs if rub.stable and rub.status == "admissible"), None)

    @property
    def under_gravity(self) -> bool:
        """Whether the rotor weighs something, or is pulled off the centre of its bearing: then nothing has the symmetry of a turn."""
        return self.rotor.system.forced is not None

    @property
    def levitates(self) -> bool:
        """Whether the contact-free motion lies inside the wall and is stable."""
        return self.equilibria[0].status == "admissible" and self.equilibria[0].stable

    @property
    def zone(self) -> str | None:
        """Zone of the contact-free amplitude; ``None`` if there is no contact-free motion."""
        levitation = self.equilibria[0]
        return None if levitation.status == "virtual" else self.case.zones.zone(min(levitation.radius, 1.0))

    @property
    def stable_orbits(self) -> tuple[Orbit, ...]:
        """Bouncing in which the machine can stay; a stable orbit without an impact is the rolling whirl."""
        return tuple(orbit for orbit in self.orbits if orbit.admissible and orbit.stable and orbit.impacts)

    @property
    def ranges(self) -> tuple[MotionRange, ...]:
        """For which values of a parameter each motion exists, with the others fixed."""
        return tuple(entry for recovery in self.recoveries for entry in recovery.motions)

    @property
    def required(self) -> Required:
        """What the machine must survive, in units of the equations."""
        return self.case.requirement.own(self.rotor.scales)

    def requirement_document(self) -> dict[str, object]:
        """What must be survived, as plain data for JSON."""
        requirement, scales = self.case.requirement, self.rotor.scales
        document: dict[str, object] = {"source": requirement.source, "frame": "fixed"}
        document |= record(self.required, "blade_loss_node")
        stated: dict[str, Any] = {"": self.required, **({"_si": requirement.complete(scales)} if scales else {})}
        for unit, required in stated.items():
            document |= record(required, f"kick{unit}=kick blade_loss{unit}=blade_loss")
            document[f"shock{unit}"] = required.shock and record(required.shock, "peak duration")
            document[f"base_record{unit}"] = required.base_record and record(required.base_record, "name largest")
        return document

    @property
    def share(self) -> Share | None:
        """Share of the kicks up to the required one that come back; ``None`` where there is no stable levitation."""
        return self.present.returned[0] if self.present else None

    @property
    def unrecovered_kinds(self) -> list[tuple[Kind, Share | None]]:
        """The kinds that must be survived and of which some were lost, with the share of them that came back."""
        return unrecovered_kinds(self.required, self.survives, self.present, self.attractors, self.full_size)

    @property
    def wording(self) -> Wording:
        """Formatter of the results of this study as text."""
        varied = self.rotor.varied
        own = {name: field for name, field in varied.items() if name not in DIMENSIONLESS_FIELDS}
        return Wording(self.rotor.scales, in_terms="damping" in varied, fields={} if "damping" in varied else own)

    @property
    def exceeds_limits(self) -> list[str]:
        """Where a limit of a touchdown bearing is exceeded, in words."""
        found = ["on the way"] if any(check.exceeded for each in self.full_size for check in each.checks) else []
        fallen = self.drop is not None and any(each.exceeded for each in self.drop.checks)
        return [*found, "in a drop"] if fallen else found

    @cached_property
    def bearing_demand(self) -> BearingDemand | None:
        """What the limit of the magnetic bearings of a ``[machine]`` does in the motions; ``None`` without one."""
        return bearing_demand(self.case, self.attractors)
