"""A study as a whole: what it finds, and that its words promise nothing."""

import json
import math
import re

import numpy as np
import pytest
from machines import PAPER, REAL
from studies import ORBIT_KEYS, study_once

from carom.base.files import as_json
from carom.base.outcome import Outcome
from carom.parameters import Case, Zones
from carom.studies.findings import LONGER_MOTIONS, PLANAR, RIGID_WALL, SAMPLED
from carom.studies.questions import about
from carom.studies.summaries import motion_rows

QUIET = PAPER.replace(gamma=0.5, mu=0.0)
"""Damped enough that no rub and no bounce is left, with too little friction to roll."""

RUB_FOLD = 3407.846808
"""Damping in N s/m at the fold of synchronous rubs of this machine: m Omega (rho sqrt(1 + mu^2) - mu (1 - omega^2))."""

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def real():
    return study_once(Case("real", REAL.parameters, REAL, Zones()))


def finding(result, topic):
    return "\n".join(fact.text for fact in about(result.facts, topic))


def everything(result):
    """The headline and all facts."""
    return "\n".join([result.verdict.headline, *(fact.sentence for fact in result.facts)])


# ------------------------------------------------------------------------------------------------ what is found


def test_real_machine(real):
    assert real.levitates
    assert real.zone == "D"
    assert [orbit.name for orbit in real.stable_orbits] == ["B1,d"]
    values = {
        (entry.motion, entry.parameter, side): edge.value for entry in real.ranges for edge, side in entry.thresholds
    }
    scales = REAL.scales
    assert values["rub", "gamma", "below"] * scales.damping == pytest.approx(RUB_FOLD, abs=1e-3)
    assert values["single-impact", "gamma", "below"] * scales.damping == pytest.approx(1639.6, abs=0.1)
    assert values["contact-free", "gamma", "above"] * scales.damping == pytest.approx(671.0, abs=0.5)
    assert {"levitation", "synchronous rub", "B1,d", "rolling backward whirl"} <= {
        member.name for member in real.attractors
    }
    along_damping = next(entry for entry in real.recoveries if entry.along.name == "gamma")
    assert along_damping.spans[0].low.value * scales.damping == pytest.approx(RUB_FOLD, abs=1e-3)


def test_all_comes_back_where_no_other_motion_can_hold_the_rotor(real):
    for found in real.recoveries:
        for span in found.searched:
            for value in np.linspace(span.low.value, span.high.value, 202)[1:-1].tolist():
                assert found.range_of("contact-free").exists_at(value)
                others = any(found.range_of(motion).exists_at(value) for motion in ("rub", "single-impact"))
                assert others or any(value in span for span in found.spans)


def test_changes_are_checked_by_fresh_disturbances(real):
    first, second = real.to_dict()["recommendation"]["changes"]
    assert (first["quantity"], second["quantity"]) == ("stiffness", "damping")
    assert first["recovered"] == first["disturbances"] == 10_000
    assert first["recovered_at_their_largest"] == first["at_their_largest"] == 96


@pytest.mark.parametrize(
    "parameters",
    [
        PAPER,
        PAPER.replace(gamma=0.05),
        pytest.param(PAPER.replace(rho=0.0), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(gamma=0.0), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(d=0.0), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(gamma=0.25), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(gamma=0.4), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(gamma=-0.1), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(d=1.0), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(mu=0.0), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(gamma=0.3, omega=1.3), marks=pytest.mark.deep),
        pytest.param(PAPER.replace(gamma=5.0, omega=0.3), marks=pytest.mark.deep),
    ],
)
def test_words_never_promise_recovery(parameters):
    result = study_once(parameters)
    verdict, tried = result.verdict, result.attractors.disturbances
    if any(not ending.recovered for ending in tried if ending.start.kind == "kick"):
        assert verdict.level != "all-tried-came-back"
    if verdict.level == "all-tried-came-back":
        assert "not proven" in verdict.headline
    if any(rub.status == "admissible" for rub in result.rubs) or result.stable_orbits:
        assert ("besides levitation there" in finding(result, "Verdict")) == result.levitates
        assert re.search(r"\bthere (is|are) ", finding(result, "Verdict"))
    covered = [SAMPLED.format(but=""), LONGER_MOTIONS, RIGID_WALL, PLANAR]
    assert finding(result, "Not covered").split("\n") == covered
    assert "nan" not in everything(result)
    assert "inf " not in everything(result)
    assert f"{len(tried)} disturbances (seed 0): " in finding(result, "Disturbances tried")
    # Many others are tried where there is something to come back to, and more of them where all of these came back.
    assert (result.present is not None) == result.levitates
    if result.present is not None:
        assert result.present.drawn.total == (10_000 if result.present.recovers else 2000)


def test_best_verdict_is_still_no_guarantee():
    quiet = study_once(QUIET)
    assert quiet.verdict.level == "all-tried-came-back"
    assert {ending.attractor.outcome for ending in quiet.attractors.disturbances} == {Outcome.LEVITATED}
    assert "not proven" in quiet.verdict.headline
    assert (quiet.present.drawn.count, quiet.present.drawn.total) == (10_000, 10_000)
    assert quiet.recommendation.kind == "no-change-needed"
    assert "No synchronous rub exists" in finding(quiet, "Rub")


