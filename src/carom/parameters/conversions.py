"""Dimensionless numbers and physical values: the one place that converts them."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from decimal import Decimal
from typing import Any, NamedTuple


class Conversion(NamedTuple):
    """A dimensionless number is ``(value/unit)^(1/power)``, with the value of its partner among the machine fields."""

    unit: Callable[[Any], float]
    """The unit in SI units, from :class:`~carom.parameters.numbers.Units` or :class:`~carom.parameters.Scales`."""
    power: int = 1

    def number(self, value: float, scales: Any) -> float:
        """Dimensionless number of a value in SI units; an analytic function of both."""
        ratio = value / self.unit(scales)
        return root(ratio) if self.power == 2 else ratio

    def value(self, number: Any, scales: Any) -> Any:
        """Value in SI units of a dimensionless number, a float or an exact ``Decimal``."""
        unit = self.unit(scales)
        return number**self.power * (Decimal(unit) if isinstance(number, Decimal) else unit)


def root(value: Any) -> Any:
    """Square root, ``nan`` for negative numbers; complex ones have a tiny imaginary part, for derivatives."""
    if isinstance(value, complex):
        return cmath.sqrt(value) if value.real >= 0.0 else math.nan
    return math.sqrt(value) if value >= 0.0 else math.nan


_SAME = Conversion(lambda scales: 1.0)
CONVERSIONS: Mapping[str, Conversion] = {
    "gamma": Conversion(lambda scales: scales.mass * scales.speed),
    "omega": Conversion(lambda scales: scales.mass * (scales.speed * scales.speed), 2),
    "rho": Conversion(lambda scales: scales.clearance),
    "phi": _SAME,
    "mu": _SAME,
    "d": _SAME,
    "radius_ratio": Conversion(lambda scales: scales.clearance),
}
"""Each dimensionless number and its partner (:data:`~carom.parameters.PHYSICAL_PARTNER`); (2.12) of the source paper."""
