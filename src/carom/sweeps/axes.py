"""The axes of a sweep: the values of one parameter, given by a range or one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Literal, cast

import numpy as np

from carom.base.arguments import checked, whole
from carom.base.outcome import InputError, Problems, shown
from carom.parameters import SETTINGS, Field, field_to_set, read_quantity

if TYPE_CHECKING:
    from carom.models import Axis

LONGEST_AXIS = 1_000_000
AxisCount = Annotated[int, whole(2, LONGEST_AXIS)]

Spacing = Literal["linear", "log", "list"]


@dataclass(frozen=True)
class GridAxis:
    """Values of one parameter in a sweep.

    :meth:`between` makes them from two ends, :meth:`of` from a list.

    Attributes
    ----------
    name : str
        A field of a machine or a term that stands for one, a dimensionless parameter, or a parameter of another model.
    spacing : {"linear", "log", "list"}
    given : tuple of float
        First and last value, or all values of a list; in SI units or dimensionless.
    count : int
    own : Field, optional
        Field of the parameter, which the name alone does not give for an :class:`~carom.models.Axis`.
    """

    name: str
    spacing: Spacing
    given: tuple[float, ...]
    count: int
    own: Field | None = None

    @classmethod
    @checked
    def between(
        cls,
        parameter: str | Axis,
        low: object,
        high: object,
        count: AxisCount,
        spacing: Literal["linear", "log"] = "linear",
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
        field, problems = _field(parameter), Problems()
        where = f"axes.{field.name}"
        ends = [problems.attempt(_number, f"{where}.{key}", field, end) for key, end in (("from", low), ("to", high))]
        problems.raise_all()
        first, last = cast("list[float]", ends)
        if first == last:
            raise InputError(f"{where}.to", shown(high), "must be another value than from")
        if spacing == "log" and not (first > 0 and last > 0):
            raise InputError(f"{where}.spacing", "log", "needs ends above 0")
        return cls(field.name, spacing, (first, last), count, field)

    @classmethod
    @checked
    def of(cls, parameter: str | Axis, values: Sequence[object]) -> GridAxis:
        """Values of a parameter one by one: numbers, in SI units if it is physical, or texts with a unit.

        Raises
        ------
        InputError
            No such parameter, no value, or values that are the same or cannot be used.
        """
        field, problems = _field(parameter), Problems()
        where = f"axes.{field.name}.values"
        numbers = [problems.attempt(_number, where, field, value) for value in values]
        problems.raise_all()
        if not 0 < len(set(numbers)) == len(numbers) <= LONGEST_AXIS:
            raise InputError(where, shown(list(values)), f"must be different values, 1 to {LONGEST_AXIS} of them")
        return cls(field.name, "list", tuple(cast("list[float]", numbers)), len(numbers), field)

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
        return self.own or SETTINGS[self.name]

    def describe(self) -> dict[str, object]:
        """Return what identifies the axis, as plain data for JSON."""
        return {"name": self.name, "spacing": self.spacing, "values": list(self.given), "count": self.count}


def _field(parameter: str | Axis) -> Field:
    return field_to_set(parameter) if isinstance(parameter, str) else parameter.field


def _number(where: str, field: Field, given: object) -> float:
    try:
        return read_quantity(field, given)
    except InputError as problem:
        raise InputError(where, problem.value, problem.allowed) from None
