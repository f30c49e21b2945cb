"""The sweep file: TOML text to a plan, with errors of one line."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Literal

import pydantic

from carom.disturbances import MODELS
from carom.outcome import InputError
from carom.parameters import (
    DIMENSIONLESS_FIELDS,
    MACHINE_FIELDS,
    Case,
    Field,
    Scales,
    load_case,
    read_quantity,
    unknown_name,
)
from carom.parameters.fields import shown
from carom.parameters.machine import check_names
from carom.parameters.toml_reader import read_toml
from carom.sweeps.basins import BasinsTask
from carom.sweeps.plan import GridAxis, SweepPlan, Task, cut
from carom.sweeps.studies import StudyTask

__all__ = ["load_sweep"]

_WHAT = "sweep file"
_REMEDY = 'must hold machine = "...", a table [axes.NAME] for each axis, and a [study] or a [basins] table'
_LONGEST_AXIS = 1_000_000
_MOST_STARTS = 10**12
_GRAVITY = " standard_gravity"
_SIZES: Mapping[str, tuple[str, str, str]] = {
    "velocity": ("m/s", "a velocity", "0.3 m/s"),
    "acceleration": ("m/s^2", "an acceleration", "20 g"),
    "time": ("s", "a time", "11 ms"),
    "length": ("m", "a length", "0.2 mm"),
}


class _Table(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(frozen=True, extra="forbid", strict=True)


_Value = float | int | str


class _Axis(_Table):
    start: _Value | None = pydantic.Field(None, alias="from")
    end: _Value | None = pydantic.Field(None, alias="to")
    count: int | None = pydantic.Field(None, ge=2, le=_LONGEST_AXIS)
    spacing: Literal["linear", "log"] | None = None
    values: list[_Value] | None = pydantic.Field(None, min_length=1, max_length=_LONGEST_AXIS)


class _Study(_Table):
    disturbances: int = pydantic.Field(0, ge=0, le=1_000_000)
    least_damping: bool = False


class _Basins(_Table):
    starts: int = pydantic.Field(ge=1, le=_MOST_STARTS)
    disturbance: dict[str, Any]


class _SweepFile(_Table):
    machine: str
    settings: list[str] = pydantic.Field([], alias="set")
    seed: int = pydantic.Field(0, ge=0, lt=2**63)
    chunk: int | None = pydantic.Field(None, ge=1)
    axes: dict[str, _Axis] = pydantic.Field(min_length=1)
    study: _Study | None = None
    basins: _Basins | None = None


_ALLOWED = {
    "machine": 'must be the path of a machine file, from the folder of the sweep file, such as "keogh-cole.toml"',
    "set": 'must be a list of settings, such as ["friction=0.2"]',
    "seed": "must be a whole number from 0 to 2^63 - 1",
    "chunk": "must be a whole number of at least 1: points of the grid that are computed and stored together",
    "axes": "must be tables [axes.NAME], one for each parameter to vary",
    "from": "must be the first value, a number or text with a unit",
    "to": "must be the last value, a number or text with a unit",
    "count": f"must be a whole number from 2 to {_LONGEST_AXIS}: how many values",
    "spacing": 'must be "linear" or "log"',
    "values": f"must be a list of 1 to {_LONGEST_AXIS} values, numbers or texts with a unit",
    "study": "must be a table [study]",
    "basins": "must be a table [basins]",
    "disturbances": "must be a whole number from 0 to 1000000: motions simulated at each point",
    "least_damping": "must be true or false",
    "starts": f"must be a whole number from 1 to {_MOST_STARTS:.0e}: disturbances at each point",
    "disturbance": 'must be a table such as {kind = "kick", fastest = "0.3 m/s"}',
}


def load_sweep(path: str | os.PathLike[str], settings: Iterable[str] = ()) -> SweepPlan:
    """Read a sweep file.

    Parameters
    ----------
    path : path
        TOML file; see ``examples/sweep-gains.toml``.
    settings : iterable of str
        Texts ``"name=value"`` as in ``--set``, besides those of the file.

    Returns
    -------
    SweepPlan

    Raises
    ------
    InputError
        The file, or the machine file it names, cannot be used.
    """
    name, content = read_toml(path, _WHAT, _REMEDY)
    try:
        given = _SweepFile.model_validate(content)
    except pydantic.ValidationError as problem:
        raise _input_error(problem, content) from None
    machine = Path(name).parent / given.machine
    listed = [*given.settings, *settings]
    case = load_case(machine, listed)
    fixed = _fixed(case, listed, given.axes)
    axes = tuple(_axis(case, axis, table) for axis, table in given.axes.items())
    task = _task(case, given)
    shape = tuple(axis.count for axis in axes)
    sources = {
        "sweep_file": Path(name).read_text(encoding="utf-8-sig"),
        "machine_file": machine.read_text(encoding="utf-8-sig"),
    }
    return SweepPlan(case, axes, task, cut(shape, task, given.chunk), given.seed, fixed, sources)


def _fixed(case: Case, settings: list[str], axes: Mapping[str, object]) -> dict[str, float]:
    """Dimensionless numbers among the settings; no setting may touch what an axis varies."""
    names = {setting.partition("=")[0].strip(): "set" for setting in settings}
    for name in axes:
        if name in names:
            raise InputError(f"axes.{name}", "varied", "is set too; do one of the two")
    check_names({**names, **dict.fromkeys(axes, "varied")})
    return {name: getattr(case.parameters, name) for name in names if name in DIMENSIONLESS_FIELDS}


def _axis(case: Case, name: str, table: _Axis) -> GridAxis:
    field = {**DIMENSIONLESS_FIELDS, **MACHINE_FIELDS}[name]
    where = f"axes.{name}"
    if name in MACHINE_FIELDS and case.machine is None:
        raise InputError(where, shown(name), "the machine file is dimensionless; vary dimensionless parameters")
    ends = {"from": table.start, "to": table.end, "count": table.count}
    if table.values is not None:
        for key, value in {**ends, "spacing": table.spacing}.items():
            if value is not None:
                raise InputError(f"{where}.{key}", shown(value), "goes without values; give one or the other")
        values = tuple(_number(f"{where}.values", field, value) for value in table.values)
        if len(set(values)) < len(values):
            raise InputError(f"{where}.values", shown(table.values), "must be different values")
        return GridAxis(name, "list", values, len(values))
    for key, value in ends.items():
        if value is None:
            raise InputError(f"{where}.{key}", None, f"missing; {_ALLOWED[key]}; or give values = [...]")
    low, high = (_number(f"{where}.{key}", field, ends[key]) for key in ("from", "to"))
    if low == high:
        raise InputError(f"{where}.to", shown(table.end), "must be another value than from")
    spacing = table.spacing or "linear"
    if spacing == "log" and not (low > 0 and high > 0):
        raise InputError(f"{where}.spacing", "log", "needs ends above 0")
    return GridAxis(name, spacing, (low, high), int(table.count or 0))


def _number(where: str, field: Field, given: object) -> float:
    try:
        return read_quantity(field, given)
    except InputError as problem:
        raise InputError(where, problem.value, problem.allowed) from None


def _task(case: Case, given: _SweepFile) -> Task:
    if (given.study is None) == (given.basins is None):
        found = "neither" if given.study is None else "both"
        raise InputError(_WHAT, found, "must hold a [study] or a [basins] table, one of them alone")
    scales = case.parameters.scales
    if given.study is not None:
        if given.study.least_damping and not given.study.disturbances:
            raise InputError("study.disturbances", 0, "must be above 0 where least_damping is wanted, such as 100")
        return StudyTask(
            given.study.disturbances, given.study.least_damping, case.zones.limits, has_scales=scales is not None
        )
    basins = given.basins
    if basins is None:
        raise InputError("basins", None, _ALLOWED["basins"])
    kind, sizes = _disturbance(basins.disturbance, scales)
    task = BasinsTask(basins.starts, kind, sizes, has_scales=scales is not None)
    try:
        task.model(scales)
    except InputError as problem:
        raise InputError(f"basins.disturbance.{problem.field}", problem.value, problem.allowed) from None
    return task


def _disturbance(table: dict[str, Any], scales: Scales | None) -> tuple[str, tuple[tuple[str, Any, bool], ...]]:
    """Kind and sizes of a disturbance."""
    where = "basins.disturbance"
    kind = table.get("kind")
    if not isinstance(kind, str) or kind not in MODELS:
        raise _unknown(f"{where}.kind", kind, MODELS)
    fields = {field.name: field for field in dataclasses.fields(MODELS[kind])}
    for name, value in table.items():
        if name != "kind" and name not in fields:
            raise unknown_name(name, value, {"kind": None, **fields}, f"[{where}] of a {kind}")
    sizes = []
    for name, field in fields.items():
        if name in table:
            scale = MODELS[kind].measured_in.get(name, "")
            read = _pair if isinstance(field.default, complex) else _size
            sizes.append((name, *read(f"{where}.{name}", table[name], scale, scales)))
        elif field.default is dataclasses.MISSING:
            raise InputError(f"{where}.{name}", None, f"missing; a {kind} needs it")
        else:
            sizes.append((name, field.default, False))
    return kind, tuple(sizes)


def _unknown(where: str, given: object, known: Mapping[str, Any]) -> InputError:
    if given is None:
        return InputError(where, None, f"missing; allowed: {', '.join(known)}")
    problem = unknown_name(shown(given), given, known, where)
    return InputError(where, shown(given), problem.allowed.replace("unknown name", "unknown"))


def _size(where: str, given: object, scale: str, scales: Scales | None) -> tuple[Any, bool]:
    """A size: a number in units of the equations, or text with a unit; and whether it is in SI units."""
    if not scale:
        return given, False
    unit, kind, example = _SIZES[scale]
    if not isinstance(given, str):
        field = Field(where, "", "", "a number", "", -1e30, 1e30, f"0.5, in units of the equations, or '{example}'")
        return read_quantity(field, given), False
    if scales is None:
        raise InputError(where, given, "must be a number: the machine file is dimensionless and has no scales")
    text = given.strip()
    if scale == "acceleration" and text.endswith("g") and not text[:-1].strip().endswith(("k", "m")):
        text = text[:-1] + _GRAVITY
    try:
        return read_quantity(Field(where, "", "", kind, unit, -1e30, 1e30, f"'{example}'"), text), True
    except InputError as problem:
        raise InputError(where, given, problem.allowed) from None


def _pair(where: str, given: object, scale: str, scales: Scales | None) -> tuple[complex, bool]:
    """A complex size: its real and imaginary part, both with a unit or both without."""
    parts = [_size(where, part, scale, scales) for part in given] if isinstance(given, list) else []
    if len(parts) != 2 or parts[0][1] != parts[1][1]:
        example = _SIZES[scale][2]
        allowed = f'must be two sizes along x and y, both with a unit or none, such as [0.5, 0], or ["{example}", "{example}"]'
        raise InputError(where, shown(given), allowed)
    (real, in_si), (imaginary, _) = parts
    return complex(real, imaginary), in_si


def _input_error(problem: pydantic.ValidationError, content: Mapping[str, Any]) -> InputError:
    """Return the one error to show: an unknown name first, since it is mostly the missing one misspelt."""
    errors = sorted(problem.errors(), key=lambda error: error["type"] != "extra_forbidden")
    first = errors[0]
    path = [part for part in first["loc"] if isinstance(part, str)]
    # Of a union of types pydantic names the alternatives too.
    known = [part for place, part in enumerate(path) if place < 2 or part in _ALLOWED]
    where, name = ".".join(known), known[-1]
    if first["type"] == "extra_forbidden":
        return _unknown_entry(path, first["input"])
    given = None if first["type"] == "missing" else shown(_find(content, path))
    return InputError(where, given, _ALLOWED[name if name in _ALLOWED else "axes"])


def _find(content: Any, path: list[str]) -> Any:
    for part in path:
        if not isinstance(content, Mapping) or part not in content:
            break
        content = content[part]
    return content


def _unknown_entry(path: list[str], given: object) -> InputError:
    tables: dict[str, type[_Table]] = {"study": _Study, "basins": _Basins, "axes": _Axis}
    table = tables.get(path[0], _SweepFile) if len(path) > 1 else _SweepFile
    names = {field.alias or name: None for name, field in table.model_fields.items()}
    return unknown_name(path[-1], given, names, f"[{'.'.join(path[:-1])}]" if len(path) > 1 else "the sweep file")
