"""The session of one page: it takes requests, has the work done beside the page, and sends the answers."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

from carom.explorer.background import Job, Worker
from carom.explorer.computing.controls import Control, controls_of, values_of, with_settings
from carom.explorer.computing.diagrams import picture_along, why_none
from carom.explorer.computing.exports import Kick, Origin, as_command, as_options, as_python, as_toml
from carom.explorer.computing.judgement import find_hardest, find_loss, judge
from carom.explorer.computing.kicked_motion import follow_kick
from carom.explorer.computing.kicks import RANGES, TRIED, map_kicks, opening_range, telling_pair
from carom.explorer.computing.motions import table_of
from carom.explorer.computing.planes import Plane, planes_of
from carom.explorer.computing.rest import rest_of
from carom.explorer.page import messages
from carom.explorer.page.view import SLOTS, View, read_kick, read_view
from carom.models import Model, model_of
from carom.outcome import CaromError, InputError
from carom.parameters import Case
from carom.progress import Progress
from carom.results import fields_of

COARSE, FINE = 60, 120
"""Cells along each side of the picture while a slider is dragged, and after that."""
COARSEST = 16
PATIENCE, PATIENCE_AFTER = 0.03, 6.0
"""Seconds that a picture may take while a slider is dragged, and after that; where it would take longer it is coarser."""
PAUSE = 0.06
"""Seconds without a further step after which, while a slider is dragged, more than the picture is computed."""
QUIET = 0.15
"""Seconds between two reports of progress."""

Answer = Callable[[str, Any], None]
"""Receives the name of an answer and its value, in any thread."""
_LONG = {
    "fine": "following disturbances",
    "loss": "looking for the smallest that is lost",
    "hardest": "looking for the hardest impact",
    "diagram": "following orbits along the slider",
    "verdict": "writing the verdict",
}


@dataclass(frozen=True)
class _Shown:
    """What the page shows at present."""

    number: int
    case: Case
    settings: Mapping[str, str]
    rotor: Model
    along: str
    plane: Plane
    view: View
    held: bool = False
    """Whether a slider is being dragged."""


Work = Callable[[_Shown, Callable[[Progress], None]], messages.Message]
"""Work for the machine shown, with a callable for its progress."""


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
    wanted : collection of str
        What of all that takes long is done.
    """

    def __init__(
        self, origin: Origin, answer: Answer, ready: threading.Event, wanted: Collection[str] = tuple(_LONG)
    ) -> None:
        self.origin, self._answer, self._ready, self._wanted = origin, answer, ready, wanted
        self.controls = {control.name: control for control in controls_of(origin.case)}
        self.planes: dict[str, Plane] = {plane.name: plane for plane in planes_of(origin.case)}
        rotor = model_of(origin.case)
        first = "damping" if "damping" in self.controls else "gamma"
        self._shown = _Shown(0, origin.case, {}, rotor, first, self.planes["kick"], View())
        self._ranges: dict[str, float] = {}
        self._pairs: dict[str, tuple[tuple[float, float], ...]] = {}
        self._cost, self._reported = PATIENCE / COARSE**2, 0.0
        self._diagrams: dict[tuple[Any, ...], Any] = {}
        self._left: dict[str, Work] = {}
        self._quick = Worker(("basin", *SLOTS, "table"))
        self._long = Worker(tuple(_LONG), self._report)

    def close(self) -> None:
        """End all work of the page."""
        self._quick.close()
        self._long.close()

    def show(self, request: Mapping[str, Any]) -> None:
        """Show another machine; see :class:`carom.explorer.page.models.Requests`."""
        asked = {str(name): str(text) for name, text in dict(request.get("settings", {})).items()}
        number, held = int(request.get("number", 0)), bool(request.get("held", False))
        settings, case, problem = self._usable(asked)
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
        self._shown = _Shown(
            number,
            case,
            settings,
            model_of(case),
            along if along in self.controls else before.along,
            self.planes.get(view.kind, self.planes["kick"]),
            view,
            held,
        )
        self._reply(number, problem)
        self._long.drop()
        self._left = {}
        self._ask("basin", self._coarse, None if held else self._finish)
        pause = PAUSE if held else 0.0
        for slot in SLOTS:
            self._ask(slot, self._motion(slot), pause=pause)
        self._ask("table", lambda shown, tell: messages.table_message(table_of(shown.rotor)), pause=pause)

    def _usable(self, asked: Mapping[str, str]) -> tuple[Mapping[str, str], Case, InputError | None]:
        """Settings with what cannot be used left as it is shown, their machine, and what cannot be used."""
        try:
            return asked, with_settings(self.origin.case, asked), None
        except InputError as problem:
            refused, shown = {one.field for one in problem.errors}, self._shown
            kept = {name: text for name, text in asked.items() if name not in refused}
            kept.update({name: shown.settings[name] for name in asked if name in refused & shown.settings.keys()})
            try:
                return kept, with_settings(self.origin.case, kept), problem
            except InputError:  # values that are refused only together
                return shown.settings, shown.case, problem

    def _reply(self, number: int, problem: InputError | None) -> None:
        """Say which machine is shown after a request, and what of it could not be used."""
        shown = self._shown
        reply = {"number": number, "shown": shown.number, "values": values_of(shown.case), "text": "", "names": []}
        if problem is not None:
            reply.update(text=str(problem), names=[one.field for one in problem.errors])
        self._answer("reply", reply)

    def _finish(self) -> None:
        """Start everything that takes longer than a moment."""
        self._answer("exports", self._exports())
        self._left = {
            "fine": lambda shown, tell: self._picture(shown, self._cells(PATIENCE_AFTER, FINE), tell),
            "loss": self._loss,
            "hardest": lambda shown, tell: vars(
                find_hardest(shown.rotor, shown.plane, self._judged(shown), shown.case.limits, tell)
            ),
            "diagram": self._diagram,
            "verdict": lambda shown, tell: fields_of(judge(shown.case, tell), "lead", "advice", "survived"),
        }
        self._left = {kind: work for kind, work in self._left.items() if kind in self._wanted}
        self.resume()

    def kick(self, request: Mapping[str, Any]) -> None:
        """Show the motion after another disturbance; see :class:`carom.explorer.page.models.Requests`."""
        kick, slot = read_kick(request.get("first"), request.get("second")), request.get("slot")
        if kick is None or slot not in (0, 1):
            return
        kicks = list(self._kicks(self._shown))
        kicks[slot] = kick
        self._shown = replace(self._shown, view=replace(self._shown.view, kicks=tuple(kicks), active=slot))
        self._ask(SLOTS[slot], self._motion(SLOTS[slot]))
        if request.get("chosen"):
            self._answer("exports", self._exports())

    def cancel(self) -> None:
        """Interrupt what takes long."""
        self._long.drop()
        self._answer("state", {"kind": "cancelled"})

    def resume(self) -> None:
        """Start again what takes long and has not been done for the machine shown."""
        for kind, work in tuple(self._left.items()):
            self._ask(kind, work)
        if not self._left:
            self._answer("state", {"kind": "idle"})

    def _largest(self, shown: _Shown) -> float:
        """Largest disturbance of the picture, in the units of planes."""
        if shown.view.largest is not None:
            return shown.view.largest * shown.plane.per_unit(shown.rotor.scales)
        name = shown.plane.name
        if name not in self._ranges:
            began = time.perf_counter()
            self._ranges[name] = opening_range(model_of(self.origin.case), shown.plane)
            # At least this, so that a machine whose motions take long begins with a coarse picture.
            self._cost = max(self._cost, (time.perf_counter() - began) / (len(RANGES) * TRIED**2))
        return self._ranges[name]

    def _judged(self, shown: _Shown) -> float:
        """What must be survived, or where nothing is stated the largest of the picture; in units of the equations."""
        return shown.plane.own(shown.plane.required or self._largest(shown), shown.rotor.scales)

    def _kicks(self, shown: _Shown) -> tuple[tuple[float, float], ...]:
        """Components of both disturbances drawn, in the unit that people are told: those asked for, or those found telling."""
        return shown.view.kicks or self._pairs.get(shown.plane.name, ((0.0, 0.0), (0.0, 0.0)))

    def _motion(self, slot: str) -> Work:
        def follow(shown: _Shown, tell: Callable[[Progress], None]) -> messages.Message:
            factor = shown.plane.shown(shown.rotor.scales)[0]
            first, second = self._kicks(shown)[SLOTS.index(slot)]
            motion = follow_kick(shown.rotor, shown.plane, first / factor, second / factor, tell)
            return {**messages.motion_message(motion, shown.rotor), "kick": {"first": first, "second": second}}

        return follow

    def _loss(self, shown: _Shown, tell: Callable[[Progress], None]) -> messages.Message:
        largest = max(shown.plane.own(self._largest(shown), shown.rotor.scales), self._judged(shown))
        return messages.loss_message(
            find_loss(shown.rotor, shown.plane, largest, tell), shown.plane, shown.rotor.scales
        )

    def _coarse(self, shown: _Shown, tell: Callable[[Progress], None]) -> messages.Message:
        """Picture that is computed fast enough to follow a dragged slider, as fine as that allows."""
        cells, began = self._cells(PATIENCE, COARSE), time.perf_counter()
        message = self._picture(shown, cells, tell)
        cost = (time.perf_counter() - began) / message["size"] ** 2
        self._cost = min(cost, 0.5 * (self._cost + cost))  # a single slow machine has little effect
        return message

    def _cells(self, patience: float, most: int) -> int:
        """Cells along each side of a picture that may take so many seconds."""
        cells = int(min(most, max(COARSEST, (patience / self._cost) ** 0.5)))
        return most if cells > 0.85 * most else cells

    def _picture(self, shown: _Shown, cells: int, tell: Callable[[Progress], None]) -> messages.Message:
        found = map_kicks(shown.rotor, shown.plane, cells, self._largest(shown), tell)
        name, factor = shown.plane.name, shown.plane.shown(shown.rotor.scales)[0]
        if name not in self._pairs:
            self._pairs[name] = tuple((factor * one, factor * other) for one, other in telling_pair(found))
        opening = self._ranges.get(name, self._largest(shown)) / shown.plane.per_unit(shown.rotor.scales)
        return {**messages.basin_message(found, shown.rotor), "opening": opening}

    def _diagram(self, shown: _Shown, tell: Callable[[Progress], None]) -> messages.Message:
        if reason := why_none(shown.rotor):
            return {"refused": reason}
        others = tuple(sorted(item for item in shown.settings.items() if item[0] != shown.along))
        if (shown.along, others) not in self._diagrams:
            control: Control = self.controls[shown.along]
            found = messages.diagram_message(picture_along(shown.rotor, control, tell))
            self._diagrams = {(shown.along, others): found}
        return {**self._diagrams[shown.along, others]}

    def _exports(self) -> messages.Message:
        shown = self._shown
        factor, largest = (
            shown.plane.shown(shown.rotor.scales)[0],
            shown.plane.own(self._largest(shown), shown.rotor.scales),
        )
        first, second = self._kicks(shown)[shown.view.active]
        kick = Kick(shown.plane, rest_of(shown.rotor), first / factor, second / factor, largest)
        return {
            "toml": as_toml(shown.case),
            "options": as_options(self.origin, shown.settings),
            "command": as_command(self.origin, shown.settings, shown.rotor, kick),
            "python": as_python(shown.case, kick, self.controls[shown.along]),
        }

    def _ask(self, kind: str, work: Work, afterwards: Callable[[], None] | None = None, pause: float = 0.0) -> None:
        """Have work done for the machine shown now and its result sent; then, if that is still shown, call `afterwards`."""
        shown, name = self._shown, "basin" if kind == "fine" else kind

        def run(tell: Callable[[Progress], None]) -> Any:
            self._wait_for_kernels()
            if kind in _LONG:
                self._answer("state", {"kind": "working", "words": _LONG[kind], "share": 0.0})
            return work(shown, tell)

        def done(result: Any) -> None:
            if isinstance(result, CaromError):
                self._answer(name, {"number": shown.number, "refused": str(result)})
            elif isinstance(result, Exception):
                self._answer(name, {"number": shown.number, "refused": f"unexpected {type(result).__name__}: {result}"})
            else:
                self._answer(name, {**result, "number": shown.number})
            if self._shown.number == shown.number:
                self._left.pop(kind, None)
            if kind == tuple(_LONG)[-1]:
                self._answer("state", {"kind": "idle"})
            if afterwards is not None and self._shown.number == shown.number:
                afterwards()

        (self._long if kind in _LONG else self._quick).submit(kind, Job(run, done, pause))

    def _wait_for_kernels(self) -> None:
        if not self._ready.is_set():
            self._answer("state", {"kind": "compiling"})
            self._ready.wait()
            self._answer("state", {"kind": "idle"})

    def _report(self, kind: str, progress: Progress) -> None:
        now = time.monotonic()
        if now - self._reported > QUIET:
            self._reported = now
            self._answer("state", {"kind": "working", "words": progress.step or _LONG[kind], "share": progress.share})
