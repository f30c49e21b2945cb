"""The study of one machine at one speed.

:func:`study` calls the parts one after another and keeps their results in a :class:`Study`.  The verdict and the recommendation
follow from these results when they are asked for.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, get_args

from carom.arguments import checked
from carom.attractors import AttractorSet, DisturbanceSet, find_attractors
from carom.basins import Share
from carom.bifurcations.boundary import BoundaryEquilibrium, boundary_equilibria
from carom.closed_forms.equilibria import Equilibrium, find_equilibria
from carom.closed_forms.thresholds import Gain, Steady
from carom.closed_forms.whirl import rolling
from carom.disturbances import Disturbance, Plan, Sample
from carom.models import Jeffcott, Subject, case_of
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import OrbitSet, orbits_within_reach
from carom.outcome import InputError
from carom.parameters import Case, Parameters, Required, Requirement
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import Result, in_a_line
from carom.studies.actuator import BearingDemand, bearing_demand
from carom.studies.advice import Recommendation, recommend
from carom.studies.document import study_document
from carom.studies.facts import Fact
from carom.studies.load_checks import WorstLoads, worst_loads
from carom.studies.orbit_ranges import single_impact_ranges
from carom.studies.ranges import Motion, MotionRange, Threshold, free_spans, levitating_spans, steady_range
from carom.studies.recovery import Check, Recovery, check_recovery, find_recovery, in_all
from carom.studies.survives import Survives, required_disturbances, survives
from carom.studies.verdict import Verdict, facts_of, verdict
from carom.studies.wording import Wording

if TYPE_CHECKING:
    from carom.proofs import Proof

TRIED = 1000
"""Disturbances tried at each value of a gain."""
FIRST, FRESH = 2000, 10_000
"""Fresh disturbances at the machine's own gains: at first, and if all of these came back."""
SEED = 1
"""Seed of these; the search for recovery has its own."""


