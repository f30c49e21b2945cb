"""Multiple shooting: the equations of an orbit of given word, their exact derivatives, and Newton's method.

The unknowns are the nodes, that is the coordinates and rates at the beginning of each segment, and the durations.  The equations: each
segment ends at the next node, and fulfils the condition at its end.  As the durations are unknowns, no time of impact has
to be solved for.  So nothing is singular where an impact grazes, and a branch of orbits passes through it.

A chatter is followed by simulation, and the contact after it begins where it lands: that node and the duration of the
chatter are no unknowns (:func:`free_entries`).  Both depend on the number of bounces that the simulation makes before it completes the chatter,
by as little as the last bounces last, and at the onset of lasting contact (:mod:`carom.orbits.landings`) they have no derivative.  The end of the
contact depends on neither.  A chatter that is interrupted just before it is complete is completed at its last bounce but one, so that the
equations hold beyond the onset too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from carom.core.closure import carry_through_segments, close_flights, shooting_equations
from carom.core.layout import rub_workspace
from carom.core.segments import follow_contact, follow_flights
from carom.core.sensitivity import sensitivity_of_flights
from carom.models import Rotor
from carom.orbits.chatter import follow_chatter
from carom.orbits.word import Kind, Word

ITERATIONS = 25
TOLERANCE = 1e-13
"""Residual at which Newton's method stops, relative to one plus the size of the nodes."""
STALLED = 1e-10
"""The same, accepted where rounding lets the residual fall no further."""
BACKTRACKS = 6
LONGEST_STEP = 0.5
"""Largest change of a duration in one step of Newton's method, relative to it."""


class Start(NamedTuple):
    """Coordinates and rates at the beginning of each segment, complex (m, N), and the durations (m,).

    Unlike the amplitudes of modes they mean the same for rotors with other parameters.
    """

    nodes: np.ndarray
    durations: np.ndarray

    def turned(self, places: int) -> Start:
        """The same period, beginning with another segment."""
        return Start(np.roll(self.nodes, -places, axis=0), np.roll(self.durations, -places))


@dataclass(frozen=True, eq=False)
class Links:
    """The segments followed from their nodes, with derivatives.

    Attributes
    ----------
    start : Start
        After a chatter, the node at which it lands.
    arrivals : ndarray of complex, shape (m, N)
        Coordinates and rates at the end of each segment.
    values : ndarray, shape (m,)
        The condition at its end; zero on an orbit.
    slopes : ndarray, shape (m, 2N + 1, 2N + 1)
        Derivative of real and imaginary parts of the arrival, then of the condition, by those of the node, then by the
        duration.
    landings : ndarray, shape (m,)
        Of each chatter its signed distance from the onset of lasting contact (:func:`~carom.orbits.landings.distance_from_onset`), below
        zero if it is interrupted; infinite for other segments.
    slips : ndarray, shape (m,)
        Of each chatter the slip with which it lands, in the direction of the sliding that follows; or where rolling follows, by how much
        friction could stop more.  Below zero if the contact is of another kind; infinite for other segments.
    """

    start: Start
    arrivals: np.ndarray
    values: np.ndarray
    slopes: np.ndarray
    landings: np.ndarray
    slips: np.ndarray

    @cached_property
    def _equations(self) -> np.ndarray:
        found: np.ndarray = shooting_equations(self.start.nodes, self.arrivals, self.values, self.slopes, False)
        return found

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
    def reduced(self) -> tuple[np.ndarray, np.ndarray]:
        """Residual and its derivative by the free unknowns alone, on which the others depend; ``nan`` where a chatter is none."""
        if all(each == math.inf for each in self.landings.tolist()):
            return self.residual, self.jacobian
        lands = ~np.isposinf(self.landings)
        width = self.slopes.shape[1]
        free, rows = free_entries(lands, width), np.repeat(~lands, width)
        whole = self.jacobian.copy()
        # The later a chatter lands, the shorter is the contact after it.
        ends = width * np.flatnonzero(lands) + width - 1
        whole[:, ends] -= whole[:, (ends + width) % len(free)]
        # The rows of a chatter say how its landing follows from its first impact.
        try:
            follows = np.linalg.solve(whole[np.ix_(~rows, ~free)], whole[np.ix_(~rows, free)])
        except np.linalg.LinAlgError:
            return np.full(rows.sum(), np.nan), np.full((rows.sum(), free.sum()), np.nan)
        return self.residual[rows], whole[np.ix_(rows, free)] - whole[np.ix_(rows, ~free)] @ follows

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


