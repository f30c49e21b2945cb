"""What a study has found, as a list of facts: the headline, the page of advice, the report and the JSON document show this list."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any, Literal

from carom.base.results import record

Evidence = Literal["proven", "closed form", "searched", "sampled", "stated", "default"]
Topic = Literal[
    "Verdict",
    "Recommendation",
    "Levitation",
    "Critical speeds",
    "Rub",
    "Bouncing",
    "Backward whirl",
    "Disturbances tried",
    "What would change it",
    "Proven",
    "Magnetic bearings",
    "Touchdown loads",
    "Drop",
    "Accuracy",
    "Not reached",
    "Not covered",
]


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

    topic: Topic
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


def about(facts: Sequence[Fact], topic: Topic) -> tuple[Fact, ...]:
    """The facts of one topic."""
    return tuple(fact for fact in facts if fact.topic == topic)


def paragraphs(facts: Sequence[Fact]) -> list[tuple[Topic, list[str]]]:
    """The facts of each topic as text, without the verdict and the recommendation: topic and paragraphs."""
    rest = [fact for fact in facts if fact.topic not in ("Verdict", "Recommendation")]
    return [(topic, [fact.text for fact in alike]) for topic, alike in groupby(rest, key=lambda fact: fact.topic)]
