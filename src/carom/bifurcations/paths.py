"""The path of an orbit through its states, and how far other states are from it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from carom.core.event_log import EventLog
from carom.core.fate import memory
from carom.core.layout import rub_workspace
from carom.core.phases import AWAY
from carom.core.rub import fly_or_rub_all
from carom.models import Rotor
from carom.motions.simulation import follow
from carom.orbits.admissibility import PHASES, departure
from carom.orbits.orbit import Orbit
from carom.orbits.word import Segment
from carom.outcome import Phase

SPACING = 0.02
"""Largest time between samples of the path among which the nearest is looked for, in ``1/Ω``."""
CORRECTIONS = 6
"""Corrections of the time of the nearest point; each leaves a share of the error as large as distance over radius of curvature."""
DIFFERENCE = 1e-4
"""Step of the difference that gives the direction of the path, in ``1/Ω``: it only has to be right to a few digits."""
CANDIDATES = 3
"""Pieces on which the nearest point is looked for: those of the nearest samples."""
TOGETHER = 500
"""States whose distances are computed together."""
MOST_EVENTS = 8192
"""Events of one segment."""


@dataclass(frozen=True, eq=False)
class Path:
    """One period as pieces, each a flight or a Taylor step of lasting contact that is exact at every time.

    Attributes
    ----------
    rotor : Rotor
    begins : ndarray of complex, shape (k, N)
        Amplitudes at the beginning of each piece.
    phases : ndarray of int, shape (k, P)
        Phase of each contact plane.
    durations : ndarray, shape (k,)
    """

    rotor: Rotor
    begins: np.ndarray
    phases: np.ndarray
    durations: np.ndarray

    @classmethod
    def of(cls, orbit: Orbit) -> Path:
        """Path of an orbit, followed anew from each of its nodes."""
        nodes = orbit.rotor.system.nodes.amplitudes(orbit.nodes)
        parts = [_pieces(orbit.rotor, *each) for each in zip(orbit.word, nodes, orbit.durations.tolist(), strict=True)]
        return cls(orbit.rotor, *(np.concatenate(column) for column in zip(*parts, strict=True)))

    def distances(self, states: np.ndarray) -> np.ndarray:
        """Distance of each of some states (m, 2n) from the path: the largest difference of a coordinate or a rate, shape (m,).

        It is exact to rounding for states so near that the path is straight over this distance.
        """
        counts = np.ceil(self.durations / SPACING).astype(int) + 2
        times = np.concatenate([np.linspace(0.0, *each) for each in zip(self.durations, counts, strict=True)])
        samples = self._states(np.repeat(np.arange(len(counts)), counts), times)
        together = np.split(states, range(TOGETHER, len(states), TOGETHER))
        return np.concatenate([self._nearest(part, counts, times, samples) for part in together])

    def _nearest(self, states: np.ndarray, counts: np.ndarray, times: np.ndarray, samples: np.ndarray) -> np.ndarray:
        """Distances by the nearest samples of some pieces, moved along these by Gauss's and Newton's method."""
        firsts = np.cumsum(counts) - counts
        apart = (np.abs(states[:, None] - samples) ** 2).sum(axis=2)
        order = np.argsort(np.minimum.reduceat(apart, firsts, axis=1), axis=1)[:, :CANDIDATES]
        least = np.full(len(states), np.inf)
        for piece in order.T:
            inside = np.arange(len(times)) - firsts[piece][:, None]
            inside = (inside >= 0) & (inside < counts[piece][:, None])
            time = times[np.where(inside, apart, np.inf).argmin(axis=1)]
            for _ in range(CORRECTIONS):
                behind, here, ahead = (self._states(piece, time + step) for step in (-DIFFERENCE, 0.0, DIFFERENCE))
                least = np.minimum(least, np.abs(states - here).max(axis=1))
                rate = (ahead - behind) / (2.0 * DIFFERENCE)
                late = (rate.conj() * (states - here)).real.sum(axis=1) / (np.abs(rate) ** 2).sum(axis=1)
                time = np.clip(time + late, 0.0, self.durations[piece])
        return least

    def _states(self, pieces: np.ndarray, times: np.ndarray) -> np.ndarray:
        """States (m, 2n) at times since the beginning of pieces."""
        room = rub_workspace(self.begins.shape[1], self.phases.shape[1])
        free, clocks = np.zeros((len(times), 0), np.int64), np.zeros(len(times))
        moved = fly_or_rub_all(
            self.rotor.system.arrays, self.begins[pieces], self.phases[pieces], free, clocks, times, room
        )
        return self.rotor.system.nodes.of(moved)


def _pieces(
    rotor: Rotor, segment: Segment, node: np.ndarray, duration: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Amplitudes, phases and durations of the pieces of a segment."""
    phases = np.full(len(rotor.system.contacts), AWAY)
    if segment.kind.flies:
        return departure(rotor, segment, node)[None], phases[None], np.array([duration])
    phases[segment.plane] = PHASES.get(segment.kind, Phase.FLIGHT)
    log, begin, contact = EventLog.empty(MOST_EVENTS, len(node), len(phases)), node.copy(), phases.copy()
    # At the border itself the simulation may change the contact by rounding, but only for an instant.
    _, time, count = follow(rotor, begin, duration, contact, log, memory(len(node)))
    log = log.first(count)
    ends = [0.0, *log.times.tolist(), max(time, *log.times.tolist(), 0.0)]
    durations = np.array([later - earlier for earlier, later in pairwise(ends)])
    return np.concatenate([node[None], log.after]), np.concatenate([phases[None], log.phases]), durations
