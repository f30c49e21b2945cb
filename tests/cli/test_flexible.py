"""A flexible machine on the command line: what works does, and what does not says so in one line."""

import csv
import json
from pathlib import Path

import pytest
import xarray

import carom as cm

pytestmark = pytest.mark.jit_only

MACHINE = "examples/tum-flexible-rotor.toml"


def test_a_drop_tells_both_bearings(carom):
    code, out, err = carom("drop", MACHINE, "--until", "20 ms")
    words = " ".join(out.split())
    assert (code, err) == (0, "")
    assert "Touchdown bearing 1 peak force" in words
    assert "Touchdown bearing 2 peak force" in words
    _, out, _ = carom("drop", MACHINE, "--until", "20 ms", "--json")
    found = json.loads(out)
    loads = cm.motions.drop_loads(cm.simulate(cm.load(MACHINE), cm.drop(), "20 ms"))
    for entry, plane in zip(found["touchdown_bearings"], loads.planes, strict=True):
        assert entry["loads"]["force_si"] == plane.si()["force"]
    assert cm.models.rotor_from(found["rotor"]).scales == loads.scales


def test_a_motion_with_all_its_stages(carom):
    code, out, _ = carom("simulate", MACHINE, "--drop", "--regained-after", "8 ms", "--until", "30 ms")
    assert code == 0
    assert "The fall:" in out
    code, out, _ = carom("simulate", MACHINE, "--drop", "--until", "10 ms", "--json")
    assert code == 0
    assert {entry["touchdown_bearing"] for entry in json.loads(out)["contacts"]} <= {1, 2}


def test_a_motion_is_logged_at_all_touchdown_bearings(carom, tmp_path):
    """In words, as CSV, as netCDF and as JSON, counted from 1 everywhere."""
    table, log, until = tmp_path / "log.csv", tmp_path / "log.nc", "15 ms"
    command = ("simulate", MACHINE, "--kick", "495 mm/s,30 deg", "--until", until)
    case = cm.load(MACHINE)
    motion = cm.simulate(case, cm.kick("495 mm/s", "30 deg"), until)
    each = [motion.seen_at(plane) for plane in (0, 1)]
    first, second = (len(seen.contacts) for seen in each)
    assert min(first, second) > 1

    _, out, _ = carom(*command, "--csv", str(table), "--netcdf", str(log))
    words = " ".join(out.split())
    assert f"{first + second} contacts ({first} at touchdown bearing 1 and {second} at touchdown bearing 2)" in words
    assert all(f"At the end at touchdown bearing {number}, in the fixed frame" in words for number in (1, 2))
    with table.open(encoding="utf-8") as stream:
        rows = [(int(row["touchdown_bearing [1]"]), float(row["time [s]"])) for row in csv.DictReader(stream)]
    starts = [(seen.plane + 1, start) for seen in each for start in seen.contacts.to_dataset()["time"].values.tolist()]
    assert rows == sorted(starts, key=lambda entry: entry[1])
    with xarray.open_dataset(log, engine="h5netcdf", decode_times=False) as read:
        assert list(zip(read["touchdown_bearing"].values, read["time"].values, strict=True)) == rows
        assert sorted(read["lasting_touchdown_bearing"].values) == sorted(number for number, _ in rows)

    found = json.loads(carom(*command, "--json")[1])
    assert [entry["touchdown_bearing"] for entry in found["contacts"]] == [number for number, _ in rows]
    for number, (entry, seen) in enumerate(zip(found["touchdown_bearings"], each, strict=True), start=1):
        assert (entry["touchdown_bearing"], entry["contacts"]) == (number, len(seen.contacts))
        place = seen.position([motion.time], "fixed")[0] * seen.scales.length
        assert complex(*entry["final"]["place_si"]) == pytest.approx(place, abs=1e-12)
        assert entry["loads"]["force_si"] == seen.contacts.to_dataset()["peak_force"].max()


def test_a_study_writes_its_report(carom, tmp_path, monkeypatch):
    monkeypatch.setattr("carom.studies.questions.FEW_MODES", 0.2)
    code, out, _ = carom("study", MACHINE, "--set", "gravity=0", "--out", str(tmp_path))
    assert code == 0
    assert "What it survives" in out
    assert "no weight is stated, so that of 9.81 m/s² downward is taken" in " ".join(out.split())
    document = json.loads((tmp_path / "study.json").read_text())
    assert {"figures/campbell.svg", "figures/sensitivity.svg", "figures/kick-1.svg"} <= set(document["figures"])
    page = (tmp_path / "report.html").read_text()
    assert document["verdict"]["outcome"] in page
    assert page.count("<svg") == len(document["figures"]) // 2


