"""What a drop asks of a touchdown bearing: its loads, when they come, and how the rotor stays there, over all stages of a motion."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from carom.arguments import checked
from carom.models import Model
from carom.models.in_bearing import races_of
from carom.motions.contacts import presses, race_speed, yields
from carom.motions.loads import TouchdownLoads, touchdown_loads
from carom.motions.trajectories import Trajectory
from carom.outcome import Outcome, Phase
from carom.parameters import Scales
from carom.results import Result

LAST_TURNS = 8.0
"""Turns of the shaft at the end over which the whirl is averaged."""
GOING_ROUND = (Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
"""Ends of a motion that goes round the wall in contact."""


@dataclass(frozen=True, repr=False)
class LastWhirl(Result):
    """How a plane went round at the end of a motion, in the fixed frame.

    Attributes
    ----------
    angular_speed : float
        Mean over the last turns of the shaft, in ``Ω``; negative for backward whirl.
    turned : float
        Angle over which it went round in these, in rad, with its sign.
    lasted : float
        Time over which that was seen, in ``1/Ω``: eight turns, or less of a motion that is shorter.
    since : float
        Time since which it has not turned back, in ``1/Ω``, to within a step of the motion.  If it does not go on, no earlier time is looked at
        than these turns.
    goes_on : bool
        Whether the motion has settled to going round in contact; otherwise this is what was seen, and no more.
    scales : Scales or None
    """

    angular_speed: float
    turned: float
    lasted: float
    since: float
    goes_on: bool
    scales: Scales | None = None

    @property
    def direction(self) -> str | None:
        """``"forward"`` or ``"backward"``; ``None`` if it went less than half round."""
        return None if abs(self.turned) < math.pi else "forward" if self.turned > 0.0 else "backward"

    @property
    def frequency_si(self) -> float | None:
        """Size of the mean, in Hz; ``None`` without scales."""
        return None if self.scales is None else abs(self.angular_speed) * self.scales.speed / (2.0 * math.pi)


@dataclass(frozen=True, repr=False)
class PlaneLoads(Result):
    """What the touchdown bearing at a plane bears in a drop; times count from the release.

    Attributes
    ----------
    plane : int
    gives_way : bool
        Whether its wall gives way.  An impact on a rigid wall has an impulse, and no force that could be told: there ``loads.force`` is
        that of lasting contact alone.
    loads : TouchdownLoads
        Over all stages: the largest of each, or their sum.
    force_at, impulse_at : float or None
        Times of the largest normal force in a wall that gives way and of the hardest contact, ``1/Ω``: that of its largest force, or of the impact.
    contacts : int
        Contacts from entering the wall on, or impacts on a rigid wall.
    bounces : int
        Those which the plane has left again.
    restitution : float or None
        Radial speed after the contact that was entered fastest over that before it, as it was seen.
    race_at_end, fastest_race : float or None
        Speed of the race at the end, and the largest at the end of a step, in ``Ω``; ``None`` if it does not turn.
    in_contact_since : float or None
        Time since which the plane has not left the wall, to the end, ``1/Ω``; ``None`` if it is not there at the end.
    whirl : LastWhirl or None
        ``None`` if it did not touch in the last turns.
    scales : Scales or None
    """

    plane: int
    gives_way: bool
    loads: TouchdownLoads
    force_at: float | None
    impulse_at: float | None
    contacts: int
    bounces: int
    restitution: float | None
    race_at_end: float | None
    fastest_race: float | None
    in_contact_since: float | None
    whirl: LastWhirl | None
    scales: Scales | None = None


@dataclass(frozen=True, repr=False)
class Braking(Result):
    """What a drop does to the speed of a shaft that is braked.

    Attributes
    ----------
    speed_at_end : float
        In ``Ω``.
    left_out : float
        Change of the speed by which the torque of the drive would add to this in flight, where it is left out, in ``Ω``.
    scales : Scales or None
    """

    speed_at_end: float
    left_out: float
    scales: Scales | None = None


@dataclass(frozen=True, repr=False)
class DropLoads(Result):
    """What a drop asks of the touchdown bearing; nothing is claimed beyond the time up to which it was followed.

    Attributes
    ----------
    rotor : Model
        That of the last stage.
    outcome : Outcome
        Where the motion settled, or why it was stopped.
    time : float
        Time from the release up to which it was followed, ``1/Ω``.
    planes : tuple of PlaneLoads
        One for each contact plane.
    shaft : Braking or None
        ``None`` of a shaft at constant speed.
    scales : Scales or None
    """

    rotor: Model
    outcome: Outcome
    time: float
    planes: tuple[PlaneLoads, ...]
    shaft: Braking | None = None
    scales: Scales | None = None

    @property
    def settled_at(self) -> float | None:
        """Time from the release since which the rotor rests on the bearing, or goes round it in contact; ``None`` if it does neither."""
        if self.outcome is not Outcome.AT_REST and self.outcome not in GOING_ROUND:
            return None
        held = [each for each in self.planes if each.in_contact_since is not None]
        times = [each.in_contact_since or 0.0 for each in held]
        if self.outcome in GOING_ROUND:
            times += [each.whirl.since for each in held if each.whirl]
        return max(times, default=None)


@checked
def drop_loads(motion: Trajectory) -> DropLoads:
    """Evaluate a drop, or any other touchdown, over all its stages and at all contact planes.

    A contact that goes on from one stage into the next counts once; its impulse is that of the larger of its parts.

    Parameters
    ----------
    motion : Trajectory
        The last stage, as :func:`carom.simulate` returns it.

    See Also
    --------
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
    seen = [[part.seen_at(plane) for part in motion.parts] for plane in range(motion.segment_phases.shape[1])]
    return DropLoads(
        rotor=motion.rotor,
        outcome=motion.outcome,
        time=motion.begins + motion.time,
        planes=tuple(map(_at_plane, seen)),
        shaft=_braking(motion),
        scales=motion.rotor.scales,
    )


