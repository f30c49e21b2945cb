"""What the motions of a study ask of the magnetic bearings, against the limits of these.

The model has linear levitation control: ``n`` equal bearings act on the rotor with ``kz + cż`` whatever its size, each
by the control current ``i = ((k/n + ks)z + (c/n)ż)/ki`` (:mod:`carom.parameters.terms`).  A real bearing gives no more
than its limits, so a motion that asks for more is not that of the real machine.

With ``z = c_r U e^{iΩt}`` a velocity is ``ż = c_rΩ w e^{iΩt}``, ``w = U̇ + iU``, and an acceleration of the fixed frame is
``z̈ = c_rΩ² b e^{iΩt}``, with the forces of lasting contact in the equation of motion::

    b = ρe^{iφ} - ω²U - γw + (-N + iT)U/|U|

So the rate of the current, ``di/dt = ((k/n + ks)ż + (c/n)z̈)/ki``, needs no differences.  An impact, or a kick, changes ``ż`` at
once, and with it the current that the controller asks for: this jump is counted as such, in A, and not as a rate, which
would be infinite.

The largest values are exact for steady motions.  Along others they are found at all events and at instants so close that
an oscillation between two of them adds less than 0.1 %.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from carom.attractors import AttractorSet, MotionName
from carom.attractors.names import LEVITATION, SYNCHRONOUS_RUB
from carom.closed_forms.sag import SteadyMotion
from carom.closed_forms.whirl import Rolling
from carom.disturbances import Sample
from carom.models import Jeffcott, jeffcott_of
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.orbit import Orbit
from carom.outcome import Outcome
from carom.parameters import Case
from carom.parameters.told import number
from carom.results import fields_of
from carom.studies.trials import coordinates_at_largest
from carom.studies.wording import listed

ROLLING = MotionName(Outcome.ROLLING)
STEP = 0.05
"""Largest step of phase between two instants, in rad of the fastest oscillation."""
MOST_INSTANTS = 200_000
"""Largest number of instants of one motion."""
LARGEST = 24
"""Number of disturbances of each kind that are followed to see what a change asks of the bearings."""
_UNITS = {"force": "N", "current": "A", "slew rate": "A/s"}


class Centre(NamedTuple):
    """Motion of the rotor centre in the fixed frame, along axes that turn with the rotor; shapes (n,) or ().

    In ``c_r``, ``c_rΩ`` and ``c_rΩ²``.
    """

    position: Any
    velocity: Any
    acceleration: Any

    @classmethod
    def whirling(cls, radius: float, speed: float) -> Centre:
        """Circular whirl, forward with a positive speed in units of ``Ω``."""
        return cls(radius, 1j * speed * radius, -(speed**2) * radius)

    @classmethod
    def along(cls, motion: Trajectory, times: np.ndarray) -> Centre:
        """At given times of a motion of the planar rotor; at an impact just after it."""
        numbers = jeffcott_of(motion.rotor).parameters
        position, turning = motion.at(times)
        velocity = turning + 1j * position
        normal, friction = motion.forces(times)
        outward = np.where(normal != 0.0, position, 0.0)  # on the wall |U| = 1
        acceleration = (
            cmath.rect(numbers.rho, numbers.phi)
            - numbers.omega**2 * position
            - numbers.gamma * velocity
            + (1j * friction - normal) * outward
        )
        return cls(position, velocity, acceleration)


@dataclass(frozen=True)
class BearingLimit:
    """Largest force, control current or rate of this current of one magnetic bearing, and what a motion asks of it.

    Attributes
    ----------
    kind : {"force", "current", "slew rate"}
    most : float
        The limit, in N, A or A/s.
    per_displacement, per_velocity, per_acceleration : float
        What is asked of the bearing per clearance of displacement, per ``c_rΩ`` of velocity and per ``c_rΩ²`` of acceleration.
    per_jump : float
        For a slew rate the current, in A, by which each ``c_rΩ`` of a sudden change of velocity makes the current jump.
    """

    kind: Literal["force", "current", "slew rate"]
    most: float
    per_displacement: float = 0.0
    per_velocity: float = 0.0
    per_acceleration: float = 0.0
    per_jump: float = 0.0

    def asked(self, motion: Centre) -> Any:
        """What a motion of the rotor centre asks of the bearing, in N, A or A/s: the size of a vector of two axes."""
        asked = self.per_displacement * motion.position + self.per_velocity * motion.velocity
        return np.abs(asked + self.per_acceleration * motion.acceleration)

    def words(self, value: float) -> str:
        """A force, current or slew rate with its unit."""
        return f"{number(value)} {_UNITS[self.kind]}"


@dataclass(frozen=True)
class Demand:
    """What a motion asks of one magnetic bearing at most, in N, A or A/s, and its largest jump of the current, in A."""

    motion: str
    limit: BearingLimit
    largest: float
    jump: float = 0.0

    @property
    def share(self) -> float:
        """Multiple of the limit."""
        return self.largest / self.limit.most


@dataclass(frozen=True)
class BearingDemand:
    """What the motions of a study ask of the magnetic bearings.

    Attributes
    ----------
    limits : tuple of BearingLimit
    motions : tuple of Demand
        Motions that can last.
    disturbances : tuple of ndarray
        For each limit the multiple of it that each disturbance asks for at most, until its end is known; shape (n,).
    jumps : tuple of ndarray
        For each limit the largest jump of the current at an impact of each disturbance, in A; 0 but for a slew rate.
    came_back : ndarray of bool, shape (n,)
        Which disturbances came back to levitation.
    """

    limits: tuple[BearingLimit, ...]
    motions: tuple[Demand, ...]
    disturbances: tuple[np.ndarray, ...]
    jumps: tuple[np.ndarray, ...]
    came_back: np.ndarray

    @property
    def doubtful(self) -> int:
        """Number of disturbances that came back, in the model, and asked for more than a limit on their way."""
        beyond = np.any([shares > 1.0 for shares in self.disturbances], axis=0)
        return int((beyond & self.came_back).sum())

    def document(self) -> dict[str, Any]:
        """As plain data for JSON."""
        return {
            "limits": [fields_of(limit, "kind", limit_si="most") for limit in self.limits],
            "motions": [
                fields_of(each, "motion", kind="limit.kind", largest_si="largest")
                | fields_of(each, "share", largest_jump_si="jump")
                for each in self.motions
            ],
            "disturbances": [
                {
                    "kind": limit.kind,
                    "largest_share": float(shares.max(initial=0.0)),
                    "beyond": int((shares > 1.0).sum()),
                    "largest_jump_si": float(jumps.max(initial=0.0)),
                }
                for limit, shares, jumps in zip(self.limits, self.disturbances, self.jumps, strict=True)
            ],
            "came_back_beyond": self.doubtful,
        }


def limits_of(case: Case) -> tuple[BearingLimit, ...]:
    """Limits of one magnetic bearing of a machine; empty if none is known."""
    machine, scales = case.machine, case.parameters.scales
    if machine is None or scales is None:
        return ()
    share = 1.0 / machine.magnetic_bearings
    stiffness = share * case.parameters.omega**2 * scales.force
    damping = share * case.parameters.gamma * scales.force
    found = []
    if machine.force_limit is not None:
        found.append(BearingLimit("force", machine.force_limit, stiffness, damping))
    if machine.force_current_factor and machine.negative_stiffness is not None:
        factor, pull = machine.force_current_factor, machine.negative_stiffness * scales.length
        proportional, derivative = (stiffness + pull) / factor, damping / factor
        if machine.current_limit is not None:
            found.append(BearingLimit("current", machine.current_limit, proportional, derivative))
        if machine.slew_rate_limit is not None:
            rates = {"per_velocity": proportional * scales.speed, "per_acceleration": derivative * scales.speed}
            found.append(BearingLimit("slew rate", machine.slew_rate_limit, **rates, per_jump=derivative))
    return tuple(found)


def bearing_demand(
    case: Case, equilibria: Iterable[SteadyMotion], orbits: Iterable[Orbit], roll: Rolling | None, found: AttractorSet
) -> BearingDemand | None:
    """What the motions of a study ask of the magnetic bearings; ``None`` if these have no limits."""
    limits = limits_of(case)
    if not limits:
        return None
    whirls = [
        (LEVITATION if entry.kind == "contact-free" else SYNCHRONOUS_RUB, Centre.whirling(entry.radius, 1.0))
        for entry in equilibria
        if entry.status != "virtual" and entry.stable
    ]
    motions = [Demand(name.words, limit, float(limit.asked(whirl))) for name, whirl in whirls for limit in limits]
    for orbit in orbits:
        if orbit.admissible and orbit.stable:
            motion = orbit.trajectory()
            reached = zip(limits, largest_along(motion, limits), largest_jumps(motion, limits), strict=True)
            motions += [Demand(MotionName(Outcome.BOUNCING, 1, orbit=orbit.name).words, *each) for each in reached]
    if roll is not None and roll.holds:
        whirl = Centre.whirling(1.0, -roll.speed)
        motions += [Demand(ROLLING.words, limit, float(limit.asked(whirl))) for limit in limits]
    tried = found.disturbances
    again = (simulate(ending.rotor, ending.start.state, ending.time) for ending in tried)  # until their ends are known
    peaks = np.array([(largest_along(motion, limits), largest_jumps(motion, limits)) for motion in again])
    peaks = peaks.reshape(len(tried), 2, len(limits))
    shares = tuple(peaks[:, 0, place] / limit.most for place, limit in enumerate(limits))
    came_back = np.array([ending.recovered for ending in tried], bool)
    return BearingDemand(limits, tuple(motions), shares, tuple(peaks[:, 1].T), came_back)


def asked_by(case: Case, disturbances: Iterable[Sample]) -> float | None:
    """Largest multiple of a limit that levitation, and disturbances at their largest size, ask for; ``None`` without limits.

    Followed are as many disturbances of each kind as :data:`LARGEST`, in random directions, each until its end is known.
    """
    limits = limits_of(case)
    if not limits:
        return None
    rotor = Jeffcott(case.parameters)
    reached = [tuple(float(limit.asked(Centre.whirling(abs(rotor.equilibrium), 1.0))) for limit in limits)]
    for sample in disturbances:
        starts = sample.model.starts(rotor, *coordinates_at_largest(sample, LARGEST))
        after = sample.model.machine_after(rotor)
        for position, velocity in zip(starts.positions, starts.velocities, strict=True):
            reached.append(largest_along(simulate(after, State.of(position, velocity), settle=True), limits))
    return max(asked / limit.most for each in reached for asked, limit in zip(each, limits, strict=True))


def largest_along(motion: Trajectory, limits: tuple[BearingLimit, ...]) -> tuple[float, ...]:
    """Largest value of each limit's kind along a motion of the planar rotor, in N, A or A/s, but for jumps."""
    fastest = 1.0 + float(np.abs(motion.rotor.system.arrays["exponents"]).max(initial=0.0))
    count = min(math.ceil(motion.time * fastest / STEP) + 2, MOST_INSTANTS)
    centre = Centre.along(motion, motion.sample(count))
    return tuple(float(limit.asked(centre).max()) for limit in limits)


