"""Scales of a rotor inside a clearance: the units of the equations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from carom.parameters.fields import MACHINE_FIELDS, Field
from carom.parameters.quantities import read_quantity

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


def plain_number(fields: Mapping[str, Field], name: str, given: object) -> float:
    """Check a number given in Python; text with units is refused here."""
    if isinstance(given, str):
        raise fields[name].error(given, "this is text, not a number")
    return read_quantity(fields[name], given)
