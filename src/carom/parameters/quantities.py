"""Conversion of text with units to floats in SI units, and for proofs to exact numbers; the rest of the package handles no units.

An exact number is rational, times a power of π where turns are counted in radians.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Context, Decimal, localcontext
from fractions import Fraction
from functools import cache
from numbers import Real
from typing import Any

from carom.base.arguments import checked
from carom.base.outcome import shown
from carom.parameters.fields import Field

_DECIMAL = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_TEXT = re.compile(rf"(?P<number>{_DECIMAL}|[+-]?(?i:nan|inf|infinity)\b)\s*(?P<unit>.*)", re.DOTALL)
_EXACT = re.compile(rf"(?P<number>[+-]?[0-9]+ */ *[0-9]+|{_DECIMAL}) *(?P<unit>.*)")
# Names, products, quotients and one-digit powers only: pint evaluates arithmetic, and "m**9**9**9" would never end.
_UNIT = re.compile(
    r"(?:[A-Za-z°%µμ_ ()*/·⋅]|1(?![0-9])|(?:\^|\*\*) *[+-]?[0-9](?!(?: *(?:\^|\*\*))|[0-9])|⁻?[¹²³⁴](?![¹²³⁴]))*"
)
_LONGEST_UNIT = 60
_SPACES = str.maketrans(dict.fromkeys("\u00a0\u2007\u2009\u202f", " ") | {"’": "'"})
_GROUPS = re.compile(r"[+-]?[1-9][0-9]{0,2}(?P<gap>[ '])[0-9]{3}(?:(?P=gap)[0-9]{3})*(?![0-9'])")
_COMMAS = re.compile(
    r"(?P<number>[+-]?[1-9][0-9]{0,2}(?P<groups>(?:,[0-9]{3})+)(?P<decimals>\.[0-9]*)?)\s*(?P<unit>(?![0-9.,]).*)",
    re.DOTALL,
)
_POWER = re.compile(r"(?<=[0-9]) ?× ?10(⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)")
_LOWERED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_WITH_COMMAS = frozenset(("rpm", "RPM", "rev/min", "r/min", "N s/m", "N/m", "A/m", "N"))
"""Units in which carom writes large numbers and nobody three decimals, so that one comma can only separate thousands."""
_COMMA = re.compile(r"(?P<before>[+-]?[0-9. ']*),(?P<after>[0-9].*)", re.DOTALL)
_HYPHEN = re.compile(r"(?<=[A-Za-z])-(?=[A-Za-z])")
_MEANT = {
    "rad/s": {"Hz": "rev/s", "kHz": "krev/s", "U/min": "rpm"},
    "m": {"mil": "thou", "mils": "thou"},
    "m/s^2": {"g": "g_0"},
}
"""Units that pint takes for others in a field of this unit: 1 Hz for 1 rad/s, the U (turn) of German papers for an amount
of an enzyme, a mil for an angle, the g of accelerations for a gram."""
_DIGITS = Context(prec=40)
_TURNS = {
    **dict.fromkeys(("rpm", "RPM", "rev/min", "r/min", "U/min"), Fraction(1, 30)),
    **dict.fromkeys(("deg", "degree", "degrees", "°", "deg/s"), Fraction(1, 180)),
    **dict.fromkeys(("rev/s", "Hz"), Fraction(2)),
    "kHz": Fraction(2000),
}
"""Units of angles and angular speeds in multiples of π."""
_LONGEST, _MOST_DIGITS, _LARGEST_EXPONENT = 200, 30, 400
"""Of exact numbers: characters, digits of the factor of a unit, and power of ten."""

Roots = frozenset[tuple[str, Decimal]]
"""Root units of pint, each with its exponent; radians are distinguished from pure numbers."""

_INCH = "0.02540000000000000000000000000000000000000"
_DEGREE = "0.01745329251994329576923690768488612713443"
_TURN_A_MINUTE = "0.1047197551196597746154214461093167628066"
_POUND_FORCE_PER_INCH = "175126.8352464763779527559055118110236220"

# The units that machine files mostly use, as pint converts them: importing it and building its registry takes longer than all the
# rest of reading a machine file.  Any other unit, and any other spelling of these, is left to pint.
# Exponents of metre, gram, second, radian and ampere, zeros at the end left out; then all units with a factor, to the 40 digits
# requested from pint.
_WRITTEN: Mapping[tuple[int, ...], Mapping[str, str]] = {
    (0, 0, 0, 0): {"1": "", "0.01": "%, percent"},
    (1, 0, 0, 0): {"1": "m", "0.01": "cm", "0.001": "mm", "0.000001": "µm, μm, um", "1E-9": "nm", _INCH: "in, inch"},
    (0, 1, 0, 0): {"1E+3": "kg", "1": "g", "1E+6": "t", "453.59237": "lb"},
    (0, 0, 1, 0): {"1": "s", "0.001": "ms", "0.000001": "µs, μs, us", "60": "min"},
    (0, 0, 0, 1): {"1": "rad", "0.001": "mrad", _DEGREE: "deg, degree, degrees, °"},
    (0, 0, -1, 1): {
        "1": "rad/s",
        _TURN_A_MINUTE: "rpm, RPM, rev/min, r/min",
        "6.283185307179586476925286766559005768394": "rev/s",
        _DEGREE: "deg/s",
    },
    (0, 0, -1, 0): {"1": "1/s, Hz", "1E+3": "kHz"},
    (1, 0, -1, 0): {"1": "m/s", "0.001": "mm/s", "0.000001": "µm/s, μm/s, um/s"},
    (1, 0, -2, 0): {"1": "m/s^2, m/s**2, m/s²", "0.001": "mm/s^2, mm/s²", "9.80665": "gravity, g_0"},
    (1, 1, -2, 0): {"1E+3": "N", "1E+6": "kN", "1": "mN", "4448.2216152605": "lbf"},
    (1, 1, -1, 0): {"1E+3": "N s, N*s, N·s, Ns, kg m/s", "1": "mN s"},
    (0, 1, -2, 0): {
        "1E+3": "N/m",
        "1E+6": "N/mm, kN/m",
        "1E+9": "N/µm, N/μm, N/um, kN/mm, MN/m",
        _POUND_FORCE_PER_INCH: "lbf/in",
    },
    (0, 1, -1, 0): {
        "1E+3": "N s/m, N*s/m, N·s/m, Ns/m, kg/s",
        "1E+6": "N s/mm, N*s/mm, N·s/mm, Ns/mm, kN s/m",
        _POUND_FORCE_PER_INCH: "lbf s/in",
    },
    (1, 1): {"1E+3": "kg m", "1": "kg mm, g m", "0.01": "g cm", "0.001": "g mm, g*mm, g·mm, gmm"},
    (0, 0, 0, 0, 1): {"1": "A", "0.001": "mA"},
    (0, 0, -1, 0, 1): {"1": "A/s, mA/ms", "1E+3": "kA/s, A/ms"},
    (-1, 0, 0, 0, 1): {"1": "A/m, mA/mm", "1E+3": "A/mm", "1E+6": "A/µm, A/μm, A/um"},
    (-1, 0, 1, 0, 1): {"1": "A s/m, A*s/m, A·s/m, As/m, mA s/mm", "1E+3": "A s/mm"},
    (1, 1, -2, 0, -1): {"1E+3": "N/A", "1E+6": "kN/A"},
}


def _root_units(exponents: tuple[int, ...]) -> Roots:
    named = zip(("meter", "gram", "second", "radian", "ampere"), exponents, strict=False)
    return frozenset((name, Decimal(exponent)) for name, exponent in named if exponent)


COMMON_UNITS: Mapping[str, tuple[Decimal, Roots]] = {
    unit: (Decimal(factor), _root_units(exponents))
    for exponents, factors in _WRITTEN.items()
    for factor, units in factors.items()
    for unit in units.split(", ")
}
"""Factor and root units of each unit."""
_CELSIUS = dict.fromkeys(("°C", "degC", "celsius"), (Decimal(1), frozenset({("celsius", Decimal(1))})))
"""Temperatures are stated in these alone: from those in kelvins or degrees Fahrenheit they differ by more than a factor."""


class Written(float):
    """A number of a file without quotes: the double, and the text that stands there."""

    def __init__(self, text: str) -> None:
        self.text = text.replace("_", "")


def read_quantity(field: Field, given: object) -> float:
    """Read a number, or text with a unit, as a float in the SI unit of a field.

    The decimal text is converted exactly and rounded once, so that ``"0.7 mm"`` and ``0.0007`` are the same double.  A
    number without a unit, in quotes or not, is in the SI unit.

    Parameters
    ----------
    field : Field
        What is read: its unit and its range.
    given : object
        A real number, or text such as ``"1759 rpm"``.

    Raises
    ------
    InputError
        If `given` is anything else, of another dimension, not finite or out of range.
    """
    if type(given) is float and type(field) is Field and field.lowest <= given <= field.highest and not field.whole:
        return given + 0.0  # the common case first: continuation sets parameters thousands of times
    return _read(field, given)


@checked
def _read(field: Field, given: object) -> float:
    if isinstance(given, str):
        number = float(_from_text(field, given))
    elif isinstance(given, Real) and not isinstance(given, bool):
        try:
            number = float(given)
        except OverflowError:
            number = float("inf")
    else:
        raise field.error(given, "this is not a number")
    return field.check(number, given)


def read_decimal(field: Field, given: object) -> Decimal:
    """Read a number like :func:`read_quantity`, but to 40 digits instead of rounded to a double.

    A number that is not text stands for its shortest decimal.
    """
    number = read_quantity(field, given)
    return Decimal(_from_text(field, given)) if isinstance(given, str) and number else Decimal(repr(number))


def without_separators(text: str) -> str:
    """Text of a number as programs write it: without the separators of its thousands, and with plain spaces.

    Thousands may be separated by spaces or apostrophes.  Commas separate them where no other reading is left: if there are
    several, before a decimal point, and before the units in which carom itself writes large numbers, as in ``50,540 N s/m``.
    Powers of ten as carom writes them, ``1.2×10⁹``, become ``1.2e9``.  Elsewhere one comma may mark decimals: in many countries ``1,500 mm`` is a millimetre and a half.
    """
    text = _POWER.sub(lambda power: f"e{power[1].translate(_LOWERED)}", text.translate(_SPACES).strip())
    groups = _GROUPS.match(text)
    if groups:
        return text[: groups.end()].replace(groups["gap"], "") + text[groups.end() :]
    commas = _COMMAS.fullmatch(text)
    if commas and (commas["decimals"] or len(commas["groups"]) > 4 or commas["unit"].strip() in _WITH_COMMAS):
        return f"{commas['number'].replace(',', '')} {commas['unit']}".strip()
    return text


def comma_advice(text: str) -> str:
    """Say how to write a number with a comma that cannot be read; nothing if the text does not begin with one."""
    plain = text.translate(_SPACES).strip()
    comma = _COMMA.fullmatch(plain)
    if not comma:
        return ""
    if not set(".' ").isdisjoint(comma["before"]) or "," in comma["after"]:
        return "decimals take a point, and spaces separate thousands: 12 345.6"
    decimal = shown(f"{comma['before'] or '0'}.{comma['after']}")
    if _COMMAS.fullmatch(plain):
        thousands = shown(f"{comma['before']} {comma['after']}")
        return f"a comma may mark decimals or thousands: write {decimal} or {thousands}"
    return f"decimals take a point, not a comma: write {decimal}"


def _from_text(field: Field, text: str) -> float | Decimal:
    plain = text.strip()
    lettered = bool(field.letter) and plain.startswith(field.letter)
    plain = without_separators(plain.removeprefix(field.letter) if lettered else plain)
    digits, unit = _number_and_unit(field, text, plain, _TEXT, "this does not start with a number")
    number = float(digits)
    if lettered and unit:
        raise field.error(text, f"a number after {field.letter} has no unit")
    if number == 0 or not math.isfinite(number):  # also decimals too long for Decimal, such as 1e-999999999999
        if unit:
            unit_factor(field, unit, text)
        return number
    with localcontext(_DIGITS):
        return Decimal(digits) * unit_factor(field, unit, text) if unit else Decimal(digits)


def _number_and_unit(field: Field, text: str, plain: str, pattern: re.Pattern[str], otherwise: str) -> tuple[str, str]:
    """Number and unit of a ``plain`` text; errors show the whole of it, and say that it is ``otherwise`` if it is of another pattern."""
    if advice := comma_advice(plain):
        raise field.error(text, advice)
    match = pattern.fullmatch(plain)
    if not match:
        raise field.error(text, otherwise if text.strip() else "this is empty")
    number, unit = match["number"], match["unit"].strip()
    if field.needs_unit and not unit:
        raise field.error(text, _unit_advice(field, number))
    return number, unit


def unit_of(field: Field, text: str) -> str:
    """Unit that stands in a text which :func:`read_quantity` reads; the letter of the field if this stands there instead."""
    plain = text.strip()
    if field.letter and plain.startswith(field.letter):
        return field.letter
    match = _TEXT.fullmatch(without_separators(plain))
    return match["unit"].strip() if match else ""


def _unit_advice(field: Field, number: str) -> str:
    """Say how to write a number without a unit."""
    written = (f"{number} {unit}" for unit in dict.fromkeys((field.usual_unit, field.unit)))
    return f"this has no unit: write {shown(' or '.join(written))}"


def unit_factor(field: Field, unit: str, text: str) -> Decimal:
    """Size of one `unit` in SI units of the field, to the digits of the context; `text` is shown in errors."""
    try:
        if len(unit) > _LONGEST_UNIT or not _UNIT.fullmatch(_HYPHEN.sub("*", unit)):
            raise ValueError(unit)
        scale, roots = _roots(_MEANT.get(field.unit, {}).get(unit) or _HYPHEN.sub("*", unit))
        field_scale, field_roots = _roots(field.unit)
    except Exception:  # noqa: BLE001  (pint raises errors of its own and of all kinds)
        raise field.error(text, f"{unit!r} is not a unit that can be used here") from None
    if roots == field_roots:
        return scale / field_scale
    if field.unit == "rad/s" and roots == _roots("1/s")[1]:
        raise field.error(
            text, f"{unit!r} leaves open whether turns or radians are counted: write rpm, Hz, rev/s or rad/s"
        )
    kind = field.kind.split(" ", 1)[1]
    raise field.error(text, f"{unit!r} is not a unit of {kind}" if field.unit else f"this number has no unit {unit!r}")


def _roots(unit: str) -> tuple[Decimal, Roots]:
    """Factor and root units of a unit.

    Raises an exception of any kind for text that is no unit, or a unit with an offset or a logarithm.
    """
    return COMMON_UNITS.get(unit) or _CELSIUS.get(unit) or _roots_by_pint(unit)


@cache
def _roots_by_pint(unit: str) -> tuple[Decimal, Roots]:
    registry = _registry()
    units = registry.parse_units(unit)
    if registry.Quantity(Decimal(0), units).to_root_units().magnitude != 0:
        raise ValueError(unit)
    scale, roots = registry.get_root_units(units)
    return Decimal(scale), frozenset(registry.Quantity(Decimal(1), roots).unit_items())


@cache
def _registry() -> Any:
    import pint  # imported only for a value with an uncommon unit: it takes longer than all the rest

    registry: pint.UnitRegistry[Decimal] = pint.UnitRegistry(non_int_type=Decimal)
    # Notations that engineers use and pint does not define.
    registry.define("rev = revolution")
    registry.define("r = revolution")
    registry.define("@alias rpm = RPM")
    registry.define("Ns = newton * second")
    registry.define("As = ampere * second")
    registry.define("gmm = gram * millimeter")
    return registry


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
            raise field.error(text, _unit_advice(field, repr(float(digits))))
        number = Fraction(read_quantity(field, float(digits)))
        return ExactNumber(number, number)
    return _exact_from_text(field, text)


def _exact_from_text(field: Field, text: str) -> ExactNumber:
    plain = without_separators(text)
    number, unit = _number_and_unit(field, text, plain, _EXACT, "this is not a decimal number or a fraction")
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
    with localcontext(_DIGITS):
        factor = unit_factor(field, unit, text).normalize()  # without zeros at the end, as of an inch from pint
    if unit in _TURNS:
        return _TURNS[unit], 1
    if len(factor.as_tuple().digits) > _MOST_DIGITS:
        raise field.error(text, f"{unit!r} cannot be converted exactly; give the value in {field.unit}")
    return Fraction(factor), 0
