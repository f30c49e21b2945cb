"""The study of one machine at one speed.

:func:`study` asks one contributor after another (:data:`CONTRIBUTORS`) and keeps what they find in a :class:`Study`.  The verdict and the facts follow
from these results when they are asked for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, get_args

from carom.attractors import AttractorSet, DisturbanceSet, find_attractors
from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import box, in_a_line
from carom.closed_forms import contact_free_kick
from carom.closed_forms.equilibria import steady_motions
from carom.closed_forms.exact_results import exact_results
from carom.closed_forms.thresholds import Gain
from carom.disturbances import Disturbance, Plan, Sample
from carom.disturbances.following import refuse_another_machine
from carom.models import Rotor, Subject, axis, case_of, rotor_of
from carom.motions.budget import Budget
from carom.orbits import OrbitSet, find_orbits, orbits_within_reach
from carom.parameters import Case, Field, Required, Requirement, read_quantity
from carom.studies import questions
from carom.studies.advice import GAIN_FACTOR, Recommendation, recommend
from carom.studies.document import study_document
from carom.studies.drops import drop_of
from carom.studies.findings import facts_of
from carom.studies.levitating import levitating
from carom.studies.questions import Fact
from carom.studies.recovery import Recovery, find_recovery
from carom.studies.standstill import spin_down_of
from carom.studies.study_data import StudyData
from carom.studies.survives import FullSize, Survives, at_full_size, comes_to_rest, decides, survives, unrecovered_kinds
from carom.studies.trials import Check, check_recovery, in_all
from carom.studies.verdict import Verdict, verdict
from carom.studies.wording import Wording

TRIED, TRIED_SINGLY = 1000, 100
"""Disturbances tried at each value of a gain, and those of rotors whose motions are followed one after another."""
FIRST, FRESH = 2000, 10_000
"""Fresh disturbances at the machine's own gains: at first, and if all of these came back."""
PROOF_TIME = "30 s"
"""Time for the proof of kicks, if it is asked for."""
GUESSES = 30
"""Stretches of motions from which orbits are searched where no closed form has them: a tenth of a second each."""
TIME_LIMIT = Field("time_limit", "", "time to follow motions", "a time", "s", 1e-3, 1e9, '"2 min"')
BEYOND = 2.0
"""Largest kick of this proof relative to the contact-free one, where those that must be survived never touch."""
OF_CONTROLLERS = ("derivative", "proportional")
"""Parameters along which recovery is searched where magnetic bearings have controllers."""
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
        """All that was found, in the order in which it is stated."""
        return tuple(facts_of(self))

    @cached_property
    def verdict(self) -> Verdict:
        """The verdict, in words."""
        return verdict(self, self.facts)

    def to_dict(self) -> dict[str, object]:
        """Return the study as it is written to ``study.json``."""
        return study_document(self, self.verdict, self.facts)


