"""What a measured channel shows: a time, or the displacement of a place of the rotor along a direction of the fixed frame."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from carom.base.outcome import InputError, shown
from carom.models import Rotor
from carom.parameters import Field
from carom.parameters.quantities import unit_factor

TIME, KEYPHASOR, IGNORED = "time", "keyphasor", "-"
_DIRECTIONS = {"x": 0.0, "y": 90.0}
_PATTERN = re.compile(
    r"(?P<what>time|keyphasor|-|x|y|(?P<angle>[-+]?\d+(?:\.\d+)?) ?deg)"
    r"(?: at (?P<place>bearing|node|sensor) (?P<number>\d+))?"
    r"(?: ?[\[(](?P<unit>[^\])]+)[\])])?"
)
_HISTORY = re.compile(r"(touchdown|node|magnetic_bearing)_(\d+)(_sensor)?_([xy])(?= |$)")
"""Headings of a file that ``--history`` has written."""
_PLACES = {"touchdown": "bearing", "node": "node", "magnetic_bearing": "sensor"}
_ALLOWED = "such as 'time [s]', 'x [um]', 'y at bearing 2 [um]', '45 deg at node 3 [mm]', 'keyphasor' or '-' for a column to ignore"
LENGTH = Field("displacement", "y", "displacement", "a length", "m", -1e3, 1e3, '"12 um"')
DURATION = Field("time", "t", "time", "a time", "s", -1e9, 1e9, '"1 ms"')


@dataclass(frozen=True)
class Channel:
    """A channel of a record.

    Attributes
    ----------
    text : str
        As it was declared, without its unit.
    what : str
        ``"time"``, ``"keyphasor"``, ``"-"`` or ``"displacement"``.
    factor : float
        SI unit, s or m, of one in the record.
    direction : float
        Of a displacement, the angle of the sensor in the fixed frame, rad.
    place : str
        ``"bearing"``, a touchdown bearing; ``"sensor"``, the mean of those of a magnetic bearing; or ``"node"``.
    number : int
        Which one, counted from 1, and as in the machine file for nodes.
    """

    text: str
    what: str
    factor: float = 1.0
    direction: float = 0.0
    place: str = "bearing"
    number: int = 1

    @classmethod
    def read(cls, text: str) -> Channel:
        """Read a declaration, such as ``"x at bearing 2 [um]"``.

        Raises
        ------
        InputError
            It cannot be read, or its unit is missing or of another dimension.
        """
        given = _HISTORY.sub(lambda each: f"{each[4]} at {_PLACES[each[1]]} {each[2]}", " ".join(text.split()))
        found = _PATTERN.fullmatch(given)
        if not found:
            raise InputError("column", shown(text), _ALLOWED)
        what, unit = found["what"], found["unit"]
        if what in (KEYPHASOR, IGNORED):
            return cls(what, what)
        field = DURATION if what == TIME else LENGTH
        if unit is None:
            raise InputError("column", shown(text), f"{field.kind} with its unit in brackets, {_ALLOWED}")
        factor = float(unit_factor(field, unit, text))
        if what == TIME:
            return cls(what, what, factor)
        degrees = float(found["angle"]) if found["angle"] else _DIRECTIONS[what]
        place, number = found["place"] or "bearing", int(found["number"] or 1)
        return cls(re.split(r" ?[\[(]", given)[0], "displacement", factor, math.radians(degrees), place, number)

    def row(self, rotor: Rotor) -> np.ndarray:
        """Displacement of its place in m per coordinate of the rotor, complex, shape (n,).

        Raises
        ------
        InputError
            The machine has no such place.
        """
        touchdowns, length = rotor.equations.touchdowns, rotor.scales.length if rotor.scales else 1.0
        if self.place == "bearing":
            if not 1 <= self.number <= len(touchdowns):
                raise InputError("column", shown(self.text), f"one of its {len(touchdowns)} touchdown bearings")
            plane = touchdowns[self.number - 1]
            return length * plane.clearance * np.array(plane.plane)
        whole = rotor.finite_elements
        if whole is None:
            raise InputError("column", shown(self.text), "a touchdown bearing: this machine has no nodes and sensors")
        named = f"node_{self.number}" if self.place == "node" else f"magnetic_bearing_{self.number}_sensor"
        places = whole.places((self.number,) if self.place == "node" else ())
        if named not in places:
            raise InputError("column", shown(self.text), f"one of its {len(whole.machine.bearings)} magnetic bearings")
        found: np.ndarray = length * places[named]
        return found
