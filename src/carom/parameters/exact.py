"""Numbers of a machine exactly as they are given: rational, times a power of π where turns are counted in radians."""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Context, Decimal, localcontext
from fractions import Fraction

from carom.parameters.fields import Field
from carom.parameters.quantities import number_and_unit, read_quantity, unit_advice, unit_factor, without_separators

_DECIMAL = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_NUMBER = re.compile(rf"(?P<number>[+-]?[0-9]+ */ *[0-9]+|{_DECIMAL}) *(?P<unit>.*)")
_TURNS = {
    **dict.fromkeys(("rpm", "RPM", "rev/min", "r/min", "U/min"), Fraction(1, 30)),
    **dict.fromkeys(("deg", "degree", "degrees", "°", "deg/s"), Fraction(1, 180)),
    **dict.fromkeys(("rev/s", "Hz"), Fraction(2)),
    "kHz": Fraction(2000),
}
"""Units of angles and angular speeds in multiples of π."""
_LONGEST, _DIGITS, _MOST_DIGITS, _LARGEST_EXPONENT = 200, 40, 30, 400


@dataclass(frozen=True)
class ExactNumber:
    """A number, or all numbers of an interval: those from ``low`` to ``high``, times ``π**turns``."""

    low: Fraction
    high: Fraction
    turns: int = 0

    def __truediv__(self, other: ExactNumber) -> ExactNumber:
        """Quotient of numbers that are not negative."""
        return ExactNumber(self.low / other.high, self.high / other.low, self.turns - other.turns)

    def __mul__(self, other: ExactNumber) -> ExactNumber:
        """Product of numbers that are not negative."""
        return ExactNumber(self.low * other.low, self.high * other.high, self.turns + other.turns)

    @property
    def rational(self) -> Fraction | None:
        """The number, if it is one number and rational."""
        return self.low if self.low == self.high and not (self.turns and self.low) else None

    def __str__(self) -> str:
        ends = str(self.low) if self.low == self.high else f"[{self.low}, {self.high}]"
        return f"{ends} pi^{self.turns}" if self.turns else ends


def read_exact(field: Field, text: str) -> ExactNumber:
    """Read a number without rounding, in the SI unit of a field.

    The text is a decimal number or a fraction, perhaps with a unit (``"0.76"``, ``"3/7"``, ``"1759 rpm"``), ``"double 0.1"`` for
    the double next to a decimal number, or ``"[0.1, 0.2]"`` for an interval of such numbers.  Anything else is refused, also a
    value out of range, and a unit that is no rational multiple of the SI unit or of π times it.
    """
    text = text.strip()
    if len(text) > _LONGEST:
        raise field.error(text, "this is too long")
    if text.startswith("[") and text.endswith("]") and text.count(",") == 1:
        low, high = (read_exact(field, end) for end in text[1:-1].split(","))
        if low.turns != high.turns or low.low > high.high:
            raise field.error(text, "the ends of an interval must increase and have the same unit")
        return ExactNumber(low.low, high.high, low.turns)
    if text.startswith("double "):
        digits = text.removeprefix("double ")
        if not re.fullmatch(_DECIMAL, digits):
            raise field.error(text, "this is not a number")
        if field.needs_unit:
            raise field.error(text, unit_advice(field, repr(float(digits))))
        number = Fraction(read_quantity(field, float(digits)))
        return ExactNumber(number, number)
    return _from_text(field, text)


def _from_text(field: Field, text: str) -> ExactNumber:
    plain = without_separators(text)
    number, unit = number_and_unit(field, text, plain, _NUMBER, "this is not a decimal number or a fraction")
    number = number.replace(" ", "")
    if "/" in number:
        if not int(number.partition("/")[2]):
            raise field.error(text, "this is not a number")
        value = Fraction(number)
    else:
        written = Decimal(number)
        if written and abs(written.adjusted()) > _LARGEST_EXPONENT:
            raise field.error(text, "this is out of range")
        value = Fraction(written)
    factor, turns = _exact_factor(field, unit, text)
    value *= factor
    # 22/7 is close enough to π for a check of the range.
    size = value * Fraction(22, 7) ** turns
    if not (field.zero and not value) and not Fraction(repr(field.lowest)) <= size <= Fraction(repr(field.highest)):
        raise field.error(text, "this is out of range")
    return ExactNumber(value, value, turns if value else 0)


def _exact_factor(field: Field, unit: str, text: str) -> tuple[Fraction, int]:
    if not unit:
        return Fraction(1), 0
    with localcontext(Context(prec=_DIGITS)):
        factor = unit_factor(field, unit, text).normalize()  # without zeros at the end, as of an inch from pint
    if unit in _TURNS:
        return _TURNS[unit], 1
    if len(factor.as_tuple().digits) > _MOST_DIGITS:
        raise field.error(text, f"{unit!r} cannot be converted exactly; give the value in {field.unit}")
    return Fraction(factor), 0
