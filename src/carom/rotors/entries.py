"""Reading of the numbers of a part: in SI units, or as text with a unit."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from carom.outcome import InputError, Problems, shown
from carom.parameters import Field, read_quantity


def read_entries(part: Any, fields: Mapping[str, Field]) -> None:
    """Set the attributes of a frozen part to the numbers that were given for them; all that cannot be used are reported together.

    One that is ``None`` by default may be left out.
    """
    problems, optional = Problems(), {each.name for each in dataclasses.fields(part) if each.default is None}
    for name, field in fields.items():
        given = getattr(part, name)
        if given is not None:
            object.__setattr__(part, name, problems.attempt(read_quantity, field, given))
        elif name not in optional:
            problems.errors.append(InputError(name, None, field.allowed))
    problems.raise_all()


def read_node(name: str, given: Any) -> int:
    """The number of a node; whether the shaft has it is seen where both meet."""
    if isinstance(given, bool) or not hasattr(given, "__index__") or given.__index__() < 0:
        raise InputError(name, shown(given), "the number of a node: a whole number of at least 0")
    return int(given.__index__())


def inertia_field(name: str, symbol: str, words: str, example: str, zero: bool = True) -> Field:
    """A moment of inertia."""
    return Field(name, symbol, words, "a moment of inertia", "kg m^2", 1e-15, 1e9, example, zero)
