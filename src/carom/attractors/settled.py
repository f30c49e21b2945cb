"""What a settled motion repeats, and whether two motions repeat the same."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.base.outcome import Outcome, Phase
from carom.base.results import Result
from carom.base.roots import bracketed_root, sign_change
from carom.closed_forms.exact_results import exact_results
from carom.motions import Trajectory
from carom.motions.settling import REPEATING
from carom.orbits import Orbit, orbit_of_motion
from carom.orbits.happenings import begins_contact, first_of_period
from carom.orbits.orbit import same_orbit
from carom.orbits.simulated import SimulatedOrbit

Whirl = Literal["forward", "backward", "none"]

SETTLED_RTOL = 1e-6
"""Distance, relative to one plus the size of the state, below which states are the same; speed below which a rotor is at rest."""
SAMPLES = 1000
LOOKED_AT = 4096
"""Most segments at the end of a motion that does not repeat in which contacts with compliant walls are looked at."""
TURNS = 10.0
"""Turns of the shaft over which a motion without a period is evaluated."""


@dataclass(frozen=True, eq=False, repr=False)
class SettledMotion(Result):
    """A motion that has been followed to its end, and the orbit on which it ends."""

    motion: Trajectory
    """As seen at the plane that touches."""
    outcome: Outcome
    multiplicity: int = 0
    """Impacts per period; 0 without a period or impacts."""
    orbit: Orbit | SimulatedOrbit | None = None
    """The orbit of periodic bouncing or of a whirl that slides; ``None`` for other motions, and where Newton's method closes none."""
    period: float | None = None
    """In ``1/Ω``; ``None`` if it is at rest, does not repeat or has not settled."""
    synchronous: bool = False
    """Whether it is at rest in the co-rotating frame."""


def settled_motion(motion: Trajectory) -> SettledMotion:
    """Determine from the end of a motion what it repeats.

    Periodic bouncing and whirls that slide are closed to their orbits (:mod:`carom.orbits.simulated_search`).  Motions that approach one orbit
    then have the same one, however far from it they were when found to be periodic.
    """
    outcome, count, motion = motion.outcome, motion.multiplicity, seen_in_contact(motion)
    system = motion.rotor.system
    if outcome is Outcome.LEVITATED:
        resting = system.forced is None
        return SettledMotion(motion, outcome, period=None if resting else 2.0 * math.pi, synchronous=resting)
    if outcome is Outcome.FORWARD_RUB and np.abs(motion.final.velocity).max() < SETTLED_RTOL:
        return SettledMotion(motion, outcome, synchronous=True)
    if outcome is Outcome.ROLLING and motion.rotor.has_closed_forms:
        return SettledMotion(motion, outcome, period=2.0 * math.pi / float(system.arrays.surface_speed[motion.plane]))
    orbit = orbit_of_motion(motion)
    if count:
        return _bouncing(motion, orbit)
    if outcome in REPEATING or not outcome.settled:
        return SettledMotion(motion, outcome)
    turn = None if system.is_time_dependent else _turn_time(motion)
    return SettledMotion(motion, outcome, 0, orbit, orbit.period if orbit is not None else turn)


def _bouncing(motion: Trajectory, orbit: Orbit | SimulatedOrbit | None) -> SettledMotion:
    """What periodic bouncing repeats, with the orbit that it ends on."""
    count, outcome = motion.multiplicity, motion.outcome
    span = motion.time - float(motion.segment_starts[1:][begins_contact(motion)][first_of_period(motion, count)])
    if orbit is None:
        return SettledMotion(motion, outcome, count, period=span)
    return SettledMotion(motion, outcome, max(1, round(count * orbit.period / span)), orbit, orbit.period)


def seen_in_contact(motion: Trajectory) -> Trajectory:
    """The motion seen at the first plane in lasting contact at its end, otherwise at that of the last impact at a wall."""
    touching = np.flatnonzero(motion.segment_phases[-1] != Phase.FLIGHT)
    planes = touching[:1] if len(touching) else motion.event_planes[begins_contact(motion)]
    return motion.seen_at(int(planes[-1]) if len(planes) else 0)


def _turn_time(motion: Trajectory) -> float | None:
    """Duration of the last full turn along the wall in the co-rotating frame; ``None`` if there was none."""
    row, final = motion.rotor.system.planes[motion.plane], motion.final
    end = complex(row @ np.atleast_1d(final.position))
    speed = abs((end.conjugate() * complex(row @ np.atleast_1d(final.velocity))).imag)
    if motion.rotor.system.arrays["stiffness"][motion.plane]:
        speed /= abs(end) ** 2
    span = 2.0 * math.pi * min(TURNS, 4.0 / speed if speed > 0.0 else TURNS)
    times = np.linspace(max(0.0, motion.time - span), motion.time, SAMPLES)
    angles = np.unwrap(np.angle(motion.at_plane(times)[0] / end))
    turned = np.flatnonzero(np.abs(angles - angles[-1]) >= 2.0 * math.pi * (1.0 - SETTLED_RTOL))
    if not len(turned):
        return None

    def ahead(time: float) -> float:
        return cmath.phase(complex(motion.at_plane(np.array(time))[0]) / end)

    # By the tolerance of a full turn, it may begin before the sample found, even before the motion that was followed.
    before, found, after = times[[max(0, turned[-1] - 1), turned[-1], turned[-1] + 1]].tolist()
    bracket = sign_change(ahead, before, after)
    return motion.time - (found if bracket is None else bracketed_root(ahead, *bracket))


