"""Tables of a machine file with ``[rotor]``: what each may hold, what it must, and the part that it makes; how a machine is written as such."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.base.outcome import InputError, shown, together
from carom.parameters import MACHINE_FIELDS, TOUCHDOWN_FIELDS, Field, TouchdownBearing
from carom.parameters.fields import by_name, unknown_name
from carom.parameters.tables import toml_line
from carom.rotors.attachments import (
    HOUSING_FIELDS,
    PLANE_FIELDS,
    SEATED,
    UNBALANCE_FIELDS,
    Housing,
    TouchdownPlane,
    Unbalance,
)
from carom.rotors.controllers import (
    PID,
    PID_FIELDS,
    Controller,
    SecondOrderSections,
    Series,
    TransferFunction,
    VoltagePID,
    ZerosPolesGain,
)
from carom.rotors.filters import LEAD_FIELDS, LOW_PASS_FIELDS, NOTCH_FIELDS, LeadLag, LowPass, Notch
from carom.rotors.flexible_rotor import LONGEST
from carom.rotors.magnetic_bearing import BEARING_FIELDS, MagneticBearing
from carom.rotors.rigid_body import POSITION, RIGID_FIELDS
from carom.rotors.shaft_parts import (
    AXIAL_FORCE,
    DISC_FIELDS,
    MATERIAL_FIELDS,
    MODAL_FIELDS,
    PROPORTIONAL_FIELDS,
    SECTION_FIELDS,
    Disc,
    Material,
    ModalDamping,
    ProportionalDamping,
    ShaftSection,
)
from carom.rotors.shared_controller import ForcePID, MomentPID, SharedController
from carom.rotors.state_spaces import SAMPLE_TIME, StateSpace
from carom.rotors.support import SUPPORT_FIELDS, Support

if TYPE_CHECKING:
    from carom.rotors.flexible_machine import FlexibleMachine

RENAMED = {"damping_ratio": "ratio", "damping_of_mass": "of_mass", "damping_of_stiffness": "of_stiffness"}
"""Entries of ``[rotor]``, and the numbers of a damping that they are."""
INTERNAL = {"internal_damping_ratio": "ratio", "internal_damping_of_stiffness": "of_stiffness"}
"""The same of damping that turns with the shaft."""
ROTOR_ENTRIES: Mapping[str, Any] = {
    "speed": MACHINE_FIELDS["speed"],
    **MATERIAL_FIELDS,
    "axial_force": AXIAL_FORCE,
    "longest_element": LONGEST,
    "source": None,
    "accuracy": Field("accuracy", "", "error of contact forces by reduction", "a number", "", 1e-9, 1.0, "0.02"),
    "modes": Field(
        "modes", "", "modes of the free rotor, in place of an accuracy", "a whole number", "", 1, 1e4, "8", whole=True
    ),
    "clearance": MACHINE_FIELDS["clearance"],
    **dict.fromkeys((*RENAMED, *INTERNAL)),
    **RIGID_FIELDS,
}
ATTACHED = {
    "bearings": "magnetic_bearing",
    "touchdowns": "touchdown",
    "unbalances": "unbalance",
    "supports": "support",
    "shared_controllers": "shared_controller",
    "housings": "housing",
}
"""Parts of a machine beside its rotor, and their tables."""
PLACED = {"position": "node", "sensor_positions": "sensor_nodes"}
"""Entries of the parts of a rigid rotor, and those that they stand for."""
_SAMPLED = {"sample_time": SAMPLE_TIME}


class _Kind(NamedTuple):
    """A kind of controller or filter: what it may hold, besides what it needs, and what it makes."""

    make: Callable[..., Controller]
    needed: tuple[str, ...]
    entries: Mapping[str, Field | None]


_QUOTIENTS = (
    _Kind(TransferFunction, ("numerator", "denominator"), _SAMPLED),
    _Kind(ZerosPolesGain, ("zeros", "poles", "gain"), _SAMPLED),
    _Kind(SecondOrderSections, ("sos",), _SAMPLED),
    _Kind(StateSpace, ("A", "B", "C", "D"), _SAMPLED),
)
_PARTS_OF_SHARED: Mapping[str, type[PID]] = {"translation": ForcePID, "tilt": MomentPID}
_CONTROLLERS = (_Kind(PID, ("proportional",), {**PID_FIELDS, **_SAMPLED, "sampling": None}), *_QUOTIENTS)
_FILTERS = (
    _Kind(Notch, ("notch_frequency",), NOTCH_FIELDS),
    _Kind(LeadLag, ("lead_zero", "lead_pole"), LEAD_FIELDS),
    _Kind(LowPass, ("low_pass_frequency",), LOW_PASS_FIELDS),
    *_QUOTIENTS,
)


def entries_in(entry: Mapping[str, object], names: Iterable[str]) -> dict[str, Any]:
    """The entries of these names that a table holds."""
    return {name: entry[name] for name in names if name in entry}


def require(entry: Mapping[str, object], names: Iterable[str]) -> None:
    """Refuse a table without one of these entries."""
    for name in names:
        if name not in entry:
            raise InputError(name, None, "must be stated")


def damping_of(whole: Mapping[str, Any], names: Mapping[str, str] = RENAMED) -> ModalDamping | ProportionalDamping:
    """Damping by the entries of ``[rotor]`` with these names, one of which has to be there."""
    modal, proportional = (
        {names[name]: whole[name] for name in names if name in whole and names[name] in fields}
        for fields in (MODAL_FIELDS, PROPORTIONAL_FIELDS)
    )
    if bool(modal) == bool(proportional):
        own, *others = names
        allowed = f"{own} (of all bending modes, such as 0.005), or {' and '.join(others)}"
        raise InputError(own.removesuffix("_ratio"), None if not modal else "both", f"one of: {allowed}")
    try:
        return ModalDamping(**modal) if modal else ProportionalDamping(**proportional)
    except InputError as problem:
        entries = {number: name for name, number in names.items()}
        raise together(
            [InputError(entries.get(each.field, each.field), each.value, each.allowed) for each in problem.errors]
        ) from None


def internal_of(whole: Mapping[str, object]) -> ModalDamping | ProportionalDamping | None:
    """Damping that turns with the shaft, if it is stated."""
    return damping_of(whole, INTERNAL) if entries_in(whole, INTERNAL) else None


def _section(entry: Mapping[str, Any]) -> ShaftSection:
    return ShaftSection(**entries_in(entry, SECTION_FIELDS), material=Material(**entries_in(entry, MATERIAL_FIELDS)))


def _disc(entry: Mapping[str, Any]) -> Disc:
    if "width" in entry:
        body = {**entry, "length": entry["width"]}
        require(body, PARTS["section"].needed)
        return Disc.of_body(entry["node"], _section(body))
    require(entry, DISC_FIELDS)
    return Disc(**entries_in(entry, ("node", *DISC_FIELDS)))


def _bearing(entry: Mapping[str, Any]) -> MagneticBearing:
    if "y" in entry:
        first = {name: value for name, value in entry.items() if name != "y"}
        of_law = {**PID_FIELDS, **_OF_CONTROLLER}
        given = _inner(entry, "y", {**BEARING_FIELDS, **of_law}, "[magnetic_bearing.y]")
        has_law = any(name in given for name in of_law if name != "filter")
        # What it does not state is as along the first axis: of a controller of its own nothing.
        shared = {name: value for name, value in first.items() if not (has_law and name in of_law)}
        return dataclasses.replace(_bearing(first), y=_bearing({**shared, **given}))
    own = entries_in(entry, ("node", "sensor_nodes", "at_regain", *BEARING_FIELDS))
    if not entries_in(entry, ("filter", *PID_FIELDS, *_OF_CONTROLLER)):
        return MagneticBearing(**own)
    return MagneticBearing(**own, controller=_controller(entry, VoltagePID if "sensor_gain" in entry else PID))


def _shared(entry: Mapping[str, Any]) -> SharedController:
    """A controller of several bearings, the parts of which are tables of their own."""
    own: dict[str, Any] = entries_in(entry, ("bearings", "at_regain"))
    for name, gains in _PARTS_OF_SHARED.items():
        if name in entry:
            known = {**PID_FIELDS, **_OF_CONTROLLER}
            own[name] = _controller(_inner(entry, name, known, f"[shared_controller.{name}]"), gains)
    if matrices := entries_in(entry, ("A", "B", "C", "D", "sample_time")):
        require(entry, ("A", "B", "C", "D"))
        own["matrices"] = StateSpace(**matrices)
    return SharedController(**own)


def _inner(entry: Mapping[str, object], name: str, known: Mapping[str, object], head: str) -> Mapping[str, object]:
    """A table in a table, with names that are known."""
    given: object = entry[name]
    if not isinstance(given, Mapping):
        raise InputError(name, shown(given), f"a table that starts with the line {head}")
    _check_names(given, known, head)
    return given


def _check_names(entry: Mapping[str, object], known: Mapping[str, object], where: str) -> None:
    """Refuse the first unknown name of a table."""
    if unknown := [name for name in entry if name not in known]:
        raise unknown_name(unknown[0], entry[unknown[0]], known, where)


def _controller(entry: Mapping[str, object], gains: type[PID]) -> Controller:
    """The controller of a table, with its filters."""
    found, filters = _of_kind("controller", entry, _CONTROLLERS, gains), []
    listed = entry.get("filter", [])
    if not isinstance(listed, list) or not all(isinstance(each, Mapping) for each in listed):
        raise InputError(
            "filter", shown(listed), "tables that start with the line [[magnetic_bearing.filter]], one for each"
        )
    for number, each in enumerate(listed, start=1):
        known = dict.fromkeys(name for kind in _FILTERS for name in (*kind.needed, *kind.entries))
        try:
            _check_names(each, known, "[[magnetic_bearing.filter]]")
            filters.append(_of_kind("filter", each, _FILTERS))
        except InputError as problem:
            raise problem.under(f"filter {number}: ") from None
    return Series(found, filters) if filters else found


def _of_kind(what: str, entry: Mapping[str, object], kinds: Iterable[_Kind], gains: type[PID] = PID) -> Controller:
    """The controller or filter that a table states."""
    stated = [
        each
        for each in kinds
        if entries_in(entry, {**dict.fromkeys(each.needed), **each.entries}.keys() - _SAMPLED.keys())
    ]
    if len(stated) != 1:
        allowed = "; or ".join(" and ".join(each.needed) for each in kinds)
        raise InputError(what, ", ".join(each.needed[0] for each in stated) or None, f"one of: {allowed}")
    kind = stated[0]
    require(entry, kind.needed)
    make: Callable[..., Controller] = gains if kind.make is PID else kind.make
    return make(**entries_in(entry, dict.fromkeys((*kind.needed, *kind.entries))))


def _plane(entry: Mapping[str, Any]) -> TouchdownPlane:
    bearing = TouchdownBearing(**entries_in(entry, ("law", *TOUCHDOWN_FIELDS)))
    return TouchdownPlane(entry["node"], bearing, **entries_in(entry, PLANE_FIELDS))


class PartTable(NamedTuple):
    """The table of a part: what it may hold, what it must, and what it makes."""

    entries: Mapping[str, Any]
    needed: tuple[str, ...]
    make: Callable[[dict[str, Any]], Any]


_NODE, _PLACE = {"node": None}, {"node": None, "position": POSITION}
_DIAMETERS = by_name(*(SECTION_FIELDS[name] for name in ("outer_diameter", "inner_diameter")))
_OF_BEARING = {"sensor_nodes": None, "sensor_positions": None, "at_regain": None, **BEARING_FIELDS, **PID_FIELDS}
_OF_CONTROLLER = {
    **dict.fromkeys(name for kind in _QUOTIENTS for name in kind.needed),
    **_SAMPLED,
    "source": None,
    "sampling": None,
    "filter": None,
}
PARTS: Mapping[str, PartTable] = {
    "section": PartTable({**SECTION_FIELDS, **MATERIAL_FIELDS}, ("length", "outer_diameter"), _section),
    "disc": PartTable({**_NODE, **DISC_FIELDS, "width": None, **_DIAMETERS, **MATERIAL_FIELDS}, ("node",), _disc),
    "magnetic_bearing": PartTable({**_PLACE, **_OF_BEARING, **_OF_CONTROLLER, "y": None}, ("node", "ki", "ks"), _bearing),
    "shared_controller": PartTable({"bearings": None, **dict.fromkeys(_PARTS_OF_SHARED), **dict.fromkeys("ABCD"), **_SAMPLED, "source": None, "at_regain": None}, (), _shared),
    "support": PartTable({**_PLACE, **SUPPORT_FIELDS, "speeds": MACHINE_FIELDS["speed"]}, ("node", "kxx", "kyy"), lambda entry: Support(**entry)),
    "housing": PartTable({**HOUSING_FIELDS, **dict.fromkeys(SEATED)}, ("mass", "stiffness"), lambda entry: Housing(**entry)),
    "touchdown": PartTable({**_PLACE, "law": None, **PLANE_FIELDS, **TOUCHDOWN_FIELDS}, ("node", "law", "rotor_radius", "friction", "clearance"), _plane),
    "unbalance": PartTable({**_PLACE, **UNBALANCE_FIELDS}, ("node", "size"), lambda entry: Unbalance(**entry)),
}  # fmt: skip
"""The table of each part."""


def machine_toml(machine: FlexibleMachine, modes: int) -> str:
    """Tables of a machine by so many modes of its rotor; empty if that has matrices which are in no file."""
    rotor = machine.rotor
    if rotor.entries is None:
        return ""
    damping = getattr(rotor, "own_damping", None)
    own = {"speed": machine.speed, "clearance": machine.clearance, **({"modes": modes} if rotor.bends else {})}
    for given, names in ((damping, RENAMED), (getattr(rotor, "internal", None), INTERNAL)):
        own |= {entry: getattr(given, name) for entry, name in names.items() if hasattr(given, name)}
    tables = [_table("[rotor]", own | dict(rotor.entries), ROTOR_ENTRIES)]
    for kind, part in _parts(machine):
        entries = _entries(part)
        if not rotor.bends:
            stations = rotor.node_places
            entries = {
                name: stations[entries.pop(node)].tolist() for name, node in PLACED.items() if node in entries
            } | entries
        tables.append(_table(f"[[{kind}]]", entries, PARTS[kind].entries))
    return "\n".join(tables)


def _parts(machine: FlexibleMachine) -> Iterator[tuple[str, object]]:
    """All parts, each with the name of its table."""
    for kind in ("section", "disc"):
        for part in getattr(machine.rotor, f"{kind}s", ()):
            yield kind, part
    for name, kind in ATTACHED.items():
        for part in getattr(machine, name):
            yield kind, part


def _entries(part: Any) -> dict[str, Any]:
    """Entries of the table of a part: its attributes that are stated, and those of its material, controller or touchdown bearing."""
    found: dict[str, Any] = {}
    for name in (field.name for field in dataclasses.fields(part)):
        value = getattr(part, name)
        if name in (*_PARTS_OF_SHARED, "y") and value is not None:
            kept = ("node", "sensor_nodes", "ki", "at_regain")
            found[name] = {key: each for key, each in _entries(value).items() if key not in kept}
        elif dataclasses.is_dataclass(value):
            found |= _entries(value)
        elif name == "filters":
            found["filter"] = [_entries(each) for each in value]
        elif name == "rate" and np.any(value):
            raise InputError("controller", "matrices with an ideal derivative", "one that a machine file can hold")
        elif name == "rate":
            continue
        elif isinstance(value, np.ndarray):
            found[name] = value.tolist()
        elif value is not None and (name, value) != ("speeds", ()):
            found[name] = value
    return found


def _table(head: str, entries: dict[str, Any], fields: Any) -> str:
    units = {name: field.unit for name, field in fields.items() if isinstance(field, Field)}
    if entries.get("exponent", 1.0) != 1.0:
        units["stiffness"] += f"^{entries['exponent']:.6g}"
    filters = entries.get("filter", [])
    if "sensor_gain" in entries:
        units |= {name: field.unit for name, field in VoltagePID.fields.items()}
    lines = [
        toml_line(name, value, units.get(name, ""))
        for name, value in entries.items()
        if name != "filter" and name not in (*_PARTS_OF_SHARED, "y")
    ]
    own = {name: field for kind in _FILTERS for name, field in kind.entries.items()}
    inner = [_table(f"[[{head.strip('[]')}.filter]]", each, own) for each in filters]
    if "y" in entries:
        inner.append(_table("[magnetic_bearing.y]", entries["y"], fields))
    inner += [
        _table(f"[shared_controller.{name}]", entries[name], kind.fields)
        for name, kind in _PARTS_OF_SHARED.items()
        if name in entries
    ]
    return "\n".join([head, *lines, *inner]) + "\n"
