"""What of a study is proven, in words: only what a :class:`~carom.proofs.Proof` has decided is called proven."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from carom.base.results import record
from carom.parameters.formats import number, rounded_down, shown_in
from carom.studies.facts import Fact
from carom.studies.study_data import StudyData
from carom.studies.wording import counted, listed

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit
    from carom.parameters import Scales

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


def proven_kicks_document(kicks: Any) -> dict[str, Any]:
    """What is proven of kicks, as plain data for JSON."""
    return record(kicks, KICKS, kicks.rotor.scales) | {
        "open": [record(part, "reason share") for part in kicks.parts if part.open]
    }


def proofs_of(study: StudyData) -> Iterator[Fact]:
    """What was proven of the motions, if it was asked for; the verdict has what was proven of kicks."""
    if study.proof is not None:
        yield Fact("Proven", proven_words(study.proof, study.rotor.scales), evidence="proven")


def is_proven(proof: Any, orbit: Orbit) -> bool:
    """Whether what a study says of an orbit is proven: that it is a motion or not, and stable or not."""
    if proof is None:
        return False
    shown = {f"{orbit.name} admissible": orbit.admissible, f"{orbit.name} stable": orbit.stable}
    known = {claim.name: claim.status for claim in proof if claim.name in shown}
    return all(known.get(name) == ("proven" if holds else "refuted") for name, holds in shown.items())
