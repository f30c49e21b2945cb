"""A flexible machine on the command line: what works does, and what does not says so in one line."""

import csv
import json
from pathlib import Path

import pytest
import xarray

import carom as cm

pytestmark = pytest.mark.jit_only

MACHINE = "examples/tum-flexible-rotor.toml"


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
    assert "gravity of 9.81 m/s² downward is assumed, as the file states none" in " ".join(out.split())
    document = json.loads((tmp_path / "study.json").read_text())
    assert {"figures/campbell.svg", "figures/sensitivity.svg", "figures/kick-1.svg"} <= set(document["figures"])
    page = (tmp_path / "report.html").read_text()
    assert document["verdict"]["outcome"] in page
    assert page.count("<svg") == len(document["figures"]) // 2


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
    assert "Nothing left to compute." in out


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
