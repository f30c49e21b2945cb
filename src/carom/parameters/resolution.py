"""From the entries of a machine, in whatever terms, to its numbers in SI units: one number from one entry."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Context, Decimal, localcontext
from typing import Any, cast

from carom.base.outcome import InputError, Problems, shown, together
from carom.parameters.fields import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, name_errors
from carom.parameters.quantities import read_decimal, read_quantity
from carom.parameters.scaling import CONVERSIONS, Scales
from carom.parameters.terms import (
    BEARING_FIELDS,
    DEFAULTS,
    ENTRIES,
    HELPER_FIELDS,
    SETTABLE,
    TERMS,
    WAYS,
    check_names,
    conflicts,
    set_by,
)

_FIRST = ("mass", "clearance", "speed", "stiffness", "damping")
_FIELDS = (*_FIRST, *(name for name in MACHINE_FIELDS if name not in _FIRST))
"""Fields in an order in which each formula finds what it needs."""
DECIMALS = Context(prec=60)
"""The digits with which formulas are evaluated."""


@dataclass(frozen=True)
class Resolved:
    """The numbers of a machine, and where they come from."""

    values: dict[str, float]
    """Fields of the machine and of its magnetic bearings, in SI units."""
    given: dict[str, dict[str, Any]] = field(default_factory=dict)
    """For each of them the entries that gave it, as they were written; none for a default."""

    def source(self, name: str) -> str | None:
        """The entry that gave a field, if there is one."""
        return next(iter(self.given.get(name, ())), None)


def resolve(entries: Mapping[str, object], base: Resolved | None = None) -> Resolved:
    """Numbers of a machine from entries; all errors of names and numbers are reported at once, or else all errors of formulas.

    An entry of the magnetic bearings that is None counts as left out.  With a ``base``, the machine to change, what is not set
    keeps its value in SI units, and dimensionless numbers may be among the entries.  A field that follows from a gain, a factor
    or a rated speed follows again if one of them is set.
    """
    entries = {name: value for name, value in entries.items() if value is not None or name not in BEARING_FIELDS}
    problems = Problems()
    if base is None:
        problems.errors += name_errors(entries, ENTRIES, "[machine]", WAYS)
        problems.errors += conflicts({name: value for name, value in entries.items() if name in ENTRIES})
    else:
        problems.attempt(check_names, entries)
    numbers = {
        name: problems.attempt(read_decimal, SETTABLE[name], value)
        for name, value in entries.items()
        if name in (ENTRIES if base is None else SETTABLE)
    }
    problems.raise_all()
    return _Work(entries, cast("dict[str, Decimal]", numbers), base).resolved()


class _Work:
    """One resolution: entries, the numbers they hold, and the machine that they change."""

    def __init__(self, entries: Mapping[str, object], numbers: Mapping[str, Decimal], base: Resolved | None) -> None:
        self.entries, self.numbers, self.base = entries, numbers, base
        self.ways = {set_by(name): name for name in entries}
        self.values: dict[str, float] = {}
        self.given: dict[str, dict[str, object]] = {}

    def resolved(self) -> Resolved:
        """Find all numbers, field by field."""
        for name in (*BEARING_FIELDS, *_FIELDS):  # the first error is raised: what follows needs this field
            self._find(name)
        if unused := self._unused():
            raise together(unused)
        ordered = [*MACHINE_FIELDS, *(name for name in BEARING_FIELDS if name in self.values)]
        return Resolved({name: self.values[name] for name in ordered}, self.given)

    def _take(self, name: str, value: float, given: Mapping[str, object]) -> None:
        self.values[name] = value
        if given:
            self.given[name] = dict(given)

    def _find(self, name: str) -> None:
        """Find one number; of one that is not set the value stays, unless its formula needs something that is set."""
        way, base = self.ways.get(name), self.base
        if way is not None:
            number, written = self.numbers[way], self.entries[way]
        elif base is not None and name in base.values:
            source = base.source(name)
            way = source or name
            if source not in TERMS or self.entries.keys().isdisjoint(HELPER_FIELDS.keys() & set(TERMS[way].needs)):
                return self._take(name, base.values[name], base.given.get(name, {}))
            written = base.given[name][way]
            number = read_decimal(ENTRIES[way], written)
        else:
            return self._take(name, DEFAULTS[name], {}) if name in DEFAULTS else None
        if way in TERMS:
            return self._derive(name, way, number, written)
        value = self._solved(name, way) if way in DIMENSIONLESS_FIELDS else float(number)
        return self._take(name, value, {way: written})

    def _derive(self, name: str, way: str, number: Decimal, written: object) -> None:
        term, needed, given = TERMS[way], list[Decimal](), {way: written}
        for need in term.needs:
            found, source = self._needed(need, way, written)
            needed.append(found)
            given |= source
        with localcontext(DECIMALS):
            value = float(term.value(number, *needed))
        target = MACHINE_FIELDS[name]
        if not target.contains(value):
            words = f"gives {name} = {term.formula} = {value:.6g} {target.unit}".rstrip()
            raise InputError(way, shown(written), f"{words}, which {target.allowed}{self._remedy(way)}")
        self._take(name, value + 0.0, given)

    def _needed(self, need: str, way: str, written: object) -> tuple[Decimal, dict[str, object]]:
        """Value of what a formula needs, and the entries that gave it."""
        if need == "rated_speed":
            before = self.base.given.get("eccentricity", {}) if self.base is not None else {}
            written_before = self.entries.get(need, before.get(need))
            if written_before is not None:
                number = read_quantity(HELPER_FIELDS[need], written_before)
                return Decimal(repr(number)), {need: written_before}
            need = "speed"
        if need not in self.values:
            raise InputError(way, shown(written), f"needs {need} too, which {HELPER_FIELDS[need].allowed}")
        return Decimal(repr(self.values[need])), self.given.get(need, {})

    def _remedy(self, way: str) -> str:
        if way != "proportional_gain":
            return ""
        least = self.values["negative_stiffness"] / self.values["force_current_factor"]
        return f"; the gain must be above negative_stiffness/force_current_factor = {least:.6g} A/m"

    def _solved(self, name: str, number: str) -> float:
        scales = Scales(self.values["mass"], self.values["clearance"], self.values["speed"])
        value = solved(number, float(self.numbers[number]), scales)
        if not MACHINE_FIELDS[name].contains(value):
            allowed = f"sets {name} to {value}, which {MACHINE_FIELDS[name].allowed}"
            raise InputError(number, shown(self.entries[number]), allowed)
        return value + 0.0

    def _unused(self) -> list[InputError]:
        """Errors for entries that change nothing, and for limits that need more to say anything."""
        errors = []
        present = self.values.keys() | {source for given in self.given.values() for source in given}
        for name, users in _USERS.items():
            default = name in DEFAULTS and self.values[name] == DEFAULTS[name]
            if name in self.entries and not default and present.isdisjoint(users):
                allowed = f"has no effect without {' or '.join(users)}"
                errors.append(InputError(name, shown(self.entries[name]), allowed))
        if (limit := "current_limit") in self.values:
            for name in [name for name in _OF_CURRENT if name not in self.values]:
                allowed = f"needs {name} too, which {HELPER_FIELDS[name].allowed}"
                errors.append(InputError(limit, shown(self.given[limit][limit]), allowed))
        return errors


_USERS = {
    "rated_speed": ("balance_grade",),
    "magnetic_bearings": ("force_current_factor", "force_limit"),
    "negative_stiffness": ("force_current_factor",),
}
_OF_CURRENT = ("force_current_factor", "negative_stiffness")


def solved(name: str, number: float, scales: Scales) -> float:
    """Return the value, in SI units, of the partner of a dimensionless parameter that gives this number.

    Short decimals are tried first: rounding to 15 digits finds the value that a person wrote. The conversion rounds at
    most three times, so every double it maps to `number` lies within four units in the last place of the exact value.
    """
    conversion = CONVERSIONS[name]
    with localcontext(DECIMALS):
        exact = conversion.value(Decimal(number), scales)
        candidates = [float(f"{exact:.{digits - 1}e}") for digits in (15, 16, 17)]
    nearest = below = above = float(exact)
    candidates.append(nearest)
    for _ in range(4):
        below, above = math.nextafter(below, -math.inf), math.nextafter(above, math.inf)
        candidates += [below, above]
    candidates = [value for value in candidates if value >= 0 or exact < 0]
    return min(candidates, key=lambda value: abs(conversion.number(value, scales) - number))
