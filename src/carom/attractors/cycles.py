"""The cycle that a settled motion repeats, and the comparison of cycles."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.closed_forms.whirl import rolling
from carom.core.advance import SHORTEST_LAP
from carom.models import Jeffcott
from carom.motions.settling import REPEATING, closed_orbit
from carom.motions.trajectories import Trajectory
from carom.orbits.orbit import Orbit
from carom.orbits.recognising import orbit_of_motion
from carom.outcome import Outcome, Phase
from carom.results import Result

Whirl = Literal["forward", "backward", "none"]

SAME = 1e-6
"""Distance, relative to one plus the speed, below which impacts are the same: far above the error of closed orbits."""
SAMPLES = 1000
TURNS = 10.0
"""Turns of the shaft over which a motion without a period is evaluated."""


@dataclass(frozen=True, eq=False, repr=False)
class Cycle(Result):
    """The cycle that a settled motion repeats."""

    outcome: Outcome
    synchronous: bool
    """Whether it is at rest in the co-rotating frame."""
    period: float | None
    """In ``1/Ω``; ``None`` if it is at rest, does not repeat or has not settled."""
    positions: np.ndarray
    velocities: np.ndarray
    """States just before the impacts of one period, in their order; empty if there are none or no period.

    Shape (m,), complex.
    """

    @property
    def kind(self) -> tuple[Outcome, bool, int]:
        """Properties that must agree before positions and velocities are compared."""
        return self.outcome, self.synchronous, self.multiplicity

    @property
    def multiplicity(self) -> int:
        """Impacts per period; 0 without a period or impacts."""
        return len(self.positions)


def cycle_of(motion: Trajectory) -> Cycle:
    """Determine the cycle of a motion from its end.

    Where possible, periodic bouncing is converged to the exact orbit (:func:`~carom.motions.settling.closed_orbit`, of other
    rotors :func:`~carom.orbits.recognising.orbit_of_motion`).
    Motions that approach one orbit then have the same cycle, however far from it they were when found to be periodic.
    """
    outcome, motion = motion.outcome, seen_in_contact(motion)
    none = np.empty(0, complex)
    if outcome is Outcome.ROLLING:
        return Cycle(outcome, False, 2.0 * math.pi / float(motion.rotor.system.arrays.drive[motion.plane]), none, none)
    if outcome not in REPEATING:
        resting = outcome is Outcome.LEVITATED or (
            outcome is Outcome.FORWARD_RUB and np.abs(motion.final.velocity).max() < SAME
        )
        whirling = outcome is Outcome.BACKWARD_WHIRL or (outcome is Outcome.FORWARD_RUB and not resting)
        return Cycle(outcome, resting, _turn_time(motion) if whirling else None, none, none)
    count = motion.multiplicity
    if count == 0:
        return Cycle(outcome, False, None, none, none)
    if motion.rotor.system.is_planar:
        closed = closed_orbit(motion.rotor, motion.final.position, motion.final.velocity, count)
        if closed is not None:
            return Cycle(outcome, False, closed.period, closed.positions, closed.velocities)
    elif (orbit := orbit_of_motion(motion)) is not None:
        strikes = orbit.nodes[[segment.kind.is_impact for segment in orbit.word]]
        return Cycle(outcome, False, orbit.period, *np.split(strikes, 2, axis=1))
    last = np.flatnonzero(motion.is_impact)[first_of_period(motion, count) :]
    positions, velocities = motion.rotor.system.state(motion.arrivals[last])
    return Cycle(outcome, False, motion.time - float(motion.segment_starts[1:][last[0]]), positions, velocities)


def seen_in_contact(motion: Trajectory) -> Trajectory:
    """The motion seen at the first plane in lasting contact at its end, otherwise at that of the last impact."""
    touching = np.flatnonzero(motion.segment_phases[-1] != Phase.FLIGHT)
    struck = motion.event_planes[motion.is_impact]
    return motion.seen_at(int(touching[0]) if len(touching) else int(struck[-1]) if len(struck) else 0)


def first_of_period(motion: Trajectory, count: int) -> int:
    """Number of the impact with which the last period of a motion begins, of ``count`` impacts at different instants."""
    times = motion.segment_starts[1:][motion.is_impact]
    if len(motion.rotor.system.arrays.rows) == 1 or not count:
        return len(times) - count
    noted, last = [], -math.inf
    for number, time in enumerate(times.tolist()):
        if time - last > SHORTEST_LAP:
            noted.append(number)
            last = time
    return noted[-min(count, len(noted))]


def _turn_time(motion: Trajectory) -> float | None:
    """Duration of the last full turn along the wall in the co-rotating frame; ``None`` if there was none."""
    row, final = motion.rotor.system.planes[motion.plane], motion.final
    end = complex(row @ np.atleast_1d(final.position))
    speed = abs((end.conjugate() * complex(row @ np.atleast_1d(final.velocity))).imag)
    span = 2.0 * math.pi * min(TURNS, 4.0 / speed if speed > 0.0 else TURNS)
    times = np.linspace(max(0.0, motion.time - span), motion.time, SAMPLES)
    angles = np.unwrap(np.angle(motion.at_plane(times)[0] / end))
    turned = np.flatnonzero(np.abs(angles - angles[-1]) >= 2.0 * math.pi * (1.0 - SAME))
    if not len(turned):
        return None
    start = float(times[turned[-1]])
    for _ in range(4):  # Newton's method from a start less than a sample's width away
        position, velocity = motion.at_plane(np.array(start))
        start -= cmath.phase(complex(position) / end) / (complex(position).conjugate() * complex(velocity)).imag
        start = max(0.0, start)
    return motion.time - start


def _turned(positions: np.ndarray, velocities: np.ndarray, places: int) -> tuple[np.ndarray, np.ndarray]:
    return np.roll(positions, -places, axis=0), np.roll(velocities, -places, axis=0)


def _distance(
    positions: np.ndarray, velocities: np.ndarray, other_positions: np.ndarray, other_velocities: np.ndarray
) -> float:
    """Largest distance of paired states, relative to one plus their speed."""
    apart, speeds = np.abs(positions - other_positions) + np.abs(velocities - other_velocities), np.abs(velocities)
    if positions.ndim > 1:
        apart, speeds = apart.sum(axis=1), speeds.sum(axis=1)
    return float((apart / (1.0 + speeds)).max())


def same_cycle(first: Cycle, second: Cycle) -> bool:
    """Whether two motions have settled to the same cycle, whichever impact of the period they ended at."""
    if first.kind != second.kind:
        return False
    if first.multiplicity == 0:
        return True
    states = first.positions, first.velocities
    turns = range(first.multiplicity)
    return any(_distance(*states, *_turned(second.positions, second.velocities, places)) < SAME for places in turns)


def orbit_of(cycle: Cycle, orbits: Sequence[Orbit]) -> Orbit | None:
    """Return the orbit among ``orbits`` to which a motion has settled, or ``None``."""
    if cycle.outcome is not Outcome.BOUNCING or cycle.multiplicity != 1:
        return None
    for orbit in orbits:
        before = orbit.section.state
        states = np.array([before.position]), np.array([before.velocity])
        if orbit.admissible and _distance(cycle.positions, cycle.velocities, *states) < SAME:
            return orbit
    return None


def _last_times(motion: Trajectory, cycle: Cycle) -> np.ndarray:
    """Times over the last period, or over the last turns of the shaft; the end alone if the rotor is at rest."""
    if cycle.synchronous:
        return np.array([motion.time])
    span = cycle.period or 2.0 * math.pi * TURNS
    return np.linspace(max(0.0, motion.time - span), motion.time, SAMPLES)


def forces_on(motion: Trajectory, cycle: Cycle) -> tuple[float, float]:
    """Largest normal impulse (``m c_r Ω``) and largest lasting normal force (``m c_r Ω²``) on the attractor, at any plane."""
    if cycle.outcome is Outcome.LEVITATED:
        return 0.0, 0.0
    if cycle.outcome is Outcome.ROLLING and isinstance(motion.rotor, Jeffcott):
        return 0.0, rolling(motion.rotor).largest_force
    impulses = motion.log_of(motion.is_impact).normal_impulse
    # Of irregular bouncing only the later half is used: the first half may be a transient.
    last = impulses[first_of_period(motion, cycle.multiplicity) if cycle.multiplicity else len(impulses) // 2 :]
    touching = cycle.outcome in (Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
    impulse = float(last.max()) if len(last) and not touching else 0.0
    if (motion.segment_phases == Phase.FLIGHT).all():
        return impulse, 0.0
    times = _last_times(motion, cycle)
    planes = range(motion.segment_phases.shape[1])
    return impulse, max(float(motion.seen_at(plane).forces(times)[0].max()) for plane in planes)


def whirl_of(motion: Trajectory, cycle: Cycle) -> Whirl:
    """Direction of whirl: the sign of the mean areal velocity of the rotor centre in the fixed frame.

    The areal velocity is ``Im(Z̄Ż)/2 = (|U|² + Im(ŪU̇))/2``.
    """
    position, velocity = motion.at_plane(_last_times(motion, cycle))
    swept = float((np.abs(position) ** 2 + (position.conj() * velocity).imag).mean())
    if abs(swept) < SAME:
        return "none"
    return "forward" if swept > 0.0 else "backward"
