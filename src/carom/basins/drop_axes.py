"""What is varied in basins of drops: a number of the release, or a parameter of the machine."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from carom.models import Axis, Rotor, axis
from carom.models.axes import Ends, read_interval, usual_range
from carom.motions import Drop
from carom.outcome import InputError
from carom.parameters import Field, own_size
from carom.parameters.told import number

TURN = 2.0 * math.pi
RELEASED: Mapping[str, Axis] = {
    field.name: Axis(field)
    for field in (
        Field(
            "phase",
            "",
            "phase of the unbalance at the release",
            "an angle",
            "rad",
            -1e6,
            1e6,
            '"90 deg"',
            usual="°",
            usual_size=math.radians(1.0),
        ),
        Field(
            "regained_after",
            "",
            "time until levitation is back",
            "a time",
            "s",
            1e-9,
            1e6,
            '"50 ms"',
            usual="ms",
            usual_size=1e-3,
        ),
        Field(
            "race_speed",
            "",
            "speed of the race at the release",
            "an angular speed",
            "rad/s",
            -1e6,
            1e6,
            '"500 rpm"',
            usual="rpm",
            usual_size=math.pi / 30.0,
        ),
    )
}
"""What of the release itself can be varied, besides the parameters of the machine."""
_OWN_UNITS = {"regained_after": "time", "race_speed": "speed"}
"""Those that a drop has in units of the equations."""
Node: TypeAlias = tuple[Rotor, Drop]


def varied_of(rotor: Rotor, name: str) -> Axis:
    """What is varied under a name: of the release, or a parameter of the machine."""
    return RELEASED[name] if name in RELEASED else axis(rotor, name)


def told_value(varied: Axis, value: float) -> str:
    """A value with its name, in the unit in which people say it."""
    return _with_unit(varied, number(varied.field.in_usual_unit(value)))


def told_range(varied: Axis, values: np.ndarray) -> str:
    """The first and last of values with their name."""
    low, high = (number(varied.field.in_usual_unit(float(value))) for value in values[[0, -1]])
    return _with_unit(varied, f"{low} to {high}")


def _with_unit(varied: Axis, text: str) -> str:
    unit = varied.field.usual_unit
    return f"{varied.name.replace('_', ' ')} {text}{'' if unit == '°' else ' '}{unit}".rstrip()


def present_of(rotor: Rotor, released: Drop, varied: Axis) -> float:
    """Value of the present machine and release, in SI units; NaN if it has none."""
    if varied.name not in RELEASED:
        return varied.value(rotor)
    if varied.name == "phase":
        return math.remainder(released.unbalance_angle(rotor) - rotor.direction_of_fall, TURN) % TURN
    given = getattr(released, varied.name)
    if given is None:
        return 0.0 if varied.name == "race_speed" else math.nan
    kind = _OWN_UNITS[varied.name]
    return own_size(varied.name, given, kind, rotor.scales) * float(getattr(rotor.scales, kind))


def values_of(varied: Axis, present: float, given: Ends | None, count: int) -> np.ndarray:
    """Values over a range; those of the phase are the middles of cells that fill a turn, unless a range is given."""
    if given is None and varied.name == "phase":
        return TURN * (np.arange(count) + 0.5) / count
    if given is None and varied.name in RELEASED and not present > 0.0:
        raise InputError("ranges", None, f"needed: the drop states no {varied.name} around which a range could be")
    return np.linspace(*read_interval(varied, given or usual_range(varied, present, "ranges")), count)


def moved(rotor: Rotor, released: Drop, axes: tuple[Axis, Axis], node: tuple[float, float]) -> Node:
    """Machine and release of a node; the release comes last, for its units may be those of the machine."""
    for varied, value in sorted(zip(axes, node, strict=True), key=lambda pair: pair[0].name in RELEASED):
        if varied.name not in RELEASED:
            rotor = varied.move(rotor, value)
        else:
            kind = _OWN_UNITS.get(varied.name)
            unit = 1.0 if kind is None else float(getattr(rotor.scales, kind))
            changes: dict[str, Any] = {varied.name: value / unit}
            released = replace(released, **changes)
    return rotor, released
