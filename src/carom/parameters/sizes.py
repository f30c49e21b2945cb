"""Sizes of starts, times and disturbances: in units of the equations, or with a unit if the machine is known."""

from __future__ import annotations

import re
from dataclasses import replace
from decimal import Decimal
from typing import NamedTuple

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.parameters.fields import Field
from carom.parameters.quantities import read_quantity, without_separators
from carom.parameters.scaling import UNITS, Scales

_HUGE = 1e12


_KINDS = {
    "length": ("a length", "mm", "0.3 mm"),
    "velocity": ("a velocity", "mm/s", "50 mm/s"),
    "acceleration": ("an acceleration", "g", "20 g"),
    "unbalance": ("an unbalance", "g mm", "5000 g mm"),
    "impulse": ("an impulse", "N s", "3 N s"),
    "time": ("a time", "ms", "11 ms"),
    "speed": ("an angular speed", "rpm", "9000 rpm"),
    "angle": ("an angle", "deg", "30 deg"),
}
"""Kinds of sizes in words, the unit in which people usually say them, and an example."""
_PLAIN = re.compile(r"\s*[+-]?(?:[0-9.]+(?:[eE][+-]?[0-9]+)?|(?i:nan|inf|infinity))\s*")
_GRAVITIES = re.compile(r"(.*[0-9.])\s*g\s*", re.DOTALL)
"""Accelerations such as ``20 g``, as engineers write shocks; in tables of units ``g`` is the gram."""


_TIME = "a finite time above 0, in 1/Omega or with a unit, such as '2 s'"
LONGEST_TIME = 1e9
"""Longest time to follow a motion, in ``1/Ω``: more than a hundred million turns, which take hours."""


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
    scales : Scales or None
        Needed for values with units.
    bare : bool
        Whether text without a unit is allowed where the scales are known.

    Raises
    ------
    InputError
        The value is not a size of this kind, or it has a unit and the scales are not known, or none where it needs one.
    """
    if kind not in _KINDS:
        raise InputError("kind", kind, f"one of: {', '.join(_KINDS)}")
    (words, usual, example), (own, unit) = _KINDS[kind], UNITS.get(kind, ("rad", "rad"))
    needs_unit = scales is not None and not bare
    field = Field(name, "", "", words, "", -_HUGE, _HUGE, f"0.5 or '{example}'", bare=own)
    if not isinstance(given, str) or (not needs_unit and _PLAIN.fullmatch(without_separators(given))):
        return Size(read_quantity(field, given), False, kind)
    in_units = replace(field, unit=unit, usual=usual, needs_unit=needs_unit)
    if needs_unit:
        in_units = replace(in_units, example=f"'{example}'")
    gravities = _GRAVITIES.fullmatch(given) if kind == "acceleration" else None
    try:
        number = read_quantity(in_units, f"{gravities[1]} standard_gravity" if gravities else given)
    except InputError as problem:
        raise InputError(name, shown(given), problem.allowed) from None
    if kind == "angle":
        return Size(number, False, kind)
    if scales is None:
        words = f"must be a number without a unit, in {own}: the machine file is dimensionless and has no scales"
        raise InputError(name, shown(given), words)
    return Size(number, True, kind)


@checked
def own_size(name: str, given: object, kind: str, scales: Scales | None) -> float:
    """Convert text with a unit to the units of the equations; a number is already in these."""
    return read_size(name, given, kind, scales).own(scales)


@checked
def read_unbalance(name: str, given: object, scales: Scales | None) -> Size:
    """Read an unbalance, or the eccentricity that it is of the whole mass; without scales a number in clearances."""
    if scales is None:
        return read_size(name, given, "length", scales)
    try:
        return read_size(name, given, "unbalance", scales, bare=False)
    except InputError as problem:
        try:
            eccentricity = read_size(name, given, "length", scales, bare=False)
        except InputError:
            raise problem from None
    return Size(float(Decimal(repr(eccentricity.value)) * Decimal(repr(scales.mass))), True, "unbalance")


@checked
def own_unbalance(name: str, given: object, scales: Scales | None) -> float:
    """Convert text with a unit of an unbalance or an eccentricity to clearances; a number is already in these."""
    return read_unbalance(name, given, scales).own(scales)


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
