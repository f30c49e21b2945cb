"""Read a rotor of several parts from the tables of a machine file."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import CaromWarning, InputError, Problems, shown
from carom.parameters import Gravity, read_quantity
from carom.parameters.fields import unknown_name
from carom.parameters.machine import LEAST_RADIUS
from carom.parameters.machine_file import Fields, check_limits, read_beside, split_settings
from carom.parameters.toml_reader import MachineTables, read_machine_tables
from carom.parameters.touchdown_bearing import LAWS
from carom.rotors.flexible_machine import ACCURACY, FlexibleMachine
from carom.rotors.flexible_rotor import MOST_ELEMENTS, FlexibleRotor
from carom.rotors.free_rotor import FreeRotor
from carom.rotors.matrix_rotor import MatrixRotor
from carom.rotors.part_tables import (
    ATTACHED,
    PARTS,
    PLACED,
    RENAMED,
    ROTOR_ENTRIES,
    damping_of,
    entries_in,
    internal_of,
    require,
)
from carom.rotors.rigid_body import POSITION, RIGID_FIELDS, RigidRotor
from carom.rotors.rotor_files import read_controller, read_rotor
from carom.rotors.shaft_parts import MATERIAL_FIELDS, Disc, Material

OF_RIGID = ("speed", "clearance", *RIGID_FIELDS)
"""Entries of ``[rotor]`` where it states the mass of a rigid rotor."""
REDUCED = ("accuracy", "modes")
"""Entries of ``[rotor]`` that say how many vectors the machine is reduced to, one of which may be stated."""
SLENDEREST = 500.0
"""Length over diameter of a section beyond which a unit was probably forgotten."""


def read_rotor_tables(tables: MachineTables, settings: Mapping[str, str], beside: Fields, problems: Problems) -> Fields:
    """The reduced machine that levitates, as a model, of a file with a ``[rotor]`` table: attributes of its case.

    Raises
    ------
    InputError
        An entry cannot be used: each error names its table, numbered from 1 where there are several; or the machine does not levitate.

    Warns
    -----
    CaromWarning
        A section is thicker than the shaft is long, or thinner than a wire, or the rotor radius is less than 5 clearances: a unit was probably forgotten.
    """
    stated = entries_in(settings, REDUCED) or tables.values
    name = next((name for name in REDUCED if name in stated), "accuracy")
    wanted = problems.attempt(read_quantity, ROTOR_ENTRIES[name], stated.get(name, ACCURACY))
    machine = _read_machine(tables, settings, beside["gravity"], problems)
    check_limits(beside["limits"], [each.bearing for each in machine.touchdowns])
    reduced = machine.with_modes(int(wanted or 1)) if name == "modes" else machine.reduce(wanted or ACCURACY)
    return {"parameters": reduced.limited, "machine": None, "gravity": machine.gravity}


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
    carom.rotors.find_whirls, carom.rotors.sensitivity, carom.rotors.synchronous_response : does it levitate well?

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.rotors.load_machine("examples/tum-flexible-rotor.toml", ["speed=6000 rpm"])
    >>> machine.reduce().vectors
    13
    """
    problems = Problems()
    tables = read_machine_tables(path, problems)
    texts = split_settings(settings, problems)
    if tables.kind != "rotor":
        problems.errors.append(InputError("machine file", shown(path), f"a [rotor] table; it holds [{tables.kind}]"))
        problems.raise_all()
    return _read_machine(tables, texts, read_beside(tables, problems)["gravity"], problems)


def _read_machine(
    tables: MachineTables, settings: Mapping[str, str], gravity: Gravity | None, problems: Problems
) -> FlexibleMachine:
    """The machine of a file, after all errors, those known before too, are raised."""
    whole = dict(tables.values)
    is_rigid = not RIGID_FIELDS.keys().isdisjoint(whole)
    known = {name: field for name, field in ROTOR_ENTRIES.items() if is_rigid or name not in RIGID_FIELDS}
    own = {name: text for name, text in settings.items() if name in known and name != "clearance"}
    whole |= own
    problems.errors += [
        unknown_name(each, given, ROTOR_ENTRIES, "[rotor]") for each, given in whole.items() if each not in known
    ]
    stations: list[float] = []
    if is_rigid:
        problems.attempt(_check_rigid, tables, whole)
        problems.raise_all()
        tables, stations = _at_stations(tables, problems)
    rotor = _read_rotor(tables, whole, stations if is_rigid else None, problems)
    everywhere = whole.get("clearance")

    def completed(entry: dict[str, object], kind: str) -> dict[str, object]:
        usual = {"clearance": None} if kind == "touchdown" and everywhere is not None else {}
        return _numbered(usual | entry, rotor, not is_rigid)

    parts = {name: _each(tables, kind, problems, completed, rotor) for name, kind in ATTACHED.items()}
    if not tables.parts.get("touchdown"):
        place = "position" if is_rigid else "node"
        allowed = f"one or more tables, each with its {place}, clearance, rotor_radius, friction and law"
        problems.errors.append(InputError("[[touchdown]]", None, allowed))
    problems.raise_all()
    if everywhere is None:
        rooms = {each.clearance for each in parts["touchdowns"]}
        everywhere = min(rooms)
        if len(rooms) == 1:
            parts["touchdowns"] = [replace(each, clearance=None) for each in parts["touchdowns"]]
    machine = FlexibleMachine(rotor, whole.get("speed"), everywhere, gravity=gravity, **parts)  # type: ignore[arg-type]
    others = {name: text for name, text in settings.items() if name not in own}
    problems.errors += [machine.unknown(each, others[each], known) for each in others if each not in machine.varied]
    problems.raise_all()
    machine = machine.replace(**others)
    _warn_of_proportions(machine)
    return machine


