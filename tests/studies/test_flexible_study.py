"""The study of a flexible machine: its sentences against fresh simulations and independent numbers."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import carom as cm
from carom.closed_forms import synchronous_response
from carom.motions.budget import Budget
from carom.outcome import InputError, Outcome
from carom.progress import Reporter
from carom.rotors import Whirl, find_whirls, load_machine
from carom.rotors.collocation import Collocation
from carom.studies import flexible_study
from carom.studies.facts import about
from carom.studies.flexible_facts import facts_of_machine
from carom.studies.flexible_levitation import levitation_of_machine
from carom.studies.flexible_trials import DIRECTIONS, all_round, trials_of
from carom.studies.standards import required_margin

pytestmark = pytest.mark.jit_only

FILE = "examples/tum-flexible-rotor.toml"
MACHINE = load_machine(FILE)


@pytest.fixture(scope="module")
def studied():
    case = cm.load(FILE)
    case = replace(
        case,
        requirement=cm.parameters.Requirement.of(case, kick="300 mm/s"),
        limits=cm.parameters.LoadLimits(force="300 N"),
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(flexible_study, "DRAWN", 60)
        return cm.study(case)


def test_the_verdict_promises_no_more_than_was_tried(studied):
    (trial,) = studied.trials
    assert studied.verdict.level == ("all-tried-came-back" if trial.survived else "may-not-come-back")
    assert "no guarantee" in studied.verdict.reason or not trial.survived
    assert f"{trial.drawn.count} of {trial.drawn.total} kicks" in studied.verdict.headline


def test_fresh_kicks_fare_as_the_share_says(studied):
    """By other seeds: the share of a fresh sample lies in the interval that is told."""
    (trial,) = studied.trials
    kicks = cm.disturbances.VelocityKick(studied.required.kick)
    fresh = cm.map_basins(studied.rotor, cm.disturbances.Sample(kicks, 60, 77)).share_recovered
    assert trial.drawn.low <= fresh.fraction <= trial.drawn.high


def test_larger_kicks_were_followed_as_told(studied):
    kick = studied.required.kick
    for times, back in studied.beyond:
        came = 0
        for number in range(DIRECTIONS):
            motion = cm.simulate(
                studied.rotor, cm.kick(times * kick, 2.0 * math.pi * number / DIRECTIONS), max_events=20_000
            )
            came += motion.outcome is Outcome.LEVITATED
        assert (came, DIRECTIONS) == (back.count, back.total)
        break  # one multiple is enough here: the others are followed alike


def test_forces_are_those_of_the_worst_motion(studied):
    (trial,) = studied.trials
    loads = cm.motions.drop_loads(trial.worst)
    largest = max(plane.loads.si()["force"] for plane in loads.planes)
    assert max(each.force for each in trial.planes) == pytest.approx(largest)
    for each in trial.planes:
        clearance = MACHINE.clearances[each.touchdown_bearing - 1]
        assert each.radius > clearance if each.contacts else each.radius < clearance
    (check,) = trial.checks
    assert check.exceeded == (largest > 300.0)


def test_the_drop_stands_in_the_verdict_with_its_loads_whether_limits_are_stated_or_not(studied):
    assert studied.fall_loads is not None
    for limits in (studied.case.limits, cm.parameters.LoadLimits()):
        found = replace(studied, case=replace(studied.case, limits=limits))
        (drop,) = (fact.text for fact in about(facts_of_machine(found), "Verdict") if fact.label == "Drop")
        assert drop.startswith(studied.fall_loads.outcome.words)
        for plane in studied.fall_loads.planes:
            assert f"{plane.loads.si()['force']:,.3g} N" in drop
        assert drop.endswith("no limit of a touchdown bearing is stated to compare them with") == (not limits.given)


def test_what_is_withheld_and_the_accuracy_are_told(studied):
    topics = {fact.topic for fact in studied.facts}
    assert {"Not covered", "Accuracy", "Drop", "Critical speeds", "Magnetic bearings"} <= topics
    accuracy = next(fact for fact in studied.facts if fact.topic == "Accuracy")
    assert accuracy.values["error"] == studied.reduced.error
    document = json.loads(json.dumps(studied.to_dict()))
    assert document["complete"] is False
    assert len(document["facts"]) == len(studied.facts)


def test_critical_speeds_are_peaks_of_the_response():
    found = levitation_of_machine(MACHINE)
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
    found = levitation_of_machine(MACHINE)
    lowest = min(found.criticals, key=lambda each: each.speed)
    whirl = min(
        (each for each in find_whirls(MACHINE, lowest.speed) if each.sense == "forward"),
        key=lambda each: abs(2.0 * math.pi * each.frequency - lowest.speed),
    )
    assert lowest.factor == pytest.approx(0.5 / whirl.damping_ratio, rel=0.1)


@pytest.mark.parametrize(
    ("sensor", "magnet", "opposed", "hardly"),
    [(0.5, 0.4, False, False), (0.5, -0.4, True, False), (0.5j, 0.4j, False, False), (0.01, -0.5, False, True)],
)
def test_a_node_between_sensor_and_magnet(sensor, magnet, opposed, hardly):
    found = Collocation(1, Whirl(1j, np.ones(2, complex), np.zeros(2, complex)), sensor, magnet)
    assert (found.opposed, found.hardly) == (opposed, hardly)


def test_a_plan_of_ones_own_is_refused_in_a_line():
    with pytest.raises(InputError, match=r"^proofs = true: left out for a flexible machine$"):
        cm.study(cm.load(FILE), proofs=True)


def test_of_motions_without_contact_the_orbit_is_told_not_the_start():
    """A kick that is known at once to come back is followed all the same; its widest orbit against a fresh one in finer steps."""
    case = cm.load(FILE)
    case = replace(case, requirement=cm.parameters.Requirement.of(case, kick="30 mm/s"))
    rotor = cm.models.model_of(case)
    required = case.requirement.own(rotor.scales)
    (trial,) = trials_of(case, rotor, required, 10, Budget(), Reporter.of(None, "trial"))
    assert trial.largest.count == DIRECTIONS
    assert not any(each.contacts for each in trial.planes)
    for each in trial.planes:
        widest = 0.0
        for pair in all_round():
            motion = cm.simulate(rotor, cm.kick(required.kick, *pair), 300.0)
            radii = motion.seen_at(each.touchdown_bearing - 1).radius(np.linspace(0.0, 300.0, 50_001))
            widest = max(widest, radii.max() * MACHINE.clearances[each.touchdown_bearing - 1])
        assert each.radius == pytest.approx(widest, rel=1e-3)
    assert trial.worst.time > 100.0
