"""``carom basins`` as a user calls it."""

import json

import numpy as np
import pytest

from carom.basins import Basin, GainMap

pytestmark = pytest.mark.jit_only


def test_json_has_the_promised_keys(carom, machine):
    code, out, err = carom("basins", machine, "--grid", "10x12", "--kick", "40 mm/s", "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    assert document["starts"] == 120
    assert document["unresolved"] == 0
    assert sum(document["fractions"].values()) == pytest.approx(1.0)
    assert set(document["fractions"]) == {"levitation", "synchronous rub", "B1,d"}
    scale = 0.7e-3 * 184.2
    assert document["smallest_unrecovered_kick_si"] == pytest.approx(document["smallest_unrecovered_kick"] * scale)
    assert 0.0 < document["harmless_kick"] < document["smallest_unrecovered_kick"] < 0.04 / scale
    assert document["recovered"]["fraction"] == document["fractions"]["levitation"]
    assert document["disturbances"]["model"]["fastest"] == pytest.approx(0.04 / scale)


def test_the_kick_found_is_lost_and_the_json_says_how_to_see_it(carom, machine):
    _, out, _ = carom("basins", machine, "--grid", "6x6", "--kick", "20 mm/s", "--json")
    document = json.loads(out)
    kick = f"{document['smallest_unrecovered_kick_si']!r} m/s,{document['smallest_unrecovered_kick_angle']!r} rad"
    _, shown, _ = carom("simulate", machine, "--kick", kick, "--json")
    assert json.loads(shown)["outcome"] == document["smallest_unrecovered_kick_outcome"] != "levitated"


def test_sample_is_seeded(carom, dimensionless):
    words = ("basins", dimensionless, "--disturbance", "state", "--starts", "80", "--json")
    first, again, other = (carom(*words, "--seed", seed)[1] for seed in ("1", "1", "2"))
    assert first == again != other
    document = json.loads(first)
    assert document["starts"] == 80
    assert document["recovered"]["method"].startswith("Clopper-Pearson")
    assert "smallest_unrecovered_kick_si" not in document


def test_table_and_files(carom, machine, tmp_path):
    out = tmp_path / "out"
    code, shown, _ = carom(
        "basins", machine, "--grid", "8x8", "--kick", "20 mm/s", "--gains", "3x3", "--out", out, "--set", "mu=0.1"
    )
    assert code == 0
    assert f"Written to {out}" in shown
    for text in ("Back to levitation", "Present machine: stiffness of the levitation 980,000 N/m"):
        assert text in shown
    assert "forward-rub" not in shown
    files = sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file())
    figures = [f"figures/{stem}.{ending}" for stem in ("basins", "gain-map") for ending in ("png", "svg")]
    assert files == ["basins.json", "basins.nc", *figures, "gains.nc"]
    basin, gains = Basin.load(out / "basins.nc"), GainMap.load(out / "gains.nc")
    document = json.loads((out / "basins.json").read_text())
    assert document["fractions"] == basin.fractions
    assert basin.parameters.mu == 0.1
    assert basin.dataset.attrs["machine_file"] == "keogh-cole.toml"
    assert "touchdown bearing" in basin.dataset.attrs["machine_text"]
    assert basin.dataset.attrs["settings"] == "mu=0.1"
    np.testing.assert_allclose(document["gains"]["recovered"], gains.dataset["recovered"].values)
    assert document["gains"]["parameters"] == ["stiffness", "damping"]


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--grid", "10"), "--grid = 10: must be 2 whole numbers of at least 1, such as 60x60"),
        (("--grid", "99999x99999"), "at most"),
        (("--grid", "5x5", "--starts", "10"), "--starts = 10: not allowed"),
        (("--starts", "10", "--seed", "-1"), "'--seed'"),
        (("--disturbance", "hammer"), "--disturbance = hammer: must be one of: kick-plane[,SPEED]"),
        (("--shock", "5 g, 1 ms, 30 deg"), "--shock = 5 g, 1 ms, 30 deg: must be without an angle"),
        (("--shock", "5 g", "--kick", "5 mm/s"), "--shock = 5 g: not allowed with --kick"),
        (("--disturbance", "release, up"), "--disturbance = release, up: must be release,fixed|rotating|rolling"),
        (("--disturbance", "state, 5 mm"), "--disturbance = 5 mm"),
        (("--disturbance", "state", "--grid", "5x5"), "--grid = 5x5"),
        (("--kick", "0 mm/s"), "--kick = 0 mm/s: must be a velocity above 0"),
        (("--gains", "1x5"), "--gains = 1x5"),
        (("--gains", "5x5", "--plane", "dampin,stiffness"), "did you mean damping"),
        (("--gains", "5x5", "--x", "1e6 N/m,1e6 N/m"), "--x = 1e6 N/m,1e6 N/m"),
        (("--set", "gamma=0.05"), "disturbance = |U*|"),
    ],
)
def test_inputs_that_cannot_be_used(refused, machine, words, complaint):
    refused(complaint, "basins", machine, *words)


RIG = "examples/tum-test-rig.toml"
GAINS = ("basins", RIG, "--starts", "4", "--gains", "3x2", "--plane", "proportional_gain,derivative_gain")


def test_a_map_takes_and_tells_gains_in_the_terms_of_the_machine(carom):
    options = (*GAINS, "--x", "4500 A/m,9000 A/m", "--y", "12 A s/m,3 A s/m")
    code, out, err = carom(*options)
    found = json.loads(carom(*options, "--json")[1])["gains"]

    assert (code, err) == (0, "")
    text = " ".join(out.split())
    assert "4,500 A/m to 9,000 A/m" in text
    assert "3 A s/m to 12 A s/m" in text
    # Two bearings of 50 N/A and -100 N/mm: k = 2 (50 P - 1e5), c = 2 * 50 D.
    assert found["parameters"] == ["stiffness", "damping"]
    np.testing.assert_allclose(found["values"][0], [2 * (50 * gain - 1e5) for gain in (4500, 6750, 9000)], rtol=1e-12)
    np.testing.assert_allclose(found["values"][1], [300.0, 1200.0], rtol=1e-12)
    assert found["terms"] == [
        {"entry": "proportional_gain", "unit": "A/m", "values": [4500.0, 6750.0, 9000.0]},
        {"entry": "derivative_gain", "unit": "A s/m", "values": [3.0, 12.0]},
    ]
