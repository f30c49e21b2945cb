"""The study of one machine at one speed.

:func:`study` calls the parts one after another and keeps their results in a :class:`Study`.  The verdict and the recommendation
follow from these results when they are asked for.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, get_args

from carom.attractors import AttractorSet, DisturbanceSet, find_attractors
from carom.bifurcations.boundary import BoundaryEquilibrium, boundary_equilibria
from carom.closed_forms.equilibria import Equilibrium, find_equilibria
from carom.closed_forms.thresholds import Gain, Steady
from carom.closed_forms.whirl import rolling
from carom.disturbances import Disturbance, Plan
from carom.models import Jeffcott, Subject, case_of
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import OrbitSet, orbits_within_reach
from carom.outcome import InputError
from carom.parameters import Case, Parameters
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import Result, in_a_line
from carom.studies.actuator import BearingDemand, bearing_demand
from carom.studies.advice import Advice, advise
from carom.studies.alone import LevitationAlone, levitation_alone
from carom.studies.document import study_document
from carom.studies.load_checks import WorstLoads, worst_loads
from carom.studies.orbit_ranges import single_impact_ranges
from carom.studies.ranges import Motion, MotionRange, Threshold, steady_range
from carom.studies.recommendation import Recommendation, recommend
from carom.studies.safety import FRESH, DampingCheck, SafeDamping, least_safe_damping, try_disturbances
from carom.studies.verdict import Verdict, verdict
from carom.studies.wording import Wording

if TYPE_CHECKING:
    from carom.proofs import Proof


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
    alone : tuple of LevitationAlone
        Values of damping and stiffness for which levitation is the only motion found.
    advice : tuple of Advice
        The least change of either that leaves only levitation, checked by simulation; empty if no change is needed.
    attractors : AttractorSet
        The motions in which simulated disturbances, and starts next to the known motions, end.
    safe_damping : SafeDamping
        The damping above which all disturbances came back, found by simulation at other dampings too.
    fresh : DampingCheck or None
        If all disturbances of the standard set came back: how many of a larger sample do, at the machine's own damping.
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
    alone: tuple[LevitationAlone, ...]
    advice: tuple[Advice, ...]
    attractors: AttractorSet
    safe_damping: SafeDamping
    fresh: DampingCheck | None
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

    def alone_along(self, gain: Gain) -> LevitationAlone | None:
        """Return where along a gain levitation is the only motion found; ``None`` if that was not searched."""
        return next((entry for entry in self.alone if entry.gain == gain), None)

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
    def recommendation(self) -> Recommendation:
        """The least change that leaves only levitation, with its margin and how sure it is."""
        return recommend(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the study as it is written to ``study.json``."""
        return study_document(self)


@shows_progress
def study(
    machine: Subject,
    disturbances: Plan | Disturbance | None = None,
    *,
    proofs: bool = False,
    progress: ShowProgress = None,
) -> Study:
    """Study a machine: its simple motions, where they exist, and where disturbances end.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    disturbances : Grid, Sample or Disturbance, optional
        The disturbances followed at the machine's own damping and stiffness instead of the standard set, as in
        :func:`~carom.attractors.find_attractors`.  At other values the standard kinds are tried.
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
    _refuse_another_machine(case, disturbances)
    tell = Reporter.of(progress, "study")
    parameters = case.parameters
    proof = None
    if proofs:
        proof, tell = _proof_of(parameters, tell.part(0.0, 0.2)), tell.part(0.2, 1.0)
    tell(0.0, "equilibria and periodic orbits (the kernels are compiled on first use)")
    rotor = Jeffcott(parameters)
    orbits = orbits_within_reach(rotor)
    tell(0.15, "disturbances")
    found = find_attractors(rotor, disturbances, progress=tell.part(0.15, 0.3, "disturbances"))
    ranges = _ranges(parameters, tell.part(0.3, 0.45, "thresholds of damping and stiffness"))
    tell(0.45, "disturbances where levitation is alone")
    alone = tuple(entry for gain in _gains(parameters) if (entry := levitation_alone(parameters, gain, ranges)))
    tell(0.53, "loss of levitation")
    boundaries = tuple(boundary for gain in _gains(parameters) for boundary in boundary_equilibria(rotor, gain))
    fresh = (
        try_disturbances(rotor, DisturbanceSet(FRESH, seed=1))
        if found.recovered == 1.0 and disturbances is None
        else None
    )
    safe = least_safe_damping(parameters, progress=tell.part(0.55, 1.0, "disturbances at other dampings"))
    advice = advise(parameters, alone, ranges, safe.simulated.gamma if safe.simulated else 0.0)
    loads = worst_loads(found, case.limits) if case.limits.stated and parameters.scales else None
    steady = find_equilibria(rotor).members
    return Study(case, rotor, steady, orbits, ranges, boundaries, alone, advice, found, safe, fresh, loads, proof)


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