def same_motion(first: SettledMotion, second: SettledMotion) -> bool:
    """Whether two motions have settled to the same one, whichever impact of the period they ended at."""
    if any(getattr(first, name) != getattr(second, name) for name in ("outcome", "synchronous", "multiplicity")):
        return False
    if first.multiplicity == 0:
        return True
    if first.orbit is not None or second.orbit is not None:
        return first.orbit is not None and second.orbit is not None and same_orbit(first.orbit, second.orbit)
    states, others = _last_states(first), _last_states(second)
    apart = [np.abs(np.roll(others, -places, axis=0) - states).max() for places in range(len(states))]
    return bool(min(apart) < SETTLED_RTOL * (1.0 + np.abs(states).max()))


def _last_states(settled: SettledMotion) -> np.ndarray:
    """Coordinates and rates just before the impacts at walls of the last period, complex, shape (p, 2n)."""
    motion = settled.motion
    last = np.flatnonzero(begins_contact(motion))[first_of_period(motion, settled.multiplicity) :]
    return motion.rotor.system.nodes.of(motion.event_amplitudes[last[-settled.multiplicity :]])


def known_orbit(orbit: Orbit | SimulatedOrbit | None, orbits: Sequence[Orbit]) -> Orbit | None:
    """Return the admissible one among ``orbits`` that is the given one, or ``None``."""
    if orbit is None:
        return None
    return next((known for known in orbits if known.admissible and same_orbit(known, orbit)), None)


def _last_times(settled: SettledMotion) -> np.ndarray:
    """Times over the last period, or over the last turns of the shaft; the end alone if the rotor is at rest."""
    motion = settled.motion
    if settled.synchronous:
        return np.array([motion.time])
    span = settled.period or 2.0 * math.pi * TURNS
    return np.linspace(max(0.0, motion.time - span), motion.time, SAMPLES)


def forces_on(settled: SettledMotion) -> tuple[float, float]:
    """Largest normal impulse (``m c_r Ω``) and largest lasting normal force (``m c_r Ω²``) on the attractor, at any plane, in units of the rotor.

    A contact with a compliant wall has both.
    """
    motion = settled.motion
    if settled.outcome is Outcome.LEVITATED:
        return 0.0, 0.0
    if settled.outcome is Outcome.ROLLING and (force := exact_results(motion.rotor).rolling_force):
        return 0.0, force
    contacts_begun = np.flatnonzero(begins_contact(motion))
    # Of irregular bouncing only the later half is used: the first half may be a transient.
    first = first_of_period(motion, settled.multiplicity) if settled.multiplicity else len(contacts_begun) // 2
    late = np.isin(np.arange(len(motion.is_impact)), contacts_begun[first:])
    log, widths = motion.log_of(late & motion.is_impact), motion.rotor.system.widths
    last = log.normal_impulse / widths[log.touchdown_bearing - 1]
    touching = settled.outcome in (Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
    impulse = float(last.max()) if len(last) and not touching else 0.0
    if (motion.segment_phases == Phase.FLIGHT).all():
        return impulse, 0.0
    times = _last_times(settled)
    planes = range(motion.segment_phases.shape[1])
    force = max(float(motion.seen_at(plane).forces(times)[0].max() / widths[plane]) for plane in planes)
    if touching or not len(contacts_begun):
        return impulse, force
    since = int(contacts_begun[min(first, len(contacts_begun) - 1)]) + 1
    since = since if settled.multiplicity else max(since, len(motion.segment_starts) - LOOKED_AT)
    return _with_touches(motion.since(since), impulse, force)


def _with_touches(motion: Trajectory, impulse: float, force: float) -> tuple[float, float]:
    """Largest impulse and force, with those of the contacts with compliant walls; samples miss brief ones."""
    for plane in np.flatnonzero(motion.rotor.system.arrays["stiffness"] > 0.0).tolist():
        touches, width = motion.seen_at(plane).contacts, float(motion.rotor.system.widths[plane])
        impulse = max(impulse, float(touches.normal_impulse.max(initial=0.0)) / width)
        force = max(force, float(touches.peak_force.max(initial=0.0)) / width)
    return impulse, force


def whirl_of(settled: SettledMotion) -> Whirl:
    """Direction of whirl: the sign of the mean areal velocity of the rotor centre in the fixed frame.

    The areal velocity is ``Im(Z̄Ż)/2 = (|U|² + Im(ŪU̇))/2``.
    """
    position, velocity = settled.motion.at_plane(_last_times(settled))
    swept = float((np.abs(position) ** 2 + (position.conj() * velocity).imag).mean())
    if abs(swept) < SETTLED_RTOL:
        return "none"
    return "forward" if swept > 0.0 else "backward"
