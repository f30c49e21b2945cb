"""Coordinates of disturbances, and the starts they lead to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, NamedTuple

import numpy as np

from carom.base.arguments import ArgumentKind, Infinity, Truths, checked
from carom.base.outcome import InputError, Outcome
from carom.parameters import UNITS, Scales
from carom.parameters.formats import number, shown_in

if TYPE_CHECKING:
    from carom.models import Rotor

TURN = 2.0 * math.pi
ON_WALL = 1e-12
"""Distance from the wall, in clearances, within which a start counts as on it."""


@checked
@dataclass(frozen=True)
class Coordinate:
    """One coordinate of a disturbance and its range.

    Attributes
    ----------
    name, words : str
    low, high : float
        Dimensionless, or rad.
    scale : str
        Property of :class:`~carom.parameters.Scales` that converts it to SI; empty for angles.
    over_disc : bool
        Whether it is a radius and counts by area: of a disc, all parts of the same area have the same weight.
    periodic : bool
        Whether it is an angle over a full turn.
    """

    name: str
    words: str
    low: float | Infinity
    high: float | Infinity
    scale: str = ""
    over_disc: bool = False
    periodic: bool = False

    def __post_init__(self) -> None:
        if self.scale and self.scale not in UNITS:
            raise InputError("scale", self.scale, f"one of: {', '.join(UNITS)}; empty for an angle")

    @property
    def units(self) -> tuple[str, str]:
        """Unit of the equations and SI unit."""
        return UNITS[self.scale] if self.scale else ("rad", "rad")

    def at(self, shares: np.ndarray) -> np.ndarray:
        """Values below which these shares, 0 to 1, of the weight lie."""
        return self.high * np.sqrt(shares) if self.over_disc else self.low + (self.high - self.low) * shares

    def edges(self, cells: int) -> np.ndarray:
        """Ends of cells of equal width, shape (cells + 1,)."""
        return self.low + (self.high - self.low) * np.arange(cells + 1) / cells

    def middles(self, cells: int) -> np.ndarray:
        """Middles of cells of equal width, shape (cells,)."""
        return self.low + (self.high - self.low) * (np.arange(cells) + 0.5) / cells

    def weights(self, cells: int) -> np.ndarray:
        """Weights of these cells, shape (cells,): ones, or for a disc proportional to the areas of its rings; one on average."""
        return (2.0 * np.arange(cells) + 1.0) / cells if self.over_disc else np.ones(cells)

    def si(self, scales: Scales) -> float:
        """One unit of the coordinate in SI units."""
        return float(getattr(scales, self.scale)) if self.scale else 1.0

    def shown_in(self, scales: Scales | None) -> tuple[float, str]:
        """Unit in which people see values, and by what to multiply them: mm/s, mm and g where the scales are known."""
        return shown_in(self.scale, scales) if self.scale else (1.0, "rad")

    def stated(self, value: float, scales: Scales | None, digits: int = 3) -> str:
        """A value as text in this unit."""
        factor, unit = self.shown_in(scales)
        return f"{number(factor * value, digits)} {unit}"


def angle_coordinate(name: str, words: str) -> Coordinate:
    """An angle over a full turn."""
    return Coordinate(name, words, 0.0, TURN, periodic=True)


INSTANT = angle_coordinate("instant", "angle by which the shaft has turned at that instant")
"""At angle zero the frame that turns with the shaft coincides with the fixed one."""


class Starts(NamedTuple):
    """Starts of free motion in the co-rotating frame; arrays of one shape.

    Attributes
    ----------
    positions, velocities : ndarray of complex
        For a rotor of ``n > 1`` coordinates with a last axis of that length.
    exists : ndarray of bool
        Whether the disturbance is possible: the start lies inside the wall, and the rotor could levitate before.
    ended : ndarray of int
        Code of the :class:`~carom.base.outcome.Outcome` that ends the motion during the disturbance already, such as ``GRAZING`` or ``BEYOND_MODEL``;
        ``CLEAR`` where it goes on.
    touched : ndarray of bool
        Whether the rotor has already met the wall, during a shock or because it starts there.
    begins : ndarray
        Times at which they are taken, in ``1/Ω``: angles by which the shaft has turned since the frames coincided.
    after : ndarray of object, optional
        The machine after the disturbance, where that changes it.
    """

    positions: np.ndarray
    velocities: np.ndarray
    exists: np.ndarray
    ended: np.ndarray
    touched: np.ndarray
    begins: np.ndarray
    after: np.ndarray | None = None

    @classmethod
    @checked
    def of(cls, positions: np.ndarray | complex, velocities: np.ndarray | complex, exists: Truths | bool) -> Starts:
        """Starts of arrays of one shape and of single numbers for all of them; all motions go on from there."""
        shapes = {np.shape(values) for values in (positions, velocities, exists)} - {()}
        if len(shapes) > 1:
            raise InputError("exists", np.shape(exists), "positions, velocities and this must have one shape")
        places, speeds, there = np.broadcast_arrays(np.asarray(positions, complex), velocities, exists)
        none = np.full(places.shape, int(Outcome.CLEAR))
        return cls(places, speeds.astype(complex), there, none, np.abs(places) >= 1.0 - ON_WALL, np.zeros(places.shape))

    @classmethod
    @checked
    def joined(
        cls,
        parts: Annotated[Sequence[Starts], ArgumentKind(lambda sets: len(sets) > 0, "sets of starts, one at least")],
    ) -> Starts:
        """All starts of several sets, one-dimensional."""
        flat = [part.some(np.ones(part.exists.shape, bool)) for part in parts]
        *arrays, after = zip(*flat, strict=True)
        machines = None if any(each is None for each in after) else np.concatenate(after)
        return cls._make((*map(np.concatenate, arrays), machines))

    def at(self, instant: np.ndarray | float) -> Starts:
        """The same states in the co-rotating frame at other instants."""
        return self._replace(begins=np.broadcast_to(np.asarray(instant, float), self.exists.shape).copy())

    def some(self, chosen: np.ndarray) -> Starts:
        """Some of the starts, one-dimensional: those where ``chosen`` is true."""
        return Starts._make(None if values is None else values[chosen] for values in self)


def displaced(rotor: Rotor, positions: np.ndarray, velocities: np.ndarray, exists: np.ndarray | bool = True) -> Starts:
    """Starts of a rotor that is displaced and moves as a whole.

    Positions are the displacement of the contact plane that moves farthest, in its clearance.  Velocities, in ``c_r Ω``, are
    those of the rotor in the fixed frame at the instant when both frames coincide: with the coordinates ``U`` and the
    translation ``t``, ``U̇ = v t − iU``.  There is no start where ``exists`` is false.  A rotor whose translation moves no
    contact plane is refused.
    """
    system, whole = rotor.system, Starts.of(positions, velocities, exists)
    places, speeds = whole.positions, whole.velocities
    if not (system.is_planar and system.translation is None):
        if not system.planes_translated.any():
            raise InputError("translation", system.translated.tolist(), "one that moves a contact plane")
        moves = system.translated if len(system.rest) > 1 else complex(system.translated[0])
        places = np.multiply.outer(places, moves / system.planes_translated.max())
        speeds = np.multiply.outer(speeds, moves)
    turning = complex_of(speeds.real + places.imag, speeds.imag - places.real)
    return whole._replace(positions=places, velocities=turning)


def within(positions: np.ndarray) -> np.ndarray:
    """Whether displacements lie inside the wall."""
    inside: np.ndarray = positions.real**2 + positions.imag**2 <= 1.0
    return inside


def complex_of(real: np.ndarray, imaginary: np.ndarray) -> np.ndarray:
    """Complex numbers from their parts.

    Callers multiply real arrays only: the last bit of a complex product depends on its place in the array.
    """
    values = np.empty(np.broadcast(real, imaginary).shape, complex)
    values.real, values.imag = real, imaginary
    return values
