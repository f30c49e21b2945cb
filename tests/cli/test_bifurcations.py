"""``carom bifurcations`` and ``carom regions`` as a user calls them."""

import json

import pytest

import carom
from carom.base.outcome import InputError
from carom.cli import main
from carom.closed_forms.sag import levitation

PAPER = "examples/source-paper.toml"
MACHINE = "examples/keogh-cole.toml"


def test_points_as_json(capsys):
    assert main(["bifurcations", PAPER, "--along", "gamma", "--from", "0.05", "--to", "0.4", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    points = {(point["kind"], point["branch"]): point for point in document["points"]}
    assert points["grazing", "B1,d"]["value"] == pytest.approx(0.0636105609, abs=5e-11)
    assert points["period-doubling", "B1,d"]["value"] == pytest.approx(0.0833814175, abs=5e-11)
    assert points["fold", "B1,d"]["period"] == pytest.approx(1.64082198, abs=5e-9)
    assert points["rub-fold", "rub"]["value"] == pytest.approx(0.370006037, abs=5e-10)
    assert {point["parameter"] for point in document["points"]} == {"gamma"}
    for branch in document["branches"]:
        assert len(branch["values"]) == len(branch["admissible"]) == len(branch["names"])


def test_where_levitation_of_a_machine_without_closed_forms_is_lost(capsys, tmp_path):
    assert main(["template", "rigid", "--out", str(tmp_path / "rigid.toml")]) == 0
    text = (tmp_path / "rigid.toml").read_text()
    (tmp_path / "late.toml").write_text(text.replace("filter_time =", 'delay = "50 us"\nfilter_time ='))
    words = ["bifurcations", str(tmp_path / "late.toml"), "--along", "delay", "--to", "1.5 ms"]
    assert main([*words, "--from", "10 us", "--out", str(tmp_path)]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "levitation lost levitation above: a vibration grows Levitation is possible at some of the " in shown
    (point,) = json.loads((tmp_path / "bifurcations-delay.json").read_text())["points"]
    assert (point["kind"], point["branch"], point["period"]) == ("levitation-lost", "contact-free", None)
    below, above = (f"delay={point['value'] * factor!r} s" for factor in (1.0 - 1e-9, 1.0 + 1e-9))
    assert levitation(carom.load(tmp_path / "late.toml", [below])).stable
    with pytest.raises(InputError, match="levitation = unstable: a forward whirl"):
        carom.load(tmp_path / "late.toml", [above])
    assert main([*words, "--from", "1.2 ms"]) == 0
    assert "Levitation is possible at none of the 101 values" in " ".join(capsys.readouterr().out.split())


def test_table_and_files(capsys, tmp_path):
    words = ["bifurcations", MACHINE, "--along", "speed", "--from", "1000 rpm", "--to", "3000 rpm"]
    assert main([*words, "--out", str(tmp_path / "out")]) == 0
    shown = capsys.readouterr().out
    assert "non-smooth Hopf" in shown
    assert "rpm" in shown
    (row,) = [
        line for line in shown.splitlines() if "non-smooth fold" not in line and " fold " in line and "B1,d" in line
    ]
    # B1,d at the fold, in mm/s of the machine that runs at that speed, not of the present one
    fold = next(
        point
        for point in carom.find_bifurcations(carom.load(MACHINE), "speed", ("1000 rpm", "3000 rpm")).points
        if (point.kind, point.name) == ("fold", "B1,d")
    )
    assert f"{0.7 * fold.radial_speed * fold.value:.4f}" in row
    assert "radial speed (mm/s)" in shown
    names = {str(path.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("*.*")}
    assert names == {"bifurcations-speed.json", *(f"figures/bifurcations-speed.{ending}" for ending in ("svg", "png"))}
    document = json.loads((tmp_path / "out" / "bifurcations-speed.json").read_text())
    assert (document["parameter"], document["unit"]) == ("speed", "rad/s")
    assert document["interval"] == pytest.approx([104.71975512, 314.15926536])


def test_plane_as_json(capsys):
    words = ["regions", PAPER, "--plane", "gamma,omega", "--x", "0.02,0.4", "--y", "0.6,1.0", "--grid", "6", "--json"]
    assert main(words) == 0
    document = json.loads(capsys.readouterr().out)
    assert {curve["kind"] for curve in document["curves"]} >= {"fold", "grazing", "period-doubling", "rub-fold"}
    (point,) = [entry for entry in document["codim2"] if entry["kind"] == "fold + boundary-equilibrium"]
    assert point["value"] == pytest.approx([0.1779723, 0.7811076], abs=5e-8)
    assert sum(region["share"] for region in document["regions"]) == pytest.approx(1.0)
    for region in document["regions"]:
        assert len(region["stable_orbit_names"]) == region["stable_orbits"]
        assert region["name"].startswith(region["source_region"])
        assert ("stable synchronous rub" in region["words"]) is region["rub"]
    for curve in document["curves"]:
        assert set(curve["ends"]) <= {"edge of the plane", "closed loop"}


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (["--along", "gama", "--from", "0.1", "--to", "0.2"], "did you mean gamma"),
        (["--along", "gamma", "--from", "0.2", "--to", "0.2"], "must be another value than --from"),
        (["--along", "gamma", "--from", "x", "--to", "0.1"], "does not start with a number"),
        (["--along", "d", "--from", "0.5", "--to", "1.5"], "--to = 1.5: d must be a number, 0 to 1"),
        (["--along", "speed", "--from", "100", "--to", "200"], "mass, clearance and speed"),
        (["--along", "gamma", "--from", "0.1", "--to", "0.2", "--out", "\0"], "directory"),
    ],
)
def test_inputs_that_cannot_be_used(refused, words, complaint):
    refused(complaint, "bifurcations", PAPER, *words)


@pytest.mark.parametrize(
    "words", [["--plane", "gamma"], ["--plane", "gamma,gamma"], ["--x", "0.1"], ["--x", "0.1,0.1"], ["--plane", "a,b"]]
)
def test_planes_that_cannot_be_used(refused, words):
    refused("", "regions", PAPER, *words)