def largest_jumps(motion: Trajectory, limits: tuple[BearingLimit, ...]) -> tuple[float, ...]:
    """Largest jump of the control current at an impact of a motion, in A; 0 for a limit that is no slew rate."""
    sudden = motion.is_impact | motion.is_landing
    (_, before), (_, after) = (
        motion.rotor.system.state(states[sudden]) for states in (motion.arrivals, motion.segment_amplitudes[1:])
    )
    largest = float(np.abs(after - before).max(initial=0.0))
    return tuple(limit.per_jump * largest for limit in limits)


def actuator_words(demand: BearingDemand) -> str:
    """Say which motions ask for more than the magnetic bearings can give."""
    most = listed([f"{limit.words(limit.most)} of {limit.kind}" for limit in demand.limits])
    sentences = [f"Levitation control is assumed linear, and one magnetic bearing gives at most {most}."]
    for motion in dict.fromkeys(each.motion for each in demand.motions):
        reached = [
            f"the bearing {each.limit.kind} reaches {number(each.share, 3)} times its limit of {each.limit.words(each.limit.most)}"
            for each in demand.motions
            if each.motion == motion
        ]
        sentences.append(f"In {motion} {listed(reached)}.")
    for limit, shares in zip(demand.limits, demand.disturbances, strict=True):
        if len(shares):
            sentences.append(
                f"{int((shares > 1.0).sum()) or 'None'} of {len(shares)} disturbances ask for more {limit.kind} than that; the most "
                f"is {number(shares.max(), 3)} times the limit."
            )
    sentences += _words_of_jumps(demand)
    if demand.doubtful:
        sentences.append(
            f"{demand.doubtful} of the {int(demand.came_back.sum())} that came back are among them: that the real machine comes "
            "back from these is not shown."
        )
    if any(each.share > 1.0 for each in demand.motions) or demand.doubtful:
        sentences.append("Beyond a limit the real machine moves otherwise than this model.")
    return " ".join(sentences)


def _words_of_jumps(demand: BearingDemand) -> list[str]:
    """Say how long the bearing takes for the largest jump that the controller asks for at an impact."""
    jumps = [(each.limit, each.jump) for each in demand.motions]
    jumps += [(limit, float(of.max(initial=0.0))) for limit, of in zip(demand.limits, demand.jumps, strict=True)]
    limit, jump = max(jumps, key=lambda each: each[1])
    if not jump:
        return []
    return [
        f"At an impact the controller asks at once for a current that differs by up to {number(jump)} A.",
        f"The bearing takes {number(1e3 * jump / limit.most)} ms for that; the slew rates are those between impacts.",
    ]
