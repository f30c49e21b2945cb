"""Studies of rotors given by their matrices: what a search and simulation find, stated by the words of every study."""

import pytest
from linear_rotors import as_matrices, tilting
from machines import PAPER

import carom as cm
from carom.base.outcome import InputError
from carom.models import jeffcott
from carom.parameters import Case, Zones
from carom.studies.questions import about

pytestmark = pytest.mark.jit_only

PLANAR = jeffcott(PAPER.replace(gamma=0.15, rho=0.3))


@pytest.fixture(scope="module")
def planar():
    return cm.study(PLANAR)


@pytest.fixture(scope="module")
def matrices():
    return cm.study(as_matrices(PLANAR))


def fact(study, label):
    return next(each for each in about(study.facts, "Verdict") if each.label == label)


def test_the_same_rotor_has_the_same_verdict(planar, matrices):
    own, found = planar.verdict, matrices.verdict
    assert (found.level, found.outcome, found.reason) == (own.level, own.outcome, own.reason)
    assert matrices.share == planar.share
    assert fact(matrices, "Share").text == fact(planar, "Share").text
    assert fact(matrices, "Coexisting").text == fact(planar, "Coexisting").text
    assert {each.name.outcome for each in matrices.attractors} == {each.name.outcome for each in planar.attractors}
    assert matrices.zone == planar.zone
    assert [orbit.period for orbit in matrices.stable_orbits] == pytest.approx(
        [orbit.period for orbit in planar.stable_orbits], rel=1e-9
    )


def test_sizes_that_are_survived_are_found_beyond_a_bound_by_energy(planar, matrices):
    own, found = planar.survives, matrices.survives
    assert 0.0 < found.kick.contact_free < own.kick.contact_free
    assert found.kick.size == pytest.approx(own.kick.size, rel=3e-3)
    assert found.blade_loss.size == pytest.approx(own.blade_loss.size, rel=1e-12)


def test_what_only_closed_forms_say_is_left_out_and_named(matrices):
    (named,) = (each.text for each in about(matrices.facts, "Not covered") if "planar rotor" in each.text)
    assert "closed form" in named
    assert matrices.ranges == ()
    assert matrices.orbits.search is not None
    assert "so the list may be incomplete" in "".join(each.text for each in about(matrices.facts, "Bouncing"))
    assert not any(each.evidence == "proven" for each in matrices.facts)
    assert not any("bends or tilts" in each.text for each in matrices.facts)


def test_a_case_of_a_model_is_studied_and_nothing_else():
    case = Case("rig", tilting().model, None, Zones())
    assert cm.models.rotor_of(case) is case.parameters
    assert dict(case.rows())["scaled damping"] == "0.1"
    with pytest.raises(InputError, match="parameters"):
        Case("rig", None, None, Zones())
