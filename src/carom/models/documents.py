"""A rotor as plain data, exact to the last bit, and back: its definition, forces, limits and stages with all their parts."""

from __future__ import annotations

import dataclasses
from importlib import import_module
from typing import Any

import numpy as np

from carom.core.laws.law import Law, law_of_name
from carom.models.definition import Definition

_KIND = "kind"
"""Entry that names the class of a part."""
_COMPLEX, _LAW = "complex", "law "
_PACKAGES = ("carom.parameters", "carom.models", "carom.rotors")
"""Whose classes rotors are made of; a file can name no others."""


def document_of(part: Any) -> object:
    """A rotor or a part of it as numbers, texts, lists and dictionaries; a controller of another library as its matrices.

    Of a class that is in none of the packages, a definition is written by its equations of motion.
    """
    if isinstance(part, Definition) and _class_of(type(part).__name__) is not type(part):
        part = part.equations
    if dataclasses.is_dataclass(part) or hasattr(part, "_fields"):
        kind = f"{_LAW}{part.law}" if isinstance(part, Law) else type(part).__name__
        names = getattr(part, "_fields", None) or [field.name for field in dataclasses.fields(part)]
        return {_KIND: kind, **{name: document_of(getattr(part, name)) for name in getattr(part, "stored", names)}}
    if isinstance(part, tuple | list) and not any(isinstance(each, complex) for each in part):
        return [document_of(each) for each in part]
    if np.iscomplexobj(part):
        values = np.asarray(part)
        return {_KIND: _COMPLEX, "real": values.real.tolist(), "imag": values.imag.tolist()}
    if isinstance(part, np.ndarray | np.generic):
        return part.tolist()
    if part is None or isinstance(part, bool | int | float | str):
        return part
    return document_of(import_module("carom.rotors.controllers").state_space_of(part))


def part_from(given: object) -> object:
    """The rotor, or the part of one, of which :func:`document_of` has made these data."""
    if isinstance(given, list):
        return tuple(map(part_from, given))
    if not isinstance(given, dict):
        return given
    kind, own = given[_KIND], {name: part_from(value) for name, value in given.items() if name != _KIND}
    if kind == _COMPLEX:
        return np.array(own["real"]) + 1j * np.array(own["imag"])
    made = law_of_name(kind.removeprefix(_LAW)) if kind.startswith(_LAW) else _class_of(kind)
    if made is None:
        raise ValueError(f"no part of a rotor is a {kind}")
    return getattr(made, "from_stored", made)(**own)


def _class_of(kind: str) -> type | None:
    classes = (getattr(import_module(package), kind, None) for package in _PACKAGES)
    return next((each for each in classes if isinstance(each, type)), None)
