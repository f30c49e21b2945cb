"""The axes of a sweep: the values of one parameter, given by a range or one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from numbers import Integral
from typing import Any, Literal, cast

import numpy as np

from carom.outcome import InputError, Problems, shown
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, Field, read_quantity, unknown_name

LONGEST_AXIS = 1_000_000
PARAMETERS = {**DIMENSIONLESS_FIELDS, **MACHINE_FIELDS}
"""All parameters that an axis can vary."""

Spacing = Literal["linear", "log", "list"]


@dataclass(frozen=True)
class GridAxis:
    """Values of one parameter; see :meth:`between` and :meth:`of`.

    Attributes
    ----------
    name : str
        A field of a machine, or a dimensionless parameter.
    spacing : {"linear", "log", "list"}
    given : tuple of float
        First and last value, or all values of a list; in SI units or dimensionless.
    count : int
    """

    name: str
    spacing: Spacing
    given: tuple[float, ...]
    count: int

    @classmethod
    def between(
        cls, name: str, low: float | str, high: float | str, count: int, spacing: Literal["linear", "log"] = "linear"
    ) -> GridAxis:
        """Evenly spaced values of a parameter, ends included.

        Parameters
        ----------
        low, high : float or str
            First and last value: numbers, in SI units if the parameter is physical, or texts with a unit.
        spacing : {"linear", "log"}

        Raises
        ------
        InputError
            No such parameter, or an end, a count or a spacing that cannot be used.
        """
        where, problems = f"axes.{name}", Problems()
        field = _field(name)
        ends = [problems.attempt(_number, f"{where}.{key}", field, end) for key, end in (("from", low), ("to", high))]
        if not (isinstance(count, Integral) and 2 <= count <= LONGEST_AXIS):
            allowed = f"must be a whole number from 2 to {LONGEST_AXIS}: how many values"
            problems.errors.append(InputError(f"{where}.count", shown(count), allowed))
        problems.tell()
        first, last = cast("list[float]", ends)
        if first == last:
            raise InputError(f"{where}.to", shown(high), "must be another value than from")
        if spacing not in ("linear", "log"):
            raise InputError(f"{where}.spacing", shown(spacing), 'must be "linear" or "log"')
        if spacing == "log" and not (first > 0 and last > 0):
            raise InputError(f"{where}.spacing", "log", "needs ends above 0")
        return cls(name, spacing, (first, last), int(count))

    @classmethod
    def of(cls, name: str, values: Sequence[float | str]) -> GridAxis:
        """Values of a parameter one by one: numbers, in SI units if it is physical, or texts with a unit.

        Raises
        ------
        InputError
            No such parameter, no value, or values that are the same or cannot be used.
        """
        where, field, problems = f"axes.{name}.values", _field(name), Problems()
        numbers = [problems.attempt(_number, where, field, value) for value in values]
        problems.tell()
        if not 0 < len(set(numbers)) == len(numbers) <= LONGEST_AXIS:
            raise InputError(where, shown(list(values)), f"must be different values, 1 to {LONGEST_AXIS} of them")
        return cls(name, "list", tuple(cast("list[float]", numbers)), len(numbers))

    @cached_property
    def values(self) -> np.ndarray:
        """All values, shape (count,)."""
        if self.spacing == "list":
            return np.array(self.given)
        low, high = self.given
        return (np.linspace if self.spacing == "linear" else np.geomspace)(low, high, self.count)

    @property
    def field(self) -> Field:
        """Words, symbol and unit of the parameter."""
        return PARAMETERS[self.name]

    def describe(self) -> dict[str, Any]:
        """Return what identifies the axis, as plain data for JSON."""
        return {"name": self.name, "spacing": self.spacing, "values": list(self.given), "count": self.count}


def _field(name: str) -> Field:
    if name not in PARAMETERS:
        raise unknown_name(name, "to vary", PARAMETERS, "the parameters")
    return PARAMETERS[name]


def _number(where: str, field: Field, given: object) -> float:
    try:
        return read_quantity(field, given)
    except InputError as problem:
        raise InputError(where, problem.value, problem.allowed) from None
