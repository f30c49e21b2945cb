"""Read a machine file, or another TOML file, into raw tables; other modules interpret them."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from carom.base.outcome import InputError, Problems, shown, together
from carom.parameters.fields import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, unknown_name
from carom.parameters.quantities import Written

_WHAT = "machine file"
_OPTIONAL = ("zones", "limits", "survive", "gravity", "touchdown", "drive")
_KINDS = ("machine", "dimensionless", "rotor")
_LISTS = ("section", "disc", "magnetic_bearing", "shared_controller", "support", "housing", "touchdown", "unbalance")
"""Tables of which a file with ``[rotor]`` holds one for each part."""
_RECOVERY = "recovery"
"""Table of which any file may hold several."""
_TABLES = dict.fromkeys((*_KINDS, *_OPTIONAL, *_LISTS, _RECOVERY))
_LARGEST_BYTES = 1_000_000
_REMEDY = "must hold a [machine], a [dimensionless] or a [rotor] table"
_MOST_LEVELS = 16
_DEEP = re.compile(r"""(?<![\w"'-])(?:(?:[\w"'-]++[ \t]*+\.[ \t]*+){16}|(?:[\w"'-]*+[ \t]*+=?[ \t]*+[\[{]){16})""")
"""Keys or brackets of more levels than machine files have: of dotted keys the parser takes quadratic memory."""
_PLACE = re.compile(r"\(at line ([0-9]+), ")


@dataclass(frozen=True)
class MachineTables:
    """Raw tables of a machine file."""

    kind: str
    """``"machine"``, ``"dimensionless"`` or ``"rotor"``: the table the file holds."""
    values: Mapping[str, object]
    """Entries of that table, as TOML gives them."""
    beside: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    """Entries of the optional tables that there are, by their names; an empty one may mean something too."""
    parts: Mapping[str, Sequence[Mapping[str, object]]] = field(default_factory=dict)
    """Tables for each part of a flexible rotor by their name, such as ``[[section]]``."""
    recoveries: Sequence[Mapping[str, object]] = ()
    """Tables ``[[recovery]]``."""
    folder: Path = Path()
    """Where the file lies: paths in it start there."""


def read_machine_tables(path: str | os.PathLike[str], problems: Problems) -> MachineTables:
    """Read the tables of a machine file: ``[machine]``, ``[dimensionless]`` or ``[rotor]``, and perhaps others.

    The entries are not checked.  Errors of other entries are added to ``problems``; if the file does not hold exactly one of these
    three tables, all of them are raised.
    """
    name, content = read_toml(path, _WHAT, _REMEDY)
    kinds = [kind for kind in _KINDS if kind in content]
    lists = (*_LISTS, _RECOVERY) if kinds == ["rotor"] else (_RECOVERY,)
    for key, value in content.items():
        if key not in _TABLES:
            problems.errors.append(_unknown_at_top(key, value))
        elif key in lists:
            if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
                allowed = f"must be tables that start with the line [[{key}]], one for each"
                problems.errors.append(InputError(key, shown(value), allowed))
        elif key in _LISTS and key not in _OPTIONAL:
            problems.errors.append(InputError(key, shown(value), "belongs to a file with a [rotor] table"))
        elif not isinstance(value, dict):
            allowed = f"must be a table that starts with the line [{key}], not a value"
            problems.errors.append(InputError(key, shown(value), allowed))
    if len(kinds) != 1 and not (problems.errors and not kinds):  # a misnamed table already explains the missing one
        found = "holds more" if kinds else "holds none"
        problems.errors.append(InputError(_WHAT, shown(name), f"{_REMEDY}, one of them alone; it {found}"))
    if len(kinds) != 1 or not isinstance(content[kinds[0]], dict):
        problems.raise_all()
    beside = {name: table for name in _OPTIONAL if isinstance(table := content.get(name), dict)}
    listed = {name: content[name] if isinstance(content.get(name), list) else [] for name in lists}
    parts = {name: [each for each in given if isinstance(each, dict)] for name, given in listed.items()}
    recoveries = parts.pop(_RECOVERY)
    return MachineTables(kinds[0], content[kinds[0]], beside, parts, recoveries, Path(name).parent)


def read_toml(path: object, what: str, remedy: str) -> tuple[str, dict[str, Any]]:
    """Read a TOML file; return its path as text, and its content.

    Errors call the file ``what``, such as ``"machine file"``.  For a file that is empty or far too long they say what it must hold,
    ``remedy``.
    """
    name = os.fspath(path) if isinstance(path, str | os.PathLike) else None
    if not isinstance(name, str) or not name:
        raise InputError(what, shown(path), "must be the path of a TOML file")
    return name, _parse(name, _read(name, what, remedy), what, remedy)


def _read(name: str, what: str, remedy: str) -> str:
    try:
        with Path(name).open("rb") as stream:
            data = stream.read(_LARGEST_BYTES + 1)
    except FileNotFoundError:
        raise InputError(what, shown(name), "there is no such file; give the path of a TOML file") from None
    except (OSError, ValueError) as problem:
        reason = str(getattr(problem, "strerror", None) or problem).lower()
        raise InputError(what, shown(name), f"cannot be read ({reason}); give the path of a TOML file") from None
    if len(data) > _LARGEST_BYTES:
        raise InputError(what, shown(name), f"{remedy}, in less than {_LARGEST_BYTES} bytes")
    try:
        return data.decode("utf-8-sig")  # some editors put a byte-order mark in front
    except UnicodeDecodeError as problem:
        line = data[: problem.start].count(b"\n") + 1
        raise InputError(what, shown(name), f"must be text in UTF-8; line {line} is not") from None


def _parse(name: str, text: str, what: str, remedy: str) -> dict[str, object]:
    if not text.strip():
        raise InputError(what, shown(name), f"{remedy}; it is empty")
    if deep := _DEEP.search(text):
        line = text.count("\n", 0, deep.start()) + 1
        words = f"must be valid TOML of at most {_MOST_LEVELS} levels; line {line} is nested too deeply"
        raise InputError(what, shown(name), words)
    try:
        return tomllib.loads(text, parse_float=Written)
    except tomllib.TOMLDecodeError as problem:
        advice = str(problem)
        place = _PLACE.search(advice)
        bare = list(_bare_texts(text, name))
        if place and int(place[1]) in (line for line, _ in bare):
            raise together([error for _, error in bare]) from None
        if advice.startswith("Cannot overwrite a value"):
            advice += ": the same key is given twice"
        raise InputError(what, shown(name), f"must be valid TOML; {advice}") from None
    except (RecursionError, ValueError):
        words = "must be valid TOML; it is nested too deeply, or a number in it has thousands of digits"
        raise InputError(what, shown(name), words) from None


def _bare_texts(text: str, name: str) -> Iterator[tuple[int, InputError]]:
    """Lines ``key = value`` whose value would be text if it stood in quotes, such as ``mass = 50 kg``."""
    for number, line in enumerate(text.split("\n"), start=1):
        key, equals, value = (part.strip() for part in line.partition("#")[0].partition("="))
        if not equals or not key or not value or not set(value).isdisjoint("\"'[]{}=\\"):
            continue
        try:
            tomllib.loads(f"x = {value}")
        except ValueError:
            allowed = (
                f'must stand in quotes if it is text or has a unit: {key} = "{value}" (line {number} of {shown(name)})'
            )
            yield number, InputError(key, value, allowed)


def _unknown_at_top(key: str, value: object) -> InputError:
    for table, fields in (("machine", MACHINE_FIELDS), ("dimensionless", DIMENSIONLESS_FIELDS)):
        if key in fields:
            return InputError(key, shown(value), f"belongs below a line [{table}]")
    return unknown_name(key, value, _TABLES, "the file")
