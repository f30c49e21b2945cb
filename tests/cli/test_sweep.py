"""``carom sweep``: table, JSON, one-line errors, and going on."""

import json

import pytest

from carom.sweeps import open_sweep

SWEEP = """
machine = "{machine}"
chunk = 3

[axes.damping]
from = "1000 N s/m"
to = "4000 N s/m"
count = 4

[axes.friction]
values = [0.1, 0.2]

[study]
"""


@pytest.fixture
def sweep_file(tmp_path, machine):
    path = tmp_path / "sweep.toml"
    path.write_text(SWEEP.format(machine=machine), encoding="utf-8")
    return path


@pytest.fixture
def store(tmp_path):
    return tmp_path / "results.zarr"


def test_table_tells_what_was_done(carom, sweep_file, store):
    code, out, err = carom("sweep", sweep_file, "--out", store, "--threads", "--workers", 1)

    assert (code, err) == (0, "")
    assert out.startswith("Sweep of keogh-cole (study): 4 damping x 2 friction\n")
    assert "Disturbances: none, closed forms only." in out
    assert "8 of 8 points are done, 0 failed." in out
    assert "This run: 8 points in" in out
    assert "points/s" in out
    data = open_sweep(store)
    assert data.damping.attrs["units"] == "N s/m"
    assert data.levitates.values.tolist() == [[1.0, 1.0]] * 4


def test_json_is_one_object(carom, sweep_file, store):
    code, out, err = carom("sweep", sweep_file, "--out", store, "--threads", "--json")
    document = json.loads(out)

    assert (code, err) == (0, "")
    assert document | {"seconds": 0, "rate": 0} == {
        "store": str(store),
        "kind": "study",
        "disturbances": "none, closed forms only",
        "axes": {"damping": 4, "friction": 2},
        "points": 8,
        "done": 8,
        "failed": 0,
        "waiting": 0,
        "chunks": 4,
        "starts": 0,
        "computed": 8,
        "seconds": 0,
        "rate": 0,
        "damaged": 0,
        "failures": [],
    }


def test_failed_points_are_told_with_parameters_and_error(carom, tmp_path, store, dimensionless):
    # Undamped and in resonance: there is no such machine.
    path = tmp_path / "sweep.toml"
    axes = "[axes.gamma]\nvalues = [0.0, 0.1]\n[axes.omega]\nvalues = [1.0, 0.8]\n[study]"
    path.write_text(f'machine = "{dimensionless}"\nchunk = 1\n{axes}', encoding="utf-8")
    code, out, _ = carom("sweep", path, "--out", store, "--threads")

    assert code == 0
    assert "points are done, 1 failed." in out
    assert "Failed at gamma = 0, omega = 1: gamma = 0.0: must differ from 0" in out
    assert "try them again with --retry-failed" in out
    _, out, _ = carom("sweep", path, "--out", store, "--threads", "--retry-failed", "--json")
    document = json.loads(out)
    assert (document["computed"], document["failed"]) == (1, 1)
    assert document["failures"][0]["point"] == [0, 0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["none.toml", "--out", "x.zarr"], "sweep file = none.toml: there is no such file"),
        (["FILE"], "--out"),
        (["FILE", "--out", "FILE"], "this is a file"),
        (["FILE", "--out", "x.zarr", "--workers", "0"], "--workers"),
        (["FILE", "--out", "x.zarr", "--set", "damping=1"], "axes.damping = varied: is set too"),
        (
            ["FILE", "--out", "x.zarr", "--workers", "2", "--scheduler", "tcp://127.0.0.1:1"],
            "--workers = 2: not allowed",
        ),
        (["FILE", "--out", "x.zarr", "--threads", "--scheduler", "tcp://127.0.0.1:1"], "--threads = given"),
    ],
)
def test_bad_input_is_one_line(refused, sweep_file, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    refused(words, "sweep", *(sweep_file if word == "FILE" else word for word in arguments))
