"""The course of a drop at one plane over all its stages: places in the fixed frame, forces, slip, shaft and race, to be drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from carom.models import Rotor
from carom.motions.contacts import presses, race_speed, shaft_lead, yields
from carom.motions.load_sums import drop_loads
from carom.motions.trajectories import Trajectory
from carom.outcome import InputError
from carom.parameters import Scales

EVEN = 6000
"""Samples at equal distances in time; the events of a motion and the largest forces of its contacts are sampled beside them."""
FOLLOWED = 30
"""Contacts shown one by one: more would cover each other."""
LATER = 1.15
"""Time up to which a drop is shown, over that since which the rotor rests or whirls."""


class Blows(NamedTuple):
    """Impacts on a rigid wall: times, normal impulses and those of friction along growing angle, sizes of the slip before them."""

    times: np.ndarray
    impulses: np.ndarray
    frictions: np.ndarray
    slips: np.ndarray


@dataclass(frozen=True)
class Course:
    """A drop at one plane from the release on, sampled; all arrays have shape (n,).

    Attributes
    ----------
    times : ndarray
        From the release on.
    place : ndarray of complex
        In the fixed frame; on a mount relative to that.
    mount : ndarray of complex or None
        Place of the mount in the fixed frame; ``None`` if the bearing has none.
    heavy : ndarray
        Angle of the unbalance in the fixed frame, rad.
    force, friction, slip : ndarray
        Normal force, friction on the rotor along growing angle, and size of the slip of the contact.
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
    mount: np.ndarray | None
    heavy: np.ndarray
    force: np.ndarray
    friction: np.ndarray
    slip: np.ndarray
    race: np.ndarray | None
    held: np.ndarray
    blows: Blows | None
    stages: tuple[float, ...]
    down: float
    scales: Scales | None


def course_of(motion: Trajectory, until: float, samples: int = EVEN) -> Course:
    """Sample all stages of a motion up to a time from the release, in ``1/Ω``, about so often beside its events."""
    columns, parts = list[tuple[Any, ...]](), [part.seen_at(motion.plane) for part in motion.parts]
    for part in parts:
        end = min(part.time, until - part.begins)
        if end <= 0.0:
            break
        system, events = part.rotor.system, part.segment_starts[part.segment_starts <= end]
        even = np.linspace(0.0, end, max(2, int(samples * end / until)))
        peaks = part.touches.peak_time if yields(system, part.plane) else np.zeros(0)
        times = np.unique(np.concatenate([even, events, np.nextafter(events[1:], 0.0), peaks[peaks <= end]]))
        amplitudes, phases = part.amplitudes_at(times)
        history, fixed = part.history(times), part.begins + times
        place = (1.0 - history.gap) * np.exp(1j * (history.angle + fixed))
        mount = _mount(part.rotor, amplitudes) * np.exp(1j * fixed)
        heavy = part.rotor.unbalance_phase + fixed + shaft_lead(system, amplitudes)
        race = race_speed(system, part.plane, amplitudes)
        forces = history.normal_force, history.friction_force, np.abs(history.slip)
        columns.append((fixed, place, mount, heavy, *forces, race, presses(phases[:, part.plane])))
    times, place, mount, heavy, force, friction, slip, race, held = map(np.concatenate, zip(*columns, strict=True))
    system = motion.rotor.system
    return Course(
        times=times,
        place=place,
        mount=mount if motion.rotor.is_on_mount else None,
        heavy=heavy,
        force=force,
        friction=friction,
        slip=slip,
        race=race if system.arrays.race[motion.plane] >= 0 else None,
        held=held,
        blows=None if yields(system, motion.plane) else _blows(parts, until),
        stages=tuple(part.begins for part in parts[1:] if part.begins < until),
        down=motion.rotor.direction_of_fall,
        scales=motion.scales,
    )


def _mount(rotor: Rotor, amplitudes: np.ndarray) -> np.ndarray:
    """Place of the mount in the frame of the rotor; zero without one."""
    if not rotor.is_on_mount:
        return np.zeros(len(amplitudes), complex)
    place: np.ndarray = rotor.system.state(amplitudes)[0][:, 1]
    return place


def _blows(parts: list[Trajectory], until: float) -> Blows:
    logs = [part.contacts for part in parts]
    times = np.concatenate([part.begins + log.time for part, log in zip(parts, logs, strict=True)])
    impulses, frictions, slips = (
        np.concatenate([getattr(log, name) for log in logs])[times <= until]
        for name in ("normal_impulse", "tangential_impulse", "slip_before")
    )
    return Blows(times[times <= until], impulses, frictions, np.abs(slips))


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
