"""Weight: the table ``[gravity]`` of a machine file."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from carom.parameters.fields import Field, by_name
from carom.parameters.scaling import Scales
from carom.parameters.tables import Table
from carom.parameters.told import number, told_angle

GRAVITY_FIELDS: Mapping[str, Field] = by_name(
    Field("acceleration", "g", "acceleration of free fall", "an acceleration", "m/s^2", 1e-9, 1e9, '"9.81 m/s^2"', True),
    Field("direction", "", "direction of the fall, from the x axis", "an angle", "rad", -1e6, 1e6, '"-90 deg"'),
)  # fmt: skip
"""Entries of a ``[gravity]`` table, in SI units; each may be left out."""


@dataclass(frozen=True)
class Gravity(Table):
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

    heading: ClassVar = "gravity"
    entries: ClassVar = GRAVITY_FIELDS

    def pull(self, scales: Scales) -> complex:
        """Return the acceleration in the fixed frame, in ``c_r Ω²``."""
        return cmath.rect(self.acceleration / scales.acceleration, self.direction)

    @property
    def words(self) -> str:
        """Both in the units of people."""
        return f"{number(self.acceleration)} m/s\N{SUPERSCRIPT TWO} at {told_angle(self.direction)}"
