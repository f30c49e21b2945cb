"""What happens along a motion, in chronological order: impacts, contact that begins, changes or ends, and limits that are met and left; how far it goes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from carom.base.outcome import Phase
from carom.core.contact_events import SHORTEST_LAP
from carom.core.event_log import flying
from carom.core.limits import LOWER, UPPER
from carom.core.margins import local_motion
from carom.motions.trajectories import Trajectory
from carom.orbits.word import Kind

SAMPLES = 2000


class Extremes(NamedTuple):
    """Largest values on a periodic motion, at any touchdown bearing.

    Attributes
    ----------
    radius, depth : float
        Distance from the centre, and how far this is into a compliant wall, in its clearance.
    force : float
        Normal force while contact lasts, in ``m c_r Ω²`` of the rotor; 0 where it never does.
    """

    radius: float
    depth: float
    force: float


def extremes_of(motion: Trajectory) -> Extremes:
    """Largest radius, depth and force of a motion at any plane; extremes within contact are those of its log where it has one."""
    system, times = motion.rotor.system, np.linspace(0.0, motion.time, SAMPLES)
    times = np.sort(np.append(times, motion.segment_starts))
    amplitudes, phases = motion.amplitudes_at(times)
    radius = depth = force = 0.0
    for plane in range(phases.shape[1]):
        seen, compliant = motion.seen_at(plane), bool(system.arrays["stiffness"][plane])
        far = float(np.abs(system.at_plane(amplitudes, plane)[0]).max())
        if compliant:
            touches = seen.contacts
            far = max(far, 1.0 + float(touches.deepest.max(initial=0.0)) if len(touches.deepest) else 0.0)
            force = max(force, float(touches.peak_force.max(initial=0.0)) / float(system.widths[plane]))
            depth = max(depth, far - 1.0)
        radius = max(radius, far)
        if (phases[:, plane] != Phase.FLIGHT).any():
            normal = seen.forces_of(amplitudes, phases, times)[0]
            force = max(force, float(normal.max()) / float(system.widths[plane]))
    return Extremes(radius, max(depth, 0.0), force)


INSTANT = 1e-12
SATURATES, RECOVERS, LANDS = "saturate", "unsaturate", "land"
CHANGES = {
    Phase.FLIGHT: "lift",
    Phase.FORWARD_SLIP: "slide+",
    Phase.BACKWARD_SLIP: "slide-",
    Phase.ROLLING: "roll",
    Phase.SEPARATED: "free",
}
"""What happens where a plane begins to be in a phase."""


class Happening(NamedTuple):
    """One of them.

    Attributes
    ----------
    label : str
        That of a :class:`~carom.orbits.word.Kind`, ``"land"``, one of :data:`CHANGES`, ``"saturate"`` or ``"unsaturate"``.
    place : int
        Contact plane, from 0; of limits twice the number of the limited quantity, plus one for its second axis.
    event : int
        Event of the motion.
    time : float
        In ``1/Ω``, since the motion began.
    begins_contact : bool
        Whether contact with a wall begins there: an impact, or contact with a compliant one.
    """

    label: str
    place: int
    event: int
    time: float
    begins_contact: bool

    @property
    def limits(self) -> bool:
        """Whether a limit is met or left."""
        return self.label in (SATURATES, RECOVERS)

    def __str__(self) -> str:
        if self.limits:
            return f"{self.label}@{self.place // 2 + 1}{'xy'[self.place % 2]}"
        return f"{self.label}@{self.place + 1}" if self.place else self.label


def happenings(motion: Trajectory) -> list[Happening]:
    """Read them from the events of a motion; impacts that lead to lasting contact without anything in between are one landing."""
    found: list[Happening] = []
    times, impacts = motion.segment_starts[1:], motion.is_impact
    phases, compliant = motion.segment_phases, motion.rotor.system.arrays["stiffness"] > 0.0
    limited = np.isin(motion.segment_limits, (UPPER, LOWER))
    changes = (np.diff(phases, axis=0) != 0).any(axis=1) | impacts
    if limited.size:
        changes |= (limited[1:] != limited[:-1]).any(axis=1)
    kinds = impact_kinds(motion)
    for event in np.flatnonzero(changes).tolist():
        time = float(times[event])
        if time <= INSTANT:  # where it begins on a wall it is put to rest there
            continue
        if impacts[event]:
            found.append(Happening(Kind(kinds[event]).label, int(motion.event_planes[event]), event, time, True))
        for plane in np.flatnonzero(phases[event] != phases[event + 1]).tolist():
            before, after = phases[event, plane], phases[event + 1, plane]
            if before == Phase.FLIGHT and not compliant[plane]:
                _land(found, plane, event, time)
            begun = bool(before == Phase.FLIGHT and compliant[plane])
            found.append(Happening(CHANGES[Phase(after)], plane, event, time, begun))
        if limited.size:
            for axis in np.flatnonzero(limited[event] != limited[event + 1]).tolist():
                label = SATURATES if limited[event + 1, axis] else RECOVERS
                found.append(Happening(label, axis, event, time, False))
    return found


def _land(found: list[Happening], plane: int, event: int, time: float) -> None:
    """Make the impacts that lead to a landing one chatter."""
    begun = Happening(LANDS, plane, event, time, False)
    while found and found[-1].place == plane and found[-1].label.startswith("impact"):
        begun = found.pop()._replace(label=LANDS, begins_contact=False)
    found.append(begun)


def impact_kinds(motion: Trajectory) -> np.ndarray:
    """Kinds of the impacts of a motion from the states before them, shape (n,); of other events they mean nothing."""
    arrays, planes = motion.rotor.system.arrays, motion.event_planes
    if not len(planes):
        return np.zeros(0, int)
    _, slip, spare = local_motion(arrays, np.maximum(planes, 0), motion.event_amplitudes).T
    sliding = np.where(slip > 0.0, Kind.IMPACT_FORWARD, Kind.IMPACT_BACKWARD)
    kinds: np.ndarray = np.where(spare >= 0.0, Kind.IMPACT_STOPPED, sliding)
    # Without friction the direction of the slip changes nothing: one motion has one word, that of the closed form.
    return np.where(arrays.friction[planes] > 0.0, kinds, Kind.IMPACT_FORWARD)


def begins_contact(motion: Trajectory) -> np.ndarray:
    """Which events of a motion are impacts at a wall: impacts, and beginnings of contact with compliant walls; bool, shape (n,)."""
    before, after = flying(motion.segment_phases, motion.event_planes)
    compliant = motion.rotor.system.arrays["stiffness"][motion.event_planes] > 0.0
    return motion.is_impact | (before & ~after & compliant)


def first_of_period(motion: Trajectory, count: int) -> int:
    """Number of the impact with which the last period of a motion begins, of ``count`` impacts at different instants."""
    times = motion.segment_starts[1:][begins_contact(motion)]
    if len(motion.rotor.system.arrays.rows) == 1 or not count:
        return len(times) - count
    noted, last = [], -math.inf
    for number, time in enumerate(times.tolist()):
        if time - last > SHORTEST_LAP:
            noted.append(number)
            last = time
    return noted[-min(count, len(noted))]


def word_of(found: Sequence[Happening]) -> str:
    """The same as text."""
    return " ".join(map(str, found))
