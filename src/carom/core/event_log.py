"""The log of a motion's events."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.base.outcome import Phase


class EventLog(NamedTuple):
    """Room for the events of a motion, as :func:`carom.core.advance.advance` writes them.

    Attributes
    ----------
    times : array, shape (L,)
    phases : int array, shape (L, P)
        Phase of each station that follows.
    stations : int array, shape (L,)
        Station of the event.
    before, after : complex arrays, shape (L, N)
        Amplitudes just before and just after it.
    limited : int array, shape (L, A)
        State of each limited axis that follows (:mod:`carom.core.limits`).
    """

    times: np.ndarray
    phases: np.ndarray
    stations: np.ndarray
    before: np.ndarray
    after: np.ndarray
    limited: np.ndarray

    @classmethod
    def empty(cls, size: int, modes: int, stations: int = 1, limits: int = 0) -> EventLog:
        """Allocate a log for this many events."""
        phases, places = np.empty((size, stations), np.int64), np.empty(size, np.int64)
        before, after = np.empty((2, size, modes), complex)
        return cls(np.empty(size), phases, places, before, after, np.empty((size, 2 * limits), np.int64))

    def first(self, count: int) -> EventLog:
        """The first events."""
        return EventLog(*(part[:count] for part in self))

    def impacts(self, phases: np.ndarray) -> np.ndarray:
        """Which events are impacts, from the phase of each station, shape (P,), before the first one."""
        aloft = flying(np.concatenate([phases[None], self.phases]), self.stations)
        impacting: np.ndarray = aloft.all(axis=0) & (self.before != self.after).any(axis=1)
        return impacting

    def contact_beginnings(self, phases: np.ndarray, compliant: np.ndarray) -> np.ndarray:
        """Which events are impacts, or begin contact with a compliant wall (bool for each station, shape (P,))."""
        before, after = flying(np.concatenate([phases[None], self.phases]), self.stations)
        arrived: np.ndarray = self.impacts(phases) | (before & ~after & compliant[self.stations])
        return arrived


def flying(phases: np.ndarray, stations: np.ndarray) -> np.ndarray:
    """Whether the station of each event flies before and after it, bool (2, n), for phases (n + 1, P) and stations (n,)."""
    places = np.arange(len(stations))
    return np.array([phases[places, stations], phases[places + 1, stations]]) == Phase.FLIGHT
