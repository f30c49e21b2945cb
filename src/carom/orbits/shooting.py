"""Multiple shooting: the equations of an orbit of given word, their exact derivatives, and Newton's method.

The unknowns are the nodes, that is the coordinates and rates just before each impact, and the durations of the flights.  The equations:
each flight ends at the next node, on the wall.  As the durations are unknowns, no time of impact has to be solved for.  So nothing is
singular where an impact grazes, and a branch of orbits passes through it.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from carom.core.closure import carry_through_segments, close_flights, shooting_equations
from carom.core.segments import follow_flights
from carom.core.sensitivity import sensitivity_of_flights
from carom.models import Rotor
from carom.orbits.word import Word
from carom.parameters import Numbers

ITERATIONS = 25
TOLERANCE = 1e-13
"""Residual at which Newton's method stops, relative to one plus the size of the nodes."""
STALLED = 1e-10
"""The same, accepted where rounding lets the residual fall no further."""
BACKTRACKS = 6
LONGEST_STEP = 0.5
"""Largest change of a duration in one step of Newton's method, relative to it."""


class ShootingStart(NamedTuple):
    """Coordinates and rates at the beginning of each segment, complex (m, N), and the durations (m,).

    Unlike the amplitudes of modes they mean the same for rotors with other parameters.
    """

    nodes: np.ndarray
    durations: np.ndarray

    def turned(self, places: int) -> ShootingStart:
        """The same period, beginning with another segment."""
        return ShootingStart(np.roll(self.nodes, -places, axis=0), np.roll(self.durations, -places))


@dataclass(frozen=True, eq=False)
class Links:
    """The segments followed from their nodes, with derivatives.

    Attributes
    ----------
    start : ShootingStart
    ends : ndarray of complex, shape (m, N)
        Coordinates and rates at the end of each segment.
    values : ndarray, shape (m,)
        The condition at its end; zero on an orbit.
    slopes : ndarray, shape (m, 2N + 1, 2N + 1)
        Derivative of real and imaginary parts of the end, then of the condition, by those of the node, then by the
        duration.
    """

    start: ShootingStart
    ends: np.ndarray
    values: np.ndarray
    slopes: np.ndarray

    @cached_property
    def _equations(self) -> np.ndarray:
        return shooting_equations(self.start.nodes, self.ends, self.values, self.slopes)

    @property
    def residual(self) -> np.ndarray:
        """Left sides of the equations, shape (m (2N + 1),)."""
        return self._equations[:, -1]

    @property
    def size(self) -> float:
        """Largest left side, relative to one plus the size of the nodes; ``nan`` or infinite if it is not defined."""
        return float(np.abs(self.residual).max() / (1.0 + np.abs(self.start.nodes).max()))

    @property
    def jacobian(self) -> np.ndarray:
        """Derivative of the residual, shape (m (2N + 1), m (2N + 1))."""
        return self._equations[:, :-1]

    @cached_property
    def _carried(self) -> tuple[np.ndarray, np.ndarray]:
        return carry_through_segments(self.slopes)

    @property
    def passages(self) -> np.ndarray:
        """Derivative of each end by its node if the segment ends where its condition is fulfilled, shape (m, 2N, 2N)."""
        return self._carried[0]

    @property
    def monodromy(self) -> np.ndarray:
        """Derivative of the first node after a period by the first node, of the shape of a passage; one eigenvalue is zero."""
        return self._carried[1]


def links_of(rotor: Rotor, word: Word, start: ShootingStart) -> Links:
    """Follow each segment of a word from its node."""
    system, (nodes, durations) = rotor.system, start
    room = _room(*nodes.shape)
    at = word.kinds, word.planes, word.planes, nodes, durations
    follow_flights(system.arrays, *system.nodes, *at, *room)
    return Links(start, *room)


def by_parameter(rotor: Rotor, word: Word, start: ShootingStart, name: str) -> np.ndarray:
    """Exact derivative of the left sides of the equations by a parameter of the planar rotor, shape (m (2N + 1),)."""
    system, present = rotor.system, rotor.parameters
    gamma, omega, rho, phi, *of_wall = Numbers.of(present).rates(name)
    accelerations = np.array([[complex(-2.0 * present.omega * omega, -gamma), -gamma]])
    force = np.array([complex(rho, present.rho * phi) * cmath.exp(1j * present.phi)])
    friction, restitution, surface_speed = np.array(of_wall)[:, None]
    rates = accelerations, force, friction, restitution, surface_speed
    at = word.kinds, word.planes, word.planes, *start
    return sensitivity_of_flights(system.arrays, *system.nodes, *rates, *at)


def _room(m: int, numbers: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arrays for the ends of ``m`` segments, the values of their conditions, and their derivatives."""
    return np.empty((m, numbers), complex), np.empty(m), np.empty((m, 2 * numbers + 1, 2 * numbers + 1))


def closed_flights(rotor: Rotor, word: Word, start: ShootingStart) -> ShootingStart | None:
    """Solve the equations of an orbit by plain Newton steps from a start next to it.

    ``None`` if the iteration does not converge; it takes no shorter steps (:func:`converged`).
    """
    system = rotor.system
    nodes, durations = start.nodes.copy(), start.durations.copy()
    at = word.kinds, word.planes, word.planes, nodes, durations
    room = _room(*nodes.shape)
    closes = close_flights(system.arrays, *system.nodes, *at, *room, TOLERANCE, ITERATIONS)
    return ShootingStart(nodes, durations) if closes else None


def pack(start: ShootingStart) -> np.ndarray:
    """Real and imaginary parts of each node and its duration, one segment after the other, shape (m (2N + 1),)."""
    return np.concatenate([start.nodes.real, start.nodes.imag, start.durations[:, None]], axis=1).ravel()


def unpack(unknowns: np.ndarray, segments: int) -> ShootingStart:
    """Nodes and durations from the unknowns of :func:`pack`."""
    rows = unknowns.reshape(segments, -1)
    numbers = rows.shape[1] // 2
    nodes = np.empty((segments, numbers), complex)
    nodes.real, nodes.imag = rows[:, :numbers], rows[:, numbers:-1]
    return ShootingStart(nodes, rows[:, -1].copy())


def converged(rotor: Rotor, word: Word, start: ShootingStart) -> Links | None:
    """Solve the equations of an orbit by Newton's method from a start nearby.

    Parameters
    ----------
    rotor : Rotor
    word : Word
    start : ShootingStart

    Returns
    -------
    Links or None
        ``None`` if the iteration does not converge.
    """
    here = links_of(rotor, word, start)
    for _ in range(ITERATIONS):
        size = here.size
        if not np.isfinite(size):
            return None
        try:
            change = np.linalg.solve(here.jacobian, -here.residual)
        except np.linalg.LinAlgError:
            return here if size <= STALLED else None
        unknowns = pack(here.start)
        if size <= TOLERANCE:
            polished = links_of(rotor, word, unpack(unknowns + change, len(word)))
            # At a fold the derivative is singular, and the step leads anywhere.
            return polished if polished.size <= TOLERANCE else here
        moved, durations = np.abs(change.reshape(len(word), -1)[:, -1]), np.abs(here.start.durations)
        share = min(1.0, LONGEST_STEP * float((durations / np.maximum(moved, 1e-300)).min()))
        for _ in range(BACKTRACKS):
            there = links_of(rotor, word, unpack(unknowns + share * change, len(word)))
            if there.size < size:
                break
            share *= 0.5
        else:
            return here if size <= STALLED else None
        here = there
    return here if here.size <= STALLED else None
