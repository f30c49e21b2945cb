"""``carom simulate --drop``, and what other commands say of a machine that weighs something."""

import csv
import json
import math
from pathlib import Path

import pytest
import xarray

import carom as cm

pytestmark = pytest.mark.jit_only

MACHINE = "examples/dropped-rotor.toml"
DROP = ("simulate", MACHINE, "--drop")


def document(answer):
    code, out, err = answer
    assert (code, err) == (0, "")
    return json.loads(out)


def test_a_drop_as_a_document(carom):
    found = document(carom(*DROP, "--json"))
    case = cm.load(MACHINE)
    motion = cm.simulate(case, cm.drop())
    assert found["disturbance"]["kind"] == "drop"
    assert found["disturbance"]["radius_si"] == pytest.approx(abs(motion.start.position) * 0.25e-3)
    assert found["gravity"] == {"acceleration_si": 9.81, "direction": -0.5 * math.pi}
    assert found["parameters"] == case.parameters.as_dict()
    assert found["outcome"] == "at-rest"
    assert [impact["time"] for impact in found["impacts"]] == motion.contacts.time.tolist()
    assert [contact["kind"] for contact in found["contacts"]] == ["slide"]
    assert {"final", "time", "touchdown_bearings", "scales_si"} <= found.keys()
    assert "stages" not in found


def test_levitation_regained_is_a_stage_of_its_own(carom, tmp_path):
    table, log = tmp_path / "log.csv", tmp_path / "log.nc"
    options = ("--regained-after", "5.4 ms", "--csv", str(table), "--netcdf", str(log))
    found = document(carom(*DROP, *options, "--json"))
    falls, levitates = found["stages"]
    assert (falls["outcome"], levitates["outcome"], found["outcome"]) == ("triggered", "levitated", "levitated")
    assert found["disturbance"]["regained_after_si"] == pytest.approx(5.4e-3)
    assert found["time"] == falls["time"] + levitates["time"]
    # It touches after levitation is back: all times count from the release.
    assert not falls["impacts"]
    times = [levitates["begins"] + impact["time"] for impact in levitates["impacts"]]
    assert [impact["time"] for impact in found["impacts"]] == times
    assert times
    assert found["start"] == falls["start"]
    unit = 1.0 / cm.load(MACHINE).machine.speed
    with table.open(encoding="utf-8") as stream:
        assert [float(row["time [s]"]) for row in csv.DictReader(stream)] == pytest.approx([unit * t for t in times])
    with xarray.open_dataset(log) as dataset:
        assert dataset.time.values == pytest.approx([unit * time for time in times])
        assert dataset.attrs["end_time"] == pytest.approx(unit * found["time"])


def test_contacts_with_a_bearing_that_gives_way(carom, tmp_path):
    """Each contact of both stages has its loads in SI, and its times count from the release."""
    text = Path(MACHINE).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("restitution")]
    bearing = ["[touchdown]", 'law = "kelvin-voigt"', 'stiffness = "1e8 N/m"', 'damping = "3000 N s/m"']
    machine = tmp_path / "machine.toml"
    machine.write_text("\n".join([*lines, *bearing]), encoding="utf-8")
    found = document(carom("simulate", str(machine), "--drop", "--regained-after", "5.9 ms", "--json"))
    scales, (falls, levitates) = found["scales_si"], found["stages"]
    # Levitation is back in the middle of the first contact.
    first, second, *_ = found["contacts"]
    assert not found["impacts"]
    assert len(found["contacts"]) == len(falls["contacts"]) + len(levitates["contacts"])
    assert (first["touchdown_bearing"], second["touchdown_bearing"]) == (1, 1)
    assert (first["lasts"], second["lasts"]) == (True, False)
    assert first["end"] == second["start"] == levitates["begins"]
    assert first["start"] < first["peak_time"] <= first["end"] <= second["peak_time"] < second["end"]
    # Beside the wall's force others hardly count in so short a time.
    change = (first["radial_speed"] - second["radial_speed_after"]) * scales["velocity"]
    assert first["impulse_si"] + second["impulse_si"] == pytest.approx(5.0 * change, rel=0.01)
    deepest = first["radial_speed"] * scales["velocity"] * math.sqrt(5.0 / 1e8)
    assert 0.8 * deepest < first["deepest_si"] < 1.05 * deepest
    assert first["peak_force_si"] == pytest.approx(1e8 * first["deepest_si"], rel=0.02)  # and 1.3 % of damping


def test_a_drop_in_words_is_seen_from_the_fixed_frame(carom):
    code, out, err = carom(*DROP)
    words = " ".join(out.split())
    assert (code, err) == (0, "")
    assert "Release: rotor centre 0.0986 mm from the middle at -91.3°" in words
    assert "under 9.81 m/s² at -90°; angles count from the fixed x axis" in words
    assert "The rotor ends in rest on the touchdown bearing" in words
    assert "At the end, in the fixed frame: 1 c_r (0.25 mm) from the centre at -" in words
    assert "-89.71" in words  # the first impact, next to the bottom


