"""Dimensionless numbers and physical values: the one place that converts them, and what each parameter moves."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from decimal import Decimal
from typing import TYPE_CHECKING, Any, NamedTuple

from carom.parameters.fields import DIMENSIONLESS_FIELDS, PHYSICAL_PARTNER

if TYPE_CHECKING:
    from carom.parameters.scaling import Parameters


_STEP = 1e-30
"""Its square is far below the rounding error of any parameter."""


class Units(NamedTuple):
    """Mass, clearance and rotational speed, the units of the equations, as plain numbers."""

    mass: float
    clearance: float
    speed: float


class Conversion(NamedTuple):
    """A dimensionless number is ``(value/unit)^(1/power)``, with the value of its partner among the machine fields."""

    unit: Callable[[Any], float]
    """The unit in SI units, from :class:`Units` or :class:`~carom.parameters.Scales`."""
    power: int = 1

    def number(self, value: float, scales: Any) -> float:
        """Dimensionless number of a value in SI units; an analytic function of both."""
        ratio = value / self.unit(scales)
        return _root(ratio) if self.power == 2 else ratio

    def value(self, number: Any, scales: Any) -> Any:
        """Value in SI units of a dimensionless number, a float or an exact ``Decimal``."""
        unit = self.unit(scales)
        return number**self.power * (Decimal(unit) if isinstance(number, Decimal) else unit)


def _root(value: Any) -> Any:
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


class Numbers(NamedTuple):
    """The dimensionless parameters as plain unchecked numbers, for functions that are evaluated thousands of times.

    They may be complex with a tiny imaginary part, for derivatives; ``mu`` is negative for orbits with backward slip.
    """

    gamma: float
    omega: float
    rho: float
    phi: float
    mu: float
    d: float
    radius_ratio: float
    units: Units | None = None

    @classmethod
    def of(cls, parameters: Parameters) -> Numbers:
        """Read the numbers of some parameters."""
        scales = parameters.scales
        units = None if scales is None else Units(scales.mass, scales.clearance, scales.speed)
        return cls(**parameters.as_dict(), units=units)

    @property
    def parameters(self) -> Parameters:
        """Checked parameters.

        Raises
        ------
        InputError
            A number out of its range.
        """
        from carom.parameters.scaling import Parameters, Scales

        return Parameters(*self[:7], scales=None if self.units is None else Scales(*self.units))

    def value(self, name: str) -> float:
        """Value of a parameter, in SI units if it is a physical one; those need units."""
        return _READ[name](self)

    def moved(self, name: str, value: float) -> Numbers:
        """Numbers with another value of one parameter; an analytic function of it.

        A dimensionless parameter moves alone.  A physical one, in SI units, moves whatever depends on it while the
        other physical ones stay: the shaft speed ``Ω`` moves ``γ = c/(mΩ)`` and ``ω = √(k/m)/Ω``, and not ``ρ``.
        """
        return _MOVES[name](self, value)

    def rates(self, name: str) -> list[float]:
        """Derivatives of the seven numbers by a parameter: imaginary parts after a tiny imaginary step, exact but for rounding."""
        if name in self._fields:  # it moves alone
            return [float(name == field) for field in self._fields[:7]]
        moved = self.moved(name, complex(self.value(name), _STEP))  # type: ignore[arg-type]
        return [complex(number).imag / _STEP for number in moved[:7]]


def _with_speed(numbers: Any, speed: float) -> Numbers:
    mass, clearance, present = numbers.units
    ratio = present / speed
    gamma, omega = numbers.gamma * ratio, numbers.omega * ratio
    return Numbers._make((gamma, omega, *numbers[2:7], Units(mass, clearance, speed)))


def _with_mass(numbers: Any, mass: float) -> Numbers:
    present, clearance, speed = numbers.units
    ratio = present / mass
    gamma, omega = numbers.gamma * ratio, numbers.omega * _root(ratio)
    return Numbers._make((gamma, omega, *numbers[2:7], Units(mass, clearance, speed)))


def _with_clearance(numbers: Any, clearance: float) -> Numbers:
    gamma, omega, rho, phi, mu, d, radius_ratio, (mass, present, speed) = numbers
    ratio = present / clearance
    return Numbers(gamma, omega, rho * ratio, phi, mu, d, radius_ratio * ratio, Units(mass, clearance, speed))


_MOVES: dict[str, Callable[[Numbers, float], Numbers]] = {
    "speed": _with_speed,
    "mass": _with_mass,
    "clearance": _with_clearance,
}
_READ: dict[str, Callable[[Any], float]] = {
    "speed": lambda numbers: numbers.units.speed,
    "mass": lambda numbers: numbers.units.mass,
    "clearance": lambda numbers: numbers.units.clearance,
}


def _add(name: str) -> None:
    """Add a dimensionless parameter and its partner."""
    place, conversion = Numbers._fields.index(name), CONVERSIONS[name]

    def move(numbers: Any, value: float) -> Numbers:
        return Numbers._make((*numbers[:place], value, *numbers[place + 1 :]))

    _MOVES[name], _READ[name] = move, lambda numbers: numbers[place]
    _MOVES[PHYSICAL_PARTNER[name]] = lambda numbers, value: move(numbers, conversion.number(value, numbers.units))
    _READ[PHYSICAL_PARTNER[name]] = lambda numbers: conversion.value(numbers[place], numbers.units)


for _name in DIMENSIONLESS_FIELDS:
    _add(_name)
