"""A sample of simulated disturbances, the same ones every time, so that a verdict rests on motions too."""

from __future__ import annotations

import cmath
import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.orbits import Orbit
from carom.outcome import Outcome
from carom.rotors import Rotor
from carom.trajectories import State, Trajectory, kick, simulate

__all__ = ["Disturbance", "Ending", "Kind", "Trials", "simulate_disturbances"]

Kind = Literal["kick", "start"]

SEED = 2014
KICK_SPEEDS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
"""Sizes of the kicks in ``c_r Ω``."""
KICK_DIRECTIONS = 16
TRIALS = 200
FASTEST_START = 0.5
"""Largest speed of the starts within the clearance, in ``c_r Ω``."""
LONGEST = 20_000.0
"""Time after which a motion that has not settled is given up, in ``1/Ω``."""
MOST_EVENTS = 200_000
SAME_ORBIT = 1e-6
"""Difference from an orbit, relative to its speeds and period, below which a periodic motion is that orbit.

Far above the 1e-9 to which a motion that counts as periodic repeats itself, far below the distance between orbits.
"""


@dataclass(frozen=True)
class Ending:
    """A motion on which disturbances end.

    Attributes
    ----------
    outcome : Outcome
    orbit : str
        Name of the orbit, if it is a known one.
    multiplicity : int
        Impacts a period of periodic bouncing; 0 otherwise.
    """

    outcome: Outcome
    orbit: str = ""
    multiplicity: int = 0

    @property
    def words(self) -> str:
        """Where the rotor ends, to follow a count: ``12 ended ...``."""
        if self.outcome is Outcome.BOUNCING:
            if self.orbit:
                return f"bouncing on {self.orbit}"
            if self.multiplicity:
                return f"bouncing with {self.multiplicity} impacts a period"
            return "bouncing without ever repeating"
        return _WORDS.get(self.outcome, self.outcome.label)


_WORDS = {
    Outcome.LEVITATED: "contact-free levitation",
    Outcome.MIXED: "alternating between bounces and lasting contact",
    Outcome.FORWARD_RUB: "synchronous rub",
    Outcome.BACKWARD_WHIRL: "sliding backward whirl",
    Outcome.ROLLING: "rolling backward whirl",
    Outcome.TIME_REACHED: "unsettled when the time was over",
    Outcome.EVENT_LIMIT: "unsettled after very many contacts",
    Outcome.GRAZING: "undecided, since it grazes the wall",
}


@dataclass(frozen=True)
class Disturbance:
    """One simulated disturbance.

    Attributes
    ----------
    kind : {"kick", "start"}
        A velocity kick of the levitating rotor, or a start anywhere within the clearance.
    start : State
    ending : Ending
        Where it settled.
    time : float
        When that was known, in ``1/Ω``.
    impacts, lasting_contacts : int
        Until then.
    hardest_impulse : float
        Largest normal impulse until then, in ``m c_r Ω``.
    final_force : float
        Largest force of lasting contact during the last turn of the shaft, in ``m c_r Ω²``; 0 without such contact.
    """

    kind: Kind
    start: State
    ending: Ending
    time: float
    impacts: int
    lasting_contacts: int
    hardest_impulse: float
    final_force: float

    @property
    def speed(self) -> float:
        """Speed at the start in ``c_r Ω``; of a kick its size."""
        return abs(self.start.velocity)

    @property
    def angle(self) -> float:
        """Direction of the velocity at the start in rad."""
        return cmath.phase(self.start.velocity)

    @property
    def touches(self) -> bool:
        """Whether the rotor touches the wall at all."""
        return self.impacts > 0 or self.lasting_contacts > 0

    @property
    def recovers(self) -> bool:
        """Whether the rotor comes back to contact-free levitation."""
        return self.ending.outcome is Outcome.LEVITATED

    def trajectory(self, rotor: Rotor, longer: float = 0.0) -> Trajectory:
        """Simulate it again, to where it has settled and ``longer``, in ``1/Ω``."""
        return simulate(rotor, self.start, self.time + longer)


