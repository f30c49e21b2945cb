"""When a motion has become quiet: no fast rotor for a time."""

from __future__ import annotations

import numpy as np

from carom.core.event_log import EventLog
from carom.models import System, Trigger
from carom.motions.kinematics import presses


def last_unrest(system: System, log: EventLog, amplitudes: np.ndarray, reached: float, trigger: Trigger) -> float:
    """Time of the last instant that was not quiet, of the events of a log and where the motion now is, with these amplitudes (N,); minus infinity if all were."""
    if _fastest(system, amplitudes[None])[0] > trigger.quiet_speed:
        return reached
    fastest = np.maximum(_fastest(system, log.before), _fastest(system, log.after))
    return float(log.times[fastest > trigger.quiet_speed].max(initial=-np.inf))


def _fastest(system: System, amplitudes: np.ndarray) -> np.ndarray:
    """Largest speed at any touchdown bearing, in the fixed frame, in ``c_r Ω``, shape (...), in amplitudes (..., N)."""
    each = (system.at_plane(amplitudes, plane) for plane in range(len(system.widths)))
    speeds = [width * np.abs(rate + 1j * place) for width, (place, rate) in zip(system.widths, each, strict=True)]
    return np.max(speeds, axis=0)


def with_pause(
    log: EventLog, phases: np.ndarray, amplitudes: np.ndarray, reached: float, limited: np.ndarray
) -> EventLog:
    """The log with an event at which nothing changes, where a motion was asked and goes on."""
    touching = np.flatnonzero(presses(phases))
    station = int(touching[0]) if len(touching) else -1
    pause = EventLog(
        np.array([reached]), phases[None], np.array([station]), amplitudes[None], amplitudes[None], limited[None]
    )
    return EventLog(*(np.concatenate(pair) for pair in zip(log, pause, strict=True)))
