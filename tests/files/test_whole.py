"""Files are complete or absent, and what a killed process leaves is removed at the next write."""

import os
import signal
import subprocess
import sys
import threading

import pytest

from carom.files import staged_directory, unfinished, whole, write_whole

KILLED = """
import os, signal, sys
from pathlib import Path
from carom.files import {name}
with {call}:
    os.kill(os.getpid(), signal.SIGKILL)
"""


def kill_within(name, call):
    done = subprocess.run([sys.executable, "-c", KILLED.format(name=name, call=call)], check=False)
    assert done.returncode == -signal.SIGKILL


posix = pytest.mark.skipif(os.name != "posix", reason="locks of POSIX systems")


@posix
def test_what_a_killed_process_leaves_goes_at_the_next_write(tmp_path):
    for name, call in (
        ("unfinished", f"unfinished(Path({str(tmp_path)!r}))"),
        ("staged_directory", f"staged_directory({str(tmp_path)!r}, '--out')"),
        ("staged_directory", f"staged_directory({str(tmp_path / 'new')!r}, '--out')"),
    ):
        kill_within(name, call)
        assert len(list(tmp_path.iterdir())) == 1
    write_whole(tmp_path / "motion.nc", b"content")
    assert [file.name for file in tmp_path.iterdir()] == ["motion.nc"]


@posix
def test_what_a_killed_process_leaves_goes_at_the_next_study(tmp_path):
    kill_within("staged_directory", f"staged_directory({str(tmp_path / 'out')!r}, '--out')")

    with staged_directory(str(tmp_path / "out"), "--out") as place:
        (place / "study.json").write_text("{}")
    assert [str(file.relative_to(tmp_path)) for file in sorted(tmp_path.rglob("*"))] == ["out", "out/study.json"]


def test_what_is_being_written_stays(tmp_path):
    with unfinished(tmp_path) as one, unfinished(tmp_path, folder=True) as other:
        write_whole(tmp_path / "motion.nc", b"content")
        assert one.exists()
        assert other.is_dir()
    assert [file.name for file in tmp_path.iterdir()] == ["motion.nc"]


@pytest.mark.parametrize("name", [".carom.part", ".carom.0123456789ABCDEF.part", "mine.part", ".0123456789abcdef.part"])
def test_files_of_others_stay(tmp_path, name):
    (tmp_path / name).write_text("mine")
    write_whole(tmp_path / "motion.nc", b"content")
    assert (tmp_path / name).read_text() == "mine"


@pytest.mark.parametrize("folder", [False, True])
def test_a_name_is_never_used_twice(tmp_path, monkeypatch, folder):
    """What another process takes for left, and removes before it is locked, is made again by another name: that process may
    still be about to remove what has the first name."""
    tried, made = [], whole._made

    def taken_at_first(part, is_folder):
        tried.append(part)
        return made(part, is_folder)

    def lock(handle, *, wait=False):
        if wait and len(tried) < 3:
            whole._remove(tried[-1])
        return True

    monkeypatch.setattr(whole, "_made", taken_at_first)
    monkeypatch.setattr(whole, "_lock", lock)
    with unfinished(tmp_path, folder=folder) as part:
        assert part == tried[-1]
        assert part.is_dir() == folder
        assert len(tried) == len(set(tried)) == 3
    assert not list(tmp_path.iterdir())


def test_many_may_write_at_the_same_time(tmp_path):
    """Each removes what seems left, and nobody loses what he is writing."""
    problems = []

    def write(number):
        try:
            for turn in range(30):
                write_whole(tmp_path / f"{number}", bytes([turn]) * 100)
        except OSError as problem:
            problems.append(problem)

    threads = [threading.Thread(target=write, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not problems
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == {
        str(n): bytes([29]) * 100 for n in range(8)
    }