@dataclass(frozen=True, eq=False, repr=False)
class Study(Result):
    """Every simple motion of a machine, the endings of a sample of disturbances, and a verdict.

    Attributes
    ----------
    equilibria : tuple of Equilibrium
        The contact-free one, then the synchronous rubs.
    orbits : OrbitSet
        Orbits with one impact a period.
    ranges : tuple of MotionRange
        For which damping and which stiffness each motion exists, with the other parameters fixed.
    boundaries : tuple of BoundaryEquilibrium
        Values of damping and stiffness at which the contact-free motion meets the wall, and what happens there.
    attractors : AttractorSet
        The motions in which simulated disturbances, and starts next to the known motions, end.
    survives : Survives or None
        The sizes of kicks, shocks and losses of a blade up to which none is lost; ``None`` where there is no stable levitation.
    present : Check or None
        Fresh disturbances of what must be survived, at the machine's own gains; ``None`` where there is no stable levitation.
    recoveries : tuple of Recovery
        The values of damping and of stiffness at which all that must be survived came back.
    recommendation : Recommendation
        The least change that leaves only recovery, with its margin and how sure it is.
    loads : WorstLoads or None
        The largest loads of the disturbances against the limits of the touchdown bearing, if any are stated.
    proof : Proof or None
        Theorems about equilibria and orbits, if they were asked for.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "iso14839")

    figure: ClassVar[str] = "overview"

    case: Case
    rotor: Jeffcott
    equilibria: tuple[Equilibrium, ...]
    orbits: OrbitSet
    ranges: tuple[MotionRange, ...]
    boundaries: tuple[BoundaryEquilibrium, ...]
    attractors: AttractorSet
    survives: Survives | None
    present: Check | None
    recoveries: tuple[Recovery, ...]
    recommendation: Recommendation
    loads: WorstLoads | None = None
    proof: Proof | None = None

    def rows(self) -> list[tuple[str, str]]:
        """The machine, its motions, and the first sentences of the verdict."""
        return [
            ("case", self.case.name),
            ("rotor", in_a_line(self.rotor)),
            ("levitates", in_a_line(self.levitates)),
            ("orbits", in_a_line(tuple(self.orbits))),
            ("attractors", in_a_line(self.attractors.members)),
            ("verdict", self.verdict.headline),
        ]

    @property
    def rubs(self) -> tuple[Equilibrium, ...]:
        """The synchronous rubs, virtual ones included."""
        return self.equilibria[1:]

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
        """Orbits on which the machine can stay."""
        return tuple(orbit for orbit in self.orbits if orbit.admissible and orbit.stable)

    @property
    def gains(self) -> tuple[Gain, ...]:
        """The gains along which ranges are known."""
        return tuple(dict.fromkeys(entry.gain for entry in self.ranges))

    def range_of(self, motion: Motion, gain: Gain) -> MotionRange | None:
        """Return the range of a motion along a gain; ``None`` if it was not determined."""
        return next((entry for entry in self.ranges if (entry.motion, entry.gain) == (motion, gain)), None)

    @property
    def required(self) -> Required:
        """What the machine must survive, in units of the equations."""
        return self.case.requirement.own(self.rotor.scales)

    @property
    def share(self) -> Share | None:
        """Share of the kicks up to the required one that come back; ``None`` where there is no stable levitation."""
        return self.present.returned[0] if self.present else None

    @property
    def thresholds(self) -> tuple[Threshold, ...]:
        """Values of damping and stiffness at which a motion appears or vanishes."""
        return tuple(threshold for entry in self.ranges for threshold in entry.thresholds)

    @property
    def wording(self) -> Wording:
        """Formatter of the results of this study as text."""
        return Wording(self.rotor.scales)

    @cached_property
    def bearing_demand(self) -> BearingDemand | None:
        """What the motions ask of the magnetic bearings; ``None`` if the machine has no limits of these."""
        return bearing_demand(self.case, self.equilibria, self.orbits, rolling(self.rotor), self.attractors)

    @cached_property
    def verdict(self) -> Verdict:
        """The verdict, in words."""
        return verdict(self)

    @cached_property
    def facts(self) -> tuple[Fact, ...]:
        """All that was found, in the order in which it is told."""
        return tuple(facts_of(self))

    def to_dict(self) -> dict[str, Any]:
        """Return the study as it is written to ``study.json``."""
        return study_document(self)


@checked
@shows_progress
def study(
    machine: Subject,
    disturbances: Plan | Disturbance | None = None,
    *,
    requirement: Requirement | None = None,
    proofs: bool = False,
    progress: ShowProgress = None,
) -> Study:
    """Study a machine: its simple motions, where they exist, and where disturbances end.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    disturbances : Grid, Sample or Disturbance, optional
        The disturbances whose ends are described, instead of kicks and starts in the clearance as fast as what must be
        survived; as in :func:`~carom.attractors.find_attractors`.
    requirement : Requirement, optional
        What the machine must survive, instead of what its file states; by default kicks of the speed of a fall through the
        diametral clearance.
    proofs : bool
        Prove equilibria and orbits too, by :func:`carom.prove`; needs the extra ``carom[proof]``.

    Raises
    ------
    InputError
        The machine is none of these.
    CaromError
        Its motions cannot be computed; the message says why.

    See Also
    --------
    carom.find_attractors, carom.find_orbits, carom.find_equilibria : its parts
    carom.map_basins : where disturbances of one kind end

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> result = cm.study(machine)
    >>> result.levitates, [orbit.name for orbit in result.stable_orbits]
    (True, ['B1,d'])
    """
    case = case_of(machine)
    if requirement is not None:
        case = replace(case, requirement=requirement)
    _refuse_another_machine(case, disturbances)
    tell = Reporter.of(progress, "study")
    parameters, rotor = case.parameters, Jeffcott(case.parameters)
    required = case.requirement.own(parameters.scales)
    proof = None
    if proofs:
        proof, tell = _proof_of(parameters, tell.part(0.0, 0.2)), tell.part(0.2, 1.0)
    tell(0.0, "equilibria and periodic orbits (the kernels are compiled on first use)")
    orbits = orbits_within_reach(rotor)
    tell(0.1, "disturbances")
    described = disturbances or DisturbanceSet(fastest=required.kick)
    found = find_attractors(rotor, described, progress=tell.part(0.1, 0.2, "disturbances"))
    endured = survives(rotor, required, tell.part(0.2, 0.4))
    ranges = _ranges(parameters, tell.part(0.4, 0.6, "thresholds of damping and stiffness"))
    tell(0.6, "loss of levitation")
    boundaries = tuple(boundary for gain in _gains(parameters) for boundary in boundary_equilibria(rotor, gain))
    tell(0.65, "what must be survived, at other gains")
    tried = required_disturbances(required, TRIED)
    present = _present(rotor, tried) if endured else None
    recoveries = _recoveries(rotor, ranges, tried, present)
    tell(0.9, "the least change")
    needed = present is None or not present.recovers
    advice = recommend(case, tried, recoveries, ranges, needed)
    loads = worst_loads(found, case.limits) if case.limits.stated and parameters.scales else None
    steady = find_equilibria(rotor).members
    return Study(
        case, rotor, steady, orbits, ranges, boundaries, found, endured, present, recoveries, advice, loads, proof
    )


def _present(rotor: Jeffcott, tried: tuple[Sample, ...]) -> Check:
    """Follow fresh disturbances at the machine's own gains; more of them if all came back."""
    first = check_recovery(rotor, in_all(tried, FIRST), seed=SEED)
    return check_recovery(rotor, in_all(tried, FRESH), seed=SEED) if first.recovers else first


