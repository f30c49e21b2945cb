"""Read a flexible machine from the tables of a machine file."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from carom.arguments import checked
from carom.outcome import CaromWarning, InputError, Problems, shown, together
from carom.parameters import (
    MACHINE_FIELDS,
    TOUCHDOWN_FIELDS,
    Case,
    Field,
    Gravity,
    LoadLimits,
    Requirement,
    Scales,
    TouchdownBearing,
    Zones,
    read_quantity,
)
from carom.parameters.fields import by_name, unknown_name
from carom.parameters.machine import LEAST_RADIUS
from carom.parameters.machine_file import split_settings
from carom.parameters.toml_reader import MachineTables, read_machine_tables
from carom.parameters.touchdown_bearing import LAWS
from carom.rotors.attachments import PLANE_FIELDS, UNBALANCE_FIELDS, TouchdownPlane, Unbalance
from carom.rotors.controllers import PID, PID_FIELDS, TransferFunction
from carom.rotors.damping import MODAL_FIELDS, PROPORTIONAL_FIELDS, ModalDamping, ProportionalDamping
from carom.rotors.discs import DISC_FIELDS, Disc
from carom.rotors.flexible_machine import ACCURACY, FlexibleMachine
from carom.rotors.flexible_rotor import LONGEST, MOST_ELEMENTS, FlexibleRotor
from carom.rotors.free_rotor import FreeRotor
from carom.rotors.machine_parameters import unknown
from carom.rotors.magnetic_bearing import BEARING_FIELDS, MagneticBearing
from carom.rotors.matrix_rotor import MatrixRotor
from carom.rotors.rigid_body import POSITION, RIGID_FIELDS, RigidRotor
from carom.rotors.rotor_files import read_rotor
from carom.rotors.sections import MATERIAL_FIELDS, SECTION_FIELDS, Material, Section
from carom.rotors.state_spaces import StateSpace
from carom.rotors.support import SUPPORT_FIELDS, Support

_Part = TypeVar("_Part")
_RENAMED = {"damping_ratio": "ratio", "damping_of_mass": "of_mass", "damping_of_stiffness": "of_stiffness"}
"""Entries of ``[rotor]``, and the numbers of a damping that they are."""
ROTOR_ENTRIES: Mapping[str, Any] = {
    "speed": MACHINE_FIELDS["speed"],
    **MATERIAL_FIELDS,
    "longest_element": LONGEST,
    "source": None,
    "accuracy": Field("accuracy", "", "error of contact forces by reduction", "a number", "", 1e-9, 1.0, "0.02"),
    **dict.fromkeys(_RENAMED),
    **RIGID_FIELDS,
}
OF_RIGID = ("speed", *RIGID_FIELDS)
"""Entries of ``[rotor]`` where it states the mass of a rigid rotor."""
SLENDEREST = 500.0
"""Length over diameter of a section beyond which a unit was probably forgotten."""
_MATRICES = ("A", "B", "C", "D")
_PLACED = {"position": "node", "sensor_positions": "sensor_nodes"}
"""Entries of the parts of a rigid rotor, and those that they stand for."""
_QUOTIENT = ("numerator", "denominator")
PART_ENTRIES: Mapping[str, Mapping[str, Any]] = {
    "section": {**SECTION_FIELDS, **MATERIAL_FIELDS},
    "disc": {"node": None, **DISC_FIELDS, "width": None, **by_name(*(SECTION_FIELDS[name] for name in ("outer_diameter", "inner_diameter"))), **MATERIAL_FIELDS},
    "magnetic_bearing": {"node": None, "sensor_nodes": None, "position": POSITION, "sensor_positions": None, "at_regain": None, **BEARING_FIELDS, **PID_FIELDS, **dict.fromkeys((*_QUOTIENT, *_MATRICES))},
    "support": {"node": None, "position": POSITION, **SUPPORT_FIELDS},
    "touchdown": {"node": None, "position": POSITION, "law": None, **PLANE_FIELDS, **TOUCHDOWN_FIELDS},
    "unbalance": {"node": None, "position": POSITION, **UNBALANCE_FIELDS},
}  # fmt: skip
"""Entries of the tables of parts."""


def read_flexible_case(name: str, tables: MachineTables, settings: Mapping[str, str], problems: Problems) -> Case:
    """Case of a file with a ``[rotor]`` table: it holds the reduced machine that levitates, as a model.

    Raises
    ------
    InputError
        An entry cannot be used: each error names its table, numbered from 1 where there are several; or the machine does not levitate.

    Warns
    -----
    CaromWarning
        A section is thicker than the shaft is long, or thinner than a wire, or the rotor radius is less than 5 clearances: a unit was probably forgotten.
    """
    if tables.drive is not None:
        problems.errors.append(
            InputError("drive", shown(dict(tables.drive)), "not allowed beside [rotor]: its speed stays as it is")
        )
    limits = problems.attempt(LoadLimits.of, tables.limits) or LoadLimits()
    zones = problems.attempt(Zones, tables.zones["limits"]) if "limits" in tables.zones else Zones()
    accuracy, text = ROTOR_ENTRIES["accuracy"], settings.get("accuracy", tables.values.get("accuracy", ACCURACY))
    wanted = problems.attempt(read_quantity, accuracy, text)
    machine = _read_machine(tables, settings, problems)
    if limits.pressure is not None and any(each.bearing.balls is None for each in machine.touchdowns):
        raise InputError("pressure", limits.pressure, "a limit needs balls in all tables [[touchdown]]")
    model = machine.reduce(wanted or ACCURACY).limited
    scales = model.scales or Scales(1.0, 1.0, 1.0)
    requirement = Requirement.of_table(tables.survive, scales)
    return Case(name, model, None, zones or Zones(), limits, requirement, machine.gravity)


@checked
def load_machine(path: str | os.PathLike[str], settings: Iterable[str] = ()) -> FlexibleMachine:
    """Read the flexible machine of a machine file with a ``[rotor]`` table, with all its modes.

    :func:`carom.load` reads the same file as a case of the reduced machine, for ``carom.simulate`` and the others.

    Parameters
    ----------
    path : path
    settings : iterable of str
        Texts ``"name=value"`` as in ``--set``: entries of ``[rotor]``, and parameters of the machine (:attr:`FlexibleMachine.varied`).

    Raises
    ------
    InputError
        The file cannot be used, or holds no ``[rotor]`` table.  Whether the machine levitates is not looked at.

    See Also
    --------
    carom.rotors.find_whirls, carom.rotors.sensitivity, carom.closed_forms.synchronous_response : does it levitate well?

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.rotors.load_machine("examples/tum-flexible-rotor.toml", ["speed=6000 rpm"])
    >>> machine.reduce().vectors
    15
    """
    problems = Problems()
    tables = read_machine_tables(path, problems)
    texts = split_settings(settings, problems)
    if tables.kind != "rotor":
        problems.errors.append(InputError("machine file", shown(path), f"a [rotor] table; it holds [{tables.kind}]"))
        problems.raise_all()
    return _read_machine(tables, texts, problems)


def _read_machine(tables: MachineTables, settings: Mapping[str, str], problems: Problems) -> FlexibleMachine:
    """The machine of a file, after all errors, those known before too, are raised."""
    whole = dict(tables.values)
    gravity = None if tables.gravity is None else problems.attempt(Gravity.of, tables.gravity)
    is_rigid = not RIGID_FIELDS.keys().isdisjoint(whole)
    known = {name: field for name, field in ROTOR_ENTRIES.items() if is_rigid or name not in RIGID_FIELDS}
    whole |= {name: text for name, text in settings.items() if name in known}
    problems.errors += [
        unknown_name(each, given, ROTOR_ENTRIES, "[rotor]") for each, given in whole.items() if each not in known
    ]
    stations: list[float] = []
    if is_rigid:
        problems.attempt(_check_rigid, tables, whole)
        problems.raise_all()
        tables, stations = _at_stations(tables, problems)
    steel = problems.attempt(_material, whole, Material()) or Material()
    discs = _each(tables, "disc", problems, lambda entry: _disc(entry, steel))
    rotor: FreeRotor | None = None
    if is_rigid:
        rotor = problems.attempt(_rigid, whole, stations) if stations else None
    elif "source" in whole:
        rotor = problems.attempt(_of_source, tables, whole, discs)
    else:
        sections = _each(tables, "section", problems, lambda entry: _section(entry, steel))
        if not tables.parts.get("section"):
            allowed = (
                "one or more tables, each with its length and outer_diameter; or [rotor] source = a file of matrices"
            )
            problems.errors.append(InputError("[[section]]", None, allowed))
        damping = problems.attempt(_damping, whole)
        if not problems.errors:
            rotor = FlexibleRotor(sections, discs, damping, whole.get("longest_element"))  # type: ignore[arg-type]
    parts: dict[str, list[Any]] = {
        "bearings": _each(
            tables, "magnetic_bearing", problems, lambda entry: _on(rotor, _bearing(_numbered(entry, rotor)))
        ),
        "touchdowns": _each(
            tables, "touchdown", problems, lambda entry: _on(rotor, _plane(_numbered(entry, rotor), not is_rigid))
        ),
        "unbalances": _each(
            tables, "unbalance", problems, lambda entry: _on(rotor, _unbalance(_numbered(entry, rotor)))
        ),
        "supports": _each(tables, "support", problems, lambda entry: _on(rotor, _support(_numbered(entry, rotor)))),
    }
    if not tables.parts.get("touchdown"):
        place = "position" if is_rigid else "node"
        allowed = f"one or more tables, each with its {place}, clearance, rotor_radius, friction and law"
        problems.errors.append(InputError("[[touchdown]]", None, allowed))
    problems.raise_all()
    rooms = {each.clearance for each in parts["touchdowns"]}
    narrowest = min(rooms)
    if len(rooms) == 1:
        parts["touchdowns"] = [replace(each, clearance=None) for each in parts["touchdowns"]]
    machine = FlexibleMachine(rotor, whole.get("speed"), narrowest, gravity=gravity, **parts)  # type: ignore[arg-type]
    others = {name: text for name, text in settings.items() if name not in known}
    problems.errors += [unknown(machine, each, others[each], known) for each in others if each not in machine.varied]
    problems.raise_all()
    machine = machine.replace(**others)
    _warn_of_proportions(machine)
    return machine


def _of_source(tables: MachineTables, whole: Mapping[str, Any], discs: list[Disc]) -> MatrixRotor:
    """The rotor of a file of matrices, beside which there are no sections."""
    given = whole["source"]
    if not isinstance(given, str) or not given:
        raise InputError(
            "source", shown(given), "the path of a file of matrices, .npz or .mat, seen from the machine file"
        )
    if tables.parts.get("section") or "longest_element" in whole:
        found = "[[section]]" if tables.parts.get("section") else "longest_element"
        raise InputError("source", shown(given), f"not allowed beside {found}: the file holds the whole shaft")
    stated = any(name in whole for name in _RENAMED)
    return read_rotor(tables.folder / given, _damping(whole) if stated else None, discs)


def _check_rigid(tables: MachineTables, whole: Mapping[str, Any]) -> None:
    """Refuse what bends beside a rigid rotor."""
    found = [f"[[{kind}]]" for kind in ("section", "disc") if tables.parts.get(kind)]
    found += [name for name in whole if name not in OF_RIGID]
    if found:
        allowed = f"not allowed beside {found[0]}: a [rotor] with a mass is rigid, and has all of its mass and inertias"
        raise InputError("mass", shown(whole.get("mass")), allowed)


def _rigid(whole: Mapping[str, Any], stations: list[float]) -> RigidRotor:
    numbers: dict[str, Any] = {name: whole.get(name) for name in RIGID_FIELDS}
    return RigidRotor(**numbers, stations=stations)


def _at_stations(tables: MachineTables, problems: Problems) -> tuple[MachineTables, list[float]]:
    """Tables of the parts of a rigid rotor, with numbers of stations in place of positions along the shaft, and these stations."""
    read: dict[tuple[str, int], dict[str, Any]] = {}
    for kind, listed in tables.parts.items():
        for number, entry in enumerate(listed, start=1):
            try:
                read[kind, number] = _placed(entry)
            except InputError as problem:
                problems.errors += [
                    InputError(f"[[{kind}]] {number}: {each.field}", each.value, each.allowed)
                    for each in problem.errors
                ]
    stations = sorted({at for places in read.values() for given in places.values() for at in np.atleast_1d(given)})
    parts: dict[str, list[Mapping[str, Any]]] = {kind: [] for kind in tables.parts}
    for (kind, number), places in read.items():
        others = {name: given for name, given in tables.parts[kind][number - 1].items() if name not in _PLACED}
        numbers = {_PLACED[name]: np.searchsorted(stations, given).tolist() for name, given in places.items()}
        parts[kind].append({**numbers, **others})
    return replace(tables, parts=parts), stations


def _placed(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Where a part of a rigid rotor is, and its sensors, m."""
    for name, node in _PLACED.items():
        if node in entry:
            raise InputError(node, shown(entry[node]), f"{name}, from the centre of mass: a rigid rotor has no nodes")
    _needed(entry, ("position",))
    found: dict[str, Any] = {"position": read_quantity(POSITION, entry["position"])}
    if "sensor_positions" in entry:
        given = entry["sensor_positions"]
        listed = given if isinstance(given, list) else [given]
        found["sensor_positions"] = [read_quantity(replace(POSITION, name="sensor_positions"), each) for each in listed]
    return found


