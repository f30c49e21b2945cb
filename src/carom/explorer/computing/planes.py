"""What the picture shows: kicks, shocks of the base, or losses of a blade, each by two components in a plane.

Sizes are in SI units if the machine is known, so that axes stay where its speed changes, and in units of the equations otherwise.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from carom.disturbances import BaseShock, BladeLoss, Coordinate, Disturbance, Starts, VelocityKick
from carom.disturbances.kicks_and_shocks import LONGEST_SHOCK
from carom.disturbances.single import angles_words
from carom.explorer.computing.rest import Rest, rest_of
from carom.models import Rotor, rotor_of
from carom.motions import State
from carom.parameters import SHOCK_DURATION, Case, Scales
from carom.parameters.formats import format_angle, format_quantity, shown_in
from carom.studies.survives import largest_change

Name = Literal["kick", "shock", "blade-loss"]
_WORDS: dict[Name, tuple[str, str, str, str]] = {
    "kick": ("kick", "kicks", "kick outward", "kick with the rotation"),
    "shock": ("shock", "shocks", "shock along 0°", "shock across it"),
    "blade-loss": ("loss", "losses of a blade", "change along the unbalance", "change across it"),
}
"""What the page calls one and many of them, and their components."""


@dataclass(frozen=True)
class ShockPlane(Disturbance):
    """Shocks of the base by the components of their peak acceleration, of a duration in ``1/Ω``."""

    peak: float
    duration: float
    kind: ClassVar[str] = "shock-plane"
    many: ClassVar[bool] = False
    noun: ClassVar[str] = "shocks"
    measured_in: ClassVar[dict[str, str]] = {"peak": "acceleration", "duration": "time"}

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Components along the axes that turn with the shaft, where they are as the shock begins."""
        return tuple(Coordinate(name, name, -self.peak, self.peak, "acceleration") for name in ("along_x", "along_y"))

    @property
    def size(self) -> Coordinate:
        """Peak acceleration."""
        return BaseShock(self.peak, self.duration).coordinates[0]

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """State at the end of the pulse; there is none beyond the largest peak."""
        x, y = values
        found = BaseShock(self.peak, self.duration).starts(rotor, np.hypot(x, y), np.arctan2(y, x), instant=instant)
        return found._replace(exists=found.exists & (np.hypot(x, y) <= self.peak * (1.0 + 1e-12)))


@dataclass(frozen=True)
class DisturbancePlane:
    """One kind of disturbance of a machine.

    Attributes
    ----------
    name : {"kick", "shock", "blade-loss"}
    scale : str
        Property of :class:`~carom.parameters.Scales` in which sizes are measured.
    required : float or None
        Size that must be survived; ``None`` where none is stated.
    usual : float
        Size at which a search for the range of the picture begins.
    duration : float
        Of a shock.
    """

    name: Name
    scale: str
    required: float | None
    usual: float
    duration: float = 0.0

    def own(self, size: float, scales: Scales | None) -> float:
        """A size in units of the equations."""
        return size / float(getattr(scales, self.scale)) if scales else size

    def shown(self, scales: Scales | None) -> tuple[float, str]:
        """Factor from sizes in units of the equations to those that people see, and their unit."""
        return shown_in(self.scale, scales)

    def per_unit(self, scales: Scales | None) -> float:
        """A size of one in the unit that people see."""
        return (float(getattr(scales, self.scale)) if scales else 1.0) / self.shown(scales)[0]

    @property
    def axes(self) -> tuple[str, str]:
        """Words of both components."""
        return _WORDS[self.name][2:]

    @property
    def nouns(self) -> tuple[str, str]:
        """What the page calls one and many of them."""
        return _WORDS[self.name][:2]

    def words_up_to(self, size: float, scales: Scales | None) -> str:
        """All of them up to a size in units of the equations, such as ``kicks up to 166 mm/s``."""
        return f"{self.nouns[1]} up to {format_quantity(size, self.scale, scales)}"

    def by_size(self, rotor: Rotor, size: float) -> Disturbance:
        """Disturbances by size and direction, for searches; the size is in units of the equations."""
        if self.name == "kick":
            return VelocityKick(size)
        if self.name == "shock":
            return BaseShock(size, self.lasting(rotor))
        return BladeLoss(size)

    def lasting(self, rotor: Rotor) -> float:
        """Duration of a shock in ``1/Ω``."""
        return self.duration / (rotor.scales.time if rotor.scales else 1.0)

    def start(self, rotor: Rotor, rest: Rest, first: float, second: float) -> tuple[Rotor, State, str]:
        """The machine and its state just after a disturbance by components in units of the equations, and what was done, in words."""
        size, angle = cmath.polar(self.vector(rest, first, second))
        words, turned = format_quantity(size, self.scale, rotor.scales), format_angle(angle % math.tau)
        if self.name == "kick":
            return rotor, rest.kicked(first, second), f"A kick of {words} at {turned}"
        if self.name == "shock":
            lasting = self.lasting(rotor)
            lasts = format_quantity(lasting, "time", rotor.scales)
            state = BaseShock(size, lasting).release(rotor, angle)
            return rotor, state, f"A shock of {words} for {lasts} at {turned}, drawn from its end,"
        after, state = BladeLoss(size).apply(rotor, angle)
        return after, state, f"A loss of a blade that changes the unbalance by {words} at {turned}"

    def vector(self, rest: Rest, first: float, second: float) -> complex:
        """A disturbance by its components, with the angle from which people count: that of a kick from the real axis of the co-rotating frame."""
        return rest.velocity(first, second) if self.name == "kick" else complex(first, second)


def planes_of(case: Case) -> tuple[DisturbancePlane, ...]:
    """The kinds of disturbances that a machine can be shown with, kicks first."""
    scales = case.parameters.scales
    needed = case.requirement.own(scales)
    rotor = rotor_of(case)
    levitates = rotor.system.rest_radius < 1.0

    def si(size: float, scale: str) -> float:
        return size * (float(getattr(scales, scale)) if scales else 1.0)

    kick = si(needed.kick, "velocity")
    planes = [DisturbancePlane("kick", "velocity", kick, kick)]
    duration = needed.shock.duration if needed.shock else SHOCK_DURATION / scales.time if scales else 0.0
    if 0.0 < duration <= LONGEST_SHOCK and levitates:
        peak = si(needed.shock.peak, "acceleration") if needed.shock else None
        usual = peak or si(math.pi * needed.kick / (2.0 * duration), "acceleration")
        planes.append(DisturbancePlane("shock", "acceleration", peak, usual, si(duration, "time")))
    if levitates and (most := largest_change(rotor)) > 0.0:
        scale = "unbalance" if scales else "length"
        change = si(needed.blade_loss, scale) if needed.blade_loss else None
        planes.append(DisturbancePlane("blade-loss", scale, change, change or si(0.5 * most, scale)))
    return tuple(planes)


def opening_words(case: Case) -> str:
    """What the page begins with."""
    rotor = rotor_of(case)
    kicks = planes_of(case)[0]
    needed = kicks.words_up_to(kicks.own(kicks.usual, rotor.scales), rotor.scales)
    return f"{case.name}: it must survive {needed}, which disturb {rest_of(rotor).words}; {angles_words(rotor.unbalance_phase)}"
