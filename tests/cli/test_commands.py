"""What the commands print."""

import json

import pytest
from studies import ORBIT_KEYS

from carom import __version__, find_equilibria, find_orbits, load
from carom.models import jeffcott

pytestmark = pytest.mark.jit_only


def document(answer):
    code, out, err = answer
    assert code == 0, err
    assert err == ""
    value, end = json.JSONDecoder().raw_decode(out)
    assert out[end:] == "\n"
    assert isinstance(value, dict)
    return value


# ------------------------------------------------------------------------------------------------ orbits


def test_orbits_as_json(carom, machine):
    value = document(carom("orbits", machine, "--json"))
    rotor = jeffcott(load(machine).parameters)

    assert set(value) >= {"parameters", "equilibria", "orbits"}
    assert all(set(entry) >= ORBIT_KEYS for entry in value["orbits"])
    assert [entry["period"] for entry in value["orbits"]] == [orbit.period for orbit in find_orbits(rotor)]
    assert [entry["status"] for entry in value["equilibria"]] == [entry.status for entry in find_equilibria(rotor)]
    assert value["complete"] is True


def test_orbits_with_several_impacts(carom, dimensionless):
    asked = ("orbits", dimensionless, "--set", "gamma=0.083", "--impacts", "2", "--guesses", "250")
    value = document(carom(*asked, "--json"))
    assert value["impacts"] == 2
    assert value["search"]["guesses"] == 500
    share, low, high = value["search"]["share_on_listed"]
    assert low < share == value["search"]["on_listed"] / value["search"]["fresh"] < high
    assert {entry["impacts"] for entry in value["orbits"]} == {1, 2}
    assert any(entry["stable"] and abs(entry["period"] - 5.9738) < 1e-4 for entry in value["orbits"])
    for entry in value["orbits"]:
        assert set(entry) >= ORBIT_KEYS | {"word", "contacts"}
        assert entry["word"] == " ".join(["impact+"] * entry["impacts"])
        first, *later = entry["contacts"]
        assert first == {"kind": "impact", "touchdown_bearing": 1, "time": 0.0} | {
            key: entry[key] for key in ("angle", "radial_speed", "angular_speed")
        }
        assert len(later) == entry["impacts"] - 1
        assert all(0.0 < contact["time"] < entry["period"] for contact in later)
    code, out, err = carom(*asked[:-1], "40")
    assert (code, err) == (0, "")
    for words in ("P2,1", "impact+ impact+", "80 initial guesses", "stable"):
        assert words in " ".join(out.split())


# ------------------------------------------------------------------------------------------------ simulate


def test_simulate_as_json(carom, dimensionless):
    value = document(carom("simulate", dimensionless, "--start", "0.2,0.1,0.3,-0.2", "--until", "100", "--json"))

    assert set(value) >= {"outcome", "time", "impacts", "contacts", "final"}
    assert (value["outcome"], value["time"]) == ("time-reached", 100.0)
    assert value["start"] == {"U": [0.2, 0.1], "V": [0.3, -0.2]}
    assert value["impacts"]
    for impact in value["impacts"]:
        assert set(impact) >= {"time", "angle", "radial_speed", "angular_speed"}
        assert impact["radial_speed"] > 0.0
    assert set(value["final"]) == {"U", "V"}


def test_simulate_for_people(carom, machine):
    code, out, err = carom("simulate", machine, "--kick", "12.894 mm/s,2 rad")

    assert (code, err) == (0, "")
    assert "The rotor ends in synchronous rub" in out
    row = next(line for line in out.splitlines() if line.startswith("impact "))
    assert row.split() == ["impact", "37.00448", "-144.9", "4.31", "0.421", "-0.0631", "7,490", "forward"]


# ------------------------------------------------------------------------------------------------ study


def test_study_for_people(carom, machine):
    code, out, err = carom("study", machine, "--long")

    assert (code, err) == (0, "")
    for words in ("Does not come back from everything it must survive", "3,408 N s/m", "zone D", "B1,d", "901 N"):
        assert words in out
    assert "\x1b" not in out
    _, short, _ = carom("study", machine)
    assert out.startswith(short.partition("All results")[0].rstrip())
    assert "B1,d" not in short


def test_json_with_a_report_stays_alone_on_standard_output(carom, dimensionless, tmp_path):
    code, out, err = carom("study", dimensionless, "--set", "gamma=0.5", "--set", "mu=0", "--json", "--out", tmp_path)

    assert code == 0
    assert "report.html" in err
    written = json.loads((tmp_path / "study.json").read_text(encoding="utf-8"))
    assert written == json.loads(out) | {"figures": written["figures"]}
    assert all((tmp_path / name).is_file() for name in written["figures"])


# ------------------------------------------------------------------------------------------------ help


def test_version(carom):
    assert carom("--version") == (0, f"carom {__version__}\n", "")
