"""The store: whole chunks or none, opened by xarray, and clear about what it refuses."""

import dataclasses
import errno
import json
import os
from importlib.metadata import version

import numpy as np
import pytest
from sweep_tasks import Drawn, Failing, basins_plan, plan_of, stored_bytes

import carom.base.files
from carom.base.outcome import InputError
from carom.sweeps import open_sweep, run_sweep
from carom.sweeps.chunk import compute_chunk
from carom.sweeps.store import SweepStore

PLAN = plan_of(Drawn(), count=9, chunk=2)


def fill(path, numbers, plan=PLAN):
    with SweepStore(path, plan) as store:
        for number in numbers:
            store.write(compute_chunk(plan, number))
    return SweepStore(path, plan)


def test_xarray_opens_what_is_there(tmp_path):
    fill(tmp_path / "s.zarr", [0, 4])
    data = open_sweep(tmp_path / "s.zarr")

    np.testing.assert_array_equal(data.gamma, PLAN.axes[0].values)
    np.testing.assert_array_equal(data.status, [1, 1, 0, 0, 0, 0, 0, 0, 1])
    np.testing.assert_array_equal(np.isfinite(data.value), data.status == 1)
    np.testing.assert_array_equal(np.isfinite(data.draw), data.status == 1)
    np.testing.assert_array_equal(data.value[[0, 1, 8]], PLAN.axes[0].values[[0, 1, 8]])
    assert data.status.attrs["flag_meanings"] == "waiting done failed"
    assert data.gamma.attrs == {"long_name": "scaled damping", "units": "1"}
    assert data.attrs["seed"] == 5
    assert data.attrs["plan_digest"] == PLAN.digest
    assert data.attrs["source"] == f"carom {carom.__version__}"
    assert data.attrs["versions"].keys() == {"carom", "numpy", "numba", "llvmlite", "python"}
    assert json.loads(data.attrs["plan"]) == PLAN.describe()


@pytest.mark.jit_only
def test_every_value_lands_in_its_place(tmp_path):
    plan = basins_plan(starts=3)
    run_sweep(plan, tmp_path / "s.zarr", workers=2, threads=True)
    data = open_sweep(tmp_path / "s.zarr").load()

    assert data.counts.dims == ("gamma", "mu", "outcome")
    assert data.outcome.attrs["flag_meanings"].split()[0] == "levitated"
    for point in np.ndindex(*plan.shape):
        found = plan.task.evaluate(plan.case_at(point), plan.seed_of(point))
        np.testing.assert_array_equal(data.counts[point], found["counts"])
        assert data.recovered[point] == found["recovered"]


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (dataclasses.replace(PLAN, seed=6), "another seed"),
        (dataclasses.replace(PLAN, chunk_shape=(3,)), "another chunk"),
        (plan_of(Drawn(), count=8, chunk=2), "another axes"),
        (dataclasses.replace(PLAN, fixed={"mu": 0.1}), "another fixed"),
    ],
)
def test_store_of_another_plan_is_refused(tmp_path, other, words):
    fill(tmp_path / "s.zarr", [0])
    before = stored_bytes(tmp_path / "s.zarr")

    with pytest.raises(InputError, match=r"^--out = .*belongs to another plan") as caught:
        run_sweep(other, tmp_path / "s.zarr", threads=True)
    assert words in str(caught.value)
    assert stored_bytes(tmp_path / "s.zarr") == before


@pytest.mark.parametrize("changed", ["carom", "numpy", "numba", "llvmlite"])
def test_store_of_another_version_is_refused(changed, tmp_path, monkeypatch):
    fill(tmp_path / "s.zarr", [0])
    monkeypatch.setattr("carom.sweeps.versions.version", lambda name: "9.9" if name == changed else version(name))

    with pytest.raises(InputError, match=rf"was begun with {changed} .*, this is 9\.9"):
        SweepStore(tmp_path / "s.zarr", PLAN)


def test_place_with_something_else_is_left_alone(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "thesis.tex").write_text("words")
    (tmp_path / "file").write_text("words")

    with pytest.raises(InputError, match="holds something other than a sweep"):
        SweepStore(tmp_path / "there", PLAN)
    with pytest.raises(InputError, match="this is a file"):
        SweepStore(tmp_path / "file", PLAN)
    with pytest.raises(InputError, match="must be a directory that a sweep was written to"):
        open_sweep(tmp_path / "there")
    assert (tmp_path / "there" / "thesis.tex").read_text() == "words"


