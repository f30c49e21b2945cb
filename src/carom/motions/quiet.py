"""When a motion has become quiet: no contact, or none of a fast rotor, for a time."""

from __future__ import annotations

import numpy as np

from carom.core.event_log import EventLog
from carom.models import System, Trigger
from carom.motions.kinematics import presses


def last_unrest(
    system: System, log: EventLog, phases: np.ndarray, amplitudes: np.ndarray, reached: float, trigger: Trigger
) -> float:
    """Time of the last instant that was not quiet, of the events of a log and where the motion now is; minus infinity if all were.

    Parameters
    ----------
    phases : ndarray of int, shape (L + 1, P)
        Of each bearing, before the first event and after each of them.
    amplitudes : ndarray of complex, shape (N,)
        Where the motion is now, at the time ``reached``.
    """
    if trigger.quiet_speed:
        before, after = (_fastest(system, each) for each in (log.before, log.after))
        restless = np.maximum(before, after) > trigger.quiet_speed
        now = bool(_fastest(system, amplitudes[None])[0] > trigger.quiet_speed)
    else:
        touching = np.any(presses(phases), axis=1)
        restless = touching[1:] | touching[:-1] | log.impacts(phases[0])
        now = bool(touching[-1])
    return reached if now else float(log.times[restless].max(initial=-np.inf))


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
