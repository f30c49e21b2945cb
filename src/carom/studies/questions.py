"""What a machine may have to survive, the questions of a study, how many events each may take, and the form of its answers.

An event, an impact or a step of lasting contact, takes some 10 microseconds, of a rotor of 64 modes 70; a motion without contact counts as
60.  Motions of planar rotors on a rigid wall do not count (:mod:`carom.motions.budget`).  Headline, report and JSON show one list of facts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any, Literal, cast

from carom.base.results import record
from carom.disturbances import BaseRecord, BaseShock, BladeLoss, Disturbance, Sample, VelocityKick
from carom.models import Rotor
from carom.parameters import Required

Kind = Literal["kick", "shock", "base_record", "blade_loss"]
"""Kinds of disturbances that a machine may have to survive."""
OF_ANOTHER_KIND = 0.2
"""Number of shocks, and of losses of a blade, relative to that of kicks, where such are required."""
LABELS: dict[Kind, str] = {"kick": "Kick", "shock": "Shock", "base_record": "Base record", "blade_loss": "Blade loss"}
DESCRIBED, PRESENT = "the outcomes of disturbances", "the share of {} that comes back"
SMALLEST = "the smallest {} that do not come back"
ALONG = "recovery along {}"
CHANGE = "the least change"
FULL_SIZE, DROP = "required disturbances at full size, in all directions", "the drop"
SPIN_DOWN = "the spin-down"
EVENTS = {
    DESCRIBED: 100_000,
    PRESENT: 300_000,
    SMALLEST.format(VelocityKick.noun): 200_000,
    SMALLEST.format(BaseShock.noun): 150_000,
    SMALLEST.format(BaseRecord.noun): 150_000,
    SMALLEST.format(BladeLoss.noun): 100_000,
    ALONG: 120_000,
    CHANGE: 100_000,
    FULL_SIZE: 100_000,
    DROP: 20_000,
    SPIN_DOWN: 100_000,
}
"""Events of each question, some 1.4 million in all; the kinds of disturbances that must be survived share the second and the last but one equally."""
UNFINISHED = "question=words followed asked"
FEW_MODES, MANY_MODES = 4, 16
"""Modes up to which an event costs about the same, of more it costs in proportion, and so many fewer are followed; and modes above which searches are coarser."""
GROWTH = 1e-12
"""Of small vibrations in a radian of the turn, up to which it is rounding."""
FEWEST = 60
"""Disturbances of a kind of which none is lost for a verdict that they came back: otherwise one in twenty might be lost unseen."""


def required_disturbances(required: Required, count: int) -> tuple[Sample, ...]:
    """Kinds of disturbances that a machine must survive, with the number of each; ``count`` is that of kicks.

    Kicks out of levitation, uniform over the disc of their velocities; shocks and losses of a blade where they are required.
    """
    more = max(1, round(OF_ANOTHER_KIND * count))
    kinds = required_kinds(required)
    return tuple(Sample(model, count if kind == "kick" else more) for kind, _, model in kinds)


def required_kinds(required: Required) -> Iterator[tuple[Kind, float, Disturbance]]:
    """The kinds that must be survived, with their size, in the order of :func:`required_disturbances`."""
    yield "kick", required.kick, VelocityKick(required.kick)
    if required.shock:
        yield "shock", required.shock.peak, BaseShock(required.shock.peak, required.shock.duration)
    if (record := required.base_record) is not None:
        yield "base_record", record.largest, cast("BaseRecord", record)
    if required.blade_loss:
        yield "blade_loss", required.blade_loss, BladeLoss(required.blade_loss, required.blade_loss_node)


def events_for(rotor: Rotor, question: str) -> int:
    """Events of a question for a rotor."""
    return round(EVENTS[question] * min(1.0, FEW_MODES / rotor.system.modes))


Evidence = Literal["proven", "closed form", "searched", "sampled", "stated", "default"]


@dataclass(frozen=True)
class Fact:
    """Something that a study has found.

    Attributes
    ----------
    topic : str
        Under which heading it stands.
    text : str
        The fact in words, in the units of the machine; speeds are those of the fixed frame.
    label : str
        What it is about, in a word or two.
    evidence : str or None
        How sure it is: proven; by a closed form; searched with complete lists of motions at many values; sampled by simulated
        disturbances; stated by the user; a default.  ``None`` where the text says it.
    values : mapping
        Its numbers, as plain data for JSON.
    detail : bool
        Whether it belongs to the last fact before it that is no detail.
    """

    topic: str
    text: str
    label: str = ""
    evidence: Evidence | None = None
    values: Mapping[str, Any] = field(default_factory=dict)
    detail: bool = False

    @property
    def sentence(self) -> str:
        """The text with the evidence behind it."""
        return f"{self.text} ({self.evidence})" if self.evidence else self.text

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return record(self, "topic label text evidence values detail")


def about(facts: Sequence[Fact], topic: str) -> tuple[Fact, ...]:
    """The facts of one topic."""
    return tuple(fact for fact in facts if fact.topic == topic)


def paragraphs(facts: Sequence[Fact]) -> list[tuple[str, list[str]]]:
    """The facts of each topic as text, without the verdict and the recommendation: topic and paragraphs."""
    rest = [fact for fact in facts if fact.topic not in ("Verdict", "Recommendation")]
    return [(topic, [fact.text for fact in alike]) for topic, alike in groupby(rest, key=lambda fact: fact.topic)]
