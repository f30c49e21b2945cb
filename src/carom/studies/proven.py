"""What of a study is proven, in words: only what a :class:`~carom.proofs.Proof` has decided is called proven."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from carom.parameters.told import number, rounded_down, shown_in
from carom.results import record
from carom.studies.facts import Fact
from carom.studies.study_data import StudyData
from carom.studies.wording import counted, listed

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit
    from carom.parameters import Scales
    from carom.proofs import Proof, ProvenKicks

KICKS = (
    "all_up_to:velocity sure_up_to:velocity impacts kicks_up_to=largest:velocity share_proven=share share_refuted=refuted_share "
    "share_open=open_share"
)

_UNTOUCHED = (
    ("kicks never touch", "speed", "velocity", "no kick out of levitation below"),
    ("steps of the unbalance never touch", "change", "length", "no step of the eccentricity below"),
)


def proven_words(proof: Proof, scales: Scales | None = None) -> str:
    """What a proof has decided, and what it has not."""
    of_orbits = any(claim.name == "machine orbits" for claim in proof)
    facts = _facts_of_orbits(proof) if of_orbits else _facts_of_levitation(proof, scales)
    told = "; ".join(filter(None, facts)) or "nothing"
    text = f"In ball arithmetic, for the numbers of the machine as doubles: {told}."
    undecided = proof.with_status("undecided")
    if undecided:
        text += f" {counted(len(undecided), 'claim')} could not be decided: {listed([claim.name for claim in undecided[:4]])}."
    return text


def _facts_of_levitation(proof: Proof, scales: Scales | None) -> list[str]:
    """Of a machine without closed forms."""
    proven = {claim.name: claim for claim in proof if claim.status == "proven"}
    facts = ["levitation is stable"] if "levitation stable" in proven else []
    for name, size, kind, words in _UNTOUCHED:
        if name in proven:
            factor, unit = shown_in(kind, scales)
            facts.append(
                f"{words} {number(rounded_down(factor * float(proven[name].enclosures[size].low)))} {unit} touches"
            )
    return facts


def _facts_of_orbits(proof: Proof) -> list[str]:
    admissible = _names(proof, "admissible", "proven")
    stable = [name for name in admissible if name in _names(proof, "stable", "proven")]
    unstable = [name for name in admissible if name in _names(proof, "stable", "refuted")]
    orbits = proof["machine orbits"]
    return [
        f"levitation lies {'inside' if proof['levitation inside'].status == 'proven' else 'not inside'} the wall"
        if proof["levitation inside"].status != "undecided"
        else "",
        f"{orbits.statement[0].lower()}{orbits.statement[1:-1]}" if orbits.status == "proven" else "",
        f"stable are {listed(stable)}" if stable else "",
        f"unstable are {listed(unstable)}" if unstable else "",
    ]


def proven_kicks_words(kicks: ProvenKicks) -> str:
    """What is proven of kicks, and what is left open for which reasons."""
    text = f"Of kicks out of levitation: {kicks.words}."
    left = [f"{number(100.0 * part.share, 3)} % of the area ({part.reason})" for part in kicks.parts if part.open]
    return f"{text} Left open: {listed(left)}." if left else text


def states_return(proof: Proof | None) -> bool:
    """Whether all states that a proof is about are proven to return."""
    return proof is not None and proof["states all recover"].status == "proven"


def proven_states_words(proof: Proof, up_to: str, scales: Scales | None) -> str:
    """What is proven of all states up to a speed, told in words."""
    whole, shown = proof["states all recover"], proof["states recover"]
    told = f"Of all states in the clearance and on its wall, of up to {up_to} in the room:"
    if whole.status == "proven":
        return f"{told} every one comes back, so that no other motion begins there."
    factor, unit = shown_in("velocity", scales)
    parts = ["some do not come back" if whole.status == "refuted" else "it is open whether all come back"]
    if shown.status == "proven":
        speed = number(rounded_down(factor * float(shown.enclosures["speed"].low)))
        parts.append(f"every one up to {speed} {unit} does")
    return f"{told} {'; '.join(parts)} ({whole.reason})."


def proven_kicks_document(kicks: ProvenKicks) -> dict[str, Any]:
    """The same as plain data for JSON."""
    return record(kicks, KICKS, kicks.rotor.scales) | {
        "open": [record(part, "reason share") for part in kicks.parts if part.open]
    }


def proofs_of(study: StudyData) -> Iterator[Fact]:
    """What was proven, if it was asked for."""
    told = []
    if study.proof is not None:
        told.append(proven_words(study.proof, study.rotor.scales))
    if study.kicks is not None:
        told.append(proven_kicks_words(study.kicks))
    if study.states is not None:
        told.append(proven_states_words(study.states, study.wording.velocity(study.required.kick), study.rotor.scales))
    yield from (Fact("Proven", text, evidence="proven") for text in told)


def is_proven(proof: Proof | None, orbit: Orbit) -> bool:
    """Whether what a study says of an orbit is proven: that it is a motion or not, and stable or not."""
    if proof is None:
        return False
    told = {f"{orbit.name} admissible": orbit.admissible, f"{orbit.name} stable": orbit.stable}
    known = {claim.name: claim.status for claim in proof if claim.name in told}
    return all(known.get(name) == ("proven" if holds else "refuted") for name, holds in told.items())


def _names(proof: Proof, kind: str, status: str) -> list[str]:
    return [claim.about for claim in proof if claim.kind == kind and claim.status == status]
