"""What it costs to hand out chunks of about a second, and how well two workers share them."""

from __future__ import annotations

import contextlib
from itertools import count, islice

import numpy as np
import pytest
from sweep_tasks import Drawn, basins_plan, plan_of

import carom
from carom.sweeps.chunk import compute_chunk
from carom.sweeps.local import on_processes, on_threads
from carom.sweeps.store import SweepStore

CHUNKS = 8
WARM = 4
"""Chunks before the clock starts: by then all workers have loaded what they need."""


@contextlib.contextmanager
def workers(who, plan, number):
    """Chunks without end, from workers that are at work."""
    numbers = (place % plan.chunks for place in count())
    with contextlib.ExitStack() as stack:
        if who == "dask":
            distributed = pytest.importorskip("distributed")
            from carom.sweeps.cluster import on_cluster

            options = {"n_workers": number, "threads_per_worker": 1, "dashboard_address": ":0", "silence_logs": 60}
            cluster = stack.enter_context(distributed.LocalCluster(**options))
            client = stack.enter_context(distributed.Client(cluster, set_as_default=False))
            client.wait_for_workers(number)
            chunks = on_cluster(plan, numbers, client)
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


@pytest.mark.parametrize(
    ("who", "number"), [("loop", 1), ("threads", 2), ("processes", 1), ("processes", 2), ("dask", 1), ("dask", 2)]
)
def test_chunks_that_compute_a_second(benchmark, who, number, tmp_path):
    """The same chunk over and over, so that all take the same time."""
    benchmark.group = "a chunk of a million motions, stored"
    time_chunks(benchmark, who, basins_plan(starts=1_000_000, chunk=1, shape=(2, 2)), number, tmp_path / "s.zarr")


@pytest.mark.parametrize("threads", [1, 2])
def test_ensemble_on_threads(benchmark, threads, starts):
    """Parallel efficiency of an ensemble: time of one thread over twice that of two."""
    rotor = carom.jeffcott(basins_plan().case.parameters.replace(gamma=0.4))
    carom.settle_all(rotor, starts[:100, 0], starts[:100, 1])
    benchmark.group = "an ensemble followed to its end"
    benchmark.pedantic(carom.settle_all, (rotor, *np.asarray(starts).T), {"threads": threads}, rounds=5)
    benchmark.extra_info.update(who=f"threads, {threads}", unit="start", units=len(starts))
