"""Chunks computed on this machine, by processes or by threads."""

from __future__ import annotations

import os
import signal
import threading
import warnings
from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack, contextmanager
from functools import partial
from itertools import chain, islice
from multiprocessing import connection
from typing import TYPE_CHECKING, TypeVar

from carom.base.outcome import CaromError
from carom.sweeps.chunk import Chunk, compute_chunk, failed_chunk
from carom.sweeps.plan import SweepPlan

if TYPE_CHECKING:
    from loky.process_executor import ProcessPoolExecutor

AHEAD = 2
"""Chunks assigned to a worker at a time: one to compute, and one more so that it need not wait."""
TRIES = 2
"""Number of times that a process ends while a chunk is with the workers until the chunk is tried alone; it may have been killed from outside."""
STARTING = 1.5
"""Seconds for which a Ctrl-C waits for a worker that starts."""
_ENVIRONMENT = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment of a worker: linear algebra uses one thread."""
_Computed = TypeVar("_Computed")


def on_threads(plan: SweepPlan, numbers: Iterator[int], workers: int) -> Generator[Chunk, None, None]:
    """Compute chunks on threads of this process, and yield them in the order in which they become ready.

    The kernels release Python's global interpreter lock; Python code runs in one thread at a time.  Only as
    many numbers are taken as the workers can work on.
    """
    pool = ThreadPoolExecutor(workers, thread_name_prefix="carom-sweep")
    try:
        yield from _as_ready(lambda number: pool.submit(compute_chunk, plan, number), numbers, workers)
    finally:
        pool.shutdown(cancel_futures=True)


def on_processes(plan: SweepPlan, numbers: Iterator[int], workers: int) -> Generator[Chunk, None, None]:
    """Compute chunks in worker processes, and yield them in the order in which they become ready.

    Only as many numbers are taken as the workers can work on.  If a process ends unexpectedly (killed, out of memory),
    the chunks that the workers had are tried again, and those that had been with them before alone; a chunk fails if the process
    that computes it alone ends.  A :class:`~carom.base.outcome.CaromError` if processes end before
    they begin.  loky starts them without running the calling script again, so it needs no ``if __name__ ==
    "__main__"``.
    """
    from loky.process_executor import BrokenProcessPool

    tries: Counter[int] = Counter()
    given: list[int] = []
    again: list[int] = []
    first = list(islice(numbers, workers))
    taken = _noting(chain(first, numbers), given)
    while True:
        try:
            with _processes(max(1, min(workers, len(first)))) as pool:
                submit = partial(pool.submit, _compute, plan)
                for chunk, heard in _as_ready(submit, chain(again, taken), workers):
                    given.remove(chunk.number)
                    for warning in heard:
                        warnings.warn(warning, stacklevel=1)  # a warning that several workers send is shown once
                    yield chunk
            return
        except BrokenProcessPool:
            tries.update(given)
        again = [number for number in given if tries[number] < TRIES]
        for number in [number for number in given if tries[number] >= TRIES]:
            given.remove(number)
            yield _alone(plan, number)


def _as_ready(
    submit: Callable[[int], Future[_Computed]], numbers: Iterator[int], workers: int
) -> Generator[_Computed, None, None]:
    """Results in the order in which they become ready; no more numbers are taken than the workers can work on."""
    pending = {submit(number) for number in islice(numbers, AHEAD * workers)}
    while pending:
        ready, pending = wait(pending, return_when=FIRST_COMPLETED)
        for future in ready:
            found = future.result()
            pending |= {submit(number) for number in islice(numbers, 1)}
            yield found


def _noting(numbers: Iterable[int], given: list[int]) -> Iterator[int]:
    """Numbers as they are taken, each noted."""
    for number in numbers:
        given.append(number)
        yield number


def _alone(plan: SweepPlan, number: int) -> Chunk:
    """A chunk computed by a process of its own; failed if that ends too."""
    from loky.process_executor import BrokenProcessPool

    with _processes(1) as pool:
        try:
            return pool.submit(_compute, plan, number).result()[0]
        except BrokenProcessPool as problem:
            words = f"the process that computed it ended ({_endings(problem)}), {TRIES + 1} times"
            return failed_chunk(plan, number, words)


@contextmanager
def _processes(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Worker processes that ignore Ctrl-C, and that end with this process or at the end of the block, even during a chunk."""
    from loky.backend import get_context
    from loky.process_executor import BrokenProcessPool, ProcessPoolExecutor

    with ExitStack() as ending:
        with _interrupts_blocked():  # an executor that is half made would leave semaphores behind
            theirs, ours = get_context("loky").Pipe(duplex=False)
            ending.callback(ours.close)
            ending.callback(theirs.close)
            pool = ProcessPoolExecutor(workers, initializer=_end_with, initargs=(theirs,), env=_ENVIRONMENT)
            ending.callback(pool.shutdown, kill_workers=True)
            started = pool.submit(os.getpid)
            wait([started], timeout=STARTING)  # a worker that is ended while it starts says so at length
        try:
            started.result()
        except BrokenProcessPool as problem:
            words = f"worker processes end before they begin ({_endings(problem)}); try --threads"
            raise CaromError(words) from None
        yield pool


def _endings(problem: Exception) -> str:
    """How processes ended, from what loky says of it."""
    return str(problem).rpartition("{")[2].partition("}")[0] or "no exit code"


def _compute(plan: SweepPlan, number: int) -> tuple[Chunk, list[Warning | str]]:
    """Compute a chunk in a worker; return what it warned of too."""
    with warnings.catch_warnings(record=True) as heard:
        chunk = compute_chunk(plan, number)
    return chunk, [each.message for each in heard]


def _end_with(pipe: connection.Connection) -> None:
    """Let a worker end at once, even during a chunk, when the process that stores the chunks has ended."""

    def watch() -> None:
        try:
            pipe.recv()
        except (EOFError, OSError):
            os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Let processes started inside ignore Ctrl-C; this process handles it, afterwards if it comes meanwhile."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    _start_trackers()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    came: list[int] = []
    # The signal may reach another thread, as that of a store, and interrupt this one all the same.
    ours = threading.current_thread() is threading.main_thread()
    handler = signal.signal(signal.SIGINT, lambda number, _: came.append(number)) if ours else None
    try:
        yield
    finally:
        if handler is not None:
            signal.signal(signal.SIGINT, handler)
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        if came:
            signal.raise_signal(signal.SIGINT)


def _start_trackers() -> None:
    """Start the processes that free what interrupted ones leave behind, without a word: nobody has to do anything about it.

    Otherwise they start with the first worker and unblock the signal.
    """
    from multiprocessing import resource_tracker

    from loky.backend import resource_tracker as loky_tracker

    before = os.environ.get("PYTHONWARNINGS")
    os.environ["PYTHONWARNINGS"] = ",".join(filter(None, (before, "ignore:resource_tracker:UserWarning")))
    for tracker in (resource_tracker, loky_tracker):
        tracker.ensure_running()
    if before is None:
        del os.environ["PYTHONWARNINGS"]
    else:
        os.environ["PYTHONWARNINGS"] = before
