"""Progress of long functions: reports, and a bar."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import wraps
from typing import TYPE_CHECKING, ParamSpec, TypeVar

if TYPE_CHECKING:
    import rich.progress
    from rich.console import Console

Arguments = ParamSpec("Arguments")
Value = TypeVar("Value")

PATIENCE = 0.7
"""Seconds before a bar appears."""
_CLOCK = len("0:00:00")
_SETTLED = 1.0
"""Seconds after which a rate means something."""


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
"""What the argument ``progress`` may be: ``True`` shows a bar, a callable receives each :class:`Progress`."""


def shows_progress(function: Callable[Arguments, Value]) -> Callable[Arguments, Value]:
    """Let ``progress=True`` of a function show a bar on the error stream, or in the notebook."""

    @wraps(function)
    def wrapper(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Value:
        if kwargs.get("progress") is not True:
            return function(*args, **kwargs)
        with bar("") as shown:
            kwargs["progress"] = shown
            return function(*args, **kwargs)

    return wrapper


@contextmanager
def bar(step: str, console: Console | None = None) -> Iterator[Reporter]:
    """Show a bar that appears if the work takes longer than a moment; the reporter moves it.

    `step` is the first step, in words.  By default the console is the error stream, or the notebook.
    """
    shown = _bar(console)
    task = shown.add_task(step, total=1.0)
    timer = threading.Timer(PATIENCE, shown.start)
    timer.daemon = True
    timer.start()
    try:
        yield Reporter(lambda report: shown.update(task, completed=report.share, description=report.step))
    finally:
        timer.cancel()
        timer.join()
        shown.stop()


def _bar(console: Console | None) -> rich.progress.Progress:
    """Return a bar with clock, share, rate, time left and words; a narrow terminal shortens the bar and the words."""
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar
    from rich.table import Column
    from rich.text import Text

    class Words(TextColumn):
        """The numbers, which go on while nothing is reported, and the words."""

        def render(self, task: rich.progress.Task) -> Text:
            return Text(_told(task.completed, task.elapsed or 0.0, task.description))

    clock = TimeElapsedColumn(table_column=Column(no_wrap=True, min_width=_CLOCK))
    columns = (BarColumn(bar_width=30), clock, Words("", table_column=Column(overflow="ellipsis", no_wrap=True)))
    return Bar(*columns, console=console or Console(stderr=True), transient=True)


def _told(share: float, elapsed: float, words: str) -> str:
    """Write share, rate and time left before the words; words that say themselves what is left stay alone.

    The rate is that since the beginning.  It is not known before anything is done.
    """
    if share <= 0.0 or " left" in words:
        return words
    numbers = f"{100.0 * share:.0f} %"
    if elapsed >= _SETTLED and share < 1.0:
        rate = 100.0 * share / elapsed
        numbers += f", {rate:.2g} %/s, {duration_words((1.0 - share) / share * elapsed)} left"
    return f"{numbers}: {words}"


def duration_words(seconds: float) -> str:
    """Write a time, with a unit that suits it."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    if seconds < 5400:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.1f} h" if seconds < 172_800 else f"{seconds / 86_400:.1f} days"
