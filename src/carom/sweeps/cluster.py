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

from carom.base.outcome import CaromError, InputError
from carom.sweeps.chunk import Chunk, compute_chunk, failed_chunk
from carom.sweeps.local import AHEAD
from carom.sweeps.plan import SweepPlan
from carom.sweeps.versions import other_version, versions

if TYPE_CHECKING:
    from distributed import Client, Future

OPTION = "--scheduler"
_PATIENCE = "20s"
_POLL = 2.0
"""Seconds without a result after which to look for new workers."""


def on_cluster(plan: SweepPlan, numbers: Iterator[int], client: Client) -> Generator[Chunk, None, None]:
    """Compute chunks on the workers of a cluster, and yield them in the order in which they become ready.

    Only as many numbers are taken as the present workers can work on.  Workers may join and leave.  If a worker is lost, the
    scheduler gives its chunks to another one.  If too many workers are lost while they compute the same chunk, the scheduler
    gives it up, and the chunk is recorded as failed.  A :class:`~carom.base.outcome.CaromError` says that the scheduler is lost, or
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
def connect(scheduler: str) -> Iterator[Client]:
    """Connect to a cluster by the address of its scheduler, such as ``"tcp://host:8786"``, or the path of its file."""
    try:
        from distributed import Client
    except ImportError:
        remedy = 'needs dask.distributed; install it with: pip install "carom[cluster]"'
        raise InputError(OPTION, scheduler, remedy) from None
    place = {"scheduler_file": scheduler} if Path(scheduler).is_file() else {"address": scheduler}
    allowed = "must be the address of a Dask scheduler that can be reached, such as tcp://host:8786, or its file"
    if "address" in place and ":" not in scheduler:
        raise InputError(OPTION, scheduler, f"{allowed} (there is no such file)")
    with _quiet():
        try:
            client = Client(**place, timeout=_PATIENCE, set_as_default=False)
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


def _compute(plan: SweepPlan, number: int, wanted: dict[str, str]) -> Chunk:
    """Compute a chunk on a worker, if it has the same versions of carom and its numerical libraries."""
    if other := other_version(versions(), wanted):
        name, there, here = other
        raise CaromError(f"the worker on {gethostname()} has {name} {there}, this is {here}; install the same on both")
    return compute_chunk(plan, number)
