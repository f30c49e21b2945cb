"""The drive of a machine and what turns with its shaft: the table ``[drive]`` of a machine file."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from carom.arguments import checked
from carom.outcome import InputError, Problems, shown
from carom.parameters.fields import Field, by_name, unknown_names
from carom.parameters.quantities import read_quantity
from carom.parameters.told import number

DRIVE_FIELDS: Mapping[str, Field] = by_name(
    Field("polar_inertia", "J", "polar inertia of the rotor", "a moment of inertia", "kg m^2", 1e-15, 1e9, '"0.02 kg m^2"'),
    Field("torque", "", "torque of the drive in contact", "a torque", "N m", -1e12, 1e12, '"0 N m"', True),
)  # fmt: skip
"""Entries of a ``[drive]`` table, in SI units."""


@dataclass(frozen=True)
class Drive:
    """What turns with the shaft, and its drive: with it friction in contact changes the speed.

    Parameters
    ----------
    polar_inertia : float or str
        Moment of inertia about the axis of rotation, kg m².
    torque : float or str, optional
        Torque of the drive while the rotor touches, N m; 0, a drive that is off, by default.  In flight the speed stays as it is.

    Raises
    ------
    InputError
        A value is missing, not of this kind or out of range.
    """

    polar_inertia: float | None = None
    torque: float = 0.0

    def __post_init__(self) -> None:
        if self.polar_inertia is None:
            raise InputError("polar_inertia", None, "a table [drive] needs it, such as polar_inertia = '0.02 kg m^2'")
        problems = Problems()
        for name, field in DRIVE_FIELDS.items():
            given: Any = getattr(self, name)
            object.__setattr__(self, name, problems.attempt(read_quantity, field, given))
        problems.raise_all()

    @property
    def words(self) -> str:
        """Both in the units of people."""
        return f"polar inertia {number(self.polar_inertia or 0.0)} kg m², torque in contact {number(self.torque)} N m"

    def to_toml(self) -> str:
        """Return the text of a table that is read as this drive."""
        lines = (f"{name} = {value!r}  # {DRIVE_FIELDS[name].unit}" for name, value in dataclasses.asdict(self).items())
        return "\n".join(["[drive]", *lines]) + "\n"

    @classmethod
    @checked
    def of(cls, table: Mapping[str, Any], has_scales: bool = True) -> Drive:
        """Read a table; one beside dimensionless parameters has no mass and clearance to be compared with.

        Raises
        ------
        InputError
            An unknown name, a value that is not allowed, or a table without a machine in SI units.
        """
        problems = Problems()
        problems.errors += unknown_names(table, DRIVE_FIELDS, "[drive]")
        if not has_scales:
            allowed = "not allowed beside [dimensionless]: it is in SI units, which need a [machine] table"
            problems.errors.append(InputError("drive", shown(dict(table)), allowed))
        found = problems.attempt(cls, **{name: value for name, value in table.items() if name in DRIVE_FIELDS})
        problems.raise_all()
        return found or cls()
