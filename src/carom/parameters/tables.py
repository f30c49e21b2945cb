"""Tables of a machine file as frozen values: their entries are declared once, as fields, and read where the value is made."""

from __future__ import annotations

import cmath
import dataclasses
import json
import math
from collections.abc import Mapping
from typing import Any, ClassVar, Self

from carom.base.arguments import Count, Infinity, checked
from carom.base.outcome import InputError, Problems, shown
from carom.parameters.fields import Field, unknown_names
from carom.parameters.formats import format_angle, format_entry, number
from carom.parameters.quantities import Written, read_quantity
from carom.parameters.scaling import Scales

DOWN = -0.5 * math.pi
"""Down the y axis, as an angle from the x axis."""
AXIAL = "axial"
"""Direction of the weight of a vertical shaft."""
BIAS, STIFFNESS = "bias", "stiffness"
"""What may carry the weight of a levitating rotor."""
_KINDS = {
    "": "a number",
    "rad": "an angle",
    "rad/s": "an angular speed",
    "s": "a time",
    "A": "a current",
    "m": "a length",
    "kg": "a mass",
    "kg m^2": "a moment of inertia",
    "m/s": "a speed",
    "m/s^2": "an acceleration",
    "N": "a force",
    "N s": "an impulse",
    "N m": "a torque",
    "W": "a power",
    "J": "an energy",
    "Pa": "a pressure",
    "N/m": "a stiffness",
    "N s/m": "a damping",
    "s/m": "a dissipation",
    "N m s": "a drag",
    "N m s^2": "a windage",
    "kg/m^3": "a density",
    "m^2/s": "a viscosity",
    "Hz": "a frequency",
    "°C": "a temperature",
    "J/(kg K)": "a specific heat",
    "W/K": "a conductance",
    "1/K": "an expansion",
}
"""What is counted in an SI unit."""
_ENTRIES: dict[type, dict[str, Field]] = {}


def entry(
    symbol: str,
    words: str,
    unit: str,
    lowest: float,
    highest: float,
    example: str,
    zero: bool = False,
    default: float | None = None,
    usual: tuple[str, float] = ("", 1.0),
    whole: bool = False,
) -> Any:
    """An attribute of a table that is a number: its field, but for the name, and its value where it is left out; ``usual`` is the unit in which people say it, and its size."""
    kind, (said, size) = "a whole number" if whole else _KINDS[unit], usual
    field = Field(
        "", symbol, words, kind, unit, lowest, highest, example, zero, usual=said, usual_size=size, whole=whole
    )
    return dataclasses.field(default=default, metadata={"field": field})


def entries_of(table: type[Table]) -> dict[str, Field]:
    """The numbers of a table, by their names; those that it has from another class, by keyword alone, come last."""
    if table not in _ENTRIES:
        ordered = sorted(dataclasses.fields(table), key=lambda each: bool(each.kw_only))
        declared = {each.name: each.metadata.get("field") for each in ordered}
        _ENTRIES[table] = {name: dataclasses.replace(field, name=name) for name, field in declared.items() if field}
    return _ENTRIES[table]


def read_entries(part: Any, fields: Mapping[str, Field]) -> None:
    """Set the attributes of a frozen part to the numbers that were given for them; all that cannot be used are reported together.

    One that is ``None`` by default may be left out.
    """
    problems, optional = Problems(), {each.name for each in dataclasses.fields(part) if each.default is None}
    for name, field in fields.items():
        given = getattr(part, name)
        if given is not None:
            object.__setattr__(part, name, problems.attempt(read_quantity, field, given))
        elif name not in optional:
            problems.errors.append(InputError(name, None, field.allowed))
    problems.raise_all()


def toml_line(name: str, value: object, remark: str = "") -> str:
    """An entry of a table as TOML states it, bit for bit: a number or a list of numbers, in the SI unit that the remark states, text, or a table of these."""
    if isinstance(value, Mapping):
        inner = [toml_line(json.dumps(key), each) for key, each in value.items()]
        return f"{name} = {{ {', '.join(inner)} }}"
    return f"{name} = {json.dumps(value, ensure_ascii=False)}" + (f"  # {remark}" if remark else "")


