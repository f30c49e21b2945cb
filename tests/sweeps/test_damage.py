"""Damaged stores: a chunk is computed again, all else is one line."""

import os
import random
import shutil

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


def test_chunk_of_another_plan_is_noticed(whole, store, tmp_path):
    run(tmp_path / "other.zarr", plan_of(Failing(above=0.85), count=10, chunk=3, seed=6))
    for name in ("value/c/1", "draw/c/1", "status/c/1", "records/0000001.json"):
        shutil.copy(tmp_path / "other.zarr" / name, store / name)
    assert run(store).damaged == (1,)
    assert stored_bytes(store) == stored_bytes(whole)


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


def test_loser_of_two_is_told(store):
    shown = []

    def start_another(report):
        if report.step.startswith("7 of 10 points"):  # and three points wait
            with pytest.raises(InputError, match="another sweep is writing to it; let it end, or stop it") as caught:
                run(store)
            shown.append(caught.value)

    for number in (0, 1):
        (store / f"status/c/{number}").unlink()
    assert run(store, progress=start_another).done == 8
    assert len(shown) == 1
