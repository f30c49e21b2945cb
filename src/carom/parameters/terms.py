"""Terms that engineers use for the numbers of a machine, and from entries in whatever terms to these numbers: one from one entry.

Unbalance, balance grade, diameters, gains of magnetic bearings: each term sets one field of the machine by a formula, and each
field is given in one way only, so no two entries can disagree.  The formulas are evaluated with exact decimals and rounded once.

A magnetic bearing is described along each of two perpendicular axes by its force on the rotor, linear in the control
current ``i`` and in the displacement ``x`` from the centre, and by a controller with proportional and derivative gain::

    F = ki i + ks x,     i = -(P x + D x')        so that n bearings act like
    k = n (ki P - ks),   c = n ki D

``ks >= 0`` is the size of the negative stiffness: the magnets pull the rotor away from the centre (G. Schweitzer,
E. H. Maslen, eds., Magnetic Bearings, 2009, chapter 4; some authors write ``F = ki i - ks x`` with ``ks < 0``).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from decimal import Context, Decimal, localcontext
from typing import NamedTuple, cast

from carom.base.arguments import checked
from carom.base.outcome import InputError, Problems, shown, together
from carom.parameters.fields import (
    DIMENSIONLESS_FIELDS,
    MACHINE_FIELDS,
    PARAMETERS,
    PHYSICAL_PARTNER,
    Field,
    by_name,
    length_field,
    name_errors,
    speed_field,
    unknown_name,
    unknown_names,
)
from carom.parameters.quantities import read_decimal, read_quantity
from carom.parameters.scaling import CONVERSIONS, Scales


class Term(NamedTuple):
    """A formula by which an entry sets a field of the machine."""

    sets: str
    """The field of the machine."""
    formula: str
    """Its value, in words."""
    needs: tuple[str, ...]
    """What the formula needs besides the entry: fields of the machine, and entries that set nothing themselves."""
    value: Callable[..., Decimal]
    """The formula, from the entry and from what it needs: decimals in the units of the fields."""
    entry: Callable[..., Decimal]
    """Its inverse: the entry from the field and from what the formula needs.  All are increasing."""


TERM_FIELDS: Mapping[str, Field] = by_name(
    Field("unbalance", "U", "unbalance: mass times eccentricity", "an unbalance", "kg m", 1e-30, 1e12, '"15 g mm"', True, usual="g mm", usual_size=1e-6),
    # By definition a velocity in mm/s: a plain number is the grade.
    Field("balance_grade", "G", "balance quality grade (ISO 21940-11) that the rotor just meets", "a balance grade", "mm/s", 1e-12, 1e9, '"G 2.5"', zero=True, letter="G"),
    length_field("rotor_diameter", "2R", "rotor diameter at the contact", 2e-9, 2e6, '"80 mm"'),
    length_field("diametral_clearance", "2c_r", "diameter of the clearance circle", 2e-9, 2e3, '"1.4 mm"'),
    Field("natural_frequency", "ω_n", "undamped natural frequency", "an angular speed", "rad/s", 1e-9, 1e9, '"22 Hz"', usual="Hz", usual_size=2.0 * math.pi),
    Field("damping_ratio", "ζ", "damping over critical damping", "a number", "", 1e-30, 1e6, "0.1", True),
    Field("proportional_gain", "P", "proportional gain, current over displacement", "a gain", "A/m", 0, 1e15, '"2e4 A/m"'),
    Field("derivative_gain", "D", "derivative gain, current over velocity", "a gain", "A s/m", 0, 1e15, '"20 A s/m"'),
)  # fmt: skip
"""Entries that stand for a field of the machine."""

HELPER_FIELDS: Mapping[str, Field] = by_name(
    speed_field("rated_speed", "Ω_r", "speed for which a balance grade is meant", '"30 Hz"'),
    Field("magnetic_bearings", "n", "number of equal bearings", "a whole number", "", 1, 1000, "2", whole=True),
    Field("force_current_factor", "k_i", "force over current of a bearing", "a force per current", "N/A", 1e-9, 1e12, '"150 N/A"'),
    Field("negative_stiffness", "k_s", "size of the negative stiffness of a bearing", "a stiffness without its sign", "N/m", 1e-30, 1e30, '"4e5 N/m"', zero=True),
    Field("force_limit", "F_max", "largest force of a bearing", "a force", "N", 1e-12, 1e15, '"500 N"'),
    Field("current_limit", "i_max", "largest control current of a bearing", "a current", "A", 1e-12, 1e9, '"3 A"'),
    Field("internal_damping", "c_i", "damping that turns with the shaft", "a damping", "N s/m", 1e-30, 1e30, '"10 N s/m"', zero=True),
    length_field("air_gap", "s_0", "radial air gap of a bearing's magnets", 1e-9, 1e3, '"0.5 mm"'),
)  # fmt: skip
"""Entries that set nothing themselves: those that formulas need, and limits."""

BEARING_FIELDS = tuple(name for name in HELPER_FIELDS if name != "rated_speed")
"""Entries about the magnetic bearings, which a machine keeps."""

TERMS: Mapping[str, Term] = {
    "unbalance": Term("eccentricity", "unbalance/mass", ("mass",), lambda U, m: U / m, lambda e, m: e * m),
    "balance_grade": Term(
        "eccentricity",
        "balance_grade/rated_speed",
        ("rated_speed",),
        lambda grade, speed: grade / 1000 / speed,
        lambda eccentricity, speed: eccentricity * 1000 * speed,
    ),
    "rotor_diameter": Term("rotor_radius", "rotor_diameter/2", (), lambda two_r: two_r / 2, lambda r: r * 2),
    "diametral_clearance": Term("clearance", "diametral_clearance/2", (), lambda two_c: two_c / 2, lambda c: c * 2),
    "natural_frequency": Term(
        "stiffness",
        "mass natural_frequency^2",
        ("mass",),
        lambda frequency, m: m * frequency**2,
        lambda k, m: (k / m).sqrt(),
    ),
    "damping_ratio": Term(
        "damping",
        "2 damping_ratio sqrt(stiffness mass)",
        ("mass", "stiffness"),
        lambda ratio, m, k: 2 * ratio * (k * m).sqrt(),
        lambda c, m, k: c / (2 * (k * m).sqrt()),
    ),
    "proportional_gain": Term(
        "stiffness",
        "magnetic_bearings (force_current_factor proportional_gain - negative_stiffness)",
        ("magnetic_bearings", "force_current_factor", "negative_stiffness"),
        lambda P, n, ki, ks: n * (ki * P - ks),
        lambda k, n, ki, ks: (k / n + ks) / ki,
    ),
    "derivative_gain": Term(
        "damping",
        "magnetic_bearings force_current_factor derivative_gain",
        ("magnetic_bearings", "force_current_factor"),
        lambda D, n, ki: n * ki * D,
        lambda c, n, ki: c / (n * ki),
    ),
}
"""The formula of each entry of :data:`TERM_FIELDS`."""

ENTRIES: Mapping[str, Field] = {**MACHINE_FIELDS, **TERM_FIELDS, **HELPER_FIELDS}
"""All that a ``[machine]`` table may hold."""
SETTABLE: Mapping[str, Field] = {**PARAMETERS, **TERM_FIELDS, **HELPER_FIELDS}
"""All that ``--set`` may change."""
DEFAULTS: Mapping[str, float] = {"unbalance_phase": 0.0, "magnetic_bearings": 1.0}
"""Entries that may be left out."""
WAYS: Mapping[str, tuple[str, ...]] = {
    name: (name, *(other for other, term in TERMS.items() if term.sets == name))
    for name in MACHINE_FIELDS
    if name not in DEFAULTS
}
"""The fields that must be given, each with the entries that give it."""


def set_by(name: str) -> str:
    """Field of the machine that an entry or a dimensionless number sets; a helper sets only itself."""
    return TERMS[name].sets if name in TERMS else PHYSICAL_PARTNER.get(name, name)


@checked
def field_to_vary(name: str) -> Field:
    """Field of a parameter of the planar rotor; refuse an unknown name, and an entry that stands for a parameter."""
    if name not in PARAMETERS:
        raise no_such_parameter(name, None, PARAMETERS, has_scales=True)
    return PARAMETERS[name]


def no_such_parameter(name: str, given: object, varied: Mapping[str, Field], has_scales: bool) -> InputError:
    """Error for a parameter that a rotor does not have: an unknown one, a term, or a physical one without scales; ``given`` is ``None`` where only its name is."""
    if name in TERMS and TERMS[name].sets in varied:
        field, formula, *_ = TERMS[name]
        allowed = f"it stands for {field} = {formula}; use {field} here"
    elif some := [each for each in varied if re.fullmatch(rf"{re.escape(name)}_\d+", each)]:
        allowed = f"it is stated for some parts only; use {', '.join(some)}, or state it for all"
    elif name in HELPER_FIELDS and has_scales:
        allowed = "set it in the machine file or, for one run, by --set"
    elif has_scales or name not in SETTABLE:
        return unknown_name(name, given, varied, "the parameters that the machine file states")
    else:
        partner = {partner: number for number, partner in PHYSICAL_PARTNER.items()}.get(set_by(name))
        advice = f"set {partner} instead" if partner in varied else "use a file with a [machine] table"
        allowed = f"only {', '.join(varied)} are, as mass, clearance and speed are not known; {advice}"
    return InputError(name, given, allowed, "is no parameter here")


def conflicts(entries: Mapping[str, object]) -> list[InputError]:
    """Errors for entries that set the same field of the machine, such as ``damping`` and ``damping_ratio``."""
    found, first = [], dict[str, str]()
    for name in sorted(entries, key=lambda name: name != set_by(name)):  # fields of the machine come first
        field = set_by(name)
        if field not in first:
            first[field] = name
            continue
        other = first[field]
        which = "is set too" if other == field else f"{other} = {shown(entries[other])} sets too"
        allowed = f"sets {field}, which {which}; give one of the two"
        found.append(InputError(name, shown(entries[name]), allowed))
    return found


def check_names(values: Mapping[str, object], known: Mapping[str, Field] = SETTABLE) -> None:
    """Check that names can be set, and that no two set the same thing, such as ``damping`` and ``gamma``.

    All errors are reported at once, with the values.
    """
    errors = unknown_names(values, known, "a machine or its parameters")
    errors += conflicts({name: value for name, value in values.items() if name in SETTABLE})
    if errors:
        raise together(errors)


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
    given: dict[str, dict[str, object]] = field(default_factory=dict)
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
    return _Work(entries, cast("dict[str, Decimal]", numbers), base or Resolved({})).resolved()


class _Work:
    """One resolution: entries, the numbers they hold, and the machine that they change, which may have nothing yet."""

    def __init__(self, entries: Mapping[str, object], numbers: Mapping[str, Decimal], base: Resolved) -> None:
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
        elif name in base.values:
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
            stated = self.entries.get(need, self.base.given.get("eccentricity", {}).get(need))
            if stated is not None:
                return Decimal(repr(read_quantity(HELPER_FIELDS[need], stated))), {need: stated}
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
        value = _nearest_value(number, float(self.numbers[number]), scales)
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


def _nearest_value(name: str, number: float, scales: Scales) -> float:
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
