"""The numbers that describe a machine: their names, symbols, units and the ranges that carom can treat.

Tables, error messages and the command line all use these entries, so each name and limit is defined once.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown

RPM = math.pi / 30.0
"""One revolution per minute in rad/s."""
_LONGEST_NAME = 60
_MOST_SUGGESTIONS = 100


@dataclass(frozen=True)
class Field:
    """One number of a machine: what it is called, its SI unit and its range.

    Parameters
    ----------
    name : str
        Name in a machine file, on the command line and in Python.
    symbol : str
        Symbol of the source paper, for tables and figures.
    words : str
        Description in words.
    kind : str
        Kind of quantity, with its article ("a mass"), for error messages.
    unit : str
        SI unit; empty for a pure number.
    lowest, highest : float
        Range of the number in that unit, both ends allowed.
    example : str
        A value as a user would write it in a machine file.
    zero : bool
        Whether zero is allowed too although it lies outside the range.
    formula : str
        Definition of a dimensionless number by physical ones.
    bare : str
        Unit of a number that is given without one; by default the SI unit.
    usual : str
        Unit in which people usually say it, such as ``"mm"``; by default the SI unit.
    usual_size : float
        That unit in the SI unit.
    letter : str
        Letter that may precede the number in place of a unit: ``"G"`` of a balance quality grade.
    whole : bool
        Whether it must be a whole number.
    needs_unit : bool
        Whether text without a unit is refused, as on the command line of a machine in SI units.
    """

    name: str
    symbol: str
    words: str
    kind: str
    unit: str
    lowest: float
    highest: float
    example: str
    zero: bool = False
    formula: str = ""
    bare: str = ""
    usual: str = ""
    usual_size: float = 1.0
    letter: str = ""
    whole: bool = False
    needs_unit: bool = False

    @property
    def usual_unit(self) -> str:
        """Unit for tables and figures; empty for a pure number."""
        return self.usual or self.unit

    def in_usual_unit(self, value: float) -> float:
        """Return a value given in the SI unit in the unit for tables and figures."""
        return value / self.usual_size

    @property
    def allowed(self) -> str:
        """What a user may write here, as the end of an error message."""
        limits = f"{self.lowest:g} to {self.highest:g}"
        if self.zero:
            limits = f"{'<=' if self.highest < 0 else '>='} 0 (0, or {limits})"
        elif self.lowest > 0:
            limits = f"> 0 ({limits})"
        unit = f" in {self.unit}" if self.unit else ""
        bare = "" if self.needs_unit else self.bare or self.unit
        bare = f" (a number without a unit is in {bare})" if bare else ""
        return f"must be {self.kind}{unit}, {limits}, such as {self.example}{bare}"

    def contains(self, number: float) -> bool:
        """Whether a number in the field's SI unit is allowed; false for NaN."""
        return (self.zero and number == 0.0) or self.lowest <= number <= self.highest

    def error(self, given: object, reason: str = "") -> InputError:
        """Error for a value that cannot be used; `reason` says what is wrong with it beyond its range."""
        return InputError(self.name, shown(given), f"{self.allowed}; {reason}" if reason else self.allowed)

    def check(self, number: float, given: object) -> float:
        """Return a number in the field's SI unit if it is finite and in range, a negative zero as zero; otherwise raise an error.

        ``given`` is what the user wrote, for the message.
        """
        if not math.isfinite(number):
            raise self.error(given, "this is not a finite number")
        if not self.contains(number):
            raise self.error(given, "this is too close to 0" if self.zero and 0 < number < self.lowest else "")
        if self.whole and number != int(number):
            raise self.error(given)
        return number + 0.0


def by_name(*fields: Field) -> dict[str, Field]:
    """Fields by their names."""
    return {field.name: field for field in fields}


def length_field(
    name: str, symbol: str, words: str, lowest: float, highest: float, example: str, zero: bool = False
) -> Field:
    """A length in m, which people say in mm."""
    return Field(name, symbol, words, "a length", "m", lowest, highest, example, zero, usual="mm", usual_size=1e-3)


def speed_field(name: str, symbol: str, words: str, example: str) -> Field:
    """A speed of the shaft in rad/s, which people say in rpm."""
    return Field(name, symbol, words, "an angular speed", "rad/s", 1e-6, 1e6, example, usual="rpm", usual_size=RPM)


def _pure(name: str, symbol: str, words: str, lowest: float, highest: float, example: str, formula: str = "") -> Field:
    return Field(name, symbol, words, "a number", "", lowest, highest, example, formula=formula)


