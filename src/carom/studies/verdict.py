"""The verdict of a study: what the machine must survive, what it survives, which share comes back, and what else may hold the rotor.

It never promises that a machine recovers.  Disturbances are samples, and motions that none of them reached may exist.
The best possible verdict is that every disturbance tried came back; of kicks it may be that all of them are proven to.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Literal

from carom.basins import Share, SmallestLoss
from carom.disturbances.echo import ANY_INSTANT
from carom.outcome import REGULAR_BOUNCING, STEADY_WORDS, Outcome
from carom.studies.endings import ending_words
from carom.studies.facts import Evidence, Fact, about
from carom.studies.kinds import LABELS, Kind, required_kinds
from carom.studies.proven import proven_kicks_document, states_return
from carom.studies.study_data import StudyData
from carom.studies.survives import decides
from carom.studies.wording import listed

Level = Literal["no-contact-free-motion", "may-not-come-back", "not-decided", "all-tried-came-back"]
NEARLY_ALL = 0.95
"""Share from which on of disturbances that do not come back it is said that nearly all are such."""
_CHOSEN = {
    "file": "as its file says",
    "option": "as the options say",
    "default": "default: the impact speed of a free fall across the diametral clearance",
}
_fact = partial(Fact, "Verdict")


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
        What does not come back, or why there is nothing to come back to; empty if there is nothing to say.
    survived : tuple of str
        For each kind of disturbance: the size that cannot touch, that up to which all tried came back, and the smallest that does not come back; then
        what must be survived, and what of it is proven.
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


def verdict(study: StudyData, found: Sequence[Fact]) -> Verdict:
    """Write the verdict of a study from its facts."""
    facts = {fact.label: fact.text for fact in about(found, "Verdict")}
    lead = {"Elsewhere": "Apart from what is required: ", "Certain": "Proven: ", "Drop": "In a drop: "}
    lead |= {label: f"{label}{'' if label == 'Shock' else ':'} " for label in LABELS.values()}
    if "Share" in facts:
        lead["Share"] = f"It must survive {facts['Must survive']}; "
    order = (*LABELS.values(), "Share", "Elsewhere", "Certain", "Drop")
    return Verdict(*judged(study), tuple(f"{lead[label]}{facts[label]}." for label in order if label in facts))


def verdict_facts(study: StudyData) -> Iterator[Fact]:
    """What must be survived, what of each kind is survived, shares, and what else may hold the rotor."""
    yield _fact(_required_words(study), "Must survive", values=study.requirement_document())
    if study.survives is not None:
        for name, values in study.survives.document().items():
            entry: SmallestLoss = getattr(study.survives, name)
            motions = () if entry.outcome is None else (entry.outcome.label,)
            yield _fact(_survived(study, name, entry), LABELS[name], None, values, motions, name)
    yield from _shares(study)
    if study.kicks is not None:
        yield _fact(study.kicks.words, "Certain", "proven", proven_kicks_document(study.kicks), disturbances="kick")
    yield from _others(study)
    gone, total = study.attractors, len(study.attractors.disturbances)
    if count := sum(entry.count for entry in gone if entry.name.outcome is Outcome.BEYOND_MODEL):
        text = f"{count:,} of {total:,} disturbances went beyond the model: {Outcome.BEYOND_MODEL.meaning.removesuffix('.')}"
        yield _fact(text, "Beyond the model", "sampled", {"count": count, "total": total})


def _required_words(study: StudyData) -> str:
    requirement, source = study.case.requirement, study.case.requirement.source
    how = _CHOSEN[source]
    if source == "default" and study.wording.scales is None:
        how = "chosen by carom"
    elif source != "default" and requirement.kick is None:
        how = f"{how}; of the kick the {_CHOSEN['default']}"
    return f"{listed(study.wording.required(study.required))} ({how})"


def _survived(study: StudyData, name: Kind, found: SmallestLoss) -> str:
    size, timed = study.wording.size_of(name), study.rotor.depends_on_instant
    of = ""
    if name == "shock" and study.survives is not None:
        of = f"of {study.wording.time(study.survives.duration)}, "
    elif name == "blade_loss":
        of = f"change of the unbalance, at the worst phase{' and instant of the turn' if timed else ''}: "
    if timed and name != "blade_loss":
        of += f"{ANY_INSTANT}, "
    parts = [f"cannot touch up to {size(found.harmless)} (proven)"] if found.harmless > 0.0 else []
    if name == "kick" and study.kicks is not None and study.kicks.all_up_to > found.harmless:
        parts.append(f"every one comes back up to {study.kicks.told_up_to} (proven)")
    if found.size is None and found.complete:
        most = "; with more it cannot levitate" if name == "blade_loss" else ""
        parts.append(f"all {found.tried:,} tried came back, up to {size(found.largest)}{most}")
        return of + ", ".join(parts)
    if found.all_back is not None:
        parts.append(f"all tried came back up to {size(found.all_back)}")
    if found.size is None:
        return of + ", ".join([*parts, "larger ones were not reached"])
    remarks = "; ".join(each for each in (lost_to(study, name, found), found.sensitivity) if each)
    which = "" if found.complete else "found "
    parts.append(f"smallest {which}that does not come back {size(found.size)}{remarks and f' ({remarks})'}")
    return of + ", ".join(parts if found.complete else [*parts, "smaller ones were not searched to the end"])


def lost_to(study: StudyData, name: Kind, found: SmallestLoss) -> str:
    """Where the smallest disturbance that does not come back ends: ``ends in synchronous rub``; empty if there is none."""
    if found.outcome is None:
        return ""
    # The motions of this machine are not those that a larger unbalance leaves.
    motions = [] if name == "blade_loss" else [entry.name for entry in study.attractors]
    return ending_words(found.outcome, motions).removeprefix("it ")


def _shares(study: StudyData) -> Iterator[Fact]:
    """The share of kicks that comes back, and apart from it that of starts elsewhere in the clearance."""
    share, elsewhere, sure = study.share, study.elsewhere, states_return(study.states)
    if share is not None and share.total:
        yield _fact(f"{share.words}, weighted by area", "Share", "sampled", share.document, disturbances="kick")
    if share is None or elsewhere is None or not elsewhere.total:
        return
    upto = study.wording.velocity(study.required.kick)
    text = f"{elsewhere.count:,} of {elsewhere.total:,} starts spread over the clearance, of up to {upto} in the room, came back; nothing requires them to"
    if sure:
        text = f"every start in the clearance, of up to {upto} in the room, comes back, as did {elsewhere.count:,} of {elsewhere.total:,} drawn"
    values = {"count": elsewhere.count, "total": elsewhere.total, **elsewhere.document}
    yield _fact(text, "Elsewhere", "proven" if sure else "sampled", values, disturbances="state")


def _others(study: StudyData) -> Iterator[Fact]:
    """Motions besides levitation that can hold the rotor, whether a disturbance reached them or not."""
    holds: list[tuple[str, tuple[str, ...]]] = []
    if any(rub.status != "virtual" for rub in study.rubs):
        stable = "stable " if study.stable_rub else ""
        holds.append((f"a {stable}{STEADY_WORDS['rub']}", (Outcome.FORWARD_RUB.label,)))
    if names := tuple(orbit.name for orbit in study.stable_orbits):
        holds.append((names[0].words if len(names) == 1 else f"{len(names)} kinds of {REGULAR_BOUNCING}", names))
    rolls = study.known.rolls
    if rolls.holds if rolls else any(each.name.outcome is Outcome.ROLLING for each in study.attractors):
        holds.append((Outcome.ROLLING.words, (Outcome.ROLLING.label,)))
    if holds:
        there = f"{'besides levitation ' if study.levitates else ''}there {'are' if len(holds) > 1 else 'is'}"
        evidence: Evidence = "searched" if study.stable_orbits else "closed form" if rolls else "sampled"
        motions = tuple(motion for _, several in holds for motion in several)
        yield _fact(f"{there} {listed([words for words, _ in holds])}", "Coexisting", evidence, motions=motions)


def judged(study: StudyData) -> tuple[Level, str, str]:
    """The level, the outcome in a few words, and the reason to stand behind it."""
    levitation, zone = study.equilibria[0], f"zone {study.zone}"
    if levitation.status != "admissible":
        what = "just reaches" if levitation.status == "boundary" else "would lie beyond"
        whirl = "sag and whirl" if study.heavy else "whirl from unbalance"
        why = f"its {whirl} {what} the wall of the touchdown bearing"
        return "no-contact-free-motion", "Cannot run without contact", why
    if not levitation.stable:
        why = "its levitation is not damped, so that a disturbance does not die out"
        if study.rotor.system.limits:
            why = "its levitation asks for more than its magnetic bearings can give, or is not damped"
        return "no-contact-free-motion", f"Does not stay in levitation, {zone}", why
    lost = [_lost_words(study, *found) for found in study.lost_kinds]
    if lost:
        return "may-not-come-back", f"Does not come back from all that it must survive, {zone}", listed(lost)
    if not decides(study.present):
        outcome = f"Not decided whether it comes back from what it must survive, {zone}"
        return "not-decided", outcome, "too few disturbances could be followed"
    outcome = f"Came back each time from what it must survive, {zone}"
    if kicks_surely_return(study) and len(required_kinds(study.required)) == 1:
        outcome = f"Comes back from every kick that it must survive, {zone}"
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
    if study.bearing_demand is not None and (count := study.bearing_demand.doubtful):
        parts.append(f"{count} disturbances ask for a faster current than its magnetic bearings have")
    zones = {loop.zone or "" for loop in study.levitating.loops} & set("CD")
    parts += [f"sensitivity in zone {max(zones)} of ISO 14839-3"] if zones else []
    parts += [] if study.levitating.met else ["a critical speed is nearer than API 617 allows"]
    return "; ".join(
        [*parts, *(f"a limit of a touchdown bearing is exceeded {where}" for where in study.exceeds_limits)]
    )


def _lost_words(study: StudyData, kind: Kind, back: Share | None) -> str:
    """How many of a kind do not come back, in words."""
    say, required = study.wording, study.required
    lost = 1.0 - back.fraction if back else 0.0
    many = "nearly all" if lost > NEARLY_ALL else "most" if lost > 0.5 else "some"
    if kind == "blade_loss":
        return f"{many} losses of a blade are not survived"
    size = say.velocity(required.kick)
    if kind == "shock" and required.shock:
        size = say.acceleration(required.shock.peak)
    return f"{many} {kind}s of up to {size} do not come back"
