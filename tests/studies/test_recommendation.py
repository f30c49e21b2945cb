"""The recommendation: numbers that the study holds, words that say how each is known, and fresh samples that attack both."""

from __future__ import annotations

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest
from machines import PAPER
from scipy.stats import binom
from studies import study_once

from carom.attractors import DisturbanceSet, MotionName
from carom.models import Jeffcott
from carom.motions.ensembles import settle
from carom.outcome import Outcome
from carom.parameters import Parameters, load
from carom.studies import Edge, Span, study
from carom.studies.advice import WANTED, advise
from carom.studies.one_page import recommendation_lines
from carom.studies.orbit_ranges import single_impact_ranges
from carom.studies.recommendation import evidence_of, recommend

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def real():
    return study_once(load("examples/keogh-cole.toml"))


def texts(result):
    return {line.label: line.text for line in recommendation_lines(result)}


def test_the_headline_begins_with_the_outcome_and_the_zone(real):
    assert real.verdict.outcome == "May not come back after a touch, zone D"
    assert real.verdict.headline.startswith("May not come back after a touch, zone D: it levitates, but a stable")
    assert real.to_dict()["verdict"]["outcome"] == real.verdict.outcome
    grounded = study_once(PAPER.replace(gamma=0.05))
    assert grounded.verdict.headline.startswith("Cannot run without contact: its whirl from unbalance would lie beyond")


def test_both_changes_with_their_margins(real):
    stiffer, damped = recommend(real).changes
    assert (stiffer.gain, stiffer.bound, damped.gain, damped.bound) == ("omega", "at least", "gamma", "at least")
    # From closed forms: levitation meets the wall at omega^2 = 1 + sqrt(rho^2 - gamma^2), the rub folds at
    # gamma = rho sqrt(1 + mu^2) - mu (1 - omega^2).
    own = real.case.parameters
    wall = math.sqrt(1.0 + math.sqrt(own.rho**2 - own.gamma**2))
    fold = own.rho * math.sqrt(1.0 + own.mu**2) - own.mu * (1.0 - own.omega**2)
    assert stiffer.margin.edge.value == pytest.approx(wall, rel=1e-12)
    assert damped.margin.edge.value == pytest.approx(fold, rel=1e-12)
    assert stiffer.advice.value == pytest.approx(wall * math.sqrt(1.0 + stiffer.margin.share), rel=1e-12)
    assert damped.advice.value == pytest.approx(fold * (1.0 + damped.margin.share), rel=1e-12)
    assert {evidence_of(change.margin.edge) for change in (stiffer, damped)} == {"closed form"}
    radius = own.rho / abs(complex(stiffer.advice.value**2 - 1.0, own.gamma))
    assert stiffer.radius == pytest.approx(radius, rel=1e-12)
    assert all(change.advice.value < min(tried.values) for change in (stiffer, damped) for tried in change.tried)


def test_the_page_says_present_value_change_margin_disturbances_and_evidence(real):
    said = texts(real)
    assert said["Machine"].startswith("damping 1,400 N s/m, stiffness 980,000 N/m, speed 1,759 rpm")
    assert said["Change"] == "stiffness 980,000 N/m → at least 2,495,000 N/m (× 2.55), tried up to 3,918,000 N/m"
    assert said["Or"] == "damping 1,400 N s/m → at least 3,578 N s/m (× 2.56), tried up to 73,450 N s/m"
    assert said["Margin"] == "5 % beyond 3,408 N s/m, where a stable and an unstable rub meet (fold) (closed form)"
    assert said["Tried"].startswith("sampled: all of 2,000 fresh disturbances of up to 258 mm/s came back")
    assert "up to 258 mm/s" in said["Disturbances"]
    assert said["How sure"].endswith("None of it is proven.")
    assert "clearance 0.7 mm, eccentricity 0.3 mm" in said["Machine"]


def test_the_document_carries_the_same_numbers(real):
    document = real.to_dict()["recommendation"]
    changes = recommend(real).changes
    assert [entry["value"] for entry in document["changes"]] == [change.advice.value for change in changes]
    assert document["changes"][1]["present_si"] == pytest.approx(1400.0)
    assert document["changes"][1]["margin"]["end_si"] == pytest.approx(3407.85, abs=0.01)
    assert [line["text"] for line in document["text"]] == [line.text for line in recommendation_lines(real)]


