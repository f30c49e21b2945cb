"""The facts of the verdict: what the machine must survive, what it survives, and which share of kicks comes back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

from carom.basins import Share, SmallestLoss
from carom.disturbances.echo import ANY_INSTANT
from carom.models import depends_on_instant
from carom.outcome import REGULAR_BOUNCING, STEADY_WORDS, Outcome
from carom.results import fields_of, in_si
from carom.studies.endings import ending_words
from carom.studies.facts import Evidence, Fact
from carom.studies.findings import stable_rub
from carom.studies.kinds import LABELS, Kind, required_kinds
from carom.studies.proven import proven_kicks_document, states_return
from carom.studies.study_data import StudyData
from carom.studies.survives import decides
from carom.studies.wording import SIZES, listed

Level = Literal["no-contact-free-motion", "may-not-come-back", "not-decided", "all-tried-came-back"]
NEARLY_ALL = 0.95
"""Share from which on of disturbances that are lost it is said that nearly all are."""
_CHOSEN = {
    "file": "as its file says",
    "option": "as the options say",
    "default": "chosen by carom: the speed of a fall through the diametral clearance",
}


def verdict_facts(study: StudyData) -> Iterator[Fact]:
    """What must be survived, what of each kind is survived, shares, and what else may hold the rotor."""
    yield _required(study)
    if study.survives is not None:
        for name, found in study.survives.items():
            yield _survived(study, name, found)
    yield from _shares(study)
    if study.kicks is not None:
        yield Fact(
            "Verdict", study.kicks.words, "Certain", "proven", proven_kicks_document(study.kicks), disturbances="kick"
        )
    yield from _others(study)
    gone = [entry for entry in study.attractors if entry.name.outcome is Outcome.BEYOND_MODEL]
    if count := sum(entry.count for entry in gone):
        total = len(study.attractors.disturbances)
        text = f"{count:,} of {total:,} disturbances went beyond the model: {Outcome.BEYOND_MODEL.meaning.removesuffix('.')}"
        yield Fact("Verdict", text, "Beyond the model", "sampled", {"count": count, "total": total})


def _required(study: StudyData) -> Fact:
    say, required, source = study.wording, study.required, study.case.requirement.source
    parts = [f"kicks of up to {say.velocity(required.kick)}"]
    if required.shock:
        parts.append(
            f"shocks of up to {say.acceleration(required.shock.peak)} over {say.time(required.shock.duration)}"
        )
    if required.blade_loss:
        parts.append(f"the loss of a blade that changes the unbalance by {say.unbalance(required.blade_loss)}")
    how = _CHOSEN[source]
    if source == "default" and say.scales is None:
        how = "chosen by carom"
    elif source != "default" and study.case.requirement.kick is None:
        how = f"{how}; the kick is {_CHOSEN['default']}"
    return Fact("Verdict", f"{listed(parts)} ({how})", "Must survive", values=requirement_document(study))


def requirement_document(study: StudyData) -> dict[str, Any]:
    """What must be survived, as plain data for JSON."""
    required, scales = study.required, study.wording.scales
    shock = required.shock
    document: dict[str, Any] = {
        "source": study.case.requirement.source,
        "frame": "fixed",
        "kick": required.kick,
        "shock": fields_of(shock, "peak", "duration") if shock else None,
        "blade_loss": required.blade_loss,
        "blade_loss_node": required.blade_loss_node,
    }
    if scales is not None:
        stated = study.case.requirement.complete(scales)
        document |= fields_of(stated, kick_si="kick", blade_loss_si="blade_loss")
        document["shock_si"] = fields_of(stated.shock, "peak", "duration") if stated.shock else None
    return document


def _survived(study: StudyData, name: Kind, found: SmallestLoss) -> Fact:
    size = study.wording.size_of(name)
    parts = [
        f"harmless up to {size(found.harmless)} (proven)" if found.harmless > 0.0 else "no size is proven harmless"
    ]
    if name == "kick" and study.kicks is not None and study.kicks.all_up_to > found.harmless:
        parts.append(f"every one comes back up to {study.kicks.told_up_to} (proven)")
    if found.size is None and not found.complete:
        if found.all_back is not None:
            parts.append(f"all tried came back up to {size(found.all_back)}")
        parts.append("larger ones were not reached")
    elif found.size is None:
        most = "; with more it cannot levitate" if name == "blade_loss" else ""
        parts.append(f"all {found.tried:,} tried came back, up to {size(found.largest)}{most}")
    else:
        if found.all_back is not None:
            parts.append(f"all tried came back up to {size(found.all_back)}")
        ends = lost_to(study, name, found)
        remarks = "; ".join(each for each in (ends, found.sensitivity) if each)
        which = "smallest lost" if found.complete else "smallest found that is lost"
        parts.append(f"{which} {size(found.size)}{remarks and f' ({remarks})'}")
        if not found.complete:
            parts.append("smaller ones were not searched to the end")
    label, of, timed = LABELS[name], "", depends_on_instant(study.rotor)
    if name == "shock" and study.survives is not None:
        of = f"of {study.wording.time(study.survives.duration)}, "
    elif name == "blade_loss":
        of = f"change of the unbalance, at the worst phase{' and instant of the turn' if timed else ''}: "
    if timed and name != "blade_loss":
        of += f"{ANY_INSTANT}, "
    return Fact(
        "Verdict",
        f"{of}{', '.join(parts)}",
        label,
        values=survived_document(study, name, found),
        motions=(found.outcome.label,) if found.outcome is not None else (),
        disturbances=name,
    )


def lost_to(study: StudyData, name: Kind, found: SmallestLoss) -> str:
    """Where the smallest disturbance that is lost ends: ``ends in synchronous rub``; empty if none is."""
    if found.outcome is None:
        return ""
    # The motions of this machine are not those that a larger unbalance leaves.
    motions = [] if name == "blade_loss" else [entry.name for entry in study.attractors]
    return ending_words(found.outcome, motions).removeprefix("it ")


def survived_document(study: StudyData, name: Kind, found: SmallestLoss) -> dict[str, Any]:
    """What of a kind is survived, as plain data for JSON."""
    sizes = fields_of(
        found, harmless_up_to="harmless", all_up_to="all_back", smallest_lost="size", searched_up_to="largest"
    )
    document = sizes | fields_of(
        found, "tried", "fresh", "angle", "instant", "neighbours", "neighbours_lost", "complete"
    )
    document["lost_to"] = None if found.outcome is None else found.outcome.label
    if name == "shock" and study.survives is not None:
        document["duration"] = study.survives.duration
    return document | in_si(sizes, study.wording.scales, **dict.fromkeys(sizes, SIZES[name]))


def _shares(study: StudyData) -> Iterator[Fact]:
    """The share of kicks that comes back, and apart from it that of starts elsewhere in the clearance."""
    say, present = study.wording, study.present
    if present is None:
        return
    upto = say.velocity(study.required.kick)
    share = study.share
    if share is not None and share.total:
        yield Fact(
            "Verdict",
            f"{share.words}, by the area of their disc",
            "Share",
            "sampled",
            share.document,
            disturbances="kick",
        )
    elsewhere, sure = study.elsewhere, states_return(study.states)
    if elsewhere is None or not elsewhere.total:
        return
    counted = f"{elsewhere.count:,} of {elsewhere.total:,} starts"
    yield Fact(
        "Verdict",
        f"every start in the clearance, of up to {upto} in the room, comes back, as did {counted} drawn"
        if sure
        else f"{counted} spread over the clearance, of up to {upto} in the room, came back; nothing requires them to",
        "Elsewhere",
        "proven" if sure else "sampled",
        {"count": elsewhere.count, "total": elsewhere.total, **elsewhere.document},
        disturbances="state",
    )


def _others(study: StudyData) -> Iterator[Fact]:
    """Motions besides levitation that can hold the rotor, whether a disturbance reached them or not."""
    holds, motions = [], []
    if any(rub.status != "virtual" for rub in study.rubs):
        holds.append(f"a {'stable ' if stable_rub(study) else ''}{STEADY_WORDS['rub']}")
        motions.append(Outcome.FORWARD_RUB.label)
    if study.stable_orbits:
        kinds = [orbit.name.words for orbit in study.stable_orbits]
        holds.append(kinds[0] if len(kinds) == 1 else f"{len(kinds)} kinds of {REGULAR_BOUNCING}")
        motions += [orbit.name for orbit in study.stable_orbits]
    rolls = study.known.rolls
    if rolls.holds if rolls else any(each.name.outcome is Outcome.ROLLING for each in study.attractors):
        holds.append(Outcome.ROLLING.words)
        motions.append(Outcome.ROLLING.label)
    if holds:
        there = "besides levitation there" if study.levitates else "there"
        text = f"{there} {'are' if len(holds) > 1 else 'is'} {listed(holds)}"
        closed: Evidence = "closed form" if rolls else "sampled"
        yield Fact("Verdict", text, "Coexisting", "searched" if study.stable_orbits else closed, motions=tuple(motions))


def judged(study: StudyData) -> tuple[Level, str, str]:
    """The level, the outcome in a few words, and the reason to stand behind it."""
    levitation = study.equilibria[0]
    if levitation.status != "admissible":
        what = "just reaches" if levitation.status == "boundary" else "would lie beyond"
        why = (
            f"its {'sag and whirl' if study.heavy else 'whirl from unbalance'} {what} the wall of the touchdown bearing"
        )
        return "no-contact-free-motion", "Cannot run without contact", why
    if not levitation.stable and study.rotor.system.limits:
        why = "its levitation asks for more than its magnetic bearings can give, or is not damped"
        return "no-contact-free-motion", f"Does not stay in levitation, zone {study.zone}", why
    if not levitation.stable:
        why = "its levitation is not damped, so that a disturbance does not die out"
        return "no-contact-free-motion", f"Does not stay in levitation, zone {study.zone}", why
    lost = [_lost_words(study, *found) for found in study.lost_kinds]
    if lost:
        outcome = f"Does not come back from all that it must survive, zone {study.zone}"
        return "may-not-come-back", outcome, listed(lost)
    if not decides(study.present):
        outcome = f"Not decided whether it comes back from what it must survive, zone {study.zone}"
        return "not-decided", outcome, "too few disturbances could be followed"
    outcome = f"Came back each time from what it must survive, zone {study.zone}"
    if kicks_surely_return(study) and len(required_kinds(study.required)) == 1:
        outcome = f"Comes back from every kick that it must survive, zone {study.zone}"
    return "all-tried-came-back", outcome, _reservations(study)


def kicks_surely_return(study: StudyData) -> bool:
    """Whether every kick that must be survived is proven to come back."""
    # The largest of a disc that is proven as a whole may differ from its text by rounding.
    return study.kicks is not None and study.kicks.sure_up_to >= study.required.kick * (1.0 - 1e-12)


def _reservations(study: StudyData) -> str:
    """What has to be said where all that must be survived came back."""
    parts = ["no guarantee, as disturbances are samples"]
    if kicks_surely_return(study):
        others = " and for all starts in the clearance that are no faster" if states_return(study.states) else ""
        parts = [f"proven for these kicks{others}; no guarantee for other disturbances, which are samples"]
    if study.bearing_demand is not None and study.bearing_demand.doubtful:
        parts.append(
            f"{study.bearing_demand.doubtful} disturbances ask for a faster current than its magnetic bearings have"
        )
    zones = {loop.zone or "" for loop in study.levitating.loops} & set("CD")
    parts += [f"sensitivity in zone {max(zones)} of ISO 14839-3"] if zones else []
    parts += [] if study.levitating.met else ["a critical speed is nearer than API 617 allows"]
    parts += [f"a limit of a touchdown bearing is exceeded {where}" for where in study.exceeds_limits]
    return "; ".join(parts)


def _lost_words(study: StudyData, kind: Kind, back: Share | None) -> str:
    """How many of a kind are lost, in words."""
    say, required = study.wording, study.required
    lost = 1.0 - back.fraction if back else 0.0
    many = "nearly all" if lost > NEARLY_ALL else "most" if lost > 0.5 else "some"
    if kind == "blade_loss":
        return f"{many} losses of a blade are not survived"
    if kind == "shock" and required.shock:
        return f"{many} shocks of up to {say.acceleration(required.shock.peak)} are lost"
    return f"{many} kicks of up to {say.velocity(required.kick)} are lost"