# Ranges: far wider than any machine from a micro-turbine to a hydro generator, and narrow enough that every
# product the scaling needs (mass * speed**2 and the like) stays a normal double with all its digits.
MACHINE_FIELDS: Mapping[str, Field] = by_name(
    Field("mass", "m", "rotor mass", "a mass", "kg", 1e-9, 1e9, '"50 kg"'),
    Field("damping", "c", "damping of the levitation", "a damping", "N s/m", 1e-30, 1e30, '"1400 N s/m"', zero=True),
    Field("stiffness", "k", "stiffness of the levitation", "a stiffness", "N/m", 1e-30, 1e30, '"9.8e5 N/m"'),
    length_field("eccentricity", "e_c", "eccentricity of the unbalance", 1e-30, 1e6, '"0.3 mm"', zero=True),
    length_field("clearance", "c_r", "radius of the clearance circle", 1e-9, 1e3, '"0.7 mm"'),
    length_field("rotor_radius", "R", "rotor radius at the contact", 1e-9, 1e6, '"40 mm"'),
    speed_field("speed", "Ω", "rotational speed", '"1759 rpm"'),
    # Beyond a million radians the spacing of doubles becomes visible in the angle: such a value is a typing error.
    Field("unbalance_phase", "φ", "phase of the unbalance", "an angle", "rad", -1e6, 1e6, '"12 deg"'),
    _pure("friction", "μ", "coefficient of friction", 0.0, 10.0, "0.15"),
    _pure("restitution", "d", "coefficient of restitution", 0.0, 1.0, "0.95"),
)
"""Entries of a ``[machine]`` table, in SI units."""

# Ranges: exponents and forcing of order 1e3 per 1/Ω still leave the flight kernel many digits; a rotor outside
# them does not bounce on the time scale of its rotation, which is what the equations are scaled for.
DIMENSIONLESS_FIELDS: Mapping[str, Field] = by_name(
    _pure("gamma", "γ", "scaled damping", -1e3, 1e3, "0.1", "damping/(mass speed)"),
    _pure("omega", "ω", "natural frequency over speed", 1e-3, 1e3, "0.76", "sqrt(stiffness/(mass speed^2))"),
    _pure("rho", "ρ", "eccentricity over clearance", 0.0, 1e3, "0.43", "eccentricity/clearance"),
    Field("phi", "φ", "phase of the unbalance", "an angle", "rad", -1e6, 1e6, "0.21", formula="unbalance_phase"),
    _pure("mu", "μ", "coefficient of friction", 0.0, 10.0, "0.15", "friction"),
    _pure("d", "d", "coefficient of restitution", 0.0, 1.0, "0.95", "restitution"),
    _pure("radius_ratio", "R/c_r", "rotor radius over clearance", 1e-3, 1e9, "57.1", "rotor_radius/clearance"),
)
"""Entries of a ``[dimensionless]`` table; (2.12) of the source paper defines the first three."""

WALL_FIELDS: Mapping[str, Field] = by_name(
    _pure("wall_stiffness", "κ", "stiffness of the wall", 1e-6, 1e12, "1e4", "wall stiffness/(mass speed^2)"),
    _pure("wall_damping", "c", "damping of the wall", 0.0, 1e9, "3.3", "wall damping/(mass speed)"),
    _pure("wall_dissipation", "χ", "dissipation of the wall", 0.0, 1e9, "0.05", "dissipation clearance speed"),
)
"""Parameters of compliant walls."""

PARAMETERS: Mapping[str, Field] = {**DIMENSIONLESS_FIELDS, **MACHINE_FIELDS}
"""All parameters of the planar rotor."""

PHYSICAL_PARTNER: Mapping[str, str] = {
    "gamma": "damping",
    "omega": "stiffness",
    "rho": "eccentricity",
    "phi": "unbalance_phase",
    "mu": "friction",
    "d": "restitution",
    "radius_ratio": "rotor_radius",
}
"""The machine field that is set by each dimensionless number while mass, speed and clearance are fixed."""

NOT_MODELLED: Mapping[str, str] = {
    "torque": "other torques than those of a bearing (race_drag, starting_torque, running_torque, load_factor) and those of drive and brake, in [drive]",
    "thermal": "temperatures of parts as wholes alone, by race_mass and conductances such as inner_conductance",
    "stribeck": "friction is the same at all slip speeds: compare its smallest and its largest value",
    "static_friction": "friction is the same at all slip speeds, and at rest: compare its smallest and its largest value",
    "cage": "balls stay evenly spaced, the cage turns as they roll, without cage slip and skidding",
    "lubricant": "races and balls without an oil film; viscosity and torque_factor give its torque",
    "misalignment": "races stay parallel: no tilt stiffness of a touchdown bearing",
}
"""What is asked for and not modelled, by a part of its name, and what is."""
_PARTNERS = {**PHYSICAL_PARTNER, **{physical: name for name, physical in PHYSICAL_PARTNER.items()}}
_MISSPELT = 0.66
"""Likeness from which a name counts as misspelt: one wrong letter of three."""
_NUMBERED = re.compile(r"(\w+)_\d+")
"""Name of a parameter of one part, such as ``friction_2``."""
_OTHER_WORDS = 0.2
"""Taken off the likeness of names with more or fewer words: a word more mostly says something else."""