def _numbered(entry: Mapping[str, Any], rotor: FreeRotor | None) -> dict[str, Any]:
    """The table of a part with numbers in place of the names of nodes, which a rotor of matrices may have."""
    for name in _PLACED:
        if name in entry:
            raise InputError(
                name,
                shown(entry[name]),
                f"{_PLACED[name]}: only a rigid rotor, with its mass in [rotor], has positions",
            )
    if not isinstance(rotor, MatrixRotor):
        return dict(entry)

    def number(given: Any) -> Any:
        return rotor.node_of(given) if isinstance(given, str) else given

    sensors = entry.get("sensor_nodes")
    numbers = {"sensor_nodes": list(map(number, sensors))} if isinstance(sensors, list) else {}
    return {**entry, **({"node": number(entry["node"])} if "node" in entry else {}), **numbers}


def _on(rotor: FreeRotor | None, part: _Part) -> _Part:
    """The part, all of whose nodes the shaft has; without a shaft, which has errors of its own, they are not known."""
    if rotor is not None:
        places: Any = part
        rotor.check_node("node", places.node)
        for node in getattr(part, "sensor_nodes", ()):
            rotor.check_node("sensor_nodes", node)
    return part


def _warn_of_proportions(machine: FlexibleMachine) -> None:
    """Warn of what no rotor looks like: a number without a unit is in metres, not in millimetres."""
    rotor, rooms = machine.rotor, machine.clearances
    sections = rotor.sections if isinstance(rotor, FlexibleRotor) else ()
    length = float(np.ptp(rotor.places))
    told = [
        f"[[section]] {number}: outer_diameter = {each.outer_diameter:g} m: thicker than the shaft is long, {length:.4g} m"
        for number, each in enumerate(sections, start=1)
        if each.outer_diameter > length
    ]
    told += [
        f"[[section]] {number}: length = {each.length:g} m: more than {SLENDEREST:g} times its diameter"
        for number, each in enumerate(sections, start=1)
        if each.length > SLENDEREST * each.outer_diameter
    ]
    told += [
        f"[[touchdown]] {number}: rotor_radius = {each.rotor_radius:g} m: less than {LEAST_RADIUS:g} clearances of {room:g} m"
        for number, (each, room) in enumerate(zip(machine.touchdowns, rooms, strict=True), start=1)
        if each.rotor_radius < LEAST_RADIUS * room
    ]
    if told:
        text = f"{'; '.join(told)}: check the units (a number without a unit is in m)"
        warnings.warn(text, CaromWarning, stacklevel=4)


