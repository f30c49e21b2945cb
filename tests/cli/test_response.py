"""``carom response`` as a user calls it."""

import json
import math

import pytest


def test_json(carom, machine):
    code, out, err = carom("response", machine, "--from", "500 rpm", "--to", "4000 rpm", "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    assert document["critical"]["rpm"] == pytest.approx(1350.474, abs=1e-3)
    assert document["amplification_factor"] == pytest.approx(4.796906, abs=1e-6)
    (critical,) = document["criticals"]
    assert (critical["side"], critical["met"]) == ("below", True)
    assert critical["separation"] == pytest.approx(0.232240, abs=1e-6)
    assert critical["required"] == pytest.approx(0.118437, abs=1e-6)
    assert document["present"]["zone"] == "D"
    assert document["present"]["steady"] == {"contact_free": True, "stable_rubs": 1, "unstable_rubs": 1, "rolls": True}
    assert document["present"]["peak_to_peak_si"] == pytest.approx(1.3368e-3, abs=1e-7)
    assert not document["critical"]["admissible"]
    assert document["critical"]["zone"] is None
    curve = document["curve"]
    assert len({len(values) for values in curve.values()}) == 1
    assert document["speeds_si"] == pytest.approx([500.0 * math.pi / 30.0, 4000.0 * math.pi / 30.0])
    assert [curve["speed_si"][0], curve["speed_si"][-1]] == document["speeds_si"]
    steady = document["steady"]
    assert [entry["to_si"] for entry in steady[:-1]] == [entry["from_si"] for entry in steady[1:]]
    (over,) = document["exceeds_api_617"]
    assert [over["from_si"], over["to_si"]] == document["speeds_si"]


def test_the_unbalance_and_the_speeds_taken_are_echoed(carom, machine):
    _, out, _ = carom("response", machine, "--from", "500 rpm", "--to", "12345 rpm")
    taken = json.loads(carom("response", machine, "--from", "500 rpm", "--to", "12345 rpm", "--json")[1])["disturbance"]

    words = "Unbalance: 15,000 g mm, eccentricity 0.3 mm, at speeds from 500 rpm to 12,345 rpm"
    assert f"\n{words}.\n" in out
    assert taken["words"] == words
    assert taken["unbalance_si"] == pytest.approx(50.0 * 0.3e-3)
    assert taken["highest_speed_si"] == pytest.approx(12345.0 * math.pi / 30.0)


def test_text_and_files(carom, machine, tmp_path):
    code, out, _ = carom("response", machine, "--operating", "1700 rpm,1800 rpm", "--out", tmp_path / "out")
    assert code == 0
    assert "1,337 µm peak to peak" in out
    assert "Levitation is impossible from 1,147 rpm to 1,725 rpm" in out
    assert "it touches" in out
    assert "add --out" not in out
    assert str(tmp_path / "out") in out
    files = {str(path.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("*.*")}
    assert files == {"figures/response.png", "figures/response.svg", "response.json"}
    assert json.loads((tmp_path / "out" / "response.json").read_text())["operating_si"] == pytest.approx(
        [1700.0 * math.pi / 30.0, 1800.0 * math.pi / 30.0]
    )


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--from", "500 rpm"), "--to = nothing given: give both --from and --to"),
        (("--to", "500 rpm"), "--from = nothing given: give both --from and --to"),
        (("--from", "500 rpm", "--to", "500 rpm"), "must be another value than --from"),
        (("--from", "5 kg", "--to", "500 rpm"), "--from = 5 kg: speed must be an angular speed"),
        (("--operating", "5"), "--operating = 5: must be"),
    ],
)
def test_bad_input(refused, machine, options, words):
    refused(words, "response", machine, *options)


def test_a_dimensionless_file_has_no_speed(refused, dimensionless):
    refused("must hold a [machine] or a [rotor] table", "response", dimensionless)
