"""The machine in SI units, and the conversion to the dimensionless parameters and back."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from decimal import Context, Decimal, localcontext
from typing import Any, Self, cast

import pydantic

from carom.outcome import InputError, Problems, shown, together
from carom.parameters.fields import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, PHYSICAL_PARTNER, check_names, name_errors
from carom.parameters.numbers import CONVERSIONS
from carom.parameters.quantities import read_quantity
from carom.parameters.scaling import Parameters, Scales
from carom.parameters.toml_reader import read_machine_tables


class Machine(pydantic.BaseModel):
    """A rotor, its levitation and its touchdown bearing, in SI units.

    Every value is a number in the SI unit below, or text with a unit such as ``"1759 rpm"`` or ``"0.3 mm"``; a number
    in quotes without a unit is in the SI unit too. The ranges are those of
    :data:`carom.parameters.fields.MACHINE_FIELDS`. Instances are immutable and hashable.

    Parameters
    ----------
    mass : float or str
        Rotor mass m, kg.
    damping : float or str
        Damping c of the levitation, N s/m; not negative.
    stiffness : float or str
        Stiffness k of the levitation, N/m.
    eccentricity : float or str
        Distance e_c of the mass centre from the geometric centre, m.
    clearance : float or str
        Radius c_r of the circle in which the rotor centre is free to move, m.
    rotor_radius : float or str
        Radius R of the rotor where it touches, m.
    speed : float or str
        Rotational speed Ω, rad/s; text in rpm, rev/s, rad/s or deg/s.
    unbalance_phase : float or str
        Phase φ of the unbalance, rad.
    friction : float or str
        Coefficient μ of friction between rotor and touchdown bearing.
    restitution : float or str
        Coefficient d of restitution of the impacts, 0 to 1.

    Raises
    ------
    InputError
        If a field is missing, unknown, of another dimension, out of range, or if the machine as a whole has a
        dimensionless parameter out of range.  It reports all errors at once.
    """

    model_config = pydantic.ConfigDict(frozen=True, extra="forbid")

    mass: float
    damping: float
    stiffness: float
    eccentricity: float
    clearance: float
    rotor_radius: float
    speed: float
    unbalance_phase: float
    friction: float
    restitution: float

    def __init__(self, /, **values: Any) -> None:
        try:
            super().__init__(**values)
        except pydantic.ValidationError as problem:
            raise together(_input_errors(problem, values)) from None

    @pydantic.field_validator("*", mode="before")
    @classmethod
    def _read(cls, given: object, info: pydantic.ValidationInfo) -> float:
        return read_quantity(MACHINE_FIELDS[str(info.field_name)], given)

    @pydantic.model_validator(mode="after")
    def _check_parameters(self) -> Self:
        try:
            self.parameters  # noqa: B018
        except InputError as problem:
            physical = PHYSICAL_PARTNER[problem.field]
            definition = f"{problem.field} = {DIMENSIONLESS_FIELDS[problem.field].formula}"
            allowed = f"gives {definition} = {problem.value}, which {problem.allowed}"
            raise InputError(physical, getattr(self, physical), allowed) from None
        return self

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Machine:
        """Read the ``[machine]`` table of a TOML file.

        Parameters
        ----------
        path : path
            The machine file.

        Raises
        ------
        InputError
            If the file cannot be read, is not TOML, holds no ``[machine]`` table, or a value is not allowed.
        """
        problems = Problems()
        tables = read_machine_tables(path, problems)
        if tables.kind != "machine":
            remedy = "must hold a [machine] table; a [dimensionless] one has no mass, clearance and speed"
            raise InputError("machine file", shown(path), remedy)
        machine = problems.attempt(cls, **tables.values)
        problems.tell()
        return cast("Machine", machine)

    @classmethod
    def from_parameters(cls, parameters: Parameters, scales: Scales | None = None) -> Machine:
        """Return the machine that has the given dimensionless parameters.

        Parameters
        ----------
        parameters : Parameters
            The dimensionless numbers.
        scales : Scales, optional
            Mass, clearance and speed; those of `parameters` if left out.

        Returns
        -------
        Machine
            A machine whose own parameters equal the given ones exactly where doubles allow that, and to one unit in
            the last place otherwise. Of several such machines it is the one with the shortest decimal numbers, so a
            machine given by up to 15 significant digits is recovered exactly.

        Raises
        ------
        InputError
            If there are no scales, or a physical value (a negative damping, say) is not allowed.
        """
        scales = scales or parameters.scales
        if scales is None:
            raise InputError("scales", None, "these parameters have none: give mass, clearance and speed")
        values = {
            physical: _solved(name, getattr(parameters, name), scales) for name, physical in PHYSICAL_PARTNER.items()
        }
        return cls(**values, mass=scales.mass, clearance=scales.clearance, speed=scales.speed)

    @property
    def scales(self) -> Scales:
        """Mass, clearance and speed as units of everything else."""
        return Scales(self.mass, self.clearance, self.speed)

    @property
    def parameters(self) -> Parameters:
        """Dimensionless parameters of this machine, with its scales; (2.12) of the source paper."""
        scales = self.scales
        numbers = {
            name: CONVERSIONS[name].number(getattr(self, physical), scales)
            for name, physical in PHYSICAL_PARTNER.items()
        }
        return Parameters(**numbers, scales=scales)

    def replace(self, /, **changes: Any) -> Machine:
        """Return a copy with other values, physical or dimensionless.

        Parameters
        ----------
        **changes
            New values by the names of machine fields or of dimensionless parameters. Physical ones are set first;
            a dimensionless one then keeps mass, speed and clearance and sets its partner (``gamma`` sets
            ``damping``, ``omega`` ``stiffness``, ``rho`` ``eccentricity``, ...), as closely as doubles allow.

        Raises
        ------
        InputError
            If a name is unknown, a value not allowed, or a field is set in two ways.
        """
        check_names(changes)
        fields = {**self.model_dump(), **{name: changes[name] for name in changes if name in MACHINE_FIELDS}}
        machine = Machine(**fields)
        given = {name: changes[name] for name in changes if name in DIMENSIONLESS_FIELDS}
        solved = {}
        for name, value in given.items():
            number = read_quantity(DIMENSIONLESS_FIELDS[name], value)
            solved[PHYSICAL_PARTNER[name]] = _solved(name, number, machine.scales)
        try:
            return Machine(**{**machine.model_dump(), **solved})
        except InputError as problem:
            for name, value in given.items():
                if PHYSICAL_PARTNER[name] == problem.field:
                    advice = f"sets {problem.field} to {problem.value}, which {problem.allowed}"
                    raise InputError(name, shown(value), advice) from None
            raise

    def to_toml(self) -> str:
        """Return the text of a machine file that :meth:`load` reads back to an equal machine."""
        lines = ["[machine]"]
        for name, field in MACHINE_FIELDS.items():
            number = repr(getattr(self, name))
            value = f'"{number} {field.unit}"' if field.unit else number
            lines.append(f"{name} = {value}  # {field.symbol}: {field.words}")
        return "\n".join(lines) + "\n"


def _solved(name: str, number: float, scales: Scales) -> float:
    """Return the value, in SI units, of the partner of a dimensionless parameter that gives this number.

    Short decimals are tried first: rounding to 15 digits finds the value that a person wrote. The conversion rounds at
    most three times, so every double it maps to `number` lies within four units in the last place of the exact value.
    """
    conversion = CONVERSIONS[name]
    with localcontext(Context(prec=60)):
        exact = conversion.value(Decimal(number), scales)
        candidates = [float(f"{exact:.{digits - 1}e}") for digits in (15, 16, 17)]
    nearest = below = above = float(exact)
    candidates.append(nearest)
    for _ in range(4):
        below, above = math.nextafter(below, -math.inf), math.nextafter(above, math.inf)
        candidates += [below, above]
    candidates = [value for value in candidates if value >= 0 or exact < 0]
    return min(candidates, key=lambda value: abs(conversion.number(value, scales) - number))


def _input_errors(problem: pydantic.ValidationError, values: Mapping[str, Any]) -> list[InputError]:
    """All errors, those of names first: an unknown name is mostly a misspelt missing one."""
    found = name_errors(values, MACHINE_FIELDS, "[machine]")
    for error in problem.errors():
        cause = error.get("ctx", {}).get("error")
        if isinstance(cause, InputError):  # with the value as the user wrote it, including its unit
            found.append(InputError(cause.field, shown(values[cause.field]), cause.allowed))
    return found