def test_a_machine_that_came_back_is_told_its_margin():
    result = study_once(PAPER.replace(gamma=0.5, mu=0.0))
    found = recommend(result)
    assert (found.kind, found.changes) == ("no-change-needed", ())
    margin = dict(found.margins)["gamma"]
    assert margin.share == pytest.approx(0.5 / margin.edge.value - 1.0)
    assert texts(result)["Change"] == "none needed for the disturbances tried (sampled)"


def test_a_share_is_no_bound():
    """Where no value leaves only levitation, nothing is said of larger ones."""
    (advised,) = advise(PAPER, (), single_impact_ranges(PAPER, "gamma"))
    result = dataclasses.replace(study_once(PAPER), advice=(advised,))
    (change,) = recommend(result).changes
    assert (change.bound, change.margin, change.tried) == ("about", None, ())
    assert texts(result)["Change"] == "γ 0.1 → 0.4046 (× 4.05)"
    assert texts(result)["Margin"].startswith("none: no value tried leaves only levitation, and this one brings back")
    assert "no value beyond it was tried" in texts(result)["Tried"] or advised.returned.count < advised.returned.total


def test_a_window_names_both_ends(real):
    """A range that another motion ends is no "at least"."""
    damped = recommend(real).changes[1]
    ends = Edge(0.6, "simulated", certified=False, motion=MotionName(Outcome.BOUNCING, 3))
    window = Span(damped.margin.edge, ends)
    alone = tuple(
        dataclasses.replace(entry, spans=(window,)) if entry.gain == "gamma" else entry for entry in real.alone
    )
    result = dataclasses.replace(real, alone=alone)
    change = recommend(result).changes[1]
    assert (change.bound, change.far) == ("about", ends)
    assert all(max(tried.values) < 0.6 for tried in change.tried)
    margins = [line.text for line in recommendation_lines(result) if line.label == "Margin"]
    assert (
        "stay on this side of 5,526 N s/m, beyond which disturbances ended in 3-impact bouncing (sampled)" in margins[1]
    )


def test_nothing_found_says_what_was_searched(real):
    result = dataclasses.replace(real, advice=())
    assert recommend(result).kind == "no-change-found"
    assert texts(result)["Change"].startswith("none found that leaves only levitation, of damping from ")


def test_only_a_proof_is_called_proven(real):
    proven = SimpleNamespace(proof=object())
    from carom.studies.one_page import _how_sure

    assert "not the change" in _how_sure(proven)
    assert "None of it is proven" in _how_sure(SimpleNamespace(proof=None))


# ------------------------------------------------------------------------------------------------ attacked


def lost(parameters, count, seed):
    rotor = Jeffcott(parameters)
    ends = settle(rotor, *DisturbanceSet(count, seed).starts(rotor)[:2])
    return int(np.count_nonzero(~ends.recovered))


def drawn(random):
    return Parameters(
        gamma=float(np.exp(random.uniform(np.log(0.03), np.log(0.8)))),
        omega=float(random.uniform(0.4, 1.8)),
        rho=float(random.uniform(0.02, 0.5)),
        phi=float(random.uniform(-3.0, 3.0)),
        mu=float(random.uniform(0.02, 0.5)),
        d=float(random.uniform(0.2, 0.97)),
        radius_ratio=float(np.exp(random.uniform(np.log(5.0), np.log(200.0)))),
    )


@pytest.mark.deep
@pytest.mark.parametrize("seed", range(20))
def test_fresh_samples_do_not_contradict_it(seed):
    """At the present values, at the recommended ones, and between these and the last one tried.

    A share stated with an interval is refused if a fresh count would be less likely than one in a million at the end of
    the interval nearest to it.
    """
    random = np.random.default_rng([seed, 4711])
    machine = drawn(random)
    result = study(machine)
    found = recommend(result)
    here = lost(machine, 5000, 10_000 + seed)
    if result.verdict.level == "all-tried-came-back" and result.fresh is not None:
        assert binom.sf(here - 1, 5000, result.fresh.share_below) > 1e-6
    for change in found.changes:
        there, advised = machine.replace(**{change.gain: change.advice.value}), change.advice.returned
        assert binom.sf(lost(there, 5000, 20_000 + seed) - 1, 5000, 1.0 - advised.low) > 1e-6
        if change.bound != "about":
            last = max((tried.values[-1] for tried in change.tried), key=lambda at: abs(at - change.advice.value))
            for place in np.exp(random.uniform(*sorted(np.log([change.advice.value, last])), 8)):
                between = machine.replace(**{change.gain: float(place)})
                assert lost(between, 2000, 30_000 + seed) <= (1.0 - WANTED) * 2000
