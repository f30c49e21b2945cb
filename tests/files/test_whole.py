"""Files are complete or absent, and what a killed process leaves is removed a day later."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from carom.base.files import unfinished, write_whole

KILLED = """
import os, signal, sys
from pathlib import Path
from carom.base.files import {name}
with {call}:
    os.kill(os.getpid(), signal.SIGKILL)
"""


def kill_within(name, call):
    done = subprocess.run([sys.executable, "-c", KILLED.format(name=name, call=call)], check=False)
    assert done.returncode == -signal.SIGKILL


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX systems")
def test_what_a_killed_process_has_left_goes_a_day_later(tmp_path):
    for name, call in (
        ("unfinished", f"unfinished(Path({str(tmp_path)!r}))"),
        ("staged_directory", f"staged_directory({str(tmp_path)!r}, '--out')"),
    ):
        kill_within(name, call)
    write_whole(tmp_path / "motion.nc", b"content")
    left = [file for file in tmp_path.iterdir() if file.name != "motion.nc"]
    assert len(left) == 2
    for file in left:
        os.utime(file, (0.0, time.time() - 90_000.0))
    write_whole(tmp_path / "motion.nc", b"content")
    assert [file.name for file in tmp_path.iterdir()] == ["motion.nc"]


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
