"""The study of one machine at one speed.

:func:`study` calls the parts one after another and keeps their results in a :class:`Study`.  The verdict and the facts follow
from these results when they are asked for.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, get_args

from carom.arguments import checked
from carom.attractors import DisturbanceSet, find_attractors
from carom.bifurcations.boundary import boundary_equilibria
from carom.closed_forms import harmless_kick
from carom.closed_forms.known import known_of
from carom.closed_forms.sag import steady_motions
from carom.closed_forms.thresholds import Gain
from carom.disturbances import Disturbance, Plan, Sample
from carom.disturbances.following import refuse_another_machine
from carom.models import Model, Subject, case_of, model_of
from carom.orbits.single_impact import OrbitSet, find_orbits, orbits_within_reach
from carom.outcome import InputError, shown
from carom.parameters import Case, Requirement, Zones
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import in_a_line
from carom.rotors.flexible_model import reduced_of
from carom.studies.advice import recommend
from carom.studies.document import study_document
from carom.studies.facts import Fact
from carom.studies.flexible_study import FlexibleStudy, study_of_machine
from carom.studies.load_checks import worst_loads
from carom.studies.recovery import find_recovery
from carom.studies.study_data import StudyData
from carom.studies.survives import comes_to_rest, required_disturbances, survives
from carom.studies.trials import Check, check_recovery, in_all
from carom.studies.verdict import Verdict, facts_of, verdict

if TYPE_CHECKING:
    from carom.proofs import Proof, ProvenKicks

TRIED = 1000
"""Disturbances tried at each value of a gain."""
FIRST, FRESH = 2000, 10_000
"""Fresh disturbances at the machine's own gains: at first, and if all of these came back."""
PROOF_TIME = "30 s"
"""Time for the proof of kicks, if it is asked for."""
BEYOND = 2.0
"""Largest kick of this proof relative to the harmless one, where those that must be survived never touch."""
SEED = 1
"""Seed of these; the search for recovery has its own."""


@dataclass(frozen=True, eq=False, repr=False)
class Study(StudyData):
    """The study of a machine: what was found (:class:`~carom.studies.study_data.StudyData`), and what follows from it in words."""

    figure: ClassVar[str] = "overview"

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

    @cached_property
    def facts(self) -> tuple[Fact, ...]:
        """All that was found, in the order in which it is told."""
        return tuple(facts_of(self))

    @cached_property
    def verdict(self) -> Verdict:
        """The verdict, in words."""
        return verdict(self, self.facts)

    def to_dict(self) -> dict[str, Any]:
        """Return the study as it is written to ``study.json``."""
        return study_document(self, self.verdict, self.facts)