def _braking(motion: Trajectory) -> Braking | None:
    """The shaft over all stages; ``None`` if its speed stays as it is."""
    if motion.rotor.system.shaft is None:
        return None
    change = 0.0
    for part in motion.parts:
        lasts = np.diff(np.append(part.segment_starts, part.time))
        flown = lasts[~presses(part.segment_phases).any(axis=1)].sum()
        change += float(flown) * (part.rotor.system.shaft.drive if part.rotor.system.shaft else 0.0)
    return Braking(motion.final.shaft[0], change, motion.rotor.scales)


def _at_plane(parts: list[Trajectory]) -> PlaneLoads:
    last = parts[-1]
    system, plane = last.rotor.system, last.plane
    soft = yields(system, plane)
    found = [touchdown_loads(part) for part in parts]
    contacts = _contacts(parts, soft)
    fastest, at_end = _race_speeds(parts) or (None, None)
    return PlaneLoads(
        plane=plane,
        gives_way=soft,
        loads=_together(found, contacts.number),
        force_at=contacts.time_of_force,
        impulse_at=contacts.time_of_impulse,
        contacts=contacts.number,
        bounces=contacts.left,
        restitution=contacts.restitution,
        race_at_end=at_end,
        fastest_race=fastest,
        in_contact_since=_in_contact_since(parts),
        whirl=_last_whirl(parts),
        scales=last.scales,
    )


def _together(found: list[TouchdownLoads], contacts: int) -> TouchdownLoads:
    """Loads over stages: those of the last one with the largest, or the sum, of all."""
    hardest = {name: max(getattr(each, name) for each in found) for name in ("impulse", "force", "depth", "power")}
    sums = {name: sum(getattr(each, name) for each in found) for name in ("heat", "restitution_loss", "contact_time")}
    pressures = [each.pressure for each in found if each.pressure is not None]
    return replace(found[-1], impacts=contacts, **hardest, **sums, pressure=max(pressures, default=None))


@dataclass(frozen=True)
class _Contacts:
    """Contacts of a plane over all stages."""

    number: int
    left: int
    time_of_force: float | None
    time_of_impulse: float | None
    restitution: float | None


