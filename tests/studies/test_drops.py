"""A drop in words and as JSON, against the limits of the touchdown bearing."""

import json
import math
from dataclasses import replace

import pytest

import carom as cm
from carom.base.files import as_json
from carom.base.outcome import InputError, Outcome
from carom.motions import drop_loads
from carom.motions.loads import LastWhirl
from carom.parameters import LoadLimits, Scales
from carom.studies import DropStudy, check_loads
from carom.studies.drops import LoadCheck, _whirl_words, worst_of

pytestmark = pytest.mark.jit_only


def dropped(machine, until=None, settings=(), **how):
    case = cm.load(f"examples/{machine}.toml", settings)
    motion = cm.simulate(case, cm.drop(**how), until)
    return DropStudy(
        case,
        cm.drop().echo_at(cm.models.rotor_of(case), motion.rotor, motion.parts[0].start, case.gravity),
        drop_loads(motion),
    )


@pytest.fixture(scope="module")
def whirl():
    return dropped(
        "touchdown-balls", "60 ms", at=cm.disturbances.whirl("0.2 mm", "-400 Hz", "30 deg"), race_speed="500 rpm"
    )


def test_a_force_that_grows_to_the_end_says_so(whirl):
    growing = dropped("touchdown-balls", "6 s", ["speed=30000 rpm"])
    ((_, rows),) = growing.tables
    assert dict(rows)["peak force"].endswith(", still growing at the end: follow the motion longer")
    assert growing.document()["touchdown_bearings"][0]["loads"]["still_growing"]
    assert all(check.still_growing for check in growing.checks if check.name in ("force", "depth", "pressure"))
    assert "still growing" not in dict(whirl.tables[0][1])["peak force"]


@pytest.mark.parametrize(
    ("speed", "words"),
    [(1.0, "synchronous with the shaft"), (-1.0, "1 times the shaft speed"), (1.01, "1.01 times the shaft speed")],
)
def test_a_whirl_says_how_it_goes_with_the_shaft(speed, words):
    whirl = LastWhirl(speed, 16.0 * math.pi * speed, 16.0 * math.pi, 0.0, goes_on=True, scales=Scales(1.0, 1e-3, 100.0))
    assert f"({words}); it persists" in _whirl_words(whirl, Outcome.FORWARD_RUB)


def test_limits_of_depth_and_pressure(whirl):
    exceeded = {check.name: check.exceeded for check in whirl.checks}
    assert exceeded == {"force": True, "heat": False, "depth": True, "pressure": True}
    words = [check.words for check in whirl.checks]
    assert "depth in the bearing: 74.3 µm, limit 50 µm: exceeded" in words
    assert "ball pressure: 4.79 GPa, limit 4.2 GPa: exceeded" in words


def test_a_limit_of_pressure_needs_balls(whirl):
    rigid = dropped("dropped-rotor", "12 ms")
    with pytest.raises(InputError, match=r"pressure = 4.2e\+09|pressure = 4200000000.0"):
        check_loads(rigid.loads.planes[0], whirl.case.limits)


def test_temperature_torque_and_cage_of_a_landing():
    given = (
        "race_mass=0.05 kg",
        "load_factor=0.01",
        "starting_torque=0.01",
        "internal_clearance=0",
        "temperature=40 °C",
    )
    found = dropped("touchdown-balls", "60 ms", settings=[f"touchdown_{each}" for each in given])
    (plane,), ((_, rows),), (entry,) = found.loads.planes, found.tables, found.document()["touchdown_bearings"]
    shown = dict(rows)
    assert shown["temperatures at the end"].startswith("sleeve 40.")
    assert shown["growth by heat"].endswith("GPa)")
    assert "would take as much over this motion" in shown["torque of balls"]
    assert shown["starting torque"] == "overcome by friction from a force of 3.29 N"
    assert shown["cage"].endswith("if the balls roll")
    assert entry["temperatures"]["highest"] == plane.si()["temperature"] > 40.0
    assert entry["turning"]["heat_si"] == pytest.approx(plane.turning.heat * found.loads.scales.energy)
    (check,) = (each for each in check_loads(plane, LoadLimits(temperature=40)) if each.name == "temperature")
    assert check.exceeded
    assert check.words.startswith("highest temperature: 40.")
    assert check.margin == -math.inf
    rise = plane.temperatures.highest - 40.0
    (check,) = (
        each for each in check_loads(plane, LoadLimits(temperature=40.0 + 4.0 * rise)) if each.name == "temperature"
    )
    assert check.margin == pytest.approx(0.75, rel=1e-9)


def test_the_worst_check_of_each_limit_where_not_all_bearings_have_it():
    rated, others = (LoadCheck(name, 2.0, 1.0, False, False, True, 0.0) for name in ("static_share", "force"))
    assert worst_of([(replace(others, value=3.0),), (rated, others)]) == (replace(others, value=3.0), rated)


def test_a_rigid_wall_has_impulses_in_place_of_forces():
    found = dropped("dropped-rotor", settings=["restitution=0.1"])
    ((_, rows),) = found.tables
    shown = dict(rows)
    assert found.headline.startswith("Rest on the touchdown bearing from ")
    assert "after the release; followed for" in found.headline
    assert shown["hardest impact"].endswith("(a rigid wall has no peak force)")
    assert "peak force" not in shown
    assert shown["whirl at the end"] == "none"
    assert shown["heating continues"].startswith("at ")
    (plane,) = found.document()["touchdown_bearings"]
    assert plane["force_at"] is None
    assert plane["loads"]["force_is_of_lasting_contact"]


def test_as_json(whirl):
    document = json.loads(as_json(whirl.document()))
    (plane,) = document["touchdown_bearings"]
    (loads,) = whirl.loads.planes
    assert document["time_si"] == pytest.approx(60e-3)
    assert (document["outcome"], document["settled_at"]) == ("time-reached", None)
    assert document["touchdown"]["law"] == "hunt-crossley"
    assert plane["loads"]["pressure_si"] == loads.pressure
    assert plane["force_at_si"] == loads.force_at * whirl.case.parameters.scales.time
    assert plane["race_at_end_si"] == loads.race_at_end * whirl.case.parameters.scales.speed
    assert plane["whirl"]["direction"] == "backward"
    assert not plane["whirl"]["goes_on"]
    assert [entry["name"] for entry in plane["limits"]] == ["force", "heat", "depth", "pressure"]