@dataclasses.dataclass(frozen=True)
class Table:
    """Base class of a table of a machine file: a frozen dataclass whose attributes are its entries.

    Attributes
    ----------
    heading : str
        Name of the table.
    texts : tuple of str
        Entries that are no numbers.
    is_in_si : bool
        Whether it needs a machine in SI units.
    """

    heading: ClassVar[str]
    texts: ClassVar[tuple[str, ...]] = ()
    is_in_si: ClassVar[bool] = True

    def __post_init__(self) -> None:
        read_entries(self, self.entries)

    @property
    def entries(self) -> Mapping[str, Field]:
        """Its numbers by their names."""
        return entries_of(type(self))

    @property
    def given(self) -> dict[str, float]:
        """The numbers that are stated, in SI units."""
        own = {name: getattr(self, name) for name in self.entries}
        return {name: value for name, value in own.items() if value is not None}

    def unit(self, name: str) -> str:
        """SI unit of an entry."""
        return self.entries[name].unit

    def replace(self, **changes: Any) -> Self:
        """Return the table with other entries."""
        return dataclasses.replace(self, **changes)

    def to_toml(self) -> str:
        """Return the text of a table that is read as this value; nothing if nothing is stated."""
        lines = [toml_line(name, given) for name in self.texts if (given := getattr(self, name))]
        lines += [toml_line(name, value, self.unit(name)) for name, value in self.given.items()]
        return "\n".join([f"[{self.heading}]", *lines]) + "\n" if lines else ""

    @classmethod
    @checked
    def of(cls, table: Mapping[str, object], has_scales: bool = True) -> Self:
        """Read a table; one beside dimensionless parameters has no mass and clearance to be compared with.

        Raises
        ------
        InputError
            An unknown name, a value that is not allowed, or a table without a machine in SI units.
        """
        problems, known = Problems(), {**dict.fromkeys(cls.texts), **entries_of(cls)}
        problems.errors += unknown_names(table, known, f"[{cls.heading}]")
        if cls.is_in_si and not has_scales:
            problems.errors.append(cls.without_scales(shown(dict(table))))
        found = problems.attempt(cls, **{name: value for name, value in table.items() if name in known})
        problems.raise_all()
        return found or cls()

    @classmethod
    def without_scales(cls, given: object) -> InputError:
        """The error of the table beside dimensionless parameters."""
        allowed = "not allowed beside [dimensionless]: it is in SI units, which need a [machine] table with mass, clearance and speed"
        return InputError(cls.heading.strip("[]"), shown(given), allowed)


@dataclasses.dataclass(frozen=True)
class Gravity(Table):
    """Gravity in the plane in which the rotor moves, as that of a horizontal shaft, or along the axis of a vertical one.

    Parameters
    ----------
    acceleration : float or str, optional
        Part of the acceleration of free fall that lies in that plane, m/s²; 9.81 by default.
    direction : float or str, optional
        Where it points, as an angle in the fixed frame from its x axis in the sense of rotation, rad; down the y axis by default.  With
        ``"axial"`` it points along the axis: nothing pulls the rotor to a side, neither while it levitates nor in a drop.
    carried_by : str, optional
        What carries the rotor while it levitates: ``"bias"``, the default, bias currents of the magnetic bearings, by which the rotor levitates
        in the centre as after integral action, and which vanish with levitation; or ``"stiffness"``, so that it sags.

    Raises
    ------
    InputError
        A value is not of this kind, or the acceleration is below zero.

    Examples
    --------
    >>> import carom as cm
    >>> cm.parameters.Gravity("1.62 m/s^2", "-60 deg").acceleration
    1.62
    """

    acceleration: float = entry("g", "acceleration of free fall", "m/s^2", 1e-9, 1e9, '"9.81 m/s^2"', True, 9.81)
    direction: float | str = entry(
        "", "direction of the fall, from the x axis", "rad", -1e6, 1e6, '"-90 deg", or "axial"', False, DOWN
    )
    carried_by: str = BIAS

    heading: ClassVar = "gravity"
    texts: ClassVar = ("carried_by",)

    def __post_init__(self) -> None:
        if self.carried_by not in (BIAS, STIFFNESS):
            raise InputError("carried_by", shown(self.carried_by), f'must be "{BIAS}" or "{STIFFNESS}"')
        super().__post_init__()

    @property
    def is_axial(self) -> bool:
        """Whether it points along the axis, as that of a vertical shaft."""
        return self.direction == AXIAL

    @property
    def entries(self) -> Mapping[str, Field]:
        """Its numbers by their names; of a vertical shaft the direction is none."""
        own = entries_of(type(self))
        return {"acceleration": own["acceleration"]} if self.is_axial else own

    def to_toml(self) -> str:
        """Return the text of a table that is read as this value."""
        return super().to_toml() + (toml_line("direction", AXIAL) + "\n" if self.is_axial else "")

    def pull(self, scales: Scales) -> complex:
        """Return the acceleration in the plane of the motion, in the fixed frame, in ``c_r Ω²``."""
        if isinstance(self.direction, str):
            return 0j
        return cmath.rect(self.acceleration / scales.acceleration, self.direction)

    @property
    def words(self) -> str:
        """Acceleration and direction in the units of people."""
        where = "along the axis" if isinstance(self.direction, str) else f"at {format_angle(self.direction)}"
        return f"{number(self.acceleration)} m/s\N{SUPERSCRIPT TWO} {where}"


