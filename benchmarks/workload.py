"""The machine and the work that all benchmarks share."""

from __future__ import annotations

import numba
import numpy as np

import carom
from carom.core.advance import advance
from carom.core.event_log import EventLog
from carom.core.layout import rub_workspace, workspace
from carom.core.phases import AWAY
from carom.core.settling import memory

UNTIL, MOST_IMPACTS = 200.0, 100


def source_paper_machine(gamma: float, **changes: float) -> carom.models.Rotor:
    """The machine of the source paper."""
    machine = {"omega": 0.76, "rho": 3 / 7, "phi": 0.21, "mu": 0.15, "d": 0.95, "radius_ratio": 400 / 7}
    return carom.models.jeffcott(carom.parameters.Parameters(gamma=gamma, **{**machine, **changes}))


def random_starts(count: int = 10_000) -> np.ndarray:
    """Starts, ``|U| < 0.95`` and ``|U̇| < 1.5`` uniform in the disc, shape (count, 2) complex."""
    rng = np.random.default_rng(12345)

    def disc(radius: float) -> np.ndarray:
        return radius * np.sqrt(rng.random(count)) * np.exp(2j * np.pi * rng.random(count))

    return np.stack([disc(0.95), disc(1.5)], axis=1)


def amplitudes_of(rotor: carom.models.Rotor, starts: np.ndarray) -> np.ndarray:
    return np.array([rotor.system.amplitudes(*start) for start in starts])


class Bounces:
    """Follow all starts to the time or the number of impacts that ends them; returns the number of impacts."""

    def __init__(self, rotor: carom.models.Rotor, starts: np.ndarray) -> None:
        self.rotor, self.starts = rotor, amplitudes_of(rotor, starts)
        self.log = EventLog.empty(MOST_IMPACTS, 2)
        self.work = memory(2, stop_at_landing=True), workspace(2), rub_workspace(2)

    def __call__(self) -> int:
        return _all_bounces(self.rotor.system.arrays, self.rotor.system.table, self.starts, UNTIL, self.log, *self.work)


@numba.njit
def _all_bounces(rotor, table, starts, until, log, recollection, work, rub):
    impacts, contact = 0, np.empty(1, np.int64)
    amplitudes = np.empty_like(starts[0])
    for i in range(starts.shape[0]):
        amplitudes[:] = starts[i]
        contact[0] = AWAY
        outcome = advance(rotor, table, amplitudes, until, contact, log, recollection, work, rub)
        impacts += outcome[2]
    return impacts
