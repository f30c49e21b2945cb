"""The study of one machine at one speed.

:func:`study` calls the parts one after another and keeps their results in a :class:`Study`.  The verdict and the facts follow
from these results when they are asked for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, get_args

import numpy as np

from carom.arguments import checked
from carom.attractors import DisturbanceSet, find_attractors
from carom.basins import Share
from carom.bifurcations.boundary import boundary_equilibria
from carom.closed_forms import harmless_kick
from carom.closed_forms.equilibria import steady_motions
from carom.closed_forms.exact_results import exact_results
from carom.closed_forms.thresholds import Gain
from carom.disturbances import AnyState, Disturbance, Plan, Sample
from carom.disturbances.following import follow, refuse_another_machine
from carom.models import Model, Subject, case_of, model_of
from carom.motions.budget import NOT_FOLLOWED, Budget
from carom.orbits.single_impact import OrbitSet, find_orbits, orbits_within_reach
from carom.outcome import InputError, shown
from carom.parameters import Case, Field, Required, Requirement, Zones, read_quantity
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import in_a_line
from carom.studies.advice import GAIN_FACTOR, recommend
from carom.studies.document import study_document
from carom.studies.facts import Fact
from carom.studies.flexible_study import FlexibleStudy, study_of_machine
from carom.studies.load_checks import worst_loads
from carom.studies.questions import ALONG, CHANGE, DESCRIBED, ELSEWHERE, EVENTS, LOADS, PRESENT, WALLS
from carom.studies.recovery import Recovery, find_recovery
from carom.studies.rigid_limit import TRIED as ON_WALLS
from carom.studies.rigid_limit import on_other_walls
from carom.studies.study_data import StudyData
from carom.studies.survives import comes_to_rest, decides, lost_kinds, required_disturbances, survives
from carom.studies.trials import Check, check_recovery, in_all
from carom.studies.verdict import Verdict, facts_of, verdict

if TYPE_CHECKING:
    from carom.proofs import Proof, ProvenKicks

TRIED, TRIED_SINGLY = 1000, 200
"""Disturbances tried at each value of a gain, and those of rotors whose motions are followed one after another."""
FIRST, FRESH = 2000, 10_000
"""Fresh disturbances at the machine's own gains: at first, and if all of these came back."""
PROOF_TIME = "30 s"
"""Time for the proof of kicks, if it is asked for."""
ELSEWHERE_TRIED = 1000
"""Starts elsewhere in the clearance."""
GUESSES = 100
"""Stretches of motions from which orbits are searched where no closed form has them: 10 to 50 milliseconds each."""
TIME_LIMIT = Field("time_limit", "", "time to follow motions", "a time", "s", 1e-3, 1e9, '"2 min"')
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
    time_limit: str | float | None = None,
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
    time_limit : str or float, optional
        Time in s or with a unit after which no further motions are followed, and what was not reached is told.  Otherwise a budget of
        events (:mod:`carom.studies.questions`) alone decides what is followed, so that the answer does not depend on the computer.

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
    seconds = math.inf if time_limit is None else read_quantity(TIME_LIMIT, time_limit)
    rotor = model_of(case)
    if (reduced := rotor.finite_elements) is not None:
        if disturbances is not None or proofs:
            given, allowed = (
                ("disturbances", disturbances) if disturbances is not None else ("proofs", proofs),
                "left out for a flexible machine",
            )
            raise InputError(given[0], shown(given[1]), allowed)
        return study_of_machine(case, rotor, reduced, Budget(seconds), tell)
    known, required = exact_results(rotor).orbits, case.requirement.own(rotor.scales)
    proof = kicks = states = None
    if proofs:
        proof, kicks, states = _proven(rotor, required.kick, proof_time, tell.part(0.0, 0.3))
        tell = tell.part(0.3, 1.0)
    budget = Budget(seconds)
    tell(0.0, "equilibria and periodic orbits (the kernels are compiled on first use)")
    steady = steady_motions(rotor)
    orbits = _orbits(rotor, known)
    tell(0.1, "disturbances")
    described = disturbances or DisturbanceSet(fastest=required.kick)
    with budget.question(DESCRIBED, EVENTS[DESCRIBED]):
        found = find_attractors(rotor, described, progress=tell.part(0.1, 0.2, "disturbances"))
    tell(0.2, "what must be survived")
    tried = required_disturbances(required, TRIED if rotor.system.is_planar else TRIED_SINGLY)
    present, elsewhere = _present(rotor, tried, required, budget) if comes_to_rest(rotor) else (None, None)
    endured = survives(rotor, required, budget, tell.part(0.25, 0.45))
    recoveries = _recoveries(rotor, _gains(rotor, known), tried, budget, tell.part(0.45, 0.85))
    tell(0.85, "loss of levitation")
    boundaries = tuple(
        boundary for gain in _gains(rotor, known) if known for boundary in boundary_equilibria(rotor, gain)
    )
    tell(0.9, "the least change")
    lost = endured is None or bool(lost_kinds(required, endured, present, found))
    with budget.question(CHANGE, EVENTS[CHANGE]):
        advice = recommend(case, tried, recoveries, needed=lost if lost or decides(present) else None)
    tell(0.95, "loads, and other touchdown bearings")
    loads = None
    if case.limits.given and rotor.scales:
        with budget.question(LOADS, EVENTS[LOADS]):
            loads = worst_loads(found, case.limits, required)
    with budget.question(WALLS, EVENTS[WALLS]):
        walls = on_other_walls(rotor, required_disturbances(required, ON_WALLS)) if endured else ()
    return Study(
        case,
        rotor,
        steady,
        orbits,
        boundaries,
        found,
        endured,
        present,
        elsewhere,
        recoveries,
        advice,
        walls,
        budget.unfinished,
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
    if exact_results(model).orbits:
        return case_of(machine)
    return Case("rotor", model, None, Zones())


def _orbits(rotor: Model, known: bool) -> OrbitSet:
    """Orbits with one impact a period; none of a rotor of which no orbits are known, as its bearings have limits or a race turns."""
    if rotor.system.unrepeated is not None:
        return OrbitSet.none(rotor)
    return orbits_within_reach(rotor) if known else find_orbits(rotor, impacts=1, guesses=GUESSES)


def _gains(rotor: Model, known: bool) -> tuple[Gain, ...]:
    """Parameters along which recovery is searched: none of other models than the planar rotor that is zero, or that nothing can move."""
    gains: tuple[Gain, ...] = get_args(Gain)
    if known:
        # With negative damping nothing comes back at any stiffness.
        return gains if rotor.value("gamma") >= 0 else gains[:1]
    return tuple(gain for gain in gains if rotor.value(gain) > 0.0)


_WORDS = {"kick": "kicks", "shock": "shocks", "blade-loss": "losses of a blade"}


def _present(rotor: Model, tried: tuple[Sample, ...], required: Required, budget: Budget) -> tuple[Check, Share]:
    """Fresh disturbances at the machine's own gains, of planar rotors more if all came back; and apart from them starts elsewhere."""
    checks = []
    for sample, more in zip(in_all(tried, FIRST), in_all(tried, FRESH), strict=True):
        with budget.question(PRESENT.format(_WORDS[sample.model.kind]), EVENTS[PRESENT] // len(tried)):
            check = check_recovery(rotor, [sample], seed=SEED)
            wanted = check.recovers and rotor.system.is_planar
            checks.append(check_recovery(rotor, [more], seed=SEED) if wanted else check)
    found = Check.joined(checks)
    with budget.question(ELSEWHERE, EVENTS[ELSEWHERE]):
        ends = follow(rotor, Sample(AnyState(required.kick), ELSEWHERE_TRIED, SEED).starts(rotor))
    followed = int(np.count_nonzero(ends.outcomes != NOT_FOLLOWED))
    return found, Share.of(int(np.count_nonzero(ends.recovered)), followed, drawn=True)


def _recoveries(
    rotor: Model, gains: tuple[Gain, ...], tried: tuple[Sample, ...], budget: Budget, tell: Reporter
) -> tuple[Recovery, ...]:
    """Along each gain the values at which what must be survived comes back, within the factor that is advised at most."""
    found = []
    for place, gain in enumerate(gains):
        words = ALONG.format("damping" if gain == "gamma" else "stiffness")
        with budget.question(words, EVENTS[words]):
            part = tell.part(place / len(gains), (place + 1) / len(gains))
            found.append(find_recovery(rotor, gain, tried, factor=GAIN_FACTOR, progress=part))
    return tuple(found)
