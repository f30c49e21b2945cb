"""Write the tables of a machine file with ``[rotor]``, so that they are read as the same machine, bit for bit."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.parameters import Field
from carom.parameters.tables import toml_line
from carom.rotors.controllers import state_space_of
from carom.rotors.part_tables import ATTACHED, PARTS, PLACED, RENAMED, ROTOR_ENTRIES

if TYPE_CHECKING:
    from carom.rotors.flexible_machine import FlexibleMachine


def machine_toml(machine: FlexibleMachine, modes: int) -> str:
    """Tables of a machine by so many modes of its rotor; empty if that has matrices which are in no file."""
    rotor = machine.rotor
    if rotor.entries is None:
        return ""
    damping = getattr(rotor, "own_damping", None)
    own = {"speed": machine.speed, "clearance": machine.clearance, **({"modes": modes} if rotor.bends else {})}
    own |= {entry: getattr(damping, name) for entry, name in RENAMED.items() if hasattr(damping, name)}
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
        if name == "controller" and not dataclasses.is_dataclass(value):
            value = state_space_of(value)
        if dataclasses.is_dataclass(value):
            found |= _entries(value)
        elif value is not None:
            found[name] = value.tolist() if isinstance(value, np.ndarray) else value
    return found


def _table(head: str, entries: dict[str, Any], fields: Any) -> str:
    units = {name: field.unit for name, field in fields.items() if isinstance(field, Field)}
    if entries.get("exponent", 1.0) != 1.0:
        units["stiffness"] += f"^{entries['exponent']:.6g}"
    lines = [toml_line(name, value, units.get(name, "")) for name, value in entries.items()]
    return "\n".join([head, *lines]) + "\n"
