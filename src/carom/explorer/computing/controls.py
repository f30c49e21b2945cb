"""Parameters that can be moved on the page, their ranges, and what people type."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from carom.base.outcome import InputError, Problems, printable, shown
from carom.models import rotor_of
from carom.parameters import SETTINGS, TERM_FIELDS, Case, Field, read_quantity
from carom.parameters.terms import set_by
from carom.parameters.touchdown_bearing import PREFIX

_BARE = re.compile(r"[\s\d.,'+-]*\d[\s\d.,']*(?:[eE][+-]?\d+)?\s*")
"""A number without a unit, which is in the unit shown beside its box."""
SHAFT, MAGNETS, TOUCHDOWNS = "The shaft", "The magnetic bearings", "The touchdown bearings"
SINGLE = "Each bearing by itself"
"""Headings of the controls, in their order."""


@dataclass(frozen=True)
class Control:
    """One parameter on the page.

    Attributes
    ----------
    name : str
        Name of the parameter, as in a machine file.
    words : str
        What an engineer calls it.
    unit : str
        Unit of all numbers here and of the box; empty for a pure number.
    value : float
        That of the machine.
    low, high : float
        Ends of the slider.
    logarithmic : bool
        Whether equal distances on the slider are equal ratios.
    group : str
        Heading under which it stands.
    among : str
        Name of the control of all parts together, one of which this moves; empty for any other.
    """

    name: str
    words: str
    unit: str
    value: float
    low: float
    high: float
    logarithmic: bool
    group: str = SHAFT
    among: str = ""


@dataclass(frozen=True)
class _ControlKind:
    group: str
    words: str
    unit: str
    reach: float
    """Ratio of the ends of the slider to the value of the machine."""
    least: float = 0.0
    """Least upper end of the slider, where the value of the machine is small."""
    most: float = math.inf
    logarithmic: bool = True
    low: float = 0.0
    """Lower end of a slider that is not logarithmic, unless the value of the machine lies below it."""


_KINDS: Mapping[str, _ControlKind] = {
    "speed": _ControlKind(SHAFT, "speed", "rpm", 2.0, logarithmic=False),
    "eccentricity": _ControlKind(SHAFT, "unbalance (eccentricity)", "mm", 2.0, logarithmic=False),
    "unbalance": _ControlKind(SHAFT, "unbalance", "g mm", 4.0, logarithmic=False),
    "stiffness": _ControlKind(MAGNETS, "stiffness (P gain)", "N/m", 4.0),
    "damping": _ControlKind(MAGNETS, "damping (D gain)", "N s/m", 5.0),
    "proportional": _ControlKind(MAGNETS, "P gain: stiffness", "A/m", 3.0),
    "integral": _ControlKind(MAGNETS, "I gain: takes out the sag", "A/m/s", 10.0, least=5000.0),
    "derivative": _ControlKind(MAGNETS, "D gain: damping", "A s/m", 4.0, least=10.0),
    "filter_time": _ControlKind(MAGNETS, "filter of the D part", "ms", 10.0),
    "gain_factor": _ControlKind(MAGNETS, "gain of the whole controller", "", 3.0),
    "delay": _ControlKind(MAGNETS, "delay of the controller", "ms", 5.0, least=0.2, logarithmic=False),
    "amplifier_bandwidth": _ControlKind(MAGNETS, "bandwidth of the amplifier", "Hz", 10.0),
    "current_limit": _ControlKind(MAGNETS, "largest current", "A", 5.0),
    "force_limit": _ControlKind(MAGNETS, "largest force", "N", 5.0),
    "slew_rate_limit": _ControlKind(MAGNETS, "fastest change of current", "A/s", 5.0),
    "clearance": _ControlKind(TOUCHDOWNS, "clearance", "mm", 3.0),
    "friction": _ControlKind(TOUCHDOWNS, "friction", "", 2.0, least=0.5, most=10.0, logarithmic=False),
    "restitution": _ControlKind(TOUCHDOWNS, "restitution", "", 1.0, least=1.0, most=1.0, logarithmic=False),
    "touchdown_stiffness": _ControlKind(TOUCHDOWNS, "touchdown stiffness", "N/m", 10.0),
    "touchdown_restitution": _ControlKind(
        TOUCHDOWNS, "touchdown restitution", "", 1.0, least=1.0, most=1.0, logarithmic=False, low=0.05
    ),
    "touchdown_damping": _ControlKind(TOUCHDOWNS, "touchdown damping", "N s/m", 10.0, least=1000.0),
    "touchdown_dissipation": _ControlKind(TOUCHDOWNS, "touchdown dissipation", "s/m", 10.0, least=1.0),
    "touchdown_internal_clearance": _ControlKind(TOUCHDOWNS, "internal clearance of the balls", "um", 10.0),
    "touchdown_preload": _ControlKind(TOUCHDOWNS, "axial preload of the balls", "N", 4.0),
}
_DIMENSIONLESS: Mapping[str, _ControlKind] = {
    "rho": _ControlKind(SHAFT, "unbalance ρ", "", 2.0, logarithmic=False),
    "omega": _ControlKind(MAGNETS, "stiffness: frequency ω over speed", "", 2.0),
    "gamma": _ControlKind(MAGNETS, "damping γ", "", 5.0),
    "mu": _ControlKind(TOUCHDOWNS, "friction μ", "", 2.0, least=0.5, most=10.0, logarithmic=False),
    "d": _ControlKind(TOUCHDOWNS, "restitution d", "", 1.0, least=1.0, most=1.0, logarithmic=False),
}
"""The same of a rotor that is given by numbers of its equations."""
_FIRST = 0.5
"""Lower end of the slider of the speed, over the speed of the machine."""
_STATED_AT_ZERO = ("unbalance", "proportional", "integral", "derivative", "delay")
"""Of what several parts may have, what has a slider although it is zero."""


def controls_of(case: Case) -> tuple[Control, ...]:
    """Controls of a machine, those of single parts last: in engineering units, or of one without scales its numbers."""
    return (*_shared(case), *_single(case))


def values_of(case: Case, controls: Mapping[str, Control] | None = None) -> dict[str, float | None]:
    """Values of the controls of a machine, in their units; ``None`` of those of all parts that now differ."""
    named = {each.name: each for each in controls_of(case)} if controls is None else controls
    return {name: _value(case, name, control.unit) for name, control in named.items()}


def _named(case: Case) -> Any:
    """What has the parameters: a flexible machine, of which also those that are zero can be set, or the rotor."""
    rotor = rotor_of(case)
    return rotor if rotor.finite_elements is None else rotor.finite_elements.machine


def _entries(case: Case) -> Mapping[str, Any]:
    """Entries that parts of a machine have, by name; none of a rotor with one of each."""
    reduced = rotor_of(case).finite_elements
    return {} if reduced is None else reduced.machine.entries


def _kinds(case: Case) -> Mapping[str, _ControlKind]:
    if "friction" not in _named(case).varied:
        return _DIMENSIONLESS
    of_controllers = {
        each.entry: _ControlKind(
            MAGNETS,
            each.field.words.partition(", of magnetic")[0],
            "Hz" if each.field.unit == "rad/s" else each.field.unit,
            3.0,
        )
        for each in _entries(case).values()
        if each.path[0] == "controller" and each.entry not in _KINDS and min(each.values(_named(case))) > 0.0
    }
    return {**_KINDS, **of_controllers}


def _shared(case: Case) -> Iterator[Control]:
    fields, parts, bearing = _named(case).varied, _entries(case), rotor_of(case).definition.bearing_at(0)
    stated = bearing.given if bearing else {}
    for name, kind in _kinds(case).items():
        # Of a touchdown bearing what it states; an entry that is not stated follows from others.
        if name not in fields or (name.startswith(PREFIX) and not parts and name.removeprefix(PREFIX) not in stated):
            continue
        if name == "clearance" and not parts:  # on which the units of the equations depend
            continue
        value = _value(case, name, _unit(case, name, kind))
        if value is not None and (value or name not in parts or name in _STATED_AT_ZERO):
            yield _control(case, name, kind, value)


def _single(case: Case) -> Iterator[Control]:
    """One for each part that is not the only one of its kind."""
    shared = {control.name for control in _shared(case)}
    kinds = _kinds(case)
    for name, entry in _entries(case).items():
        own = entry.entry
        if name == own or own not in kinds or len(getattr(_named(case), entry.attribute)) < 2:
            continue
        kind, number = kinds[own], name.rpartition("_")[2]
        value = _value(case, name, _unit(case, name, kind))
        if value or own in _STATED_AT_ZERO:
            part = {MAGNETS: "magnetic bearing", TOUCHDOWNS: "touchdown bearing"}.get(kind.group)
            words = f"{part} {number}: {kind.words.partition(':')[0]}" if part else f"{kind.words} {number}"
            found = _control(case, name, replace(kind, words=words), value or 0.0)
            yield replace(found, group=SINGLE, among=own if own in shared else "")


def _value(case: Case, name: str, unit: str) -> float | None:
    """Value of a parameter in a unit; ``None`` if parts differ in it."""
    named = _named(case)
    try:
        return float(f"{named.value(name) / _size(named.varied[name], unit):.12g}")
    except InputError:
        return None


def _unit(case: Case, name: str, kind: _ControlKind) -> str:
    """Unit of a control: that of a stiffness depends on its exponent."""
    if not name.startswith("touchdown_stiffness"):
        return kind.unit
    place = int(name.rpartition("_")[2]) - 1 if name[-1].isdigit() else 0
    bearing: Any = _named(case).touchdowns[place].bearing if _entries(case) else rotor_of(case).definition.bearing_at(0)
    return str(bearing.unit("stiffness"))


def _size(field: Field, unit: str) -> float:
    """Size of a unit, in SI units, of which that of a curved stiffness is one."""
    return read_quantity(replace(field, lowest=0.0, highest=math.inf), f"1 {unit}") if unit and "^" not in unit else 1.0


def unit_of(name: str) -> float:
    """Size in SI units of the unit in which the page shows a parameter of the planar rotor."""
    return _size(SETTINGS[name], _KINDS[name].unit) if name in _KINDS and not name.startswith(PREFIX) else 1.0


def _control(case: Case, name: str, kind: _ControlKind, value: float) -> Control:
    logarithmic = kind.logarithmic and value > 0.0
    high = min(max(kind.reach * value, kind.least), kind.most) or 1.0
    low = value / kind.reach if logarithmic else _FIRST * value if name == "speed" else min(kind.low, value)
    return Control(name, kind.words, _unit(case, name, kind), value, low, high, logarithmic, kind.group)


def with_settings(case: Case, settings: Mapping[str, str]) -> Case:
    """Return the machine with other values of its controls, whether it then levitates or not.

    A value is text: a number in the unit shown on the page, with a unit of its own, or in a term that a machine file may state
    instead, such as ``90 g mm`` for the eccentricity.  Unknown names and values that are not allowed are refused, all at once.
    """
    units = {control.name: control.unit for control in controls_of(case)} if settings else {}
    problems = Problems()
    entries: dict[str, str | float] = {}
    for name, text in settings.items():
        if name not in units:
            problems.errors.append(InputError(shown(name), shown(text), f"one of: {', '.join(units)}"))
            continue
        entry = problems.attempt(_entry, case, name, units[name], text)
        if entry is not None:
            entries.update([entry])
    problems.raise_all()
    reduced = rotor_of(case).finite_elements
    if reduced is None or not entries:
        return case.replace(**entries)
    changed = reduced.of(reduced.machine.replace(**entries))
    return replace(case, parameters=replace(changed.unchecked, limits=changed.limits or ()))


def _entry(case: Case, name: str, unit: str, text: str) -> tuple[str, str | float]:
    """The entry of a machine file that a text sets, with its value: the control itself, or a term that stands for it."""
    given = with_unit(unit, text)
    if name.startswith(PREFIX) and not _entries(case):
        case.replace(**{name: given})  # the bearing reads it, also in a unit such as N/m^1.5
        return name, given
    field = _named(case).varied[name]
    if "^" in unit:  # which the field does not read
        given = given.removesuffix(unit).strip()
    try:
        return name, read_quantity(replace(field, bare=unit), given)
    except InputError:
        term = term_of(case, name, text)
        if term == name:
            raise
    try:
        case.replace(**{term: text})
    except InputError as problem:
        # It may need what the file does not state, such as the force over current of a bearing.
        raise InputError(name, shown(text), f"is a {TERM_FIELDS[term].words}: {problem}".replace("\n", "; ")) from None
    return term, text


def term_of(case: Case, name: str, text: str) -> str:
    """The entry of a machine file in which a text for a control is stated; the control itself if no term has such a unit."""
    if name not in case.si or name not in SETTINGS or _reads(SETTINGS[name], with_unit(_KINDS[name].unit, text)):
        return name
    return next((term for term in TERM_FIELDS if set_by(term) == name and _reads(TERM_FIELDS[term], text)), name)


def _reads(field: Field, text: str) -> bool:
    try:
        read_quantity(field, text)
    except InputError:
        return False
    return True


def in_options(case: Case, changes: Mapping[str, str]) -> dict[str, str]:
    """Changes on the page by the entry of a machine file that each sets, as ``--set`` reads them."""
    units = {control.name: control.unit for control in controls_of(case)}
    return {
        # The unit of a curved stiffness is none that can be read.
        term_of(case, name, text): text.removesuffix(units[name]).strip()
        if "^" in units[name] and _entries(case)
        else with_unit(units[name], text)
        for name, text in changes.items()
    }


def with_unit(unit: str, text: str) -> str:
    """Add the unit of the page to a number without one."""
    text = printable(str(text)).strip()
    return f"{text} {unit}".strip() if _BARE.fullmatch(text) else text
