"""What the motions of a study ask of the magnetic bearings, against the limits of these.

The model has linear levitation control: ``n`` equal bearings act on the rotor with ``kz + cż`` whatever its size, each
by the control current ``i = ((k/n + ks)z + (c/n)ż)/ki`` (:mod:`carom.parameters.terms`).  A real bearing gives no more
than its limits, so a motion that asks for more is not that of the real machine.

With ``U`` and ``U̇`` of the co-rotating frame ``|kz + cż| = c_r |kU + cΩ(U̇ + iU)|``.  Its largest value is exact for
steady motions.  Along others it is found at all events and at instants so close that an oscillation between two of them
adds less than 0.1 %.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from carom.attractors import AttractorSet, Ending, MotionName
from carom.attractors.names import LEVITATION, SYNCHRONOUS_RUB
from carom.closed_forms.equilibria import Equilibrium
from carom.closed_forms.whirl import Rolling
from carom.motions.trajectories import Trajectory, simulate
from carom.orbits.orbit import Orbit
from carom.outcome import Outcome
from carom.parameters import Case
from carom.studies.wording import number

if TYPE_CHECKING:
    from carom.studies.assembly import Study

ROLLING = MotionName(Outcome.ROLLING)
STEP = 0.05
"""Largest step of phase between two instants, in rad of the fastest oscillation."""
MOST_INSTANTS = 200_000
"""Largest number of instants of one motion."""
_UNITS = {"force": "N", "current": "A"}


@dataclass(frozen=True)
class BearingLimit:
    """Largest force or control current of one magnetic bearing, and what a motion asks of it.

    Attributes
    ----------
    kind : {"force", "current"}
    most : float
        The limit, in N or A.
    per_displacement, per_velocity : float
        What is asked of the bearing per clearance of displacement, and per ``c_rΩ`` of velocity, in N or A.
    """

    kind: Literal["force", "current"]
    most: float
    per_displacement: float
    per_velocity: float

    def asked(self, position: Any, velocity: Any) -> Any:
        """What a state of the co-rotating frame asks of the bearing, in N or A: the size of a vector of two axes."""
        return np.abs(self.per_displacement * position + self.per_velocity * (velocity + 1j * position))

    def words(self, value: float) -> str:
        """A force or current with its unit."""
        return f"{number(value)} {_UNITS[self.kind]}"


@dataclass(frozen=True)
class Demand:
    """What a motion asks of one magnetic bearing at most, in N or A."""

    motion: str
    limit: BearingLimit
    largest: float

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
    came_back : ndarray of bool, shape (n,)
        Which disturbances came back to levitation.
    """

    limits: tuple[BearingLimit, ...]
    motions: tuple[Demand, ...]
    disturbances: tuple[np.ndarray, ...]
    came_back: np.ndarray

    @property
    def doubtful(self) -> int:
        """Number of disturbances that came back, in the model, and asked for more than a limit on their way."""
        beyond = np.any([shares > 1.0 for shares in self.disturbances], axis=0)
        return int((beyond & self.came_back).sum())

    def document(self) -> dict[str, Any]:
        """As plain data for JSON."""
        return {
            "limits": [{"kind": limit.kind, "limit_si": limit.most} for limit in self.limits],
            "motions": [
                {"motion": each.motion, "kind": each.limit.kind, "largest_si": each.largest, "share": each.share}
                for each in self.motions
            ],
            "disturbances": [
                {
                    "kind": limit.kind,
                    "largest_share": float(shares.max(initial=0.0)),
                    "beyond": int((shares > 1.0).sum()),
                }
                for limit, shares in zip(self.limits, self.disturbances, strict=True)
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
    if machine.current_limit is not None and machine.force_current_factor and machine.negative_stiffness is not None:
        factor, pull = machine.force_current_factor, machine.negative_stiffness * scales.length
        found.append(BearingLimit("current", machine.current_limit, (stiffness + pull) / factor, damping / factor))
    return tuple(found)


def bearing_demand(
    case: Case, equilibria: Iterable[Equilibrium], orbits: Iterable[Orbit], roll: Rolling, found: AttractorSet
) -> BearingDemand | None:
    """What the motions of a study ask of the magnetic bearings; ``None`` if these have no limits."""
    limits = limits_of(case)
    if not limits:
        return None
    motions = []
    for entry in equilibria:
        if entry.status != "virtual" and entry.stable:
            name = LEVITATION if entry.kind == "contact-free" else SYNCHRONOUS_RUB
            motions += [Demand(name.words, limit, float(limit.asked(entry.radius, 0.0))) for limit in limits]
    for orbit in orbits:
        if orbit.admissible and orbit.stable:
            reached = largest_along(orbit.trajectory(), limits)
            motions += [Demand(f"bouncing on {orbit.name}", *each) for each in zip(limits, reached, strict=True)]
    if roll.holds:
        velocity = -1j * (roll.speed + 1.0)  # the centre goes round backward, at ``speed`` in the fixed frame
        motions += [Demand(ROLLING.words, limit, float(limit.asked(1.0, velocity))) for limit in limits]
    tried = found.disturbances
    peaks = np.array([_until_known(ending, limits) for ending in tried]).reshape(len(tried), len(limits))
    shares = tuple(peaks[:, place] / limit.most for place, limit in enumerate(limits))
    return BearingDemand(limits, tuple(motions), shares, np.array([ending.recovered for ending in tried], bool))


def _until_known(ending: Ending, limits: tuple[BearingLimit, ...]) -> tuple[float, ...]:
    """Largest values of a disturbance, which is simulated once more."""
    return largest_along(simulate(ending.rotor, ending.start.state, ending.time), limits)


def largest_along(motion: Trajectory, limits: tuple[BearingLimit, ...]) -> tuple[float, ...]:
    """Largest value of each limit's kind along a motion, in N or A."""
    fastest = 1.0 + float(np.abs(motion.rotor.system.exponents).max(initial=0.0))
    count = min(math.ceil(motion.time * fastest / STEP) + 2, MOST_INSTANTS)
    position, velocity = motion.at(motion.sample(count))
    return tuple(float(limit.asked(position, velocity).max()) for limit in limits)


def actuator_words(study: Study) -> str:
    """Say which motions ask for more than the magnetic bearings can give."""
    demand = study.bearing_demand
    if demand is None:
        return ""
    most = " and ".join(f"{limit.words(limit.most)} of {limit.kind}" for limit in demand.limits)
    sentences = [f"Levitation control is assumed linear, and one magnetic bearing gives at most {most}."]
    for motion in dict.fromkeys(each.motion for each in demand.motions):
        reached = [
            f"the bearing {each.limit.kind} reaches {number(each.share, 3)} times its limit of {each.limit.words(each.limit.most)}"
            for each in demand.motions
            if each.motion == motion
        ]
        sentences.append(f"In {motion} {' and '.join(reached)}.")
    for limit, shares in zip(demand.limits, demand.disturbances, strict=True):
        if len(shares):
            sentences.append(
                f"{int((shares > 1.0).sum()) or 'None'} of {len(shares)} disturbances ask for more {limit.kind} than that; the most "
                f"is {number(shares.max(), 3)} times the limit."
            )
    if demand.doubtful:
        sentences.append(
            f"{demand.doubtful} of the {int(demand.came_back.sum())} that came back are among them: that the real machine comes "
            "back from these is not shown."
        )
    if any(each.share > 1.0 for each in demand.motions) or demand.doubtful:
        sentences.append("Beyond a limit the real machine moves otherwise than this model.")
    return " ".join(sentences)
