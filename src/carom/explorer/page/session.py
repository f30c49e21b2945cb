"""The session of one page: it takes requests, has the work done beside the page, and sends the answers."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

from carom.explorer.background import Job, Worker
from carom.explorer.computing.exports import Origin
from carom.explorer.page.kind import Message, Shown, Work
from carom.explorer.page.kinds import kind_of
from carom.explorer.page.view import View, read_kick, read_view
from carom.outcome import CaromError, InputError
from carom.progress import Progress

PAUSE = 0.06
"""Seconds without a further step after which, while a slider is dragged, more than the most urgent is computed."""
QUIET = 0.15
"""Seconds between two reports of progress."""

Answer = Callable[[str, Any], None]
"""Receives the name of an answer and its value, in any thread."""


@dataclass(frozen=True)
class _Telling:
    """What work tells on its way: :class:`carom.explorer.page.kind.Tell`."""

    report: Callable[[Progress], None]
    show: Callable[[Message], None]

    def __call__(self, progress: Progress) -> None:
        self.report(progress)


class Session:
    """State of one page.

    Parameters
    ----------
    origin : Origin
        The machine with which it begins.
    answer : callable
        Hands an answer to the page.
    ready : threading.Event
        Set when the kernels are compiled.
    wanted : collection of str, optional
        Answers of what takes long that are wanted; by default all.
    """

    def __init__(
        self, origin: Origin, answer: Answer, ready: threading.Event, wanted: Collection[str] | None = None
    ) -> None:
        self.kind, self._answer, self._ready = kind_of(origin), answer, ready
        self._wanted = {task.answer for task in self.kind.long.values()} if wanted is None else set(wanted)
        self._shown = Shown(0, self.kind.subject({}), {}, self.kind.along, View())
        self._reported = 0.0
        self._left: dict[str, Work] = {}
        quick, apart = self.kind.quick, self.kind.apart
        self._quick = Worker([name for name in quick if name not in apart])
        self._apart = Worker(apart) if apart else self._quick
        self._tasks = {**self.kind.long, **self.kind.wished}
        self._long = Worker(tuple(self._tasks), self._report)

    def close(self) -> None:
        """End all work of the page."""
        for worker in (self._quick, self._apart, self._long):
            worker.close()

    def show(self, request: Mapping[str, Any]) -> None:
        """Show another machine; see :class:`carom.explorer.page.models.Requests`."""
        asked = {str(name): str(text) for name, text in dict(request.get("settings", {})).items()}
        number, held = int(request.get("number", 0)), bool(request.get("held", False))
        settings, subject, problem = self._usable(asked)
        before, view = self._shown, read_view(request.get("view"))
        if (
            problem is not None
            and before.number
            and (settings, held, view) == (before.settings, before.held, before.view)
        ):
            # Nothing is to be shown anew, so what is being computed goes on.
            self._reply(number, problem)
            return
        along = str(request.get("along") or before.along)
        self._shown = Shown(
            number, subject, settings, along if along in self.kind.controls else before.along, view, held
        )
        self._reply(number, problem)
        self._long.drop()
        if self._apart is not self._quick:
            self._apart.drop()
        self._left = {}
        first, *others = self.kind.quick
        self._ask(first, self.kind.quick[first], None if held else self._finish)
        for name in others:
            self._ask(name, self.kind.quick[name], pause=PAUSE if held else 0.0)

    def _usable(self, asked: Mapping[str, str]) -> tuple[Mapping[str, str], Any, InputError | None]:
        """Settings with what cannot be used left as it is shown, their machine, and what cannot be used."""
        try:
            return asked, self.kind.subject(asked), None
        except InputError as problem:
            refused, shown = {one.field for one in problem.errors}, self._shown
            kept = {name: text for name, text in asked.items() if name not in refused}
            kept.update({name: shown.settings[name] for name in asked if name in refused & shown.settings.keys()})
            try:
                return kept, self.kind.subject(kept), problem
            except InputError:  # values that are refused only together
                return shown.settings, shown.subject, problem

    def _reply(self, number: int, problem: InputError | None) -> None:
        """Say which machine is shown after a request, and what of it could not be used."""
        shown = self._shown
        values = self.kind.values(shown.subject)
        reply = {"number": number, "shown": shown.number, "values": values, "text": "", "names": []}
        if problem is not None:
            reply.update(text=str(problem), names=[one.field for one in problem.errors])
        self._answer("reply", reply)

    def _finish(self) -> None:
        """Start everything that takes longer than a moment."""
        self._answer("exports", self.kind.exports(self._shown))
        self._left = {name: task.work for name, task in self.kind.long.items() if task.answer in self._wanted}
        self.resume()

    def kick(self, request: Mapping[str, Any]) -> None:
        """Show the motion after another disturbance; see :class:`carom.explorer.page.models.Requests`."""
        kick, slot = read_kick(request.get("first"), request.get("second")), request.get("slot")
        if kick is None or not isinstance(slot, int) or slot not in range(len(self.kind.slots)):
            return
        kicks = list(self.kind.kicks(self._shown))
        kicks[slot] = kick
        self._shown = replace(self._shown, view=replace(self._shown.view, kicks=tuple(kicks), active=slot))
        name = self.kind.slots[slot]
        self._ask(name, self.kind.quick[name])
        if request.get("chosen"):
            self._answer("exports", self.kind.exports(self._shown))

    def wish(self, request: Mapping[str, Any]) -> None:
        """Begin what takes long and is done only where it is asked for, by its ``name``."""
        name = str(request.get("name"))
        if name in self.kind.wished:
            self._left[name] = self.kind.wished[name].work
            self._ask(name, self._left[name])

    def cancel(self) -> None:
        """Interrupt what takes long."""
        self._long.drop()
        self._answer("state", {"kind": "cancelled"})

    def resume(self) -> None:
        """Start again what takes long and has not been done for the machine shown."""
        for name, work in tuple(self._left.items()):
            self._ask(name, work)
        if not self._left:
            self._answer("state", {"kind": "idle"})

    def _ask(self, name: str, work: Work, afterwards: Callable[[], None] | None = None, pause: float = 0.0) -> None:
        """Have work done for the machine shown now and its result sent; then, if that is still shown, call `afterwards`."""
        shown, task = self._shown, self._tasks.get(name)
        answer = name if task is None else task.answer

        def send(message: Message) -> None:
            self._answer(answer, {**message, "number": shown.number})

        def run(report: Callable[[Progress], None]) -> Any:
            if name not in self.kind.early:
                self._wait_for_kernels()
            if task is not None:
                self._answer("state", {"kind": "working", "words": task.words, "share": 0.0})
            return work(shown, _Telling(report, send))

        def done(result: Any) -> None:
            if isinstance(result, CaromError):
                send({"refused": str(result)})
            elif isinstance(result, Exception):
                send({"refused": f"unexpected {type(result).__name__}: {result}"})
            else:
                send(result)
            if self._shown.number == shown.number:
                self._left.pop(name, None)
            if name == tuple(self.kind.long)[-1] or name in self.kind.wished:
                self._answer("state", {"kind": "idle"})
            if afterwards is not None and self._shown.number == shown.number:
                afterwards()

        worker = self._long if task is not None else self._apart if name in self.kind.apart else self._quick
        worker.submit(name, Job(run, done, pause))

    def _wait_for_kernels(self) -> None:
        if not self._ready.is_set():
            self._answer("state", {"kind": "compiling"})
            self._ready.wait()
            self._answer("state", {"kind": "idle"})

    def _report(self, name: str, progress: Progress) -> None:
        now = time.monotonic()
        if now - self._reported > QUIET:
            self._reported = now
            words = progress.step or self._tasks[name].words
            self._answer("state", {"kind": "working", "words": words, "share": progress.share})
