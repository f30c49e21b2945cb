"""``carom attractors`` as a user calls it."""

import json

import pytest

pytestmark = pytest.mark.jit_only


def test_json(carom, dimensionless):
    code, out, err = carom("attractors", dimensionless, "--starts", "24", "--seed", "3", "--exponents", "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    assert (document["starts"], document["seed"]) == (24, 3)
    assert document["parameters"]["gamma"] == 0.1
    found = {entry["name"]: entry for entry in document["attractors"]}
    bounce = found["B1,d"]
    assert {"outcome", "word", "impacts", "period", "share", "transient", "half_life_impacts"} <= bounce.keys()
    assert (bounce["word"], bounce["impacts"]) == ("impact+", 1)
    assert bounce["period"] == pytest.approx(2.8635671446)
    low, high = bounce["share"][1:]
    assert low < bounce["share"][0] < high
    # The logarithms of the moduli of its multipliers over its period.
    assert bounce["exponents"]["per_time"] == pytest.approx([0.0, -0.0608718, -0.0874765, -0.0874765], abs=1e-6)
    for unit in ("time", "impact"):
        assert len(bounce["exponents"][f"error_per_{unit}"]) == len(bounce["exponents"][f"per_{unit}"]) == 4
    assert bounce["exponents"]["per_impact"][1] == pytest.approx(-0.1743106, abs=1e-5)
    assert found["synchronous rub"]["exponents"]["per_time"][2:] == [None, None]
    assert sum(entry["count"] for entry in found.values()) == 24


def test_text_and_files(carom, dimensionless, tmp_path):
    arguments = ("--set", "gamma=0.0815", "--starts", "24", "--out", tmp_path / "out")
    code, out, _ = carom("attractors", dimensionless, *arguments)
    assert code == 0
    assert "6-impact bouncing" in out
    assert "Lyapunov exponents" not in out
    assert str(tmp_path / "out") in out
    files = {str(path.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("*.*")}
    assert files == {"figures/attractors.png", "figures/attractors.svg", "attractors.json"}
    written = json.loads((tmp_path / "out" / "attractors.json").read_text())
    assert "exponents" not in written["attractors"][0]
    code, out, _ = carom("attractors", dimensionless, "--starts", "24", "--exponents")
    assert "-inf: contact removes this direction" in out
    assert "exact" in out
    assert f"of {written['share']['of']} up to 1 c_r Ω come back (" in " ".join(out.split())
    kicks = int(0.6 * 24)
    assert written["share"]["estimate"] * kicks == pytest.approx(round(written["share"]["estimate"] * kicks))
    assert written["share"]["low"] <= written["share"]["estimate"] <= written["share"]["high"]
