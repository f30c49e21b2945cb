"""Loads against the limits of a touchdown bearing."""

import math

import pytest

import carom as cm
from carom.models import rotor_of
from carom.motions import drop_loads
from carom.parameters import LoadLimits, Required, Shock
from carom.studies import check_loads
from carom.studies.survives import all_round, at_full_size

MACHINE = cm.load("examples/keogh-cole.toml")
ALL = LoadLimits(impulse="5 N s", force="2 kN", power="10 kW", heat="1 kJ", impacts=100)


def motion(start):
    return cm.simulate(MACHINE, start, settle=True)


def test_each_limit_is_compared_with_its_load():
    loads = drop_loads(motion(cm.kick(0.1, 2.0))).planes[0]
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
    assert "s later if contact continues" in checks["heat"].words
    assert checks["impacts"].words.endswith("limit 100: exceeded")
    assert checks["force"].words.endswith(": kept")


def test_the_heat_of_a_rub_reaches_its_limit_when_it_is_said_to():
    start = cm.kick(0.1, 2.0)
    (heat,) = check_loads(drop_loads(motion(start)).planes[0], LoadLimits(heat="1 kJ"))
    time = motion(start).time + heat.after / MACHINE.parameters.scales.time
    followed = drop_loads(cm.simulate(MACHINE, start, time)).planes[0]
    assert followed.si()["heat"] == pytest.approx(1000.0, rel=1e-5)


def test_bouncing_has_no_end_of_impacts():
    loads = drop_loads(motion(cm.kick("50 mm/s"))).planes[0]
    (impacts,) = check_loads(loads, LoadLimits(impacts=100_000))
    assert impacts.exceeded
    assert impacts.endless
    assert impacts.after == math.inf


def test_a_motion_that_comes_back_keeps_what_it_has_not_exceeded():
    quiet = MACHINE.replace(eccentricity="10 um", damping="3000 N s/m")
    loads = drop_loads(cm.simulate(quiet, cm.kick("200 mm/s"), settle=True)).planes[0]
    assert loads.contacts > 0
    assert not loads.goes_on
    exact = LoadLimits(impacts=loads.contacts, impulse=loads.si()["impulse"] * (1.0 + 1e-9))
    assert not any(check.exceeded for check in check_loads(loads, exact))
    less = LoadLimits(impacts=loads.contacts - 1, impulse=0.999 * loads.si()["impulse"])
    assert all(check.exceeded for check in check_loads(loads, less))


def test_nothing_is_compared_without_scales():
    case = cm.load("examples/source-paper.toml")
    assert check_loads(drop_loads(cm.simulate(case, cm.kick(0.4), 20.0)).planes[0], ALL) == ()


@pytest.mark.jit_only
def test_the_worst_at_full_size_is_compared_with_the_limits():
    """A shock is followed from its beginning: this one is hardest on the bearing while it lasts."""
    shock = cm.BaseShock.of(MACHINE, "20 g", "11 ms")
    rotor, required = rotor_of(MACHINE), Required(0.1, Shock(shock.peak, shock.duration), None)
    kicks, shocks = at_full_size(rotor, required, ALL)
    for found, model in ((kicks, cm.disturbances.VelocityKick(0.1)), (shocks, shock)):
        motions = [
            cm.simulate(*model.apply(rotor, angle, instant=instant), settle=True, max_events=5000)
            for angle, instant in all_round()
        ]
        checks = [check_loads(plane, ALL) for each in motions for plane in drop_loads(each).planes]
        for place, check in enumerate(found.checks):
            assert check.value == max(each[place].value for each in checks if each[place].exceeded == check.exceeded)
            assert check.exceeded == any(each[place].exceeded for each in checks)
    assert shocks.checks[0].exceeded
    assert [entry["name"] for entry in shocks.document()["limits"]] == list(ALL.given)
    assert at_full_size(rotor, Required(1e-3, None, None), ALL)[0].checks[0].value == 0.0
