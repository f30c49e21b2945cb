"""Case to study: what the tables of a machine file and settings on the command line make of a planar rotor."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar, cast

from carom.base.arguments import checked
from carom.base.outcome import InputError, Problems, shown, together
from carom.base.tabular import Tabular
from carom.parameters.fields import (
    DIMENSIONLESS_FIELDS,
    MACHINE_FIELDS,
    Field,
    name_errors,
    unknown_name,
    unknown_names,
)
from carom.parameters.formats import format_entry, format_quantity, number, shown_in
from carom.parameters.machine import Machine, warn_of_proportions
from carom.parameters.numbers import Parameters, own_numbers
from carom.parameters.quantities import read_quantity
from carom.parameters.recovery import RecoveryAction, read_recoveries
from carom.parameters.requirement import Requirement
from carom.parameters.scaling import Scales
from carom.parameters.tables import GRAVITY_FIELDS, LIMIT_FIELDS, Drive, Gravity, LoadLimits, Table, Zones
from carom.parameters.terms import ENTRIES, SETTABLE, check_names
from carom.parameters.toml_reader import MachineTables
from carom.parameters.touchdown_bearing import PREFIX, TOUCHDOWN_FIELDS, TouchdownBearing

_SETTING = "--set"
_Table = TypeVar("_Table", Gravity, TouchdownBearing)
UNUSED = 0.0
"""Restitution of a machine whose touchdown bearing is compliant."""
GRAVITY_NAME = "gravity"
"""Name of the acceleration of ``[gravity]`` where it stands beside the entries of the machine."""
OF_TABLES: Mapping[str, Field] = {
    GRAVITY_NAME: replace(GRAVITY_FIELDS["acceleration"], name=GRAVITY_NAME),
    **{PREFIX + name: replace(field, name=PREFIX + name) for name, field in TOUCHDOWN_FIELDS.items()},
}
"""Entries of the tables ``[gravity]`` and ``[touchdown]``, by the names that they have beside those of the machine."""
SETTINGS: Mapping[str, Field] = {**SETTABLE, **OF_TABLES}
"""Everything that a setting, or an axis of a sweep, may change."""
_UNITS_SHOWN = ("length", "time", "velocity", "force", "impulse")
"""Units of the equations that a case shows."""


@checked
@dataclass(frozen=True, repr=False)
class Case(Tabular):
    """What a command works on: the content of a machine file after all settings.

    Parameters
    ----------
    name : str
        Name of the file without folder and suffix, printable.
    parameters : Parameters or model
        Dimensionless parameters, with scales if the file describes a machine. A dimensionless number that was set is
        stored here exactly.  A model that no file describes stands for itself.
    machine : Machine or None
        The machine, as close to `parameters` as doubles allow; None for a dimensionless file.
    zones : Zones
        Limits of the amplitude zones.
    limits : LoadLimits
        Largest loads that are stated for the touchdown bearing.
    requirement : Requirement
        What the machine must survive, in the SI units of `parameters` if these have scales.
    gravity : Gravity, optional
        By default, or with an acceleration of zero, the rotor has no weight.
    touchdown : TouchdownBearing, optional
        By default, or with the law of a rigid wall, the touchdown bearing is rigid; otherwise the restitution of the machine is not used.
    drive : Drive, optional
        Beside a compliant touchdown bearing; by default the speed never changes.
    recoveries : tuple of RecoveryAction
        When levitation is regained after a drop, and with which actions.
    stated : mapping of str, optional
        The numbers of a dimensionless file as they were written.

    Raises
    ------
    InputError
        `parameters` or `requirement` are something else, there is gravity without scales, or the change of the unbalance by the loss of a blade is out of range for the
        mass and clearance of the machine.
    """

    name: str
    # Not narrower: what files describe reads the parameters of a planar rotor.
    parameters: Any
    machine: Machine | None
    zones: Zones
    limits: LoadLimits = field(default_factory=LoadLimits)
    requirement: Requirement = field(default_factory=Requirement)
    gravity: Gravity | None = None
    touchdown: TouchdownBearing | None = None
    drive: Drive | None = None
    recoveries: tuple[RecoveryAction, ...] = ()
    stated: Mapping[str, object] = field(default_factory=dict, compare=False)

    def __post_init__(self) -> None:
        if not hasattr(self.parameters, "finite_elements"):
            raise InputError("parameters", shown(self.parameters), "must be carom.parameters.Parameters, or a model")
        self.requirement.own(self.parameters.scales)
        if self.drive and self.drive.polar_inertia is None and self.parameters.finite_elements is None:
            raise InputError("polar_inertia", None, "a table [drive] needs it, such as polar_inertia = '0.02 kg m^2'")
        if self.gravity is not None and self.gravity.acceleration == 0.0:
            object.__setattr__(self, "gravity", None)
        if self.touchdown is not None and self.touchdown.is_plain:
            object.__setattr__(self, "touchdown", None)
        if self.touchdown is not None and not self.touchdown.is_compliant and self.touchdown.restitution is not None:
            allowed = "must be left out: the restitution of a rigid wall is that of the machine, restitution"
            raise InputError(f"{PREFIX}restitution", self.touchdown.restitution, allowed)
        for table in (self.gravity, self.touchdown):
            if table is not None and self.parameters.scales is None:
                raise table.without_scales(table.words)
        if self.machine is not None:
            check_limits(self.limits, [self.touchdown])

    @property
    def heading(self) -> str:
        """What it is, and its name."""
        return f"Case {self.name}"

    @property
    def si(self) -> Mapping[str, float]:
        """Numbers of ``[machine]`` that are stated, or have a default, in SI units; empty without this table."""
        return {} if self.machine is None else self.machine.values

    @property
    def given(self) -> Mapping[str, Mapping[str, Any]]:
        """For each of them the entries that gave it: :attr:`carom.parameters.Machine.given`."""
        return {} if self.machine is None else self.machine.given

    @property
    def given_texts(self) -> Mapping[str, Mapping[str, str]]:
        """The same as texts that can be shown anywhere."""
        return {} if self.machine is None else self.machine.given_texts

    @property
    def written(self) -> Mapping[str, Any]:
        """The numbers of ``[machine]`` or ``[dimensionless]`` as they were written, with their units; of one that follows from others the double that it is."""
        if not self.si:
            return self.stated
        return {name: self.given.get(name, {}).get(name, self.si[name]) for name in MACHINE_FIELDS}

    def rows(self) -> list[tuple[str, str]]:
        """The machine in the units of people, what is stated beside it, and the units of the equations."""
        scales = self.parameters.scales
        zones = ", ".join(f"{zone} up to {number(limit)}" for zone, limit in zip("ABC", self.zones.limits, strict=True))
        limits = [
            f"{field.words} {format_entry(field, value)}"
            for name, field in LIMIT_FIELDS.items()
            if (value := getattr(self.limits, name)) is not None
        ]
        units = [f"{shown_in(kind, None)[1]} = {format_quantity(1.0, kind, scales)}" for kind in _UNITS_SHOWN]
        rows = {
            "touchdown bearing": self.touchdown and self.touchdown.words,
            "drive": self.drive and self.drive.words,
            "gravity": self.gravity and self.gravity.words,
            "must survive": self._required(),
            "levitation after a drop": "; ".join(f"{each.name}: {each.words}" for each in self.recoveries),
            "zones, in clearances": zones,
            "limits of the bearing": ", ".join(limits),
            "units of the equations": scales and ", ".join(units),
        }
        return self._of_machine() + [(name, text) for name, text in rows.items() if text]

    def _of_machine(self) -> list[tuple[str, str]]:
        """The machine, without its restitution if its touchdown bearing is compliant."""
        numbers = self.parameters
        if numbers.finite_elements is not None:
            return numbers.finite_elements.machine.rows()
        if self.machine is None:
            return [(numbers.varied[name].words, number(value)) for name, value in own_numbers(numbers).items()]
        left_out = ENTRIES["restitution"].words if self.touchdown and self.touchdown.is_compliant else None
        return [row for row in self.machine.rows() if row[0] != left_out]

    def to_toml(self) -> str:
        """Return the text of a machine file that is read as this case, bit for bit; empty if its rotor has matrices that are in no file."""
        numbers, machine = self.parameters, self.machine
        if numbers.finite_elements is not None:
            text = numbers.finite_elements.to_toml()
        elif machine is not None:
            text = machine.to_toml()
            if self.touchdown and self.touchdown.is_compliant:  # whose law has its own restitution
                text = re.sub("(?m)^restitution = .*\n", "", text)
        elif isinstance(numbers, Parameters) and numbers.scales is None:
            lines = [f"{name} = {value!r}" for name, value in numbers.as_dict().items()]
            text = "\n".join(["[dimensionless]", *lines]) + "\n"
        else:
            text = ""
        if not text:
            return ""
        tables = [table.to_toml() for table in (self.limits, self.touchdown, self.drive, self.gravity) if table]
        tables += [each.to_toml() for each in self.recoveries]
        required = self.requirement.to_toml(has_scales=numbers.scales is not None)
        return "\n".join(filter(None, [text, self.zones.to_toml(), required, *tables]))

    def _required(self) -> str:
        scales, stated = self.parameters.scales, self.requirement
        required = stated.own(scales)
        usual = " (default: impact speed of a free fall across the clearance)" if stated.kick is None else ""
        parts = [f"kicks up to {format_quantity(required.kick, 'velocity', scales)}{usual}"]
        if required.shock:
            peak = format_quantity(required.shock.peak, "acceleration", scales)
            parts.append(f"shocks up to {peak}, {format_quantity(required.shock.duration, 'time', scales)}")
        if required.blade_loss:
            kind = "unbalance" if scales else "length"
            parts.append(f"a loss of a blade of {format_quantity(required.blade_loss, kind, scales)}")
        return "; ".join(parts)

    def replace(self, /, **changes: object) -> Case:
        """Return the case with other parameters of the machine, bit for bit the same as with ``--set``.

        Parameters
        ----------
        **changes
            As for :meth:`carom.parameters.Machine.replace`; for a dimensionless case as for :meth:`carom.parameters.Parameters.replace`;
            for one of a model as for its own ``replace``.
            ``gravity`` sets the acceleration of :class:`carom.parameters.Gravity`, and ``touchdown_stiffness`` and the like the entries
            of :class:`carom.parameters.TouchdownBearing`.

        Raises
        ------
        InputError
            If a name is unknown or a value not allowed.
        """
        if GRAVITY_NAME in changes:
            if self.parameters.scales is None:
                raise Gravity.without_scales(changes[GRAVITY_NAME])
            gravity = _changed(self.gravity or Gravity(), {"acceleration": changes.pop(GRAVITY_NAME)}, GRAVITY_NAME)
            return replace(self, gravity=gravity).replace(**changes)
        if not isinstance(self.parameters, Parameters):
            return replace(self, parameters=self.parameters.replace(**changes)) if changes else self
        if of_bearing := {name: changes.pop(name) for name in list(changes) if name.startswith(PREFIX)}:
            own = {name.removeprefix(PREFIX): value for name, value in of_bearing.items()}
            if unknown := unknown_names(own, {**TOUCHDOWN_FIELDS, "law": TOUCHDOWN_FIELDS["exponent"]}, "[touchdown]"):
                raise together(unknown)
            touchdown = _changed(self.touchdown or TouchdownBearing(), own)
            return replace(self, touchdown=touchdown).replace(**changes)
        is_compliant = self.touchdown is not None and self.touchdown.is_compliant
        if is_compliant and (unused := {"d", "restitution"} & changes.keys()):
            raise _unused_restitution(changes[min(unused)])
        numbers = {
            name: read_quantity(DIMENSIONLESS_FIELDS[name], changes[name])
            for name in changes
            if name in DIMENSIONLESS_FIELDS
        }
        if self.machine is None:
            stated = {**self.stated, **changes}
            return replace(self, parameters=self.parameters.replace(**changes | numbers), stated=stated)
        machine = self.machine.replace(**changes)
        return replace(self, parameters=machine.parameters.replace(**numbers), machine=machine)


def check_limits(limits: LoadLimits, bearings: Sequence[TouchdownBearing | None]) -> None:
    """Refuse limits of what a machine with these touchdown bearings, ``None`` for one that is rigid, does not have."""
    if limits.depth is not None and not all(each and each.is_compliant for each in bearings):
        raise InputError("depth", limits.depth, "a limit needs a table [touchdown] of a compliant bearing")
    for name, entry in limits.needed.items():
        if name in limits.given and not all(each and entry in each.given for each in bearings):
            where = "the table [touchdown]" if len(bearings) == 1 else "all tables [[touchdown]]"
            raise InputError(name, limits.given[name], f"a limit needs {entry} in {where}")


Fields = dict[str, Any]
"""Attributes of a case by their names."""


def read_beside(tables: MachineTables, problems: Problems, has_scales: bool = True) -> Fields:
    """What all kinds of files state beside their machine: ``[zones]``, ``[limits]``, ``[gravity]``, ``[drive]`` and ``[[recovery]]``; errors are added to those before."""
    defaults: dict[type[Table], Table | None] = {Zones: Zones(), LoadLimits: LoadLimits(), Gravity: None, Drive: None}
    stated = {kind: tables.beside.get(kind.heading) for kind in defaults}
    found = {kind: problems.attempt(kind.of, table, has_scales) for kind, table in stated.items() if table is not None}
    beside = {kind.heading: found.get(kind) or default for kind, default in defaults.items()}
    return {**beside, "recoveries": read_recoveries(tables.recoveries, has_scales, problems)}


def read_case(
    name: str,
    tables: MachineTables,
    texts: Mapping[str, str],
    problems: Problems,
    read_rotor: Callable[[MachineTables, Mapping[str, str], Fields, Problems], Fields],
) -> Case:
    """Case of a machine file with these settings; ``read_rotor`` reads what a file with ``[rotor]`` states, with its settings.

    Raises
    ------
    InputError
        Errors of the tables and the settings, together with those found before.

    Warns
    -----
    CaromWarning
        The rotor radius is less than 5 clearances: a unit was probably forgotten.
    """
    has_scales, of_parts = tables.kind != "dimensionless", tables.kind == "rotor"
    found = read_beside(tables, problems, has_scales)
    found |= read_rotor(tables, texts, found, problems) if of_parts else _read_planar(tables, problems)
    # If the machine cannot be read any scales do, so that all errors are stated.
    scales = Scales(1.0, 1.0, 1.0) if has_scales else None
    if found["parameters"] is not None:
        scales = found["parameters"].scales
    found["requirement"] = (
        problems.attempt(Requirement.of_table, tables.beside.get("survive", {}), scales) or Requirement()
    )
    if not of_parts:
        problems.attempt(check_names, {each: texts[each] for each in texts if not each.startswith(PREFIX)}, SETTINGS)
    problems.raise_all()
    case = Case(name, **found)
    if not of_parts:
        case = case.replace(**texts)
        warn_of_proportions(case.machine)
    return case


def _read_planar(tables: MachineTables, problems: Problems) -> Fields:
    """Of ``[machine]`` or ``[dimensionless]``, and ``[touchdown]``."""
    of_machine = tables.kind == "machine"
    stated = tables.beside.get("touchdown", {})
    values, bearing = problems.attempt(_with_restitution, tables.values, stated) or (tables.values, {})
    touchdown = problems.attempt(TouchdownBearing.of, bearing, of_machine) if bearing else None
    if of_machine:
        machine = problems.attempt(Machine, **values)
        return {"parameters": machine and machine.parameters, "machine": machine, "touchdown": touchdown}
    numbers = problems.attempt(_read_dimensionless, tables)
    return {"parameters": numbers, "machine": None, "touchdown": touchdown, "stated": tables.values}


@checked
def field_to_set(name: str) -> Field:
    """Field of anything that a setting, or an axis of a sweep, may change."""
    if name not in SETTINGS:
        raise unknown_name(name, None, SETTINGS, "the parameters")
    return SETTINGS[name]


def split_settings(settings: Iterable[str], problems: Problems) -> dict[str, str]:
    """Names and texts of the settings, each name once."""
    texts: dict[str, str] = {}
    for setting in settings:
        name, equals, text = (part.strip() for part in str(setting).partition("="))
        if not equals or not name:
            allowed = "must be name=value, such as gamma=0.1 or damping=2000 N s/m"
            problems.errors.append(InputError(_SETTING, shown(setting), allowed))
            continue
        if name in texts:
            problems.errors.append(InputError(name, shown(text), f"is set twice by {_SETTING}; give it once"))
        texts[name] = text
    return texts


def _changed(table: _Table, changes: Mapping[str, object], entry: str = "") -> _Table:
    """A table with other entries; errors name them as settings, with the prefix of a touchdown bearing or as one ``entry``."""
    try:
        return table.replace(**changes)
    except InputError as problem:
        raise InputError(entry or PREFIX + problem.field, shown(problem.value), problem.allowed) from None


def _with_restitution(
    values: Mapping[str, object], touchdown: Mapping[str, object]
) -> tuple[Mapping[str, object], Mapping[str, object]]:
    """Entries of a machine and its touchdown bearing: the restitution of a rigid wall, wherever it is stated, is that of the machine.

    With a compliant touchdown bearing the restitution of the machine is not used; one that is given is refused.
    """
    if touchdown.get("law", "rigid") == "rigid":
        own = {name: given for name, given in touchdown.items() if name == "restitution"}
        if own and "restitution" in values:
            raise InputError("restitution", shown(own["restitution"]), "stated in [machine] already; give it once")
        return {**values, **own}, {name: given for name, given in touchdown.items() if name not in own}
    if "restitution" in values:
        raise _unused_restitution(values["restitution"])
    return {**values, "restitution": UNUSED}, touchdown


def _unused_restitution(given: object) -> InputError:
    allowed = "must be left out: the touchdown bearing is compliant, and its law has entries of its own in [touchdown]"
    return InputError("restitution", shown(given), allowed)


def _read_dimensionless(tables: MachineTables) -> Parameters:
    problems = Problems()
    problems.errors += name_errors(tables.values, DIMENSIONLESS_FIELDS, "[dimensionless]")
    numbers = {
        name: problems.attempt(read_quantity, field, tables.values[name])
        for name, field in DIMENSIONLESS_FIELDS.items()
        if name in tables.values
    }
    problems.raise_all()
    return Parameters(**cast("dict[str, float]", numbers), scales=None)
