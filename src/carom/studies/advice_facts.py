"""The facts of the recommendation: one page, the same in the terminal and in the report."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

from carom.base.outcome import Outcome
from carom.models import Edge
from carom.parameters import in_terms_of
from carom.parameters.formats import format_entry, number
from carom.studies.advice import GAIN_FACTOR, Change, evidence_of
from carom.studies.endings import motion_words
from carom.studies.facts import Evidence, Fact
from carom.studies.ranges import event_words
from carom.studies.study_data import StudyData
from carom.studies.wording import Wording, entry_words, present_values

CHANGES = ("Change", "Or")
"""Labels of the changes that help."""
_NO_CHANGE = {
    "no-change-needed": "none needed to survive the requirement",
    "not-decided": "undecided: too few of the required disturbances could be followed to their end",
    "no-change-found": f"none found that brings back every required disturbance and changes no gain by more than a factor of {number(GAIN_FACTOR)}",
}
_HOW_SURE = "closed form: exact; searched: complete lists of orbits at closely spaced values; sampled: random disturbances, so rare ones may end elsewhere; results not marked 'proven' are not proven"
_LAST_ZONE = "D"
_fact = partial(Fact, "Recommendation")


def advice_facts(study: StudyData) -> Iterator[Fact]:
    """The machine, what it does now, the changes that help, and how sure all this is."""
    say, si, recommended = study.wording, study.case.si, study.recommendation
    shown = [present_values(study.case)]
    shown += [f"{name} {format_entry(name, si[name])}" for name in ("mass", "clearance", "eccentricity") if name in si]
    yield _fact(", ".join(shown), "Machine")
    kind = recommended.kind
    if kind in _NO_CHANGE:
        finished = all(entry.complete and entry.searched for entry in study.recoveries)
        but = ", but the search was not finished" if kind == "no-change-found" and not finished else ""
        yield _fact(f"{_NO_CHANGE[kind]}{but}", "Change", "sampled")
    for place, change in enumerate(recommended.changes):
        yield _fact(_change(study, change), CHANGES[min(place, 1)], values=change.document(say))
        for label, text, sure in _details(study, change):
            yield _fact(text, label, sure, detail=True)
    for margin in recommended.margins:
        name, end, own = margin.parameter, margin.edge.value, study.case.parameters.value(margin.parameter)
        side = "above" if own > end else "below"
        text = f"{say.name(name)} {say.value(name, own)} is {number(100.0 * margin.share, 2)} % {side} {say.value(name, end)}, {_where(margin.edge)}"
        values = say.in_both(name, present=own) | margin.document(say)
        yield _fact(text, "Margin", evidence_of(margin.edge), values, detail=True)
    of_now = "" if study.proof is None else "; proofs hold for the present values, not for the change"
    yield _fact(f"{_HOW_SURE}{of_now}.", "How sure")


def _change(study: StudyData, change: Change) -> str:
    """The change in the terms of the machine file, what it is in others, and how far beyond it was searched."""
    name, terms = change.parameter, change.terms
    # ω varies with the square root of the stiffness.
    what = "stiffness" if name == "omega" and not study.wording.of_machine else study.wording.name(name)
    times = "none at present" if math.isinf(change.ratio) else f"{what} × {number(change.ratio, 3)}"
    now, far = (in_terms_of(study.case, name, value).text for value in (change.present, change.far.value))
    bound, searched = ("", "") if change.bound == "about" else (f"{change.bound} ", f", searched to {far}")
    return f"{entry_words(terms.entry)} {now} → {bound}{terms.text} ({', '.join([*terms.beside, times])}){searched}"


def _details(study: StudyData, change: Change) -> Iterator[tuple[str, str, Evidence | None]]:
    """Label, text and evidence of the lines under a change: how to try it, margin, levitation there, what was tried, what remains."""
    say, margin, zone = study.wording, change.margin, f"zone {change.zone}"
    yield "Set", f'--set "{change.terms.setting}"', None
    text = f"{number(100.0 * margin.share, 2)} % beyond {_end(say, margin.parameter, margin.edge)}"
    text += f"; stay on this side of {_end(say, change.parameter, change.far)}" if change.bound == "about" else ""
    yield "Margin", text, None
    if change.zone == _LAST_ZONE:
        zone = f"{'still ' if study.zone == _LAST_ZONE else ''}{zone}: the unbalance must be reduced too"
    yield "Then", f"levitates at a radius of {say.length(change.radius)}, {zone}", "closed form"
    yield "Tried", _tried(study, change), "sampled"
    if change.whirl is not None:
        fast = say.velocity(change.whirl.certain)
        text = f"{Outcome.ROLLING.words}: certain to begin if, in lasting contact, the rotor centre moves backward faster than {fast}"
        yield "Remains", text, "closed form"


def _tried(study: StudyData, change: Change) -> str:
    """Say how many fresh disturbances were followed at the value, and that all came back."""
    drawn, largest = change.check.drawn, sum(share.total for share in change.check.largest)
    return (
        f"all of {drawn.total:,} new disturbances up to {study.wording.velocity(study.required.kick)}, and {largest:,} at full size, "
        f"came back (95 % confidence: at least {number(100.0 * drawn.low, 4)} % do)"
    )


def _end(say: Wording, name: str, edge: Edge) -> str:
    return f"{say.value(name, edge.value)}, {_where(edge)} ({evidence_of(edge)})"


def _where(edge: Edge) -> str:
    """Say what happens at the end of a range."""
    if edge.motion is not None:
        return f"beyond which disturbances ended in {motion_words(edge.motion)}"
    return f"where {event_words(edge)}"
