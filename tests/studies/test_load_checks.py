"""Loads against the limits of a touchdown bearing."""

from __future__ import annotations

import dataclasses
import math

import pytest

import carom as cm
from carom.attractors import find_attractors
from carom.motions import touchdown_loads
from carom.parameters import Case, LoadLimits, Required, Shock, Zones
from carom.studies import check_loads, worst_loads

MACHINE = cm.load("examples/keogh-cole.toml")
ALL = LoadLimits(impulse="5 N s", force="2 kN", power="10 kW", heat="1 kJ", impacts=100)


def motion(start):
    return cm.simulate(MACHINE, start, settle=True)


def test_each_limit_is_compared_with_its_load():
    loads = touchdown_loads(motion(cm.kick(0.1, 2.0)))
    checks = {check.name: check for check in check_loads(loads, ALL)}
    si = loads.si()
    assert list(checks) == ["impulse", "force", "power", "heat", "impacts"]
    assert all(checks[name].value == si[name] for name in ("impulse", "force", "power", "heat"))
    assert {name: check.exceeded for name, check in checks.items()} == {
        "impulse": False,
        "force": False,
        "power": False,
        "heat": True,
        "impacts": True,
    }
    # The rub goes on: its heat reaches the limit.
    assert checks["heat"].after == pytest.approx((1000.0 - si["heat"]) / si["lasting_power"])
    assert "s later, as the motion goes on in contact" in checks["heat"].words
    assert checks["impacts"].words.endswith("limit 100: exceeded")
    assert checks["force"].words.endswith(": kept")


def test_the_heat_of_a_rub_reaches_its_limit_when_it_is_said_to():
    start = cm.kick(0.1, 2.0)
    (heat,) = check_loads(touchdown_loads(motion(start)), LoadLimits(heat="1 kJ"))
    time = motion(start).time + heat.after / MACHINE.parameters.scales.time
    followed = touchdown_loads(cm.simulate(MACHINE, start, time))
    assert followed.si()["heat"] == pytest.approx(1000.0, rel=1e-5)


def test_bouncing_has_no_end_of_impacts():
    loads = touchdown_loads(motion(cm.kick("50 mm/s")))
    (impacts,) = check_loads(loads, LoadLimits(impacts=100_000))
    assert impacts.exceeded
    assert impacts.endless
    assert impacts.after == math.inf


def test_a_motion_that_comes_back_keeps_what_it_has_not_exceeded():
    quiet = MACHINE.replace(eccentricity="10 um", damping="3000 N s/m")
    loads = touchdown_loads(cm.simulate(quiet, cm.kick("200 mm/s"), settle=True))
    assert loads.impacts > 0
    assert not loads.goes_on
    exact = LoadLimits(impacts=loads.impacts, impulse=loads.si()["impulse"] * (1.0 + 1e-9))
    assert not any(check.exceeded for check in check_loads(loads, exact))
    less = LoadLimits(impacts=loads.impacts - 1, impulse=0.999 * loads.si()["impulse"])
    assert all(check.exceeded for check in check_loads(loads, less))


def test_nothing_is_compared_without_scales():
    case = cm.load("examples/source-paper.toml")
    assert check_loads(touchdown_loads(cm.simulate(case, cm.kick(0.4), 20.0)), ALL) == ()


def test_the_worst_over_disturbances():
    starts = [cm.kick(0.1, 2.0), cm.kick("50 mm/s"), cm.kick(1e-3)]
    worst = worst_loads(find_attractors(MACHINE, starts, known=False), ALL)
    assert worst.disturbances == 2
    singles = [check_loads(touchdown_loads(motion(start)), ALL) for start in starts[:2]]
    for place, check in enumerate(worst.checks):
        assert check.value == pytest.approx(max(single[place].value for single in singles))
        assert worst.exceeding[place] == sum(single[place].exceeded for single in singles)
    assert worst.exceeded
    assert "limit 5 N s: exceeded by 1 of 2" in worst.words
    assert "limit 2,000 N: kept by all" in worst.words
    document = worst.document()
    assert [entry["name"] for entry in document["limits"]] == list(ALL.given)
    none = worst_loads(find_attractors(MACHINE, [cm.kick(1e-3)], known=False), ALL)
    assert none.words.startswith("None of the disturbances")


@pytest.mark.jit_only
def test_a_study_says_it():
    calm = MACHINE.parameters.replace(gamma=0.65, mu=0.0)
    case = Case("calm", calm, None, Zones(), LoadLimits(force="1 N", impulse="1 kN s"))
    found = cm.study(case, cm.disturbances.Sample(cm.disturbances.VelocityKick(1.5), 20))
    assert found.loads.disturbances > 0
    said = "\n".join(fact.text for fact in found.facts if fact.topic == "Touchdown loads")
    assert said.endswith(found.loads.words)
    assert "limit 1,000 N s: kept by all" in said
    assert found.to_dict()["loads"]["limits"][0]["name"] == "impulse"
    silent = dataclasses.replace(found, loads=None)
    assert not any(fact.text.startswith("Largest loads") for fact in silent.facts)


def test_shocks_and_losses_of_a_blade_that_must_be_survived_count():
    """A shock is followed from its beginning: this one is hardest on the bearing while it lasts."""
    limits, quiet = LoadLimits(impulse="5 N s"), find_attractors(MACHINE, [cm.kick(1e-3)], known=False)
    shock = cm.BaseShock.of(MACHINE, "20 g", "11 ms")
    required = Required(0.1, Shock(shock.peak, shock.duration), None)
    worst = worst_loads(quiet, limits, required)
    assert worst.disturbances == 24
    (check,) = worst.checks
    hardest, later = 0.0, 0.0
    for place in range(24):
        first, second = cm.simulate(*shock.apply(MACHINE, 2.0 * math.pi * place / 24)).parts
        hardest = max(hardest, first.contacts.normal_impulse.max(), second.contacts.normal_impulse.max(initial=0.0))
        later = max(later, second.contacts.normal_impulse.max(initial=0.0))
    assert check.value == pytest.approx(hardest * MACHINE.parameters.scales.impulse)
    assert hardest > later
    lost = worst_loads(quiet, limits, Required(0.1, None, 0.6))
    assert lost.disturbances > 0
