"""The verdict of a study: what the machine must survive, what it survives and what of it is proven, which share comes back, and what else may hold the rotor.

It never promises that a machine recovers.  Disturbances are samples, and motions that none of them reached may exist.
The best possible verdict is that every disturbance tried came back; of kicks it may be that all of them are proven to.  Only what a
:class:`~carom.proofs.Proof` has decided is called proven.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

from carom.base.outcome import REGULAR_BOUNCING, STEADY_WORDS, Outcome, printable
from carom.base.results import record
from carom.basins import Share, SmallestUnrecovered
from carom.disturbances.plans import ANY_INSTANT
from carom.orbits import Orbit
from carom.parameters import Scales
from carom.parameters.formats import number, rounded_down, shown_in
from carom.studies.questions import GROWTH, LABELS, Evidence, Fact, Kind, about, required_kinds
from carom.studies.study_data import StudyData
from carom.studies.survives import decides
from carom.studies.wording import Wording, counted, ending_words, listed

KICKS = (
    "all_up_to:velocity sure_up_to:velocity impacts kicks_up_to=largest:velocity share_proven=share share_refuted=refuted_share "
    "share_open=open_share"
)
_SAID = {
    "levitation inside": "levitation lies inside the wall",
    "levitation stable": "levitation is stable",
    "machine orbits": "",
    "kicks never touch": "no kick out of levitation below {speed} touches",
    "steps of the unbalance never touch": "no step of the eccentricity below {change} touches",
}
"""What is said of the claims of a proof that are about the whole machine, with their sizes; the statement itself where nothing stands here."""
_KINDS = {"speed": "velocity", "change": "length"}
Level = Literal["no-contact-free-motion", "may-not-come-back", "not-decided", "all-tried-came-back"]
NEARLY_ALL = 0.95
"""Share from which on of disturbances that do not come back the text says "nearly all"."""
_CHOSEN = {
    "file": "from the machine file",
    "option": "from the options",
    "default": "default: the impact speed of a free fall across the diametral clearance",
}
SURVIVED = {
    "untouched": "cannot touch up to",
    "sure": "all come back up to",
    "back": "all tried came back up to",
    "lost": "smallest found that does not come back",
}
"""Results for each kind of disturbance: headings of a table, and words before the size in a sentence."""
_fact = partial(Fact, "Verdict")


def proven_words(proof: Any, scales: Scales | None = None) -> str:
    """What a proof has decided, and what it has not."""
    facts = []
    for claim in proof.with_status("proven"):
        if claim.name in _SAID:
            sizes = {}
            for name, kind in _KINDS.items():
                if name in claim.enclosures:
                    factor, unit = shown_in(kind, scales)
                    sizes[name] = f"{number(rounded_down(factor * float(claim.enclosures[name].low)))} {unit}"
            words = _SAID[claim.name].format(**sizes)
            facts.append(words or f"{claim.statement[0].lower()}{claim.statement[1:-1]}")
    text = f"In ball arithmetic, for the numbers of the machine as doubles: {'; '.join(facts) or 'nothing'}."
    if undecided := proof.with_status("undecided"):
        text += f" {counted(len(undecided), 'claim')} could not be decided: {listed([claim.name for claim in undecided[:4]])}."
    return text


def proven_kicks_document(kicks: Any) -> dict[str, object]:
    """What is proven of kicks, as plain data for JSON."""
    return record(kicks, KICKS, kicks.rotor.scales) | {
        "open": [record(part, "reason share") for part in kicks.parts if part.open]
    }


def is_proven(proof: Any, orbit: Orbit) -> bool:
    """Whether what a study says of an orbit is proven: that it is a motion or not, and stable or not."""
    if proof is None:
        return False
    shown = {f"{orbit.name} admissible": orbit.admissible, f"{orbit.name} stable": orbit.stable}
    known = {claim.name: claim.status for claim in proof if claim.name in shown}
    return all(known.get(name) == ("proven" if holds else "refuted") for name, holds in shown.items())


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
    lead = {"Certain": "Proven: ", "Drop": "In a drop: "}
    lead |= {label: f"{label}{' ' if condition_of(study, kind) else ': '}" for kind, label in LABELS.items()}
    if "Share" in facts:
        lead["Share"] = f"It must survive {facts['Must survive']}; "
    order = (*LABELS.values(), "Share", "Certain", "Drop")
    return Verdict(*judged(study), tuple(f"{lead[label]}{facts[label]}." for label in order if label in facts))


def verdict_facts(study: StudyData) -> Iterator[Fact]:
    """What must be survived, what of each kind is survived, shares, and what else may hold the rotor."""
    yield _fact(_required_words(study), "Must survive", values=study.requirement_document())
    if study.survives is not None:
        for (name, entry), values in zip(study.survives.items(), study.survives.document().values(), strict=True):
            yield _fact(_survived(study, name, entry), LABELS[name], None, values)
    if study.share is not None and study.share.total:
        words, values = f"{study.share.words}, weighted by area", study.share.document()
        yield _fact(words, "Share", "sampled", values)
    if study.kicks is not None:
        yield _fact(study.kicks.words, "Certain", "proven", proven_kicks_document(study.kicks))
    yield from _others(study)
    gone, total = study.attractors, len(study.attractors.disturbances)
    if count := sum(entry.count for entry in gone if entry.name.outcome is Outcome.BEYOND_MODEL):
        text = f"{count:,} of {total:,} disturbances went beyond the model: {Outcome.BEYOND_MODEL.meaning.removesuffix('.')}"
        yield _fact(text, "Beyond the model", "sampled", {"count": count, "total": total})


def _required_words(study: StudyData) -> str:
    requirement, source = study.case.requirement, study.case.requirement.source
    how = _CHOSEN[source]
    if source == "default" and study.wording.scales is None:
        how = "default"
    elif source != "default" and requirement.kick is None:
        how = f"{how}; kick: {_CHOSEN['default']}"
    return f"{listed(study.wording.required(study.required))} ({how})"


def survived_cells(study: StudyData, name: Kind, found: SmallestUnrecovered) -> dict[str, str]:
    """What of one kind of disturbance is survived, by :data:`SURVIVED`; what is not known is left out."""
    cells = size_cells(study.wording, found, lost_to(study, name, found))
    if name == "kick" and study.kicks is not None and study.kicks.all_up_to > found.contact_free:
        cells["sure"] = f"{study.kicks.shown_up_to} (proven)"
    return {column: cells[column] for column in SURVIVED if column in cells}


def size_cells(wording: Wording, found: SmallestUnrecovered, *remarks: str) -> dict[str, str]:
    """Sizes of one kind of disturbance up to which it is survived, by :data:`SURVIVED`; remarks stand behind the smallest that is not."""
    name, cells = found.kind.replace("-", "_"), {}
    size = wording.size_of(name)
    if found.contact_free > 0.0:
        cells["untouched"] = f"{size(found.contact_free)} (proven)"
    none = found.size is None and found.complete
    if (up_to := found.largest if none else found.all_back) is not None:
        most = "; beyond it the rotor cannot levitate" if none and name == "blade_loss" else ""
        cells["back"] = f"{size(up_to)} ({found.tried:,} tried{most})"
    shown = "; ".join(filter(None, (*remarks, found.sensitivity, "" if found.complete else "search not finished")))
    if found.size is not None:
        cells["lost"] = f"{size(found.size)} ({shown})"
    elif not found.complete:
        cells["lost"] = "none found before the search was stopped"
    return cells


def condition_of(study: StudyData, name: Kind) -> str:
    """What is the same for all disturbances of a kind."""
    parts = []
    if name == "shock" and study.survives is not None:
        parts.append(f"of {study.wording.time(study.survives.duration)}")
    if name == "base_record" and study.required.base_record is not None:
        parts.append(f"{printable(study.required.base_record.name)}, turned to all directions")
    if name == "blade_loss":
        parts.append("as a change of unbalance at the worst phase")
    return ", ".join([*parts, ANY_INSTANT] if study.rotor.depends_on_instant else parts)


def _survived(study: StudyData, name: Kind, found: SmallestUnrecovered) -> str:
    of, cells = condition_of(study, name), survived_cells(study, name, found)
    shown = ", ".join(f"{SURVIVED[column]} {cell}" for column, cell in cells.items())
    return f"{of}: {shown}" if of else shown


def lost_to(study: StudyData, name: Kind, found: SmallestUnrecovered) -> str:
    """Where the smallest disturbance that does not come back ends: ``ends in synchronous rub``; empty if there is none."""
    if found.outcome is None:
        return ""
    # The motions of this machine are not those that a larger unbalance leaves.
    motions = [] if name == "blade_loss" else [entry.name for entry in study.attractors]
    return ending_words(found.outcome, motions).removeprefix("it ")


def _others(study: StudyData) -> Iterator[Fact]:
    """Motions besides levitation that can hold the rotor, whether a disturbance reached them or not."""
    holds: list[str] = []
    if any(rub.status != "virtual" for rub in study.rubs):
        holds.append(f"a {'stable ' if study.stable_rub else ''}{STEADY_WORDS['rub']}")
    if orbits := study.stable_orbits:
        holds.append(orbits[0].name.words if len(orbits) == 1 else f"{len(orbits)} kinds of {REGULAR_BOUNCING}")
    rolls = study.known.rolls
    if rolls.holds if rolls else any(each.name.outcome is Outcome.ROLLING for each in study.attractors):
        holds.append(Outcome.ROLLING.words)
    if holds:
        there = f"{'besides levitation ' if study.levitates else ''}there {'are' if len(holds) > 1 else 'is'}"
        evidence: Evidence = "searched" if orbits else "closed form" if rolls else "sampled"
        yield _fact(f"{there} {listed(holds)}", "Coexisting", evidence)


def judged(study: StudyData) -> tuple[Level, str, str]:
    """The level, the outcome in a few words, and the reason to stand behind it."""
    levitation, zone = study.equilibria[0], f"vibration in zone {study.zone}"
    if levitation.status != "admissible":
        what = "just reaches" if levitation.status == "boundary" else "would lie beyond"
        whirl = "sag and whirl" if study.under_gravity else "whirl from unbalance"
        why = f"its {whirl} {what} the wall of the touchdown bearing"
        return "no-contact-free-motion", "Cannot run without contact", why
    if not levitation.stable:
        grows = levitation.eigenvalues.real.max() > GROWTH
        why = "small vibrations grow" if grows else "levitation has no damping, so vibrations do not decay"
        if study.rotor.system.limits:
            why = "levitation saturates the magnetic bearings, or is not damped"
        return "no-contact-free-motion", f"Does not stay in levitation, {zone}", why
    lost = [_lost_words(study, *found) for found in study.unrecovered_kinds]
    if lost:
        return "may-not-come-back", f"Does not come back from everything it must survive, {zone}", listed(lost)
    if not decides(study.present):
        outcome = f"Undecided whether it comes back from what it must survive, {zone}"
        return "not-decided", outcome, "too few disturbances could be followed"
    outcome = f"Came back in every trial from what it must survive, {zone}"
    if kicks_surely_return(study) and len(list(required_kinds(study.required))) == 1:
        outcome = f"Comes back from every kick it must survive, {zone}"
    return "all-tried-came-back", outcome, _reservations(study)


def kicks_surely_return(study: StudyData) -> bool:
    """Whether every kick that must be survived is proven to come back."""
    # The largest of a disc that is proven as a whole may differ from its text by rounding.
    return study.kicks is not None and study.kicks.sure_up_to >= study.required.kick * (1.0 - 1e-12)


def _reservations(study: StudyData) -> str:
    """Reservations where every required disturbance came back."""
    parts = ["sampled, not proven"]
    if kicks_surely_return(study):
        parts = ["proven for these kicks; other disturbances are sampled, not proven"]
    zones = {loop.zone or "" for loop in study.levitating.loops} & set("CD")
    parts += [f"control-loop sensitivity in zone {max(zones)} (ISO 14839-3)"] if zones else []
    near = not all(each.separation.met for each in study.levitating.criticals)
    parts += ["a critical speed is closer than API 617 allows"] if near else []
    parts += [f"a limit of a touchdown bearing is exceeded {where}" for where in study.exceeds_limits]
    return "; ".join(parts)


def _lost_words(study: StudyData, kind: Kind, back: Share | None) -> str:
    """How many of a kind do not come back, in words."""
    lost = 1.0 - back.fraction if back else 0.0
    many = "nearly all" if lost > NEARLY_ALL else "most" if lost > 0.5 else "some"
    if kind == "blade_loss":
        return f"{many} blade losses are not survived"
    sizes = {kind: size for kind, size, _ in required_kinds(study.required)}
    return f"{many} {LABELS[kind].lower()}s up to {study.wording.size_of(kind)(sizes[kind])} do not come back"
