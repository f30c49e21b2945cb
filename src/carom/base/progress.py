"""Progress of long functions: reports, and a bar."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import wraps
from multiprocessing import current_process
from threading import Timer
from typing import TYPE_CHECKING, ParamSpec, TypeVar

if TYPE_CHECKING:
    import rich.progress
    from rich.console import Console

Arguments = ParamSpec("Arguments")
Value = TypeVar("Value")

PATIENCE = 0.7
"""Seconds before a bar appears that was asked for."""
LONG = 2.0
"""Seconds before one appears that was not."""
_CLOCK, _WIDTH = len("0:00:00"), 20
_TAKEN = _WIDTH + len("100%") + 2 * _CLOCK + 4
"""Columns of a terminal that bar, share and both clocks take."""


@dataclass(frozen=True)
class Progress:
    """The progress of a function that takes long.

    Attributes
    ----------
    share : float
        Share of the work done, 0 to 1.
    step : str
        What is done now, in words.
    """

    share: float
    step: str


@dataclass(frozen=True)
class Reporter:
    """Reports the progress of a function, or of a part of one.

    Attributes
    ----------
    send : callable or None
        Receives each :class:`Progress`.
    low, high : float
        Shares of the whole at which this part begins and ends.
    step : str
        What is done, for reports that do not say so themselves.
    """

    send: Callable[[Progress], object] | None = None
    low: float = 0.0
    high: float = 1.0
    step: str = ""

    @classmethod
    def of(cls, wanted: ShowProgress, step: str) -> Reporter:
        """Return the reporter of a function; `step` says what it does, unless its caller has said so."""
        if isinstance(wanted, Reporter):
            return cls(wanted.send, wanted.low, wanted.high, wanted.step or step)
        return cls(wanted if callable(wanted) else None, step=step)

    def __call__(self, share: float, step: str = "") -> None:
        """Report the share of this part that is done, 0 to 1."""
        if self.send is not None:
            self.send(Progress(self.low + share * (self.high - self.low), step or self.step))

    def part(self, low: float, high: float, step: str = "") -> Reporter:
        """Return the reporter of a part that begins and ends at these shares of this one."""
        width = self.high - self.low
        return Reporter(self.send, self.low + low * width, self.low + high * width, step or self.step)


ShowProgress = Callable[[Progress], object] | Reporter | bool | None
"""What the argument ``progress`` may be: ``None`` shows a bar where someone watches and it takes long (:func:`shows_progress`),
``True`` always, ``False`` never; a callable receives each :class:`Progress`."""

_inside: ContextVar[bool] = ContextVar("carom_progress", default=False)
"""Whether a function that was called before tells the progress of all, or was asked not to."""


def shows_progress(function: Callable[Arguments, Value]) -> Callable[Arguments, Value]:
    """Let a function show a bar on the error stream: with ``progress=True``, and by itself if it takes long.

    By itself it does so where someone watches: if the error stream is a terminal.  ``progress=False`` prevents
    it, and ``CAROM_PROGRESS=0`` in the environment does for all functions.
    """

    @wraps(function)
    def wrapper(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Value:
        wanted = kwargs.get("progress")
        if wanted is True or (wanted is None and _watched()):
            step = function.__name__.replace("_", " ")
            with bar(step, patience=LONG if wanted is None else PATIENCE) as shown:
                kwargs["progress"] = shown
                return function(*args, **kwargs)
        before = _inside.set(True)
        try:
            return function(*args, **kwargs)
        finally:
            _inside.reset(before)

    return wrapper


def _watched() -> bool:
    """Whether someone sees a bar that was not asked for: nobody does in other threads and processes, and where output is piped."""
    # Asked before each call of a function that takes long at most: what is quickly stated comes first.
    if _inside.get() or sys.stderr is None or not sys.stderr.isatty():
        return False
    if os.environ.get("CAROM_PROGRESS") == "0":
        return False
    return current_process().name == "MainProcess" and threading.current_thread() is threading.main_thread()


@contextmanager
def bar(step: str, console: Console | None = None, patience: float | None = None) -> Iterator[Reporter]:
    """Show a bar that appears if the work takes longer than a moment; the reporter moves it, and at the end it vanishes.

    `step` is the first step, in words.  By default the console is the error stream.
    """
    late = _LateBar(step, console, PATIENCE if patience is None else patience)
    before = _inside.set(True)
    try:
        yield Reporter(late.tell)
    finally:
        _inside.reset(before)
        late.end()


class _LateBar:
    """A bar that is made when it appears, after some seconds; until then it only knows the newest report."""

    def __init__(self, step: str, console: Console | None, patience: float) -> None:
        self._newest, self._console, self._began = Progress(0.0, step), console, time.monotonic()
        self._lock, self._ended = threading.Lock(), False
        self._shown: rich.progress.Progress | None = None
        self._timer = Timer(patience, self._appear)
        self._timer.daemon = True
        self._timer.start()

    def _appear(self) -> None:
        with self._lock:
            if not self._ended:
                self._shown = _bar(self._console)
                self._shown.add_task("", total=1.0)
                self._shown.tasks[0].start_time = self._began
                self._shown.start()
                self._show()

    def _show(self) -> None:
        if self._shown is not None:
            task, report = self._shown.tasks[0].id, self._newest
            self._shown.update(task, completed=report.share, description=report.step)

    def tell(self, report: Progress) -> None:
        with self._lock:
            self._newest = report
            self._show()

    def end(self) -> None:
        self._timer.cancel()
        with self._lock:
            self._ended = True
            if self._shown is not None:
                self._shown.stop()


def _bar(console: Console | None) -> rich.progress.Progress:
    """Return a bar with share, clock, time left and words; a narrow terminal shortens the words."""
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar
    from rich.table import Column

    clock = Column(no_wrap=True, min_width=_CLOCK)
    screen = console or Console(stderr=True)
    room = Column(overflow="ellipsis", no_wrap=True, max_width=max(screen.width - _TAKEN, 1))
    words = TextColumn("{task.description}", markup=False, table_column=room)
    elapsed, remaining = TimeElapsedColumn(table_column=clock), TimeRemainingColumn(table_column=clock.copy())
    columns = (
        BarColumn(bar_width=_WIDTH),
        TaskProgressColumn(table_column=Column(no_wrap=True)),
        elapsed,
        remaining,
        words,
    )
    return Bar(*columns, console=screen, transient=True)


def duration_words(seconds: float) -> str:
    """Write a time, with a unit that suits it."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    if seconds < 5400:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h" if seconds < 172_800 else f"{seconds / 86_400:.1f} days"
