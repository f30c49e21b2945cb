"""Run a sweep: compute the waiting chunks with the chosen workers, and store them."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from contextlib import ExitStack, closing
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from carom.base.arguments import Count, checked
from carom.base.outcome import InputError
from carom.base.progress import Reporter, ShowProgress, duration_words, shows_progress
from carom.core.processors import available_cores
from carom.sweeps.plan import SweepPlan
from carom.sweeps.store import SweepStore, open_sweep

if TYPE_CHECKING:
    import xarray
    from distributed import Client


@dataclass(frozen=True)
class Tally:
    """Progress of a sweep.

    Attributes
    ----------
    store : Path or None
        Directory of the results; ``None`` in memory.
    points, done, failed : int
        Numbers of points of the grid; points that are neither done nor failed are waiting.
    computed : int
        Points computed by this run.
    seconds : float
        Time since this run began.
    damaged : tuple of int
        Finished chunks of which a file was damaged, missing or another's; they are computed again.
    failures : list of dict
        The first failed points, when the run has ended: index in the grid, parameters and error of each.
    """

    store: Path | None
    points: int
    done: int
    failed: int
    computed: int
    seconds: float
    read: Callable[[], xarray.Dataset] = field(repr=False, compare=False)
    damaged: tuple[int, ...] = ()
    failures: list[dict[str, object]] = field(default_factory=list, repr=False)

    @property
    def dataset(self) -> xarray.Dataset:
        """Results so far, as :func:`~carom.sweeps.open_sweep` returns them."""
        return self.read()

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

    @property
    def words(self) -> str:
        """Points done, rate and time left, in less than 80 characters."""
        parts = [f"{self.done + self.failed:,} of {self.points:,} points", rate_words(self.rate, "points")]
        if self.left is not None:
            parts.append(f"{duration_words(self.left)} left")
        if self.failed:
            parts.append(f"{self.failed:,} failed")
        return ", ".join(parts)


def rate_words(rate: float, noun: str) -> str:
    """Write a number per second."""
    from carom.parameters.formats import number

    return f"{number(rate, 3)} {noun}/s"


@checked
@shows_progress
def run_sweep(
    plan: SweepPlan,
    store: str | os.PathLike[str] | None = None,
    *,
    workers: Count | None = None,
    threads: bool | None = None,
    scheduler: str | Client | None = None,
    retry_failed: bool = False,
    progress: ShowProgress = None,
) -> Tally:
    """Compute all points of a sweep that are not in its store yet; without a store, keep the results in memory.

    Each chunk is stored as soon as it is computed, completely or not at all.  If this function is interrupted for any
    reason, the same call resumes the sweep.  Chunks finished before are compared with their records, and damaged ones
    are computed again.  On processors of one kind the results are bit for bit the same, whichever workers compute them.
    The returned tally has the results as its ``dataset``.

    Parameters
    ----------
    plan : SweepPlan
        From :func:`~carom.sweeps.plan_sweep`, or from a file by :func:`~carom.sweeps.load_sweep`.
    store : path, optional
        Directory of the Zarr store; created if it does not exist.
    workers : int, optional
        Number of processes on this machine, by default one for each available core.
    threads : bool
        Use threads of this process instead of processes; by default in memory only.
    scheduler : str or distributed.Client, optional
        Compute on a Dask cluster instead: address or file of its scheduler, or a client.
    retry_failed : bool
        Compute chunks with failed points again.

    Raises
    ------
    InputError
        The store cannot be written, is being written by another sweep, belongs to another plan, or is damaged outside
        its chunks.
    CaromError
        No worker can compute.

    See Also
    --------
    carom.sweeps.plan_sweep, carom.sweeps.load_sweep : plans
    carom.open_sweep : read a store

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> axes = [cm.sweeps.GridAxis.between("damping", "1000 N s/m", "4000 N s/m", 3)]
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> plan = cm.sweeps.plan_sweep(machine, axes, cm.disturbances.Sample(kicks, 10, seed=1))
    >>> cm.run_sweep(plan).dataset.recovered.values
    array([0. , 0.2, 1. ])
    """
    for option, given in (("--threads", "given" if threads else None), ("--workers", workers)):
        if scheduler is not None and given is not None:
            raise InputError(option, given, "not allowed with --scheduler, whose workers compute")
    if store is None:
        with TemporaryDirectory(prefix="carom-sweep-") as folder:
            own = (scheduler is None) if threads is None else threads
            place = Path(folder, "sweep")
            found = run_sweep(plan, place, workers=workers, threads=own, scheduler=scheduler, progress=progress)
            data = found.dataset.load()
        return replace(found, store=None, read=lambda: data)
    book = SweepStore(store, plan)
    began, computed, tell = time.monotonic(), 0, Reporter.of(progress, "computing points")

    def tally() -> Tally:
        numbers = plan.points, book.done, book.failed, computed, time.monotonic() - began
        return Tally(book.path, *numbers, partial(open_sweep, book.path), tuple(book.damaged))

    def end() -> Tally:
        return replace(tally(), failures=book.failures())

    if next(book.waiting(retry_failed), None) is None:
        return end()
    with ExitStack() as stack:
        stack.enter_context(book)
        if next(book.waiting(retry_failed), None) is None:
            return end()
        numbers = book.waiting(retry_failed)
        if scheduler is None:
            from carom.sweeps.local import on_processes, on_threads

            chunks = (on_threads if threads else on_processes)(plan, numbers, workers or available_cores())
        else:
            from carom.sweeps.cluster import connect, on_cluster

            client = stack.enter_context(connect(scheduler)) if isinstance(scheduler, str) else scheduler
            chunks = on_cluster(plan, numbers, client)
        for chunk in stack.enter_context(closing(chunks)):
            book.write(chunk)
            computed += plan.size(chunk.number)
            now = tally()
            tell((now.done + now.failed) / now.points, now.words)
    return end()
