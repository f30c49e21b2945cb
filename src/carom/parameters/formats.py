"""Numbers and sizes as people write and read them: speeds of the rotor centre in mm/s, accelerations in g, angles in degrees.

Sizes of starts, times and disturbances are read in units of the equations, or with a unit if the machine is known.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from decimal import Decimal
from typing import NamedTuple, TypeVar

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.parameters.fields import PHYSICAL_PARTNER, Field
from carom.parameters.quantities import read_quantity, without_separators
from carom.parameters.scaling import CONVERSIONS, GRAVITY, UNITS, Scales
from carom.parameters.terms import SETTABLE

_Number = TypeVar("_Number", float, Decimal)
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Exponents as people write them."""
_SHOWN = {
    "velocity": (1e3, "mm/s"),
    "length": (1e3, "mm"),
    "acceleration": (1.0 / GRAVITY, "g"),
    "unbalance": (1e6, "g mm"),
    "time": (1e3, "ms"),
}
"""By what to multiply an SI unit to get the unit in which people see a size, and that unit."""
_OWN = {"Omega": "Ω", "^2": "²", "^3": "³"}
_HUGE = 1e12
_KINDS = {
    "length": ("a length", "0.3 mm"),
    "velocity": ("a velocity", "50 mm/s"),
    "acceleration": ("an acceleration", "20 g"),
    "unbalance": ("an unbalance", "5000 g mm"),
    "impulse": ("an impulse", "3 N s"),
    "time": ("a time", "11 ms"),
    "speed": ("an angular speed", "9000 rpm"),
    "angle": ("an angle", "30 deg"),
}
"""Kinds of sizes that are read, in words, and an example in the unit in which people usually say them."""
_PLAIN = re.compile(r"\s*[+-]?(?:[0-9.]+(?:[eE][+-]?[0-9]+)?|(?i:nan|inf|infinity))\s*")
_GRAVITIES = re.compile(r"(.*[0-9.])\s*g\s*", re.DOTALL)
"""Accelerations such as ``20 g``, as engineers write shocks; in tables of units ``g`` is the gram."""
_TIME = "a finite time above 0, in 1/Omega or with a unit, such as '2 s'"
LONGEST_TIME = 1e9
"""Longest time to follow a motion, in ``1/Ω``: more than a hundred million turns, which take hours."""


