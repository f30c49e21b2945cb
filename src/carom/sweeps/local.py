"""Chunks computed on this machine, by processes or by threads."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections import Counter, deque
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import chain, islice
from multiprocessing import connection
from multiprocessing.context import SpawnProcess
from types import FrameType

from carom.outcome import CaromError
from carom.sweeps.chunk import Chunk, compute_chunk, failed_chunk
from carom.sweeps.plan import SweepPlan

__all__ = ["AHEAD", "on_processes", "on_threads"]

AHEAD = 2
"""Chunks that a worker has been given: one to compute, and one so that it need not wait for the next."""
TRIES = 2
"""Processes that a chunk may end before it counts as failed; any of them may have been stopped from outside."""
_FALSE_STARTS = 3
_SINGLE = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


def on_threads(plan: SweepPlan, numbers: Iterator[int], workers: int) -> Generator[Chunk, None, None]:
    """Compute chunks on threads of this process, in the order in which they become ready.

    The kernels run without Python's lock; what is done in Python takes turns.

    Parameters
    ----------
    plan : SweepPlan
    numbers : iterator of int
        Taken one by one: as many as can be worked on.
    workers : int
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
    """Compute chunks in processes of their own, in the order in which they become ready.

    A process that ends on its own - killed, out of memory - is replaced, and its chunk is tried once more.

    Parameters
    ----------
    plan : SweepPlan
    numbers : iterator of int
        Taken one by one: as many as can be worked on.
    workers : int

    Raises
    ------
    CaromError
        Processes do not even start.
    """
    crew = _Crew(plan, numbers, workers)
    try:
        yield from crew.chunks()
    finally:
        crew.dismiss()


@dataclass(eq=False)
class _Worker:
    process: SpawnProcess
    pipe: connection.Connection
    ready: bool = False
    given: deque[int] = field(default_factory=deque)


class _Crew:
    """Worker processes, each with a pipe: numbers of chunks go in, chunks come out."""

    def __init__(self, plan: SweepPlan, numbers: Iterator[int], size: int) -> None:
        self.plan, self.numbers = plan, numbers
        self.tries: Counter[int] = Counter()
        self.false_starts = 0
        self.workers: list[_Worker] = []
        first = list(islice(numbers, size))
        self.numbers = chain(first, numbers)
        for _ in first:
            self._hire()

    def chunks(self) -> Iterator[Chunk]:
        """All chunks."""
        while any(worker.given or not worker.ready for worker in self.workers):
            pipes = {worker.pipe: worker for worker in self.workers}
            for pipe in connection.wait(list(pipes)):
                worker = pipes[pipe]  # type: ignore[index]
                try:
                    told = worker.pipe.recv()
                except (EOFError, OSError):
                    yield from self._lost(worker)
                    continue
                if isinstance(told, Chunk):
                    worker.given.remove(told.number)
                worker.ready = True
                self._give(worker)
                if isinstance(told, Chunk):
                    yield told

    def dismiss(self) -> None:
        """End all processes."""
        for worker in self.workers:
            worker.process.terminate()
        for worker in self.workers:
            worker.process.join()
            worker.pipe.close()

    def _hire(self) -> None:
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        process = context.Process(target=_serve, args=(self.plan, theirs), daemon=True, name="carom-sweep")
        with _inherited():
            process.start()
        theirs.close()
        self.workers.append(_Worker(process, ours))

    def _give(self, worker: _Worker) -> None:
        for number in islice(self.numbers, AHEAD - len(worker.given)):
            worker.given.append(number)
            try:
                worker.pipe.send(number)
            except OSError:  # it has ended, as its pipe will tell
                return

    def _lost(self, worker: _Worker) -> Iterator[Chunk]:
        """A process has ended: what it was given goes to others."""
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
        self._hire()


def _ending(process: SpawnProcess) -> str:
    code = process.exitcode or 0
    return f"signal {-code}" if code < 0 else f"exit code {code}"


def _serve(plan: SweepPlan, pipe: connection.Connection) -> None:
    """Compute what comes through the pipe until its other end is closed."""
    threading.Thread(target=_end_with_parent, daemon=True).start()
    try:
        pipe.send("ready")
        while True:
            pipe.send(compute_chunk(plan, pipe.recv()))
    except (EOFError, OSError):
        return


def _end_with_parent() -> None:
    """End at once, in the middle of a chunk, when the process that would have stored it is gone."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


@contextmanager
def _put_off() -> Iterator[None]:
    """Put off a Ctrl-C that another thread receives, which a mask of this one does not keep from being handled here."""
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
def _inherited() -> Iterator[None]:
    """What processes started here inherit: one thread of linear algebra, and no ear for Ctrl-C, which is ours to treat.

    A Ctrl-C in the meantime is not lost: it is heard when they have started.
    """
    before: dict[str, str | None] = {name: os.environ.get(name) for name in _SINGLE}
    os.environ.update(dict.fromkeys(_SINGLE, "1"))
    can_block = hasattr(signal, "pthread_sigmask")
    if can_block:
        from multiprocessing import resource_tracker

        resource_tracker.ensure_running()  # else started with the first process, and unblocks what is blocked here
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT}) if can_block else set()
    try:
        with _put_off():
            yield
    finally:
        if can_block:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
