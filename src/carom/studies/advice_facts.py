"""The facts of the recommendation: one page, the same in the terminal and in the report."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from carom.basins.changes import WANTED
from carom.models import Edge
from carom.outcome import Outcome
from carom.parameters import in_terms_of
from carom.parameters.told import number, told_entry
from carom.results import fields_of, in_si
from carom.studies.advice import GAIN_FACTOR, Change, Margin, evidence_of
from carom.studies.endings import motion_words
from carom.studies.facts import Evidence, Fact
from carom.studies.ranges import event_words
from carom.studies.recovery import Recovery, power_of
from carom.studies.study_data import StudyData
from carom.studies.trials import Check, Lost
from carom.studies.verdict_facts import judged
from carom.studies.wording import Wording, counted, entry_words, present_values

CHANGES = ("Change", "Or")
"""Labels of the changes that help."""
BEYOND = "Beyond the limits"
"""Label of the changes that ask for more than the magnetic bearings can give."""
_NOTHING_BUILDABLE = (
    "nothing that the magnetic bearings can give helps: every change found that brings all back asks for more than their "
    "limits, so that the real machine moves otherwise; larger limits, less unbalance or a larger clearance are needed"
)
_NO_CHANGE = {
    "no-change-needed": "none needed for what the machine must survive",
    "not-decided": "not decided: too few of the disturbances that the machine must survive could be followed",
    "nothing-buildable": _NOTHING_BUILDABLE,
}
_HOW_SURE = (
    "closed form: exact; searched: complete lists of orbits at values close together; sampled: seeded random "
    "disturbances, so that rare ones may end elsewhere."
)
_LAST_ZONE = "D"


def advice_facts(study: StudyData) -> Iterator[Fact]:
    """The machine, what it does now, the changes that help, and how sure all this is."""
    say, machine, told = study.wording, study.case.machine, present_values(study.case)
    if machine is not None:
        names = ("mass", "clearance", "eccentricity")
        told = ", ".join([told, *(f"{name} {told_entry(name, getattr(machine, name))}" for name in names)])
    yield _fact("Machine", told)
    _, outcome, _ = judged(study)
    verb = "levitates, with sag and whirl out to" if study.heavy else "levitates at"
    levitates = f"{verb} {_place(say, study.equilibria[0].radius)}, zone {study.zone}"
    yield _fact("Now", levitates if study.levitates else outcome.lower(), "closed form")
    recommended = study.recommendation
    unbuildable = recommended.kind == "nothing-buildable"
    if recommended.kind in _NO_CHANGE:
        yield _fact("Change", _NO_CHANGE[recommended.kind], "sampled")
    for place, change in enumerate(recommended.changes):
        label = BEYOND if unbuildable else "Or" if place else "Change"
        yield _fact(label, _change(study, change), values=change_document(study, change))
        yield from _details(study, change)
    if recommended.kind == "no-change-found":
        yield _fact("Change", _none_found(study), "sampled")
    for margin in recommended.margins:
        present = _in_both(study, margin.parameter, present=study.case.parameters.value(margin.parameter))
        values = present | _margin_document(study, margin)
        yield _fact(
            "Margin", _own_margin(say, present["present"], margin), evidence_of(margin.edge), values, detail=True
        )
    for recovery in () if recommended.kind in ("no-change-needed", "not-decided") else study.recoveries:
        if recovery.searched and recovery.complete and not recovery.spans:
            yield _fact("Not by this gain", _not_by(study, recovery), "sampled")
    yield _fact("Disturbances", _disturbances(study))
    proven = "Only what is called proven is."
    if study.proof is not None:
        proven = "Proven is only what “Proven” says of the present values, not the change."
    yield _fact("How sure", f"{_HOW_SURE} {proven}")


def _fact(
    label: str, text: str, evidence: Evidence | None = None, values: dict[str, Any] | None = None, detail: bool = False
) -> Fact:
    return Fact("Recommendation", text, label, evidence, values or {}, detail=detail)


def _place(say: Wording, radius: float) -> str:
    """Return a radius with the clearance beside it where lengths are known."""
    if say.scales is None:
        return f"{number(radius, 3)} of the clearance"
    return f"a radius of {say.length(radius)} (clearance {say.length(1.0)})"


def _change(study: StudyData, change: Change) -> str:
    """The change in the terms of the machine file, what it is in others, and how far beyond it was tried."""
    name, terms = change.parameter, change.terms
    # ω varies with the square root of the stiffness.
    what = "stiffness" if name == "omega" and not study.wording.of_machine else study.wording.name(name)
    times = "there is none now" if math.isinf(change.ratio) else f"{what} × {number(change.ratio, 3)}"
    now = _stated(study, name, change.present)
    bound, tried = ("", "") if change.bound == "about" else (f"{change.bound} ", f", tried {_farthest(study, change)}")
    return f"{entry_words(terms.entry)} {now} → {bound}{terms.text} ({', '.join([*terms.beside, times])}){tried}"


def _farthest(study: StudyData, change: Change) -> str:
    """How far beyond a change was tried: ``up to 60 N s/m``."""
    farthest = max((check.value for check in change.beyond), key=lambda at: abs(at - change.value))
    return f"{'up' if farthest > change.value else 'down'} to {_stated(study, change.parameter, farthest)}"


def _stated(study: StudyData, name: str, value: float) -> str:
    """A value as the file of the machine would state it."""
    return in_terms_of(study.case, name, value).text


def _details(study: StudyData, change: Change) -> Iterator[Fact]:
    """The lines under a change: how to try it, margin, levitation there, what was tried, what remains."""
    yield _fact("Set", f'--set "{change.terms.setting}"', detail=True)
    yield _fact("Margin", _margin(study, change), detail=True)
    zone = f"zone {change.zone}"
    if change.zone == _LAST_ZONE:
        worse = study.zone not in (None, _LAST_ZONE)
        still = "still " if study.zone == _LAST_ZONE else ""
        zone = f"{zone}, which is worse than now" if worse else f"{still}{zone}: less unbalance is needed too"
    yield _fact("Then", f"levitates at {_place(study.wording, change.radius)}, {zone}", "closed form", detail=True)
    yield _fact("Tried", _tried(study, change), "sampled", detail=True)
    for check in change.forced:
        yield _fact("Not nearer", _forced(study, change.parameter, check), "sampled", detail=True)
    if change.demand is not None:
        most = (
            f"{number(change.demand, 3)} times the largest rate of the current"
            if change.demand > 1.0
            else f"{number(100.0 * change.demand, 3)} % of the largest rate of the current"
        )
        beyond = "; values beyond it may ask for more" if change.beyond else ""
        asked = f"asked at this value for at most {most} of the magnetic bearings{beyond}"
        yield _fact("Bearings", asked, "sampled", detail=True)
    if change.whirl is not None:
        fast = study.wording.velocity(change.whirl.certain)
        remains = f"{Outcome.ROLLING.words}: it surely begins if, in lasting contact, the centre moves backward faster than {fast}"
        yield _fact("Remains", remains, "closed form", detail=True)


def _tried(study: StudyData, change: Change) -> str:
    """Say how many disturbances were followed at the value and beyond it, and how many came back."""
    text = check_words(study, change.check)
    if not change.beyond:
        return f"{text}; no value beyond it was tried"
    each = min(check.tried for check in change.beyond)
    several = "each of " if len(change.beyond) > 1 else ""
    places = f"{several}{counted(len(change.beyond), 'value')} {_farthest(study, change)}"
    return f"{text}; beyond it none was lost of {each:,} at {places}"


def check_words(study: StudyData, check: Check) -> str:
    """Say how many fresh disturbances were followed at a value, how fast they were, and how many came back."""
    drawn = check.drawn
    sample = f"{drawn.total:,} fresh disturbances of up to {study.wording.velocity(study.required.kick)}"
    at_most = f"{sum(share.total for share in check.largest):,} at their largest"
    if check.recovers:
        return f"all of {sample}, and {at_most}, came back (so at least {number(100.0 * drawn.low, 4)} % do, with 95 % confidence)"
    lost = sum(share.total - share.count for share in check.largest)
    low, high = (number(100.0 * share, 4) for share in (drawn.low, drawn.high))
    return (
        f"{drawn.count:,} of {sample} came back ({low} to {high} % do, with 95 % confidence); of {at_most} {lost or 'none'} "
        f"{'was' if lost <= 1 else 'were'} lost"
    )


def _forced(study: StudyData, name: str, check: Check) -> str:
    """Say which disturbance was lost at a nearer value."""
    lost = check.tried - check.drawn.count - sum(share.count for share in check.largest)
    example = f", such as {lost_words(study, check.example)}" if check.example else ""
    return f"at {_stated(study, name, check.value)} {lost:,} of {check.tried:,} {'was' if lost == 1 else 'were'} lost{example}"


def lost_words(study: StudyData, lost: Lost) -> str:
    """Describe a disturbance that was lost, by its coordinates."""
    along = lost.model.coordinates
    sizes = [
        f"{each.words} {each.told(value, study.wording.scales)}"
        for each, value in zip(along, lost.values, strict=False)
        if not each.periodic
    ]
    ends = f", which ends in {motion_words(lost.motion)}" if lost.motion else ""
    return (
        f"{_KINDS.get(lost.model.kind, lost.model.kind)} ({', '.join(sizes)}){ends}"
        if sizes
        else f"{lost.model.kind}{ends}"
    )


_KINDS = {"kick": "a kick", "state": "a start in the clearance", "shock": "a shock", "blade-loss": "a loss of a blade"}


def _margin(study: StudyData, change: Change) -> str:
    say, name, margin, far = study.wording, change.parameter, change.margin, change.far
    if margin is None:
        share = f"{number(100.0 * WANTED, 3)} %"
        return f"none: no value tried brings all back, and this one brings back at least {share} (sampled)"
    text = f"{number(100.0 * margin.share, 2)} % beyond {_end(say, name, margin.edge)}"
    return text if far is None else f"{text}; stay on this side of {_end(say, name, far)}"


def _end(say: Wording, name: str, edge: Edge) -> str:
    return f"{say.value(name, edge.value)}, {_where(edge)} ({evidence_of(edge)})"


def _own_margin(say: Wording, own: float, margin: Margin) -> str:
    name, end = margin.parameter, margin.edge.value
    share = f"{number(100.0 * margin.share, 2)} % {'above' if own > end else 'below'} {say.value(name, end)}"
    return f"{say.name(name)} {say.value(name, own)} is {share}, {_where(margin.edge)}"


def _where(edge: Edge) -> str:
    """Say what happens at the end of a range."""
    if edge.motion is not None:
        return f"beyond which disturbances ended in {motion_words(edge.motion)}"
    return f"where {event_words(edge)}"


def _none_found(study: StudyData) -> str:
    """Whether a change was looked for to the end."""
    if not all(entry.complete for entry in study.recoveries):
        return "none found, but the search for one was not finished"
    if not any(entry.searched for entry in study.recoveries):
        return "none found: no range of damping or stiffness could be searched"
    return "none found that brings back all that must be survived"


def _not_by(study: StudyData, found: Recovery) -> str:
    """In which range of a gain no value brings all back."""
    say, along = study.wording, found.along
    ends = found.searched[0].low, found.searched[-1].high
    low, high = (say.value(along.name, edge.value) for edge in ends)
    present = along.value(found.rotor)
    times = max((high.value / present) ** power_of(along) for high in ends[1:]) if present > 0.0 else math.inf
    beyond = (
        f"; a controller can hardly give more than {number(GAIN_FACTOR)} times of it"
        if times >= GAIN_FACTOR * 0.999
        else ""
    )
    return f"no {say.name(along.name)} from {low} to {high} brings back all that must be survived{beyond}"


def _disturbances(study: StudyData) -> str:
    say, required = study.wording, study.required
    text = f"velocity kicks out of levitation of up to {say.velocity(required.kick)}"
    if required.shock:
        text += f"; shocks of up to {say.acceleration(required.shock.peak)} over {say.time(required.shock.duration)}"
    if required.blade_loss:
        text += f"; losses of a blade of {say.unbalance(required.blade_loss)}"
    return f"{text}; of faster ones, and of other kinds, nothing is said"


def change_document(study: StudyData, change: Change) -> dict[str, Any]:
    """A change as plain data for JSON."""
    name, check = change.parameter, change.check
    document = {
        **_in_both(study, name, present=change.present, value=change.value),
        **fields_of(change, entry="terms.entry", set="terms.setting", bound="bound", ratio="ratio"),
        "margin": None if change.margin is None else _margin_document(study, change.margin),
        "other_end": None if change.far is None else _end_document(study, name, change.far),
        **fields_of(check.drawn, disturbances="total", recovered="count", share_low="low", share_high="high"),
        "at_their_largest": sum(share.total for share in check.largest),
        "recovered_at_their_largest": sum(share.count for share in check.largest),
        "not_nearer": [fields_of(each, value="value", disturbances="tried") for each in change.forced],
        "beyond": [fields_of(each, value="value", disturbances="tried") | {"lost": 0} for each in change.beyond],
        **fields_of(change, "radius", "zone"),
        "rolling_from": None if change.whirl is None else change.whirl.certain,
        **fields_of(change, "buildable", "demand"),
    }
    return document | in_si(document, study.wording.scales, "radius", rolling_from="velocity")


def _margin_document(study: StudyData, margin: Margin) -> dict[str, Any]:
    return _end_document(study, margin.parameter, margin.edge) | {"share": margin.share}


def _end_document(study: StudyData, name: str, edge: Edge) -> dict[str, Any]:
    return _in_both(study, name, end=edge.value) | {"at_end": edge.motion or edge.kind, "evidence": evidence_of(edge)}


def _in_both(study: StudyData, name: str, **values: float) -> dict[str, Any]:
    """Return values of a parameter, with those in SI units if the machine is known."""
    return {"parameter": name, **values, **study.wording.in_si(name, **values)}