@checked
@shows_progress
def study(
    machine: Subject,
    disturbances: Plan | Disturbance | None = None,
    *,
    requirement: Requirement | None = None,
    proofs: bool = False,
    proof_time: str | float = PROOF_TIME,
    progress: ShowProgress = None,
) -> Study | FlexibleStudy:
    """Study a machine: its simple motions, where they exist, and where disturbances end.

    A flexible machine has a study of its own (:class:`~carom.studies.FlexibleStudy`): how it levitates, from all its modes, and what it survives,
    by simulation of the reduced rotor.

    A study of another model than the planar rotor rests on what a search and simulation find: it lacks what only closed forms say, and
    names it under *Not covered*.

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
        Prove equilibria and orbits too, by :func:`carom.prove`, which of the kicks that must be survived come back, by
        :func:`carom.proofs.prove_kicks` (of kicks up to twice the harmless one where these never touch), and whether all states as fast as these do, by :func:`carom.proofs.prove_states`; needs the extra
        ``carom[proof]``.
    proof_time : str or float
        Time for the proof of kicks, in s or with a unit.  What is proven in it depends on the computer.

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
    case = _case_of(machine)
    if requirement is not None:
        case = replace(case, requirement=requirement)
    refuse_another_machine(disturbances)
    tell = Reporter.of(progress, "study")
    rotor = model_of(case)
    if (reduced := reduced_of(rotor)) is not None:
        if disturbances is not None or proofs:
            given, allowed = (
                ("disturbances", disturbances) if disturbances is not None else ("proofs", proofs),
                "left out for a flexible machine",
            )
            raise InputError(given[0], shown(given[1]), allowed)
        return study_of_machine(case, rotor, reduced, tell)
    known, required = known_of(rotor).orbits, case.requirement.own(rotor.scales)
    proof = kicks = states = None
    if proofs:
        proof, kicks, states = _proven(rotor, required.kick, proof_time, tell.part(0.0, 0.3))
        tell = tell.part(0.3, 1.0)
    tell(0.0, "equilibria and periodic orbits (the kernels are compiled on first use)")
    steady = steady_motions(rotor)
    orbits = _orbits(rotor, known)
    tell(0.1, "disturbances")
    described = disturbances or DisturbanceSet(fastest=required.kick)
    found = find_attractors(rotor, described, progress=tell.part(0.1, 0.2, "disturbances"))
    endured = survives(rotor, required, tell.part(0.2, 0.4))
    tell(0.4, "what must be survived")
    searching = tell.part(0.45, 0.85)
    tried = required_disturbances(required, TRIED)
    present = _present(rotor, tried) if endured else None
    gains = _gains(rotor, known)
    recoveries = tuple(
        find_recovery(
            rotor,
            gain,
            tried,
            present=present,
            progress=searching.part(place / len(gains), (place + 1) / len(gains)),
        )
        for place, gain in enumerate(gains)
    )
    tell(0.85, "loss of levitation")
    boundaries = tuple(boundary for gain in gains if known for boundary in boundary_equilibria(rotor, gain))
    tell(0.9, "the least change")
    advice = recommend(case, tried, recoveries, needed=present is None or not present.recovers)
    loads = worst_loads(found, case.limits, required) if case.limits.stated and rotor.scales else None
    return Study(
        case,
        rotor,
        steady,
        orbits,
        boundaries,
        found,
        endured,
        present,
        recoveries,
        advice,
        loads,
        proof,
        kicks,
        states,
    )


def _proven(
    rotor: Model, largest: float, time: str | float, tell: Reporter
) -> tuple[Proof, ProvenKicks | None, Proof | None]:
    """Theorems about equilibria and orbits; about kicks and about all states where there is levitation to come back to.

    ``largest`` is the kick that must be survived.
    """
    from carom.proofs import ProvenKicks, prove, prove_kicks, prove_states  # only here: they need an extra

    proof = prove(rotor, progress=tell.part(0.0, 0.2))
    if not comes_to_rest(rotor):
        return proof, None, None
    states = prove_states(rotor, largest, progress=tell.part(0.2, 0.3))
    harmless = harmless_kick(rotor)
    reach = largest if largest > harmless else BEYOND * harmless
    kicks = prove_kicks(rotor, reach, time_limit=time, progress=tell.part(0.3, 1.0))
    return proof, ProvenKicks.of(kicks, rotor), states


def _case_of(machine: Subject) -> Case:
    """What is studied; a model that no file describes stands for itself, with the usual zones."""
    model = model_of(machine)
    if isinstance(machine, Case):
        return machine
    if known_of(model).orbits:
        return case_of(machine)
    return Case("rotor", model, None, Zones())


def _orbits(rotor: Model, known: bool) -> OrbitSet:
    """Orbits with one impact a period; none of a rotor of which no orbits are known, as its bearings have limits or a race turns."""
    if rotor.system.unrepeated is not None:
        return OrbitSet.none(rotor)
    return orbits_within_reach(rotor) if known else find_orbits(rotor, impacts=1)


def _gains(rotor: Model, known: bool) -> tuple[Gain, ...]:
    """Parameters along which recovery is searched: none of other models than the planar rotor that is zero, or that nothing can move."""
    gains: tuple[Gain, ...] = get_args(Gain)
    if known:
        # With negative damping nothing comes back at any stiffness.
        return gains if rotor.value("gamma") >= 0 else gains[:1]
    return tuple(gain for gain in gains if rotor.value(gain) > 0.0)


def _present(rotor: Model, tried: tuple[Sample, ...]) -> Check:
    """Follow fresh disturbances at the machine's own gains; more of them if all came back."""
    first = check_recovery(rotor, in_all(tried, FIRST), seed=SEED)
    return check_recovery(rotor, in_all(tried, FRESH), seed=SEED) if first.recovers else first
