"""What the motions of a study have to do with the limits of the magnetic bearings.

A limit of force or current acts in the motion (:mod:`carom.models.limited`): which disturbances come to it, and how many of these come back, is counted.

The rate of the current is not limited in the motion of the planar rotor, whose ``n`` equal bearings follow the controller at once, each by the control
current ``i = ((k/n + ks)z + (c/n)ż)/ki`` (:mod:`carom.parameters.terms`).  What it asks for is compared with the limit afterwards: a motion that
asks for more is not that of the real machine.

With ``z = c_r U e^{iΩt}`` a velocity is ``ż = c_rΩ w e^{iΩt}``, ``w = U̇ + iU``, and an acceleration of the fixed frame is
``z̈ = c_rΩ² b e^{iΩt}``, with the forces of lasting contact and what a bearing at its limit does not give, ``e``, in the equation of motion::

    b = ρe^{iφ} - ω²U - γw + (-N + iT)U/|U| + e

So the rate of the current, ``di/dt = ((k/n + ks)ż + (c/n)z̈)/ki``, needs no differences; at a limit of the current it is that of what is asked for.  An impact, or a
kick, changes ``ż`` at once, and with it the current that the controller asks for: this jump is counted as such, in A, and not as a rate, which
would be infinite.

The largest values are exact for steady motions.  Along others they are found at all events and at instants so close that
an oscillation between two of them adds less than 0.1 %.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from carom.attractors import AttractorSet, MotionName
from carom.attractors.names import LEVITATION, SYNCHRONOUS_RUB
from carom.closed_forms.equilibria import SteadyMotion
from carom.closed_forms.sag import Levitation
from carom.closed_forms.whirl import Rolling
from carom.core.limits import WITHIN
from carom.disturbances import Sample
from carom.models import rotor_of
from carom.models.saturation import saturation_accelerations, saturation_of
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.orbit import Orbit
from carom.outcome import Outcome
from carom.parameters import Case, ControlLimit
from carom.parameters.told import number
from carom.results import fields_of
from carom.studies.trials import coordinates_at_largest

ROLLING = MotionName(Outcome.ROLLING)
STEP = 0.05
"""Largest step of phase between two instants, in rad of the fastest oscillation."""
MOST_INSTANTS = 200_000
"""Largest number of instants of one motion."""
SHORTEST = 1e-6
"""Time for which a disturbance is followed whose end is known at once."""
LARGEST = 24
"""Number of disturbances of each kind that are followed to see what a change asks of the bearings."""


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
        numbers: Any = motion.rotor.definition.planar
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
        system = motion.rotor.system
        if system.limits:
            excess = saturation_of(system, motion.amplitudes_at(times)[0], motion.begins + times)
            acceleration = acceleration + excess @ saturation_accelerations(system)[0]
        return cls(position, velocity, acceleration)


@dataclass(frozen=True)
class SlewLimit:
    """Largest rate of the control current of one magnetic bearing, and what a motion asks of it.

    Attributes
    ----------
    most : float
        A/s.
    per_velocity, per_acceleration : float
        Rate per ``c_rΩ`` of velocity and per ``c_rΩ²`` of acceleration, A/s.
    per_jump : float
        The current, in A, by which each ``c_rΩ`` of a sudden change of velocity makes the current jump.
    """

    most: float
    per_velocity: float
    per_acceleration: float
    per_jump: float

    def asked(self, motion: Centre) -> Any:
        """What a motion of the rotor centre asks of the bearing, in A/s: the size of a vector of two axes."""
        return np.abs(self.per_velocity * motion.velocity + self.per_acceleration * motion.acceleration)


@dataclass(frozen=True)
class Demand:
    """What a motion asks of one magnetic bearing at most, in A/s, and its largest jump of the current, in A."""

    motion: str
    limit: SlewLimit
    largest: float
    jump: float = 0.0

    @property
    def share(self) -> float:
        """Multiple of the limit."""
        return self.largest / self.limit.most


@dataclass(frozen=True)
class BearingDemand:
    """What the motions of a study have to do with the limits of the magnetic bearings.

    Attributes
    ----------
    control : ControlLimit or None
        Largest control force, which acts in the motions.
    slew : SlewLimit or None
        Largest rate of the current, which does not.
    motions : tuple of Demand
        Rates that motions which can last ask for.
    shares : ndarray
        The multiple of the largest rate that each disturbance asks for at most, until its end is known; shape (n,), zeros without one.
    jumps : ndarray
        The largest jump of the current at an impact of each disturbance, in A; shape (n,).
    at_limit : ndarray of bool, shape (n,)
        Which disturbances come to the largest control force.
    came_back : ndarray of bool, shape (n,)
        Which disturbances came back to levitation.
    """

    control: ControlLimit | None
    slew: SlewLimit | None
    motions: tuple[Demand, ...]
    shares: np.ndarray
    jumps: np.ndarray
    at_limit: np.ndarray
    came_back: np.ndarray

    @property
    def doubtful(self) -> int:
        """Number of disturbances that came back, in the model, and asked for a larger rate than the bearings have on their way."""
        return int(((self.shares > 1.0) & self.came_back).sum())

    def document(self) -> dict[str, Any]:
        """As plain data for JSON."""
        return {
            "control": None if self.control is None else fields_of(self.control, force_si="force", pull_si="pull"),
            "slew_rate": None if self.slew is None else fields_of(self.slew, limit_si="most"),
            "motions": [
                fields_of(each, "motion", "share", largest_si="largest", largest_jump_si="jump")
                for each in self.motions
            ],
            "disturbances": {
                "at_limit": int(self.at_limit.sum()),
                "came_back_at_limit": int((self.at_limit & self.came_back).sum()),
                "largest_share": float(self.shares.max(initial=0.0)),
                "beyond": int((self.shares > 1.0).sum()),
                "largest_jump_si": float(self.jumps.max(initial=0.0)),
            },
            "came_back_beyond": self.doubtful,
        }


def slew_limit_of(case: Case) -> SlewLimit | None:
    """Largest rate of the current of one magnetic bearing of a machine; ``None`` if it is not stated."""
    machine, scales = case.machine, case.parameters.scales
    if machine is None or scales is None or machine.slew_rate_limit is None:
        return None
    gains = machine.controller_gains
    jump = gains["derivative_gain"] * scales.velocity
    return SlewLimit(
        machine.slew_rate_limit,
        gains["proportional_gain"] * scales.velocity,
        jump * scales.speed,
        jump,
    )


def bearing_demand(
    case: Case, equilibria: Iterable[SteadyMotion], orbits: Iterable[Orbit], roll: Rolling | None, found: AttractorSet
) -> BearingDemand | None:
    """What the motions of a study have to do with the limits of the magnetic bearings; ``None`` if these have none."""
    given, slew = rotor_of(case).limits, slew_limit_of(case)
    control = given if isinstance(given, ControlLimit) else None
    equilibria = tuple(equilibria)
    if isinstance(equilibria[0], Levitation):
        slew = None  # under weight nothing here says what levitation asks for
    if control is None and slew is None:
        return None
    tried = found.disturbances
    motions = [
        simulate(ending.rotor, ending.start.state, max(ending.time, SHORTEST)) for ending in tried
    ]  # until their ends are known
    came_back = np.array([ending.recovered for ending in tried], bool)
    at_limit = np.array([bool((motion.segment_limits > WITHIN).any()) for motion in motions], bool)
    shares, jumps = np.zeros((2, len(motions)))
    if slew is not None:
        shares = np.array([largest_along(motion, slew) for motion in motions]) / slew.most
        jumps = np.array([largest_jump(motion, slew) for motion in motions])
    lasting = () if slew is None else tuple(_lasting(slew, equilibria, orbits, roll))
    return BearingDemand(control, slew, lasting, shares, jumps, at_limit, came_back)


def _lasting(
    limit: SlewLimit, equilibria: Iterable[SteadyMotion], orbits: Iterable[Orbit], roll: Rolling | None
) -> Iterable[Demand]:
    """What motions that can last ask for."""
    for entry in equilibria:
        if entry.status != "virtual" and entry.stable:
            name = LEVITATION if entry.kind == "contact-free" else SYNCHRONOUS_RUB
            yield Demand(name.words, limit, float(limit.asked(Centre.whirling(entry.radius, 1.0))))
    for orbit in orbits:
        if orbit.admissible and orbit.stable:
            motion, name = orbit.trajectory(), MotionName(Outcome.BOUNCING, 1, orbit=orbit.name)
            yield Demand(name.words, limit, largest_along(motion, limit), largest_jump(motion, limit))
    if roll is not None and roll.holds:
        yield Demand(ROLLING.words, limit, float(limit.asked(Centre.whirling(1.0, -roll.speed))))


def asked_by(case: Case, disturbances: Iterable[Sample]) -> float | None:
    """Largest multiple of the largest rate of the current that levitation, and disturbances at their largest size, ask for; ``None`` without one.

    Followed are as many disturbances of each kind as :data:`LARGEST`, in random directions, each until its end is known.
    """
    limit = slew_limit_of(case)
    if limit is None:
        return None
    rotor = rotor_of(case)
    reached = [float(limit.asked(Centre.whirling(rotor.system.rest_radius, 1.0)))]
    for sample in disturbances:
        starts = sample.model.starts_on(rotor, *coordinates_at_largest(rotor, sample, LARGEST))
        machines = [rotor] * len(starts.positions) if starts.after is None else starts.after
        each = zip(machines, starts.positions, starts.velocities, starts.begins.tolist(), strict=True)
        for after, position, velocity, begun in each:
            motion = simulate(after, State.of(position, velocity, time=begun), settle=True)
            reached.append(largest_along(motion, limit))
    return max(reached) / limit.most


def largest_along(motion: Trajectory, limit: SlewLimit) -> float:
    """Largest rate of the current along a motion of the planar rotor, in A/s, but for jumps."""
    fastest = 1.0 + float(np.abs(motion.rotor.system.arrays["exponents"]).max(initial=0.0))
    count = min(math.ceil(motion.time * fastest / STEP) + 2, MOST_INSTANTS)
    return float(limit.asked(Centre.along(motion, motion.sample(count))).max())


def largest_jump(motion: Trajectory, limit: SlewLimit) -> float:
    """Largest jump of the control current at an impact of a motion, in A."""
    sudden = motion.is_impact | motion.is_landing
    (_, before), (_, after) = (
        motion.rotor.system.state(states[sudden]) for states in (motion.arrivals, motion.segment_amplitudes[1:])
    )
    return limit.per_jump * float(np.abs(after - before).max(initial=0.0))


def actuator_words(demand: BearingDemand) -> str:
    """Say what the limits of the magnetic bearings do in the motions, and which motions ask for a larger rate of the current."""
    return " ".join([*_words_of_control(demand), *_words_of_slew(demand)])


def _words_of_control(demand: BearingDemand) -> list[str]:
    if demand.control is None:
        return []
    total, count = len(demand.at_limit), int(demand.at_limit.sum())
    sentences = [
        f"The magnetic bearings give {demand.control.words}: in every motion that was followed they do no more than that.",
        f"{count or 'None'} of {total} disturbances bring them to this limit"
        + (f", and {int((demand.at_limit & demand.came_back).sum())} of these came back." if count else "."),
    ]
    return sentences if total else sentences[:1]


def _words_of_slew(demand: BearingDemand) -> list[str]:
    if demand.slew is None:
        return []
    limit, shares = demand.slew, demand.shares
    most = f"{number(limit.most)} A/s"
    sentences = [f"The current of one magnetic bearing changes by at most {most}, which the motions leave out."]
    sentences += [f"In {each.motion} its rate reaches {number(each.share, 3)} times that." for each in demand.motions]
    if len(shares):
        sentences.append(
            f"{int((shares > 1.0).sum()) or 'None'} of {len(shares)} disturbances ask for a larger rate; the most "
            f"is {number(shares.max(), 3)} times the limit."
        )
    sentences += _words_of_jumps(demand, limit)
    if demand.doubtful:
        sentences.append(
            f"{demand.doubtful} of the {int(demand.came_back.sum())} that came back are among them: that the real machine comes "
            "back from these is not shown."
        )
    if any(each.share > 1.0 for each in demand.motions) or demand.doubtful:
        sentences.append("Beyond this limit the real machine moves otherwise than this model.")
    return sentences


def _words_of_jumps(demand: BearingDemand, limit: SlewLimit) -> list[str]:
    """Say how long the bearing takes for the largest jump that the controller asks for at an impact."""
    jump = max([float(demand.jumps.max(initial=0.0)), *(each.jump for each in demand.motions)])
    if not jump:
        return []
    return [
        f"At an impact the controller asks at once for a current that differs by up to {number(jump)} A.",
        f"The bearing takes {number(1e3 * jump / limit.most)} ms for that; the rates are those between impacts.",
    ]
