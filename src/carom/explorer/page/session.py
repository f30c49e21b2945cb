"""The session of one page: it takes requests, has the work done beside the page, and sends the answers."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import Any

from carom.base.outcome import CaromError, InputError
from carom.base.progress import Progress
from carom.explorer.background import Job, Worker
from carom.explorer.computing.exports import Origin
from carom.explorer.page.messages import Message
from carom.explorer.page.questions import Questions, Shown, Subject, Work
from carom.explorer.page.view import SLOTS, View, read_kick, read_view

PAUSE = 0.06
"""Seconds without a further step after which, while a slider is dragged, more than the most urgent is computed."""
QUIET = 0.15
"""Seconds between two reports of progress."""

FIRST, WAITED_FOR = "levitating", "basin"
"""The answer that is there at once and needs no kernels, and that for which a dragged slider waits."""

Answer = Callable[[str, object], None]
"""Receives the name of an answer and its value, in any thread."""


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
        self.questions, self._answer, self._ready = Questions(origin), answer, ready
        self._wanted = {task.answer for task in self.questions.long.values()} if wanted is None else set(wanted)
        self._shown = Shown(0, self.questions.subject({}), {}, self.questions.along, View())
        self._reported = 0.0
        self._left: dict[str, Work] = {}
        self._first = Worker([FIRST])
        # What may take a second does not hold up the first answer.
        self._quick = Worker([name for name in self.questions.quick if name != FIRST])
        self._tasks = {**self.questions.long, **self.questions.on_request}
        self._long = Worker(tuple(self._tasks), self._report)

    def close(self) -> None:
        """End all work of the page."""
        for worker in (self._first, self._quick, self._long):
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
            number, subject, settings, along if along in self.questions.controls else before.along, view, held
        )
        self._reply(number, problem)
        self._long.drop()
        self._quick.drop()
        self._left = {}
        for name, work in self.questions.quick.items():
            urgent = name in (FIRST, WAITED_FOR)
            afterwards = self._finish if name == WAITED_FOR and not held else None
            self._ask(name, work, afterwards, PAUSE if held and not urgent else 0.0)

    def _usable(self, asked: Mapping[str, str]) -> tuple[Mapping[str, str], Subject, InputError | None]:
        """Settings with what cannot be used left as it is shown, their machine, and what cannot be used."""
        try:
            return asked, self.questions.subject(asked), None
        except InputError as problem:
            refused, shown = {one.field for one in problem.errors}, self._shown
            kept = {name: text for name, text in asked.items() if name not in refused}
            kept.update({name: shown.settings[name] for name in asked if name in refused & shown.settings.keys()})
            try:
                return kept, self.questions.subject(kept), problem
            except InputError:  # values that are refused only together
                return shown.settings, shown.subject, problem

    def _reply(self, number: int, problem: InputError | None) -> None:
        """Say which machine is shown after a request, and what of it could not be used."""
        shown = self._shown
        values = self.questions.values(shown.subject)
        reply = {"number": number, "shown": shown.number, "values": values, "text": "", "names": []}
        if problem is not None:
            reply.update(text=str(problem), names=[one.field for one in problem.errors])
        self._answer("reply", reply)

    def _finish(self) -> None:
        """Start everything that takes longer than a moment."""
        self._answer("exports", self.questions.exports(self._shown))
        self._left = {name: task.work for name, task in self.questions.long.items() if task.answer in self._wanted}
        self.resume()

    def kick(self, request: Mapping[str, object]) -> None:
        """Show the motion after another disturbance; see :class:`carom.explorer.page.models.Requests`."""
        kick, slot = read_kick(request.get("first"), request.get("second")), request.get("slot")
        if kick is None or not isinstance(slot, int) or slot not in range(len(SLOTS)):
            return
        kicks = list(self.questions.kicks(self._shown))
        kicks[slot] = kick
        self._shown = replace(self._shown, view=replace(self._shown.view, kicks=tuple(kicks), active=slot))
        name = SLOTS[slot]
        self._ask(name, self.questions.quick[name])
        if request.get("chosen"):
            self._answer("exports", self.questions.exports(self._shown))

    def wish(self, request: Mapping[str, object]) -> None:
        """Begin what takes long and is done only where it is asked for, by its ``name``."""
        name = str(request.get("name"))
        if name in self.questions.on_request:
            self._left[name] = self.questions.on_request[name].work
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

        def run(report: Callable[[Progress], None]) -> object:
            if name != FIRST:
                self._wait_for_kernels()
            if task is not None:
                self._answer("state", {"kind": "working", "words": task.words, "share": 0.0})
            return work(shown, report)

        def done(result: Any) -> None:
            if isinstance(result, CaromError):
                send({"refused": str(result)})
            elif isinstance(result, Exception):
                send({"refused": f"unexpected {type(result).__name__}: {result}"})
            else:
                send(result)
            if self._shown.number == shown.number:
                self._left.pop(name, None)
            if name == tuple(self.questions.long)[-1] or name in self.questions.on_request:
                self._answer("state", {"kind": "idle"})
            if afterwards is not None and self._shown.number == shown.number:
                afterwards()

        worker = self._long if task is not None else self._first if name == FIRST else self._quick
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
