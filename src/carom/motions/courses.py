"""The course of a drop at one plane over all its stages: places in the fixed frame, force, slip and speed of the race, to be drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from carom.models.weight import direction_of_fall
from carom.motions.bearing_loads import drop_loads
from carom.motions.contacts import presses, race_speed, yields
from carom.motions.trajectories import Trajectory
from carom.outcome import InputError
from carom.parameters import Scales

EVEN = 6000
"""Samples at equal distances in time; the events of a motion and the largest forces of its contacts are sampled beside them."""
LATER = 1.15
"""Time up to which a drop is shown, over that since which the rotor rests or whirls."""


class Blows(NamedTuple):
    """Impacts on a rigid wall: times, normal impulses and sizes of the slip before them."""

    times: np.ndarray
    impulses: np.ndarray
    slips: np.ndarray


@dataclass(frozen=True)
class Course:
    """A drop at one plane from the release on, sampled; all arrays have shape (n,).

    Attributes
    ----------
    times : ndarray
        From the release on.
    place : ndarray of complex
        In the fixed frame.
    force, slip : ndarray
        Normal force, and size of the slip of the contact.
    race : ndarray or None
        Speed of the surface of the race; ``None`` if it does not turn.
    held : ndarray of bool
        Whether the wall presses.
    blows : Blows or None
        ``None`` if the wall gives way.
    stages : tuple of float
        Times at which later stages begin.
    down : float
        Direction of the fall, rad.
    scales : Scales or None
    """

    times: np.ndarray
    place: np.ndarray
    force: np.ndarray
    slip: np.ndarray
    race: np.ndarray | None
    held: np.ndarray
    blows: Blows | None
    stages: tuple[float, ...]
    down: float
    scales: Scales | None


def course_of(motion: Trajectory, until: float) -> Course:
    """Sample all stages of a motion up to a time from the release, in ``1/Ω``."""
    columns, parts = list[tuple[Any, ...]](), [part.seen_at(motion.plane) for part in motion.parts]
    for part in parts:
        end = min(part.time, until - part.begins)
        if end <= 0.0:
            break
        system, events = part.rotor.system, part.segment_starts[part.segment_starts <= end]
        even = np.linspace(0.0, end, max(2, int(EVEN * end / until)))
        peaks = part.touches.peak_time if yields(system, part.plane) else np.zeros(0)
        times = np.unique(np.concatenate([even, events, np.nextafter(events[1:], 0.0), peaks[peaks <= end]]))
        amplitudes, phases = part.amplitudes_at(times)
        history = part.history(times)
        place = (1.0 - history.gap) * np.exp(1j * (history.angle + part.begins + times))
        race = race_speed(system, part.plane, amplitudes)
        held = presses(phases[:, part.plane])
        columns.append((part.begins + times, place, history.normal_force, np.abs(history.slip), race, held))
    times, place, force, slip, race, held = (np.concatenate(each) for each in zip(*columns, strict=True))
    system = motion.rotor.system
    return Course(
        times=times,
        place=place,
        force=force,
        slip=slip,
        race=race if system.arrays.race[motion.plane] >= 0 else None,
        held=held,
        blows=None if yields(system, motion.plane) else _blows(parts),
        stages=tuple(part.begins for part in parts[1:] if part.begins < until),
        down=direction_of_fall(motion.rotor),
        scales=motion.rotor.scales,
    )


def _blows(parts: list[Trajectory]) -> Blows:
    logs = [part.contacts for part in parts]
    times = np.concatenate([part.begins + log.time for part, log in zip(parts, logs, strict=True)])
    impulses = np.concatenate([log.normal_impulse for log in logs])
    return Blows(times, impulses, np.concatenate([np.abs(log.slip_before) for log in logs]))


def shown_until(motion: Trajectory) -> float:
    """Time from the release, in ``1/Ω``, until shortly after the rotor has come to rest or to whirl; else the whole time.

    Raises
    ------
    InputError
        No time was followed.
    """
    whole = motion.begins + motion.time
    if whole == 0.0:
        raise InputError("motion", "no time followed", "a motion that lasts: give until")
    settled = drop_loads(motion).settled_at
    return whole if settled is None else min(whole, max(LATER * settled, settled + 8.0 * math.pi))


def first_contacts(motion: Trajectory, number: int) -> float:
    """Time from the release, in ``1/Ω``, until shortly after so many contacts of the plane, or impacts; infinite if there are less."""
    parts = [part.seen_at(motion.plane) for part in motion.parts]
    ends = [
        part.begins + (part.touches.end if yields(part.rotor.system, part.plane) else part.contacts.time)
        for part in parts
    ]
    every = np.sort(np.concatenate(ends))
    return 1.02 * float(every[number - 1]) if len(every) >= number else math.inf