def _recoveries(
    rotor: Jeffcott, ranges: tuple[MotionRange, ...], tried: tuple[Sample, ...], present: Check | None
) -> tuple[Recovery, ...]:
    """Search each gain for values at which all comes back: where no rub and no orbit exists, or else wherever it levitates.

    Where all comes back at the machine's own gains although such motions exist, the range around these is searched.
    """
    found = []
    for gain in _gains(rotor.parameters):
        free, levitating = free_spans(ranges, gain), levitating_spans(ranges, gain)
        if free is None or levitating is None:
            continue
        own = rotor.parameters.value(gain)
        here = present is not None and present.recovers and not any(own in span for span in free)
        recovery = find_recovery(rotor, gain, tried, within=levitating if here else free)
        if not recovery.spans and not here and free != levitating:
            recovery = find_recovery(rotor, gain, tried, within=levitating)
        found.append(recovery)
    return tuple(found)


def _refuse_another_machine(case: Case, disturbances: Plan | Disturbance | None) -> None:
    """Refuse disturbances that change the machine."""
    if disturbances is None:
        return
    model = disturbances if isinstance(disturbances, Disturbance) else disturbances.model
    rotor = Jeffcott(case.parameters)
    if model.machine_after(rotor) is not rotor:
        allowed = "one that leaves the machine as it is: study the machine after it, or follow it with map_basins"
        raise InputError("disturbances", model.kind, allowed)


def _proof_of(parameters: Parameters, tell: Reporter) -> Proof:
    from carom.proofs import prove  # only here: it needs an extra

    return prove(parameters, progress=tell)


def _ranges(parameters: Parameters, tell: Reporter) -> tuple[MotionRange, ...]:
    found: list[MotionRange] = []
    gains = _gains(parameters)
    for place, gain in enumerate(gains):
        found += [steady_range(parameters, motion, gain) for motion in get_args(Steady)]
        found += single_impact_ranges(parameters, gain, tell.part(place / len(gains), (place + 1) / len(gains)))
    return tuple(found)


def _gains(parameters: Parameters) -> tuple[Gain, ...]:
    """Return the gains to vary; with negative damping nothing comes back at any stiffness: vary damping only."""
    return ("gamma", "omega") if parameters.gamma >= 0 else ("gamma",)
