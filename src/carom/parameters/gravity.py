"""Weight: the table ``[gravity]`` of a machine file."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from carom.arguments import checked
from carom.outcome import InputError, Problems, shown
from carom.parameters.fields import Field, by_name, unknown_names
from carom.parameters.quantities import read_quantity
from carom.parameters.scaling import Scales
from carom.parameters.told import number, told_angle

GRAVITY_FIELDS: Mapping[str, Field] = by_name(
    Field(
        "acceleration", "g", "acceleration of free fall", "an acceleration", "m/s^2", 1e-9, 1e9, '"9.81 m/s^2"', True
    ),
    Field("direction", "", "direction of the fall, from the x axis", "an angle", "rad", -1e6, 1e6, '"-90 deg"'),
)
"""Entries of a ``[gravity]`` table, in SI units; each may be left out."""


@dataclass(frozen=True)
class Gravity:
    """Gravity in the plane in which the rotor moves, as that of a horizontal shaft.

    Parameters
    ----------
    acceleration : float or str, optional
        Part of the acceleration of free fall that lies in that plane, m/s²; 9.81 by default.
    direction : float or str, optional
        Where it points, as an angle in the fixed frame from its x axis in the sense of rotation, rad; down the y axis by default.

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

    acceleration: float = 9.81
    direction: float = -0.5 * math.pi

    def __post_init__(self) -> None:
        problems = Problems()
        for name, field in GRAVITY_FIELDS.items():
            given: Any = getattr(self, name)
            object.__setattr__(self, name, problems.attempt(read_quantity, field, given))
        problems.raise_all()

    def pull(self, scales: Scales) -> complex:
        """Return the acceleration in the fixed frame, in ``c_r Ω²``."""
        return cmath.rect(self.acceleration / scales.acceleration, self.direction)

    @property
    def words(self) -> str:
        """Both in the units of people."""
        return f"{number(self.acceleration)} m/s\N{SUPERSCRIPT TWO} at {told_angle(self.direction)}"

    def to_toml(self) -> str:
        """Return the text of a table that is read as this gravity."""
        return f'[gravity]\nacceleration = "{self.acceleration!r} m/s^2"\ndirection = "{self.direction!r} rad"\n'

    @classmethod
    @checked
    def of(cls, table: Mapping[str, Any], has_scales: bool = True) -> Gravity:
        """Read a table; one beside dimensionless parameters has nothing to be compared with.

        Raises
        ------
        InputError
            An unknown name, a value that is not allowed, or a table without a machine in SI units.
        """
        problems = Problems()
        problems.errors += unknown_names(table, GRAVITY_FIELDS, "[gravity]")
        known = {name: value for name, value in table.items() if name in GRAVITY_FIELDS}
        found = problems.attempt(cls, **known)
        if not has_scales:
            problems.errors.append(refused(dict(table)))
        problems.raise_all()
        return found or cls()


def refused(given: object) -> InputError:
    """The error of gravity beside dimensionless parameters."""
    allowed = (
        "not allowed beside [dimensionless]: it is in m/s^2, which needs a [machine] table with its clearance and speed"
    )
    return InputError("gravity", shown(given), allowed)