@checked
def why_not_modelled(name: str) -> str | None:
    """What is modelled in place of what a name asks for; ``None`` of any other name."""
    return next((f"not modelled: {why}" for part, why in NOT_MODELLED.items() if part in name), None)


def unknown_name(name: str, given: object, known: Mapping[str, object], where: str, listed: bool = True) -> InputError:
    """Error for a name that does not exist, with the nearest name that does.

    ``where`` says where the name stood, for example ``"[machine]"``.  Of the known names, those allowed there, the symbol or the
    partner (``gamma`` for ``damping``) is recognised too; one of what is not modelled says so; ``listed`` adds them to the message, without numbered ones such as
    ``friction_2`` where ``friction`` is known.
    """
    best = nearest_name(name, known)
    if best is None and (why := why_not_modelled(name)):
        return InputError(shown(name), given, why, "is no parameter here")
    advice = [f"did you mean {best}?"] if best else []
    allowed = [each for each in known if not (part := _NUMBERED.fullmatch(each)) or part[1] not in known]
    remedy = " ".join(advice + ([f"allowed: {', '.join(allowed)}"] if listed else []))
    reason = f"unknown name in {where}" + (f"; {remedy}" if remedy else "")
    return InputError(shown(name), given, reason, "is no parameter here")


def unknown_names(table: Mapping[str, object], known: Mapping[str, object], where: str) -> list[InputError]:
    """Errors for all names of a table that do not exist; only the first lists those that are allowed, as it is read first."""
    unknown = [name for name in table if name not in known]
    errors = [
        unknown_name(name, table[name], known, where, listed=name == unknown[0]) for name in unknown[:_MOST_SUGGESTIONS]
    ]
    return errors + [
        InputError(name, shown(table[name]), f"unknown name in {where}") for name in unknown[_MOST_SUGGESTIONS:]
    ]


def name_errors(
    table: Mapping[str, object],
    fields: Mapping[str, Field],
    where: str,
    ways: Mapping[str, tuple[str, ...]] | None = None,
) -> list[InputError]:
    """Errors for all names of a table that are unknown or missing.

    If an unknown name seems to be a misspelt missing one, only the unknown name is reported.  ``ways`` has the numbers that
    must be given, each with the names that give it; by default each of ``fields`` by its own name.
    """
    ways = {name: (name,) for name in fields} if ways is None else ways
    absent = {name: names for name, names in ways.items() if not any(way in table for way in names)}
    meant = {nearest_name(name, fields) for name in [name for name in table if name not in fields][:_MOST_SUGGESTIONS]}
    return unknown_names(table, fields, where) + [
        InputError(name, None, "; or give ".join([f"missing in {where}; {fields[name].allowed}", *names[1:]]))
        for name, names in absent.items()
        if meant.isdisjoint(names)
    ]


def nearest_name(name: str, known: Mapping[str, object]) -> str | None:
    """Return the known name that was probably meant, if there is one: a misspelling, a symbol, or the partner of the same number.

    A name that merely looks alike may mean something else: ``bearing_stiffness`` is not ``negative_stiffness``.
    """
    symbols = {field.symbol: key for key, field in known.items() if isinstance(field, Field)}
    wanted = "_".join(name[:_LONGEST_NAME].strip().lower().replace("-", " ").replace("_", " ").split())
    partner = _PARTNERS.get(wanted, "")
    likeness = {key: _likeness(wanted, key.lower()) for key in known}
    nearest = max(likeness, key=likeness.__getitem__, default=None)
    return (
        symbols.get(name)
        or (partner if partner in known else "")
        or (nearest if nearest and likeness[nearest] >= _MISSPELT else None)
    )


def _likeness(one: str, other: str) -> float:
    """Likeness of two names, 0 to 1: of their least similar words; a name of another number of words must be more alike as a whole."""
    words, others = one.split("_"), other.split("_")
    if len(words) == len(others):
        return min(difflib.SequenceMatcher(None, *pair).ratio() for pair in zip(words, others, strict=True))
    return difflib.SequenceMatcher(None, "".join(words), "".join(others)).ratio() - _OTHER_WORDS
