"""Parameters that can be moved on the page, their ranges, and what people type."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from carom.models import rotor_of
from carom.outcome import InputError, Problems, printable, shown
from carom.parameters import SETTINGS, Case, TouchdownBearing, read_quantity
from carom.parameters.fields import Field
from carom.parameters.terms import TERM_FIELDS, set_by
from carom.parameters.touchdown_bearing import PREFIX

_BARE = re.compile(r"[\s\d.,'+-]*\d[\s\d.,']*(?:[eE][+-]?\d+)?\s*")
"""A number without a unit, which is in the unit shown beside its box."""


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
    group: str = "The machine"
    among: str = ""

    def setting(self, value: float) -> str:
        """A value as text that :func:`with_settings` reads, rounded to four digits."""
        return f"{float(f'{value:.4g}'):g} {self.unit}".strip()


@dataclass(frozen=True)
class _Kind:
    words: str
    unit: str
    reach: float
    """Ratio of the end of the slider to the value of the machine."""
    least: float = 0.0
    """Least end of the slider, where the value of the machine is small."""
    most: float = float("inf")
    logarithmic: bool = False
    low: float = 0.0
    """Lower end of a slider that is not logarithmic, unless the value of the machine lies below it."""


_KINDS: Mapping[str, _Kind] = {
    "stiffness": _Kind("stiffness (P gain)", "N/m", 4.0, logarithmic=True),
    "damping": _Kind("damping (D gain)", "N s/m", 5.0, logarithmic=True),
    "speed": _Kind("speed", "rpm", 2.0),
    "eccentricity": _Kind("unbalance (eccentricity)", "mm", 2.0),
    "friction": _Kind("friction", "", 2.0, least=0.5, most=10.0),
}
_DIMENSIONLESS: Mapping[str, _Kind] = {
    "omega": _Kind("stiffness: frequency ω over speed", "", 2.0, logarithmic=True),
    "gamma": _Kind("damping γ", "", 5.0, logarithmic=True),
    "rho": _Kind("unbalance ρ", "", 2.0),
    "mu": _Kind("friction μ", "", 2.0, least=0.5, most=10.0),
}
_OF_WALL: Mapping[str, _Kind] = {
    "restitution": _Kind("restitution", "", 1.0, least=1.0, most=1.0),
    "d": _Kind("restitution d", "", 1.0, least=1.0, most=1.0),
}
"""What a rigid wall has, of a machine and of a dimensionless one."""
_OF_BEARING: Mapping[str, _Kind] = {
    "touchdown_stiffness": _Kind("touchdown stiffness", "N/m", 10.0, logarithmic=True),
    "touchdown_restitution": _Kind("touchdown restitution", "", 1.0, least=1.0, most=1.0, low=0.05),
    "touchdown_damping": _Kind("touchdown damping", "N s/m", 10.0, least=1000.0, logarithmic=True),
    "touchdown_dissipation": _Kind("touchdown dissipation", "s/m", 10.0, least=1.0, logarithmic=True),
}
"""What a touchdown bearing that gives way has; of its losses that which is stated."""


def controls_of(case: Case) -> tuple[Control, ...]:
    """Controls of a machine: in engineering units, or of a dimensionless one its numbers."""
    values = values_of(case)
    return tuple(_control(name, kind, values[name]) for name, kind in _kinds_of(case).items())


def values_of(case: Case) -> dict[str, float]:
    """Values of a machine's controls, in their units."""
    rotor = rotor_of(case)
    return {name: float(f"{rotor.value(name) / unit_of(name):.12g}") for name in _kinds_of(case)}


def _kinds_of(case: Case) -> Mapping[str, _Kind]:
    own, restitution = (_DIMENSIONLESS, "d") if case.machine is None else (_KINDS, "restitution")
    of_wall = {restitution: _OF_WALL[restitution]} if restitution in rotor_of(case).varied else {}
    return {**own, **of_wall, **(_kinds_of_bearing(case.touchdown) if case.touchdown else {})}


def _kinds_of_bearing(bearing: TouchdownBearing) -> Mapping[str, _Kind]:
    """Those of the entries that the bearing states, in SI units: that of the stiffness depends on its exponent."""
    given = {PREFIX + name: bearing.unit(name) for name in bearing.given}
    return {name: replace(kind, unit=given[name]) for name, kind in _OF_BEARING.items() if name in given}


def unit_of(name: str) -> float:
    """Size in SI units of the unit in which the page shows a parameter."""
    if name in _OF_BEARING:
        return 1.0
    unit = {**_KINDS, **_DIMENSIONLESS, **_OF_WALL}[name].unit
    return read_quantity(SETTINGS[name], f"1 {unit}") if unit else 1.0


def _control(name: str, kind: _Kind, value: float) -> Control:
    logarithmic = kind.logarithmic and value > 0.0
    high = min(max(kind.reach * value, kind.least), kind.most) or 1.0
    low = value / kind.reach if logarithmic or name == "speed" else min(kind.low, value)
    return Control(name, kind.words, kind.unit, value, low, high, logarithmic)


def with_settings(case: Case, settings: Mapping[str, str]) -> Case:
    """Return the machine with other values of its controls.

    A value is text: a number in the unit shown on the page, with a unit of its own, or in a term that a machine file may state
    instead, such as ``90 g mm`` for the eccentricity.  Unknown names and values that are not allowed are refused, all at once.
    """
    kinds = _kinds_of(case)
    problems = Problems()
    entries: dict[str, str | float] = {}
    for name, text in settings.items():
        if name not in kinds:
            problems.errors.append(InputError(shown(name), shown(text), f"one of: {', '.join(kinds)}"))
            continue
        entry = problems.attempt(_entry, case, name, text)
        if entry is not None:
            entries.update([entry])
    problems.raise_all()
    return case.replace(**entries)


def _entry(case: Case, name: str, text: str) -> tuple[str, str | float]:
    """The entry of a machine file that a text sets, with its value: the control itself, or a term that stands for it."""
    unit = _kinds_of(case)[name].unit
    if name in _OF_BEARING:
        text = with_unit(unit, text)
        case.replace(**{name: text})  # the bearing reads it, also in a unit such as N/m^1.5
        return name, text
    try:
        return name, read_quantity(replace(SETTINGS[name], bare=unit), with_unit(unit, text))
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
    if case.machine is None or _reads(SETTINGS[name], with_unit(_kinds_of(case)[name].unit, text)):
        return name
    return next((term for term in TERM_FIELDS if set_by(term) == name and _reads(TERM_FIELDS[term], text)), name)


def _reads(field: Field, text: str) -> bool:
    try:
        read_quantity(field, text)
    except InputError:
        return False
    return True


def with_unit(unit: str, text: str) -> str:
    """Add the unit of the page to a number without one."""
    text = printable(str(text)).strip()
    return f"{text} {unit}".strip() if _BARE.fullmatch(text) else text
