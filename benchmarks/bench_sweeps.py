"""What it costs to plan a sweep and to hand out chunks of about a second, and how well two workers share them."""

from __future__ import annotations

import contextlib
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from itertools import count, islice
from multiprocessing import get_context
from pathlib import Path
from statistics import median

import pytest
from sweep_tasks import Drawn, basins_plan, plan_of

from carom.sweeps.chunk import compute_chunk
from carom.sweeps.local import on_processes, on_threads
from carom.sweeps.store import SweepStore

CHUNKS = 8
WARM = 4
"""Chunks before the clock starts: by then all workers have loaded what they need."""

PLANNED = """
machine = '{machine}'
axes.stiffness = {{from = "5e5 N/m", to = "2e6 N/m", count = 1000}}
axes.damping = {{from = "500 N s/m", to = "8000 N s/m", count = 1000}}
basins.starts = 100
basins.disturbance = {{kind = "shock", peak = "20 g", duration = "11 ms"}}
"""
UP_TO_THE_WORKERS = """
import sys
import carom.sweeps.local
from carom.sweeps import load_sweep, run_sweep
carom.sweeps.local.on_processes = lambda *given: (chunk for chunk in ())
print(run_sweep(load_sweep(sys.argv[1]), sys.argv[2]).waiting)
"""


def test_plan_of_a_hundred_million_starts(benchmark, tmp_path):
    """From a fresh process to the first worker, store laid out: nearly all of it is loading."""
    machine = Path(__file__).parents[1] / "examples" / "keogh-cole.toml"
    file = tmp_path / "sweep.toml"
    file.write_text(PLANNED.format(machine=machine), encoding="utf-8")
    stores = count()

    def plan():
        command = [sys.executable, "-c", UP_TO_THE_WORKERS, file, tmp_path / f"{next(stores)}.zarr"]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert int(done.stdout) == 10**6

    benchmark.group = "a sweep of 10^8 starts, up to the workers, in a fresh process"
    benchmark.pedantic(plan, rounds=5)
    benchmark.extra_info.update(who="plan", unit="plan", units=1)


@contextlib.contextmanager
def dask_workers(number):
    """A client of that many workers."""
    from distributed import Client, LocalCluster

    options = {"n_workers": number, "threads_per_worker": 1, "dashboard_address": ":0", "silence_logs": 60}
    with LocalCluster(**options) as cluster, Client(cluster, set_as_default=False) as client:
        client.wait_for_workers(number)
        yield client


@contextlib.contextmanager
def workers(who, plan, number):
    """Chunks without end, from workers that are at work."""
    numbers = (place % plan.chunks for place in count())
    with contextlib.ExitStack() as stack:
        if who == "dask":
            pytest.importorskip("distributed")
            from carom.sweeps.cluster import on_cluster

            chunks = on_cluster(plan, numbers, stack.enter_context(dask_workers(number)))
        elif who == "loop":
            chunks = (compute_chunk(plan, place) for place in numbers)
        else:
            chunks = (on_threads if who == "threads" else on_processes)(plan, numbers, number)
        stack.enter_context(contextlib.closing(chunks))
        for _ in islice(chunks, WARM):
            pass
        yield chunks


def time_chunks(benchmark, who, plan, number, store):
    with workers(who, plan, number) as chunks, SweepStore(store, plan) as book:

        def draw():
            for chunk in islice(chunks, CHUNKS):
                book.write(chunk)

        benchmark.pedantic(draw, rounds=3)
    benchmark.extra_info.update(who=f"{who}, {number}", unit="chunk", units=CHUNKS)


@pytest.mark.parametrize("who", ["threads", "processes", "dask"])
def test_chunks_that_sleep_a_second(benchmark, who, tmp_path):
    """Nothing but handing out and storing: half a second a chunk is what two workers can do at best."""
    benchmark.group = "a chunk that sleeps a second, two workers, stored"
    time_chunks(benchmark, who, plan_of(Drawn(seconds_taken=1.0), count=12, chunk=1), 2, tmp_path / "s.zarr")


@pytest.mark.parametrize(("who", "number"), [("loop", 1), ("threads", 2), ("processes", 2), ("dask", 2)])
def test_chunks_that_compute_a_second(benchmark, who, number, tmp_path):
    """Motions that bounce; the same chunks over and over."""
    benchmark.group = "a chunk of 60,000 bouncing motions, stored"
    time_chunks(benchmark, who, bouncing_plan(), number, tmp_path / "s.zarr")


def test_what_dask_adds_to_a_chunk_that_computes(benchmark):
    """One worker of Dask's, in turns with a process of one's own."""
    pytest.importorskip("distributed")
    plan, seconds = bouncing_plan(), []
    with ProcessPoolExecutor(1, get_context("spawn")) as pool, dask_workers(1) as client:

        def on_dask():
            client.submit(compute_chunk, plan, 0, pure=False).result()

        def on_a_process():
            began = time.perf_counter()
            pool.submit(compute_chunk, plan, 0).result()
            seconds.append(time.perf_counter() - began)

        on_a_process()
        on_dask()
        seconds.clear()
        benchmark.group = "a chunk of 60,000 bouncing motions, one worker"
        benchmark.pedantic(on_dask, setup=on_a_process, rounds=21)
    benchmark.extra_info.update(who="dask", unit="chunk", units=1, beside={"a process": median(seconds)})


def bouncing_plan():
    return basins_plan(starts=60_000, chunk=1, shape=(2, 2), damping=(0.1, 0.1001))