@dataclasses.dataclass(frozen=True)
class Drive(Table):
    """What turns with the shaft, and its drive: with it friction in contact changes the speed.

    Parameters
    ----------
    polar_inertia : float or str, optional
        Moment of inertia about the axis of rotation, kg m²; needed beside ``[machine]``, and by default that of the rotor beside ``[rotor]``.
    torque : float or str, optional
        Torque of the drive while the rotor touches, N m; 0, a drive that is off, by default.  In flight the speed stays as it is, but not in a
        spin-down to standstill, in which it always acts, as do those below.
    brake, drag, windage : float or str, optional
        Torques against the rotation in a spin-down: one that is constant, such as that of the axial touchdown bearing, N m; one that grows with the
        speed, N m s; and one that grows with its square, N m s²; 0 by default.

    Raises
    ------
    InputError
        A value is missing, not of this kind or out of range.
    """

    polar_inertia: float | None = entry("J", "polar inertia of the rotor", "kg m^2", 1e-15, 1e9, '"0.02 kg m^2"')
    torque: float = entry("", "torque of the drive in contact", "N m", -1e12, 1e12, '"0 N m"', True, 0.0)
    brake: float = entry("", "torque that is constant, in a spin-down", "N m", 1e-15, 1e12, '"0.1 N m"', True, 0.0)
    drag: float = entry("", "torque per speed, in a spin-down", "N m s", 1e-18, 1e12, '"1e-5 N m s"', True, 0.0)
    windage: float = entry(
        "", "torque per speed squared, in a spin-down", "N m s^2", 1e-21, 1e12, '"1e-8 N m s^2"', True, 0.0
    )

    heading: ClassVar = "drive"

    @property
    def words(self) -> str:
        """What is stated in the units of people."""
        parts = [f"polar inertia {number(self.polar_inertia)} kg m²"] if self.polar_inertia else []
        parts.append(f"torque in contact {number(self.torque)} N m")
        units = {"brake": "N m", "drag": "N m s", "windage": "N m s²"}
        parts += [f"{name} {number(getattr(self, name))} {unit}" for name, unit in units.items() if getattr(self, name)]
        return ", ".join(parts)


