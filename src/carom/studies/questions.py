"""The questions of a study, how many events each may take, and what is stated where these did not suffice.

An event, an impact or a step of lasting contact, takes some 10 microseconds, of a rotor of 64 modes 70; a motion without contact counts as
60.  Motions of planar rotors on a rigid wall do not count (:mod:`carom.motions.budget`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from carom.base.results import record
from carom.models import Rotor
from carom.motions.budget import Question
from carom.studies.facts import Fact
from carom.studies.wording import listed

DESCRIBED, PRESENT = "where disturbances end", "the share of {} that comes back"
SMALLEST = "the smallest {} that does not come back"
ALONG = "recovery along {}"
CHANGE = "the least change"
FULL_SIZE, DROP = "what must be survived, at its full size all around", "the drop"
EVENTS = {
    DESCRIBED: 100_000,
    PRESENT: 300_000,
    SMALLEST.format("kick"): 200_000,
    SMALLEST.format("shock"): 150_000,
    SMALLEST.format("loss of a blade"): 100_000,
    ALONG: 120_000,
    CHANGE: 100_000,
    FULL_SIZE: 100_000,
    DROP: 20_000,
}
"""Events of each question, some 1.3 million in all; the kinds of disturbances that must be survived share the second and the last but one equally."""
UNFINISHED = "question=words followed asked"
FEW_MODES, MANY_MODES = 4, 16
"""Modes up to which an event costs about the same, of more it costs in proportion, and so many fewer are followed; and modes above which searches are coarser."""
FEWEST = 60
"""Disturbances of a kind of which none is lost for a verdict that they came back: otherwise one in twenty might be lost unseen."""


def events_for(rotor: Rotor, question: str) -> int:
    """Events of a question for a rotor."""
    return round(EVENTS[question] * min(1.0, FEW_MODES / rotor.system.modes))


def unfinished_facts(questions: Sequence[Question]) -> Iterator[Fact]:
    """What was not followed to its end, and how much of it was."""
    if questions:
        shown = [f"{each.words} ({each.followed:,} of {each.asked:,} motions)" for each in questions]
        text = (
            f"Not followed to the end: {listed(shown)}. Each question of a study has a fixed number of events, so that "
            "its answer does not depend on the computer; a time limit ends it earlier."
        )
        yield Fact("Not reached", text, values={"questions": [record(each, UNFINISHED) for each in questions]})