def _read_rotor(
    tables: MachineTables, whole: Mapping[str, Any], stations: list[float] | None, problems: Problems
) -> FreeRotor | None:
    """The rotor itself: rigid with stations, of a file of matrices, or of sections; ``None`` if it has errors."""
    steel = vars(problems.attempt(lambda: Material(**entries_in(whole, MATERIAL_FIELDS))) or Material())
    everywhere = steel | entries_in(whole, ("axial_force",))

    def of_material(entry: dict[str, object], _: str) -> dict[str, object]:
        # A shear modulus is that of its own elastic modulus.
        return everywhere | ({"shear_modulus": None} if "elastic_modulus" in entry else {}) | entry

    discs = _each(tables, "disc", problems, of_material)
    if stations is not None:
        numbers: dict[str, Any] = {name: whole.get(name) for name in RIGID_FIELDS}
        return problems.attempt(lambda: RigidRotor(**numbers, stations=stations)) if stations else None
    if "source" in whole:
        return problems.attempt(_of_source, tables, whole, discs)
    sections = _each(tables, "section", problems, of_material)
    if not tables.parts.get("section"):
        allowed = "one or more tables, each with its length and outer_diameter; or [rotor] source = a file of matrices"
        problems.errors.append(InputError("[[section]]", None, allowed))
    damping, internal = problems.attempt(damping_of, whole), problems.attempt(internal_of, whole)
    if problems.errors or damping is None:
        return None
    return FlexibleRotor(sections, discs, damping, whole.get("longest_element"), internal)


def _of_source(tables: MachineTables, whole: Mapping[str, object], discs: list[Disc]) -> MatrixRotor:
    """The rotor of a file of matrices, beside which there are no sections."""
    given = whole["source"]
    if not isinstance(given, str) or not given:
        allowed = "the path of a file of matrices, .npz or .mat, seen from the machine file"
        raise InputError("source", shown(given), allowed)
    sections = ["[[section]]"] if tables.parts.get("section") else []
    if beside := [*sections, *entries_in(whole, ("longest_element", "axial_force"))]:
        raise InputError("source", shown(given), f"not allowed beside {beside[0]}: the file holds the whole shaft")
    own = damping_of(whole) if entries_in(whole, RENAMED) else None
    return read_rotor(tables.folder / given, own, discs, internal_of(whole))


def _check_rigid(tables: MachineTables, whole: Mapping[str, object]) -> None:
    """Refuse what bends beside a rigid rotor."""
    found = [f"[[{kind}]]" for kind in ("section", "disc") if tables.parts.get(kind)]
    found += [name for name in whole if name not in OF_RIGID]
    if found:
        allowed = f"not allowed beside {found[0]}: a [rotor] with a mass is rigid, and has all of its mass and inertias"
        raise InputError("mass", shown(whole.get("mass")), allowed)


def _at_stations(tables: MachineTables, problems: Problems) -> tuple[MachineTables, list[float]]:
    """Tables of the parts of a rigid rotor, with numbers of stations in place of positions along the shaft, and these stations."""
    read: dict[tuple[str, int], dict[str, Any]] = {}
    for kind, listed in tables.parts.items():
        for number, entry in enumerate(listed, start=1):
            try:
                read[kind, number] = _placed(entry) if "node" in PARTS[kind].needed else {}
            except InputError as problem:
                problems.errors += problem.under(f"[[{kind}]] {number}: ").errors
    stations = sorted({at for places in read.values() for given in places.values() for at in np.atleast_1d(given)})
    parts: dict[str, list[Mapping[str, Any]]] = {kind: [] for kind in tables.parts}
    for (kind, number), places in read.items():
        others = {name: given for name, given in tables.parts[kind][number - 1].items() if name not in PLACED}
        numbers = {PLACED[name]: np.searchsorted(stations, given).tolist() for name, given in places.items()}
        parts[kind].append({**numbers, **others})
    return replace(tables, parts=parts), stations


def _placed(entry: Mapping[str, object]) -> dict[str, object]:
    """Where a part of a rigid rotor is, and its sensors, m."""
    for name, node in PLACED.items():
        if node in entry:
            raise InputError(node, shown(entry[node]), f"{name}, from the centre of mass: a rigid rotor has no nodes")
    require(entry, ("position",))
    found: dict[str, object] = {"position": read_quantity(POSITION, entry["position"])}
    if "sensor_positions" in entry:
        given = entry["sensor_positions"]
        listed = given if isinstance(given, list) else [given]
        found["sensor_positions"] = [read_quantity(replace(POSITION, name="sensor_positions"), each) for each in listed]
    return found


