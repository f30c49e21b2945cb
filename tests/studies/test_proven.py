"""A study calls proven only what a proof has decided."""

from __future__ import annotations

from dataclasses import replace

import pytest
from machines import PAPER
from studies import study_once

from carom.orbits import find_orbits
from carom.proofs import check, prove
from carom.studies.document import study_document
from carom.studies.proven import is_proven, proven_words
from carom.studies.summaries import motion_rows


@pytest.fixture(scope="module")
def proof():
    return prove(PAPER)


def test_words_name_what_is_proven(proof):
    words = proven_words(proof)

    assert "levitation lies inside the wall" in words
    assert "synchronous with the shaft: B1,a, B1,b, B1,c, B1,d;" in words
    assert "stable are B1,d; unstable are" in words
    assert "could not be decided" not in words


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


@pytest.mark.deep
@pytest.mark.jit_only
def test_study_shows_its_proof():
    plain = study_once(PAPER)
    assert "Proven" not in [fact.topic for fact in plain.facts]
    proven = replace(plain, proof=prove(plain.case.parameters))

    assert "Proven" in [fact.topic for fact in proven.facts]
    remarks = {row.name: row.remark for row in motion_rows(proven)}
    assert remarks["orbit B1,d"].startswith("proven")
    assert "proven" not in {row.name: row.remark for row in motion_rows(plain)}["orbit B1,d"]
    assert check(study_document(proven)["proof"]).claims == proven.proof.claims
    assert study_document(plain)["proof"] is None
