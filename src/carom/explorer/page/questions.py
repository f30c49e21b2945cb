"""What the page asks of a machine: its controls, and the work by which each answer is found."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from carom.base.outcome import CaromError
from carom.base.progress import ShowProgress
from carom.closed_forms.exact_results import exact_results
from carom.explorer.computing.controls import Control, controls_of, values_of, with_settings
from carom.explorer.computing.diagrams import diagram_along
from carom.explorer.computing.exports import Kick, Origin, as_command, as_options, as_python, mark_of
from carom.explorer.computing.judgement import find_hardest, find_loss, judge
from carom.explorer.computing.kicked_motion import follow_kick
from carom.explorer.computing.kicks import RANGES, TRIED, is_slow, map_kicks, opening_range, representative_kicks
from carom.explorer.computing.levitation import levitation_of, response_of
from carom.explorer.computing.motions import table_of
from carom.explorer.computing.planes import DisturbancePlane, opening_words, planes_of
from carom.explorer.computing.proofs import find_proven
from carom.explorer.computing.rest import rest_of
from carom.explorer.computing.walls import wall_at
from carom.explorer.page import messages
from carom.explorer.page.messages import Message
from carom.explorer.page.view import SLOTS, View
from carom.models import Rotor, rotor_of
from carom.parameters import Case

Pairs = tuple[tuple[float, float], ...]
COARSE, FINE = 60, 120
"""Cells along each side of the picture while a slider is dragged, and after that."""
COARSEST, COARSEST_SLOW = 16, 6
"""The least of them, and where motions take long."""
PATIENCE, PATIENCE_AFTER, PATIENCE_SLOW = 0.03, 6.0, 20.0
"""Seconds that a picture may take while a slider is dragged, and after that, and where motions take long; where it would take longer it is coarser."""
MOVING = ("derivative", "damping", "gamma", "stiffness", "omega", "speed")
"""Which control counts as moved last at first: the first of these that there is."""


@dataclass(frozen=True)
class Subject:
    """A machine with its rotor."""

    case: Case
    rotor: Rotor


@dataclass(frozen=True)
class Shown:
    """What a page shows at present.

    Attributes
    ----------
    number : int
        That of the request for it.
    subject : Subject
    settings : mapping
        Texts of the controls that were changed.
    along : str
        The control moved last.
    view : View
    held : bool
        Whether a slider is being dragged.
    """

    number: int
    subject: Subject
    settings: Mapping[str, str]
    along: str
    view: View
    held: bool = False


Work = Callable[[Shown, ShowProgress], Message]
"""Work for the machine shown."""


@dataclass(frozen=True)
class PageTask:
    """Work that takes long: what is done in words, and the answer that it gives."""

    words: str
    work: Work
    answer: str


class Questions:
    """What the page asks of a machine; each session has one of its own, which keeps what it has found.

    Attributes
    ----------
    origin : Origin
    mark : str
        Text that differs from machine to machine.
    controls : mapping
        By name.
    planes : mapping
        Kinds of disturbances by name.
    along : str
        The control that counts as moved last at first.
    figures : tuple of str
        Names of the figures with axes.
    quick : mapping
        Work by its answer, the most urgent first; a dragged slider waits for the picture of disturbances.
    long : mapping
        Work that is begun when nothing moves, in its order.
    on_request : mapping
        Work that takes long and is begun only when the page asks for it.
    """

    def __init__(self, origin: Origin) -> None:
        self.origin, self.mark = origin, mark_of(origin.case)
        self.controls: Mapping[str, Control] = {control.name: control for control in controls_of(origin.case)}
        self.planes: dict[str, DisturbancePlane] = {plane.name: plane for plane in planes_of(origin.case)}
        self.along = next(name for name in (*MOVING, *self.controls) if name in self.controls)
        rotor = rotor_of(origin.case)
        self.bearings, self.slow, self.exact = len(rotor.system.planes), is_slow(rotor), exact_results(rotor).orbits
        shown = {"forces": rotor.is_compliant, "response": rotor.scales is not None, "diagram": self.exact}
        self.figures = ("distances", "section", *(name for name, has in shown.items() if has))
        self._ranges: dict[str, float] = {}
        self._pairs: dict[str, Pairs] = {}
        self._cost = PATIENCE / COARSE**2
        self._diagrams: dict[tuple[object, ...], Message] = {}
        self.quick: Mapping[str, Work] = {
            "levitating": lambda shown, tell: levitation_of(shown.subject.case),
            "basin": self._coarse,
            **{slot: self._motion(place) for place, slot in enumerate(SLOTS)},
            "table": lambda shown, tell: table_of(shown.subject.rotor),
        }
        response = PageTask("computing the response to unbalance", self._response, "response")
        diagram = PageTask("following orbits along the slider", self._diagram, "diagram")
        self.long: Mapping[str, PageTask] = {
            "fine": PageTask("following disturbances", self._fine, "basin"),
            **({"response": response} if shown["response"] else {}),
            "loss": PageTask("looking for the smallest that does not come back", self._loss, "loss"),
            "hardest": PageTask("looking for the hardest impact", self._hardest, "hardest"),
            **({"diagram": diagram} if self.exact else {}),
            "verdict": PageTask("writing the verdict", lambda shown, tell: judge(shown.subject.case, tell), "verdict"),
        }
        self.on_request: Mapping[str, PageTask] = {
            "proven": PageTask("proving which kicks come back", self._proven, "proven")
        }

    def subject(self, settings: Mapping[str, str]) -> Subject:
        """The machine with other values of its controls; refuse all that cannot be used at once."""
        case = with_settings(self.origin.case, settings)
        return Subject(case, rotor_of(case))

    def values(self, subject: Subject) -> Mapping[str, float | None]:
        """Values of the controls of a machine; ``None`` of those of all parts that differ."""
        return values_of(subject.case, self.controls)

    def kicks(self, shown: Shown) -> Pairs:
        """Components of both disturbances drawn, in the unit that people see: those asked for, or those found telling."""
        asked = shown.view.kicks
        if asked is not None and len(asked) == len(SLOTS):
            return asked
        return self._pairs.get(self._plane(shown).name, ((0.0, 0.0), (0.0, 0.0)))

    def variables(self) -> Message:
        """What the template needs beside the controls."""
        rotor = rotor_of(self.origin.case)
        return {
            "planes": [messages.plane_message(plane, rotor.scales) for plane in self.planes.values()],
            "wall": wall_at(rotor, 0),
            "exact": self.exact,
            "figures": self.figures,
            "bearings": self.bearings,
            "frame": self.frame,
            "toml": bool(self.origin.case.to_toml()),
            "sweep": "" if self.slow else self.along,
        }

    @property
    def frame(self) -> str:
        """Frame in which motions are drawn first: that in which the rotor is at rest, or in which weight points down."""
        return "fixed" if rotor_of(self.origin.case).is_time_dependent else "rotating"

    def words(self) -> str:
        """What the page begins with, in a line."""
        return opening_words(self.origin.case)

    def warm_up(self) -> None:
        """Compile the kernels, or load them, by a first small use."""
        rotor, kicks = rotor_of(self.origin.case), self.planes["kick"]
        found = map_kicks(rotor, kicks, 5 if self.slow else 17, opening_range(rotor, kicks))
        follow_kick(rotor, kicks, *representative_kicks(found)[0])

    def exports(self, shown: Shown) -> Message:
        """What can be copied, by the name of its button."""
        case, rotor, plane = shown.subject.case, shown.subject.rotor, self._plane(shown)
        found = {"toml": case.to_toml(), "options": as_options(self.origin, shown.settings)}
        try:
            rest = rest_of(rotor)
        except CaromError:  # there is no disturbance that a command or a program could follow
            return {**found, "command": "", "python": ""}
        factor, largest = plane.shown(rotor.scales)[0], plane.own(self._largest(shown), rotor.scales)
        first, second = self.kicks(shown)[shown.view.active]
        kick = Kick(plane, rest, first / factor, second / factor, largest)
        return {
            **found,
            "command": as_command(self.origin, shown.settings, rotor, kick),
            "python": as_python(self.origin, shown.settings, rotor, kick, self.controls[shown.along]),
        }

    def _plane(self, shown: Shown) -> DisturbancePlane:
        return self.planes.get(shown.view.kind, self.planes["kick"])

    def _largest(self, shown: Shown) -> float:
        """Largest disturbance of the picture, in the units of planes."""
        plane = self._plane(shown)
        if shown.view.largest is not None:
            return shown.view.largest * plane.per_unit(shown.subject.rotor.scales)
        if plane.name not in self._ranges:
            began = time.perf_counter()
            self._ranges[plane.name] = opening_range(rotor_of(self.origin.case), plane)
            # At least this, so that a machine whose motions take long begins with a coarse picture.
            self._cost = max(self._cost, (time.perf_counter() - began) / (len(RANGES) * TRIED**2))
        return self._ranges[plane.name]

    def _judged(self, shown: Shown) -> float:
        """What must be survived, or where nothing is stated the largest of the picture; in units of the equations."""
        plane = self._plane(shown)
        return plane.own(plane.required or self._largest(shown), shown.subject.rotor.scales)

    def _motion(self, place: int) -> Work:
        def follow(shown: Shown, tell: ShowProgress) -> Message:
            rotor, plane = shown.subject.rotor, self._plane(shown)
            factor = plane.shown(rotor.scales)[0]
            first, second = self.kicks(shown)[place]
            motion = follow_kick(rotor, plane, first / factor, second / factor, tell)
            return {**motion, **messages.units_message(rotor.scales), "kick": {"first": first, "second": second}}

        return follow

    def _coarse(self, shown: Shown, tell: ShowProgress) -> Message:
        """Picture that is computed fast enough to follow a dragged slider, as fine as that allows."""
        self._largest(shown)  # which takes seconds the first time, and would be taken for the cost of the picture
        cells, began = self._cells(PATIENCE, COARSE), time.perf_counter()
        message = self._picture(shown, cells, tell, coarse=True)
        cost = (time.perf_counter() - began) / message["size"] ** 2
        self._cost = min(cost, 0.5 * (self._cost + cost))  # a single slow machine has little effect
        return message

    def _fine(self, shown: Shown, tell: ShowProgress) -> Message:
        return self._picture(shown, self._cells(PATIENCE_SLOW if self.slow else PATIENCE_AFTER, FINE), tell)

    def _cells(self, patience: float, most: int) -> int:
        """Cells along each side of a picture that may take so many seconds."""
        coarsest = COARSEST_SLOW if self.slow else COARSEST
        cells = int(min(most, max(coarsest, (patience / self._cost) ** 0.5)))
        return most if cells > 0.85 * most else cells

    def _picture(self, shown: Shown, cells: int, tell: ShowProgress, coarse: bool = False) -> Message:
        rotor, plane = shown.subject.rotor, self._plane(shown)
        found = map_kicks(rotor, plane, cells, self._largest(shown), tell)
        name, factor = plane.name, plane.shown(rotor.scales)[0]
        if name not in self._pairs:
            self._pairs[name] = tuple((factor * one, factor * other) for one, other in representative_kicks(found))
        opening = self._ranges.get(name, self._largest(shown)) / plane.per_unit(rotor.scales)
        return {**messages.basin_message(found, rotor, coarse), "opening": opening}

    def _response(self, shown: Shown, tell: ShowProgress) -> Message:
        return messages.response_message(*response_of(shown.subject.case, tell), shown.subject.rotor)

    def _loss(self, shown: Shown, tell: ShowProgress) -> Message:
        rotor, plane = shown.subject.rotor, self._plane(shown)
        largest = max(plane.own(self._largest(shown), rotor.scales), self._judged(shown))
        return find_loss(rotor, plane, largest, tell)

    def _proven(self, shown: Shown, tell: ShowProgress) -> Message:
        rotor, plane = shown.subject.rotor, self._plane(shown)
        return find_proven(rotor, plane, plane.own(self._largest(shown), rotor.scales), tell)

    def _hardest(self, shown: Shown, tell: ShowProgress) -> Message:
        case, rotor = shown.subject.case, shown.subject.rotor
        return find_hardest(rotor, self._plane(shown), self._judged(shown), case.limits, tell)

    def _diagram(self, shown: Shown, tell: ShowProgress) -> Message:
        others = tuple(sorted(item for item in shown.settings.items() if item[0] != shown.along))
        if (shown.along, others) not in self._diagrams:
            found = diagram_along(shown.subject.rotor, self.controls[shown.along], tell)
            self._diagrams = {(shown.along, others): found}
        return {**self._diagrams[shown.along, others]}
