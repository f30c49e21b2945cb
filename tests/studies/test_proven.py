"""A study calls proven only what a proof has decided."""

import json
import re
from dataclasses import replace

import pytest
from machines import PAPER
from studies import study_once

from carom import find_orbits, load, prove, study
from carom.base.files import as_json
from carom.closed_forms import contact_free_kick
from carom.parameters import Case, Requirement, Shock, Zones
from carom.proofs import ProvenKicks, check, hypotheses_of
from carom.proofs.claims import Evidence
from carom.proofs.families import KICKS
from carom.proofs.kick_search import BITS
from carom.proofs.proving import proof_at
from carom.studies.verdict import is_proven, proven_words


@pytest.fixture(scope="module")
def proof():
    return prove(PAPER)


def test_words_name_what_is_proven(proof):
    words = proven_words(proof)

    assert "levitation lies inside the wall" in words
    assert "synchronous with the shaft: B1,a, B1,b, B1,c, B1,d." in words
    assert "could not be decided" not in words


def test_words_name_what_is_proven_of_any_machine():
    case = load("examples/dropped-rotor.toml")
    speed = float(prove(case)["kicks never touch"].enclosures["speed"].low) * case.parameters.scales.velocity
    words = proven_words(prove(case), case.parameters.scales)
    shown = float(
        re.search(r"levitation is stable; no kick out of levitation below ([\d.]+) mm/s touches", words).group(1)
    )
    assert 0.999 * speed < 1e-3 * shown <= speed


def test_words_tell_what_is_undecided():
    words = proven_words(prove(PAPER.replace(gamma=0.0), longest_period=5))
    assert "could not be decided: machine periods and machine orbits" in words


def test_orbit_is_marked_only_if_its_claims_agree(proof):
    orbit = find_orbits(PAPER)["B1,d"]
    assert is_proven(proof, orbit)
    assert not is_proven(None, orbit)

    undecided = tuple(replace(claim, status="undecided") if claim.kind == "stable" else claim for claim in proof)
    assert not is_proven(replace(proof, claims=undecided), orbit)
    assert not is_proven(proof, find_orbits(PAPER.replace(gamma=0.05))["B1,d"])


DAMPED = PAPER.replace(gamma=0.65, mu=0.0)
"""Every disturbance of this machine comes back at once; kicks of up to 0.58 never touch."""


def proven_of(study, largest, cells):
    """What cells show of the kicks of a studied machine."""
    options = {"kicks_up_to": str(largest), "most_impacts": 2}
    evidence = Evidence({"cells": cells})
    return ProvenKicks.of(proof_at(BITS, KICKS.about, hypotheses_of(study.rotor), options, evidence), study.rotor)


@pytest.fixture(scope="module")
def whole():
    """The study of a machine that must survive kicks which never touch."""
    studied = study_once(Case("damped", DAMPED, None, Zones(), requirement=Requirement(kick=0.5)))
    return replace(studied, kicks=proven_of(studied, 0.5, "aav0a00v0a00aa000"))


@pytest.fixture(scope="module")
def half():
    """The same where only the slower half of the kicks that must be survived is proven."""
    studied = study_once(DAMPED)
    return replace(studied, kicks=proven_of(studied, 1, "vaav0a00v0a00aa000vgx"))


@pytest.mark.jit_only
def test_kicks_that_are_all_proven_are_no_sample(whole):
    verdict = whole.verdict
    assert verdict.level == "all-tried-came-back"
    assert verdict.outcome.startswith("Comes back from every kick it must survive, vibration in zone")
    assert verdict.reason.startswith("proven for these kicks; other disturbances are sampled")
    assert verdict.headline.endswith("Proven: every kick up to 0.5 c_r Ω comes back, without an impact.")
    plain = replace(whole, kicks=None).verdict
    assert plain.outcome.startswith("Came back in every trial")
    assert plain.reason.startswith("sampled, not proven")
    assert "Proven" not in plain.headline


@pytest.mark.jit_only
def test_of_other_disturbances_nothing_is_proven(whole):
    shock = Shock(0.1, 1.0)
    more = replace(whole, case=replace(whole.case, requirement=Requirement(kick=0.5, shock=shock)))
    twice = {name: 2 * getattr(more.present, name) for name in ("returned", "largest")}
    present = replace(more.present, **twice)
    assert replace(more, present=present).verdict.outcome.startswith("Came back in every trial")


@pytest.mark.jit_only
def test_facts_say_what_is_proven_and_what_is_open(half):
    facts = {fact.label: fact for fact in half.facts if fact.topic == "Verdict"}
    assert facts["Certain"].evidence == "proven"
    assert facts["Certain"].text.startswith(
        "25 % of the kicks up to 1 c_r Ω come back, without an impact, and every one up to 0.5796 c_r Ω"
    )
    values = facts["Certain"].values
    assert (values["kicks_up_to"], values["all_up_to"], values["share_proven"], values["share_open"]) == (
        1,
        0.5,
        0.25,
        0.75,
    )
    assert values["sure_up_to"] == pytest.approx(contact_free_kick(DAMPED))
    assert [entry["share"] for entry in values["open"]] == [7 / 16, 5 / 16]
    # What never touches is stated as harmless.
    assert "every one comes back" not in facts["Kick"].text
    assert half.verdict.outcome == replace(half, kicks=None).verdict.outcome
    (first, *_) = (fact.text for fact in half.facts if fact.topic == "Not covered")
    assert "except the kicks that are proven" in first


@pytest.mark.jit_only
def test_document_has_a_certificate_that_can_be_checked(half):
    document = json.loads(as_json(half.to_dict()))
    assert check(document["kick_proof"]).claims == half.kicks.proof.claims
    assert replace(half, kicks=None).to_dict()["kick_proof"] is None


@pytest.mark.jit_only
def test_study_proves_the_kicks_that_must_be_survived():
    found = study(DAMPED, proofs=True, requirement=Requirement(kick=0.5), proof_time=0.5)
    # Those that must be survived never touch, so that faster ones are looked at.
    assert found.kicks.largest == pytest.approx(2.0 * contact_free_kick(DAMPED))
    assert found.verdict.outcome.startswith("Comes back from every kick it must survive")
    assert found.proof is not None
    without = study(DAMPED.replace(rho=0.9), proofs=True, requirement=Requirement(kick=0.5), proof_time=20.0)
    assert without.survives is without.kicks is None
