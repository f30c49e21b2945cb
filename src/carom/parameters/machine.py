"""The machine in SI units, and the conversion to the dimensionless parameters and back."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from carom.base.arguments import NotNegative, Positive, checked
from carom.base.outcome import CaromWarning, InputError, shown
from carom.base.tabular import Tabular
from carom.parameters.fields import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, PHYSICAL_PARTNER
from carom.parameters.formats import format_entry, number
from carom.parameters.numbers import Parameters
from carom.parameters.scaling import CONVERSIONS, Scales
from carom.parameters.tables import toml_line
from carom.parameters.terms import DEFAULTS, ENTRIES, HELPER_FIELDS, Resolved, resolve

LEAST_RADIUS = 5.0
"""Rotor radius in clearances below which a machine file probably has a wrong unit; touchdown bearings have 20 to 1000."""


@checked
@dataclass(frozen=True)
class ControlLimit:
    """The largest control force ``ki i`` of all magnetic bearings of the planar rotor together, along each of two perpendicular axes.

    The controller asks for ``(k + pull) z + c ż`` with the stiffness and the damping of the levitation, and gets no more than this force along
    an axis.  The magnets pull the rotor away from the centre, whatever the current, by ``pull`` times its displacement.

    Attributes
    ----------
    force : float
        N.
    pull : float
        Size of the negative stiffness of all bearings, N/m.
    """

    force: Positive
    pull: NotNegative = 0.0

    @property
    def words(self) -> str:
        """Both in the units of people."""
        pull = f" against a negative stiffness of {number(self.pull)} N/m" if self.pull else ""
        return f"a control force of at most {number(self.force)} N along each axis{pull}"


class Machine(Tabular):
    """A rotor, its levitation and its touchdown bearing, in SI units.

    Every value is a number in the SI unit below, or text with a unit such as ``"1759 rpm"`` or ``"0.3 mm"``; a number
    in quotes without a unit is in the SI unit too. The ranges are those of
    :data:`carom.parameters.fields.MACHINE_FIELDS`. Instances are immutable and hashable.

    Parameters
    ----------
    mass : float or str
        Rotor mass m, kg.
    damping : float or str
        Damping c of the levitation, N s/m; not negative.
    stiffness : float or str
        Stiffness k of the levitation, N/m.
    eccentricity : float or str
        Distance e_c of the mass centre from the geometric centre, m.
    clearance : float or str
        Radius c_r of the circle in which the rotor centre is free to move, m.
    rotor_radius : float or str
        Radius R of the rotor where it touches, m.
    speed : float or str
        Rotational speed Ω, rad/s; text in rpm, rev/s, rad/s or deg/s.
    unbalance_phase : float or str, optional
        Phase φ of the unbalance, rad; 0 by default.  It fixes from where angles on the rotor are counted, and under weight where the unbalance
        is at time zero; shares and smallest sizes do not depend on it, since disturbances are drawn at any instant of the turn.
    friction : float or str
        Coefficient μ of friction between rotor and touchdown bearing.
    restitution : float or str
        Coefficient d of restitution of the impacts, 0 to 1.
    magnetic_bearings : float or str, optional
        Number n of equal magnetic bearings; 1 by default.
    force_current_factor, negative_stiffness : float or str, optional
        Force a current ki (N/A) and size ks of the negative stiffness (N/m, not negative) of one of them.
    force_limit, current_limit : float or str, optional
        Largest force (N) and control current (A) of one of them.
    air_gap : float or str, optional
        Radial air gap s0 of their magnets (m), larger than the clearance: a rotor that is there reaches them.
    internal_damping : float or str, optional
        Damping c_i that turns with the shaft (N s/m), such as that of its material: it acts on the velocity that the shaft sees.

    Raises
    ------
    InputError
        If a field is missing, unknown, of another dimension, out of range, or given in two ways, or if the machine as a
        whole has a dimensionless parameter out of range.  It reports all errors at once.

    Notes
    -----
    A field may be given by an entry of :data:`carom.parameters.TERM_FIELDS` instead, such as ``eccentricity`` by
    ``unbalance="15 g mm"`` or ``balance_grade="G 2.5"``; the formulas are those of :data:`carom.parameters.TERMS`.
    """

    mass: float
    damping: float
    stiffness: float
    eccentricity: float
    clearance: float
    rotor_radius: float
    speed: float
    unbalance_phase: float
    friction: float
    restitution: float
    magnetic_bearings: float = DEFAULTS["magnetic_bearings"]
    force_current_factor: float | None = None
    negative_stiffness: float | None = None
    force_limit: float | None = None
    current_limit: float | None = None
    air_gap: float | None = None
    internal_damping: float | None = None
    _resolved: Resolved

    def __init__(self, /, **entries: object) -> None:
        self._fill(resolve(entries), entries)

    def _fill(self, resolved: Resolved, entries: Mapping[str, object]) -> None:
        vars(self).update(resolved.values, _resolved=resolved)
        if self.air_gap is not None and self.air_gap <= self.clearance:
            allowed = f"larger than the clearance, {format_entry('clearance', self.clearance, 6)}: a rotor in contact would reach the magnets"
            raise InputError("air_gap", shown(entries.get("air_gap", self.air_gap)), allowed)
        try:
            self.parameters  # noqa: B018
        except InputError as problem:
            raise self._out_of_proportion(problem, entries) from None

    def _out_of_proportion(self, problem: InputError, entries: Mapping[str, object]) -> InputError:
        """The error of a dimensionless parameter, as one of the entry that it follows from."""
        field = PHYSICAL_PARTNER[problem.field]
        value = getattr(self, field)
        gives = f"gives {problem.field} = {DIMENSIONLESS_FIELDS[problem.field].formula} = {problem.value}, which {problem.allowed}"
        source = self._resolved.source(field) or field
        if source == field or source not in entries:
            return InputError(field, shown(entries.get(field, value)), gives)
        unit = MACHINE_FIELDS[field].unit
        return InputError(source, shown(entries[source]), f"gives {field} = {value:.6g} {unit}, which {gives}")

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a machine is frozen: machine.replace({name}=...) returns another")

    def __eq__(self, other: object) -> bool:
        """Whether all numbers are equal, whatever they were given by."""
        return isinstance(other, Machine) and self._resolved.values == other._resolved.values

    def __hash__(self) -> int:
        return hash(tuple(self._resolved.values.values()))

    def rows(self) -> list[tuple[str, str]]:
        """What the machine has in the units of people; beside it the symbol of the equations, and the entry of the file that gave it."""
        shown_names = [name for name in MACHINE_FIELDS if name not in DEFAULTS or name in self.given]
        shown_names += [name for name in HELPER_FIELDS if name in self.given]
        return [(ENTRIES[name].words, self._row(name)) for name in shown_names]

    def _row(self, name: str) -> str:
        text, numbers = format_entry(name, getattr(self, name), 6), self.parameters
        beside = [
            f"{DIMENSIONLESS_FIELDS[own].symbol} = {number(getattr(numbers, own))}"
            for own, partner in PHYSICAL_PARTNER.items()
            if partner == name and own not in ("mu", "d", "phi")
        ]
        entry, written = next(iter(self.given_texts.get(name, {}).items()), (name, ""))
        if entry != name:
            beside.append(f"given as {entry} = {written}")
        elif re.search("[a-z]", written, re.IGNORECASE) and not written.endswith(ENTRIES[name].usual_unit):
            beside.append(f"given as {written}")
        return f"{text} ({'; '.join(beside)})" if beside else text

    @property
    def values(self) -> Mapping[str, float]:
        """All numbers that are stated, or have a default, in SI units."""
        return self._resolved.values

    @property
    def given(self) -> Mapping[str, Mapping[str, object]]:
        """For each number the entries that gave it, as they were written, the one that sets it first.

        A number that was not given, and has its default, is left out.  ``{"eccentricity": {"unbalance": "15 g mm",
        "mass": "2 kg"}}`` says that the eccentricity is the quotient of the two; a mass that was set later does not
        change it.
        """
        return self._resolved.given

    @property
    def scales(self) -> Scales:
        """Mass, clearance and speed as units of everything else."""
        return Scales(self.mass, self.clearance, self.speed)

    @property
    def parameters(self) -> Parameters:
        """Dimensionless parameters of this machine, with its scales; (2.12) of the source paper."""
        scales = self.scales
        numbers = {
            name: CONVERSIONS[name].number(getattr(self, physical), scales)
            for name, physical in PHYSICAL_PARTNER.items()
        }
        return Parameters(**numbers, scales=scales)

    @property
    def given_texts(self) -> dict[str, dict[str, str]]:
        """What :attr:`given` holds, as texts that can be shown anywhere."""
        return {name: {entry: shown(value) for entry, value in given.items()} for name, given in self.given.items()}

    @property
    def control_limit(self) -> ControlLimit | None:
        """Largest control force of all magnetic bearings together; ``None`` without a limit of force or current."""
        factor = self.force_current_factor or 0.0
        of_current = math.inf if self.current_limit is None else factor * self.current_limit
        force = min(math.inf if self.force_limit is None else self.force_limit, of_current)
        if force == math.inf:
            return None
        return ControlLimit(self.magnetic_bearings * force, self.magnetic_bearings * (self.negative_stiffness or 0.0))

    def replace(self, /, **changes: object) -> Machine:
        """Return a copy with other values, physical or dimensionless.

        Parameters
        ----------
        **changes
            New values by the names of machine fields, of terms that stand for them, or of dimensionless parameters.
            Mass, speed and clearance are set first, then the stiffness, then all others.  A dimensionless number sets
            its partner (``gamma`` sets ``damping``, ``omega`` ``stiffness``, ``rho`` ``eccentricity``, ...), as closely
            as doubles allow.  A field that is not set keeps its value in SI units, but one that follows from a
            controller gain, a force-current factor or a rated speed follows again if one of those is set.

        Raises
        ------
        InputError
            If a name is unknown, a value not allowed, or a field is set in two ways.
        """
        machine = Machine.__new__(Machine)
        machine._fill(resolve(changes, self._resolved), changes)
        return machine

    def to_toml(self) -> str:
        """Return the text of a machine file that :func:`carom.load` reads back as an equal machine.

        It holds the entries as they were written, if they still give this machine, and otherwise numbers in SI units.
        """
        written = {name: value for given in self.given.values() for name, value in given.items()}
        written = {name: written[name] for name in ENTRIES if name in written}
        try:
            same = Machine(**written) == self
        except InputError:
            same = False
        entries = written if same else dict(self._resolved.values)
        return "\n".join(["[machine]", *(_line(name, value) for name, value in entries.items())]) + "\n"


def warn_of_proportions(machine: Machine | None) -> None:
    """Warn of a clearance that leaves no shaft: a number without a unit is in metres, not in millimetres."""
    if machine is None or machine.rotor_radius >= LEAST_RADIUS * machine.clearance:
        return
    given = machine.given_texts
    if "radius_ratio" in given["rotor_radius"]:  # set on purpose, and has no unit
        return
    written = ", ".join(
        f"{entry} = {text}" for name in ("clearance", "rotor_radius") for entry, text in given[name].items()
    )
    ratio = machine.rotor_radius / machine.clearance
    warnings.warn(
        f"{written}: a rotor radius of {ratio:.3g} clearances; touchdown bearings have 20 to 1000: check the units "
        "(a number without a unit is in m)",
        CaromWarning,
        stacklevel=3,
    )


def _line(name: str, value: Any) -> str:
    field = ENTRIES[name]
    if not isinstance(value, str):
        plain = int(value) if field.whole else float(value)
        value = f"{plain!r} {field.unit}" if field.unit else plain
    return toml_line(name, value, f"{field.symbol}: {field.words}")