def links_of(rotor: Rotor, word: Word, start: Start) -> Links:
    """Follow each segment of a word from its node.

    Parameters
    ----------
    rotor : Rotor
    word : Word
    start : Start
        What follows from a chatter is not read: where it lands, and how long it takes of the time up to the end of the contact after it.

    Returns
    -------
    Links
        Its ``values`` are ``nan`` where a chatter does not end in the lasting contact that follows in the word.
    """
    system = rotor.system
    arrays, coordinates, (nodes, durations) = system.arrays, system.nodes, start
    m = len(nodes)
    arrivals, values, slopes = _room(*nodes.shape)
    follow_flights(
        arrays, *coordinates, word.kinds, word.planes, word.targets, nodes, durations, arrivals, values, slopes
    )
    landings, slips = np.full((2, m), np.inf)
    if not word.flies:
        nodes, durations = nodes.copy(), durations.copy()
        for i in np.flatnonzero(word.lands).tolist():
            time, landings[i], slips[i] = follow_chatter(rotor, word[(i + 1) % m], nodes[i], arrivals[i], slopes[i])
            values[i] = 0.0 if np.isfinite(time) else np.nan
            if np.isfinite(time):
                after = (i + 1) % m
                nodes[after], durations[after], durations[i] = arrivals[i], durations[after] + durations[i] - time, time
        at = word.kinds, word.planes, word.conditions, nodes, durations, rub_workspace(system.modes, len(arrays.rows))
        follow_contact(arrays, *coordinates, *at, arrivals, values, slopes)
    return Links(Start(nodes, durations), arrivals, values, slopes, landings, slips)


def by_parameter(rotor: Rotor, word: Word, start: Start, name: str) -> np.ndarray | None:
    """Exact derivative of the left sides of the equations by a parameter of the rotor, shape (m (2N + 1),).

    ``None`` for words with lasting contact, and where the rotor does not give the derivatives of its equations of motion.
    """
    rates = rotor.rates(name) if word.flies else None
    if rates is None:
        return None
    system = rotor.system
    at = word.kinds, word.planes, word.targets, *start
    changes: np.ndarray = sensitivity_of_flights(system.arrays, *system.nodes, *rates, *at)
    return changes


def _room(m: int, numbers: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arrays for the ends of ``m`` segments, the values of their conditions, and their derivatives."""
    return np.empty((m, numbers), complex), np.empty(m), np.empty((m, 2 * numbers + 1, 2 * numbers + 1))


def closed_flights(rotor: Rotor, word: Word, start: Start) -> Start | None:
    """Solve the equations of a word of impacts by plain Newton steps from a start next to an orbit.

    ``None`` if the iteration does not converge; it takes no shorter steps, and knows no lasting contact (:func:`converged`).
    """
    system = rotor.system
    nodes, durations = start.nodes.copy(), start.durations.copy()
    at = word.kinds, word.planes, word.targets, nodes, durations
    room = _room(*nodes.shape)
    closes = close_flights(system.arrays, *system.nodes, *at, *room, False, TOLERANCE, ITERATIONS)
    return Start(nodes, durations) if closes else None


def pack(start: Start) -> np.ndarray:
    """Real and imaginary parts of each node and its duration, one segment after the other, shape (m (2N + 1),)."""
    return np.concatenate([start.nodes.real, start.nodes.imag, start.durations[:, None]], axis=1).ravel()


def unpack(unknowns: np.ndarray, segments: int) -> Start:
    """Nodes and durations from the unknowns of :func:`pack`."""
    rows = unknowns.reshape(segments, -1)
    numbers = rows.shape[1] // 2
    nodes = np.empty((segments, numbers), complex)
    nodes.real, nodes.imag = rows[:, :numbers], rows[:, numbers:-1]
    return Start(nodes, rows[:, -1].copy())


def free_entries(lands: np.ndarray, width: int) -> np.ndarray:
    """Which entries of :func:`pack` are unknowns, bool: not the node at which a chatter lands, nor its duration.

    The duration of the contact after it then stands for that of both.

    Parameters
    ----------
    lands : ndarray of bool, shape (m,)
        Which segments are chatters.
    width : int
        Entries of a segment.
    """
    kept = np.ones((len(lands), width), bool)
    kept[lands, -1] = False
    kept[np.roll(lands, 1), :-1] = False
    return kept.ravel()


def pack_free(word: Word, start: Start) -> np.ndarray:
    """The unknowns among the entries of :func:`pack`."""
    if word.flies:
        return pack(start)
    durations = start.durations + np.roll(np.where(word.lands, start.durations, 0.0), 1)
    whole = pack(Start(start.nodes, durations))
    free: np.ndarray = whole[free_entries(word.lands, len(whole) // len(word))]
    return free


def unpack_free(word: Word, unknowns: np.ndarray) -> Start:
    """Nodes and durations from the unknowns of :func:`pack_free`; zero where they follow from a chatter."""
    if word.flies:
        return unpack(unknowns, len(word))
    width = len(unknowns) // (len(word) - int(word.lands.sum()))
    whole = np.zeros(len(word) * width)
    whole[free_entries(word.lands, width)] = unknowns
    return unpack(whole, len(word))


def converged(rotor: Rotor, word: Word, start: Start) -> Links | None:
    """Solve the equations of an orbit by Newton's method from a start nearby.

    Parameters
    ----------
    rotor : Rotor
    word : Word
    start : Start

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
        share = min(1.0, LONGEST_STEP * float((durations / np.maximum(moved, 1e-300))[word.kinds != Kind.LAND].min()))
        for _ in range(BACKTRACKS):
            there = links_of(rotor, word, unpack(unknowns + share * change, len(word)))
            if there.size < size:
                break
            share *= 0.5
        else:
            return here if size <= STALLED else None
        here = there
    return here if here.size <= STALLED else None
