"""What the motions of a study have to do with the limits of the magnetic bearings.

A limit of force or current acts in the motion (:mod:`carom.models.limits`): which disturbances come to it, and how many of these come back, is counted.

The rate of the current is not limited in the motion of the planar rotor, whose ``n`` equal bearings follow the controller at once, each by the control
current ``i = ((k/n + ks)z + (c/n)ż)/ki`` (:mod:`carom.parameters.terms`).  What it asks for is compared with the limit afterwards: a motion that
asks for more is not that of the real machine.

With ``z = c_r U e^{iΩt}`` a velocity is ``ż = c_rΩ w e^{iΩt}``, ``w = U̇ + iU``, and an acceleration of the fixed frame is
``z̈ = c_rΩ² b e^{iΩt}``, with the forces of lasting contact and what a bearing at its limit does not give, ``e``, in the equation of motion::

    b = ρe^{iφ} - ω²U - γw + (-N + iT)U/|U| + e

So the rate of the current, ``di/dt = ((k/n + ks)ż + (c/n)z̈)/ki``, needs no differences; at a limit of the current it is that of what is asked for.  An impact, or a
kick, changes ``ż`` at once, and with it the current that the controller asks for: this jump is no rate, and does not count.

The largest values are found at all events and at instants so close that an oscillation between two of them adds less than 0.1 %.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.attractors import AttractorSet
from carom.base.results import record
from carom.core.limits import WITHIN
from carom.disturbances import Sample
from carom.models import rotor_of
from carom.models.saturation import saturation_accelerations, saturation_of
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.parameters import Case, ControlLimit
from carom.parameters.formats import number
from carom.studies.trials import coordinates_at_largest

STEP = 0.05
"""Largest step of phase between two instants, in rad of the fastest oscillation."""
MOST_INSTANTS = 200_000
"""Largest number of instants of one motion."""
SHORTEST = 1e-6
"""Time for which a disturbance is followed whose end is known at once."""
LARGEST = 24
"""Number of disturbances of each kind that are followed to see what a change asks of the bearings."""


@dataclass(frozen=True)
class SlewLimit:
    """Largest rate of the control current of one magnetic bearing, and what a motion asks of it.

    Attributes
    ----------
    most : float
        A/s.
    per_velocity, per_acceleration : float
        Rate per ``c_rΩ`` of velocity and per ``c_rΩ²`` of acceleration, A/s.
    """

    most: float
    per_velocity: float
    per_acceleration: float

    def asked(self, velocity: Any, acceleration: Any) -> Any:
        """What a motion of the rotor centre in the fixed frame asks of the bearing, in A/s: the size of a vector of two axes."""
        return np.abs(self.per_velocity * velocity + self.per_acceleration * acceleration)


@dataclass(frozen=True)
class BearingDemand:
    """What the motions of a study have to do with the limits of the magnetic bearings.

    Attributes
    ----------
    control : ControlLimit or None
        Largest control force, which acts in the motions.
    slew : SlewLimit or None
        Largest rate of the current, which does not.
    demand : float or None
        What is asked for at most of that rate, in multiples of it (:func:`asked_by`).
    at_limit, came_back_at_limit, total : int
        Numbers of the disturbances that come to the largest control force, of those among them that come back, and of all.
    """

    control: ControlLimit | None
    slew: SlewLimit | None
    demand: float | None
    at_limit: int
    came_back_at_limit: int
    total: int

    @property
    def is_exceeded(self) -> bool:
        """Whether a larger rate is asked for than the bearings have."""
        return self.demand is not None and self.demand > 1.0

    @property
    def words(self) -> str:
        """What the limits do in the motions, and what is asked for of the rate of the current."""
        words = ""
        if self.control is not None:
            back = f", and {self.came_back_at_limit} of these came back" if self.at_limit else ""
            words = (
                f"The magnetic bearings give {self.control.words}: in every motion that was followed they do no more than that. "
                f"{self.at_limit or 'None'} of {self.total} disturbances bring them to this limit{back}. "
            )
        if self.slew is not None and self.demand is not None:
            words += (
                f"The current of one magnetic bearing changes by at most {number(self.slew.most)} A/s, which the motions leave out: "
                f"what must be survived asks for up to {number(self.demand, 3)} times that."
            )
        return words.rstrip()

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return {
            "control": self.control and record(self.control, "force_si=force pull_si=pull"),
            "slew_rate": self.slew and record(self, "limit_si=slew.most demand"),
            "disturbances": record(self, "at_limit came_back_at_limit"),
        }


def slew_limit_of(case: Case) -> SlewLimit | None:
    """Largest rate of the current of one magnetic bearing of a machine; ``None`` if it is not stated, or under weight."""
    machine, scales, limit = case.machine, case.parameters.scales, case.si.get("slew_rate_limit")
    if machine is None or scales is None or limit is None or rotor_of(case).system.forced is not None:
        return None
    gains = machine.controller_gains
    return SlewLimit(
        limit,
        gains["proportional_gain"] * scales.velocity,
        gains["derivative_gain"] * scales.velocity * scales.speed,
    )


def bearing_demand(case: Case, found: AttractorSet, required: Iterable[Sample]) -> BearingDemand | None:
    """What motions have to do with the limits of the magnetic bearings; ``None`` if these have none.

    The rate of the current is that of what is ``required`` to be survived; nothing is said of it where that is nothing.
    """
    limits, required = rotor_of(case).limits, tuple(required)
    slew = slew_limit_of(case) if required else None
    control = limits if isinstance(limits, ControlLimit) else None
    if control is None and slew is None:
        return None
    tried = found.disturbances if control else ()
    # Until their ends are known.
    motions = ((each, simulate(each.rotor, each.start.state, max(each.time, SHORTEST))) for each in tried)
    back = [each.recovered for each, motion in motions if (motion.segment_limits > WITHIN).any()]
    demand = asked_by(case, required) if slew else None
    return BearingDemand(control, slew, demand, len(back), sum(back), len(tried))


def asked_by(case: Case, disturbances: Iterable[Sample]) -> float | None:
    """Largest multiple of the largest rate of the current that levitation, and disturbances at their largest size, ask for; ``None`` without one.

    Followed are as many disturbances of each kind as :data:`LARGEST`, in random directions, each until its end is known.
    """
    limit = slew_limit_of(case)
    if limit is None:
        return None
    rotor = rotor_of(case)
    radius = rotor.system.rest_radius
    reached = [float(limit.asked(1j * radius, -radius))]
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
    return float(limit.asked(*centre_along(motion, motion.sample(count))).max())


def centre_along(motion: Trajectory, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Velocity and acceleration of the rotor centre in the fixed frame, along axes that turn with the rotor, at times of a motion of the planar rotor.

    In ``c_rΩ`` and ``c_rΩ²``, shapes (n,); at an impact just after it.
    """
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
    return velocity, acceleration
