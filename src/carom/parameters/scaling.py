"""Scales of a rotor inside a clearance: the units of the equations."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, NamedTuple

from carom.parameters.fields import MACHINE_FIELDS, Field
from carom.parameters.quantities import read_quantity

GRAVITY = 9.80665
"""Standard acceleration of free fall, m/s²."""
UNITS = {
    "mass": ("m", "kg"),
    "length": ("c_r", "m"),
    "time": ("1/Omega", "s"),
    "speed": ("Omega", "rad/s"),
    "velocity": ("c_r Omega", "m/s"),
    "acceleration": ("c_r Omega^2", "m/s^2"),
    "force": ("m c_r Omega^2", "N"),
    "impulse": ("m c_r Omega", "N s"),
    "energy": ("m c_r^2 Omega^2", "J"),
    "power": ("m c_r^2 Omega^3", "W"),
    "unbalance": ("m c_r", "kg m"),
    "damping": ("m Omega", "N s/m"),
    "stiffness": ("m Omega^2", "N/m"),
}
"""Units of each property of :class:`Scales`: that of the equations, and the SI unit."""

SCALING = ("mass", "clearance", "speed")
"""Fields of a machine that are its scales."""


@dataclass(frozen=True)
class Scales:
    """The units in which the equations are written: rotor mass, clearance and rotational speed.

    Parameters
    ----------
    mass : float
        Rotor mass m, kg.
    clearance : float
        Radius c_r of the clearance circle, m.
    speed : float
        Rotational speed Ω, rad/s.

    Raises
    ------
    InputError
        If one of them is not a positive number within the range of the machine field of the same name.

    Notes
    -----
    Multiply a dimensionless result by the property of its kind to get SI units: position by `length`, time by
    `time`, impulse by `impulse`, ... (scaling of the source paper, section 2).
    """

    mass: float
    clearance: float
    speed: float

    def __post_init__(self) -> None:
        for name in SCALING:
            object.__setattr__(self, name, plain_number(MACHINE_FIELDS, name, getattr(self, name)))

    @property
    def length(self) -> float:
        """Unit of length: c_r, m."""
        return self.clearance

    @property
    def time(self) -> float:
        """Unit of time: 1/Ω, s."""
        return 1.0 / self.speed

    @property
    def velocity(self) -> float:
        """Unit of velocity: c_r Ω, m/s."""
        return self.clearance * self.speed

    @property
    def acceleration(self) -> float:
        """Unit of acceleration: c_r Ω², m/s²."""
        return self.clearance * (self.speed * self.speed)

    @property
    def force(self) -> float:
        """Unit of force: m c_r Ω², N."""
        return self.mass * self.acceleration

    @property
    def impulse(self) -> float:
        """Unit of impulse: m c_r Ω, N s."""
        return self.mass * self.velocity

    @property
    def energy(self) -> float:
        """Unit of energy: m c_r² Ω², J."""
        return self.force * self.clearance

    @property
    def power(self) -> float:
        """Unit of power: m c_r² Ω³, W."""
        return self.energy * self.speed

    @property
    def unbalance(self) -> float:
        """Unit of unbalance: m c_r, kg m."""
        return self.mass * self.clearance

    @property
    def damping(self) -> float:
        """Unit of damping: m Ω, N s/m; the damping of a machine is gamma times this unit."""
        return self.mass * self.speed

    @property
    def stiffness(self) -> float:
        """Unit of stiffness: m Ω², N/m; the stiffness of a machine is omega² times this unit."""
        return self.mass * (self.speed * self.speed)


class Units(NamedTuple):
    """Mass, clearance and rotational speed, the units of the equations, as plain numbers."""

    mass: float
    clearance: float
    speed: float


def plain_number(fields: Mapping[str, Field], name: str, given: object) -> float:
    """Check a number given in Python; text with units is refused here."""
    if isinstance(given, str):
        raise fields[name].error(given, "this is text, not a number")
    return read_quantity(fields[name], given)


class Conversion(NamedTuple):
    """A dimensionless number is ``(value/unit)^(1/power)``, with the value of its partner among the machine fields."""

    unit: Callable[[Scales | Units], float]
    """The unit in SI units."""
    power: int = 1

    def number(self, value: float, scales: Scales | Units) -> float:
        """Dimensionless number of a value in SI units; an analytic function of both."""
        ratio = value / self.unit(scales)
        return root(ratio) if self.power == 2 else ratio

    def value(self, number: Any, scales: Scales | Units) -> Any:
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