def test_a_drop_with_a_start_or_a_kick(carom):
    centre = document(carom(*DROP, "--start", "0,0,0,0", "--set", "eccentricity=0", "--json"))
    assert centre["impacts"][0]["time"] / cm.load(MACHINE).machine.speed == pytest.approx(7.139215615e-3, abs=5e-13)
    kicked = document(carom(*DROP, "--kick", "50 mm/s", "--until", "10 ms", "--json"))
    assert kicked["outcome"] == "time-reached"


def test_figures_of_both_stages(carom, tmp_path):
    code, _, err = carom(*DROP, "--regained-after", "12 ms", "--out", str(tmp_path / "drop"))
    assert (code, err.strip()) == (0, f"Written to {tmp_path / 'drop'}")
    names = {path.stem for path in (tmp_path / "drop" / "figures").iterdir()}
    assert {"motion", "touchdown", "motion-2", "radius-2"} <= names


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            ("simulate", "examples/source-paper.toml", "--drop"),
            "gravity = nothing given: a drop needs weight",
        ),
        (
            ("simulate", "examples/source-paper.toml", "--drop", "--set", "gravity=9.81"),
            "gravity = 9.81: not allowed beside",
        ),
        ((*DROP, "--shock", "5 g"), "--drop = with --shock 5 g: allowed alone, or with one of --start, --kick"),
        (
            (*DROP, "--kick", "5 mm/s", "--start", "0,0,0,0"),
            "--drop = with --start 0,0,0,0 with --kick 5 mm/s: allowed",
        ),
        ((*DROP, "--regained-after", "5"), "--regained-after = 5: must be a time"),
        (
            ("simulate", MACHINE, "--kick", "5 mm/s", "--regained-after", "5 ms"),
            "--regained-after = 5 ms: allowed only with",
        ),
        (
            (*DROP, "--set", "stiffness=1e5 N/m"),
            "levitation = up to 1.97 clearances from the centre: static sag and whirl",
        ),
        (
            ("simulate", MACHINE, "--set", "stiffness=1e5 N/m", "--shock", "5 g"),
            "levitation = up to 1.97 clearances from the centre: static sag and whirl",
        ),
    ],
)
def test_bad_drops_get_one_line(carom, arguments, words):
    code, out, err = carom(*arguments)
    assert (code, out) == (2, "")
    assert err.startswith(f"carom: {words}")
    assert err.count("\n") == 1


def test_orbits_of_a_heavy_rotor_say_how_many_turns_they_take(carom):
    bounces = ("gravity=100", "unbalance=400 g mm", "friction=0")
    settings = [text for each in bounces for text in ("--set", each)]
    arguments = ("orbits", MACHINE, "--impacts", "1", "--guesses", "20", *settings)
    (orbit,) = document(carom(*arguments, "--json"))["orbits"]
    assert orbit["turns"] == 2
    assert orbit["period"] == pytest.approx(4.0 * math.pi)
    assert len(orbit["multipliers"]) == 4
    code, out, _ = carom(*arguments)
    assert code == 0
    assert "13.3 ms, 2 turns" in out


BALLS = "examples/touchdown-balls.toml"


@pytest.mark.parametrize(
    ("option", "value", "since"),
    [
        ("--shock", "20 g, 5 ms", "the shock began"),
        ("--kick", "300 mm/s", "the kick"),
        ("--blade-loss", "2000 g mm, 90 deg", "the loss"),
    ],
)
def test_a_bearing_that_gives_way_tells_its_loads_after_any_disturbance(carom, option, value, since):
    command = ("simulate", BALLS, option, value, "--until", "30 ms")
    code, out, err = carom(*command)
    assert (code, err) == (0, "")
    words = " ".join(out.split())
    _, out, _ = carom(*command, "--json")
    document = json.loads(out)
    (bearing,) = document["touchdown_bearings"]
    peak = bearing["loads"]["force_si"]
    # The limits of the table are compared with the loads of the whole motion, once.
    assert f"ms after {since}" in words
    assert words.count("normal force:") == 1
    assert bearing["limits"]
    assert peak > 1000.0
    assert bearing["loads"]["pressure_si"] > 1e9
    forces = [entry["peak_force_si"] for entry in document["contacts"]]
    assert max(forces) == pytest.approx(peak, rel=1e-12)
    assert len(forces) == bearing["contacts"]
    # Its wall has a law of its own, and no coefficient of restitution.
    assert "d" not in document["parameters"]
    assert document["touchdown"]["law"] == "hunt-crossley"


def test_what_is_hit_during_a_shock_counts(carom):
    """The hardest contact of this shock comes while it lasts."""
    _, out, _ = carom("simulate", BALLS, "--shock", "20 g, 5 ms", "--until", "30 ms", "--json")
    document = json.loads(out)
    whole, first, second = (each["touchdown_bearings"][0] for each in (document, *document["stages"]))
    assert whole["loads"]["force_si"] == first["loads"]["force_si"] > 2.0 * second["loads"]["force_si"]
    assert whole["force_at_si"] < 5e-3
    assert whole["fastest_race_si"] > whole["race_at_end_si"] > 0.0
