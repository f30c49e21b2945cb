"""The motion that disturbances disturb: levitation, or where the machine cannot levitate the rub."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.closed_forms import find_equilibria
from carom.disturbances import Coordinate, Disturbance, KickPlane, Starts, outward_from
from carom.models import Jeffcott
from carom.motions import State
from carom.outcome import STEADY_WORDS


@dataclass(frozen=True)
class RestKick(KickPlane):
    """A kick like that of :class:`KickPlane`, of a rotor that cannot levitate and rests on the wall.

    Attributes
    ----------
    position : complex
        Where it rests, in clearances.
    """

    position: complex = 1.0 + 0.0j
    kind: ClassVar[str] = "rest-kick"

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Radial and tangential part."""
        return KickPlane(self.fastest).coordinates

    def starts(self, rotor: Jeffcott, *values: np.ndarray) -> Starts:  # type: ignore[override]
        """The resting motion with the velocity changed."""
        radial, tangential = values
        outward = self.position / abs(self.position)
        there = self.within(radial, tangential)
        return Starts.of(np.full(np.shape(radial), self.position), outward * (radial + 1j * tangential), there)


@dataclass(frozen=True)
class Rest:
    """The motion that kicks disturb.

    Attributes
    ----------
    words : str
    levitates : bool
    position : complex
        In clearances, co-rotating frame.
    outward : complex
        Direction of a kick outward, a number of modulus one.
    """

    words: str
    levitates: bool
    position: complex
    outward: complex

    def kicked(self, radial: float, tangential: float) -> State:
        """State just after a kick, whose parts are in ``c_r Ω``."""
        return State(self.position, self.outward * complex(radial, tangential))

    def kicks(self, fastest: float) -> Disturbance:
        """All kicks up to a size in ``c_r Ω``."""
        return KickPlane(fastest) if self.levitates else RestKick(fastest, self.position)


def rest_of(rotor: Jeffcott) -> Rest:
    """The motion that kicks disturb: levitation, otherwise the stable rub, otherwise rest where levitation meets the wall."""
    place = rotor.equilibrium
    if abs(place) < 1.0:
        return Rest(STEADY_WORDS["contact-free"], True, place, outward_from(rotor))
    for found in find_equilibria(rotor):
        if found.kind == "rub" and found.status == "admissible" and found.stable:
            return Rest(f"the {STEADY_WORDS['rub']}", False, complex(found.position), complex(found.position))
    on_wall = place / abs(place)
    return Rest("rest on the bearing", False, on_wall, on_wall)