def _each(tables: MachineTables, kind: str, problems: Problems, read: Callable[[dict[str, Any]], _Part]) -> list[_Part]:
    """The parts of all tables of a kind; errors name their table."""
    found: list[_Part] = []
    listed = tables.parts.get(kind, [])
    if len(listed) > MOST_ELEMENTS:
        advice = "; neighbouring sections of one diameter are one section" if kind == "section" else ""
        allowed = f"at most {MOST_ELEMENTS} tables{advice}"
        problems.errors.append(InputError(f"[[{kind}]]", f"{len(listed)} tables", allowed))
        return found
    for number, entry in enumerate(listed, start=1):
        known = PART_ENTRIES[kind]
        errors = [unknown_name(name, given, known, f"[[{kind}]]") for name, given in entry.items() if name not in known]
        try:
            part = read({name: given for name, given in entry.items() if name in known})
        except InputError as problem:
            errors += problem.errors
        else:
            found.append(part)
        problems.errors += [
            InputError(f"[[{kind}]] {number}: {each.field}", each.value, each.allowed) for each in errors
        ]
    return found


def _of(entry: Mapping[str, Any], names: Iterable[str]) -> dict[str, Any]:
    return {name: entry[name] for name in names if name in entry}


def _needed(entry: Mapping[str, Any], names: Iterable[str]) -> None:
    """Refuse a table without one of these entries."""
    for name in names:
        if name not in entry:
            raise InputError(name, None, "must be stated")


