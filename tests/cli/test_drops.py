"""``carom simulate --drop``, and what other commands say of a machine that weighs something."""

import json
import math
from pathlib import Path

import pytest

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
            ("simulate", MACHINE, "--kick", "5 mm/s", "--regained-after", "5 ms"),
            "--regained-after = 5 ms: allowed only with",
        ),
        (
            (*DROP, "--set", "stiffness=1e5 N/m"),
            "levitation = up to 1.97 clearances from the centre: static sag and whirl",
        ),
    ],
)
def test_bad_drops_get_one_line(refused, arguments, words):
    refused(f"carom: {words}", *arguments)


RECOVERY = """
[[recovery]]
name = "early"
regain_after = "20 ms"

[[recovery]]
name = "damped"
regain_after = "20 ms"
lasts = "0.1 s"
gains = { damping = 1800, stiffness = "6e5 N/m" }
"""


def test_shares_that_come_back(carom, tmp_path):
    path = tmp_path / "machine.toml"
    path.write_text(Path(MACHINE).read_text(encoding="utf-8") + RECOVERY, encoding="utf-8")
    asked = ("drop", str(path), "--recovery", "--drops", "3", "--until", "2 s")
    found = document(carom(*asked, "--json"))
    assert [(each["name"], each["share"]["count"]) for each in found["recoveries"]] == [("early", 3), ("damped", 3)]
    code, out, _ = carom(*asked)
    assert code == 0
    assert "damped: regained after 20 ms, then for 100 ms, damping 1800, stiffness 6e5 N/m." in " ".join(out.split())
    again = tmp_path / "again.toml"
    again.write_text(cm.load(path).to_toml(), encoding="utf-8")
    assert cm.load(again).recoveries == cm.load(path).recoveries
    code, out, _ = carom("drop", str(path), "--regained-by", "early")
    assert code == 0
    assert "levitation regained after 20 ms" in " ".join(out.split())


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        (RECOVERY, ("--recovery", "--phase", "90 deg"), "--phase = 90 deg: not allowed with --recovery"),
        (RECOVERY, ("--drops", "3"), "--drops = 3: allowed only with --recovery"),
        (RECOVERY, ("--regained-by", "late"), "--regained-by = late: one of early, damped"),
        (RECOVERY + RECOVERY, ("--recovery",), "[[recovery]] 3: name = early: a name of its own for each"),
        ("", ("--recovery",), "recovery = nothing given: one or more tables [[recovery]]"),
        ("[[recovery]]\nregain_afer = 1", ("--recovery",), "[[recovery]] 1: regain_afer = 1: unknown name"),
        ("[recovery]\n", ("--recovery",), "recovery = "),
    ],
)
def test_what_is_no_comparison(carom, tmp_path, text, options, words):
    path = tmp_path / "machine.toml"
    path.write_text(Path(MACHINE).read_text(encoding="utf-8") + text, encoding="utf-8")
    code, _, err = carom("drop", str(path), *options)
    assert code == 2
    assert words in err
