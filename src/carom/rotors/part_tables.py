"""Tables of a machine file with ``[rotor]``: what each may hold, what it must, and the part that it makes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from carom.base.outcome import InputError, together
from carom.parameters import MACHINE_FIELDS, TOUCHDOWN_FIELDS, Field, TouchdownBearing
from carom.parameters.fields import by_name
from carom.rotors.attachments import PLANE_FIELDS, UNBALANCE_FIELDS, TouchdownPlane, Unbalance
from carom.rotors.controllers import PID, PID_FIELDS, TransferFunction
from carom.rotors.damping import MODAL_FIELDS, PROPORTIONAL_FIELDS, ModalDamping, ProportionalDamping
from carom.rotors.discs import DISC_FIELDS, Disc
from carom.rotors.flexible_rotor import LONGEST
from carom.rotors.magnetic_bearing import BEARING_FIELDS, MagneticBearing
from carom.rotors.rigid_body import POSITION, RIGID_FIELDS
from carom.rotors.sections import MATERIAL_FIELDS, SECTION_FIELDS, Material, ShaftSection
from carom.rotors.state_spaces import StateSpace
from carom.rotors.support import SUPPORT_FIELDS, Support

RENAMED = {"damping_ratio": "ratio", "damping_of_mass": "of_mass", "damping_of_stiffness": "of_stiffness"}
"""Entries of ``[rotor]``, and the numbers of a damping that they are."""
ROTOR_ENTRIES: Mapping[str, Any] = {
    "speed": MACHINE_FIELDS["speed"],
    **MATERIAL_FIELDS,
    "longest_element": LONGEST,
    "source": None,
    "accuracy": Field("accuracy", "", "error of contact forces by reduction", "a number", "", 1e-9, 1.0, "0.02"),
    "modes": Field(
        "modes", "", "modes of the free rotor, in place of an accuracy", "a whole number", "", 1, 1e4, "8", whole=True
    ),
    "clearance": MACHINE_FIELDS["clearance"],
    **dict.fromkeys(RENAMED),
    **RIGID_FIELDS,
}
ATTACHED = {
    "bearings": "magnetic_bearing",
    "touchdowns": "touchdown",
    "unbalances": "unbalance",
    "supports": "support",
}
"""Parts of a machine beside its rotor, and their tables."""
PLACED = {"position": "node", "sensor_positions": "sensor_nodes"}
"""Entries of the parts of a rigid rotor, and those that they stand for."""
_QUOTIENT, _MATRICES = ("numerator", "denominator"), ("A", "B", "C", "D")
_CONTROLLERS: tuple[tuple[Callable[..., object], Iterable[str], tuple[str, ...]], ...] = (
    (PID, PID_FIELDS, ("proportional",)),
    (TransferFunction, _QUOTIENT, _QUOTIENT),
    (StateSpace, _MATRICES, _MATRICES),
)
"""Each with its entries, and those that it needs."""


def entries_in(entry: Mapping[str, object], names: Iterable[str]) -> dict[str, Any]:
    """The entries of these names that a table holds."""
    return {name: entry[name] for name in names if name in entry}


def require(entry: Mapping[str, object], names: Iterable[str]) -> None:
    """Refuse a table without one of these entries."""
    for name in names:
        if name not in entry:
            raise InputError(name, None, "must be stated")


def damping_of(whole: Mapping[str, Any]) -> ModalDamping | ProportionalDamping:
    """Damping by the entries of ``[rotor]``, one of which has to be there."""
    modal, proportional = (
        {RENAMED[name]: whole[name] for name in RENAMED if name in whole and RENAMED[name] in fields}
        for fields in (MODAL_FIELDS, PROPORTIONAL_FIELDS)
    )
    if bool(modal) == bool(proportional):
        allowed = "damping_ratio (of all bending modes, such as 0.005), or damping_of_mass and damping_of_stiffness"
        raise InputError("damping", None if not modal else "both", f"one of: {allowed}")
    try:
        return ModalDamping(**modal) if modal else ProportionalDamping(**proportional)
    except InputError as problem:
        entries = {number: name for name, number in RENAMED.items()}
        raise together(
            [InputError(entries.get(each.field, each.field), each.value, each.allowed) for each in problem.errors]
        ) from None


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
    stated = [each for each in _CONTROLLERS if entries_in(entry, each[1])]
    if len(stated) != 1:
        allowed = (
            "one of: proportional (with integral, derivative, filter_time), numerator and denominator, or A, B, C and D"
        )
        raise InputError("controller", ", ".join(needed[0] for *_, needed in stated) or None, allowed)
    kind, names, needed = stated[0]
    require(entry, needed)
    own = entries_in(entry, ("node", "sensor_nodes", "at_regain", *BEARING_FIELDS))
    return MagneticBearing(**own, controller=kind(**entries_in(entry, names)))


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
PARTS: Mapping[str, PartTable] = {
    "section": PartTable({**SECTION_FIELDS, **MATERIAL_FIELDS}, ("length", "outer_diameter"), _section),
    "disc": PartTable({**_NODE, **DISC_FIELDS, "width": None, **_DIAMETERS, **MATERIAL_FIELDS}, ("node",), _disc),
    "magnetic_bearing": PartTable({**_PLACE, **_OF_BEARING, **dict.fromkeys((*_QUOTIENT, *_MATRICES))}, ("node", "ki", "ks"), _bearing),
    "support": PartTable({**_PLACE, **SUPPORT_FIELDS}, ("node", "kxx", "kyy"), lambda entry: Support(**entry)),
    "touchdown": PartTable({**_PLACE, "law": None, **PLANE_FIELDS, **TOUCHDOWN_FIELDS}, ("node", "law", "rotor_radius", "friction", "clearance"), _plane),
    "unbalance": PartTable({**_PLACE, **UNBALANCE_FIELDS}, ("node", "size"), lambda entry: Unbalance(**entry)),
}  # fmt: skip
"""The table of each part."""
