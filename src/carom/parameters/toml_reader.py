"""The text of a machine file, or of another TOML file, up to its tables; what they mean is read elsewhere."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from carom.outcome import InputError
from carom.parameters.fields import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, shown, unknown_name

__all__ = ["MachineTables", "read_machine_tables", "read_toml"]

_WHAT = "machine file"
_TABLES = {"machine": None, "dimensionless": None, "zones": None}
_LARGEST_BYTES = 1_000_000
_REMEDY = "must hold a [machine] or a [dimensionless] table"


@dataclass(frozen=True)
class MachineTables:
    """Raw tables of a machine file.

    Parameters
    ----------
    kind : str
        ``"machine"`` or ``"dimensionless"``: the table the file holds.
    values : mapping
        Entries of that table, as TOML gives them.
    zones : mapping
        Entries of the optional table ``[zones]``.
    """

    kind: str
    values: Mapping[str, Any]
    zones: Mapping[str, Any] = field(default_factory=dict)


def read_machine_tables(path: str | os.PathLike[str]) -> MachineTables:
    """Read the tables of a machine file.

    Parameters
    ----------
    path : path
        A TOML file with either a ``[machine]`` or a ``[dimensionless]`` table, and perhaps ``[zones]``.

    Returns
    -------
    MachineTables
        The entries, not yet looked at.

    Raises
    ------
    InputError
        If the file cannot be read, is not TOML, or does not hold exactly one of the two tables.
    """
    name, content = read_toml(path, _WHAT, _REMEDY)
    for key, value in content.items():
        if key not in _TABLES:
            raise _unknown_at_top(key, value)
        if not isinstance(value, dict):
            raise InputError(key, shown(value), f"must be a table that starts with the line [{key}], not a value")
    kinds = [kind for kind in ("machine", "dimensionless") if kind in content]
    if len(kinds) != 1:
        found = "holds both" if kinds else "holds neither"
        raise InputError(_WHAT, shown(name), f"{_REMEDY}, one of them alone; it {found}")
    return MachineTables(kinds[0], content[kinds[0]], content.get("zones", {}))


def read_toml(path: str | os.PathLike[str], what: str, remedy: str) -> tuple[str, dict[str, Any]]:
    """Read a TOML file.

    Parameters
    ----------
    path : path
    what : str
        What the file is called in errors, such as ``"machine file"``.
    remedy : str
        What it must hold, for the errors of a file that is empty or far too long.

    Returns
    -------
    name : str
        The path as text.
    content : dict

    Raises
    ------
    InputError
        If the file cannot be read or is not TOML.
    """
    name = _path_text(path, what)
    return name, _parse(name, _read(name, what, remedy), what, remedy)


def _path_text(path: str | os.PathLike[str], what: str) -> str:
    try:
        text = os.fspath(path)
    except TypeError:
        text = None
    if not isinstance(text, str) or not text:
        raise InputError(what, shown(path), "must be the path of a TOML file")
    return text


def _read(name: str, what: str, remedy: str) -> str:
    try:
        with Path(name).open("rb") as stream:
            data = stream.read(_LARGEST_BYTES + 1)
    except FileNotFoundError:
        raise InputError(what, shown(name), "there is no such file; give the path of a TOML file") from None
    except IsADirectoryError:
        raise InputError(what, shown(name), "this is a directory; give the path of a TOML file") from None
    except PermissionError:
        raise InputError(what, shown(name), "you have no permission to read it; allow it or copy the file") from None
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or problem
        raise InputError(what, shown(name), f"cannot be read ({reason}); give the path of a TOML file") from None
    if len(data) > _LARGEST_BYTES:
        raise InputError(what, shown(name), f"{remedy}, in less than {_LARGEST_BYTES} bytes")
    try:
        return data.decode("utf-8-sig")  # some editors put a byte-order mark in front
    except UnicodeDecodeError as problem:
        line = data[: problem.start].count(b"\n") + 1
        raise InputError(what, shown(name), f"must be text in UTF-8; line {line} is not") from None


def _parse(name: str, text: str, what: str, remedy: str) -> dict[str, Any]:
    if not text.strip():
        raise InputError(what, shown(name), f"{remedy}; it is empty")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InputError(what, shown(name), "must be valid TOML; it is nested too deeply") from None
    except ValueError as problem:
        advice = str(problem)
        if advice.startswith("Cannot overwrite a value"):
            advice += ": the same key is given twice"
        raise InputError(what, shown(name), f"must be valid TOML; {advice}") from None


def _unknown_at_top(key: str, value: object) -> InputError:
    for table, fields in (("machine", MACHINE_FIELDS), ("dimensionless", DIMENSIONLESS_FIELDS)):
        if key in fields:
            return InputError(key, shown(value), f"belongs below a line [{table}]")
    return unknown_name(key, value, _TABLES, "the file")
