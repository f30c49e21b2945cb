"""The sweep file: read TOML text into a plan, with one-line errors."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar, cast

import pydantic

from carom.base.arguments import checked
from carom.base.outcome import InputError, Problems, shown, together
from carom.disturbances import MODELS, BaseRecord, Sample
from carom.loading import load
from carom.parameters import (
    DIMENSIONLESS_FIELDS,
    SETTINGS,
    TERMS,
    Case,
    Parameters,
    Scales,
    Size,
    Zones,
    read_size,
    unknown_name,
    usual_kick,
)
from carom.parameters.fields import nearest_name, unknown_names
from carom.parameters.machine_file import split_settings
from carom.parameters.terms import check_names
from carom.parameters.toml_reader import read_toml
from carom.sweeps.axes import LONGEST_AXIS, GridAxis
from carom.sweeps.basins import BasinsTask
from carom.sweeps.plan import SweepPlan, Task, cut, parameter_of
from carom.sweeps.studies import StudyTask

if TYPE_CHECKING:
    from carom.disturbances import Disturbance
    from carom.models import Axis

_WHAT = "sweep file"
_REMEDY = 'must hold machine = "...", a table [axes.NAME] for each axis, and a [study] or a [basins] table'
_MOST_STARTS = 1_000_000
_ANY_SCALES = Scales(1.0, 1.0, 1.0)
"""Scales used to check sizes if the machine file has errors, so that the scales of the machine are unknown."""


class _Table(pydantic.BaseModel):
    model_config = pydantic.ConfigDict(frozen=True, extra="forbid", strict=True)


_Value = float | int | str


class _Axis(_Table):
    start: _Value | None = pydantic.Field(None, alias="from")
    end: _Value | None = pydantic.Field(None, alias="to")
    count: int | None = pydantic.Field(None, ge=2, le=LONGEST_AXIS)
    spacing: Literal["linear", "log"] | None = None
    values: list[Any] | None = pydantic.Field(None, min_length=1, max_length=LONGEST_AXIS)


class _Study(_Table):
    disturbances: int = pydantic.Field(0, ge=0, le=1_000_000)


class _Basins(_Table):
    starts: int = pydantic.Field(ge=1, le=_MOST_STARTS)
    disturbance: dict[str, Any]


class _Top(_Table):
    machine: str
    settings: list[str] = pydantic.Field([], alias="set")
    seed: int | None = pydantic.Field(None, ge=0, lt=2**63)
    chunk: int | None = pydantic.Field(None, ge=1)


_TABLES = ("axes", "study", "basins")
_Model = TypeVar("_Model", bound=_Table)
_ALLOWED = {
    "machine": 'must be the path of a machine file, from the folder of the sweep file, such as "keogh-cole.toml"',
    "set": 'must be a list of settings, such as ["friction=0.2"]',
    "seed": "must be a whole number from 0 to 2^63 - 1",
    "chunk": "must be a whole number of at least 1: points of the grid that are computed and stored together",
    "axes": "must be tables [axes.NAME], one for each parameter to vary",
    "from": "must be the first value, a number or text with a unit",
    "to": "must be the last value, a number or text with a unit",
    "count": f"must be a whole number from 2 to {LONGEST_AXIS}: how many values",
    "spacing": 'must be "linear" or "log"',
    "values": f"must be a list of 1 to {LONGEST_AXIS} values, numbers or texts with a unit",
    "disturbances": "must be a whole number from 0 to 1000000: motions simulated at each point",
    "starts": f"must be a whole number from 1 to {_MOST_STARTS:.0e}: disturbances at each point",
    "disturbance": 'must be a table such as {kind = "kick", fastest = "0.3 m/s"}',
}


@checked
def load_sweep(path: str | os.PathLike[str], settings: Iterable[str] = ()) -> SweepPlan:
    """Read a sweep file.

    Parameters
    ----------
    path : path
        TOML file; see ``examples/sweep-gains.toml``.
    settings : iterable of str
        Texts ``"name=value"`` as in ``--set``, applied in addition to those of the file.

    Raises
    ------
    InputError
        The file, or the machine file it names, cannot be used.  The message lists all errors at once.
    """
    name, content = read_toml(path, _WHAT, _REMEDY)
    problems = Problems()
    tables = {table: content.pop(table) for table in _TABLES if table in content}
    top = problems.attempt(_read, _Top, content, "", _TABLES)
    listed = [*(top.settings if top else []), *settings]
    machine = Path(name).parent / (top.machine if top else "")
    case = problems.attempt(load, machine, listed) if top else None
    texts = split_settings(listed, Problems())
    axes = problems.attempt(_axes, tables.get("axes"), texts, case)
    task = problems.attempt(_task, tables, top, case)
    problems.raise_all()
    case, axes, task, top = cast("tuple[Case, tuple[GridAxis, ...], Task, _Top]", (case, axes, task, top))
    chunk = cut(tuple(axis.count for axis in axes), task, top.chunk)
    fixed: dict[str, float | str] = {
        name: getattr(case.parameters, name) for name in texts if name in DIMENSIONLESS_FIELDS
    }
    if case.si:
        fixed |= {name: text for name, text in texts.items() if name in TERMS}
    sources = {
        "sweep_file": Path(name).read_text(encoding="utf-8-sig"),
        "machine_file": machine.read_text(encoding="utf-8-sig"),
    }
    return SweepPlan(case, axes, task, chunk, top.seed or 0, fixed, sources)


def _read(model: type[_Model], content: object, where: str, besides: Iterable[str] = ()) -> _Model:
    """Check the entries of a table; `besides` are names of other tables that errors about unknown names may suggest."""
    if not isinstance(content, dict):
        raise InputError(where, shown(content), f"must be a table [{where}]")
    try:
        return model.model_validate(content)
    except pydantic.ValidationError as problem:
        errors = problem.errors()
    names = {field.alias or name: None for name, field in model.model_fields.items()}
    prefix = f"{where}." if where else ""
    found = unknown_names(content, {**names, **dict.fromkeys(besides)}, f"[{where}]" if where else _WHAT)
    meant = {nearest_name(entry, names) for entry in content if entry not in names}
    for entry in dict.fromkeys(str(error["loc"][0]) for error in errors):
        if entry in content and entry in names:
            found.append(InputError(f"{prefix}{entry}", shown(content[entry]), _ALLOWED[entry]))
        elif entry in names and entry not in meant:
            found.append(InputError(f"{prefix}{entry}", None, f"missing; {_ALLOWED[entry]}"))
    raise together(found)


# -------------------------------------------------------------------------------------------------------------- axes


def _axes(tables: object, settings: Iterable[str], case: Case | None) -> tuple[GridAxis, ...]:
    if not isinstance(tables, dict) or not tables:
        raise InputError("axes", None if tables is None else shown(tables), _ALLOWED["axes"])
    problems = Problems()
    planar = case is None or isinstance(case.parameters, Parameters)
    problems.attempt(_check_varied, list(tables), settings, planar)
    wanted = [name for name in tables if not planar or name in SETTINGS]
    axes = [problems.attempt(_axis, case, name, tables[name]) for name in wanted]
    problems.raise_all()
    return cast("tuple[GridAxis, ...]", tuple(axes))


def _check_varied(axes: list[str], settings: Iterable[str], planar: bool) -> None:
    """Refuse settings that change a parameter that an axis varies, and of the planar rotor what is none, or set twice in other words."""
    problems = Problems()
    problems.errors += [
        InputError(f"axes.{name}", "varied", "is set too; do only one of the two") for name in axes if name in settings
    ]
    if planar:
        known = [name for name in settings if name in SETTINGS]  # others are errors of the settings already
        problems.attempt(check_names, dict.fromkeys(known, "set") | dict.fromkeys(axes, "varied"), SETTINGS)
    problems.raise_all()


def _axis(case: Case | None, name: str, given: object) -> GridAxis:
    problems = Problems()
    parameter = problems.attempt(parameter_of, case, name) if case is not None else name
    table = problems.attempt(_read, _Axis, given, f"axes.{name}")
    # Values of the planar rotor's parameters are known by their names.
    known = parameter or (name if name in SETTINGS else None)
    axis = problems.attempt(_values, known, name, table) if table and known else None
    problems.raise_all()
    return cast("GridAxis", axis)


def _values(parameter: Axis | str, name: str, table: _Axis) -> GridAxis:
    where = f"axes.{name}"
    ends = {"from": table.start, "to": table.end, "count": table.count}
    if table.values is None:
        if missing := [key for key, value in ends.items() if value is None]:
            words = "missing; {}; or give values = [...]"
            raise together([InputError(f"{where}.{key}", None, words.format(_ALLOWED[key])) for key in missing])
        low, high, count = cast("tuple[_Value, _Value, int]", tuple(ends.values()))
        return GridAxis.between(parameter, low, high, count, table.spacing or "linear")
    problems = Problems()
    problems.errors += [
        InputError(f"{where}.{key}", shown(value), "not allowed beside values; give one or the other")
        for key, value in {**ends, "spacing": table.spacing}.items()
        if value is not None
    ]
    axis = problems.attempt(GridAxis.of, parameter, table.values)
    problems.raise_all()
    return cast("GridAxis", axis)


# -------------------------------------------------------------------------------------------------------------- work


def _task(tables: Mapping[str, object], top: _Top | None, case: Case | None) -> Task:
    """Return the task of each point; without a case the table is only checked for errors."""
    if ("study" in tables) == ("basins" in tables):
        found = "both" if "study" in tables else "neither"
        raise InputError(_WHAT, found, "must hold either a [study] or a [basins] table")
    scales = case.parameters.scales if case else _ANY_SCALES
    if "basins" in tables:
        return _basins(tables["basins"], scales)
    study = _read(_Study, tables["study"], "study")
    limits = case.zones.limits if case else Zones().limits
    if top and top.seed is not None and not study.disturbances:
        allowed = "allowed only with simulated disturbances; leave it out, or set study.disturbances above 0"
        raise InputError("seed", top.seed, allowed)
    return StudyTask(study.disturbances, limits, scales is not None)


def _basins(given: object, scales: Scales | None) -> BasinsTask:
    problems = Problems()
    basins = problems.attempt(_read, _Basins, given, "basins")
    table = given.get("disturbance") if isinstance(given, dict) else None
    found = problems.attempt(_disturbance, table, scales) if isinstance(table, dict) else None
    problems.raise_all()
    basins, (model, in_si) = cast("tuple[_Basins, tuple[Disturbance, tuple[str, ...]]]", (basins, found))
    return BasinsTask(Sample(model, basins.starts), in_si, scales)


def _disturbance(table: Mapping[str, object], scales: Scales | None) -> tuple[Disturbance, tuple[str, ...]]:
    """Read a disturbance; return the names of its sizes that are in SI units too."""
    where = "basins.disturbance"
    kind = table.get("kind")
    if not isinstance(kind, str) or kind not in MODELS:
        allowed = f"missing; allowed: {', '.join(MODELS)}"
        if kind is not None:
            allowed = unknown_name(shown(kind), kind, MODELS, f"{where}.kind").allowed
        raise InputError(f"{where}.kind", None if kind is None else shown(kind), allowed)
    model = MODELS[kind]
    if "file" in table and kind == BaseRecord.kind:
        return model.single_of(str(table["file"]), scales, f"{where}.file").model, ()
    # The velocity of a slice has two parts, and stays zero here.
    fields = {each.name: each for each in dataclasses.fields(model) if not isinstance(each.default, complex)}
    problems = Problems()
    problems.errors += unknown_names(table, {"kind": None, **fields}, f"[{where}] of a {kind}")
    meant = {nearest_name(name, fields) for name in table if name not in fields}
    if "fastest" in fields:
        usual = usual_kick(scales)
        table = {"fastest": f"{usual * scales.velocity!r} m/s" if scales else usual, **table}
    sizes = {}
    for name, field in fields.items():
        if name in table:
            sizes[name] = problems.attempt(_size, f"{where}.{name}", table[name], model.measured_in.get(name), scales)
        elif field.default is dataclasses.MISSING and name not in meant:
            problems.errors.append(InputError(f"{where}.{name}", None, f"missing; a {kind} needs it"))
    problems.raise_all()
    own = {name: size.own(scales) if isinstance(size, Size) else size for name, size in sizes.items()}
    try:
        made = model(**own)
    except InputError as problem:
        raise problem.under(f"{where}.") from None
    return made, tuple(name for name, size in sizes.items() if isinstance(size, Size) and size.in_si)


def _size(where: str, given: object, scale: str | None, scales: Scales | None) -> object:
    """Read a size; what has no unit stays as it is."""
    if scale is None:
        return given
    return read_size(where, given, scale, scales)
