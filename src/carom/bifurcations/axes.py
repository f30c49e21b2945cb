"""Parameters to vary: dimensionless ones, and physical ones that move several of them at once."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from carom.outcome import InputError
from carom.parameters import (
    DIMENSIONLESS_FIELDS,
    MACHINE_FIELDS,
    Field,
    Parameters,
    Scales,
    read_quantity,
    unknown_name,
)

Ends = tuple[float | str, float | str]
"""Both ends of a range: numbers, in SI units if the parameter is physical, or text such as ``"300 N s/m"``."""
_FIELDS = {**DIMENSIONLESS_FIELDS, **MACHINE_FIELDS}


class Numbers(NamedTuple):
    """Parameters as plain unchecked numbers, for residuals that are evaluated thousands of times.

    ``mass``, ``clearance`` and ``speed`` are ``nan`` where they are not known.
    """

    gamma: float
    omega: float
    rho: float
    phi: float
    mu: float
    d: float
    radius_ratio: float
    mass: float
    clearance: float
    speed: float

    @classmethod
    def of(cls, parameters: Parameters) -> Numbers:
        """Read the numbers of some parameters."""
        scales = parameters.scales
        known = (math.nan,) * 3 if scales is None else (scales.mass, scales.clearance, scales.speed)
        return cls(**parameters.as_dict(), **dict(zip(("mass", "clearance", "speed"), known, strict=True)))

    @property
    def parameters(self) -> Parameters:
        """Checked parameters.

        Raises
        ------
        InputError
            A number out of its range.
        """
        scales = None if math.isnan(self.mass) else Scales(self.mass, self.clearance, self.speed)
        return Parameters(*self[:7], scales=scales)


@dataclass(frozen=True)
class Axis:
    """A parameter to vary.

    Attributes
    ----------
    name : str
    get : callable
        Returns its value, in SI units if it is physical.
    set : callable
        Returns numbers with another value of it; numbers that depend on it change too.  It is an analytic function.
    """

    name: str
    get: Callable[[Numbers], float]
    set: Callable[[Numbers, float], Numbers]

    @property
    def field(self) -> Field:
        """Words, symbol, unit and range of the parameter."""
        return _FIELDS[self.name]


def axis(parameters: Parameters, name: str) -> Axis:
    """Parameter of this name.

    A physical one changes all numbers that depend on it: the shaft speed ``Ω`` changes ``γ = c/(mΩ)`` and
    ``ω = √(k/m)/Ω`` together, while ``ρ`` stays the same.

    Raises
    ------
    InputError
        No such name, or a physical one without scales.
    """
    if name not in _AXES:
        raise unknown_name(name, "to vary", _FIELDS, "the parameters")
    if name in MACHINE_FIELDS and parameters.scales is None:
        raise InputError(
            name,
            "to vary",
            f"only dimensionless parameters can be varied here ({', '.join(DIMENSIONLESS_FIELDS)}), as "
            "mass, clearance and speed are not known",
        )
    return _AXES[name]


def vary(parameters: Parameters, name: str, value: float) -> Parameters:
    """Return the parameters with one of them, dimensionless or physical (SI), set to a value.

    Raises
    ------
    InputError
        No such name, a physical one without scales, or a value out of range.
    """
    return axis(parameters, name).set(Numbers.of(parameters), float(value)).parameters


def value_of(parameters: Parameters, name: str) -> float:
    """Present value of a parameter, in SI units if it is a physical one."""
    return axis(parameters, name).get(Numbers.of(parameters))


def value_in(numbers: Numbers, name: str) -> float:
    """Value of a parameter; ``nan`` for a physical one where mass, clearance or speed is not known."""
    return _AXES[name].get(numbers)


def read_interval(name: str, given: Ends) -> tuple[float, float]:
    """Read a range of a parameter.

    Raises
    ------
    InputError
        No such parameter, a value that it cannot have, or a range that is empty.
    """
    if name not in _FIELDS:
        raise unknown_name(name, "to vary", _FIELDS, "the parameters")
    low, high = (read_quantity(_FIELDS[name], end) for end in given)
    if not low < high:
        raise InputError(name, f"{low:g} to {high:g}", "a range of two finite values in ascending order")
    return low, high


def interval_around(along: Axis, numbers: Numbers, given: Ends) -> tuple[float, tuple[float, float]]:
    """Present value of a parameter, and a range that must hold it, by rounding at least.

    Raises
    ------
    InputError
        The range cannot be read or does not hold the value.
    """
    low, high = read_interval(along.name, given)
    value = along.get(numbers)
    nearest = min(max(value, low), high)
    if not abs(value - nearest) <= 1e-12 * max(abs(low), abs(high)):
        raise InputError(
            along.name, f"{low:g} to {high:g}", f"an interval that holds the motion's own value {value:.6g}"
        )
    return nearest, (low, high)


def _with_speed(numbers: Numbers, speed: float) -> Numbers:
    ratio = numbers.speed / speed
    return numbers._replace(gamma=numbers.gamma * ratio, omega=numbers.omega * ratio, speed=speed)


def _with_mass(numbers: Numbers, mass: float) -> Numbers:
    ratio = numbers.mass / mass
    return numbers._replace(gamma=numbers.gamma * ratio, omega=numbers.omega * _root(ratio), mass=mass)


def _with_clearance(numbers: Numbers, clearance: float) -> Numbers:
    ratio = numbers.clearance / clearance
    return numbers._replace(rho=numbers.rho * ratio, radius_ratio=numbers.radius_ratio * ratio, clearance=clearance)


def _root(value: complex) -> Any:
    """Square root, ``nan`` for negative numbers; complex ones have a tiny imaginary part, for derivatives."""
    return value**0.5 if value.real >= 0.0 else math.nan


def _plain(name: str, field: str) -> Axis:
    place = Numbers._fields.index(field)

    def change(numbers: Numbers, value: float) -> Numbers:
        return Numbers._make((*numbers[:place], value, *numbers[place + 1 :]))

    return Axis(name, lambda numbers: numbers[place], change)


_AXES: dict[str, Axis] = {
    **{name: _plain(name, name) for name in DIMENSIONLESS_FIELDS},
    "unbalance_phase": _plain("unbalance_phase", "phi"),
    "friction": _plain("friction", "mu"),
    "restitution": _plain("restitution", "d"),
    "speed": Axis("speed", lambda numbers: numbers.speed, _with_speed),
    "mass": Axis("mass", lambda numbers: numbers.mass, _with_mass),
    "clearance": Axis("clearance", lambda numbers: numbers.clearance, _with_clearance),
    "damping": Axis(
        "damping",
        lambda n: n.gamma * n.mass * n.speed,
        lambda n, value: n._replace(gamma=value / (n.mass * n.speed)),
    ),
    "stiffness": Axis(
        "stiffness",
        lambda n: n.omega**2 * n.mass * n.speed**2,
        lambda n, value: n._replace(omega=_root(value / n.mass) / n.speed),
    ),
    "eccentricity": Axis(
        "eccentricity", lambda n: n.rho * n.clearance, lambda n, value: n._replace(rho=value / n.clearance)
    ),
    "rotor_radius": Axis(
        "rotor_radius",
        lambda n: n.radius_ratio * n.clearance,
        lambda n, value: n._replace(radius_ratio=value / n.clearance),
    ),
}
