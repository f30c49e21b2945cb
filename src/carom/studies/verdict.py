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
from carom.studies.kinds import LABELS
from carom.studies.levitation_facts import bearing_facts, critical_speed_facts, levitation_facts
from carom.studies.proven import proven_kicks_words, proven_states_words, proven_words
from carom.studies.questions import unfinished_facts
from carom.studies.rigid_limit import wall_values, wall_words
from carom.studies.study_data import StudyData
from carom.studies.touchdown_facts import accuracy_facts, drop_facts, drop_headline, load_facts
from carom.studies.verdict_facts import Level, judged, verdict_facts

SAMPLED = (
    "Disturbances other than those simulated. They are samples: one between them, or a larger one, may end elsewhere."
)
SAMPLED_BUT_KICKS = (
    "Disturbances other than those simulated, but for the kicks that are proven to come back. They are samples: one between them, or a "
    "larger one, may end elsewhere."
)
"""The same if kicks are proven to come back."""
LONGER_MOTIONS = (
    "Periodic motions with two or more impacts a period, bouncing that never repeats, and motions that alternate "
    "between bounces and lasting contact. They are named only if a simulated disturbance ended in one."
)
RIGID_WALL = (
    "A touchdown bearing that moves, turns or gives way: the wall is rigid, so the load of an impact is an impulse."
)
COMPLIANT_WALL = "Wear, heat and axial motion of the touchdown bearing: its law is taken as it is stated."
PLANAR = (
    "Changes of speed, gravity, a rotor that bends or tilts, and controllers that do more than a spring and a damper."
)
MATRICES = "Changes of speed, gravity, and controllers that add states of their own."
WEIGHT = "Changes of speed, and controllers that add states of their own."
SYMMETRY = (
    f"What rests on the symmetry of a turn: {STEADY_WORDS['rub']}s, orbits in closed form, and that a kick does the same whatever the angle of the "
    "unbalance is as it strikes. Here that is the angle in the machine file; with others some kicks may end elsewhere."
)
CLOSED_FORMS = (
    "What is known in closed form for the planar rotor alone: whether rolling lasts and from which speed whirl runs away to it, for "
    "which damping and stiffness each motion exists, how levitation ends, and that no orbit is missing."
)
FLEXIBLE = (
    "Limits of the magnetic bearings that the file does not state, magnetic bearings whose axes differ, coefficients of supports at other speeds, and changes of speed.",
    "Damping of the shaft as it turns with it.",
)
AT_LIMITS = (
    "Other angles of the unbalance to the axes of the magnetic bearings, along which their limits act, as a disturbance strikes than that of the "
    "machine file. Saturation of the iron and limits of the voltage are not modelled."
)
NOT_COVERED = (SAMPLED, LONGER_MOTIONS, RIGID_WALL, PLANAR)
"""What the study of a planar rotor in a rigid wall does not cover."""


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
    yield from drop_headline(study)
    yield from advice_facts(study)
    for topic, write in FINDINGS.items():
        for text in write(study).split("\n") if study.recoveries or topic != "What would change it" else ():
            yield Fact(topic, text)
        if topic == "Levitation":
            yield from levitation_facts(study.levitating)
            yield from critical_speed_facts(study.levitating)
    yield from _proofs(study)
    yield from bearing_facts(study.levitating)
    if study.bearing_demand is not None:
        yield Fact("Magnetic bearings", actuator_words(study.bearing_demand))
    if study.other_walls:
        words, values = wall_words(study.wording, study.other_walls), wall_values(study.other_walls, study.rotor.scales)
        yield Fact("Touchdown bearing", words, evidence="sampled", values=values)
    yield from load_facts(study)
    yield from drop_facts(study)
    yield from accuracy_facts(study)
    yield from unfinished_facts(study.unfinished)
    for text in not_covered(study):
        yield Fact("Not covered", text)


def _proofs(study: StudyData) -> Iterator[Fact]:
    if study.proof is not None:
        yield Fact("Proven", proven_words(study.proof), evidence="proven")
    if study.kicks is not None:
        yield Fact("Proven", proven_kicks_words(study.kicks), evidence="proven")
    if study.states is not None:
        up_to = study.wording.velocity(study.required.kick)
        yield Fact("Proven", proven_states_words(study.states, up_to, study.rotor.scales), evidence="proven")


def not_covered(study: StudyData) -> tuple[str, ...]:
    """What the study does not cover, by what the rotor has."""
    compliant = bool((study.rotor.system.arrays["stiffness"] > 0.0).any())
    found = [
        SAMPLED_BUT_KICKS if study.kicks is not None and study.kicks.share else SAMPLED,
        LONGER_MOTIONS,
        COMPLIANT_WALL if compliant else RIGID_WALL,
    ]
    if study.reduced is not None:
        found += [*FLEXIBLE, *([SYMMETRY] if study.heavy else []), CLOSED_FORMS]
    elif study.heavy:
        found += [WEIGHT, SYMMETRY, CLOSED_FORMS]
    else:
        found += [PLANAR] if study.known.orbits else [MATRICES, CLOSED_FORMS]
    return (*found, AT_LIMITS) if study.rotor.system.limits else tuple(found)


def verdict(study: StudyData, found: Sequence[Fact]) -> Verdict:
    """Write the verdict of a study from its facts."""
    level, outcome, reason = judged(study)
    facts = {fact.label: fact.text for fact in about(found, "Verdict")}
    survived = [
        f"{label}{'' if label == 'Shock' else ':'} {facts[label]}." for label in LABELS.values() if label in facts
    ]
    if "Share" in facts:
        survived.append(f"It must survive {facts['Must survive']}; {facts['Share']}.")
    if "Elsewhere" in facts:
        survived.append(f"Apart from what is required: {facts['Elsewhere']}.")
    if "Certain" in facts:
        survived.append(f"Proven: {facts['Certain']}.")
    if "Drop" in facts:
        survived.append(f"In a drop: {facts['Drop']}.")
    return Verdict(level, outcome, reason, tuple(survived))
