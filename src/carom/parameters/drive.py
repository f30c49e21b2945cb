"""The drive of a machine and what turns with its shaft: the table ``[drive]`` of a machine file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from carom.base.outcome import InputError
from carom.parameters.fields import Field, by_name
from carom.parameters.tables import Table
from carom.parameters.told import number

DRIVE_FIELDS: Mapping[str, Field] = by_name(
    Field("polar_inertia", "J", "polar inertia of the rotor", "a moment of inertia", "kg m^2", 1e-15, 1e9, '"0.02 kg m^2"'),
    Field("torque", "", "torque of the drive in contact", "a torque", "N m", -1e12, 1e12, '"0 N m"', True),
)  # fmt: skip
"""Entries of a ``[drive]`` table, in SI units."""


@dataclass(frozen=True)
class Drive(Table):
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

    heading: ClassVar = "drive"
    entries: ClassVar = DRIVE_FIELDS

    def __post_init__(self) -> None:
        if self.polar_inertia is None:
            raise InputError("polar_inertia", None, "a table [drive] needs it, such as polar_inertia = '0.02 kg m^2'")
        super().__post_init__()

    @property
    def words(self) -> str:
        """Both in the units of people."""
        return f"polar inertia {number(self.polar_inertia or 0.0)} kg m², torque in contact {number(self.torque)} N m"
