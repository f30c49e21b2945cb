"""Contacts with compliant walls, each from entering the wall until leaving it: impulses, peaks, depths and works."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from carom.base.outcome import Phase
from carom.core.wall_work import (
    COLUMNS,
    DEPTH,
    DRIVEN,
    FORCE,
    FORCE_TIME,
    FRICTION,
    HEAT,
    LOST,
    NORMAL,
    contact_works_all,
    stored_energies_all,
)
from carom.motions.contacts import (
    NUMBERED,
    PRESSING,
    Table,
    column,
    polar,
    presses,
    yields,
)
from carom.parameters import Scales

if TYPE_CHECKING:
    from carom.motions.trajectories import Trajectory


@dataclass(frozen=True, eq=False, repr=False)
class TouchLog(Table):
    """Contacts of a plane with a compliant wall, in chronological order; all arrays have shape (n,).

    A contact lasts from entering the wall until leaving it, through sliding, rolling and the times in between in which the plane has
    parted from a wall that comes back more slowly.  The friction ``F`` does the work ``F v`` on the contact point, which slips with
    ``v = s + r(1 + θ̇)``, less the speed of the race's surface if that turns; the drive gives ``−F s``.  Along the normal the wall takes
    the work of its damper, and what its spring holds where plane and wall part.
    """

    touchdown_bearing: np.ndarray = column("1", NUMBERED)
    start: np.ndarray = column("time", "time of entering the wall, or the beginning of the motion")
    end: np.ndarray = column("time", "time of leaving the wall, or the end of the motion")
    duration: np.ndarray = column("time", "time from beginning to end")
    entered: np.ndarray = column("1", "whether the wall was entered: a motion may begin in it")
    lasts: np.ndarray = column("1", "whether it lasts beyond the end of the motion")
    phase: np.ndarray = column("1", "kind of contact that takes most of it")
    angle: np.ndarray = column("rad", "angle at its beginning, in the co-rotating frame")
    angular_speed: np.ndarray = column("speed", "angular speed at its beginning, co-rotating frame")
    radial_speed: np.ndarray = column("velocity", "radial speed on entering, or at the beginning")
    radial_speed_after: np.ndarray = column("velocity", "radial speed on leaving, or at the end")
    normal_impulse: np.ndarray = column("impulse", "integral of the normal force, inward")
    friction_impulse: np.ndarray = column("impulse", "integral of the friction force, along growing angle")
    peak_force: np.ndarray = column("force", "largest normal force")
    peak_time: np.ndarray = column("time", "time of the largest normal force")
    deepest: np.ndarray = column("length", "largest depth in the wall")
    heat: np.ndarray = column("energy", "work lost to friction, never negative")
    normal_loss: np.ndarray = column("energy", "work lost along the normal: in the wall's damper, and on parting")
    drive_work: np.ndarray = column("energy", "work of the shaft's drive through friction")
    scales: Scales | None = None

    dimension: ClassVar[str] = "touch"


class ContactWorks(NamedTuple):
    """What contact does in the segments of a motion in which a plane is at its wall, by the columns of :mod:`carom.core.wall_work`."""

    segments: np.ndarray
    """Numbers of these segments, shape (k,)."""
    found: np.ndarray
    """For each of them and each plane, shape (k, P, 9)."""


def contact_works(motion: Trajectory) -> ContactWorks:
    """Add up the contact at all planes over each segment of a motion."""
    segments = np.flatnonzero((motion.segment_phases != Phase.FLIGHT).any(axis=1))
    found = np.empty((len(segments), motion.segment_phases.shape[1], COLUMNS))
    contact_works_all(
        motion.rotor.system.arrays,
        segments,
        motion.segment_amplitudes,
        motion.segment_phases,
        motion.segment_limits,
        np.fmod(motion.begins + motion.segment_starts[segments], 2.0 * np.pi),
        motion.durations[segments],
        motion.workspace(),
        found,
    )
    return ContactWorks(segments, found)


def stored(motion: Trajectory, amplitudes: np.ndarray, phases: np.ndarray) -> np.ndarray:
    """Energy that the spring of the plane's wall holds in states (n, N) with phases (n,) there; none where there is no contact."""
    position, _ = motion.rotor.system.at_plane(amplitudes, motion.plane)
    held = presses(phases)
    energy = np.zeros(len(amplitudes))
    energy[held] = stored_energies_all(motion.rotor.system.arrays, motion.plane, np.abs(position[held]) - 1.0)
    return energy


def lost_on_parting(motion: Trajectory) -> np.ndarray:
    """Energy of the wall's spring that is lost in each event, (n,): where plane and wall part, less what it holds where they meet again."""
    phases = motion.segment_phases[:, motion.plane]
    parted = phases == Phase.SEPARATED
    lost = stored(motion, motion.arrivals, phases[:-1]) - stored(motion, motion.segment_amplitudes[1:], phases[1:])
    return np.where(parted[:-1] | parted[1:], lost, 0.0)


def touches_of(motion: Trajectory, works: ContactWorks | None = None) -> TouchLog:
    """Contacts with the wall at the plane of a motion, whose :func:`contact_works` may be known; none if that is rigid."""
    system, plane = motion.rotor.system, motion.plane
    phases = motion.segment_phases[:, plane]
    inside = (phases != Phase.FLIGHT) & yields(system, plane)
    first, after = np.flatnonzero(np.diff(np.concatenate([[0], inside, [0]]))).reshape(-1, 2).T
    bounds, segments = np.append(motion.segment_starts, motion.time), np.flatnonzero(inside)
    known = works or contact_works(motion)
    at = known.found[np.searchsorted(known.segments, segments), plane].T
    begins = np.searchsorted(segments, first)
    edges = np.append(begins, len(segments))

    def total(column: int) -> np.ndarray:
        return np.add.reduceat(at[column], begins)

    hardest = np.array([begin + at[FORCE, begin:end].argmax() for begin, end in pairwise(edges)], int)
    lasted = motion.durations[segments]
    takes = [np.add.reduceat(np.where(phases[segments] == kind, lasted, 0.0), begins) for kind in PRESSING]
    parted = np.concatenate([[0.0], np.cumsum(lost_on_parting(motion))])
    angle, radial, angular = polar(*system.at_plane(motion.segment_amplitudes[first], plane))
    _, radial_after, _ = polar(*system.at_plane(motion.ends_of(after - 1), plane))
    return TouchLog(
        touchdown_bearing=np.full(len(first), plane + 1),
        start=bounds[first],
        end=bounds[after],
        duration=bounds[after] - bounds[first],
        entered=first > 0,
        lasts=after == len(phases),
        phase=np.array(PRESSING)[np.argmax(takes, axis=0)],
        angle=angle,
        angular_speed=angular,
        radial_speed=radial,
        radial_speed_after=radial_after,
        normal_impulse=total(NORMAL),
        friction_impulse=total(FRICTION),
        peak_force=at[FORCE, hardest],
        peak_time=bounds[segments[hardest]] + at[FORCE_TIME, hardest],
        deepest=np.maximum.reduceat(at[DEPTH], begins),
        heat=total(HEAT),
        normal_loss=total(LOST) + parted[np.minimum(after, len(parted) - 1)] - parted[first],
        drive_work=-(system.contacts[plane].wall.surface_speed - 1.0) * total(DRIVEN),
        scales=motion.scales,
    )
