"""Chunks computed by the workers of a Dask cluster."""

from __future__ import annotations

import logging
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from queue import Empty, SimpleQueue
from socket import gethostname
from typing import TYPE_CHECKING

from carom.outcome import CaromError, InputError
from carom.sweeps.chunk import Chunk, compute_chunk, failed_chunk
from carom.sweeps.local import AHEAD
from carom.sweeps.plan import SweepPlan
from carom.sweeps.versions import other_version, versions

if TYPE_CHECKING:
    from distributed import Client, Future

OPTION = "--scheduler"
SLURM = "slurm"
_PATIENCE = "20s"
_POLL = 2.0
"""Seconds without a result after which to look for new workers."""


def on_cluster(plan: SweepPlan, numbers: Iterator[int], client: Client) -> Generator[Chunk, None, None]:
    """Compute chunks on the workers of a cluster, and yield them in the order in which they become ready.

    Only as many numbers are taken as the present workers can work on.  Workers may join and leave.  If a worker is lost, the
    scheduler gives its chunks to another one.  If too many workers are lost while they compute the same chunk, the scheduler
    gives it up, and the chunk is recorded as failed.  A :class:`~carom.outcome.CaromError` says that the scheduler is lost, or
    that a worker cannot load carom or has another version of it.
    """
    from distributed import CancelledError, KilledWorker

    here = versions()
    pending: dict[Future[Chunk], int] = {}
    ready: SimpleQueue[Future[Chunk]] = SimpleQueue()

    def submit() -> None:
        slots = sum(client.ncores().values()) or 1
        for number in islice(numbers, max(AHEAD * slots - len(pending), 0)):
            # Impure, so each task gets its own key: a chunk that is tried again is really computed again.
            future = client.submit(_compute, plan, number, here, pure=False)
            pending[future] = number
            future.add_done_callback(ready.put)

    try:
        submit()
        while pending:
            try:
                future = ready.get(timeout=_POLL)
            except Empty:
                submit()  # to workers that have joined since
                continue
            number = pending.pop(future)
            try:
                chunk = future.result()
            except KilledWorker:
                chunk = failed_chunk(plan, number, "too many workers were lost while they computed it")
            except (ImportError, AttributeError, RuntimeError) as problem:  # computing a chunk raises nothing itself
                reason = " ".join(str(problem.__cause__ or problem).split())
                raise CaromError(f"a worker cannot load carom ({reason}); install {here['carom']} there") from None
            submit()
            yield chunk
    except (CancelledError, OSError) as problem:
        words = f"lost the scheduler ({type(problem).__name__}); finished chunks are kept; resume with the same command"
        raise CaromError(words) from None
    finally:
        client.cancel(list(pending))


@contextmanager
def connect(scheduler: str, workers: int | None) -> Iterator[Client]:
    """Connect to a cluster; refuse a scheduler that cannot be reached.

    The scheduler is an address such as ``"tcp://host:8786"``, the path of its file, or ``"slurm"`` for as many jobs of
    a SLURM cluster as there are to be workers, which the configuration of dask-jobqueue describes.
    """
    try:
        from distributed import Client
    except ImportError:
        remedy = 'needs dask.distributed; install it with: pip install "carom[cluster]"'
        raise InputError(OPTION, scheduler, remedy) from None
    with _quiet(), _connected(Client, scheduler, workers) as client:
        yield client


@contextmanager
def _connected(kind: type[Client], scheduler: str, workers: int | None) -> Iterator[Client]:
    if scheduler == SLURM:
        with _slurm_jobs(workers) as cluster, kind(cluster) as client:
            yield client
        return
    place = {"scheduler_file": scheduler} if Path(scheduler).is_file() else {"address": scheduler}
    allowed = (
        f"must be the address of a Dask scheduler that can be reached, such as tcp://host:8786, or its file, or {SLURM}"
    )
    if "address" in place and ":" not in scheduler:
        raise InputError(OPTION, scheduler, f"{allowed} (there is no such file)")
    try:
        client = kind(**place, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as problem:
        raise InputError(OPTION, scheduler, f"{allowed} ({type(problem).__name__})") from None
    with client:
        yield client


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep the tracebacks of lost connections out of the output; the error is one line instead."""
    loggers = [logging.getLogger(name) for name in logging.root.manager.loggerDict if name.startswith("distributed")]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


@contextmanager
def _slurm_jobs(workers: int | None) -> Iterator[object]:
    try:
        from dask_jobqueue import SLURMCluster
    except ImportError:
        raise InputError(OPTION, SLURM, "needs dask-jobqueue; install it with: pip install dask-jobqueue") from None
    if workers is None:
        raise InputError("--workers", None, f"with {OPTION} {SLURM}: how many workers to ask for")
    try:
        cluster = SLURMCluster()
    except (ValueError, OSError) as problem:
        remedy = "describe the jobs (cores, memory, queue) in the configuration of dask-jobqueue"
        raise InputError(OPTION, SLURM, f"{remedy}; {problem}") from None
    with cluster:
        cluster.scale(workers)
        yield cluster


def _compute(plan: SweepPlan, number: int, wanted: dict[str, str]) -> Chunk:
    """Compute a chunk on a worker, if it has the same versions of carom and its numerical libraries."""
    if other := other_version(versions(), wanted):
        name, there, here = other
        raise CaromError(f"the worker on {gethostname()} has {name} {there}, this is {here}; install the same on both")
    return compute_chunk(plan, number)
