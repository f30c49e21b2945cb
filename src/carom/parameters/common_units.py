"""The units that machine files mostly use, as pint converts them.

Importing pint and building its registry takes longer than all the rest of reading a machine file.  The units listed
here need neither.  Any other unit, and any other spelling of these, is left to pint.
``tests/parameters/test_quantities.py`` compares every entry with pint.
"""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal

Roots = frozenset[tuple[str, Decimal]]
"""Root units of pint, each with its exponent; radians are distinguished from pure numbers."""

_INCH = "0.02540000000000000000000000000000000000000"
_DEGREE = "0.01745329251994329576923690768488612713443"
_TURN_A_MINUTE = "0.1047197551196597746154214461093167628066"
_POUND_FORCE_PER_INCH = "175126.8352464763779527559055118110236220"

# Exponents of metre, gram, second, radian and ampere, zeros at the end left out; then the factors, to the 40 digits
# requested from pint.
_WRITTEN: Mapping[tuple[int, ...], Mapping[str, str]] = {
    (0, 0, 0, 0): {"": "1", "%": "0.01", "percent": "0.01"},
    (1, 0, 0, 0): {
        "m": "1",
        "cm": "0.01",
        "mm": "0.001",
        "µm": "0.000001",
        "μm": "0.000001",
        "um": "0.000001",
        "nm": "1E-9",
        "in": _INCH,
        "inch": _INCH,
    },
    (0, 1, 0, 0): {"kg": "1E+3", "g": "1", "t": "1E+6", "lb": "453.59237"},
    (0, 0, 1, 0): {"s": "1", "ms": "0.001", "µs": "0.000001", "μs": "0.000001", "us": "0.000001", "min": "60"},
    (0, 0, 0, 1): {"rad": "1", "mrad": "0.001", "deg": _DEGREE, "degree": _DEGREE, "degrees": _DEGREE, "°": _DEGREE},
    (0, 0, -1, 1): {
        "rad/s": "1",
        "rpm": _TURN_A_MINUTE,
        "RPM": _TURN_A_MINUTE,
        "rev/min": _TURN_A_MINUTE,
        "r/min": _TURN_A_MINUTE,
        "rev/s": "6.283185307179586476925286766559005768394",
        "deg/s": _DEGREE,
    },
    (0, 0, -1, 0): {"1/s": "1", "Hz": "1", "kHz": "1E+3"},
    (1, 0, -1, 0): {"m/s": "1", "mm/s": "0.001", "µm/s": "0.000001", "μm/s": "0.000001", "um/s": "0.000001"},
    (1, 0, -2, 0): {
        "m/s^2": "1",
        "m/s**2": "1",
        "m/s²": "1",
        "mm/s^2": "0.001",
        "mm/s²": "0.001",
        "gravity": "9.80665",
        "g_0": "9.80665",
    },
    (1, 1, -2, 0): {"N": "1E+3", "kN": "1E+6", "mN": "1", "lbf": "4448.2216152605"},
    (1, 1, -1, 0): {"N s": "1E+3", "N*s": "1E+3", "N·s": "1E+3", "Ns": "1E+3", "mN s": "1", "kg m/s": "1E+3"},
    (0, 1, -2, 0): {
        "N/m": "1E+3",
        "N/mm": "1E+6",
        "N/µm": "1E+9",
        "N/μm": "1E+9",
        "N/um": "1E+9",
        "kN/m": "1E+6",
        "kN/mm": "1E+9",
        "MN/m": "1E+9",
        "lbf/in": _POUND_FORCE_PER_INCH,
    },
    (0, 1, -1, 0): {
        "N s/m": "1E+3",
        "N*s/m": "1E+3",
        "N·s/m": "1E+3",
        "Ns/m": "1E+3",
        "kg/s": "1E+3",
        "N s/mm": "1E+6",
        "N*s/mm": "1E+6",
        "N·s/mm": "1E+6",
        "Ns/mm": "1E+6",
        "kN s/m": "1E+6",
        "lbf s/in": _POUND_FORCE_PER_INCH,
    },
    (1, 1): {
        "kg m": "1E+3",
        "kg mm": "1",
        "g m": "1",
        "g cm": "0.01",
        "g mm": "0.001",
        "g*mm": "0.001",
        "g·mm": "0.001",
        "gmm": "0.001",
    },
    (0, 0, 0, 0, 1): {"A": "1", "mA": "0.001"},
    (0, 0, -1, 0, 1): {"A/s": "1", "kA/s": "1E+3", "A/ms": "1E+3", "mA/ms": "1"},
    (-1, 0, 0, 0, 1): {"A/m": "1", "A/mm": "1E+3", "mA/mm": "1", "A/µm": "1E+6", "A/μm": "1E+6", "A/um": "1E+6"},
    (-1, 0, 1, 0, 1): {"A s/m": "1", "A*s/m": "1", "A·s/m": "1", "As/m": "1", "A s/mm": "1E+3", "mA s/mm": "1"},
    (1, 1, -2, 0, -1): {"N/A": "1E+3", "kN/A": "1E+6"},
}


def _roots(exponents: tuple[int, ...]) -> Roots:
    named = zip(("meter", "gram", "second", "radian", "ampere"), exponents, strict=False)
    return frozenset((name, Decimal(exponent)) for name, exponent in named if exponent)


COMMON_UNITS: Mapping[str, tuple[Decimal, Roots]] = {
    unit: (Decimal(factor), _roots(exponents))
    for exponents, units in _WRITTEN.items()
    for unit, factor in units.items()
}
"""Factor and root units of each unit."""