@checked
@shows_progress
def study(
    machine: Subject,
    disturbances: Plan | Disturbance | None = None,
    *,
    requirement: Requirement | None = None,
    along: Sequence[str] | None = None,
    proofs: bool = False,
    proof_time: str | float = PROOF_TIME,
    time_limit: str | float | None = None,
    progress: ShowProgress = None,
) -> Study:
    """Study a machine: its simple motions, where they exist, and where disturbances end.

    Every machine is asked the same questions (:data:`CONTRIBUTORS`), and each is answered where it has a meaning for it.  What closed forms say exists of
    the planar rotor alone; of others it is what a search and simulation find, and *Not covered* names what is missing.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    disturbances : Grid, Sample or Disturbance, optional
        The disturbances whose ends are described, instead of kicks and starts in the clearance as fast as what must be
        survived; as in :func:`~carom.attractors.find_attractors`.
    requirement : Requirement, optional
        What the machine must survive, instead of what its file states; by default kicks of the speed of a fall through the
        diametral clearance.
    along : sequence of str, optional
        Parameters along which recovery is searched and a change is looked for, such as ``"speed"``, ``"friction"`` or ``"touchdown_stiffness"``; by
        default damping and stiffness of the levitation, or the gains of the magnetic bearings.
    proofs : bool
        Prove equilibria and orbits too, by :func:`carom.prove`, and which of the kicks that must be survived come back, by
        :func:`carom.proofs.prove_kicks` (of kicks up to twice the contact-free one where these never touch); needs the extra
        ``carom[proof]``.
    proof_time : str or float
        Time for the proof of kicks, in s or with a unit.  What is proven in it depends on the computer.
    time_limit : str or float, optional
        Time in s or with a unit after which no further motions are followed, and what was not reached is stated.  Otherwise a budget of
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
    case = case_of(machine)
    if requirement is not None:
        case = replace(case, requirement=requirement)
    refuse_another_machine(disturbances)
    seconds = math.inf if time_limit is None else read_quantity(TIME_LIMIT, time_limit)
    rotor = rotor_of(case)
    asked = Asked(case, rotor, case.requirement.own(rotor.scales), Budget(seconds), disturbances, along, proof_time)
    contributors = [each for each in CONTRIBUTORS if each.applies(asked) and (proofs or each.name not in OF_PROOFS)]
    tell, done, whole = Reporter.of(progress, "study"), 0.0, sum(each.share for each in contributors)
    for each in contributors:
        tell(done / whole, each.words)
        events = questions.events_for(rotor, each.question) if each.question else 0
        with asked.budget.question(each.question, events) if each.question else nullcontext():
            asked.found[each.name] = each.find(asked, tell.part(done / whole, (done + each.share) / whole))
        done += each.share
    return Study(case, rotor, unfinished=asked.budget.unfinished, **asked.found)


@dataclass(frozen=True)
class Asked:
    """What a study is asked, and what it has found so far, by the fields of :class:`StudyData`."""

    case: Case
    rotor: Rotor
    required: Required
    budget: Budget
    disturbances: Plan | Disturbance | None
    along: Sequence[str] | None
    proof_time: str | float
    found: dict[str, Any] = field(default_factory=dict)

    @property
    def tried(self) -> tuple[Sample, ...]:
        """What must be survived, as it is tried at one value of a parameter."""
        return questions.required_disturbances(self.required, TRIED if self.rotor.system.is_planar else TRIED_SINGLY)

    @property
    def needed(self) -> bool | None:
        """Whether a change is needed; ``None`` where too few disturbances could be followed."""
        found = self.found
        endured, present, full_size = found.get("survives"), found.get("present"), found.get("full_size", ())
        kinds = unrecovered_kinds(self.required, endured, present, found["attractors"], full_size)
        lost = endured is None or bool(kinds)
        return lost if lost or decides(present) else None


class Contributor(NamedTuple):
    """A part of a study: what it finds, and for which machines it has something."""

    name: str
    """The field of :class:`StudyData`."""
    words: str
    share: float
    """About what share of the time it takes."""
    find: Callable[[Asked, Reporter], object]
    applies: Callable[[Asked], bool] = lambda _: True
    question: str = ""
    """Within whose events it is found, if these are limited as a whole."""


def _returns(asked: Asked) -> bool:
    return comes_to_rest(asked.rotor)


def _is_known(asked: Asked) -> bool:
    return exact_results(asked.rotor).orbits


def _prove_kicks(asked: Asked, tell: Reporter) -> object:
    """Of the kicks that must be survived, or of larger ones where these never touch."""
    contact_free = contact_free_kick(asked.rotor)
    reach = asked.required.kick if asked.required.kick > contact_free else BEYOND * contact_free
    prover = box("proofs")
    proof = prover.prove_kicks(asked.rotor, reach, time_limit=asked.proof_time, progress=tell)
    return prover.ProvenKicks.of(proof, asked.rotor)


def _orbits(asked: Asked, tell: Reporter) -> OrbitSet:
    """Orbits with one impact a period; none of a rotor whose motions never repeat."""
    rotor = asked.rotor
    if rotor.system.why_not_stationary is not None:
        return OrbitSet.none(rotor)
    return orbits_within_reach(rotor) if _is_known(asked) else find_orbits(rotor, impacts=1, guesses=GUESSES)


def _attractors(asked: Asked, tell: Reporter) -> AttractorSet:
    described = asked.disturbances or DisturbanceSet(fastest=asked.required.kick)
    return find_attractors(asked.rotor, described, progress=tell)


def _present(asked: Asked, tell: Reporter) -> Check:
    """Fresh disturbances at the machine's own gains, of planar rotors more if all came back."""
    rotor, checks, events = asked.rotor, [], questions.events_for(asked.rotor, questions.PRESENT) // len(asked.tried)
    for sample, more in zip(in_all(asked.tried, FIRST), in_all(asked.tried, FRESH), strict=True):
        with asked.budget.question(questions.PRESENT.format(sample.model.noun), events):
            check = check_recovery(rotor, [sample], seed=SEED)
            wanted = check.recovers and rotor.system.is_planar
            checks.append(check_recovery(rotor, [more], seed=SEED) if wanted else check)
    return Check.joined(checks)


