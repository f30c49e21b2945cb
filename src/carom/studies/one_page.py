"""The recommendation on one page, as lines with labels: the same in the terminal and in the report."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from carom.studies.advice import WANTED
from carom.studies.endings import came_back
from carom.studies.recommendation import Bound, Change, Margin, evidence_of
from carom.studies.remedies import check_words
from carom.studies.wording import counted, listed, number, present_values

if TYPE_CHECKING:
    from carom.closed_forms.thresholds import Gain
    from carom.studies.assembly import Study
    from carom.studies.ranges import Edge

EVENTS = {
    "boundary-equilibrium": "levitation reaches the wall",
    "rub-fold": "a stable and an unstable rub meet (fold)",
    "fold": "two orbits meet (fold)",
    "speed-fold": "two orbits of one period meet (fold)",
    "grazing": "an orbit grazes the wall between its impacts",
    "non-smooth-hopf": "an orbit shrinks into levitation on the wall (non-smooth Hopf)",
    "slip-stop": "friction begins to stop the slip in the impacts of an orbit",
    "contact-onset": "an orbit begins to stay on the wall after its impact",
    "period-doubling": "an orbit loses its stability (period doubling)",
    "neimark-sacker": "an orbit loses its stability (Neimark-Sacker)",
    "vanishing-period": "the period of an orbit shrinks to zero",
    "rolling-limit": "friction just keeps the rotor rolling at every angle",
}
"""What happens at the ends of the ranges of motions."""
_BOUNDS: dict[Bound, str] = {"at least": "at least ", "at most": "at most ", "about": ""}


@dataclass(frozen=True)
class Line:
    """A line of the page.  A detail belongs to the last line above it that is not a detail."""

    label: str
    text: str
    detail: bool = False


def recommendation_lines(study: Study) -> list[Line]:
    """Return the lines of the page: the machine, what it does now, the changes, and the evidence."""
    lines = [Line("Machine", _machine(study)), Line("Now", _now(study))]
    recommended = study.recommendation
    lost = study.verdict.level != "all-tried-came-back"
    for place, change in enumerate(recommended.changes):
        label = "Or" if place else "Change" if lost else "For levitation alone"
        lines += [Line(label, _change(study, change)), *_details(study, change)]
    if recommended.kind == "no-change-found":
        lines.append(Line("Change", _none_found(study)))
    elif recommended.kind == "no-change-needed":
        lines.append(Line("Change", "none needed for the disturbances tried (sampled)"))
        lines += [Line("Margin", _own_margin(study, gain, margin), detail=True) for gain, margin in recommended.margins]
    return [*lines, Line("Disturbances", _disturbances(study)), Line("How sure", _how_sure(study))]


def _machine(study: Study) -> str:
    """The present values in a line."""
    machine, told = study.case.machine, present_values(study.case)
    if machine is None:
        return told
    more = [
        f"{name} {study.wording.field(name, getattr(machine, name))}" for name in ("mass", "clearance", "eccentricity")
    ]
    return ", ".join([told, *more])


def _now(study: Study) -> str:
    levitation, tried = study.equilibria[0], study.attractors.disturbances
    back = f"{came_back(tried)} of {counted(len(tried), 'disturbance')} came back (sampled)"
    if study.fresh is not None:
        back += f", {study.fresh.sample.count - study.fresh.lost:,} of {study.fresh.sample.count:,} fresh ones too (sampled)"
    if not study.levitates:
        return f"{study.verdict.outcome.lower()} (closed form)"
    return f"levitates at {_place(study, levitation.radius)}, zone {study.zone} (closed form); {back}"


def _place(study: Study, radius: float) -> str:
    """Return a radius with the clearance beside it where lengths are known."""
    if study.wording.scales is None:
        return f"{number(radius, 3)} of the clearance"
    return f"a radius of {study.wording.length(radius)} (clearance {study.wording.length(1.0)})"


def _change(study: Study, change: Change) -> str:
    say, gain, value = study.wording, change.gain, change.advice.value
    ratio = "there is none now" if math.isinf(change.advice.change) else f"× {number(change.advice.change, 3)}"
    if say.scales is None and gain == "omega":
        ratio = f"stiffness {ratio}"  # It is the square of ω.
    name, present = say.gain_name(gain), say.gain(gain, change.present)
    text = f"{name} {present} → {_BOUNDS[change.bound]}{say.gain(gain, value)} ({ratio})"
    if change.bound == "about":
        return text
    farthest = max((tried.values[-1] for tried in change.tried), key=lambda at: abs(at - value))
    return f"{text}, tried {'up' if farthest > value else 'down'} to {say.gain(gain, farthest)}"


def _details(study: Study, change: Change) -> list[Line]:
    """The lines under a change: margin, levitation there, what was tried, what remains."""
    lines = [
        Line("Margin", _margin(study, change.gain, change.margin, change.far)),
        Line("Then", f"levitates at {_place(study, change.radius)}, zone {change.zone} (closed form)"),
        Line("Tried", _tried(study, change)),
    ]
    if change.whirl is not None:
        fast = study.wording.velocity(change.whirl.certain)
        remains = f"rolling backward whirl: it surely begins if, in lasting contact, the centre moves backward faster than {fast}"
        lines.append(Line("Remains", f"{remains} (closed form)"))
    return [Line(line.label, line.text, detail=True) for line in lines]


def _tried(study: Study, change: Change) -> str:
    """Say how many disturbances were followed at the value and beyond it, and how many came back."""
    say, gain, value = study.wording, change.gain, change.advice.value
    text = f"sampled: {check_words(study, change.advice)}"
    others = []
    for tried in change.tried:
        last = tried.values[-1]
        places = f"{counted(len(tried.values), 'value')} {'up' if last > value else 'down'} to {say.gain(gain, last)}"
        others.append(f"of {tried.disturbances:,} at {'each of ' if len(tried.values) > 1 else ''}{places}")
    return f"{text}; beyond it none was lost {listed(others)}" if others else f"{text}; no value beyond it was tried"


def _margin(study: Study, gain: Gain, margin: Margin | None, far: Edge | None) -> str:
    say = study.wording
    if margin is None:
        share = f"{number(100.0 * WANTED, 3)} %"
        return f"none: no value tried leaves only levitation, and this one brings back at least {share} (sampled)"
    text = f"{number(100.0 * margin.share, 2)} % beyond {say.gain(gain, margin.edge.value)}, {_where(margin.edge)} ({evidence_of(margin.edge)})"
    if far is None:
        return text
    other = evidence_of(far)
    return f"{text}; stay on this side of {say.gain(gain, far.value)}, {_where(far)} ({other})"


def _own_margin(study: Study, gain: Gain, margin: Margin) -> str:
    say = study.wording
    own, end = study.case.parameters.value(gain), margin.edge.value
    side = "above" if own > end else "below"
    name, present = say.gain_name(gain), say.gain(gain, own)
    share = f"{number(100.0 * margin.share, 2)} % {side} {say.gain(gain, end)}"
    return f"{name} {present} is {share}, {_where(margin.edge)} ({evidence_of(margin.edge)})"


def _where(edge: Edge) -> str:
    """Say what happens at the end of a range."""
    if edge.motion is not None:
        return f"beyond which disturbances ended in {edge.motion.words}"
    return f"where {EVENTS.get(edge.kind, f'an orbit ends ({edge.kind})')}"


def _none_found(study: Study) -> str:
    say = study.wording
    searched = [
        f"{say.gain_name(entry.gain)} from {say.gain(entry.gain, entry.searched.low.value)} to "
        f"{say.gain(entry.gain, entry.searched.high.value)}"
        for entry in study.ranges
        if entry.motion == "single-impact" and entry.searched is not None
    ]
    if not searched:
        return "none found: no range of damping or stiffness could be searched"
    return f"none found that leaves only levitation, of {' and '.join(searched)}, each alone (sampled)"


def _disturbances(study: Study) -> str:
    fastest = study.wording.velocity(study.safe_damping.sample.fastest)
    return (
        f"velocity kicks of the levitating rotor, and starts anywhere within the clearance, both of up to {fastest}; "
        "of faster ones, and of other kinds, nothing is said"
    )


def _how_sure(study: Study) -> str:
    text = (
        "closed form: exact; searched: complete lists of orbits at values close together; sampled: seeded random "
        "disturbances, so that rare ones may end elsewhere. "
    )
    if study.proof is None:
        return text + "None of it is proven."
    return text + "Proven is only what “Proven” says of the present values, not the change."


def recommendation_document(study: Study) -> dict[str, Any]:
    """Return the same page as numbers, with its lines as text."""
    recommended, sample = study.recommendation, study.safe_damping.sample
    scales = study.wording.scales
    return {
        "kind": recommended.kind,
        "changes": [_change_document(study, change) for change in recommended.changes],
        "margins": [
            {
                **_in_both(study, gain, present=study.case.parameters.value(gain)),
                **_margin_document(study, gain, margin),
            }
            for gain, margin in recommended.margins
        ],
        "fastest": sample.fastest,
        **({} if scales is None else {"fastest_si": sample.fastest * scales.velocity}),
        "text": [
            {"label": line.label, "text": line.text, "detail": line.detail} for line in recommendation_lines(study)
        ],
    }


def _change_document(study: Study, change: Change) -> dict[str, Any]:
    advice, gain, scales = change.advice, change.gain, study.wording.scales
    document = {
        **_in_both(study, gain, present=change.present, value=advice.value),
        "bound": change.bound,
        "ratio": advice.change,
        "margin": None if change.margin is None else _margin_document(study, gain, change.margin),
        "other_end": None if change.far is None else _end_document(study, gain, change.far),
        "disturbances": advice.returned.total,
        "recovered": advice.returned.count,
        "share_low": advice.returned.low,
        "tried": [
            {"values": list(tried.values), "disturbances": tried.disturbances, "lost": 0} for tried in change.tried
        ],
        "radius": change.radius,
        "zone": change.zone,
        "rolling_from": None if change.whirl is None else change.whirl.certain,
    }
    if scales is not None:
        document["radius_si"] = change.radius * scales.length
        document["rolling_from_si"] = None if change.whirl is None else change.whirl.certain * scales.velocity
    return document


def _margin_document(study: Study, gain: Gain, margin: Margin) -> dict[str, Any]:
    return {**_end_document(study, gain, margin.edge), "share": margin.share}


def _end_document(study: Study, gain: Gain, edge: Edge) -> dict[str, Any]:
    ends = _in_both(study, gain, end=edge.value)
    return {**ends, "at_end": edge.motion or edge.kind, "evidence": evidence_of(edge)}


def _in_both(study: Study, gain: Gain, **values: float) -> dict[str, Any]:
    """Return values of a gain, with those in SI units if the machine is known."""
    say = study.wording
    document: dict[str, Any] = {"parameter": gain, **values}
    if say.scales is not None:
        document["quantity"] = say.gain_name(gain)
        document |= {f"{name}_si": say.gain_in_si(gain, value) for name, value in values.items()}
    return document
