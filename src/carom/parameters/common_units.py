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


def _roots(exponents: tuple[int, ...]) -> Roots:
    named = zip(("meter", "gram", "second", "radian", "ampere"), exponents, strict=False)
    return frozenset((name, Decimal(exponent)) for name, exponent in named if exponent)


COMMON_UNITS: Mapping[str, tuple[Decimal, Roots]] = {
    unit: (Decimal(factor), _roots(exponents))
    for exponents, factors in _WRITTEN.items()
    for factor, units in factors.items()
    for unit in units.split(", ")
}
"""Factor and root units of each unit."""
