"""The same bytes whoever computes, and whatever ends the sweep in the middle."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from machines import machine_text
from sweep_tasks import Deadly, Drawn, basins_plan, plan_of, stored_bytes

from carom.base.outcome import InputError
from carom.sweeps import load_sweep, open_sweep, run_sweep

SWEEP = """
machine = "machine.toml"
chunk = 1
[axes.gamma]
from = 0.3
to = 0.9
count = 10
[axes.mu]
values = [0.1, 0.15]
[basins]
starts = 150
disturbance = {kind = "state"}
"""
MACHINE = machine_text("numbers")


def _environment():
    """Environment of processes that find what this one finds, and the modules of the tests."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])}


posix = pytest.mark.skipif(os.name != "posix", reason="sends signals")


@pytest.mark.jit_only
def test_threads_and_processes_give_the_same_bytes(tmp_path):
    plan = basins_plan()
    stores = {}
    for name, options in {
        "one thread": {"workers": 1, "threads": True},
        "two threads": {"workers": 2, "threads": True},
        "two processes": {"workers": 2},
    }.items():
        tally = run_sweep(plan, tmp_path / name, **options)
        assert (tally.done, tally.computed) == (20, 20)
        stores[name] = stored_bytes(tmp_path / name)

    assert stores["one thread"] == stores["two threads"] == stores["two processes"]
    assert len(stores["one thread"]) > 12


@pytest.mark.jit_only
@posix
def test_killed_sweep_goes_on_to_the_same_bytes(tmp_path):
    (tmp_path / "machine.toml").write_text(MACHINE)
    (tmp_path / "sweep.toml").write_text(SWEEP)
    store = tmp_path / "s.zarr"
    command = [sys.executable, "-m", "carom", "sweep", str(tmp_path / "sweep.toml"), "--out", str(store)]
    process = subprocess.Popen([*command, "--workers", "2"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    status = store / "status" / "c"
    while process.poll() is None and len(list(status.glob("*/*"))) < 4:
        time.sleep(0.005)
    process.kill()
    _, errors = process.communicate()
    plan = load_sweep(tmp_path / "sweep.toml")
    kept = {file: file.stat().st_mtime_ns for file in status.glob("*/*")}
    finished = len(kept)

    assert process.returncode == -signal.SIGKILL, errors
    assert 4 <= finished < 20
    tally = run_sweep(plan, store, workers=1, threads=True)
    assert (tally.done, tally.computed) == (20, 20 - finished)
    run_sweep(plan, tmp_path / "whole.zarr", workers=2, threads=True)
    assert stored_bytes(store) == stored_bytes(tmp_path / "whole.zarr")
    # What was finished has not been written again.
    assert {file: file.stat().st_mtime_ns for file in kept} == kept


@pytest.mark.parametrize("moment", [0.0, 0.05, 0.3])
@posix
def test_interrupt_says_how_to_go_on(tmp_path, moment):
    (tmp_path / "machine.toml").write_text(MACHINE)
    (tmp_path / "sweep.toml").write_text(SWEEP.replace("150", "20000"))
    store = tmp_path / "s.zarr"
    command = [sys.executable, "-m", "carom", "sweep", str(tmp_path / "sweep.toml"), "--out", str(store)]
    process = subprocess.Popen(
        [*command, "--workers", "2"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # Where the tests run in the background, what they start is deaf to Ctrl-C.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    while process.poll() is None and not store.exists():
        time.sleep(0.01)
    time.sleep(moment)
    os.killpg(process.pid, signal.SIGINT)  # as Ctrl-C does: to the workers too
    output, errors = process.communicate()

    assert (process.returncode, output) == (130, "")
    assert errors == f"carom: interrupted; the same command resumes {store}\n"


def test_plain_script_needs_no_main_guard(tmp_path):
    """Nor a module for the task that it defines itself."""
    script = tmp_path / "script.py"
    script.write_text(
        """
print("started")
import sweep_tasks
from carom.sweeps import open_sweep, run_sweep

class Own(sweep_tasks.Drawn):
    def evaluate(self, case, seed):
        return {"value": 2 * case.parameters.gamma, "draw": 3}

tally = run_sweep(sweep_tasks.plan_of(Own(), 4, 1), "s.zarr", workers=2)
print(tally.done, tally.failed, open_sweep("s.zarr").value.values.round(3).tolist())
"""
    )
    done = subprocess.run(
        [sys.executable, script], cwd=tmp_path, env=_environment(), capture_output=True, text=True, check=False
    )

    assert (done.stdout, done.stderr) == ("started\n4 0 [0.2, 0.8, 1.4, 2.0]\n", "")


@posix
def test_chunk_that_kills_every_process_fails_and_the_others_go_on(tmp_path):
    plan = plan_of(Deadly(above=0.95))
    tally = run_sweep(plan, tmp_path / "s.zarr", workers=2)
    data = open_sweep(tmp_path / "s.zarr")

    assert (tally.done, tally.failed) == (8, 2)
    np.testing.assert_array_equal(data.status, [1] * 8 + [2] * 2)
    shown = (tmp_path / "s.zarr" / "records" / "0000004.json").read_text()
    assert "the process that computed it ended (SIGKILL(-9)), 3 times" in shown


@posix
def test_worker_killed_from_outside_costs_nothing(tmp_path):
    import multiprocessing

    plan, killed = plan_of(Drawn(seconds_taken=0.1)), []

    def kill_one(_):
        if not killed:
            killed.append(multiprocessing.active_children()[0].pid)
            os.kill(killed[0], signal.SIGKILL)

    tally = run_sweep(plan, tmp_path / "s.zarr", workers=2, progress=kill_one)
    run_sweep(plan, tmp_path / "other.zarr", workers=1, threads=True)

    assert killed
    assert (tally.done, tally.failed) == (10, 0)
    assert stored_bytes(tmp_path / "s.zarr") == stored_bytes(tmp_path / "other.zarr")
    assert not multiprocessing.active_children()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"workers": 0}, "workers = 0: a whole number of at least 1"),
        ({"threads": True, "scheduler": "tcp://x:1"}, "--threads = given"),
    ],
)
def test_options_that_do_not_go(tmp_path, options, words):
    with pytest.raises(InputError, match=words):
        run_sweep(plan_of(Drawn()), tmp_path / "s.zarr", **options)
