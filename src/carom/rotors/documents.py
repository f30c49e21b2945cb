"""A flexible machine as plain data, exact to the last bit, and back."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from carom.rotors.controllers import state_space_of

_KIND = "kind"
"""Entry that names the class of a part."""


def document_of(part: Any) -> Any:
    """A machine or a part of it as numbers, texts, lists and dictionaries; a controller of another library as its matrices."""
    if dataclasses.is_dataclass(part):
        fields = {field.name: document_of(getattr(part, field.name)) for field in dataclasses.fields(part)}
        return {_KIND: type(part).__name__, **fields}
    if isinstance(part, np.ndarray):
        return part.tolist()
    if isinstance(part, tuple | list):
        return [document_of(each) for each in part]
    if part is None or isinstance(part, bool | int | float | str):
        return part
    if isinstance(part, np.generic):
        return part.item()
    return document_of(state_space_of(part))


def part_from(given: Any) -> Any:
    """The machine, or the part of one, of which :func:`document_of` has made these data."""
    if isinstance(given, list):
        return [part_from(each) for each in given]
    if not isinstance(given, dict):
        return given
    from carom import parameters, rotors  # the machine itself is made of these parts

    kind = given[_KIND]
    made = getattr(rotors if hasattr(rotors, kind) else parameters, kind)
    return made(**{name: part_from(value) for name, value in given.items() if name != _KIND})
