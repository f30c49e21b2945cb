"""The motion that disturbances disturb: levitation, or where the machine cannot levitate the rub."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from carom.base.outcome import STEADY_WORDS, CaromError, InputError
from carom.closed_forms import Equilibrium, find_equilibria
from carom.disturbances import Coordinate, Disturbance, KickPlane, Starts, outward_from
from carom.models import Rotor
from carom.motions import State

NONE = "No disturbance is followed: with these values there is no levitation that it could disturb."


@dataclass(frozen=True)
class RestKick(KickPlane):
    """A kick like that of :class:`KickPlane`, of a rotor that cannot levitate and rests on the wall.

    Attributes
    ----------
    position : complex
        Where it rests in its clearance, in clearances.
    among : tuple of complex
        Coordinates of a rotor of several; by default the position alone.
    """

    position: complex = 1.0 + 0.0j
    among: tuple[complex, ...] = ()
    kind: ClassVar[str] = "rest-kick"
    many: ClassVar[bool] = False

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Radial and tangential part."""
        return KickPlane(self.fastest).coordinates

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """The resting motion with the velocity of the rotor as a whole changed."""
        radial, tangential = values
        velocities = self.position / abs(self.position) * (radial + 1j * tangential)
        there = Starts.of(np.full(velocities.shape, self.position), velocities, self.within(radial, tangential)).at(
            instant
        )
        if not self.among:
            return there
        moved = velocities[..., None] * rotor.system.translated
        return there._replace(positions=np.broadcast_to(self.among, moved.shape).astype(complex), velocities=moved)


@dataclass(frozen=True)
class Rest:
    """The motion that kicks disturb.

    Attributes
    ----------
    words : str
    levitates : bool
    position : complex or ndarray of complex, shape (n,)
        Coordinates of the rotor in clearances, co-rotating frame.
    place : complex
        Where it is in its clearance, in clearances.
    outward : complex
        Direction of a kick outward, a number of modulus one.
    translated : ndarray of complex, shape (n,)
        Coordinates that move with the rotor as a whole.
    moving : complex or ndarray of complex, shape (n,)
        Rates of the coordinates: in the frame of the shaft a rotor that hangs under its weight goes round.
    """

    words: str
    levitates: bool
    position: Any
    place: complex
    outward: complex
    translated: np.ndarray
    moving: complex | np.ndarray = 0.0

    def velocity(self, radial: float, tangential: float) -> complex:
        """Change of velocity by a kick, whose parts are in ``c_r Ω``."""
        return self.outward * complex(radial, tangential)

    def kicked(self, radial: float, tangential: float) -> State:
        """State just after a kick, whose parts are in ``c_r Ω``."""
        velocity = self.velocity(radial, tangential)
        return State(self.position, self.moving + (velocity * self.translated if np.ndim(self.position) else velocity))

    def kicks(self, fastest: float) -> Disturbance:
        """All kicks up to a size in ``c_r Ω``."""
        return KickPlane(fastest) if self.levitates else RestKick(fastest, self.place, self.among)

    @property
    def among(self) -> tuple[complex, ...]:
        """Coordinates of a rotor of several; none of one, which is where it is."""
        return tuple(self.position.tolist()) if np.ndim(self.position) else ()


def rest_of(rotor: Rotor) -> Rest:
    """The motion that kicks disturb: levitation, otherwise the stable rub, otherwise rest where levitation meets the wall.

    Raises
    ------
    CaromError
        It does not levitate in several touchdown bearings, in which no such motion is known.
    """
    system = rotor.system
    rest, moving = system.kicked(0.0)
    place = complex(system.planes[0] @ rest)
    if system.levitates:
        return _rest(rotor, STEADY_WORDS["contact-free"], rest, place, outward_from(rotor), moving)
    if len(system.planes) > 1:
        raise CaromError(NONE)
    for found in _rubs(rotor):
        if found.status == "admissible" and found.stable:
            there = complex(found.places[0])
            return _rest(rotor, f"the {STEADY_WORDS['rub']}", found.position, there, there / abs(there))
    on_wall = place / abs(place)
    return _rest(rotor, "rest on the bearing", rest / abs(place), on_wall, on_wall)


def _rest(
    rotor: Rotor,
    words: str,
    position: complex | np.ndarray,
    place: complex,
    outward: complex,
    moving: complex | np.ndarray = 0.0,
) -> Rest:
    own, rates = (each if np.size(each) > 1 else complex(np.reshape(each, ())) for each in (position, moving))
    return Rest(words, rotor.system.levitates, own, place, outward, rotor.system.translated, rates)


def _rubs(rotor: Rotor) -> tuple[Equilibrium, ...]:
    """Synchronous rubs, where they are known."""
    try:
        return tuple(found for found in find_equilibria(rotor) if found.kind == "rub")
    except InputError:
        return ()
