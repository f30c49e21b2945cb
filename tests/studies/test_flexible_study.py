"""The study of a flexible machine: its sentences against fresh simulations and independent numbers."""

import math
from dataclasses import replace

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import Outcome
from carom.rotors import find_whirls, load_machine, synchronous_response
from carom.studies.critical_speeds import required_margin
from carom.studies.findings import facts_of
from carom.studies.levitating import levitating
from carom.studies.questions import about
from carom.studies.survives import DIRECTIONS, all_round, at_full_size

pytestmark = pytest.mark.jit_only

FILE = "examples/tum-flexible-rotor.toml"
MACHINE, CASE = load_machine(FILE), cm.load(FILE)


@pytest.fixture(scope="module")
def studied():
    case = cm.load(FILE)
    case = replace(
        case,
        requirement=cm.parameters.Requirement.of(case, kick="150 mm/s"),
        limits=cm.parameters.LoadLimits(force="300 N"),
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("carom.studies.questions.FEW_MODES", 2)  # fewer events: seconds instead of half a minute
        return cm.study(case, along=("friction", "proportional_1"))


def test_the_verdict_promises_no_more_than_was_tried(studied):
    (share,) = studied.present.returned
    assert (studied.verdict.level == "may-not-come-back") == bool(studied.unrecovered_kinds)
    assert "not proven" in studied.verdict.reason or studied.verdict.level != "all-tried-came-back"
    assert share.words in studied.verdict.headline


def test_fresh_kicks_fare_as_the_share_says(studied):
    """By other seeds: the share of a fresh sample lies in the interval that is stated."""
    (share,) = studied.present.returned
    kicks = cm.disturbances.VelocityKick(studied.required.kick)
    fresh = cm.map_basins(studied.rotor, cm.disturbances.Sample(kicks, 60, 77)).share_recovered
    assert share.low <= fresh.high
    assert fresh.low <= share.high


def test_any_parameter_of_the_machine_has_a_search(studied):
    assert [found.along.name for found in studied.recoveries] == ["friction", "proportional_1"]
    shown = [fact.text for fact in studied.facts if fact.topic == "What would change it"]
    assert shown[0].startswith("coefficient of friction (this machine: 0.15)")
    document = studied.to_dict()
    assert [each["parameter"] for each in document["recovery"]] == ["friction", "proportional_1"]


def test_forces_are_those_of_the_worst_motion(studied):
    (kicks,) = studied.full_size
    loads = cm.motions.drop_loads(kicks.worst)
    largest = max(plane.si()["force"] for plane in loads.planes)
    assert max(each.document()["force_si"] for each in kicks.bearings) == pytest.approx(largest)
    for each in kicks.bearings:
        assert each.radius > 1.0 if each.contacts else each.radius < 1.0
    (check,) = kicks.checks
    assert check.limit == 300.0
    assert check.value == pytest.approx(largest, rel=1e-6)


def test_the_drop_stands_in_the_verdict_with_its_loads_whether_limits_are_stated_or_not(studied):
    assert studied.drop is not None
    assert not studied.drop.assumed
    for limits in (studied.case.limits, cm.parameters.LoadLimits()):
        case = replace(studied.case, limits=limits)
        found = replace(studied, case=case, drop=replace(studied.drop, case=case))
        (drop,) = (fact.text for fact in about(tuple(facts_of(found)), "Verdict") if fact.label == "Drop")
        assert studied.drop.loads.outcome is Outcome.TIME_REACHED
        assert drop.startswith("not settled after 0.2 s")
        for plane in studied.drop.loads.planes:
            assert f"{plane.si()['force']:,.3g} N" in drop
        assert drop.endswith("the file states no limits of the touchdown bearing") == (not limits.given)


def test_what_is_withheld_and_the_accuracy_are_told(studied):
    topics = {fact.topic for fact in studied.facts}
    assert {"Not covered", "Accuracy", "Drop", "Critical speeds", "Magnetic bearings"} <= topics
    accuracy = next(fact for fact in studied.facts if fact.topic == "Accuracy")
    assert accuracy.values["error"] == studied.rotor.finite_elements.error
    document = studied.to_dict()
    assert {"survives", "share", "requirement", "levitating", "reduction", "drop", "full_size"} <= set(document)
    assert len(document["facts"]) == len(studied.facts)


def test_critical_speeds_are_peaks_of_the_response():
    found = levitating(CASE, cm.models.rotor_of(CASE))
    assert found.criticals
    for each in found.criticals:
        step = 0.01 * each.speed
        near = synchronous_response(MACHINE, [each.speed - step, each.speed, each.speed + step])
        sizes = near.sensors.major[:, each.bearing - 1]
        assert sizes.argmax() == 1
        assert sizes[1] == pytest.approx(each.amplitude, rel=1e-9)
        assert each.separation.required == required_margin(each.factor, each.separation.side)


def test_the_amplification_factor_is_that_of_the_damping_ratio():
    """Of a single narrow peak, 1/(2ζ), to the next order in ζ and what other whirls add."""
    found = levitating(CASE, cm.models.rotor_of(CASE))
    lowest = min(found.criticals, key=lambda each: each.speed)
    whirl = min(
        (each for each in find_whirls(MACHINE, lowest.speed) if each.sense == "forward"),
        key=lambda each: abs(2.0 * math.pi * each.frequency - lowest.speed),
    )
    assert lowest.factor == pytest.approx(0.5 / whirl.damping_ratio, rel=0.1)


def test_of_motions_without_contact_the_orbit_is_told_not_the_start():
    """A kick that is known at once to come back is followed all the same; its widest orbit against a fresh one in finer steps."""
    case = cm.load(FILE)
    case = replace(case, requirement=cm.parameters.Requirement.of(case, kick="30 mm/s"))
    rotor = cm.models.rotor_of(case)
    required = case.requirement.own(rotor.scales)
    (kicks,) = at_full_size(rotor, required)
    assert kicks.back.count == DIRECTIONS
    for each in kicks.bearings:
        assert not each.contacts
        widest = 0.0
        for pair in all_round():
            motion = cm.simulate(rotor, cm.kick(required.kick, *pair), 300.0)
            radii = motion.seen_at(each.touchdown_bearing - 1).radius(np.linspace(0.0, 300.0, 50_001))
            widest = max(widest, radii.max())
        assert each.radius == pytest.approx(widest, rel=1e-3)
    assert kicks.worst.time > 100.0
