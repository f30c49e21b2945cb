"""Values of a machine in the terms of its file: a gain in A s/m where the file has gains, a frequency where it has one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal, localcontext
from typing import Annotated, Literal, NamedTuple

from carom.base.arguments import checked, whole
from carom.parameters.fields import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, Field
from carom.parameters.formats import RAISED, own_entry
from carom.parameters.formats import number as short
from carom.parameters.machine import Machine
from carom.parameters.machine_file import Case
from carom.parameters.quantities import read_quantity, unit_factor, unit_of
from carom.parameters.terms import DECIMALS, HELPER_FIELDS, SETTABLE, TERMS, no_such_parameter, set_by

Side = Literal["up", "down", "nearest"]
_ROUNDING = {"up": ROUND_CEILING, "down": ROUND_FLOOR, "nearest": ROUND_HALF_EVEN}
_SECONDARY_DIGITS = 3
EXACT = 17
"""Significant digits with which a value is stated without rounding."""
Digits = Annotated[int, whole(1, EXACT)]
"""Significant digits."""


@dataclass(frozen=True)
class InTerms:
    """A value of a parameter as the file of a machine would state it.

    Attributes
    ----------
    entry : str
        The entry that states it there, such as ``"derivative_gain"``.
    value : float
        Its rounded value, in `unit`.
    unit : str
        The unit that stands in the file; empty for a pure number.
    text : str
        Value and unit for people, such as ``"50,540 N s/m"``.
    setting : str
        What follows ``--set``, such as ``"damping=50540 N s/m"``.
    reached : float
        The parameter after this setting, in its own unit; on the side that was asked for.
    beside : tuple of str
        What else people call it, such as ``"damping ratio 0.31"``.
    field : Field
        The entry's words, symbol and range.
    """

    entry: str
    value: float
    unit: str
    text: str
    setting: str
    reached: float
    beside: tuple[str, ...]
    field: Field


class _Stated(NamedTuple):
    """An entry, its exact value, and how it is written."""

    entry: str
    exact: Decimal
    unit: str
    field: Field

    def written(self, number: str) -> str:
        is_letter = self.unit and self.unit == self.field.letter
        return f"{self.unit} {number}" if is_letter else f"{number} {self.unit}".rstrip()


@checked
def in_terms_of(case: Case, name: str, value: object, side: Side = "nearest", digits: Digits = 4) -> InTerms:
    """Return a value of a parameter in the terms and units of the machine's file, rounded.

    Parameters
    ----------
    case : Case
        A field that a dimensionless number has set is stated by its own name.
    name : str
        A dimensionless parameter, or a field of the machine.
    value : float
        In the unit of the parameter: ``gamma`` and the like without one, fields of the machine in SI units.
    side : {"up", "down", "nearest"}
        How to round.  A machine with the setting has at least, or at most, the value.
    digits : int
        Significant digits.

    Raises
    ------
    InputError
        The case has no such parameter, the machine cannot have this value, or it is none; no such side; digits not from 1 to 17.

    Examples
    --------
    >>> import carom as cm
    >>> case = cm.load("examples/tum-test-rig.toml")
    >>> least = cm.parameters.in_terms_of(case, "damping", 1234.5, "up")
    >>> least.setting, least.beside
    ('derivative_gain=12.35 A s/m', ('damping 1,240 N s/m', 'damping ratio 0.623'))
    """
    if name not in case.parameters.varied:
        raise no_such_parameter(name, value, case.parameters.varied, case.parameters.scales is not None)
    wanted = read_quantity(case.parameters.varied[name], value)
    with localcontext(DECIMALS):
        stated = _stated(case, name, Decimal(repr(wanted)))
        rounding = Context(prec=digits, rounding=_ROUNDING[side])
        number = rounding.plus(stated.exact)
        after = _changed(case, stated, number)
        while (side == "up" and _value(after, name) < wanted) or (side == "down" and _value(after, name) > wanted):
            # Rounding of what follows from the entry has put the last bit on the other side.
            number = rounding.next_plus(number) if side == "up" else rounding.next_minus(number)
            after = _changed(case, stated, number)
        return InTerms(
            stated.entry,
            float(number),
            stated.unit,
            stated.written(_for_people(number)),
            f"{stated.entry}={stated.written(_plain(number))}",
            _value(after, name),
            tuple(_beside(after, stated.entry)),
            stated.field,
        )


def _stated(case: Case, name: str, value: Decimal) -> _Stated:
    """The entry that states a parameter in the file of a machine, with its value."""
    machine = case.machine
    given: Mapping[str, object] = {}
    if machine is not None:
        name, value = own_entry(name, value, machine.scales)
        given = machine.given.get(name, {})
    entry = next((entry for entry in given if entry in TERMS), name)
    if machine is not None and entry in TERMS:
        value = TERMS[entry].entry(value, *(_needed(machine, need) for need in TERMS[entry].needs))
    field, written = SETTABLE.get(entry) or case.parameters.varied[entry], given.get(entry)
    unit = (unit_of(field, written) if isinstance(written, str) else "") or field.usual_unit
    size = unit_factor(field, unit, unit) if unit and unit != field.letter else 1
    return _Stated(entry, value / size, unit, field)


def _changed(case: Case, stated: _Stated, number: Decimal) -> Case:
    """The case after ``--set``."""
    entry, text = stated.entry, stated.written(_plain(number))
    if case.machine is None and entry in DIMENSIONLESS_FIELDS:
        return case.replace(**{entry: read_quantity(DIMENSIONLESS_FIELDS[entry], text)})
    return case.replace(**{entry: text})


def _value(case: Case, name: str) -> float:
    """A parameter, as exact as the case knows it."""
    return float(
        getattr(case.machine, name) if case.machine and name in MACHINE_FIELDS else case.parameters.value(name)
    )


def _needed(machine: Machine, need: str) -> Decimal:
    """What a formula needs besides the field, as :mod:`carom.parameters.terms` takes it."""
    if need == "rated_speed":
        written = machine.given["eccentricity"].get(need, machine.speed)
        return Decimal(repr(read_quantity(HELPER_FIELDS[need], written)))
    return Decimal(repr(getattr(machine, need)))


def _beside(case: Case, entry: str) -> Iterator[str]:
    """What else people say: the damping or stiffness that follows from a term, the damping ratio, the natural frequency."""
    numbers, field = case.parameters, set_by(entry)
    if not {"gamma", "omega"} <= set(numbers.varied):
        return
    gamma, omega = (numbers.value(name) for name in ("gamma", "omega"))
    if field in numbers.varied and field in ("damping", "stiffness") and entry != field:
        yield f"{field} {short(numbers.value(field), _SECONDARY_DIGITS)} {MACHINE_FIELDS[field].unit}"
    if field == "damping" and entry != "damping_ratio":
        yield f"damping ratio {short(gamma / (2.0 * omega), _SECONDARY_DIGITS)}"
    if numbers.scales and field == "stiffness" and entry != "natural_frequency":
        yield f"natural frequency {short(omega * numbers.scales.speed / math.tau, _SECONDARY_DIGITS)} Hz"


def _plain(number: Decimal) -> str:
    """Text of a number as all programs read it."""
    number = number.normalize()
    return f"{number:f}" if -5 <= number.adjusted() < 12 or not number else f"{number:e}"


def _for_people(number: Decimal) -> str:
    """Text of a number with thousands separators, or a power of ten: ``50,540``, ``2.5×10⁹``."""
    number = number.normalize()
    power = number.adjusted()
    if -5 <= power < 8 or not number:
        return f"{number:,f}"
    return f"{number.scaleb(-power):f}×10{str(power).translate(RAISED)}"
