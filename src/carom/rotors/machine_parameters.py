"""Named parameters of a flexible machine: one list of names for settings, sweeps, gain maps and branches.

A name such as ``proportional`` or ``friction`` is that of all magnetic bearings, or all touchdown bearings, at once; with the number of one of them, as
the tables of a machine file are counted from 1, of that one: ``proportional_2``.  Entries of touchdown bearings have the prefix that they have
for the planar rotor: ``touchdown_stiffness``.  The size of an unbalance is ``unbalance``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple, Self

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.parameters import MACHINE_FIELDS, SETTINGS, TOUCHDOWN_FIELDS, Field, Gravity, read_quantity
from carom.parameters.fields import unknown_name
from carom.parameters.machine_file import GRAVITY_NAME
from carom.parameters.touchdown_bearing import PREFIX
from carom.rotors.attachments import HOUSING_FIELDS, PLANE_FIELDS, UNBALANCE_FIELDS, TouchdownPlane
from carom.rotors.controllers import Series
from carom.rotors.free_rotor import FreeRotor
from carom.rotors.magnetic_bearing import BEARING_FIELDS
from carom.rotors.state_spaces import SAMPLE_TIME
from carom.rotors.support import SUPPORT_FIELDS

WHOLE: Mapping[str, Field] = {name: MACHINE_FIELDS[name] for name in ("speed", "clearance")}
"""Parameters of the machine as a whole, beside its weight."""
OF_STATES = ("integral", "derivative", "filter_time", "delay")
"""Entries at zero of which a controller has fewer states."""
_LEFT_OUT = (("exponent", 1.0), ("tilt_stiffness", 0.0), ("tilt_damping", 0.0), ("ks_tilt", 0.0))
"""Entries with values that are as none, for which nothing is prepared."""
_Path = tuple[str | int, ...]
_Paths = dict[str, tuple[_Path, Field]]
"""By the name of an entry, the attributes that lead to it from its part, and its field."""


_COEFFICIENT = Field("", "", "", "a number", "", -1e60, 1e60, "1", True)


def _inside(found: _Paths, *attributes: str | int, prefix: str = "", words: str = "") -> _Paths:
    """Numbers of a part to which these attributes and places lead from the whole."""
    return {
        prefix + name: ((*attributes, *path), replace(field, words=field.words + words))
        for name, (path, field) in found.items()
    }


def numbers_of(controller: object) -> _Paths:
    """Numbers of a controller by their names, those that are stated."""
    if isinstance(controller, Series):
        found = _inside(numbers_of(controller.controller), "controller")
        for place, each in enumerate(controller.filters):
            own = {name: number for name, number in numbers_of(each).items() if name != "sample_time"}
            number = place + 1
            found |= _inside(own, "filters", place, prefix=f"filter{number}_", words=f", of filter {number}")
        has_samples = "sample_time" in found
    else:
        fields: Mapping[str, Field] = getattr(controller, "fields", {})
        found = _own({name: field for name, field in fields.items() if getattr(controller, name) is not None})
        for name, path, words in getattr(controller, "coefficients", ()):
            found[name] = path, replace(_COEFFICIENT, name=name, words=words)
        has_samples = getattr(controller, "sample_time", None) is not None
    return found | (_own({"sample_time": SAMPLE_TIME}) if has_samples else {})


def _own(fields: Mapping[str, Field]) -> _Paths:
    return {name: ((name,), field) for name, field in fields.items()}


_KINDS: Mapping[str, tuple[str, _Paths]] = {
    "bearings": ("magnetic bearing", _own(BEARING_FIELDS)),
    "shared_controllers": ("shared controller", {}),
    "supports": ("support", _own(SUPPORT_FIELDS)),
    "touchdowns": (
        "touchdown bearing",
        _own(PLANE_FIELDS) | {PREFIX + name: (("bearing", name), SETTINGS[PREFIX + name]) for name in TOUCHDOWN_FIELDS},
    ),
    "housings": ("housing", {f"housing_{name}": ((name,), field) for name, field in HOUSING_FIELDS.items()}),
    "unbalances": ("[[unbalance]]", {"unbalance": (("size",), UNBALANCE_FIELDS["size"])}),
}
"""By the attribute of a machine, what its parts are called, and their entries."""


def _read(part: Any, path: _Path) -> Any:
    """Number of an entry; ``None`` where it is not there, as the exponent of a force that grows like the depth, changes no motion, or has several numbers over speed."""
    if path[0] == "bearing" and path[1] not in getattr(part, path[0]).of_motion:
        return None
    for name in path:
        part = part[name] if isinstance(name, int) else getattr(part, name, None)
    return None if isinstance(part, tuple) or (path[-1], part) in _LEFT_OUT else part


def _changed(part: Any, path: _Path, value: float) -> Any:
    name, rest = path[0], path[1:]
    own = _changed(part[name] if isinstance(name, int) else getattr(part, name), rest, value) if rest else value
    return (*part[:name], own, *part[name + 1 :]) if isinstance(name, int) else replace(part, **{name: own})


def _entries_of(attribute: str, part: object) -> _Paths:
    """Entries of a part that are stated; those of a bearing with the numbers of its controller."""
    _, paths = _KINDS[attribute]
    found = {name: own for name, own in paths.items() if _read(part, own[0]) is not None}
    for controller in ("controller", "translation", "tilt", "matrices"):
        prefix = "" if controller in ("controller", "matrices") else f"{controller}_"
        found |= _inside(numbers_of(getattr(part, controller, None)), controller, prefix=prefix)
    if getattr(part, "y", None) is not None:
        others = _entries_of(attribute, part.y)  # type: ignore[attr-defined]
        others.pop("ki")
        found |= _inside(others, "y", prefix="y_", words=", along its second axis")
    return found


class Entry(NamedTuple):
    """An entry of parts, and which of them it changes."""

    field: Field
    entry: str
    attribute: str
    path: _Path
    numbers: list[int]

    def values(self, machine: NamedParameters) -> list[float]:
        """Its values in these parts."""
        return [float(_read(getattr(machine, self.attribute)[number], self.path)) for number in self.numbers]


class NamedParameters:
    """A machine of parts that has its numbers by names."""

    rotor: FreeRotor
    speed: float
    clearance: float
    touchdowns: Sequence[TouchdownPlane]
    gravity: Gravity | None

    @property
    def clearances(self) -> tuple[float, ...]:
        """Radial clearance at each touchdown bearing, m."""
        return tuple(each.clearance or self.clearance for each in self.touchdowns)

    @cached_property
    def entries(self) -> Mapping[str, Entry]:
        """The entries of parts by the names of parameters: of all parts of a kind if each has it, and of each."""
        found = {}
        for attribute, (kind, _) in _KINDS.items():
            parts = [_entries_of(attribute, part) for part in getattr(self, attribute)]
            listed: _Paths = {}
            for part in parts:
                listed |= {name: own for name, own in part.items() if name not in listed}
            for entry, (path, field) in listed.items():
                numbers = [number for number, part in enumerate(parts) if entry in part]
                if len({parts[number][entry] for number in numbers}) == 1 and len(numbers) == len(parts):
                    found[entry] = Entry(replace(field, name=entry), entry, attribute, path, numbers)
                for number in numbers:
                    own, single = parts[number][entry]
                    name, words = f"{entry}_{number + 1}", f"{single.words}, of {kind} {number + 1}"
                    found[name] = Entry(replace(single, name=name, words=words), entry, attribute, own, [number])
        return found

    @property
    def _of_rotor(self) -> Mapping[str, Field]:
        """Fields of the numbers of the rotor itself: of a rigid one that are stated."""
        return {name: field for name, field in self.rotor.fields.items() if getattr(self.rotor, name) is not None}

    @property
    def varied(self) -> Mapping[str, Field]:
        """Parameters that :meth:`replace` can change: entries of all parts of a kind, and with its number of one, such as ``proportional_2``."""
        fields = {name: each.field for name, each in self.entries.items()}
        own = {name: field for name, field in fields.items() if name == self.entries[name].entry}
        return {**self._of_rotor, **WHOLE, GRAVITY_NAME: SETTINGS[GRAVITY_NAME], **own, **fields}

    @property
    def varied_in_model(self) -> dict[str, Field]:
        """Fields of what a model of the machine may vary: not its weight, which is a force on it; and never zero what then would leave out states."""
        found = {name: field for name, field in self.varied.items() if name != GRAVITY_NAME}
        of_states = {name: each for name, each in self.entries.items() if each.entry in OF_STATES}
        for name, entry in of_states.items():
            found[name] = replace(entry.field, zero=False)
            if not all(entry.values(self)):
                del found[name]
        return found

    @checked
    def value(self, name: str) -> float:
        """Return the value of a parameter, in SI units.

        Raises
        ------
        InputError
            The name is unknown, or the parts have different values.
        """
        if name == "clearance" and len(set(self.clearances)) > 1:
            raise InputError(name, list(self.clearances), "the same at all here; each touchdown bearing has its own")
        if name in self._of_rotor:
            return float(getattr(self.rotor, name))
        if name in WHOLE:
            return self.clearances[0] if name == "clearance" else self.speed
        if name == GRAVITY_NAME:
            return self.gravity.acceleration if self.gravity else 0.0
        entry = self._entry(name, "wanted")
        values = entry.values(self)
        if len(set(values)) > 1:
            names = ", ".join(f"{name}_{number + 1}" for number in entry.numbers)
            allowed = f"the same at all here; {names} are those of each {_KINDS[entry.attribute][0]}"
            raise InputError(name, values, allowed)
        return values[0]

    def replace(self, **changes: Any) -> Self:
        """Return the machine with other values of parameters: numbers in SI units, or text with a unit.

        Names of all parts are set before those of single ones.

        Raises
        ------
        InputError
            A name is unknown, or a value not allowed.
        """
        machine: Any = self
        for name in sorted(changes, key=lambda name: name[-1:].isdigit()):
            machine = replace(machine, **machine._changes(name, changes[name]))
        return machine

    def _changes(self, name: str, given: object) -> dict[str, object]:
        if name == "clearance":
            return {"clearance": given, "touchdowns": [replace(each, clearance=None) for each in self.touchdowns]}
        if name in self._of_rotor:
            rotor: Any = self.rotor
            return {"rotor": replace(rotor, **{name: given})}
        if name in WHOLE:
            return {name: given}
        if name == GRAVITY_NAME:
            value = read_quantity(SETTINGS[GRAVITY_NAME], given)
            return {"gravity": replace(self.gravity or Gravity(), acceleration=value)}
        entry = self._entry(name, given)
        value, parts = read_quantity(entry.field, given), list(getattr(self, entry.attribute))
        for number in entry.numbers:
            try:
                parts[number] = _changed(parts[number], entry.path, value)
            except InputError as problem:  # what it does not go with has the name of the entry in its own table
                raise InputError(name, shown(given), f"{problem.field}: {problem.allowed}") from None
        return {entry.attribute: parts}

    def _entry(self, name: str, given: object) -> Entry:
        if name not in self.entries:
            raise self.unknown(name, given)
        return self.entries[name]

    def unknown(self, name: str, given: object, besides: Mapping[str, object] | None = None) -> InputError:
        """Error for a name that does not exist: allowed are listed without those of single parts; ``besides`` has names of other things."""
        where = "this machine, which has entries of one part by its number, such as proportional_2"
        return unknown_name(name, given, {**self.varied, **(besides or {})}, where)
