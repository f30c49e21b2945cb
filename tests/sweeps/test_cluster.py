"""A real scheduler and real workers: the same bytes, also when one of them is killed during the run."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from sweep_tasks import Drawn, basins_plan, plan_of, stored_bytes

from carom.base.outcome import CaromError, InputError
from carom.sweeps import run_sweep
from carom.sweeps.cluster import connect

distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")
pytestmark = pytest.mark.skipif(os.name != "posix", reason="starts and kills processes")

DASK = [sys.executable, "-m", "dask"]


class Cluster:
    """A scheduler with its file, and workers, each a process."""

    def __init__(self, place):
        self.file = place / "scheduler.json"
        self.place = place
        self.workers = {}
        self.scheduler = self._start("scheduler", "--port", "0", "--host", "127.0.0.1", "--dashboard-address", ":0")
        self._wait(self.file.exists)

    def _start(self, *arguments):
        environment = {
            **os.environ,
            "PYTHONPATH": str(Path(__file__).parents[1]),
            # A worker that is gone is given up soon.
            "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "10s",
        }
        with (self.place / "log").open("ab") as log:
            command = [*DASK, *arguments, "--scheduler-file", str(self.file)]
            return subprocess.Popen(command, env=environment, stdout=log, stderr=log, cwd=self.place)

    def hire(self, name):
        options = ("--nthreads", "1", "--no-nanny", "--no-dashboard", "--memory-limit", "0")
        self.workers[name] = self._start("worker", "--name", name, *options)

    def wait_for(self, count):
        with connect(str(self.file)) as client:
            client.wait_for_workers(count, timeout=120)

    def _wait(self, ready):
        for _ in range(1200):
            if ready():
                return
            time.sleep(0.1)
        raise TimeoutError((self.place / "log").read_text())

    def close(self):
        for process in (*self.workers.values(), self.scheduler):
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    cluster = Cluster(tmp_path_factory.mktemp("cluster"))
    try:
        for name in ("first", "second"):
            cluster.hire(name)
        cluster.wait_for(2)
        yield cluster
    finally:
        cluster.close()


@pytest.mark.jit_only
def test_two_workers_give_the_bytes_of_one_thread(cluster, tmp_path):
    plan = basins_plan()
    tally = run_sweep(plan, tmp_path / "cluster.zarr", scheduler=str(cluster.file))
    run_sweep(plan, tmp_path / "thread.zarr", workers=1, threads=True)

    assert (tally.done, tally.computed) == (20, 20)
    assert stored_bytes(tmp_path / "cluster.zarr") == stored_bytes(tmp_path / "thread.zarr")


@pytest.mark.jit_only
def test_worker_killed_during_the_run_costs_nothing(cluster, tmp_path):
    plan, killed = basins_plan(starts=200), []
    address = distributed.Client(scheduler_file=str(cluster.file), set_as_default=False)

    def kill_one(report):
        if not killed and report.share * plan.points >= 3.5:
            killed.append(cluster.workers.pop("second"))
            killed[0].send_signal(signal.SIGKILL)
            killed[0].wait()

    with address as client:
        tally = run_sweep(plan, tmp_path / "cluster.zarr", scheduler=client, progress=kill_one)
        left = len(client.scheduler_info()["workers"])
    run_sweep(plan, tmp_path / "thread.zarr", workers=2, threads=True)

    assert killed
    assert left == 1
    assert (tally.done, tally.failed) == (20, 0)
    assert stored_bytes(tmp_path / "cluster.zarr") == stored_bytes(tmp_path / "thread.zarr")
    cluster.hire("second")
    cluster.wait_for(2)


def test_lost_scheduler_is_one_line_and_what_was_finished_is_kept(tmp_path, capfd):
    plan = plan_of(Drawn(seconds_taken=0.05), count=40, chunk=1)
    own = Cluster(tmp_path)
    try:
        own.hire("only")
        own.wait_for(1)

        def end(report):
            if round(report.share * plan.points) == 3:
                own.close()

        with pytest.raises(CaromError, match=r"lost the scheduler .* finished chunks are kept") as caught:
            run_sweep(plan, tmp_path / "s.zarr", scheduler=str(own.file), progress=end)
    finally:
        own.close()

    assert "\n" not in str(caught.value)
    assert capfd.readouterr().err == ""  # no traceback of the connection either
    tally = run_sweep(plan, tmp_path / "s.zarr", workers=1, threads=True)
    assert tally.done == 40
    assert tally.computed <= 37


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense://", "no-such-file.json"])
def test_scheduler_that_cannot_be_reached_is_named(address, tmp_path, monkeypatch):
    monkeypatch.setattr("carom.sweeps.cluster._PATIENCE", "1s")

    with pytest.raises(InputError, match=f"^--scheduler = {address}: must be the address of a Dask scheduler"):
        run_sweep(plan_of(Drawn()), tmp_path / "s.zarr", scheduler=address)
