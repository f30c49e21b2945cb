"""Sums of what a motion asks of its touchdown bearings, piece by piece: of a piece that has been added nothing is kept but its contacts and last turns."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from carom.base.arguments import Count, checked
from carom.base.outcome import Outcome, Phase
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.closed_forms.exact_results import exact_results
from carom.core.wall_work import COLUMNS, DEPTH, FORCE, HEAT, POWER, ROLLED
from carom.models import Subject
from carom.motions.contacts import ContactLog, ContactWorks, contact_works, contacts_of
from carom.motions.heating import RaceRecord, Temperatures, race_run
from carom.motions.kinematics import presses
from carom.motions.loads import (
    GOING_ROUND,
    Braking,
    CatalogueLoads,
    DropLoads,
    FirstContact,
    LastWhirl,
    TouchdownLoads,
    reach_with,
)
from carom.motions.settling import PATIENCE
from carom.motions.simulation import Following, stretches
from carom.motions.starts import Beginning, State, Until
from carom.motions.trajectories import Trajectory, joined
from carom.parameters import TouchdownBearing

RECENT = 10
"""Impacts over which the power of bouncing is averaged, at least."""
AT_THE_END = 0.98
"""Share of the time of a motion after which its largest force came at its end, in contact: a slow whirl may still speed up."""
PER_LIFE = 1e6
"""Turns of a bearing under its dynamic load rating (ISO 281)."""
LAST_TURNS = 8.0
"""Turns of the shaft at the end over which the whirl is averaged."""
PER_RADIAN = 2.0
"""Instants for each radian of the fastest mode at which the angle is looked at; it must not go half round in between."""
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
    >>> print(f"{plane.si()['force']:.0f} N")
    1318 N
    """
    following = Following(settle, False, PATIENCE, max_events, Reporter.of(progress, "simulating"))
    return loads_of(stretches(machine, start, until, following))


@checked
def drop_loads(motion: Trajectory) -> DropLoads:
    """Evaluate a drop, or any other touchdown, over all its stages and at all contact planes.

    A contact that goes on from one stage into the next counts once.  Friction does the work ``F v`` on the contact point, which slips with
    ``v = s + 1 + θ̇``; in an impact the work is that of the impulse on the mean of the slip velocities before and after.  Loads on a compliant
    wall are those of :attr:`Trajectory.contacts`.

    Parameters
    ----------
    motion : Trajectory
        The last stage, as :func:`carom.simulate` returns it.

    See Also
    --------
    carom.motions.follow_loads : the same of a motion that is not recorded
    carom.drop : levitation lost
    carom.studies.check_loads : compare the ``loads`` of a plane with the limits of the bearing
    carom.plots.drop_orbit, carom.plots.touchdown : draw it

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/touchdown-balls.toml")
    >>> loads = cm.motions.drop_loads(cm.simulate(machine, cm.drop(), "100 ms"))
    >>> (plane,) = loads.planes
    >>> print(f"{plane.si()['force']:.0f} N after {1e3 * plane.force_at * machine.parameters.scales.time:.1f} ms")
    1318 N after 6.0 ms
    """
    return loads_of(motion.parts)


def loads_of(pieces: Iterable[Trajectory]) -> DropLoads:
    """Loads of pieces of a motion, or of whole stages, in their order."""
    planes: list[_AtPlane] = []
    kept: list[Trajectory] = []
    left_out, magnets = 0.0, None
    for piece in pieces:
        system = piece.rotor.system
        planes = planes or [_AtPlane() for _ in system.contacts]
        if kept and kept[-1].begins != piece.begins:
            kept.clear()
        kept.append(piece)
        magnets = reach_with(magnets, piece)
        works = contact_works(piece)
        for plane, sums in enumerate(planes):
            # What a motion keeps of itself at each plane refers to it: only the garbage collector would free a piece.
            sums.add(replace(piece, plane=plane), works)
        if system.shaft is not None:
            flown = piece.durations[~presses(piece.segment_phases).any(axis=1)]
            left_out += float(flown.sum()) * system.shaft.drive
        begins = piece.time - LAST_TURNS * 2.0 * math.pi
        while len(kept) > 1 and (kept[0].time < begins or sum(len(each.segment_starts) for each in kept) > MOST_KEPT):
            del kept[0]
    last = joined(kept)
    rotor = last.rotor
    return DropLoads(
        rotor=rotor,
        outcome=last.outcome,
        multiplicity=last.multiplicity,
        time=last.begins + last.time,
        planes=tuple(sums.found(seen) for sums, seen in zip(planes, last.at_each, strict=True)),
        shaft=None if rotor.system.shaft is None else Braking(last.final.shaft[0], left_out, rotor.scales),
        magnets=magnets,
        scales=rotor.scales,
    )


