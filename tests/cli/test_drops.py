"""``carom simulate --drop``, and what other commands say of a machine that weighs something."""

import json
import math

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
