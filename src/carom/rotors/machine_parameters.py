"""Named parameters of a flexible machine: one list of names for settings, sweeps, gain maps and branches.

A name such as ``proportional`` or ``friction`` is that of all magnetic bearings, or all touchdown bearings, at once; with the number of one of them, as
the tables of a machine file are counted from 1, of that one: ``proportional_2``.  Entries of touchdown bearings have the prefix that they have
for the planar rotor: ``touchdown_stiffness``.  The size of an unbalance is ``unbalance``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from carom.outcome import InputError, shown
from carom.parameters import MACHINE_FIELDS, SETTINGS, TOUCHDOWN_FIELDS, Field, Gravity, read_quantity
from carom.parameters.fields import nearest_name
from carom.parameters.settings import GRAVITY_NAME
from carom.parameters.touchdown_bearing import BALL_FIELDS, PREFIX
from carom.rotors.attachments import PLANE_FIELDS, UNBALANCE_FIELDS, TouchdownPlane, Unbalance
from carom.rotors.controllers import PID, PID_FIELDS
from carom.rotors.magnetic_bearing import BEARING_FIELDS, MagneticBearing
from carom.rotors.support import SUPPORT_FIELDS

if TYPE_CHECKING:
    from carom.rotors.flexible_machine import FlexibleMachine

WHOLE: Mapping[str, Field] = {name: MACHINE_FIELDS[name] for name in ("speed", "clearance")}
"""Parameters of the machine as a whole, beside its weight."""
OF_STATES = ("integral", "derivative", "delay")
"""Entries at zero of which a controller has fewer states."""


@dataclass(frozen=True)
class _Parts:
    """The parts of one kind, and how their entries are read and changed; an entry that is ``None`` is not there."""

    attribute: str
    words: str
    fields: Mapping[str, Field]
    read: Callable[[Any, str], Any]
    change: Callable[[Any, str, Any], Any]

    def having(self, machine: FlexibleMachine, name: str) -> list[int]:
        """Which parts have an entry."""
        return [number for number, part in enumerate(self.of(machine)) if self.read(part, name) is not None]

    def of(self, machine: FlexibleMachine) -> Sequence[Any]:
        parts: Sequence[Any] = getattr(machine, self.attribute)
        return parts


def _of_bearing(bearing: MagneticBearing, name: str) -> Any:
    if name in BEARING_FIELDS:
        return getattr(bearing, name)
    return getattr(bearing.controller, name) if isinstance(bearing.controller, PID) else None


def _changed_bearing(bearing: MagneticBearing, name: str, value: Any) -> MagneticBearing:
    if name in BEARING_FIELDS:
        return replace(bearing, **{name: value})
    controller: Any = bearing.controller
    return replace(bearing, controller=replace(controller, **{name: value}))


def _of_plane(plane: TouchdownPlane, name: str) -> Any:
    return getattr(plane, name) if name in PLANE_FIELDS else plane.bearing.given.get(name.removeprefix(PREFIX))


def _changed_plane(plane: TouchdownPlane, name: str, value: Any) -> TouchdownPlane:
    if name in PLANE_FIELDS:
        return replace(plane, **{name: value})
    return replace(plane, bearing=plane.bearing.replace(**{name.removeprefix(PREFIX): value}))


def _of_unbalance(unbalance: Unbalance, name: str) -> Any:
    return unbalance.size


def _changed_unbalance(unbalance: Unbalance, name: str, value: Any) -> Unbalance:
    return replace(unbalance, size=value)


_KINDS = (
    _Parts("bearings", "magnetic bearing", {**PID_FIELDS, **BEARING_FIELDS}, _of_bearing, _changed_bearing),
    _Parts("supports", "support", SUPPORT_FIELDS, getattr, lambda part, name, value: replace(part, **{name: value})),
    _Parts(
        "touchdowns",
        "touchdown bearing",
        {
            **PLANE_FIELDS,
            **{PREFIX + name: SETTINGS[PREFIX + name] for name in TOUCHDOWN_FIELDS if name not in BALL_FIELDS},
        },
        _of_plane,
        _changed_plane,
    ),
    _Parts(
        "unbalances",
        "[[unbalance]]",
        {"unbalance": replace(UNBALANCE_FIELDS["size"], name="unbalance")},
        _of_unbalance,
        _changed_unbalance,
    ),
)


@dataclass(frozen=True)
class Entry:
    """An entry of parts, and which of them it changes."""

    field: Field
    parts: _Parts
    entry: str
    numbers: list[int]

    def values(self, machine: FlexibleMachine) -> list[float]:
        """Its values in these parts."""
        parts = self.parts.of(machine)
        return [float(self.parts.read(parts[number], self.entry)) for number in self.numbers]


def entries_of(machine: FlexibleMachine) -> dict[str, Entry]:
    """The entries of parts by the names of parameters: of all parts of a kind if each has it, and of each."""
    found = {}
    for parts in _KINDS:
        count = len(parts.of(machine))
        for entry, field in parts.fields.items():
            numbers = parts.having(machine, entry)
            if count and len(numbers) == count:
                found[entry] = Entry(replace(field, name=entry), parts, entry, numbers)
            for number in numbers:
                name, words = f"{entry}_{number + 1}", f"{field.words}, of {parts.words} {number + 1}"
                found[name] = Entry(replace(field, name=name, words=words), parts, entry, [number])
    return found


def rotor_fields(machine: FlexibleMachine) -> Mapping[str, Field]:
    """Fields of the numbers of the rotor itself: of a rigid one that are stated."""
    return {name: field for name, field in machine.rotor.fields.items() if getattr(machine.rotor, name) is not None}


def fields_of_machine(machine: FlexibleMachine) -> dict[str, Field]:
    """Fields of all parameters by name, those of single parts last."""
    entries = machine.entries
    own = {name: each.field for name, each in entries.items() if name == each.entry}
    single = {name: each.field for name, each in entries.items() if name != each.entry}
    return {**rotor_fields(machine), **WHOLE, GRAVITY_NAME: SETTINGS[GRAVITY_NAME], **own, **single}


def varied_in_model(machine: FlexibleMachine) -> dict[str, Field]:
    """Fields of what a model of the machine may vary: not its weight, which is a force on it; and never zero what then would leave out states."""
    found = {}
    for name, field in fields_of_machine(machine).items():
        entry = machine.entries.get(name)
        if entry is not None and entry.entry in OF_STATES:
            if all(entry.values(machine)):
                found[name] = replace(field, zero=False)
        elif name != GRAVITY_NAME:
            found[name] = field
    return found


def value_of_machine(machine: FlexibleMachine, name: str) -> float:
    """Value of a parameter in SI units; refuse an unknown name, and one whose values differ between parts."""
    if name == "clearance" and len(set(machine.clearances)) > 1:
        raise InputError(name, list(machine.clearances), "the same at all here; each touchdown bearing has its own")
    if name in rotor_fields(machine):
        return float(getattr(machine.rotor, name))
    if name in WHOLE:
        return machine.clearances[0] if name == "clearance" else machine.speed
    if name == GRAVITY_NAME:
        return machine.gravity.acceleration if machine.gravity else 0.0
    if name not in machine.entries:
        raise unknown(machine, name, "wanted")
    entry = machine.entries[name]
    values = entry.values(machine)
    if len(set(values)) > 1:
        names = ", ".join(f"{name}_{number + 1}" for number in entry.numbers)
        raise InputError(name, values, f"the same at all here; {names} are those of each {entry.parts.words}")
    return values[0]


def changed_machine(machine: FlexibleMachine, changes: Mapping[str, Any]) -> FlexibleMachine:
    """The machine with other values of parameters: numbers in SI units, or texts with a unit.

    Names of all parts are set before those of single ones.
    """
    for name in sorted(changes, key=lambda name: name[-1:].isdigit()):
        machine = _with(machine, name, changes[name])
    return machine


def _with(machine: FlexibleMachine, name: str, given: Any) -> FlexibleMachine:
    if name == "clearance":
        planes = [replace(each, clearance=None) for each in machine.touchdowns]
        return replace(machine, clearance=given, touchdowns=planes)
    if name in rotor_fields(machine):
        rotor: Any = machine.rotor
        return replace(machine, rotor=replace(rotor, **{name: given}))
    if name in WHOLE:
        return replace(machine, **{name: given})
    if name == GRAVITY_NAME:
        value = read_quantity(SETTINGS[GRAVITY_NAME], given)
        return replace(machine, gravity=replace(machine.gravity or Gravity(), acceleration=value))
    if name not in machine.entries:
        raise unknown(machine, name, given)
    entry = machine.entries[name]
    value = read_quantity(entry.field, given)
    parts = list(entry.parts.of(machine))
    for number in entry.numbers:
        try:
            parts[number] = entry.parts.change(parts[number], entry.entry, value)
        except InputError as problem:  # what it does not go with has the name of the entry in its own table
            raise InputError(name, shown(given), f"{problem.field}: {problem.allowed}") from None
    changed: dict[str, Any] = {entry.parts.attribute: parts}
    return replace(machine, **changed)


def unknown(machine: FlexibleMachine, name: str, given: Any, besides: Mapping[str, Any] | None = None) -> InputError:
    """Error for a name that does not exist: allowed are listed without those of single parts; ``besides`` has names of other things."""
    known = {**fields_of_machine(machine), **(besides or {})}
    nearest = nearest_name(name, known)
    advice = f"did you mean {nearest}? " if nearest else ""
    entries = machine.entries
    listed = ", ".join(each for each in known if each not in entries or entries[each].entry == each)
    allowed = f"unknown parameter of this machine; {advice}allowed: {listed}, and entries of one part by its number, such as proportional_2"
    return InputError(shown(name), shown(given), allowed)
