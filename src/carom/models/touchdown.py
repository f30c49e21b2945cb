"""Touchdown bearings: where a rotor can touch its housing, and what the wall does to it there."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from carom.base.arguments import ArgumentKind, NotNegative, Positive, checked, kind_of_numbers
from carom.base.outcome import InputError, shown
from carom.core.laws.law import Law
from carom.core.wall import Wall
from carom.models.turning import Race
from carom.parameters import TouchdownBearing

FARTHEST = 2.0
"""Distance from the centre, in clearances, up to which a rotor is followed in a compliant wall.

The wall is a spring however deep the rotor is in it, and a magnet is linear however near the rotor comes; neither holds far beyond the
clearance.  The air gap of a magnet usually is twice the clearance of its touchdown bearing, so a rotor that far out reaches the magnet.
"""
_Forward = Annotated[float, ArgumentKind(lambda number: number >= 1.0, "a number of at least 1")]


@checked
@dataclass(frozen=True)
class Touchdown:
    """One contact plane of a rotor.

    Attributes
    ----------
    plane : sequence of complex, shape (n,)
        Displacement at the plane, in its clearance, per coordinate of the rotor.  A plane resists impulses with the
        effective mass ``1/(W M⁻¹ Wᴴ)`` of this row ``W``.
    law : carom.core.laws.law.Law
        What the wall does to a plane that arrives: Rigid, FallingRestitution, KelvinVoigt, HuntCrossley or one of your own.
    friction : float
        Coulomb friction coefficient ``μ``.
    surface_speed : float
        Slip velocity of a rotor at rest in the co-rotating frame: ``s + 1``, with the rotor radius ``s`` at the plane in clearances.
    race : Race, optional
        Inner race that turns; by default it stands still.
    clearance : float, optional
        Clearance there in the unit of length of the rotor's scales, 1 by default: results at the plane in SI units need it, the equations do not.
    bearing : carom.parameters.TouchdownBearing, optional
        Its data in SI units where it states its balls or ratings, which loads are compared with.
    farthest : float, optional
        Distance from the centre, in clearances, up to which the rotor is followed in a compliant wall: beyond it, motions end as
        beyond the model.  By default 2.

    Raises
    ------
    InputError
        A value is not allowed.
    """

    plane: Any
    law: Law
    friction: NotNegative
    surface_speed: _Forward
    race: Race | None = None
    clearance: Positive = 1.0
    bearing: TouchdownBearing | None = None
    farthest: Positive = FARTHEST

    def __post_init__(self) -> None:
        row = np.empty(0) if kind_of_numbers(self.plane) == "-" else np.array(self.plane, complex)
        if row.ndim != 1 or not row.size:
            raise InputError("plane", shown(self.plane), "finite numbers, one for each coordinate of the rotor")
        object.__setattr__(self, "plane", tuple(row.tolist()))

    @property
    def parameters(self) -> dict[str, str]:
        """Its parameters by name: friction ``"mu"``, ``"radius_ratio"`` (the surface speed minus one), and those of its law."""
        return {"mu": "friction", "radius_ratio": "surface_speed", **self.law.parameters}

    def value(self, name: str) -> float:
        """Value of one of its parameters."""
        if name in self.law.parameters:
            return float(getattr(self.law, self.law.parameters[name]))
        return self.friction if name == "mu" else self.surface_speed - 1.0

    def replace(self, name: str, value: float) -> Touchdown:
        """Return the same with another value of one of its parameters."""
        if name in self.law.parameters:
            changed = {self.law.parameters[name]: value}
            return dataclasses.replace(self, law=dataclasses.replace(self.law, **changed))
        if name == "mu":
            return dataclasses.replace(self, friction=value)
        return dataclasses.replace(self, surface_speed=value + 1.0)

    def at_speed(self, factor: float) -> Touchdown:
        """Return the same at a speed of the shaft that is larger by a factor: what is in its unit then has another number."""
        race = None if self.race is None else self.race.at_speed(factor)
        return dataclasses.replace(self, law=self.law.at_speed(factor), race=race)

    def wall(self, mass: float) -> Wall:
        """The numbers of its wall, as the kernels take them, if the plane resists impulses with this mass."""
        found = self.law.wall(self.friction, self.surface_speed, mass)
        return found._replace(farthest=self.farthest) if found.stiffness else found
