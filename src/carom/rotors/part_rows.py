"""The parts of a flexible machine in the units of people: the table of its report."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from carom.parameters import Field
from carom.parameters.fields import RPM
from carom.parameters.formats import format_angle, format_entry, number
from carom.rotors.attachments import PLANE_FIELDS
from carom.rotors.controllers import PID, PID_FIELDS
from carom.rotors.magnetic_bearing import BEARING_FIELDS
from carom.rotors.support import SUPPORT_FIELDS

if TYPE_CHECKING:
    from carom.rotors.flexible_machine import FlexibleMachine

_MILLIMETRES = 1e3


def part_rows(machine: FlexibleMachine) -> Iterator[tuple[str, str]]:
    """The rotor and what stands around it, part by part; places along the shaft are from its beginning."""
    places = _MILLIMETRES * machine.rotor.node_places

    def at(*nodes: int) -> str:
        return f"{' and '.join(number(float(places[node])) for node in nodes)} mm"

    yield "rotor", machine.rotor.words
    yield "speed", f"{number(machine.speed / RPM)} rpm"
    for place, bearing in enumerate(machine.bearings, start=1):
        controller = bearing.controller
        law = _entries(controller, PID_FIELDS) if isinstance(controller, PID) else type(controller).__name__
        seen = "" if bearing.sensor_nodes == (bearing.node,) else f", sensors at {at(*bearing.sensor_nodes)}"
        yield f"magnetic bearing {place}", f"at {at(bearing.node)}{seen}: {_entries(bearing, BEARING_FIELDS)}; {law}"
    for place, support in enumerate(machine.supports, start=1):
        yield f"support {place}", f"at {at(support.node)}: {_entries(support, SUPPORT_FIELDS)}"
    for place, (plane, clearance) in enumerate(zip(machine.touchdowns, machine.clearances, strict=True), start=1):
        room = format_entry(PLANE_FIELDS["clearance"], clearance)
        others = {name: field for name, field in PLANE_FIELDS.items() if name != "clearance"}
        shown = f"clearance {room}, {_entries(plane, others)}; {plane.bearing.words}"
        yield f"touchdown bearing {place}", f"at {at(plane.node)}: {shown}"
    for place, unbalance in enumerate(machine.unbalances, start=1):
        yield (
            f"unbalance {place}",
            f"at {at(unbalance.node)}: {number(1e6 * unbalance.size)} g mm, at {format_angle(unbalance.angle)}",
        )


def _entries(part: object, fields: Mapping[str, Field]) -> str:
    """Entries of a part by their names in the file, without those that are zero or not there."""
    given = ((name, getattr(part, name), field) for name, field in fields.items())
    return ", ".join(f"{name.replace('_', ' ')} {format_entry(field, value)}" for name, value, field in given if value)