@dataclass
class _AtPlane:
    """Sums of a plane."""

    contact_time: float = 0.0
    heat: float = 0.0
    restitution_loss: float = 0.0
    rolled: float = 0.0
    largest: np.ndarray = field(default_factory=lambda: np.zeros(COLUMNS))
    logs: list[tuple[float, ContactLog]] = field(default_factory=list)
    race: RaceRecord = field(default_factory=RaceRecord)
    since: float | None = None
    turned_back: dict[int, float] = field(default_factory=lambda: {1: 0.0, -1: 0.0})

    def add(self, seen: Trajectory, works: ContactWorks) -> None:
        """Add a piece, seen at the plane."""
        self.contact_time += float(seen.durations[presses(seen.segment_phases[:, seen.plane])].sum())
        steps = works.found[:, seen.plane]
        self.heat += float(steps[:, HEAT].sum())
        self.rolled += float(steps[:, ROLLED].sum())
        self.largest = np.maximum(self.largest, steps.max(axis=0, initial=0.0))
        log = contacts_of(seen, works)
        loss = float(log.normal_loss.sum())
        if not seen.is_compliant:
            # A landing stands for the last bounces of a chatter.
            landings = seen.log_of(seen.is_landing & (seen.event_planes == seen.plane))
            self.heat += float(log.heat.sum() + landings.heat.sum())
            loss += float(landings.normal_loss.sum())
        self.restitution_loss += loss
        self.logs.append((seen.begins, log))
        self.race.add(seen, works)
        self._move(seen)

    def _move(self, seen: Trajectory) -> None:
        """Note since when the plane is at the wall, and when it last turned back."""
        bounds = seen.begins + np.append(seen.segment_starts, seen.time)
        flying = np.flatnonzero(seen.segment_phases[:, seen.plane] == Phase.FLIGHT)
        if len(flying):
            self.since = float(bounds[flying[-1] + 1]) if flying[-1] + 1 < len(seen.segment_starts) else None
        elif self.since is None:
            self.since = float(bounds[0])
        place, rate = seen.rotor.system.at_plane(seen.segment_amplitudes, seen.plane)
        spin = (place.conj() * rate).imag + np.abs(place) ** 2
        for sense in self.turned_back:
            other = np.flatnonzero(spin * sense <= 0.0)
            if len(other):
                self.turned_back[sense] = float(bounds[other[-1] + 1])

    def found(self, last: Trajectory) -> TouchdownLoads:
        """All that is stated of the plane at the end of a piece, which reaches back over the last turns."""
        rotor, scales, plane = last.rotor, last.scales, last.plane
        soft, race, contacts = last.is_compliant, rotor.races[plane], ContactLog.joined(self.logs).whole
        peaks, left = np.nan_to_num(contacts.peak_force), contacts.left
        force, bearing = float(self.largest[FORCE]), rotor.definition.bearing_at(plane)
        if not soft and last.outcome is Outcome.ROLLING:
            force = max(force, exact_results(rotor).rolling_force)
        # The impulse of a contact that lasts grows on.
        hardest = _largest(np.where(left | (peaks == 0.0), contacts.normal_impulse, 0.0))
        strongest = _largest(peaks)
        fastest = _largest(np.where(contacts.entered & left, contacts.radial_speed, 0.0))
        return TouchdownLoads(
            plane=plane,
            is_compliant=soft,
            outcome=last.outcome,
            contacts=len(contacts),
            bounces=int(left.sum()),
            impulse=0.0 if hardest is None else float(contacts.normal_impulse[hardest]),
            impulse_at=None if hardest is None else float(contacts.peak_time[hardest]),
            force=force,
            force_at=None if strongest is None else float(contacts.peak_time[strongest]),
            still_growing=strongest is not None
            and self.since is not None
            and bool(contacts.peak_time[strongest] > AT_THE_END * (last.begins + last.time)),
            depth=float(self.largest[DEPTH]),
            power=float(self.largest[POWER]),
            heat=self.heat,
            restitution_loss=self.restitution_loss,
            contact_time=self.contact_time,
            lasting_power=_lasting_power(last, contacts),
            restitution=None
            if fastest is None
            else float(-contacts.radial_speed_after[fastest] / contacts.radial_speed[fastest]),
            race_at_end=None if race is None else self.race.ended / race.radius,
            fastest_race=None if race is None else self.race.fastest / race.radius,
            in_contact_since=self.since,
            whirl=_last_whirl(last, self.turned_back, self.since),
            first=_first(contacts),
            catalogue=CatalogueLoads()
            if bearing is None or scales is None
            else _catalogue(
                bearing, force * scales.force, self.rolled * scales.force**3 / race.radius if race else 0.0
            ),
            turning=race_run(last, self.race, force * (scales.force if scales else 0.0)),
            temperatures=None if bearing is None else Temperatures.of(bearing, self.race),
            scales=scales,
        )