def _numbered(entry: Mapping[str, object], rotor: FreeRotor | None, bends: bool) -> dict[str, object]:
    """The table of a part with numbers in place of the names of nodes, which a rotor of matrices may have."""
    for name in PLACED:
        if name in entry:
            allowed = f"{PLACED[name]}: only a rigid rotor, with its mass in [rotor], has positions"
            raise InputError(name, shown(entry[name]), allowed)
    if bends and entry.get("law") == "rigid":
        allowed = f"must be one of {', '.join(LAWS[1:])}: a rigid wall has no answer on a rotor that bends"
        raise InputError("law", "rigid", allowed)
    if not isinstance(rotor, MatrixRotor):
        return dict(entry)

    def number(given: object) -> Any:
        return rotor.node_of(given) if isinstance(given, str) else given

    sensors = entry.get("sensor_nodes")
    numbers = {"sensor_nodes": list(map(number, sensors))} if isinstance(sensors, list) else {}
    return {**entry, **({"node": number(entry["node"])} if "node" in entry else {}), **numbers}


def _warn_of_proportions(machine: FlexibleMachine) -> None:
    """Warn of what no rotor looks like: a number without a unit is in metres, not in millimetres."""
    rotor, rooms = machine.rotor, machine.clearances
    sections = rotor.sections if isinstance(rotor, FlexibleRotor) else ()
    length = float(np.ptp(rotor.places))
    stated = []
    for number, each in enumerate(sections, start=1):
        wide, where = each.outer_diameter, f"[[section]] {number}: "
        if wide > length:
            stated.append(f"{where}outer_diameter = {wide:g} m: thicker than the shaft is long, {length:.4g} m")
        if each.length > SLENDEREST * wide:
            stated.append(f"{where}length = {each.length:g} m: more than {SLENDEREST:g} times its diameter")
    for number, (plane, room) in enumerate(zip(machine.touchdowns, rooms, strict=True), start=1):
        if plane.rotor_radius < LEAST_RADIUS * room:
            few = f"less than {LEAST_RADIUS:g} clearances of {room:g} m"
            stated.append(f"[[touchdown]] {number}: rotor_radius = {plane.rotor_radius:g} m: {few}")
    if stated:
        text = f"{'; '.join(stated)}: check the units (a number without a unit is in m)"
        warnings.warn(text, CaromWarning, stacklevel=5)


def _with_controllers(entry: Mapping[str, object], folder: Path) -> dict[str, object]:
    """A table, with all below it, in which the controllers of files stand in place of the entries ``source``."""
    found: dict[str, object] = {}
    for name, given in entry.items():
        if isinstance(given, Mapping):
            found[name] = _with_controllers(given, folder)
        elif name == "filter" and isinstance(given, list):
            found[name] = [_with_controllers(each, folder) if isinstance(each, Mapping) else each for each in given]
        elif name != "source":
            found[name] = given
        elif not isinstance(given, str) or not given:
            raise InputError(name, shown(given), "the path of a .mat or .npz file, seen from the machine file")
        else:
            own = read_controller(folder / given)
            if beside := [each for each in own if each in entry]:
                raise InputError(name, shown(given), f"not allowed beside {beside[0]}, which the file holds too")
            found |= own
    return found


def _each(
    tables: MachineTables,
    kind: str,
    problems: Problems,
    completed: Callable[[dict[str, Any], str], dict[str, Any]],
    rotor: FreeRotor | None = None,
) -> list[Any]:
    """The parts of all tables of a kind, at nodes that the rotor has if it is known; errors name their table."""
    found, listed, table = list[Any](), tables.parts.get(kind, []), PARTS[kind]
    if len(listed) > MOST_ELEMENTS:
        advice = "; neighbouring sections of one diameter are one section" if kind == "section" else ""
        allowed = f"at most {MOST_ELEMENTS} tables{advice}"
        problems.errors.append(InputError(f"[[{kind}]]", f"{len(listed)} tables", allowed))
        return found

    def made(entry: Mapping[str, Any]) -> Any:
        whole = completed(_with_controllers(entries_in(entry, table.entries), tables.folder), kind)
        require(whole, table.needed)
        part = table.make(whole)
        if rotor is not None and "node" in table.needed:
            rotor.check_node("node", part.node)
            for node in getattr(part, "sensor_nodes", ()):
                rotor.check_node("sensor_nodes", node)
        return part

    for number, entry in enumerate(listed, start=1):
        own, where = Problems(), f"[[{kind}]] {number}: "
        for name in [name for name in entry if name not in table.entries]:
            own.errors.append(unknown_name(name, entry[name], table.entries, f"[[{kind}]]"))
        found.append(own.attempt(made, entry))
        problems.errors += [each.under(where) for each in own.errors]
    return [each for each in found if each is not None]
