"""The verdict of a study in words: what the machine survives, what may hold it, which changes help, what is unknown.

It never promises that a machine recovers.  Disturbances are samples, and motions that none of them reached may exist.
The best possible verdict is that every disturbance tried came back; of kicks it may be that all of them are proven to.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from carom.outcome import STEADY_WORDS
from carom.studies.actuator import actuator_words
from carom.studies.advice_facts import advice_facts
from carom.studies.facts import Fact, about
from carom.studies.findings import FINDINGS
from carom.studies.proven import proven_kicks_words, proven_states_words, proven_words
from carom.studies.questions import unfinished_facts
from carom.studies.rigid_limit import wall_values, wall_words
from carom.studies.study_data import StudyData
from carom.studies.verdict_facts import KINDS, Level, judged, verdict_facts

NOT_COVERED = (
    "Disturbances other than those simulated. They are samples: one between them, or a larger one, may end elsewhere.",
    (
        "Periodic motions with two or more impacts a period, bouncing that never repeats, and motions that alternate "
        "between bounces and lasting contact. They are named only if a simulated disturbance ended in one."
    ),
    "A touchdown bearing that moves, turns or gives way: the wall is rigid, so the load of an impact is an impulse.",
    "Changes of speed, gravity, a rotor that bends or tilts, and controllers that do more than a spring and a damper.",
)
"""What a study does not cover."""
SAMPLED, NOT_COVERED_BUT_KICKS = (
    0,
    (
        "Disturbances other than those simulated, but for the kicks that are proven to come back. They are samples: one between them, or a "
        "larger one, may end elsewhere."
    ),
)
"""Place of the first of these, and what stands there if kicks are proven to come back."""
NOT_COVERED_OF_MATRICES = (
    "Changes of speed, gravity, and controllers that add states of their own.",
    (
        "What is known in closed form for the planar rotor alone: whether rolling lasts and from which speed whirl runs away to it, for "
        "which damping and stiffness each motion exists, how levitation ends, and that no orbit is missing."
    ),
)
"""What a study of any other model does not cover, in place of the last of these."""
NOT_COVERED_UNDER_WEIGHT = (
    "Changes of speed, and controllers that add states of their own.",
    (
        f"What rests on the symmetry of a turn: {STEADY_WORDS['rub']}s, orbits in closed form, and that a kick does the same whatever the angle of the "
        "unbalance is as it strikes. Here that is the angle in the machine file; with others some kicks may end elsewhere."
    ),
    NOT_COVERED_OF_MATRICES[-1],
)
"""The same of a rotor that weighs something."""
NOT_COVERED_AT_LIMITS = (
    "Other angles of the unbalance to the axes of the magnetic bearings, along which their limits act, as a disturbance strikes than that of the "
    "machine file. Saturation of the iron and limits of the voltage are not modelled."
)
"""What is added where magnetic bearings have limits."""
WALL, NOT_COVERED_OF_WALLS = (
    2,
    "Wear, heat and axial motion of the touchdown bearing: its law is taken as it is stated.",
)
"""Place of the entry above on the rigid wall, and what stands there if the touchdown bearing gives way."""


@dataclass(frozen=True)
class Verdict:
    """The conclusion of a study.

    Attributes
    ----------
    level : {"no-contact-free-motion", "may-not-come-back", "not-decided", "all-tried-came-back"}
        The verdict as a code for programs.
    outcome : str
        The verdict in a few words, with the zone of the vibration amplitude (ISO 14839-2).
    reason : str
        What was lost, or why there is nothing to come back to; empty if there is nothing to say.
    survived : tuple of str
        For each kind of disturbance: harmless up to, all tried came back up to, smallest lost; then what must be survived, and what of it is proven.
    """

    level: Level
    outcome: str
    reason: str
    survived: tuple[str, ...]

    @property
    def lead(self) -> str:
        """The outcome with its reason, as a sentence."""
        return f"{self.outcome}: {self.reason}." if self.reason else f"{self.outcome}."

    @property
    def headline(self) -> str:
        """The whole in one paragraph: the outcome, and what is survived in absolute sizes."""
        return " ".join((self.lead, *self.survived))


def facts_of(study: StudyData) -> Iterator[Fact]:
    """List all facts of a study, in the order in which they are told."""
    yield from verdict_facts(study)
    yield from advice_facts(study)
    for topic, write in FINDINGS.items():
        for text in write(study).split("\n"):
            yield Fact(topic, text)
    if study.proof is not None:
        yield Fact("Proven", proven_words(study.proof), evidence="proven")
    if study.kicks is not None:
        yield Fact("Proven", proven_kicks_words(study.kicks), evidence="proven")
    if study.states is not None:
        up_to = study.wording.velocity(study.required.kick)
        yield Fact("Proven", proven_states_words(study.states, up_to, study.rotor.scales), evidence="proven")
    if study.bearing_demand is not None:
        yield Fact("Magnetic bearings", actuator_words(study.bearing_demand))
    if study.other_walls:
        words, values = wall_words(study.wording, study.other_walls), wall_values(study.other_walls, study.rotor.scales)
        yield Fact("Touchdown bearing", words, evidence="sampled", values=values)
    if study.loads is not None:
        for text in study.loads.words.split("\n"):
            yield Fact("Touchdown loads", text)
    yield from unfinished_facts(study.unfinished)
    for text in not_covered(study):
        yield Fact("Not covered", text)


def not_covered(study: StudyData) -> tuple[str, ...]:
    """What the study does not cover; of other models than the planar rotor also what only its closed forms say."""
    of_model = NOT_COVERED_UNDER_WEIGHT if study.heavy else NOT_COVERED_OF_MATRICES
    covered = list(NOT_COVERED if study.known.orbits else (*NOT_COVERED[:-1], *of_model))
    if study.kicks is not None and study.kicks.share:
        covered[SAMPLED] = NOT_COVERED_BUT_KICKS
    if (study.rotor.system.arrays["stiffness"] > 0.0).any():
        covered[WALL] = NOT_COVERED_OF_WALLS
    if study.rotor.system.limits:
        covered.append(NOT_COVERED_AT_LIMITS)
    return tuple(covered)


def verdict(study: StudyData, found: Sequence[Fact]) -> Verdict:
    """Write the verdict of a study from its facts."""
    level, outcome, reason = judged(study)
    facts = {fact.label: fact.text for fact in about(found, "Verdict")}
    survived = [
        f"{label}{'' if label == 'Shock' else ':'} {facts[label]}." for label in KINDS.values() if label in facts
    ]
    if "Share" in facts:
        survived.append(f"It must survive {facts['Must survive']}; {facts['Share']}.")
    if "Elsewhere" in facts:
        survived.append(f"Apart from what is required: {facts['Elsewhere']}.")
    if "Certain" in facts:
        survived.append(f"Proven: {facts['Certain']}.")
    return Verdict(level, outcome, reason, tuple(survived))
