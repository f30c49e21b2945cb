"""Chunks computed on this machine, by processes or by threads."""

from __future__ import annotations

import os
import queue
import signal
import threading
import warnings
from collections import Counter, deque
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import chain, islice
from multiprocessing import connection
from multiprocessing.process import BaseProcess
from types import FrameType

from carom.base.outcome import CaromError
from carom.sweeps.chunk import Chunk, compute_chunk, failed_chunk
from carom.sweeps.plan import SweepPlan

AHEAD = 2
"""Chunks assigned to a worker at a time: one to compute, and one more so that it need not wait."""
TRIES = 2
"""Number of processes that end during a chunk until it counts as failed; one may have been killed from outside."""
_FALSE_STARTS = 3
_ENVIRONMENT = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""Environment of a worker: linear algebra uses one thread."""


def on_threads(plan: SweepPlan, numbers: Iterator[int], workers: int) -> Generator[Chunk, None, None]:
    """Compute chunks on threads of this process, and yield them in the order in which they become ready.

    The kernels release Python's global interpreter lock; Python code runs in one thread at a time.  Only as
    many numbers are taken as the workers can work on.
    """
    pool = ThreadPoolExecutor(workers, thread_name_prefix="carom-sweep")
    pending: set[Future[Chunk]] = set()
    try:
        pending |= {pool.submit(compute_chunk, plan, number) for number in islice(numbers, AHEAD * workers)}
        while pending:
            ready, pending = wait(pending, return_when=FIRST_COMPLETED)
            pending |= {pool.submit(compute_chunk, plan, number) for number in islice(numbers, len(ready))}
            for future in ready:
                yield future.result()
    finally:
        pool.shutdown(cancel_futures=True)


def on_processes(plan: SweepPlan, numbers: Iterator[int], workers: int) -> Generator[Chunk, None, None]:
    """Compute chunks in worker processes, and yield them in the order in which they become ready.

    Only as many numbers are taken as the workers can work on.  A process that ends unexpectedly (killed, out of
    memory) is replaced, and its chunk is tried once more; a :class:`~carom.base.outcome.CaromError` if processes end before
    they begin.  loky starts them without running the calling script again, so it needs no ``if __name__ ==
    "__main__"``.
    """
    pool = _Pool(plan, numbers, workers)
    try:
        yield from pool.chunks()
    finally:
        pool.dismiss()


@dataclass(eq=False)
class _Worker:
    process: BaseProcess
    pipe: connection.Connection
    ready: bool = False
    given: deque[int] = field(default_factory=deque)


class _Pool:
    """Worker processes, each with a pipe: it receives numbers of chunks and sends chunks."""

    def __init__(self, plan: SweepPlan, numbers: Iterator[int], size: int) -> None:
        self.plan, self.numbers = plan, numbers
        self.tries: Counter[int] = Counter()
        self.false_starts = 0
        self.workers: list[_Worker] = []
        first = list(islice(numbers, size))
        self.numbers = chain(first, numbers)
        for _ in first:
            self._start_worker()

    def chunks(self) -> Iterator[Chunk]:
        """Yield all chunks as they become ready."""
        while any(worker.given or not worker.ready for worker in self.workers):
            pipes = {worker.pipe: worker for worker in self.workers}
            for pipe in connection.wait(list(pipes)):
                worker = pipes[pipe]  # type: ignore[index]
                try:
                    told = worker.pipe.recv()
                except (EOFError, OSError):
                    yield from self._replace(worker)
                    continue
                if isinstance(told, Warning):
                    warnings.warn(told, stacklevel=1)  # a warning that several workers send is shown once
                    continue
                if isinstance(told, Chunk):
                    worker.given.remove(told.number)
                worker.ready = True
                self._assign(worker)
                if isinstance(told, Chunk):
                    yield told

    def dismiss(self) -> None:
        """End all processes."""
        for worker in self.workers:
            worker.process.terminate()
        for worker in self.workers:
            worker.process.join()
            worker.pipe.close()

    def _start_worker(self) -> None:
        from loky.backend import get_context

        context = get_context("loky")
        ours, theirs = context.Pipe()
        process = context.Process(
            target=_serve, args=(self.plan, theirs), daemon=True, name="carom-sweep", env=_ENVIRONMENT
        )
        with _interrupts_blocked():
            process.start()
        theirs.close()
        self.workers.append(_Worker(process, ours))

    def _assign(self, worker: _Worker) -> None:
        for number in islice(self.numbers, AHEAD - len(worker.given)):
            worker.given.append(number)
            try:
                worker.pipe.send(number)
            except OSError:  # the process has ended: its pipe reports this in chunks()
                return

    def _replace(self, worker: _Worker) -> Iterator[Chunk]:
        """Replace a worker process that has ended, and assign its chunks to others."""
        worker.process.join()
        worker.pipe.close()
        self.workers.remove(worker)
        self.false_starts = 0 if worker.ready else self.false_starts + 1
        if self.false_starts >= _FALSE_STARTS:
            raise CaromError(f"worker processes end before they begin ({_ending(worker.process)}); try --threads")
        again = list(worker.given)
        if again:
            self.tries[again[0]] += 1
            if self.tries[again[0]] >= TRIES:
                words = f"the process that computed it ended ({_ending(worker.process)}), {TRIES} times"
                yield failed_chunk(self.plan, again.pop(0), words)
        self.numbers = chain(again, self.numbers)
        self._start_worker()


def _ending(process: BaseProcess) -> str:
    code = process.exitcode or 0
    return f"signal {-code}" if code < 0 else f"exit code {code}"


def _serve(plan: SweepPlan, pipe: connection.Connection) -> None:
    """Compute the chunks requested through the pipe until it is closed; send the warnings of each, then the chunk."""
    numbers: queue.SimpleQueue[int] = queue.SimpleQueue()
    threading.Thread(target=_receive, args=(pipe, numbers), daemon=True).start()
    try:
        pipe.send("ready")
        with warnings.catch_warnings(record=True) as heard:
            while True:
                chunk = compute_chunk(plan, numbers.get())
                while heard:
                    pipe.send(heard.pop(0).message)
                pipe.send(chunk)
    except OSError:
        return


def _receive(pipe: connection.Connection, numbers: queue.SimpleQueue[int]) -> None:
    """Receive numbers; exit at once, even during a chunk, when the process that stores the chunks has ended."""
    try:
        while True:
            numbers.put(pipe.recv())
    except (EOFError, OSError):
        os._exit(1)


@contextmanager
def _put_off() -> Iterator[None]:
    """Defer a Ctrl-C that another thread receives: the signal mask of this thread does not block its handler here."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard: list[tuple[int, FrameType | None]] = []
    handler = signal.signal(signal.SIGINT, lambda *what: heard.append(what))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
    if heard and callable(handler):
        handler(*heard[0])


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Let processes started inside ignore Ctrl-C; this process handles it, afterwards if it comes meanwhile."""
    if not hasattr(signal, "pthread_sigmask"):
        with _put_off():
            yield
        return
    from multiprocessing import resource_tracker

    from loky.backend import resource_tracker as loky_tracker

    for tracker in (resource_tracker, loky_tracker):
        tracker.ensure_running()  # otherwise it starts with the first process and unblocks the signal
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        with _put_off():
            yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