@dataclass(frozen=True)
class Trials:
    """All simulated disturbances.

    Attributes
    ----------
    members : tuple of Disturbance
    seed : int
        Of the random starts.
    """

    members: tuple[Disturbance, ...]
    seed: int

    def __len__(self) -> int:
        return len(self.members)

    def __iter__(self) -> Iterator[Disturbance]:
        return iter(self.members)

    @property
    def endings(self) -> dict[Ending, Trials]:
        """Where they ended, the most frequent first, and which did."""
        groups: dict[Ending, list[Disturbance]] = {}
        for member in self:
            groups.setdefault(member.ending, []).append(member)
        ordered = sorted(groups.items(), key=lambda item: -len(item[1]))
        return {ending: self._only(group) for ending, group in ordered}

    def of_kind(self, kind: Kind) -> Trials:
        """Only the kicks, or only the starts."""
        return self._only([member for member in self if member.kind == kind])

    def of_speed(self, speed: float) -> Trials:
        """Only those of this speed, in ``c_r Ω``."""
        return self._only([member for member in self if math.isclose(member.speed, speed, rel_tol=1e-9)])

    def _only(self, members: Sequence[Disturbance]) -> Trials:
        return dataclasses.replace(self, members=tuple(members))

    @property
    def recovered(self) -> int:
        """How many came back to contact-free levitation."""
        return sum(member.recovers for member in self)

    @property
    def touching(self) -> Trials:
        """Only those that touched the wall."""
        return self._only([member for member in self if member.touches])

    @property
    def smallest_unrecovered_kick(self) -> float | None:
        """Smallest kick tried that did not come back to levitation, in ``c_r Ω``; ``None`` if all did."""
        return min((member.speed for member in self.of_kind("kick") if not member.recovers), default=None)

    @property
    def hardest_impulse(self) -> float:
        """Largest normal impulse of all, in ``m c_r Ω``."""
        return max((member.hardest_impulse for member in self), default=0.0)

    @property
    def final_force(self) -> float:
        """Largest force of lasting contact at the end, in ``m c_r Ω²``."""
        return max((member.final_force for member in self), default=0.0)


def simulate_disturbances(
    rotor: Rotor, stable_orbits: Sequence[Orbit], progress: Callable[[float], None] | None = None
) -> Trials:
    """Simulate kicks of several sizes and directions, and random starts within the clearance, to where they settle.

    Parameters
    ----------
    rotor : Rotor
    stable_orbits : sequence of Orbit
        Orbits that motions may settle on.
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    Trials
        200 disturbances; all of them random starts if the rotor cannot levitate.
    """
    starts: list[tuple[Kind, State]] = []
    if abs(rotor.equilibrium) < 1.0:
        angles = 2.0 * math.pi * np.arange(KICK_DIRECTIONS) / KICK_DIRECTIONS
        starts += [("kick", kick(speed, float(angle)).state(rotor)) for speed in KICK_SPEEDS for angle in angles]
    starts += [("start", state) for state in _random_states(TRIALS - len(starts))]
    members = []
    for done, (kind, start) in enumerate(starts, start=1):
        members.append(_follow(rotor, kind, start, stable_orbits))
        if progress:
            progress(done / len(starts))
    return Trials(tuple(members), SEED)


def _random_states(count: int) -> list[State]:
    """Positions even over the clearance circle, velocities even over a disc."""
    random = np.random.default_rng(SEED)
    radii = np.sqrt(random.random((count, 2)))
    angles = 2.0 * math.pi * random.random((count, 2))
    points = radii * np.exp(1j * angles)
    return [State(complex(point[0]), FASTEST_START * complex(point[1])) for point in points]


def _follow(rotor: Rotor, kind: Kind, start: State, stable_orbits: Sequence[Orbit]) -> Disturbance:
    motion = simulate(rotor, start, LONGEST, settle=True, max_events=MOST_EVENTS)
    orbit = next((orbit.name for orbit in stable_orbits if _is_on(motion, orbit)), "")
    impulses = motion.contacts.normal_impulse
    hardest = float(impulses.max()) if len(impulses) else 0.0
    return Disturbance(
        kind=kind,
        start=start,
        ending=Ending(motion.outcome, orbit, motion.multiplicity),
        time=motion.time,
        impacts=len(impulses),
        lasting_contacts=len(motion.lasting_contacts),
        hardest_impulse=hardest,
        final_force=_final_force(motion),
    )


def _final_force(motion: Trajectory) -> float:
    if not motion.outcome.settled or not motion.lasting_contacts:
        return 0.0
    normal, _ = motion.forces(np.linspace(max(0.0, motion.time - 2.0 * math.pi), motion.time, 200))
    return float(normal.max())


def _is_on(motion: Trajectory, orbit: Orbit) -> bool:
    """Whether a motion has settled on an orbit: compare the last impact and the flight before it."""
    if motion.outcome is not Outcome.BOUNCING or motion.multiplicity != 1:
        return False
    log = motion.contacts
    turn = abs(cmath.phase(cmath.rect(1.0, float(log.angle[-1]) - orbit.angle)))
    speeds = abs(log.radial_speed[-1] - orbit.radial_speed) + abs(log.angular_speed[-1] - orbit.angular_speed)
    size = abs(orbit.radial_speed) + abs(orbit.angular_speed)
    flight = log.time[-1] - log.time[-2]
    return bool(
        turn < SAME_ORBIT and speeds < SAME_ORBIT * size and abs(flight - orbit.period) < SAME_ORBIT * orbit.period
    )
