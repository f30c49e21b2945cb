"""Jobs in a thread beside the page: the newest of a kind replaces older ones, which are dropped or interrupted."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

from carom.base.progress import Progress


class SupersededError(Exception):
    """Raised inside work that is no longer wanted."""


@dataclass(frozen=True)
class Job:
    """A job for a :class:`Worker`.

    Attributes
    ----------
    work : callable
        Called in the thread of the worker with a callable that takes :class:`~carom.base.progress.Progress`; it raises
        :class:`SupersededError` where the work is no longer wanted.
    done : callable
        Receives the result, or the exception, in that thread; nothing if the work was interrupted.  It may raise
        :class:`SupersededError` too.
    pause : float
        Seconds for which the worker waits for a newer or more urgent job before it begins with this one.
    """

    work: Callable[[Callable[[Progress], None]], object]
    done: Callable[[Any], None]
    pause: float = 0.0


class Worker:
    """A thread that does one job after another; of each kind only the newest.

    Parameters
    ----------
    kinds : sequence of str
        Kinds of jobs, the most urgent first.
    tell : callable
        Receives kind and progress of the work being done, in the thread of the worker.
    """

    def __init__(
        self, kinds: Sequence[str], tell: Callable[[str, Progress], None] = lambda kind, progress: None
    ) -> None:
        self._kinds, self._tell = tuple(kinds), tell
        self._waiting: dict[str, Job] = {}
        self._changed = threading.Condition()
        self._stale = threading.Event()
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="carom explore", daemon=True)
        self._thread.start()

    def submit(self, kind: str, job: Job) -> None:
        """Queue a job behind the more urgent ones; it replaces a waiting one of its kind."""
        with self._changed:
            self._waiting[kind] = job
            self._changed.notify()

    def drop(self) -> None:
        """Drop everything that waits, and interrupt the work being done."""
        with self._changed:
            self._waiting.clear()
            self._stale.set()

    def close(self) -> None:
        """End the thread, after the work being done has noticed that it is interrupted."""
        with self._changed:
            self._closed = True
            self._changed.notify()
        self.drop()

    def join(self, seconds: float | None = None) -> bool:
        """Wait for the end of the thread; return whether it has ended."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def _next(self) -> tuple[str, Job] | None:
        with self._changed:
            while True:
                self._changed.wait_for(lambda: self._waiting or self._closed)
                if self._closed:
                    return None
                kind, job = self._most_urgent()
                if not self._changed.wait_for(partial(self._is_overtaken, job), job.pause):
                    self._stale.clear()
                    del self._waiting[kind]
                    return kind, job

    def _most_urgent(self) -> tuple[str, Job]:
        kind = next(kind for kind in self._kinds if kind in self._waiting)
        return kind, self._waiting[kind]

    def _is_overtaken(self, job: Job) -> bool:
        return self._closed or not self._waiting or self._most_urgent()[1] is not job

    def _run(self) -> None:
        while (found := self._next()) is not None:
            kind, job = found

            def tell(progress: Progress, kind: str = kind) -> None:
                if self._stale.is_set():
                    raise SupersededError
                self._tell(kind, progress)

            with suppress(SupersededError):
                result = self._result(job, tell)
                if not self._stale.is_set():
                    job.done(result)

    def _result(self, job: Job, tell: Callable[[Progress], None]) -> object:
        try:
            return job.work(tell)
        except SupersededError:
            raise
        except Exception as problem:  # noqa: BLE001  (handed to the caller)
            return problem
