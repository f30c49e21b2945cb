"""The page of a flexible machine: whether it levitates, the motion after a kick at each touchdown bearing, and where kicks lead."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping

from carom.explorer.computing.controls import Control
from carom.explorer.computing.exports import Origin, mark_of
from carom.explorer.computing.flexible_controls import controls_of_machine, in_entries, machine_with, values_of_machine
from carom.explorer.computing.flexible_exports import as_program, as_set, as_simulate, settings_of
from carom.explorer.computing.flexible_kicks import (
    COARSE,
    FINE,
    FOLLOWING,
    KickPicture,
    empty_picture,
    fill_picture,
    opening_size,
)
from carom.explorer.computing.flexible_levitation import levitating, told_more
from carom.explorer.computing.flexible_motion import follow_flexible
from carom.explorer.page.flexible_messages import flexible_motion_message, levitation_message, picture_message
from carom.explorer.page.kind import Message, Pairs, Shown, Task, Tell, Work
from carom.explorer.page.scripts import FLEXIBLE
from carom.explorer.page.view import View
from carom.models import Rotor, rotor_of
from carom.outcome import CaromError, InputError
from carom.parameters import Case, Scales
from carom.parameters.told import shown_in, told
from carom.rotors import ReducedMachine
from carom.rotors.documents import document_of
from carom.studies.levitating import FASTEST

NONE = "No kick is followed: with these values there is no levitation that it could disturb."
FIRST = 0.5, math.radians(30.0)
"""Size of the kick that is drawn first, over the range of the picture, and its direction."""


class FlexibleKind:
    """A flexible machine; see :class:`carom.explorer.page.kind.Kind`.  A subject is the machine with its vectors."""

    slots: tuple[str, ...] = ("motion",)
    apart: tuple[str, ...] = ("motion",)
    early: tuple[str, ...] = ("levitating", "told")
    along = "speed"
    template = "flexible.html.jinja"
    scripts: tuple[str, ...] = FLEXIBLE
    figures: tuple[str, ...] = ("response", "distances", "forces")
    frame = "fixed"
    reading = "Point at a kick: it is followed at every touchdown bearing. Kicks are as seen along the shaft, with 0° at the right. The picture is filled in, coarse at first."

    def __init__(self, origin: Origin) -> None:
        found = rotor_of(origin.case).finite_elements
        if found is None:
            raise TypeError("no flexible machine")
        self.origin, self._reduced = origin, found
        self.planes_shown = len(found.machine.touchdowns)
        self.controls: Mapping[str, Control] = {each.name: each for each in controls_of_machine(found.machine)}
        self.mark = mark_of(origin.case.name, json.dumps(document_of(found.machine), sort_keys=True))
        self.quick: Mapping[str, Work] = {"levitating": self._levitation, "motion": self._motion}
        self.long: Mapping[str, Task] = {
            "basin": Task(FOLLOWING, self._basin(COARSE), "basin"),
            "told": Task("critical speeds and sensitivity", self._told, "told"),
            "fine": Task(FOLLOWING, self._basin(FINE), "basin"),
        }
        self.wished: Mapping[str, Task] = {}
        self._picture: tuple[int, KickPicture] | None = None

    @property
    def _case(self) -> Case:
        return self.origin.case

    def subject(self, settings: Mapping[str, str]) -> ReducedMachine:
        """The machine with other values of its controls, by the same vectors."""
        return self._reduced.of(machine_with(self._reduced.machine, self.controls, settings))

    def values(self, subject: ReducedMachine) -> Mapping[str, float | None]:
        """Values of the controls of a machine; ``None`` of those of all parts that differ."""
        return values_of_machine(subject.machine, self.controls)

    def kicks(self, shown: Shown) -> Pairs:
        """Parts of the kick that is drawn."""
        if shown.view.kicks is not None and len(shown.view.kicks) == len(self.slots):
            return shown.view.kicks
        share, angle = FIRST
        size = share * self._largest(shown)
        return ((float(f"{size * math.cos(angle):.3g}"), float(f"{size * math.sin(angle):.3g}")),)

    def variables(self) -> Message:
        """What the template needs beside the controls."""
        return {"touchdowns": self.planes_shown, "planes": [{"name": "kick", "words": "kicks"}]}

    def words(self) -> str:
        """What the page begins with."""
        needed = told(self._required(self._reduced.scales), "velocity", self._reduced.scales)
        return f"{self._case.name}: it must survive kicks up to {needed}, which disturb levitation; angles count from the x axis, against which the mark of the shaft lies at the kick"

    def warm_up(self) -> None:
        """Compile the kernels, or load them, by a first small use."""
        opening_size(self._case)
        shown = Shown(0, self._reduced, {}, self.along, View())
        follow_flexible(self._reduced.model, *self._own(shown))

    def exports(self, shown: Shown) -> Message:
        """What can be copied."""
        settings = settings_of(
            self.origin, self.controls, in_entries(shown.subject.machine, self.controls, shown.settings)
        )
        (right, up), unit = self.kicks(shown)[0], self._shown_in[1]
        return {
            "options": as_set(settings),
            "command": as_simulate(self.origin, settings, right, up, unit),
            "python": as_program(self.origin, settings, right, up, unit, self._largest(shown)),
        }

    @property
    def _shown_in(self) -> tuple[float, str]:
        """Factor from m/s to the unit of kicks, and the unit."""
        factor, unit = shown_in("velocity", self._reduced.scales)
        return factor / self._reduced.scales.velocity, unit

    def _required(self, scales: Scales) -> float:
        """Kick that must be survived, in units of the equations."""
        return self._case.requirement.own(scales).kick

    def _largest(self, shown: Shown) -> float:
        """Largest kick of the picture, in the unit that people are told."""
        if shown.view.largest is not None:
            return shown.view.largest
        return self._shown_in[0] * opening_size(self._case)

    def _own(self, shown: Shown) -> tuple[float, float]:
        """Parts of the kick that is drawn, in units of the equations of the machine shown."""
        right, up = self.kicks(shown)[0]
        unit = self._shown_in[0] * shown.subject.scales.velocity
        return right / unit, up / unit

    def _levitating(self, shown: Shown) -> Rotor:
        """The rotor, whose levitation kicks disturb."""
        try:
            rotor: Rotor = shown.subject.model
        except InputError:
            raise CaromError(NONE) from None
        if rotor.system.rest_radius >= 1.0:
            raise CaromError(NONE)
        return rotor

    def _levitation(self, shown: Shown, tell: Tell) -> Message:
        reduced: ReducedMachine = shown.subject
        top = FASTEST * self._reduced.machine.speed
        return levitation_message(levitating(self._case, reduced, top), reduced.machine.speed)

    def _motion(self, shown: Shown, tell: Tell) -> Message:
        rotor = self._levitating(shown)
        right, up = self.kicks(shown)[0]
        motion = follow_flexible(rotor, *self._own(shown), tell)
        return {**flexible_motion_message(motion, rotor), "kick": {"first": right, "second": up}}

    def _told(self, shown: Shown, tell: Tell) -> Message:
        return {"told": told_more(shown.subject, tell)}

    def _basin(self, strides: tuple[int, ...]) -> Work:
        """The picture, shown again and again while it is filled in."""

        def fill(shown: Shown, tell: Tell) -> Message:
            rotor = self._levitating(shown)
            unit = self._shown_in[0] * shown.subject.scales.velocity
            required, opening = self._required(shown.subject.scales), self._shown_in[0] * opening_size(self._case)
            picture = begun = self._begun(shown, self._largest(shown) / unit)
            for picture in fill_picture(rotor, begun, strides, tell):
                self._picture = shown.number, picture
                tell.show(picture_message(picture, rotor, required, opening))
            return picture_message(picture, rotor, required, opening)

        return fill

    def _begun(self, shown: Shown, largest: float) -> KickPicture:
        """The picture as far as it is known of the machine shown."""
        number, picture = self._picture or (0, None)
        return picture if picture is not None and number == shown.number else empty_picture(largest)