def _parameters(asked: Asked) -> tuple[str, ...]:
    """Parameters along which recovery is searched; by default those of the levitation, without what is zero or differs between bearings."""
    rotor = asked.rotor
    if asked.along is not None:
        return tuple(axis(rotor, name).name for name in asked.along)
    gains: tuple[Gain, ...] = get_args(Gain)
    if _is_known(asked):
        # With negative damping nothing comes back at any stiffness.
        return gains if rotor.value("gamma") >= 0 else gains[:1]
    levitation = gains if gains[0] in rotor.varied else OF_CONTROLLERS
    return tuple(name for name in levitation if name in rotor.varied and _has(rotor, name))


def _has(rotor: Rotor, name: str) -> bool:
    try:
        return rotor.value(name) > 0.0
    except InputError:  # bearings differ
        return False


def _recoveries(asked: Asked, tell: Reporter) -> tuple[Recovery, ...]:
    """Along each parameter the values at which what must be survived comes back, within the factor that is advised at most."""
    names, found = _parameters(asked), []
    say = Wording(asked.rotor.scales)
    for place, name in enumerate(names):
        with asked.budget.question(
            questions.ALONG.format(say.name(name)), questions.events_for(asked.rotor, questions.ALONG)
        ):
            part = tell.part(place / len(names), (place + 1) / len(names))
            found.append(find_recovery(asked.rotor, name, asked.tried, factor=GAIN_FACTOR, progress=part))
    return tuple(found)


def _recommendation(asked: Asked, tell: Reporter) -> Recommendation:
    return recommend(asked.case, asked.tried, asked.found["recoveries"], needed=asked.needed)


def _survives(asked: Asked, tell: Reporter) -> Survives | None:
    return survives(asked.rotor, asked.required, asked.budget, tell)


def _full_size(asked: Asked, tell: Reporter) -> tuple[FullSize, ...]:
    return at_full_size(asked.rotor, asked.required, asked.case.limits)


OF_PROOFS = ("proof", "kicks")
CONTRIBUTORS = (
    Contributor("proof", "proofs", 0.1, lambda asked, tell: box("proofs").prove(asked.rotor, progress=tell)),
    Contributor("kicks", "proof of kicks", 0.3, _prove_kicks, lambda asked: _is_known(asked) and _returns(asked)),
    Contributor("levitating", "whirls", 0.02, lambda asked, _: levitating(asked.case, asked.rotor)),
    Contributor("equilibria", "equilibria", 0.02, lambda asked, _: steady_motions(asked.rotor)),
    Contributor("orbits", "periodic orbits (the kernels are compiled on first use)", 0.06, _orbits),
    Contributor("attractors", "disturbances", 0.1, _attractors, question=questions.DESCRIBED),
    Contributor("present", "what must be survived", 0.05, _present, _returns),
    Contributor("survives", "the smallest disturbances that do not come back", 0.2, _survives, _returns),
    Contributor("full_size", "loads of the touchdown bearings", 0.05, _full_size, _returns, questions.FULL_SIZE),
    Contributor("recoveries", "recovery along parameters", 0.4, _recoveries),
    Contributor("recommendation", "the least change", 0.05, _recommendation, question=questions.CHANGE),
    Contributor("drop", "the drop", 0.02, lambda asked, _: drop_of(asked.case), _returns, questions.DROP),
    Contributor(
        "spin_down", "the spin-down", 0.05, lambda asked, _: spin_down_of(asked.case), _returns, questions.SPIN_DOWN
    ),
)
"""The parts of a study, in the order in which they are asked; later ones use what earlier ones have found."""
