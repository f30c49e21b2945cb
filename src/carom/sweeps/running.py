"""Run a sweep: compute the waiting chunks with the chosen workers, and store them."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from carom.core.processors import available_cores
from carom.outcome import InputError
from carom.sweeps.chunk import Chunk
from carom.sweeps.plan import SweepPlan
from carom.sweeps.store import SweepStore

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["Tally", "run_sweep"]


@dataclass(frozen=True)
class Tally:
    """Progress of a sweep.

    Attributes
    ----------
    store : Path
    points, done, failed : int
        Numbers of points of the grid; points that are neither done nor failed are waiting.
    computed : int
        Points computed by this run.
    seconds : float
        Time since this run began.
    damaged : tuple of int
        Finished chunks of which a file was damaged or missing; they are computed again.
    """

    store: Path
    points: int
    done: int
    failed: int
    computed: int
    seconds: float
    damaged: tuple[int, ...] = ()

    @property
    def waiting(self) -> int:
        """Points that have not been computed."""
        return self.points - self.done - self.failed

    @property
    def rate(self) -> float:
        """Points per second."""
        return self.computed / self.seconds if self.seconds > 0 else 0.0

    @property
    def left(self) -> float | None:
        """Seconds left at this rate, if it is known."""
        return self.waiting / self.rate if self.rate > 0 else None


def run_sweep(
    plan: SweepPlan,
    store: str | os.PathLike[str],
    *,
    workers: int | None = None,
    threads: bool = False,
    scheduler: str | Client | None = None,
    retry_failed: bool = False,
    progress: Callable[[Tally], None] | None = None,
) -> Tally:
    """Compute all points of a sweep that are not in its store yet.

    Each chunk is stored as soon as it is computed, completely or not at all.  If this function is interrupted for any
    reason, the same call resumes the sweep.  Chunks finished before are compared with their checksums, and damaged ones
    are computed again.  On processors of one kind the results are bit for bit the same, whichever workers compute them.

    Parameters
    ----------
    plan : SweepPlan
    store : path
        Directory of the Zarr store; created if it does not exist.
    workers : int, optional
        Number of processes on this machine, by default one for each available core.
    threads : bool
        Use threads of this process instead of processes.
    scheduler : str or distributed.Client, optional
        Compute on a Dask cluster instead: address or file of its scheduler, ``"slurm"``, or a client.
    retry_failed : bool
        Compute chunks with failed points again.
    progress : callable, optional
        Called with a :class:`Tally` after each chunk.

    Returns
    -------
    Tally

    Raises
    ------
    InputError
        The store cannot be written, is being written by another sweep, belongs to another plan, or is damaged outside
        its chunks.
    CaromError
        No worker can compute.
    """
    if workers is not None and workers < 1:
        raise InputError("--workers", workers, "must be a whole number of at least 1")
    if scheduler is not None and threads:
        raise InputError("--threads", "given", "must be left out with --scheduler, whose workers compute")
    if scheduler not in (None, "slurm") and workers is not None:
        raise InputError(
            "--workers", workers, "must be left out with --scheduler ADDRESS, whose workers compute; allowed with slurm"
        )
    book = SweepStore(store, plan)
    began, computed = time.monotonic(), 0

    def tally() -> Tally:
        seconds = time.monotonic() - began
        return Tally(book.path, plan.points, book.done, book.failed, computed, seconds, tuple(book.damaged))

    if next(book.waiting(retry_failed), None) is None:
        return tally()
    with ExitStack() as stack:
        stack.enter_context(book)
        chunks = _chunks(plan, book.waiting(retry_failed), workers, threads, scheduler, stack)
        for chunk in stack.enter_context(closing(chunks)):
            book.write(chunk)
            computed += plan.size(chunk.number)
            if progress:
                progress(tally())
    return tally()


def _chunks(
    plan: SweepPlan,
    numbers: Iterator[int],
    workers: int | None,
    threads: bool,
    scheduler: str | Client | None,
    stack: ExitStack,
) -> Generator[Chunk, None, None]:
    if scheduler is not None:
        from carom.sweeps.cluster import connect, on_cluster

        client = stack.enter_context(connect(scheduler, workers)) if isinstance(scheduler, str) else scheduler
        return on_cluster(plan, numbers, client)
    from carom.sweeps.local import on_processes, on_threads

    return (on_threads if threads else on_processes)(plan, numbers, workers or available_cores())
