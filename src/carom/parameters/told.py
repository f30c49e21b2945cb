"""Numbers and sizes as people write them: speeds of the rotor centre in mm/s, accelerations in g, angles in degrees."""

from __future__ import annotations

import math

from carom.parameters.requirement import GRAVITY
from carom.parameters.scaling import UNITS, Scales

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_SHOWN = {
    "velocity": (1e3, "mm/s"),
    "length": (1e3, "mm"),
    "acceleration": (1.0 / GRAVITY, "g"),
    "unbalance": (1e6, "g mm"),
    "time": (1e3, "ms"),
}
_OWN = {"Omega": "Ω", "^2": "²", "^3": "³"}


def number(value: float, digits: int = 4) -> str:
    """Write a number with the given significant digits and thousands separators: ``1,400``, ``0.0725``, ``2.38×10⁹``."""
    if value == 0:
        return "0"
    if not math.isfinite(value):
        return str(value)
    rounded = float(f"{value:.{digits - 1}e}")
    if not 1e-4 <= abs(rounded) < 1e8:
        mantissa, exponent = f"{rounded:.{digits - 1}e}".split("e")
        return f"{float(mantissa):g}×10{str(int(exponent)).translate(_RAISED)}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
    text = f"{rounded:,.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def shown_in(kind: str, scales: Scales | None) -> tuple[float, str]:
    """Return the unit in which people are told a size, and by what to multiply one in units of the equations.

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
    """Return the unit in which people are told a length, speed or acceleration given in an SI unit, and by what to multiply it."""
    kinds = {UNITS[kind][1]: kind for kind in ("length", "velocity", "acceleration")}
    return _SHOWN[kinds[unit]] if unit in kinds else (1.0, unit)


def told(value: float, kind: str, scales: Scales | None, digits: int = 3) -> str:
    """Write a size given in units of the equations in this unit: ``60 mm/s``, ``5 g``; a time without scales as ``0.5/Ω``."""
    factor, unit = shown_in(kind, scales)
    return f"{number(factor * value, digits)}{unit[1:] if unit.startswith('1/') else f' {unit}'}"


def told_beside(value: float, kind: str, scales: Scales | None) -> str:
    """What stands behind a number in units of the equations for people: `` (60 mm/s)``; nothing without scales."""
    return "" if scales is None else f" ({told(value, kind, scales)})"


def told_angle(angle: float) -> str:
    """Write an angle given in rad in degrees: ``30°``."""
    return f"{number(math.degrees(angle), 3)}°"
