"""Scales and dimensionless parameters of a rotor inside a clearance."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from carom.arguments import checked
from carom.outcome import InputError, shown
from carom.parameters.fields import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, PARAMETERS, Field
from carom.parameters.numbers import Numbers
from carom.parameters.quantities import read_quantity
from carom.parameters.terms import no_such_parameter

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

# Smallest |omega² - 1 + i gamma|, by which the unbalance is divided to get the contact-free equilibrium: below it
# the equilibrium lies so far out that rounding leaves no digits for positions inside the clearance.
_RESONANCE = 1e-9


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
            object.__setattr__(self, name, _number(MACHINE_FIELDS, name, getattr(self, name)))

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


@dataclass(frozen=True)
class Parameters:
    """Dimensionless parameters of a rotor inside a clearance, in the co-rotating frame.

    Parameters
    ----------
    gamma : float
        Scaled damping c/(m Ω), equation (2.12) of the source paper. Negative values are allowed: a branch of
        orbits may be followed there.
    omega : float
        Natural over rotational frequency, sqrt(k/(m Ω²)), (2.12); positive.
    rho : float
        Eccentricity over clearance e_c/c_r, (2.12); not negative.
    phi : float
        Phase of the unbalance, rad.
    mu : float
        Coefficient of friction; not negative.
    d : float
        Coefficient of restitution, 0 to 1.
    radius_ratio : float
        Rotor radius over clearance R/c_r; positive.
    scales : Scales, optional
        Units that convert results to SI units.

    Raises
    ------
    InputError
        If a number is not finite or outside the range of its entry in
        :data:`carom.parameters.fields.DIMENSIONLESS_FIELDS`, or ``gamma = 0`` and ``omega = 1``: a rotor in undamped
        resonance has no equilibrium.
    """

    gamma: float
    omega: float
    rho: float
    phi: float
    mu: float
    d: float
    radius_ratio: float
    scales: Scales | None = None

    def __post_init__(self) -> None:
        for name in DIMENSIONLESS_FIELDS:
            object.__setattr__(self, name, _number(DIMENSIONLESS_FIELDS, name, getattr(self, name)))
        if math.hypot(self.omega * self.omega - 1.0, self.gamma) < _RESONANCE:
            allowed = f"must differ from 0 by {_RESONANCE:g} or more where omega = 1 (undamped resonance)"
            raise InputError("gamma", self.gamma, allowed)
        if not isinstance(self.scales, Scales | None):
            raise InputError("scales", shown(self.scales), "must be a carom.parameters.Scales, or None")

    def replace(self, /, **changes: Any) -> Parameters:
        """Return a copy with other values, dimensionless or physical.

        Parameters
        ----------
        **changes
            Numbers by their names; physical ones in SI units, or text with a unit.  Physical ones are set first, each
            with all others unchanged; a dimensionless one then moves alone.  ``scales`` are changed before all others.

        Raises
        ------
        InputError
            If a name is unknown or a value not allowed, or a physical value is given without scales.
        """
        varied = self.varied
        for name, value in changes.items():
            if name not in varied and name != "scales":
                raise no_such_parameter(name, value, varied, self.scales is not None)
        physical = {name: value for name, value in changes.items() if name in MACHINE_FIELDS}
        own = {name: value for name, value in changes.items() if name not in physical}
        if not physical:
            return Parameters(**(vars(self) | own))
        numbers = Numbers.of(dataclasses.replace(self, scales=own.pop("scales")) if "scales" in own else self)
        for name, value in physical.items():
            numbers = numbers.moved(name, read_quantity(MACHINE_FIELDS[name], value))
        return dataclasses.replace(numbers.parameters, **own) if own else numbers.parameters

    @property
    def varied(self) -> Mapping[str, Field]:
        """What :meth:`replace` can vary: dimensionless parameters, and with scales the fields of the machine too."""
        return DIMENSIONLESS_FIELDS if self.scales is None else PARAMETERS

    @checked
    def value(self, name: str) -> float:
        """Present value of a parameter, in SI units if it is a physical one.

        Raises
        ------
        InputError
            If the name is unknown, or a physical one without scales.
        """
        if name not in self.varied:
            raise no_such_parameter(name, "wanted", self.varied, self.scales is not None)
        return Numbers.of(self).value(name)

    @property
    def words(self) -> str:
        """In a line: what a machine has in SI units, or the dimensionless numbers."""
        from carom.parameters.told import told_entry  # that module needs this one

        names = DIMENSIONLESS_FIELDS if self.scales is None else MACHINE_FIELDS
        return ", ".join(f"{PARAMETERS[name].symbol} {told_entry(name, self.value(name))}" for name in names)

    def as_dict(self) -> dict[str, float]:
        """Return the seven numbers by name, without the scales."""
        return {name: getattr(self, name) for name in DIMENSIONLESS_FIELDS}

    def attributes(self) -> dict[str, str]:
        """Return the numbers and the scales as attributes of a dataset, exact to the last bit."""
        scales = dataclasses.asdict(self.scales) if self.scales else None
        return {"parameters": json.dumps(self.as_dict()), "scales": json.dumps(scales)}

    @classmethod
    def from_attributes(cls, attributes: Mapping[str, str]) -> Parameters:
        """Parameters from the attributes of a dataset that :meth:`attributes` has given.

        Raises
        ------
        InputError
            A value is not allowed.
        KeyError, TypeError, ValueError
            An attribute is missing, or is not such text.
        """
        numbers, scales = (json.loads(attributes[name]) for name in ("parameters", "scales"))
        return cls(**numbers, scales=Scales(**scales) if scales else None)


def _number(fields: Mapping[str, Field], name: str, given: object) -> float:
    """Check a number given in Python; text with units is refused here."""
    if isinstance(given, str):
        raise fields[name].error(given, "this is text, not a number")
    return read_quantity(fields[name], given)