def _catalogue(bearing: TouchdownBearing, force: float, rolled: float) -> CatalogueLoads:
    """What the balls bear at a peak force, N, and the shares of the ratings; ``rolled`` is the integral of its cube over the angle of the race, N³."""
    ring, dynamic, static = bearing.ring, bearing.dynamic_rating, bearing.static_rating
    load = None if ring is None else ring.largest_load(force)
    return CatalogueLoads(
        ball_load=load,
        pressure=None if ring is None or load is None else ring.pressure_of(load),
        static_share=static and force / static,
        life_share=dynamic and rolled / (2.0 * math.pi * PER_LIFE * dynamic**3),
    )


def _largest(values: np.ndarray) -> int | None:
    """Which has the largest value above zero, the first of several; ``None`` if there is none."""
    return int(values.argmax()) if values.max(initial=0.0) > 0.0 else None


def _first(contacts: ContactLog) -> FirstContact | None:
    """The first contact that has a force."""
    pressing = np.flatnonzero(contacts.peak_force > 0.0)
    if not len(pressing):
        return None
    peak, start, time = (float(each[pressing[0]]) for each in (contacts.peak_force, contacts.time, contacts.peak_time))
    return FirstContact(peak, start, time, bool(contacts.left[pressing[0]]))


def _lasting_power(last: Trajectory, contacts: ContactLog) -> float:
    """Power of friction with which a settled motion goes on."""
    phase = last.segment_phases[-1, last.plane]
    if not last.outcome.settled or last.outcome is Outcome.LEVITATED or phase == Phase.ROLLING:
        return 0.0
    if presses(phase):
        return float(-last.history(np.array([last.time])).friction_power[0])
    recent = np.flatnonzero(contacts.end >= last.begins)[-max(RECENT, 2 * last.multiplicity) - 1 :]
    times, works = contacts.time[recent], contacts.heat[recent]
    return float(works[1:].sum() / (times[-1] - times[0])) if len(times) > 1 else 0.0


def _last_whirl(last: Trajectory, turned_back: dict[int, float], held_since: float | None) -> LastWhirl | None:
    """How the plane of a motion goes round at its end; ``None`` if it does not touch in the last turns of the shaft.

    Of what was before the motion it is known when the plane last went round against each sense, and since when it has not left the wall.
    """
    begins = max(float(last.segment_starts[0]), last.time - LAST_TURNS * 2.0 * math.pi)
    touching = last.segment_phases[:, last.plane] != Phase.FLIGHT
    ends = np.append(last.segment_starts[1:], last.time)
    own_impacts = last.event_planes[last.is_impact] == last.plane
    recent = last.segment_starts[1:][last.is_impact][own_impacts] > begins
    if last.time == 0.0 or not (recent.any() or (ends[touching] > begins).any()):
        return None
    # What fades without turning, such as the state of a filter, may be faster by far and moves nothing round.
    fastest, lasted = float(np.abs(last.rotor.system.arrays["exponents"].imag).max()), last.time - begins
    times = np.linspace(begins, last.time, 2 + math.ceil(lasted * fastest * PER_RADIAN))
    # At the wall a step of the series is too short to go half round.
    flying = ~touching[np.searchsorted(last.segment_starts, times, side="right").clip(1) - 1]
    flying[[0, -1]] = True
    later, times = last.segment_starts > begins, times[flying]
    places = last.at_plane(times)[0], last.rotor.system.at_plane(last.segment_amplitudes[later], last.plane)[0]
    times = np.append(times, last.segment_starts[later])
    order = np.argsort(times)
    # From one time to the next it goes less than half round.
    angles = np.unwrap((np.angle(np.concatenate(places)) + times)[order])
    turned, goes_on = float(angles[-1] - angles[0]), last.outcome in GOING_ROUND
    seen = held_since if goes_on and held_since is not None else last.begins + begins
    return LastWhirl(
        angular_speed=turned / lasted if lasted > 0.0 else 0.0,
        turned=turned,
        lasted=lasted,
        since=max(seen, turned_back[1 if turned > 0.0 else -1]),
        goes_on=goes_on,
        scales=last.rotor.scales,
    )
