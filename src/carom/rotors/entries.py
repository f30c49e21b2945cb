"""Entries of parts of a rotor: nodes and inertias."""

from __future__ import annotations

from carom.base.outcome import InputError, shown
from carom.parameters import Field


def read_node(name: str, given: object) -> int:
    """The number of a node; whether the shaft has it is seen where both meet."""
    if isinstance(given, bool) or not hasattr(given, "__index__") or given.__index__() < 0:
        raise InputError(name, shown(given), "the number of a node: a whole number of at least 0")
    return int(given.__index__())


def inertia_field(name: str, symbol: str, words: str, example: str, zero: bool = True) -> Field:
    """A moment of inertia."""
    return Field(name, symbol, words, "a moment of inertia", "kg m^2", 1e-15, 1e9, example, zero)
