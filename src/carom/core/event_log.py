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
        Phase of each plane that follows.
    planes : int array, shape (L,)
        Plane of the event.
    before, after : complex arrays, shape (L, N)
        Amplitudes just before and just after it.
    limited : int array, shape (L, A)
        State of each limited axis that follows (:mod:`carom.core.limits`).
    """

    times: np.ndarray
    phases: np.ndarray
    planes: np.ndarray
    before: np.ndarray
    after: np.ndarray
    limited: np.ndarray

    @classmethod
    def empty(cls, size: int, modes: int, planes: int = 1, limits: int = 0) -> EventLog:
        """Allocate a log for this many events."""
        phases, places = np.empty((size, planes), np.int64), np.empty(size, np.int64)
        before, after = np.empty((2, size, modes), complex)
        return cls(np.empty(size), phases, places, before, after, np.empty((size, 2 * limits), np.int64))

    def first(self, count: int) -> EventLog:
        """The first events."""
        return EventLog(*(part[:count] for part in self))

    def impacts(self, phases: np.ndarray) -> np.ndarray:
        """Which events are impacts, from the phase of each plane, shape (P,), before the first one."""
        aloft = flying(np.concatenate([phases[None], self.phases]), self.planes)
        struck: np.ndarray = aloft.all(axis=0) & (self.before != self.after).any(axis=1)
        return struck

    def arrivals(self, phases: np.ndarray, yields: np.ndarray) -> np.ndarray:
        """Which events are impacts, or begin contact with a wall that gives way (bool for each plane, shape (P,))."""
        before, after = flying(np.concatenate([phases[None], self.phases]), self.planes)
        arrived: np.ndarray = self.impacts(phases) | (before & ~after & yields[self.planes])
        return arrived


def flying(phases: np.ndarray, planes: np.ndarray) -> np.ndarray:
    """Whether the plane of each event flies before and after it, bool (2, n), for phases (n + 1, P) and planes (n,)."""
    places = np.arange(len(planes))
    return np.array([phases[places, planes], phases[places + 1, planes]]) == Phase.FLIGHT