def test_a_sweep_of_studies_over_gains(carom, tmp_path):
    """Where a whirl grows nothing comes back, without a simulation; elsewhere the share is that of the study of that point."""
    path, store = tmp_path / "sweep.toml", str(tmp_path / "sweep.zarr")
    path.write_text(
        f'machine = "{Path(MACHINE).absolute()}"\nset = ["gravity=0"]\n[axes.proportional]\nvalues = ["1000 A/m", "5500 A/m"]\n'
        "[study]\ndisturbances = 4\n"
    )
    code, _, err = carom("sweep", str(path), "--out", store, "--threads", "--workers", "1")
    assert (code, err) == (0, "")
    found = cm.open_sweep(store)
    assert found.levitates.values.tolist() == [0, 1]
    assert found.recovered.values.tolist() == [0.0, 1.0]
    alone = cm.closed_forms.levitation(cm.load(MACHINE, ["gravity=0", "proportional=5500 A/m"]))
    assert found.levitation_radius.values[1] == pytest.approx(alone.radius)


SWEEP = f"""machine = "{Path(MACHINE).absolute()}"
set = ["gravity=0"]
[axes.proportional]
values = ["1000 A/m", "5500 A/m"]
[axes.touchdown_stiffness_2]
from = "1e7 N/m"
to = "2e7 N/m"
count = 2
[basins]
starts = 2
disturbance = {{kind = "kick", fastest = "20 mm/s"}}
"""


def test_a_sweep_of_basins_over_gains_is_resumed(carom, tmp_path):
    path, store = tmp_path / "sweep.toml", str(tmp_path / "sweep.zarr")
    path.write_text(SWEEP)
    code, _, err = carom("sweep", str(path), "--out", store, "--threads", "--workers", "2")
    assert (code, err) == (0, "")
    found = cm.open_sweep(store)
    assert found.levitates.values.tolist() == [[0, 0], [1, 1]]
    assert found.possible.values.tolist() == [[0, 0], [2, 2]]
    assert (found.recovered.values[1] == 1.0).all()
    _, out, _ = carom("sweep", str(path), "--out", store)
    assert "Nothing was left to compute." in out


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        (("axes.proportional", "axes.propotional"), "axes.propotional = propotional: unknown name"),
        (("1000 A/m", "1000 N/m"), "axes.proportional.values = 1000 N/m: must be a gain in A/m"),
        (('"gravity=0"', '"proportional=5000 A/m"'), "axes.proportional = varied: is set too"),
    ],
)
def test_a_sweep_over_what_is_no_parameter_gets_one_line(carom, tmp_path, changes, says):
    path = tmp_path / "sweep.toml"
    path.write_text(SWEEP.replace(*changes))
    code, out, err = carom("sweep", str(path), "--out", str(tmp_path / "store"))
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert says in err


def test_gains_are_mapped_by_their_names(carom, tmp_path):
    small = ("--grid", "1x2", "--kick", "10 mm/s", "--set", "gravity=0", "--gains", "2x2")
    code, out, err = carom("basins", MACHINE, *small, "--x", "1000 A/m,5500 A/m", "--out", str(tmp_path / "out"))
    words = " ".join(out.split())
    assert code == 0
    assert err.startswith("Written to ")
    assert "Map: proportional gain 1,000 A/m to 5,500 A/m; derivative gain 2.5 A s/m to 10 A s/m." in words
    assert "50 % cannot levitate" in words
    found = cm.basins.GainMap.load(tmp_path / "out" / "gains.nc")
    assert found.dataset.levitates.values.tolist() == [[0.0, 0.0], [1.0, 1.0]]
    assert found.present == (5000.0, 5.0)
    assert [each.name for each in found.axes] == ["proportional", "derivative"]


def test_orbits_tell_steady_motions(carom):
    code, out, err = carom("orbits", MACHINE, "--set", "gravity=0", "--json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    model = cm.load(MACHINE, ["gravity=0"]).parameters
    (held,), whirls = found["equilibria"], found["whirls"]
    assert (held["kind"], held["stable"], held["touchdown_bearings"]) == ("contact-free", True, [])
    assert ([each["touchdown_bearing"] for each in whirls], found["orbits"]) == ([1, 1, 2], [])
    whirl = whirls[0]
    assert held["radius_si"] == pytest.approx(model.system.rest_radius * model.scales.length)
    # Kept by a force that is that of the wall at this depth: 1e7 N/m.
    assert whirl["normal_force_si"] == pytest.approx(1e7 * (whirl["radius_si"] - 0.2e-3), rel=1e-6)
    code, out, _ = carom("orbits", MACHINE)
    assert code == 0
    assert "Under gravity, rubs and whirls are not steady motions" in " ".join(out.split())
    code, out, err = carom("orbits", MACHINE, "--longest-period", "3")
    assert (code, out, err.count("\n")) == (2, "", 1)


def test_an_unstable_levitation_is_one_line(carom):
    code, out, err = carom(
        "simulate", MACHINE, "--kick", "5 mm/s", "--until", "20 ms", "--set", "proportional=1000 A/m"
    )
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("carom: levitation = unstable: a displacement to one side grows")
