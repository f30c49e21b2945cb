"""Contacts of a motion with its touchdown bearings, of whatever law: one log, and the impulses in events and works in segments that it is made of.

An impact on a rigid touchdown bearing is a contact of no duration.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from carom.base.outcome import Phase
from carom.core.friction import rebound
from carom.core.wall_work import (
    COLUMNS,
    DAMPED,
    DEPTH,
    DRIVEN,
    FORCE,
    FORCE_TIME,
    FRICTION,
    HEAT,
    NORMAL,
    contact_works_all,
    stored_energies_all,
)
from carom.motions.kinematics import PRESSING, is_compliant, polar, presses, shaft_speed, slip_velocity
from carom.motions.tables import NUMBERED, LogTable, column

if TYPE_CHECKING:
    from carom.models import System
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales


UNLIKE = 1e-9
"""Difference of radial speeds, relative to one plus the speed, above which an impact was not by Newton's restitution; impulses
below that are too small to tell."""


@dataclass(frozen=True, eq=False, repr=False)
class ContactLog(LogTable):
    """Contacts of a motion in chronological order, one entry each; all arrays have shape (n,).

    On a rigid touchdown bearing a contact is an impact: it has an impulse, and no force (``peak_force`` is not a number).  Alone, its normal
    impulse is ``m_p (1 + d) ṙ`` with the effective mass ``m_p = 1/(W M⁻¹ Wᴴ)``, which is the whole mass for the planar rotor.  Of bearings
    with impacts in one instant it is that of the joint solution (:mod:`carom.core.joint`), and each bearing has an entry.  Heat and normal loss
    follow from the means of the velocities before and after; the work of the drive is the kinetic energy gained without it, which a shaft whose
    speed changes gives from its own.

    In a compliant one a contact lasts from entering the wall until leaving it, through sliding, rolling and the times in between in which the
    rotor has parted from a wall that comes back more slowly.  The friction ``F`` does the work ``F v`` on the contact point; the drive gives ``−F s``.
    Along the normal the wall takes the work of its damper, and what its spring holds where rotor and wall part.

    The slip velocity of the contact point is ``v = s + r(1 + θ̇)``, less the speed of the race's surface if that turns.
    """

    time: np.ndarray = column("time", "time of the impact, of entering the wall, or of the start of the motion", "time")
    end: np.ndarray = column("time", "time of leaving the wall, or of the end of the motion")
    touchdown_bearing: np.ndarray = column("1", NUMBERED, "bearing")
    duration: np.ndarray = column("time", "time from beginning to end, zero for an impact", "duration")
    entered: np.ndarray = column("1", "whether the wall was entered during the motion (a motion may start in contact)")
    lasts: np.ndarray = column("1", "whether it lasts beyond the end of the motion")
    phase: np.ndarray = column("1", "dominant kind of contact, or the kind with which an impact ends")
    angle: np.ndarray = column("rad", "angle at its beginning, in the co-rotating frame", "angle")
    radial_speed: np.ndarray = column(
        "velocity", "radial speed before it, or at the beginning of the motion", "speed towards wall"
    )
    angular_speed: np.ndarray = column("speed", "angular speed before it, co-rotating frame")
    radial_speed_after: np.ndarray = column("velocity", "radial speed after it, or at the end of the motion")
    angular_speed_after: np.ndarray = column("speed", "angular speed after it, co-rotating frame")
    normal_impulse: np.ndarray = column(
        "impulse", "normal impulse of the bearing on the rotor, inward", "normal impulse"
    )
    friction_impulse: np.ndarray = column(
        "impulse", "friction impulse on the rotor, positive in the sense of rotation", "friction impulse"
    )
    slip_before: np.ndarray = column("velocity", "slip velocity before it")
    slip_after: np.ndarray = column("velocity", "slip velocity after it", "slip after")
    sticks: np.ndarray = column("1", "whether friction has stopped the slip at its end")
    by_poisson: np.ndarray = column("1", "whether Poisson's restitution replaced Newton's")
    peak_force: np.ndarray = column("force", "largest normal force", "peak force")
    peak_time: np.ndarray = column("time", "time of the largest normal force, or of the impact")
    deepest: np.ndarray = column("length", "largest depth in the wall")
    heat: np.ndarray = column("energy", "work lost to friction")
    normal_loss: np.ndarray = column("energy", "work lost along the normal")
    drive_work: np.ndarray = column("energy", "work of the shaft through friction")
    scales: Scales | None = None

    dimension: ClassVar[str] = "contact"
    shown: ClassVar[tuple[str, ...]] = (
        "time",
        "duration",
        "touchdown_bearing",
        "angle",
        "radial_speed",
        "normal_impulse",
        "friction_impulse",
        "slip_after",
        "peak_force",
    )

    @property
    def is_impact(self) -> np.ndarray:
        """Which of them are impacts on a rigid touchdown bearing, bool, shape (n,)."""
        return np.isnan(self.peak_force)

    @property
    def contact_work(self) -> np.ndarray:
        """Work on the contact point, never positive in the sum over bearings with impacts in one instant."""
        return -self.normal_loss - self.heat

    @property
    def left(self) -> np.ndarray:
        """Which of them the rotor has left again: an impact, where it bounced."""
        return np.where(self.is_impact, self.radial_speed_after < 0.0, ~self.lasts)

    @classmethod
    def joined(cls, logs: Sequence[tuple[float, ContactLog]]) -> ContactLog:
        """Logs of several stages or pieces as one, each with the time from which its times count."""
        columns: dict[str, np.ndarray] = {
            name: np.concatenate([getattr(log, name) for _, log in logs]) for name in cls.columns
        }
        begins = np.repeat([since for since, _ in logs], [len(log) for _, log in logs])
        return cls(**columns | {name: columns[name] + begins for name in _INSTANTS}, scales=logs[0][1].scales)

    def some(self, chosen: np.ndarray) -> ContactLog:
        """Those that are chosen."""
        columns: dict[str, np.ndarray] = {name: getattr(self, name)[chosen] for name in self.columns}
        return ContactLog(**columns, scales=self.scales)

    @property
    def whole(self) -> ContactLog:
        """The same where one that is not entered goes on from one before that lasts: both are one contact."""
        begun = np.ones(len(self), bool)
        begun[1:] = self.entered[1:] | self.left[:-1]
        first, last = np.flatnonzero(begun), np.flatnonzero(np.append(begun[1:], True))
        if begun.all():
            return self
        peaks = np.maximum.reduceat(self.peak_force, first)
        hardest = self.peak_force == np.repeat(peaks, last - first + 1)
        columns: dict[str, np.ndarray] = {
            name: getattr(self, name)[last if name in _AT_END else first] for name in self.columns
        }
        columns |= {name: np.add.reduceat(getattr(self, name), first) for name in _SUMS}
        columns["peak_time"] = np.minimum.reduceat(np.where(hardest, self.peak_time, np.inf), first)
        columns["deepest"] = np.maximum.reduceat(self.deepest, first)
        return ContactLog(**columns | {"peak_force": peaks}, scales=self.scales)


_INSTANTS = ("time", "end", "peak_time")
_AT_END = ("end", "lasts", "radial_speed_after", "angular_speed_after", "slip_after", "sticks")
_SUMS = ("duration", "normal_impulse", "friction_impulse", "heat", "normal_loss", "drive_work")


def contacts_of(motion: Trajectory, works: ContactWorks | None = None) -> ContactLog:
    """Contacts at the plane of a motion, whose :func:`contact_works` may be known."""
    if is_compliant(motion.rotor.system, motion.plane):
        return _contacts_in_wall(motion, works or contact_works(motion))
    return impacts_of(motion, motion.impulses(motion.is_impact).at(motion.plane))


def impacts_of(motion: Trajectory, impulses: Impulses) -> ContactLog:
    """Log of impulses at rigid touchdown bearings."""
    system, events, planes = motion.rotor.system, impulses.events, impulses.planes
    arrays, times = system.arrays, motion.segment_starts[1:][events]
    before, after = motion.event_amplitudes[events], motion.segment_amplitudes[1:][events]
    mass, none = arrays.masses[planes], np.zeros(len(planes))
    normal, friction = -mass * impulses.sizes.real, mass * impulses.sizes.imag
    seen = _states(motion, planes, before, after)
    radial, radial_after, slip = seen["radial_speed"], seen["radial_speed_after"], seen["slip_after"]
    newton = np.zeros(len(planes))
    for plane, contact in enumerate(system.contacts):
        here = planes == plane
        newton[here] = rebound(np.maximum(radial[here], 0.0), contact.wall)
    unlike = np.abs(radial_after + newton) > UNLIKE * (1.0 + radial)
    sticks = arrays.friction[planes] * normal >= np.abs(mass * slip - friction)
    spin, spin_after = (shaft_speed(system, each) for each in (before, after))
    slides = np.where(slip < 0.0, Phase.BACKWARD_SLIP, Phase.FORWARD_SLIP)
    return ContactLog(
        time=times,
        end=times,
        touchdown_bearing=planes + 1,
        duration=none,
        entered=none == 0.0,
        lasts=none > 0.0,
        phase=np.where(sticks, Phase.ROLLING, slides),
        normal_impulse=normal,
        friction_impulse=friction,
        sticks=sticks,
        by_poisson=np.isin(events, events[unlike & (-impulses.sizes.real > UNLIKE)]),
        peak_force=np.full(len(planes), np.nan),
        peak_time=times,
        deepest=none,
        heat=-0.5 * friction * (seen["slip_before"] + slip),
        normal_loss=0.5 * normal * (radial + radial_after),
        drive_work=-(arrays.surface_speed[planes] - 1.0) * (0.5 * (spin + spin_after)) * friction,
        scales=motion.scales,
        **seen,
    )


def _contacts_in_wall(motion: Trajectory, works: ContactWorks) -> ContactLog:
    """Contacts with the compliant touchdown bearing at the plane of a motion."""
    system, plane = motion.rotor.system, motion.plane
    phases = motion.segment_phases[:, plane]
    inside = phases != Phase.FLIGHT
    first, after = np.flatnonzero(np.diff(np.concatenate([[0], inside, [0]]))).reshape(-1, 2).T
    bounds, segments = np.append(motion.segment_starts, motion.time), np.flatnonzero(inside)
    at = works.found[np.searchsorted(works.segments, segments), plane].T
    begins = np.searchsorted(segments, first)
    edges = np.append(begins, len(segments))

    def total(column: int) -> np.ndarray:
        return np.add.reduceat(at[column], begins)

    hardest = np.array([begin + at[FORCE, begin:end].argmax() for begin, end in pairwise(edges)], int)
    lasted = motion.durations[segments]
    takes = [np.add.reduceat(np.where(phases[segments] == kind, lasted, 0.0), begins) for kind in PRESSING]
    parted = np.concatenate([[0.0], np.cumsum(lost_on_parting(motion))])
    planes = np.full(len(first), plane)
    return ContactLog(
        time=bounds[first],
        end=bounds[after],
        touchdown_bearing=planes + 1,
        duration=bounds[after] - bounds[first],
        entered=first > 0,
        lasts=after == len(phases),
        phase=np.array(PRESSING)[np.argmax(takes, axis=0)],
        normal_impulse=total(NORMAL),
        friction_impulse=total(FRICTION),
        sticks=phases[after - 1] == Phase.ROLLING,
        by_poisson=planes < 0,
        peak_force=at[FORCE, hardest],
        peak_time=bounds[segments[hardest]] + at[FORCE_TIME, hardest],
        deepest=np.maximum.reduceat(at[DEPTH], begins),
        heat=total(HEAT),
        normal_loss=total(DAMPED) + parted[np.minimum(after, len(parted) - 1)] - parted[first],
        drive_work=-(system.contacts[plane].wall.surface_speed - 1.0) * total(DRIVEN),
        scales=motion.scales,
        **_states(motion, planes, motion.segment_amplitudes[first], motion.ends_of(after - 1)),
    )


def _states(motion: Trajectory, planes: np.ndarray, before: np.ndarray, after: np.ndarray) -> dict[str, np.ndarray]:
    """Columns of angles and speeds in amplitudes (n, N) before and after contacts at planes (n,)."""
    system, slips = motion.rotor.system, np.zeros((2, len(planes)))
    angle, radial, angular = polar(*system.at_planes(before, planes))
    _, radial_after, angular_after = polar(*system.at_planes(after, planes))
    for plane in np.unique(planes).tolist():
        here = planes == plane
        slips[0, here], slips[1, here] = (slip_velocity(system, plane, each[here]) for each in (before, after))
    return {
        "angle": angle,
        "radial_speed": radial,
        "angular_speed": angular,
        "radial_speed_after": radial_after,
        "angular_speed_after": angular_after,
        "slip_before": slips[0],
        "slip_after": slips[1],
    }


AT_WALL = 1e-9
"""Distance from its wall up to which a plane may have had its impact together with another (:data:`carom.core.joint.ONE_INSTANT`), with
a margin for the rounding of states: of a plane without impact the equations give none but a rounding error."""
NONE, ROUNDING = 1e-12, 1e-14
"""Impulse, relative to the largest in the event and to the terms of velocities, below which a plane at its wall had no impact."""


class Impulses(NamedTuple):
    """Impulses at planes; arrays of shape (k,)."""

    events: np.ndarray
    """Number of the event."""
    planes: np.ndarray
    """Contact plane."""
    sizes: np.ndarray
    """Impulse on the rotor per effective mass of the plane, ``−P + iF``: outward, and along growing angle.  Complex."""

    def at(self, plane: int) -> Impulses:
        """Those at one plane."""
        here = self.planes == plane
        return Impulses(*(part[here] for part in self))


def impulses_of(motion: Trajectory, events: np.ndarray) -> Impulses:
    """Impulses that have changed the amplitudes of a rotor in some events, by their numbers, shape (n,).

    Of a plane alone the impulse is the change of its own velocity.  Where others are at their walls too, the impulses
    follow from the changes of velocity at all of these: ``Δu_p = Σ_q A_pq π_q`` (:mod:`carom.core.joint`), less those by the unbalance of
    a shaft whose speed jumps.  Of planes that always
    move alike only the sum of their impulses counts, which is given to them in equal parts.
    """
    system, planes = motion.rotor.system, motion.event_planes[events]
    lasting = motion.segment_phases[events] != Phase.FLIGHT
    before, after = motion.event_amplitudes[events], motion.segment_amplitudes[events + 1]
    arrays, places, count = system.arrays, np.arange(len(events)), lasting.shape[1]
    pushed = (before, _without_jolt(system, before, after))
    states = [[system.at_planes(each, np.full(len(events), p)) for p in range(count)] for each in pushed]
    position = np.stack([place for place, _ in states[0]], axis=-1)
    normal = position / np.abs(position)
    speeds = [
        np.stack([radial + 1j * along for _, radial, along in (polar(*at) for at in each)], axis=-1) for each in states
    ]
    changes = speeds[1] - speeds[0]
    at_wall = (lasting | (np.abs(position) >= 1.0 - AT_WALL)) & (arrays.stiffness == 0.0)
    at_wall[places, planes] = True
    impulses = np.where(at_wall, changes, 0.0)
    for event in np.flatnonzero(at_wall.sum(axis=1) > 1):
        here = np.flatnonzero(at_wall[event])
        couplings = normal[event, here].conj()[:, None] * arrays.mobility[np.ix_(here, here)] * normal[event, here]
        impulses[event, here] = np.linalg.lstsq(couplings, changes[event, here])[0]
    sizes, terms = np.abs(impulses), np.abs(before) @ np.abs(arrays.rate_rows).T
    has_impact = sizes > NONE * sizes.max(axis=1, initial=0.0, keepdims=True) + ROUNDING * terms
    has_impact[places, planes] |= ~has_impact.any(axis=1)
    rows, columns = np.nonzero(has_impact)
    return Impulses(events[rows], columns, impulses[rows, columns])


def _without_jolt(system: System, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Amplitudes after events without the impulse of the unbalance, which moves the rotor as the speed of its shaft jumps."""
    if system.shaft is None:
        return after
    direction = before[:, int(system.arrays.shaft[0]), None]
    jump = shaft_speed(system, after) - shaft_speed(system, before)
    freed: np.ndarray = after + 1j * jump[:, None] * direction * system.arrays.unbalance
    return freed


class ContactWorks(NamedTuple):
    """What contact does in the segments of a motion in which a plane is at its wall, by the columns of :mod:`carom.core.wall_work`."""

    segments: np.ndarray
    """Numbers of these segments, shape (k,)."""
    found: np.ndarray
    """For each of them and each plane, shape (k, P, 10)."""


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
    lost = stored(motion, motion.event_amplitudes, phases[:-1]) - stored(
        motion, motion.segment_amplitudes[1:], phases[1:]
    )
    return np.where(parted[:-1] | parted[1:], lost, 0.0)
