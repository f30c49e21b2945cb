"""Damaged stores: a chunk is computed again, all else is one line."""

import os
import random
import shutil

import numpy as np
import pytest
from compilation import sized
from damage import KINDS, damage, misplace
from sweep_tasks import Failing, plan_of, stored_bytes

from carom.base.outcome import InputError
from carom.sweeps import open_sweep, run_sweep
from carom.sweeps.store import SweepStore

PLAN = plan_of(Failing(above=0.85), count=10, chunk=3)
"""Four chunks: points 8 and 9, in the last two, fail."""


@pytest.fixture(autouse=True)
def quick_disk(monkeypatch):
    """Nothing here is about power cuts."""
    monkeypatch.setattr(os, "fsync", lambda handle: None)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A finished store; not to be touched."""
    path = tmp_path_factory.mktemp("whole") / "s.zarr"
    run(path)
    return path


@pytest.fixture
def store(whole, tmp_path):
    return shutil.copytree(whole, tmp_path / "s.zarr")


def run(path, plan=PLAN, **options):
    return run_sweep(plan, path, workers=1, threads=True, **options)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "directory"])
@pytest.mark.parametrize("name", ["value/c/1", "draw/c/3"])
def test_damaged_chunk_is_computed_again(whole, store, name, kind):
    damage(store / name, random.Random(1), kind)
    tally = run(store)

    assert tally.damaged == (int(name[-1]),)
    assert tally.computed == PLAN.size(int(name[-1]))
    assert (tally.done, tally.failed) == (8, 2)
    assert stored_bytes(store) == stored_bytes(whole)
    assert run(store).damaged == ()


@pytest.mark.parametrize("kind", ["empty", "cut", "flip", "deleted"])
def test_chunk_without_its_status_is_computed_again(whole, store, kind):
    damage(store / "status/c/2", random.Random(1), kind)

    assert run(store).computed == 3
    assert stored_bytes(store) == stored_bytes(whole)


@pytest.mark.parametrize("data", [bytes(4), b"\xff" * 8])
def test_what_agrees_with_its_end_but_is_too_short_is_no_chunk(whole, store, data):
    (store / "value/c/1").write_bytes(data)
    assert run(store).damaged == (1,)
    assert stored_bytes(store) == stored_bytes(whole)


@pytest.mark.parametrize(
    ("first", "second", "wrong"),
    [
        ("value/c/1", "value/c/2", {1, 2}),
        ("value/c/1", "draw/c/1", {1}),
        ("status/c/0", "status/c/3", {0, 3}),
        ("records/0000001.json", "records/0000002.json", {1, 2}),
    ],
)
def test_exchanged_files_are_noticed(whole, store, first, second, wrong):
    one, other = (store / first).read_bytes(), (store / second).read_bytes()
    (store / first).write_bytes(other)
    (store / second).write_bytes(one)
    assert set(run(store).damaged) == wrong
    assert stored_bytes(store) == stored_bytes(whole)


def test_chunk_under_the_name_of_another_is_noticed(whole, store):
    """All its files, the record too: they agree with each other, but not with their place."""
    for name in ("value/c/{}", "draw/c/{}", "status/c/{}", "records/000000{}.json"):
        shutil.copy(store / name.format(0), store / name.format(1))
    assert run(store).damaged == (1,)
    assert stored_bytes(store) == stored_bytes(whole)


def test_chunk_of_another_plan_is_noticed(whole, store, tmp_path):
    run(tmp_path / "other.zarr", plan_of(Failing(above=0.85), count=10, chunk=3, seed=6))
    for name in ("value/c/1", "draw/c/1", "status/c/1", "records/0000001.json"):
        shutil.copy(tmp_path / "other.zarr" / name, store / name)
    assert run(store).damaged == (1,)
    assert stored_bytes(store) == stored_bytes(whole)


def test_chunks_that_wait_are_not_missing(store):
    (store / "status/c/1").unlink()
    (store / "value/c/1").unlink()

    assert np.isnan(open_sweep(store).value[3:6]).all()


def test_other_readers_of_zarr_notice_too(store):
    import zarr

    damage(store / "value/c/1", random.Random(1), "flip")
    with pytest.raises(ValueError, match="checksum"):
        zarr.open_group(store, mode="r")["value"][:]


@pytest.mark.parametrize("kind", ["empty", "cut", "zeros", "deleted"])
def test_damaged_metadata_are_one_line(store, kind):
    damage(store / "zarr.json", random.Random(1), kind)
    for use in (run, open_sweep):
        with pytest.raises(InputError, match=r"its file zarr\.json is damaged, missing or not of a sweep; restore it"):
            use(store)


@pytest.mark.parametrize(
    "text", ["", "{", "[" * 100_000, '{"content": {"points": []}, "crc32c": 1}', "\xff\xfe", "null"]
)
def test_chunk_with_a_broken_record_is_computed_again(whole, store, text):
    (store / "records" / "0000003.json").write_bytes(text.encode("latin-1"))
    tally = run(store)
    assert (tally.damaged, tally.failed) == ((3,), 2)
    assert stored_bytes(store) == stored_bytes(whole)


@pytest.mark.parametrize(
    "name", ["status/c/x", "status/c/99", "status/c/007", "value/c/99", "records/notes.json", "mine"]
)
def test_folders_that_are_not_in_the_way_do_no_harm(store, name):
    (store / name).mkdir()
    (store / "status/c/٣").touch()

    assert run(store).damaged == ()
    assert open_sweep(store).status.values.tolist() == [1] * 8 + [2] * 2


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("value/c/1", "Is a directory"),
        ("status/c/1", "Is a directory"),
        ("records/0000003.json", "Is a directory"),
        ("zarr.json", "Is a directory"),
    ],
)
@pytest.mark.skipif(os.name != "posix", reason="words of POSIX systems")
def test_folders_in_the_way_are_one_line(store, name, words):
    (store / name).unlink()
    (store / name).mkdir()
    with pytest.raises(InputError, match=rf"^--out = .*cannot be read or written \({words}: .*{name}\)"):
        run(store)


@pytest.mark.parametrize("name", [".parts", "records", ".lock"])
def test_what_stands_in_the_way_of_writing_is_one_line(store, name):
    place = store / name
    shutil.rmtree(place) if place.is_dir() else place.unlink()
    place.touch() if name != ".lock" else place.mkdir()
    (store / "status/c/0").unlink()
    with pytest.raises(InputError, match=r"^--out = "):
        run(store)


def test_folder_among_unfinished_files_is_one_line(store):
    (store / ".parts" / "mine").mkdir()
    (store / "status/c/0").unlink()
    with pytest.raises(InputError, match=r"^--out = .*\.parts/mine"):
        run(store)
    (store / ".parts" / "mine").rmdir()
    assert run(store).computed == 3  # nothing is left locked


@pytest.mark.parametrize("seed", range(sized(20, 20, 2500)))
def test_whatever_files_of_chunks_are_damaged_or_exchanged_they_are_computed_again(whole, store, seed):
    chance = random.Random(seed)
    files = sorted(file for name in ("value", "draw", "status") for file in (store / name / "c").iterdir())
    for file in chance.sample(files, chance.choice([1, 1, 2, 4])):
        damage(file, chance, chance.choice([kind for kind in KINDS if kind != "directory"]))
    if chance.random() < 0.5:
        misplace(*chance.sample(files, 2), chance)
    tally = run(store)
    assert (tally.done, tally.failed) == (8, 2)
    assert stored_bytes(store) == stored_bytes(whole)
    assert SweepStore(store, PLAN).failures() == SweepStore(whole, PLAN).failures()


@pytest.mark.parametrize("seed", range(sized(10, 10, 200)))
def test_store_of_an_interrupted_sweep_has_the_same_bytes(whole, tmp_path, seed):
    chance = random.Random(seed)
    path = tmp_path / "s.zarr"

    def stop(report):
        if chance.random() < 0.5:
            raise KeyboardInterrupt

    for _ in range(100):
        try:
            run(path, progress=stop)
        except KeyboardInterrupt:
            files = sorted(
                file
                for name in ("value", "draw", "records")
                for file in (path / name).rglob("*[0-9]*")
                if file.is_file()
            )
            if files and chance.random() < 0.3:
                damage(chance.choice(files), chance, "cut")
            continue
        break
    assert stored_bytes(path) == stored_bytes(whole)
    names = [sorted(str(file.relative_to(store)) for file in store.rglob("*")) for store in (path, whole)]
    assert names[0] == names[1]


# --------------------------------------------------------------------------------------------------- two at the same time


def test_store_that_another_sweep_has_just_made_is_taken(store, monkeypatch):
    monkeypatch.setattr("carom.sweeps.store.is_new", lambda path: True)  # as it was a moment ago

    assert SweepStore(store, PLAN).done == 8
    assert [file.name for file in store.parent.iterdir()] == ["s.zarr"]


def test_loser_of_two_is_told(store):
    told = []

    def start_another(report):
        if report.step.startswith("7 of 10 points"):  # and three points wait
            with pytest.raises(InputError, match="another sweep is writing to it; let it end, or stop it") as caught:
                run(store)
            told.append(caught.value)

    for number in (0, 1):
        (store / f"status/c/{number}").unlink()
    assert run(store, progress=start_another).done == 8
    assert len(told) == 1
