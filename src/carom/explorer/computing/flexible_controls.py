"""Parameters of a flexible machine that can be moved on the page: of all bearings together where they are equal, and of each by itself."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace

from carom.explorer.computing.controls import Control, with_unit
from carom.outcome import InputError, Problems, shown
from carom.parameters import MACHINE_FIELDS, SETTINGS, TERM_FIELDS, Field, read_quantity
from carom.rotors import FlexibleMachine

SHAFT, MAGNETS, TOUCHDOWNS, SINGLE = (
    "The shaft",
    "The controllers",
    "The touchdown bearings",
    "Each bearing by itself",
)
"""Headings of the controls, in their order."""


@dataclass(frozen=True)
class _Kind:
    group: str
    words: str
    unit: str
    reach: float
    """Ratio of the ends of the slider to the value of the machine."""
    least: float = 0.0
    """Least upper end of the slider, in its unit."""
    logarithmic: bool = True


_KINDS: Mapping[str, _Kind] = {
    "speed": _Kind(SHAFT, "speed", "rpm", 2.0, logarithmic=False),
    "unbalance": _Kind(SHAFT, "unbalance", "g mm", 4.0, logarithmic=False),
    "proportional": _Kind(MAGNETS, "P gain: stiffness", "A/m", 3.0),
    "integral": _Kind(MAGNETS, "I gain: takes out the sag", "A/m/s", 10.0, least=5000.0),
    "derivative": _Kind(MAGNETS, "D gain: damping", "A s/m", 4.0, least=10.0),
    "filter_time": _Kind(MAGNETS, "filter of the D part", "ms", 10.0),
    "delay": _Kind(MAGNETS, "delay of the controller", "ms", 5.0, least=0.2, logarithmic=False),
    "amplifier_bandwidth": _Kind(MAGNETS, "bandwidth of the amplifier", "Hz", 10.0),
    "current_limit": _Kind(MAGNETS, "largest current", "A", 5.0),
    "force_limit": _Kind(MAGNETS, "largest force", "N", 5.0),
    "slew_rate_limit": _Kind(MAGNETS, "fastest change of current", "A/s", 5.0),
    "clearance": _Kind(TOUCHDOWNS, "clearance", "mm", 3.0),
    "friction": _Kind(TOUCHDOWNS, "friction", "", 2.0, least=0.5, logarithmic=False),
    "touchdown_stiffness": _Kind(TOUCHDOWNS, "stiffness", "", 10.0),
    "touchdown_restitution": _Kind(TOUCHDOWNS, "restitution", "", 1.0, least=1.0, logarithmic=False),
    "touchdown_damping": _Kind(TOUCHDOWNS, "damping", "N s/m", 10.0, least=1000.0),
    "touchdown_dissipation": _Kind(TOUCHDOWNS, "losses (dissipation)", "s/m", 10.0, least=1.0),
}
_LOWEST = {"speed": 0.25, "touchdown_restitution": 0.05}
"""Lower ends of sliders that are not logarithmic, over the value of the machine, where they are not zero."""
_ALWAYS = ("speed", "unbalance", "proportional", "integral", "derivative", "delay")
"""What has a slider although it is zero."""


def controls_of_machine(machine: FlexibleMachine) -> tuple[Control, ...]:
    """Controls of a machine, those of single parts last."""
    return (*_shared(machine), *_single(machine))


def _shared(machine: FlexibleMachine) -> Iterator[Control]:
    fields = machine.varied
    for name, kind in _KINDS.items():
        if name in fields and (value := _value(machine, name)) is not None and (value or name in _ALWAYS):
            yield _control(machine, name, kind, value)


def _single(machine: FlexibleMachine) -> Iterator[Control]:
    """One for each part that is not the only one of its kind."""
    fields, entries = machine.varied, machine.entries
    for name, entry in entries.items():
        own = entry.entry
        if name == own or own not in _KINDS or len(entry.parts.of(machine)) < 2:
            continue
        kind, value, number = _KINDS[own], machine.value(name), name.rpartition("_")[2]
        if not value and own not in _ALWAYS:
            continue
        words = {SHAFT: "", MAGNETS: "magnetic bearing", TOUCHDOWNS: "touchdown bearing"}[kind.group]
        named = replace(
            kind, words=f"{words or kind.words} {number}" + (f": {kind.words.partition(':')[0]}" if words else "")
        )
        shared = own if own in fields and _value(machine, own) is not None else ""
        yield replace(_control(machine, name, named, value), group=SINGLE, among=shared)


def _value(machine: FlexibleMachine, name: str) -> float | None:
    """Value of a parameter, in SI units; ``None`` if parts differ in it."""
    try:
        return machine.value(name)
    except InputError:
        return None


def _size(field: Field, unit: str) -> float:
    """Size of a unit, in SI units, of which that of a curved stiffness is one."""
    return read_quantity(replace(field, lowest=0.0, highest=math.inf), f"1 {unit}") if unit and "^" not in unit else 1.0


def _control(machine: FlexibleMachine, name: str, kind: _Kind, value: float) -> Control:
    field, unit = machine.varied[name], kind.unit
    if name.startswith("touchdown_stiffness"):  # the unit of which depends on the exponent
        unit = machine.touchdowns[int(name.rpartition("_")[2]) - 1 if name[-1].isdigit() else 0].bearing.unit(
            "stiffness"
        )
    own = float(f"{value / _size(field, unit):.12g}")
    logarithmic = kind.logarithmic and own > 0.0
    high = max(kind.reach * own, kind.least)
    low = own / kind.reach if logarithmic else own * _LOWEST.get(name, 0.0)
    return Control(name, kind.words, unit, own, low, high, logarithmic, kind.group)


def values_of_machine(machine: FlexibleMachine, controls: Mapping[str, Control]) -> dict[str, float | None]:
    """Values of controls in their units; ``None`` of those of all parts that now differ."""
    fields, found = machine.varied, {}
    for name, control in controls.items():
        value = _value(machine, name)
        size = _size(fields[name], control.unit)
        found[name] = None if value is None else float(f"{value / size:.12g}")
    return found


def in_entries(
    machine: FlexibleMachine, controls: Mapping[str, Control], settings: Mapping[str, str]
) -> dict[str, str]:
    """Settings with each unbalance that is stated by a term, as ``G 2.5`` or by an eccentricity, as what ``--set`` reads.

    A grade is that of the whole rotor at the speed that is set with it; its unbalances have equal parts of it.
    """
    texts = {name: str(text) for name, text in settings.items()}
    try:
        speed = (
            read_quantity(SETTINGS["speed"], with_unit("rpm", texts["speed"])) if "speed" in texts else machine.speed
        )
    except InputError:  # refused where it is read
        speed = machine.speed
    for name, text in texts.items():
        if not name.startswith("unbalance") or name not in controls:
            continue
        for field, per_unit in ((TERM_FIELDS["balance_grade"], 1e-3 / speed), (MACHINE_FIELDS["eccentricity"], 1.0)):
            with suppress(InputError):
                size = read_quantity(field, with_unit(controls[name].unit, text)) * per_unit * machine.rotor.mass
                texts[name] = f"{1e6 * size / len(machine.unbalances):.9g} g mm"
    return texts


def machine_with(
    machine: FlexibleMachine, controls: Mapping[str, Control], settings: Mapping[str, str]
) -> FlexibleMachine:
    """The machine with other values of its controls, as texts in the units of the page or of their own; refuse all that cannot be used at once."""
    problems, texts = Problems(), {}
    fields = machine.varied
    for name, text in in_entries(machine, controls, settings).items():
        if name not in controls:
            problems.errors.append(InputError(shown(name), shown(text), f"one of: {', '.join(controls)}"))
            continue
        unit = controls[name].unit
        given = with_unit(unit, text)
        if "^" in unit:  # which the field does not read
            given = given.removesuffix(unit).strip()
        if problems.attempt(read_quantity, replace(fields[name], bare=unit), given) is not None:
            texts[name] = given
    problems.raise_all()
    return machine.replace(**texts)