def _contacts(parts: list[Trajectory], soft: bool) -> _Contacts:
    """Count the contacts of a plane and find the hardest; those that go over from one stage to the next count once."""
    logs = [part.log for part in parts]

    def column(name: str) -> np.ndarray:
        return np.concatenate([getattr(log, name) for log in logs])

    times = column("peak_time" if soft else "time") + np.repeat([part.begins for part in parts], list(map(len, logs)))
    impulses, speeds, after = column("normal_impulse"), column("radial_speed"), column("radial_speed_after")
    entered, left, forces = np.ones(len(times), bool), after < 0.0, np.zeros(0)
    if soft:
        entered, left, forces = column("entered"), ~column("lasts"), column("peak_force")
        impulses = np.where(left, impulses, 0.0)
        begins_inside = len(parts[0].touches) > 0 and not entered[0]
    whole = np.where(entered & left, speeds, 0.0)
    fastest = int(whole.argmax()) if whole.any() else None
    return _Contacts(
        int(entered.sum()) + int(soft and begins_inside),
        int(left.sum()),
        float(times[forces.argmax()]) if len(forces) else None,
        float(times[impulses.argmax()]) if impulses.any() else None,
        None if fastest is None else float(-after[fastest] / speeds[fastest]),
    )


def _race_speeds(parts: list[Trajectory]) -> tuple[float, float] | None:
    """Largest speed of the race at a plane, and that at the end, in ``Ω``; ``None`` if it does not turn."""
    rotor, plane = parts[-1].rotor, parts[-1].plane
    race = races_of(rotor)[plane]
    if race is None:
        return None
    # A stage may have further modes, such as those of a shock.
    each = [
        race_speed(part.rotor.system, plane, amplitudes)
        for part in parts
        for amplitudes in (part.segment_amplitudes, part.last_amplitudes[None])
    ]
    speeds = np.concatenate(each) / race.radius
    return float(speeds[np.abs(speeds).argmax()]), float(speeds[-1])


def _begun(part: Trajectory) -> float:
    """Time since which the plane has not left the wall to the end of a stage; that end, if it is not there."""
    flying = np.flatnonzero(part.segment_phases[:, part.plane] == Phase.FLIGHT)
    return float(np.append(part.segment_starts, part.time)[flying[-1] + 1 if len(flying) else 0])


def _in_contact_since(parts: list[Trajectory]) -> float | None:
    """Time since which the plane has been at the wall without leaving it, to the end."""
    since = None
    for part in reversed(parts):
        begun = _begun(part)
        if part.segment_phases[-1, part.plane] == Phase.FLIGHT:
            return since
        since = part.begins + begun
        if begun > 0.0:
            return since
    return since


def _last_whirl(parts: list[Trajectory]) -> LastWhirl | None:
    """How the plane goes round at the end; ``None`` if it does not touch in the last turns of the shaft."""
    last = parts[-1]
    begins = max(0.0, last.time - LAST_TURNS * 2.0 * math.pi)
    touching = last.segment_phases[:, last.plane] != Phase.FLIGHT
    ends = np.append(last.segment_starts[1:], last.time)
    struck = last.event_planes[last.is_impact] == last.plane
    recent = last.segment_starts[1:][last.is_impact][struck] > begins
    if last.time == 0.0 or not (recent.any() or (ends[touching] > begins).any()):
        return None
    times, angles, rates = _angles(last, min(begins, _begun(last)) if last.outcome in GOING_ROUND else begins)
    shown = times >= begins
    # From one time to the next it goes less than half round.
    turned = float(np.subtract(*np.unwrap(angles[shown])[[-1, 0]]))
    other = np.flatnonzero(rates * np.sign(turned) <= 0.0)
    since = times[other[-1] + 1] if len(other) and other[-1] + 1 < len(times) else times[-1] if len(other) else times[0]
    lasted = float(np.ptp(times[shown]))
    return LastWhirl(
        angular_speed=turned / lasted if lasted > 0.0 else 0.0,
        turned=turned,
        lasted=lasted,
        since=last.begins + float(since),
        goes_on=last.outcome in GOING_ROUND,
        scales=last.rotor.scales,
    )


def _angles(last: Trajectory, begins: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times from a first one on, angles of the plane in the fixed frame and their rates, at nodes close enough to count its turns."""
    edges = np.append(last.segment_starts, last.time)
    # What fades without turning, such as the state of a filter, may be faster by far and moves nothing round.
    fastest = np.abs(last.rotor.system.arrays["exponents"].imag).max()
    pieces = []
    for first, end in pairwise(edges):
        if end > begins:
            count = max(1, math.ceil((end - first) * fastest))
            pieces.append(np.linspace(max(first, begins), end, 16 * count, endpoint=False))
    times = np.append(np.concatenate(pieces), last.time)
    place, rate = last.at_plane(times)
    turned: np.ndarray = np.angle(place) + last.begins + times
    return times, turned, (place.conj() * rate).imag + np.abs(place) ** 2