def _material(entry: Mapping[str, Any], usual: Material) -> Material:
    """Material of a table, whose other numbers are as usual."""
    given = _of(entry, MATERIAL_FIELDS)
    return Material(**{name: given.get(name, getattr(usual, name)) for name in MATERIAL_FIELDS})


def _section(entry: Mapping[str, Any], steel: Material) -> Section:
    _needed(entry, ("length", "outer_diameter"))
    return Section(**_of(entry, SECTION_FIELDS), material=_material(entry, steel))


def _disc(entry: dict[str, Any], steel: Material) -> Disc:
    _needed(entry, ("node",))
    if "width" in entry:
        return Disc.of_body(entry["node"], _section({**entry, "length": entry["width"]}, steel))
    _needed(entry, DISC_FIELDS)
    return Disc(**_of(entry, ("node", *DISC_FIELDS)))


def _bearing(entry: dict[str, Any]) -> MagneticBearing:
    _needed(entry, ("node", "ki", "ks"))
    ways = {"proportional": PID_FIELDS, "numerator": _QUOTIENT, "A": _MATRICES}
    stated = [way for way, names in ways.items() if any(name in entry for name in names)]
    if len(stated) != 1:
        allowed = (
            "one of: proportional (with integral, derivative, filter_time), numerator and denominator, or A, B, C and D"
        )
        raise InputError("controller", ", ".join(stated) or None, allowed)
    given = _of(entry, ways[stated[0]])
    _needed(given, {"proportional": ("proportional",), "numerator": _QUOTIENT, "A": _MATRICES}[stated[0]])
    kinds: dict[str, Callable[..., Any]] = {"proportional": PID, "numerator": TransferFunction, "A": StateSpace}
    return MagneticBearing(
        **_of(entry, ("node", "sensor_nodes", "at_regain", *BEARING_FIELDS)), controller=kinds[stated[0]](**given)
    )


