"""Sums of what a motion asks of its touchdown bearings, piece by piece: of a piece that has been added nothing is kept but its last turns."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from carom.arguments import Count, checked
from carom.closed_forms.exact_results import exact_results
from carom.closed_forms.hertz import ball_pressure
from carom.core.wall_work import DEPTH, FORCE, HEAT, POWER
from carom.models import Subject
from carom.motions.bearing_loads import Braking, DropLoads, FirstContact, PlaneLoads
from carom.motions.contacts import ContactLog, presses, race_speed, yields
from carom.motions.last_whirl import LAST_TURNS, last_whirl
from carom.motions.ledger import contact_power
from carom.motions.loads import TouchdownLoads
from carom.motions.magnets import MagnetReach, reach_with
from carom.motions.simulation import stretches
from carom.motions.starts import Beginning, State, Until
from carom.motions.touches import ContactWorks, contact_works, touches_of
from carom.motions.trajectories import Trajectory, joined
from carom.outcome import Outcome, Phase
from carom.progress import ShowProgress, shows_progress

RECENT, MOST_RECENT = 10, 4096
"""Impacts over which the power of bouncing is averaged: so many at least, and at most."""
MOST_KEPT = 16_384
"""Most segments that are kept for the last turns; where these have more the whirl is that of fewer turns."""


@checked
@shows_progress
def follow_loads(
    machine: Subject,
    start: State | Beginning,
    until: Until | None = None,
    *,
    settle: bool | None = None,
    max_events: Count = 1_000_000,
    progress: ShowProgress = None,
) -> DropLoads:
    """Follow a start as :func:`carom.simulate` does, and add up its loads as it goes: memory does not grow with the length of contact.

    Parameters
    ----------
    machine, start, until, settle, max_events
        See :func:`carom.simulate`.

    See Also
    --------
    carom.motions.drop_loads : the same of a motion that has been recorded

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/touchdown-balls.toml")
    >>> (plane,) = cm.motions.follow_loads(machine, cm.drop(), "100 ms").planes
    >>> print(f"{plane.loads.si()['force']:.0f} N")
    1318 N
    """
    sums = LoadSums()
    for piece in stretches(machine, start, until, settle=settle, max_events=max_events, progress=progress):
        sums.add(piece)
    return sums.loads()


@checked
def drop_loads(motion: Trajectory) -> DropLoads:
    """Evaluate a drop, or any other touchdown, over all its stages and at all contact planes.

    A contact that goes on from one stage into the next counts once.

    Parameters
    ----------
    motion : Trajectory
        The last stage, as :func:`carom.simulate` returns it.

    See Also
    --------
    carom.motions.follow_loads : the same of a motion that is not recorded
    carom.drop : levitation lost
    carom.studies.check_loads : compare the ``loads`` of a plane with the limits of the bearing
    carom.plots.drop_orbit, carom.plots.drop_loads : draw it

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/touchdown-balls.toml")
    >>> loads = cm.motions.drop_loads(cm.simulate(machine, cm.drop(), "100 ms"))
    >>> (plane,) = loads.planes
    >>> print(f"{plane.loads.si()['force']:.0f} N after {1e3 * plane.force_at * machine.parameters.scales.time:.1f} ms")
    1318 N after 6.0 ms
    """
    sums = LoadSums()
    for part in motion.parts:
        sums.add(part)
    return sums.loads()


@checked
def touchdown_loads(trajectory: Trajectory) -> TouchdownLoads:
    """Evaluate the loads of a motion, or of its last stage, at its contact plane.

    Friction does the work ``F v`` on the contact point, which slips with ``v = s + 1 + θ̇``; in an impact the work is that of the
    impulse on the mean of the slip velocities before and after.  Loads on a wall that gives way are those of :attr:`Trajectory.touches`.
    """
    sums = _AtPlane()
    sums.add(trajectory, contact_works(trajectory))
    return sums.loads(trajectory)


class LoadSums:
    """Loads of the pieces of a motion that have been added, in their order."""

    def __init__(self) -> None:
        self._planes: list[_AtPlane] = []
        self._kept: list[Trajectory] = []
        self._left_out = 0.0
        self._magnets: MagnetReach | None = None

    def add(self, piece: Trajectory) -> None:
        """Add a piece, or a whole stage."""
        if not self._planes:
            self._planes = [_AtPlane() for _ in piece.rotor.system.contacts]
        if self._kept and self._kept[-1].begins != piece.begins:
            self._kept.clear()
        self._kept.append(piece)
        self._magnets = reach_with(self._magnets, piece)
        works = contact_works(piece)
        for plane, sums in enumerate(self._planes):
            # What a motion keeps of itself at each plane refers to it: only the garbage collector would free a piece.
            sums.add(replace(piece, plane=plane), works)
        if (shaft := piece.rotor.system.shaft) is not None:
            flown = piece.durations[~presses(piece.segment_phases).any(axis=1)]
            self._left_out += float(flown.sum()) * shaft.drive
        begins = piece.time - LAST_TURNS * 2.0 * math.pi
        while len(self._kept) > 1 and (self._kept[0].time < begins or self._size() > MOST_KEPT):
            del self._kept[0]

    def _size(self) -> int:
        return sum(len(piece.segment_starts) for piece in self._kept)

    def loads(self) -> DropLoads:
        """Loads of all that has been added."""
        last = joined(self._kept)
        rotor, shaft = last.rotor, None
        if rotor.system.shaft is not None:
            shaft = Braking(last.final.shaft[0], self._left_out, rotor.scales)
        planes = (sums.found(seen) for sums, seen in zip(self._planes, last.at_each, strict=True))
        return DropLoads(
            rotor=rotor,
            outcome=last.outcome,
            multiplicity=last.multiplicity,
            time=last.begins + last.time,
            planes=tuple(planes),
            shaft=shaft,
            magnets=self._magnets,
            scales=rotor.scales,
        )


class _Contacts(NamedTuple):
    """Contacts of a piece, or impacts on a rigid wall; arrays of shape (n,), times from the beginning of the motion."""

    starts: np.ndarray
    peak_times: np.ndarray
    peaks: np.ndarray
    impulses: np.ndarray
    speeds: np.ndarray
    after: np.ndarray
    heat: np.ndarray
    entered: np.ndarray
    left: np.ndarray


@dataclass
class _AtPlane:
    """Sums of a plane."""

    begins: float = 0.0
    contact_time: float = 0.0
    heat: float = 0.0
    restitution_loss: float = 0.0
    largest: np.ndarray = field(default_factory=lambda: np.zeros(9))
    contacts: int = 0
    bounces: int = 0
    force: tuple[float, float | None] = (-1.0, None)
    impulse: tuple[float, float | None] = (0.0, None)
    fastest: tuple[float, float | None] = (0.0, None)
    first: FirstContact | None = None
    open: _Contacts | None = None
    recent: np.ndarray = field(default_factory=lambda: np.zeros((2, 0)))
    race: float = 0.0
    since: float | None = None
    turned_back: dict[int, float] = field(default_factory=lambda: {1: 0.0, -1: 0.0})

    def add(self, seen: Trajectory, works: ContactWorks) -> None:
        """Add a piece, seen at the plane."""
        system, plane, begins = seen.rotor.system, seen.plane, seen.begins
        if self.begins != begins:
            self.begins, self.recent = begins, np.zeros((2, 0))
        self.contact_time += float(seen.durations[presses(seen.segment_phases[:, plane])].sum())
        steps = works.found[:, plane]
        self.heat += float(steps[:, HEAT].sum())
        self.largest = np.maximum(self.largest, steps.max(axis=0, initial=0.0))
        if yields(system, plane):
            touches = touches_of(seen, works)
            self.restitution_loss += float(touches.normal_loss.sum())
            self._count(
                _Contacts(
                    begins + touches.start,
                    begins + touches.peak_time,
                    touches.peak_force,
                    touches.normal_impulse,
                    touches.radial_speed,
                    touches.radial_speed_after,
                    touches.heat,
                    touches.entered,
                    ~touches.lasts,
                )
            )
        else:
            self._strike(seen)
        self._move(seen)

    def _strike(self, seen: Trajectory) -> None:
        """Add the impacts on a rigid wall."""
        log = seen.contacts
        # A landing stands for the last bounces of a chatter.
        landings = seen.log_of(seen.is_landing & (seen.event_planes == seen.plane))
        works, times = _friction_work(log), seen.begins + log.time
        self.heat += float(works.sum() + _friction_work(landings).sum())
        self.restitution_loss += float(_normal_work(log).sum() + _normal_work(landings).sum())
        after, none = log.radial_speed_after, np.zeros(len(log))
        entered = np.ones(len(log), bool)
        self._count(
            _Contacts(times, times, none, log.normal_impulse, log.radial_speed, after, works, entered, after < 0.0)
        )

    def _count(self, each: _Contacts) -> None:
        """Count contacts; the first of them may go on from before, and the last may last."""
        if not len(each.starts):
            self.open = None
            return
        goes_on = not each.entered[0]
        self.contacts += int(each.entered.sum()) + int(goes_on and self.open is None)
        if goes_on and self.open is not None:
            each = _with_earlier(each, self.open)
            self.recent = self.recent[:, :-1]
        self.bounces += int(each.left.sum())
        hardest = int(each.peaks.argmax())
        if each.peaks[hardest] > self.force[0]:
            self.force = float(each.peaks[hardest]), float(each.peak_times[hardest])
        whole = np.where(each.left | (each.peaks == 0.0), each.impulses, 0.0)
        place = int(whole.argmax())
        if whole[place] > self.impulse[0]:
            self.impulse = float(whole[place]), float(each.peak_times[place])
        speeds = np.where(each.entered & each.left, each.speeds, 0.0)
        place = int(speeds.argmax())
        if speeds[place] > self.fastest[0]:
            self.fastest = float(speeds[place]), float(-each.after[place] / speeds[place])
        self._note_first(each)
        self.recent = np.hstack([self.recent, [each.starts, each.heat]])[:, -MOST_RECENT:]
        self.open = None if each.left[-1] else _Contacts(*(column[-1:] for column in each))

    def _note_first(self, each: _Contacts) -> None:
        """Note the first contact that has a force, until it is over."""
        pressing = np.flatnonzero(each.peaks > 0.0)
        if len(pressing) and (self.first is None or not self.first.over):
            at = int(pressing[0])
            self.first = FirstContact(
                float(each.peaks[at]), float(each.starts[at]), float(each.peak_times[at]), bool(each.left[at])
            )

    def _move(self, seen: Trajectory) -> None:
        """Note how fast the race turns, since when the plane is at the wall, and when it last turned back."""
        amplitudes, begins = np.concatenate([seen.segment_amplitudes, seen.last_amplitudes[None]]), seen.begins
        speeds = race_speed(seen.rotor.system, seen.plane, amplitudes)
        self.race = float(max(self.race, *speeds[[speeds.argmax(), speeds.argmin()]], key=abs))
        bounds = begins + np.append(seen.segment_starts, seen.time)
        flying = np.flatnonzero(seen.segment_phases[:, seen.plane] == Phase.FLIGHT)
        if len(flying):
            self.since = float(bounds[flying[-1] + 1]) if flying[-1] + 1 < len(seen.segment_starts) else None
        elif self.since is None:
            self.since = float(bounds[0])
        place, rate = seen.rotor.system.at_plane(amplitudes[:-1], seen.plane)
        spin = (place.conj() * rate).imag + np.abs(place) ** 2
        for sense in self.turned_back:
            other = np.flatnonzero(spin * sense <= 0.0)
            if len(other):
                self.turned_back[sense] = float(bounds[other[-1] + 1])

    def loads(self, last: Trajectory) -> TouchdownLoads:
        """Loads up to the end of a piece."""
        rotor, scales, plane = last.rotor, last.scales, last.plane
        soft = yields(rotor.system, plane)
        force, bearing = float(self.largest[FORCE]), rotor.definition.bearing_at(plane)
        if not soft and last.outcome is Outcome.ROLLING:
            force = max(force, exact_results(rotor).rolling_force)
        return TouchdownLoads(
            outcome=last.outcome,
            impacts=self.contacts,
            impulse=self.impulse[0],
            force=force,
            depth=float(self.largest[DEPTH]),
            power=float(self.largest[POWER]),
            heat=self.heat,
            restitution_loss=self.restitution_loss,
            contact_time=self.contact_time,
            lasting_power=self._lasting_power(last),
            scales=scales,
            pressure=None if bearing is None or scales is None else ball_pressure(bearing, force * scales.force),
        )

    def _lasting_power(self, last: Trajectory) -> float:
        """Power of friction with which a settled motion goes on."""
        phase = last.segment_phases[-1, last.plane]
        if not last.outcome.settled or last.outcome is Outcome.LEVITATED or phase == Phase.ROLLING:
            return 0.0
        if presses(phase):
            return float(-contact_power(last, np.array([last.time]))[0][0])
        times, works = self.recent[:, -max(RECENT, 2 * last.multiplicity) - 1 :]
        return float(works[1:].sum() / (times[-1] - times[0])) if len(times) > 1 else 0.0

    def found(self, last: Trajectory) -> PlaneLoads:
        """All that is told of the plane at the end of a piece, which reaches back over the last turns."""
        soft, race = yields(last.rotor.system, last.plane), last.rotor.races[last.plane]
        at_end = race_speed(last.rotor.system, last.plane, last.last_amplitudes)
        return PlaneLoads(
            plane=last.plane,
            gives_way=soft,
            loads=self.loads(last),
            force_at=self.force[1] if soft else None,
            impulse_at=self.impulse[1],
            contacts=self.contacts,
            bounces=self.bounces,
            restitution=self.fastest[1],
            race_at_end=None if race is None else float(at_end / race.radius),
            fastest_race=None if race is None else self.race / race.radius,
            in_contact_since=self.since,
            whirl=last_whirl(last, self.turned_back, self.since),
            first=self.first,
            scales=last.scales,
        )


def _with_earlier(each: _Contacts, earlier: _Contacts) -> _Contacts:
    """Contacts of which the first goes on from an earlier piece."""
    each = _Contacts(*(column.copy() for column in each))
    if earlier.peaks[0] >= each.peaks[0]:
        each.peaks[0], each.peak_times[0] = earlier.peaks[0], earlier.peak_times[0]
    for column, before in ((each.impulses, earlier.impulses), (each.heat, earlier.heat)):
        column[0] += before[0]
    for column, before in zip(
        (each.starts, each.speeds, each.entered), (earlier.starts, earlier.speeds, earlier.entered), strict=True
    ):
        column[0] = before[0]
    return each


def _friction_work(log: ContactLog) -> np.ndarray:
    """Work lost to friction in impacts, shape (n,)."""
    work: np.ndarray = -0.5 * log.tangential_impulse * (log.slip_before + log.slip_after)
    return work


def _normal_work(log: ContactLog) -> np.ndarray:
    """Work lost along the normal in impacts, shape (n,)."""
    work: np.ndarray = 0.5 * log.normal_impulse * (log.radial_speed + log.radial_speed_after)
    return work
