"""Studies of rotors given by their matrices: what a search and simulation find, stated by the words of every study."""

import json
import math
from functools import partial

import numpy as np
import pytest
from linear_rotors import as_matrices, tilting
from machines import PAPER

import carom as cm
from carom.base.files import as_json
from carom.base.outcome import InputError
from carom.basins import smallest_unrecovered
from carom.basins.unrecovered import Effort
from carom.disturbances import Sample, VelocityKick
from carom.models import Rotor, jeffcott
from carom.parameters import Case, Requirement, Scales, Zones
from carom.studies.facts import about

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
    assert matrices.ranges == matrices.thresholds == ()
    assert matrices.orbits.search is not None
    assert "does not prove that these are all" in "".join(each.text for each in about(matrices.facts, "Bouncing"))
    assert not any(each.evidence == "proven" for each in matrices.facts)
    assert not any("bends or tilts" in each.text for each in matrices.facts)


def test_a_rotor_with_two_planes_in_si_units(monkeypatch):
    """Its numbers are those of the rotor as a whole: no entries of a machine stand for them."""
    for name, count in {"TRIED": 30, "FIRST": 30, "FRESH": 30}.items():
        monkeypatch.setattr(f"carom.studies.assembly.{name}", count)
    monkeypatch.setattr("carom.studies.advice.CHECKED", 30)
    monkeypatch.setattr("carom.studies.recovery.MOST", 3)
    monkeypatch.setattr("carom.basins.unrecovered.COARSE", Effort(8, 6, drawn=20, around=24))
    monkeypatch.setattr("carom.basins.unrecovered.LOSSES", Effort(8, 6, near=4, drawn=10, around=12))
    monkeypatch.setattr(
        "carom.studies.survives.smallest_unrecovered", partial(smallest_unrecovered, directions=8, sizes=6)
    )
    monkeypatch.setattr("carom.studies.assembly.find_orbits", partial(cm.find_orbits, guesses=50))
    rotor: Rotor = tilting(damping=0.3 * np.diag([1.0, 0.4])).model.replace(scales=Scales(50.0, 0.7e-3, 184.2))
    found = cm.study(rotor, Sample(VelocityKick(0.3), 4), requirement=Requirement(kick=0.02))
    assert found.levitates
    assert "mm/s" in found.verdict.headline
    assert found.required.kick == pytest.approx(0.02 / (0.7e-3 * 184.2))
    shown = " ".join(each.text for each in found.facts)
    assert "N s/m" not in shown
    assert "γ" in shown
    assert all(math.isfinite(each.contact_free) for _, each in found.survives.items())
    json.loads(as_json(found.to_dict()))


def test_a_case_of_a_model_is_studied_and_nothing_else():
    case = Case("rig", tilting().model, None, Zones())
    assert cm.models.rotor_of(case) is case.parameters
    assert dict(case.rows())["scaled damping"] == "0.1"
    with pytest.raises(InputError, match="parameters"):
        Case("rig", None, None, Zones())
