"""The dimensionless parameters, checked and as plain numbers, and what each parameter moves."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple, cast

from carom.base.arguments import checked, having
from carom.base.outcome import InputError, shown
from carom.parameters.fields import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, PARAMETERS, PHYSICAL_PARTNER, Field
from carom.parameters.formats import format_entry
from carom.parameters.quantities import read_quantity
from carom.parameters.scaling import CONVERSIONS, Scales, Units, plain_number, root
from carom.parameters.terms import no_such_parameter

# Smallest |omega² - 1 + i gamma|, by which the unbalance is divided to get the contact-free equilibrium: below it
# the equilibrium lies so far out that rounding leaves no digits for positions inside the clearance.
_RESONANCE = 1e-9


_STEP = 1e-30
"""Its square is far below the rounding error of any parameter."""


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

    finite_elements: ClassVar[None] = None

    def __post_init__(self) -> None:
        for name in DIMENSIONLESS_FIELDS:
            object.__setattr__(self, name, plain_number(DIMENSIONLESS_FIELDS, name, getattr(self, name)))
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
            raise no_such_parameter(name, None, self.varied, self.scales is not None)
        return Numbers.of(self).value(name)

    @property
    def words(self) -> str:
        """In a line: what a machine has in SI units, or the dimensionless numbers."""
        names = DIMENSIONLESS_FIELDS if self.scales is None else MACHINE_FIELDS
        return ", ".join(f"{PARAMETERS[name].symbol} {format_entry(name, self.value(name))}" for name in names)

    def as_dict(self) -> dict[str, float]:
        """Return the seven numbers by name, without the scales."""
        return {name: getattr(self, name) for name in DIMENSIONLESS_FIELDS}

    def attributes(self) -> dict[str, str]:
        """Return the numbers and the scales as attributes of a dataset, exact to the last bit."""
        scales = dataclasses.asdict(self.scales) if self.scales else None
        return {"parameters": json.dumps(self.as_dict()), "scales": json.dumps(scales)}

    @classmethod
    @checked
    def from_attributes(cls, attributes: Annotated[Mapping[str, object], having("parameters", "scales")]) -> Parameters:
        """Parameters from the attributes of a dataset that :meth:`attributes` has given.

        Raises
        ------
        InputError
            A value is not allowed.
        KeyError, TypeError, ValueError
            An attribute is missing, or is not such text.
        """
        numbers, scales = (json.loads(str(attributes[name])) for name in ("parameters", "scales"))
        return cls(**numbers, scales=Scales(**scales) if scales else None)


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
    @checked
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
        return Parameters(*self[:7], scales=None if self.units is None else Scales(*self.units))

    def value(self, name: str) -> float:
        """Value of a parameter, in SI units if it is a physical one; those need units."""
        number = _NUMBER_OF.get(name)
        value: float = getattr(self.units if name in Units._fields else self, number or name)
        return value if number is None else CONVERSIONS[number].value(value, cast("Units", self.units))

    def moved(self, name: str, value: float) -> Numbers:
        """Numbers with another value of one parameter; an analytic function of it.

        A dimensionless parameter moves alone.  A physical one, in SI units, moves whatever depends on it while the
        other physical ones stay: the shaft speed ``Ω`` moves ``γ = c/(mΩ)`` and ``ω = √(k/m)/Ω``, and not ``ρ``.
        """
        units = cast("Units", self.units)
        moved: dict[str, Any] = {name: value}
        if number := _NUMBER_OF.get(name):
            moved = {number: CONVERSIONS[number].number(value, units)}
        elif name in Units._fields:
            ratio = getattr(units, name) / value
            factors = dict.fromkeys(_FOLLOWING[name], ratio)
            if name == "mass":
                factors["omega"] = root(ratio)
            moved = {number: getattr(self, number) * factor for number, factor in factors.items()}
            moved["units"] = units._replace(**{name: value})
        return self._replace(**moved)

    def rates(self, name: str) -> list[float]:
        """Derivatives of the seven numbers by a parameter: imaginary parts after a tiny imaginary step, exact but for rounding."""
        if name in self._fields:  # it moves alone
            return [float(name == field) for field in self._fields[:7]]
        moved = self.moved(name, complex(self.value(name), _STEP))  # type: ignore[arg-type]
        return [complex(number).imag / _STEP for number in moved[:7]]


_NUMBER_OF = {partner: name for name, partner in PHYSICAL_PARTNER.items()}
_FOLLOWING = {"speed": ("gamma", "omega"), "mass": ("gamma", "omega"), "clearance": ("rho", "radius_ratio")}
"""Numbers that change with each of the units: as its reciprocal does, only the frequency as the root of that of the mass."""


def own_numbers(numbers: Any) -> dict[str, float]:
    """Return the dimensionless numbers of a planar rotor, or of a model, by name; those that differ between the planes of a rotor for each plane."""
    found: dict[str, float] = {}
    for name in DIMENSIONLESS_FIELDS:
        try:
            found[name] = numbers.value(name)
        except InputError:
            at_planes = [each for each in numbers.varied if each.startswith(f"{name}_")]
            found |= {each: numbers.value(each) for each in at_planes}
    return found