@pytest.mark.skipif(os.name != "posix", reason="locks of POSIX systems")
def test_only_one_writes(tmp_path):
    store = SweepStore(tmp_path / "s.zarr", PLAN)
    with (
        store,
        pytest.raises(InputError, match="another sweep is writing to it"),
        SweepStore(tmp_path / "s.zarr", PLAN),
    ):
        pass
    fill(tmp_path / "s.zarr", [0])


def test_leftovers_of_a_killed_writer_vanish_and_count_for_nothing(tmp_path):
    path = tmp_path / "s.zarr"
    fill(path, [0])
    (path / ".parts" / "half").write_bytes(b"12")
    chunk = path / "value" / "c" / "1"  # of a chunk whose status was not written
    chunk.write_bytes(b"\0" * 16)

    assert list(SweepStore(path, PLAN).waiting()) == [1, 2, 3, 4]
    fill(path, [1])
    assert not list((path / ".parts").iterdir())
    np.testing.assert_array_equal(open_sweep(path).value[2:4], PLAN.axes[0].values[2:4])


# ------------------------------------------------------------------------------------------------- disks that refuse


def assert_nothing_lost(path, plan, kept):
    assert kept
    for name, data in kept.items():
        assert (path / name).read_bytes() == data
    run_sweep(plan, path, workers=1, threads=True)
    fresh = path.with_name("fresh.zarr")
    run_sweep(plan, fresh, workers=1, threads=True)
    assert stored_bytes(path) == stored_bytes(fresh)


@pytest.mark.parametrize("call", ["replace", "fsync", "write"])
def test_full_disk_is_one_line_and_loses_nothing(tmp_path, monkeypatch, call):
    path, calls = tmp_path / "s.zarr", []
    kept = {}

    def fails_later(function):
        def wrapped(*arguments, **options):
            calls.append(call)
            if len(calls) > 12:  # each chunk is four files in four directories
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            return function(*arguments, **options)

        return wrapped

    SweepStore(path, PLAN)
    with monkeypatch.context() as patch:
        if call == "write":
            patch.setattr(carom.base.files, "memoryview", fails_later(memoryview), raising=False)
        else:
            patch.setattr(f"carom.base.files.os.{call}", fails_later(getattr(os, call)))
        with pytest.raises(InputError) as caught:
            run_sweep(PLAN, path, workers=1, threads=True, progress=lambda tally: kept.update(stored_bytes(path)))

    assert str(caught.value).startswith(f"--out = {path}: cannot be written (No space left on device); ")
    assert "of 5 chunks are stored; fix this, and the same command resumes the sweep" in str(caught.value)
    assert not list((path / ".parts").iterdir())
    assert_nothing_lost(path, PLAN, kept)


def test_finished_store_needs_no_writing(tmp_path, monkeypatch):
    fill(tmp_path / "s.zarr", range(5))

    def refuse(*arguments):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    monkeypatch.setattr("carom.sweeps.store.FileLock.acquire", refuse)
    monkeypatch.setattr("carom.sweeps.store.write_whole", refuse)
    tally = run_sweep(PLAN, tmp_path / "s.zarr")

    assert (tally.done, tally.waiting, tally.computed) == (9, 0, 0)


# ----------------------------------------------------------------------------------------------------------- failures


def test_failures_are_written_down_and_can_be_tried_again(tmp_path):
    path, mended = tmp_path / "s.zarr", tmp_path / "mended"
    plan = plan_of(Failing(above=0.75, mended=str(mended)), count=10, chunk=3)
    tally = run_sweep(plan, path, workers=1, threads=True)

    assert (tally.done, tally.failed, tally.waiting) == (7, 3, 0)
    np.testing.assert_array_equal(open_sweep(path).status, [1] * 7 + [2] * 3)
    failures = SweepStore(path, plan).failures()
    assert [failure["point"] for failure in failures] == [[7], [8], [9]]
    assert failures[0]["values"] == {"gamma": plan.axes[0].values[7]}
    assert failures[0]["error"] == "ZeroDivisionError: damping is too large"

    mended.touch()
    assert run_sweep(plan, path, workers=1, threads=True).computed == 0
    tally = run_sweep(plan, path, workers=1, threads=True, retry_failed=True)
    assert (tally.done, tally.failed, tally.computed) == (10, 0, 4)
    fresh = run_sweep(plan, tmp_path / "fresh.zarr", workers=1, threads=True)
    assert stored_bytes(path) == stored_bytes(fresh.store)