def test_machine_that_cannot_levitate():
    result = study_once(PAPER.replace(gamma=0.05))

    assert result.verdict.level == "no-contact-free-motion"
    assert result.zone is None
    assert "cannot run without contact" in finding(result, "Levitation")


def test_machine_on_the_boundary():
    result = study_once(PAPER.replace(gamma=math.sqrt((3 / 7) ** 2 - (1 - 0.76**2) ** 2)))

    assert result.equilibria[0].status == "boundary"
    assert result.verdict.level == "no-contact-free-motion"


def test_tables_hold_every_motion(real):
    names = [row.name for row in motion_rows(real)]

    assert names[:3] == ["levitation", "synchronous rub", "synchronous rub"]
    assert {f"orbit {orbit.name}" for orbit in real.orbits} <= set(names)
    assert "rolling backward whirl" in names
    shares = [int(row.trials.split(" of ")[0]) for row in motion_rows(real) if row.trials]
    assert sum(shares) == len(real.attractors.disturbances)


EQUILIBRIUM_KEYS = {"kind", "U", "radius", "normal_force", "status", "stable"}


def strict(text):
    def refuse(name):
        raise ValueError(name)

    return json.loads(text, parse_constant=refuse)


def test_json_has_the_stable_keys(real):
    document = strict(as_json(real.to_dict()))

    assert set(document["parameters"]) == {"gamma", "omega", "rho", "phi", "mu", "d", "radius_ratio"}
    assert len(document["equilibria"]) == 3
    for entry in document["equilibria"]:
        assert set(entry) >= EQUILIBRIUM_KEYS
        assert len(entry["U"]) == 2
    assert {entry["status"] for entry in document["equilibria"]} <= {"admissible", "boundary", "virtual"}
    for entry in document["orbits"]:
        assert set(entry) >= ORBIT_KEYS
        assert [len(value) for value in entry["multipliers"]] == [2, 2, 2]
    assert document["machine_si"]["damping"] == 1400.0
    assert document["machine_given"]["damping"] == {"damping": "1400 N s/m"}
    disturbances = document["disturbances"]
    smallest = disturbances["smallest_unrecovered_kick"]
    assert disturbances["smallest_unrecovered_kick_si"] == pytest.approx(smallest * 0.7e-3 * 184.2, rel=1e-14)
    assert sum(entry["count"] for entry in document["attractors"]) == disturbances["count"] == 200
    assert document["requirement"]["source"] == "default"
    assert document["requirement"]["frame"] == "fixed"
    assert document["requirement"]["kick_si"] == pytest.approx(math.sqrt(4 * 9.80665 * 0.7e-3), rel=1e-14)
    for kind in ("kick", "shock", "blade_loss"):
        entry = document["survives"][kind]
        assert {"harmless_up_to", "all_up_to", "smallest_lost", "lost_to", "tried"} <= set(entry)
        assert entry["smallest_lost_si"] > 0.0
    assert document["survives"]["kick"]["smallest_lost_si"] == pytest.approx(5.467e-3, rel=1e-3)
    assert document["share"] == {
        "of": "kicks",
        "up_to": real.required.kick,
        "up_to_si": pytest.approx(document["requirement"]["kick_si"], rel=1e-14),
        "estimate": real.share.fraction,
        "low": real.share.low,
        "high": real.share.high,
    }
    assert [fact["text"] for fact in document["facts"]] == [fact.text for fact in real.facts]
    assert document["verdict"]["level"] == real.verdict.level


def test_json_values_are_those_of_the_study(real):
    document = strict(as_json(real.to_dict()))
    orbit = real.orbits["B1,d"]
    (entry,) = [entry for entry in document["orbits"] if entry["name"] == "B1,d"]

    assert entry["period"] == orbit.period
    assert entry["period_si"] == pytest.approx(orbit.period / 184.2, rel=1e-15)
    assert entry["normal_impulse_si"] == pytest.approx(1.95 * orbit.radial_speed * 50 * 0.7e-3 * 184.2, rel=1e-14)
    assert document["equilibria"][1]["normal_force_si"] == pytest.approx(900.8, abs=0.1)
    rub = next(entry for entry in document["thresholds"] if entry["motion"] == "rub" and entry["parameter"] == "gamma")
    assert rub["value_si"] == pytest.approx(rub["value"] * 50 * 184.2, rel=1e-15)
    assert rub["exists"] == "below"


def test_json_has_nothing_that_is_not_finite(real):
    # The contact-free range has an infinite end.
    document = strict(as_json(real.to_dict()))

    (entry,) = [e for e in document["ranges"] if e["motion"] == "contact-free" and e["parameter"] == "gamma"]
    assert entry["spans"][0][1] is None
    assert strict(as_json({"a": [math.nan, -math.inf, complex(1.0, math.inf)]})) == {"a": [None, None, [1.0, None]]}