def number(value: float, digits: int = 4) -> str:
    """Write a number with the given significant digits and thousands separators: ``1,400``, ``0.0725``, ``2.38×10⁹``."""
    if value == 0:
        return "0"
    if not math.isfinite(value):
        return str(value)
    rounded = float(f"{value:.{digits - 1}e}")
    if not 1e-4 <= abs(rounded) < 1e8:
        mantissa, exponent = f"{rounded:.{digits - 1}e}".split("e")
        return f"{float(mantissa):g}×10{str(int(exponent)).translate(RAISED)}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    text = f"{rounded:,.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def complex_words(value: complex) -> str:
    """A complex number to six digits: ``0.5 − 0.25i``."""
    if value.imag == 0:
        return f"{value.real:.6g}"
    return f"{value.real:.6g} {'+' if value.imag >= 0 else '−'} {abs(value.imag):.6g}i"


def rounded_down(value: float, digits: int = 4) -> float:
    """Round a positive number down to significant digits: what is proven must not be stated as more."""
    unit = 10.0 ** (math.floor(math.log10(value)) - digits + 1)
    # A number that has no more digits stays, whatever its last bit is.
    return math.floor(value / unit * (1.0 + 1e-14)) * unit


def shown_in(kind: str, scales: Scales | None) -> tuple[float, str]:
    """Return the unit in which people see a size, and by what to multiply one in units of the equations.

    The kind is a property of :class:`~carom.parameters.Scales`.  Without scales it is the unit of the equations.
    """
    own, si = UNITS[kind]
    if scales is None:
        for written, sign in _OWN.items():
            own = own.replace(written, sign)
        return 1.0, own
    factor, unit = _SHOWN.get(kind, (1.0, si))
    return float(getattr(scales, kind)) * factor, unit


def shown_from_si(unit: str) -> tuple[float, str]:
    """Return the unit in which people see a length, time, speed or acceleration given in an SI unit, and by what to multiply it."""
    kinds = {UNITS[kind][1]: kind for kind in ("length", "time", "velocity", "acceleration")}
    return _SHOWN[kinds[unit]] if unit in kinds else (1.0, unit)


def format_quantity(value: float, kind: str, scales: Scales | None, digits: int = 3) -> str:
    """Write a size given in units of the equations in this unit: ``60 mm/s``, ``5 g``; a time without scales as ``0.5/Ω``."""
    factor, unit = shown_in(kind, scales)
    if unit == "mm" and 0.0 < abs(factor * value) < 1e-2:
        factor, unit = 1e3 * factor, "µm"
    return f"{number(factor * value, digits)}{unit[1:] if unit.startswith('1/') else f' {unit}'}"


def format_beside(value: object, kind: str, scales: Scales | None) -> str:
    """What stands behind numbers in units of the equations for people: `` (60 mm/s)``; nothing without scales.

    Of an array of more than one number it is the range of the finite ones; nothing if there are none, or if they are complex.
    """
    import numpy as np  # reading a machine file does without

    numbers = np.asarray(value)
    if scales is None or numbers.dtype.kind not in "iufc":
        return ""
    if numbers.size == 1:
        (one,) = numbers.ravel().tolist()
        return f" ({_format_number(one, kind, scales)})" if np.isfinite(one) else ""
    if numbers.dtype.kind == "c" or not np.isfinite(numbers).any():
        return ""
    known = numbers[np.isfinite(numbers)]
    low, high = (_format_number(float(end), kind, scales) for end in (known.min(), known.max()))
    return f" ({format_interval(low, high)})"


def _format_number(value: complex, kind: str, scales: Scales) -> str:
    """A real or complex number, or an angle in rad, with its unit."""
    if kind == "angle":
        return format_angle(value.real)
    if not isinstance(value, complex):
        return format_quantity(value, kind, scales)
    factor, unit = shown_in(kind, scales)
    up = number(factor * value.imag, 3)
    return f"{number(factor * value.real, 3)}{up if up.startswith('-') else f'+{up}'}i {unit}"


def format_angle(angle: float) -> str:
    """Write an angle given in rad in degrees: ``30°``."""
    return f"{number(math.degrees(angle), 3)}°"


def format_entry(parameter: str | Field, value: float, digits: int = 4) -> str:
    """Write a parameter given in SI units in the unit in which people usually say it: ``1,759 rpm``, ``1.592 µm``, ``0.152``.

    One that is none of the planar rotor is given by its field.
    """
    field = SETTABLE[parameter] if isinstance(parameter, str) else parameter
    if field.usual_unit == "mm" and 0.0 < value < 1e-4:
        return f"{number(value / 1e-6, digits)} µm"
    return f"{number(field.in_usual_unit(value), digits)} {field.usual_unit}".rstrip()


def format_range(parameter: str | Field, values: Iterable[float]) -> str:
    """Write the range of some values of a parameter: ``500 to 2,000 N s/m``."""
    ends = list(values)
    return format_interval(format_entry(parameter, min(ends)), format_entry(parameter, max(ends)))


def own_entry(name: str, value: _Number, scales: Scales | None) -> tuple[str, _Number]:
    """A parameter with a value; with scales what a machine has in place of a dimensionless one, in SI units."""
    if scales is None or name not in PHYSICAL_PARTNER:
        return name, value
    return PHYSICAL_PARTNER[name], CONVERSIONS[name].value(value, scales)


def format_along(name: str, values: Iterable[float], scales: Scales | None = None) -> str:
    """Write a parameter with the range of some values; with scales what a machine has in place of a dimensionless one."""
    (entry, *_), own = zip(*(own_entry(name, value, scales) for value in values), strict=True)
    return f"{entry} {format_range(entry, own)}"


def format_interval(low: str, high: str) -> str:
    """Write a range of two sizes with one unit, where both have the same; of equal ones once."""
    unit = high.partition(" ")[2]
    return high if low == high else f"{low.removesuffix(f' {unit}') if unit else low} to {high}"


class Size(NamedTuple):
    """A size as it was given.

    Attributes
    ----------
    in_si : bool
        Whether it is in the SI unit; otherwise it is in units of the equations.
    kind : str
        Property of :class:`Scales` that gives its unit, or ``"angle"``.
    """

    value: float
    in_si: bool
    kind: str

    def own(self, scales: Scales | None) -> float:
        """Return the size in units of the equations; a size in SI units needs the scales."""
        return self.value / float(getattr(scales, self.kind)) if self.in_si else self.value


@checked
def read_size(name: str, given: object, kind: str, scales: Scales | None, bare: bool = True) -> Size:
    """Read a size: a number without a unit, in quotes or not, is in units of the equations.

    Parameters
    ----------
    name : str
        Name of the option or entry, for error messages.
    given : object
        A real number, or text; in ``"20 g"`` the unit is the standard gravity.
    kind : {"length", "velocity", "acceleration", "unbalance", "impulse", "time", "speed", "angle"}
        An unbalance may be given by the eccentricity that it is of the whole mass; without scales it is a number in clearances.
    scales : Scales or None
        Needed for values with units.
    bare : bool
        Whether text without a unit is allowed where the scales are known; never that of an unbalance.

    Raises
    ------
    InputError
        The value is not a size of this kind, or it has a unit and the scales are not known, or none where it needs one.
    """
    if kind not in _KINDS:
        raise InputError("kind", kind, f"one of: {', '.join(_KINDS)}")
    return _read_unbalance(name, given, scales) if kind == "unbalance" else _read(name, given, kind, scales, bare)


def _read_unbalance(name: str, given: object, scales: Scales | None) -> Size:
    if scales is None:
        return _read(name, given, "length", scales)
    try:
        return _read(name, given, "unbalance", scales, bare=False)
    except InputError as problem:
        try:
            eccentricity = _read(name, given, "length", scales, bare=False)
        except InputError:
            raise problem from None
    return Size(float(Decimal(repr(eccentricity.value)) * Decimal(repr(scales.mass))), True, "unbalance")


def _read(name: str, given: object, kind: str, scales: Scales | None, bare: bool = True) -> Size:
    (words, example), (own, unit) = _KINDS[kind], UNITS.get(kind, ("rad", "rad"))
    needs_unit = scales is not None and not bare
    field = Field(name, "", "", words, "", -_HUGE, _HUGE, f"0.5 or '{example}'", bare=own)
    if not isinstance(given, str) or (not needs_unit and _PLAIN.fullmatch(without_separators(given))):
        return Size(read_quantity(field, given), False, kind)
    stated = f"'{example}'" if needs_unit else field.example
    in_units = replace(field, unit=unit, usual=example.partition(" ")[2], needs_unit=needs_unit, example=stated)
    gravities = _GRAVITIES.fullmatch(given) if kind == "acceleration" else None
    try:
        value = read_quantity(in_units, f"{gravities[1]} standard_gravity" if gravities else given)
    except InputError as problem:
        raise InputError(name, shown(given), problem.allowed) from None
    if kind == "angle":
        return Size(value, False, kind)
    if scales is None:
        words = f"must be a number without a unit, in {own}: the machine file is dimensionless and has no scales"
        raise InputError(name, shown(given), words)
    return Size(value, True, kind)


@checked
def own_size(name: str, given: object, kind: str, scales: Scales | None) -> float:
    """Convert text with a unit to the units of the equations; a number is already in these."""
    return read_size(name, given, kind, scales).own(scales)


@checked
def own_time(name: str, given: object, scales: Scales | None) -> float:
    """Time to follow a motion, in units of the equations; refuse what is none above 0, and what no computer awaits."""
    if given is None:
        raise InputError(name, None, _TIME)
    time = read_size(name, given, "time", scales).own(scales)
    if not 0.0 < time <= LONGEST_TIME:
        own = f"{LONGEST_TIME:g}/Omega"
        most = own if scales is None else f"{LONGEST_TIME * scales.time:.4g} s ({own})"
        advice = "; without it a motion is followed until its end is known" if name.endswith("until") else ""
        raise InputError(name, given, f"{_TIME}, up to {most}{advice}")
    return time