@dataclasses.dataclass(frozen=True)
class LoadLimits(Table):
    """Largest loads of a touchdown that are stated for a touchdown bearing; ``None`` where nothing is stated.

    Every value is a number in the SI unit below, or text with a unit such as ``"2 kN"``.

    Parameters
    ----------
    impulse : float or str, optional
        Normal impulse of an impact, N s.
    force : float or str, optional
        Normal force, N: the peak in a compliant bearing, and on a rigid wall that of lasting contact.
    power : float or str, optional
        Friction power in lasting contact, W.
    heat : float or str, optional
        Friction work of the whole touchdown, J.
    depth : float or str, optional
        Depth in a compliant bearing, m.
    pressure : float or str, optional
        Largest pressure between a ball and the inner race, Pa; the bearing has to state its balls.
    static_share : float or str, optional
        Peak force over the static load rating; 1 for a bearing that states that rating.
    life_share : float or str, optional
        Share of the life that a touchdown may use; the bearing has to state its dynamic load rating.
    temperature : float or str, optional
        Highest temperature of a part of the bearing or of the sleeve, °C; the bearing has to state the mass of its race.
    impacts : int or str, optional
        Number of impacts of the whole touchdown.

    Raises
    ------
    InputError
        A value is not of this kind, or below zero.
    """

    impulse: float | None = entry("", "normal impulse of an impact", "N s", 1e-12, 1e12, '"5 N s"', True)
    force: float | None = entry("", "normal force", "N", 1e-12, 1e15, '"2 kN"', True)
    power: float | None = entry("", "friction power in lasting contact", "W", 1e-12, 1e15, '"10 kW"', True)
    heat: float | None = entry("", "friction work of a touchdown", "J", 1e-12, 1e15, '"500 J"', True)
    impacts: float | None = entry("", "impacts of a touchdown", "", 1, 1e9, "20", True, whole=True)
    depth: float | None = entry("", "depth in the bearing", "m", 1e-12, 1.0, '"20 um"', True, usual=("µm", 1e-6))
    pressure: float | None = entry("", "ball pressure", "Pa", 1.0, 1e13, '"4.2 GPa"', True, usual=("GPa", 1e9))
    static_share: float | None = entry("", "force over the static rating", "", 1e-12, 1e6, "0.5", True)
    life_share: float | None = entry("", "share of the bearing life", "", 1e-15, 1e6, "0.01", True)
    temperature: float | None = entry("", "highest temperature", "°C", -273.15, 3000.0, '"150 °C"')

    heading: ClassVar = "limits"
    needed: ClassVar = {
        "pressure": "balls",
        "static_share": "static_rating",
        "life_share": "dynamic_rating",
        "temperature": "race_mass",
    }
    """Entries of a touchdown bearing that limits need."""

    @staticmethod
    @checked
    def format(name: str, value: float | Infinity, digits: Count = 3) -> str:
        """Write a load that is limited, given in its SI unit, in the unit in which people say it."""
        if name not in LIMIT_FIELDS:
            raise InputError("name", name, "a load that can be limited")
        return format_entry(LIMIT_FIELDS[name], value, digits)


@dataclasses.dataclass(frozen=True)
class Zones(Table):
    """Zones of the vibration amplitude of a rotor on magnetic bearings.

    Parameters
    ----------
    limits : tuple of float
        Largest radius, in units of the clearance, in zone A, B and C; above the last one lies zone D. The default
        are the limits of ISO 14839-2:2004 for the displacement of a rotor on active magnetic bearings.

    Raises
    ------
    InputError
        If the limits are not three numbers that increase from above 0 to at most 1.
    """

    limits: tuple[float, float, float] = (0.3, 0.4, 0.5)

    heading: ClassVar = "zones"
    texts: ClassVar = ("limits",)
    is_in_si: ClassVar = False
    labels: ClassVar = ("A", "B", "C", "D")
    """Names of the zones, from the smallest amplitude to the largest."""

    def __post_init__(self) -> None:
        given: object = self.limits
        stated = given if isinstance(given, list | tuple) and len(given) == 3 else ()
        numbers = [float(each) for each in stated if type(each) in (int, float, Written)]
        if len(numbers) != 3 or not 0 < numbers[0] < numbers[1] < numbers[2] <= 1:
            words = "must be three numbers that increase from above 0 to at most 1 (the clearance), such as [0.3, 0.4, 0.5], in [zones]"
            raise InputError("limits", shown(given), words)
        object.__setattr__(self, "limits", tuple(numbers))

    @checked
    def zone(self, radius: float) -> str:
        """Return the zone of an amplitude: the largest distance of the rotor centre from the bearing centre, in clearances.

        A radius equal to a limit belongs to the zone below it.  A negative radius, or one that is not a number, is refused.
        """
        if not radius >= 0:
            raise InputError("radius", shown(radius), "must be >= 0, in units of the clearance")
        return self.labels[sum(radius > limit for limit in self.limits)]


GRAVITY_FIELDS, DRIVE_FIELDS, LIMIT_FIELDS = map(entries_of, (Gravity, Drive, LoadLimits))
