"""The page of the planar rotor: basin, two motions, table, smallest loss, hardest blow, diagram, verdict."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from carom.closed_forms.exact_results import exact_results
from carom.explorer.computing.controls import Control, controls_of, values_of, with_settings
from carom.explorer.computing.diagrams import picture_along, why_none
from carom.explorer.computing.exports import Kick, Origin, as_command, as_options, as_python, as_toml, mark_of
from carom.explorer.computing.judgement import find_hardest, find_loss, judge
from carom.explorer.computing.kicked_motion import follow_kick
from carom.explorer.computing.kicks import RANGES, TRIED, map_kicks, opening_range, telling_pair
from carom.explorer.computing.motions import table_of
from carom.explorer.computing.planes import Plane, opening_words, planes_of
from carom.explorer.computing.proofs import find_proven
from carom.explorer.computing.rest import rest_of
from carom.explorer.computing.walls import wall_of
from carom.explorer.page import messages
from carom.explorer.page.kind import Message, Pairs, Shown, Task, Tell, Work
from carom.explorer.page.scripts import PLANAR
from carom.explorer.page.view import SLOTS
from carom.models import Rotor, rotor_of
from carom.parameters import Case
from carom.results import fields_of

COARSE, FINE = 60, 120
"""Cells along each side of the picture while a slider is dragged, and after that."""
COARSEST = 16
PATIENCE, PATIENCE_AFTER = 0.03, 6.0
"""Seconds that a picture may take while a slider is dragged, and after that; where it would take longer it is coarser."""


@dataclass(frozen=True)
class PlanarSubject:
    """A machine with the model of its rotor."""

    case: Case
    rotor: Rotor


class PlanarKind:
    """The planar rotor; see :class:`carom.explorer.page.kind.Kind`."""

    slots: tuple[str, ...] = SLOTS
    apart: tuple[str, ...] = ()
    early: tuple[str, ...] = ()
    template = "planar.html.jinja"
    scripts: tuple[str, ...] = PLANAR
    figures: tuple[str, ...] = ("history", "section", "diagram")
    planes_shown = 1
    frame = "rotating"
    reading = "Point at a kick: what comes back flies as 1, what is lost as 2. Angles count from 0°, the x axis that turns with the shaft."

    def __init__(self, origin: Origin) -> None:
        self.origin, self.mark = origin, mark_of(origin.case.name, as_toml(origin.case))
        self.controls: Mapping[str, Control] = {control.name: control for control in controls_of(origin.case)}
        self.planes: dict[str, Plane] = {plane.name: plane for plane in planes_of(origin.case)}
        self.along = "damping" if "damping" in self.controls else "gamma"
        self._ranges: dict[str, float] = {}
        self._pairs: dict[str, Pairs] = {}
        self._cost = PATIENCE / COARSE**2
        self._diagrams: dict[tuple[Any, ...], Message] = {}
        self.quick: Mapping[str, Work] = {
            "basin": self._coarse,
            **{slot: self._motion(place) for place, slot in enumerate(SLOTS)},
            "table": lambda shown, tell: messages.table_message(table_of(shown.subject.rotor)),
        }
        self.long: Mapping[str, Task] = {
            "fine": Task("following disturbances", self._fine, "basin"),
            "loss": Task("looking for the smallest that is lost", self._loss, "loss"),
            "hardest": Task("looking for the hardest impact", self._hardest, "hardest"),
            "diagram": Task("following orbits along the slider", self._diagram, "diagram"),
            "verdict": Task("writing the verdict", self._verdict, "verdict"),
        }
        self.wished: Mapping[str, Task] = {"proven": Task("proving which kicks come back", self._proven, "proven")}

    def subject(self, settings: Mapping[str, str]) -> PlanarSubject:
        """The machine with other values of its controls."""
        case = with_settings(self.origin.case, settings)
        return PlanarSubject(case, rotor_of(case))

    def values(self, subject: PlanarSubject) -> Mapping[str, float | None]:
        """Values of the controls of a machine."""
        return dict(values_of(subject.case))

    def kicks(self, shown: Shown) -> Pairs:
        """Components of both disturbances drawn: those asked for, or those found telling."""
        asked = shown.view.kicks
        if asked is not None and len(asked) == len(SLOTS):
            return asked
        return self._pairs.get(self._plane(shown).name, ((0.0, 0.0), (0.0, 0.0)))

    def variables(self) -> Message:
        """What the template needs beside the controls."""
        rotor = rotor_of(self.origin.case)
        return {
            "planes": [messages.plane_message(plane, rotor.scales) for plane in self.planes.values()],
            "wall": wall_of(rotor),
            "orbits": exact_results(rotor).orbits,
        }

    def words(self) -> str:
        """What the page begins with."""
        return opening_words(self.origin.case)

    def warm_up(self) -> None:
        """Compile the kernels, or load them, by a first small use."""
        rotor, kicks = rotor_of(self.origin.case), self.planes["kick"]
        table_of(rotor)
        found = map_kicks(rotor, kicks, 17, opening_range(rotor, kicks))
        follow_kick(rotor, kicks, *telling_pair(found)[0])

    def exports(self, shown: Shown) -> Message:
        """What can be copied."""
        case, rotor, plane = shown.subject.case, shown.subject.rotor, self._plane(shown)
        factor, largest = plane.shown(rotor.scales)[0], plane.own(self._largest(shown), rotor.scales)
        first, second = self.kicks(shown)[shown.view.active]
        kick = Kick(plane, rest_of(rotor), first / factor, second / factor, largest)
        return {
            "toml": as_toml(case),
            "options": as_options(self.origin, shown.settings),
            "command": as_command(self.origin, shown.settings, rotor, kick),
            "python": as_python(case, kick, self.controls[shown.along]),
        }

    def _plane(self, shown: Shown) -> Plane:
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
        def follow(shown: Shown, tell: Tell) -> Message:
            rotor, plane = shown.subject.rotor, self._plane(shown)
            factor = plane.shown(rotor.scales)[0]
            first, second = self.kicks(shown)[place]
            motion = follow_kick(rotor, plane, first / factor, second / factor, tell)
            return {**messages.motion_message(motion, rotor), "kick": {"first": first, "second": second}}

        return follow

    def _coarse(self, shown: Shown, tell: Tell) -> Message:
        """Picture that is computed fast enough to follow a dragged slider, as fine as that allows."""
        self._largest(shown)  # which takes seconds the first time, and would be taken for the cost of the picture
        cells, began = self._cells(PATIENCE, COARSE), time.perf_counter()
        message = self._picture(shown, cells, tell, coarse=True)
        cost = (time.perf_counter() - began) / message["size"] ** 2
        self._cost = min(cost, 0.5 * (self._cost + cost))  # a single slow machine has little effect
        return message

    def _fine(self, shown: Shown, tell: Tell) -> Message:
        return self._picture(shown, self._cells(PATIENCE_AFTER, FINE), tell)

    def _cells(self, patience: float, most: int) -> int:
        """Cells along each side of a picture that may take so many seconds."""
        cells = int(min(most, max(COARSEST, (patience / self._cost) ** 0.5)))
        return most if cells > 0.85 * most else cells

    def _picture(self, shown: Shown, cells: int, tell: Tell, coarse: bool = False) -> Message:
        rotor, plane = shown.subject.rotor, self._plane(shown)
        found = map_kicks(rotor, plane, cells, self._largest(shown), tell)
        name, factor = plane.name, plane.shown(rotor.scales)[0]
        if name not in self._pairs:
            self._pairs[name] = tuple((factor * one, factor * other) for one, other in telling_pair(found))
        opening = self._ranges.get(name, self._largest(shown)) / plane.per_unit(rotor.scales)
        return {**messages.basin_message(found, rotor, coarse), "opening": opening}

    def _loss(self, shown: Shown, tell: Tell) -> Message:
        rotor, plane = shown.subject.rotor, self._plane(shown)
        largest = max(plane.own(self._largest(shown), rotor.scales), self._judged(shown))
        return messages.loss_message(find_loss(rotor, plane, largest, tell), plane, rotor.scales)

    def _proven(self, shown: Shown, tell: Tell) -> Message:
        rotor, plane = shown.subject.rotor, self._plane(shown)
        return vars(find_proven(rotor, plane, plane.own(self._largest(shown), rotor.scales), tell))

    def _hardest(self, shown: Shown, tell: Tell) -> Message:
        case, rotor = shown.subject.case, shown.subject.rotor
        return vars(find_hardest(rotor, self._plane(shown), self._judged(shown), case.limits, tell))

    def _verdict(self, shown: Shown, tell: Tell) -> Message:
        return fields_of(judge(shown.subject.case, tell), "lead", "advice", "survived")

    def _diagram(self, shown: Shown, tell: Tell) -> Message:
        if reason := why_none(shown.subject.rotor):
            return {"refused": reason}
        others = tuple(sorted(item for item in shown.settings.items() if item[0] != shown.along))
        if (shown.along, others) not in self._diagrams:
            found = messages.diagram_message(picture_along(shown.subject.rotor, self.controls[shown.along], tell))
            self._diagrams = {(shown.along, others): found}
        return {**self._diagrams[shown.along, others]}
