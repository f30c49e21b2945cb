"""Limits that a touchdown bearing is stated to bear: the table ``[limits]`` of a machine file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, ClassVar

from carom.base.arguments import Count, Infinity, Kind, checked
from carom.base.outcome import InputError
from carom.parameters.fields import Field, by_name
from carom.parameters.tables import Table
from carom.parameters.told import number

if TYPE_CHECKING:
    from carom.parameters.touchdown_bearing import TouchdownBearing

LIMIT_FIELDS: Mapping[str, Field] = by_name(
    Field("impulse", "", "normal impulse of an impact", "an impulse", "N s", 1e-12, 1e12, '"5 N s"', zero=True),
    Field("force", "", "normal force", "a force", "N", 1e-12, 1e15, '"2 kN"', zero=True),
    Field("power", "", "friction power in lasting contact", "a power", "W", 1e-12, 1e15, '"10 kW"', zero=True),
    Field("heat", "", "friction work of a touchdown", "an energy", "J", 1e-12, 1e15, '"500 J"', zero=True),
    Field("depth", "", "depth in the bearing", "a length", "m", 1e-12, 1.0, '"20 um"', True, usual="µm", usual_size=1e-6),
    Field("pressure", "", "pressure of balls", "a pressure", "Pa", 1.0, 1e13, '"4.2 GPa"', True, usual="GPa", usual_size=1e9),
    Field("impacts", "", "impacts of a touchdown", "a whole number", "", 1, 1e9, "20", zero=True, whole=True),
)  # fmt: skip
"""Entries of a ``[limits]`` table, in SI units; each may be left out."""


@dataclass(frozen=True)
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
    impacts : int or str, optional
        Number of impacts of the whole touchdown.

    Raises
    ------
    InputError
        A value is not of this kind, or below zero.
    """

    impulse: float | None = None
    force: float | None = None
    power: float | None = None
    heat: float | None = None
    impacts: float | None = None
    depth: float | None = None
    pressure: float | None = None

    heading: ClassVar = "limits"
    means_something_empty: ClassVar = False
    entries: ClassVar = LIMIT_FIELDS

    @staticmethod
    @checked
    def told(
        name: Annotated[str, Kind(LIMIT_FIELDS.__contains__, "a load that can be limited")],
        value: float | Infinity,
        digits: Count = 3,
    ) -> str:
        """Write a load that is limited, given in its SI unit, in the unit in which people say it."""
        field = LIMIT_FIELDS[name]
        return f"{number(field.in_usual_unit(value), digits)} {field.usual_unit}".rstrip()

    def check_fit(self, bearing: TouchdownBearing | None) -> None:
        """Refuse limits of what a machine with a touchdown bearing, ``None`` if that is rigid, does not have.

        Raises
        ------
        InputError
            A depth in a rigid wall is limited, or the pressure of balls that are not stated.
        """
        if self.depth is not None and (bearing is None or not bearing.yields):
            raise InputError("depth", self.depth, "a limit needs a table [touchdown] of a compliant bearing")
        if self.pressure is not None and (bearing is None or bearing.balls is None):
            raise InputError("pressure", self.pressure, "a limit needs balls in the table [touchdown]")