def _plane(entry: dict[str, Any], bends: bool) -> TouchdownPlane:
    _needed(entry, ("node", "law", "rotor_radius", "friction", "clearance"))
    if bends and entry["law"] == "rigid":
        raise InputError(
            "law", "rigid", f"must be one of {', '.join(LAWS[1:])}: a rigid wall has no answer on a rotor that bends"
        )
    bearing = TouchdownBearing(**_of(entry, ("law", *TOUCHDOWN_FIELDS)))
    return TouchdownPlane(entry["node"], bearing, **_of(entry, PLANE_FIELDS))


def _support(entry: dict[str, Any]) -> Support:
    _needed(entry, ("node", "kxx", "kyy"))
    return Support(**entry)


def _unbalance(entry: dict[str, Any]) -> Unbalance:
    _needed(entry, ("node", "size"))
    return Unbalance(**entry)


def _damping(whole: Mapping[str, Any]) -> ModalDamping | ProportionalDamping:
    """Damping by the entries of ``[rotor]``, one of which has to be there."""
    modal, proportional = (
        {_RENAMED[name]: whole[name] for name in _RENAMED if name in whole and _RENAMED[name] in fields}
        for fields in (MODAL_FIELDS, PROPORTIONAL_FIELDS)
    )
    if bool(modal) == bool(proportional):
        allowed = "damping_ratio (of all bending modes, such as 0.005), or damping_of_mass and damping_of_stiffness"
        raise InputError("damping", None if not modal else "both", f"one of: {allowed}")
    try:
        return ModalDamping(**modal) if modal else ProportionalDamping(**proportional)
    except InputError as problem:
        entries = {number: name for name, number in _RENAMED.items()}
        told = [InputError(entries.get(each.field, each.field), each.value, each.allowed) for each in problem.errors]
        raise together(told) from None
