"""The course of a drop at one plane over all its stages: places in the fixed frame, forces, slip, shaft and race, to be drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.base.outcome import InputError
from carom.motions.contacts import ContactLog
from carom.motions.kinematics import is_compliant, presses, race_speed, shaft_lead, shaft_speed
from carom.motions.load_sums import drop_loads
from carom.motions.trajectories import Trajectory
from carom.parameters import Scales

EVEN = 6000
"""Samples at equal distances in time; the events of a motion and the largest forces of its contacts are sampled beside them."""
FOLLOWED = 30
"""Contacts shown one by one: more would cover each other."""
LATER = 1.15
"""Time up to which a drop is shown, over that since which the rotor rests or whirls."""


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
    unbalance_angles : ndarray
        Angle of the unbalance in the fixed frame, rad.
    force, friction, slip : ndarray
        Normal force, friction on the rotor along growing angle, and size of the slip of the contact.
    race : ndarray or None
        Speed of the surface of the race; ``None`` if it does not turn.
    held : ndarray of bool
        Whether the wall presses.
    impacts : ContactLog or None
        ``None`` if the touchdown bearing is compliant.
    stages : tuple of float
        Times at which later stages begin.
    down : float
        Direction of the fall, rad.
    scales : Scales or None
    turns : ndarray
        Speed of the shaft, in ``Ω``.
    """

    times: np.ndarray
    place: np.ndarray
    unbalance_angles: np.ndarray
    force: np.ndarray
    friction: np.ndarray
    slip: np.ndarray
    held: np.ndarray
    impacts: ContactLog | None
    stages: tuple[float, ...]
    down: float
    scales: Scales | None
    turns: np.ndarray
    mount: np.ndarray | None = None
    race: np.ndarray | None = None


def course_of(motion: Trajectory, until: float, samples: int = EVEN) -> Course:
    """Sample all stages of a motion up to a time from the release, in ``1/Ω``, about so often beside its events."""
    rotor, plane = motion.rotor, motion.plane
    parts = [part.seen_at(plane) for part in motion.parts]
    followed = [(part, end) for part in parts if (end := min(part.time, until - part.begins)) > 0.0]
    columns = [_sampled(part, end, int(samples * end / until)) for part, end in followed]
    course: dict[str, np.ndarray] = {name: np.concatenate([each[name] for each in columns]) for name in columns[0]}
    impacts = ContactLog.joined([(part.begins, part.contacts) for part in parts])
    return Course(
        **course,
        impacts=None if is_compliant(rotor.system, plane) else impacts.some(impacts.time <= until),
        stages=tuple(part.begins for part in parts[1:] if part.begins < until),
        down=rotor.acting.direction_of_fall,
        scales=motion.scales,
    )


def _sampled(part: Trajectory, end: float, samples: int) -> dict[str, np.ndarray]:
    """Columns of one stage up to a time, at so many instants beside its events."""
    system, events = part.rotor.system, part.segment_starts[part.segment_starts <= end]
    even = np.linspace(0.0, end, max(2, samples))
    peaks = part.contacts.peak_time
    times = np.unique(np.concatenate([even, events, np.nextafter(events[1:], 0.0), peaks[peaks <= end]]))
    amplitudes, phases = part.amplitudes_at(times)
    history, fixed = part.history(times), part.begins + times
    columns = {
        "times": fixed,
        "place": (1.0 - history.gap) * np.exp(1j * (history.angle + fixed)),
        "unbalance_angles": part.rotor.unbalance_phase + fixed + shaft_lead(system, amplitudes),
        "force": history.normal_force,
        "friction": history.friction_force,
        "slip": np.abs(history.slip),
        "held": presses(phases[:, part.plane]),
        "turns": shaft_speed(system, amplitudes),
    }
    if part.rotor.planar is not None and len(system.rest) > 1:  # on a mount, whose place is the second coordinate
        columns["mount"] = system.state(amplitudes)[0][:, 1] * np.exp(1j * fixed)
    if system.arrays.race[part.plane] >= 0:
        columns["race"] = race_speed(system, part.plane, amplitudes)
    return columns


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
    every = np.sort(ContactLog.joined([(part.begins, part.contacts) for part in parts]).whole.end)
    return 1.02 * float(every[number - 1]) if len(every) >= number else math.inf
