"""Starts of the motions that are followed until they settle."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.base.arguments import Positive, Seed, Whole, checked
from carom.base.outcome import STEADY_WORDS
from carom.closed_forms import find_equilibria
from carom.closed_forms.exact_results import exact_results
from carom.disturbances import FASTEST, AnyState, KickPlane, Plan, Single, Starts, VelocityKick
from carom.disturbances.coordinates import INSTANT, ON_WALL
from carom.disturbances.following import require_start
from carom.disturbances.plans import INSTANTS, ITS_INSTANT
from carom.models import Rotor, Subject, rotor_of
from carom.motions import State
from carom.orbits import Orbit
from carom.parameters import own_size, usual_kick
from carom.parameters.formats import format_quantity

Kind = Literal["kick", "start", "orbit", "rub", "whirl"]

DISTURBANCES = 200
KICKS_SHARE = 0.6
NUDGE, PUSH = 1e-6, 1e-3
"""Relative change of the speed of a known motion, for stable and for unstable motions.

The first is small compared with any relevant basin.  The second is so large that the motion is not taken for periodic
before it has left the unstable one.
"""


@dataclass(frozen=True)
class Start:
    """A start of a motion, and its origin.

    Attributes
    ----------
    kind : {"kick", "start", "orbit", "rub", "whirl"}
        A velocity kick out of levitation; the start after any other disturbance; a start next to an orbit
        or a synchronous rub that is known in closed form; a start in backward whirl along the wall.
    words : str
        Description of a start next to a known motion.
    """

    kind: Kind
    state: State
    words: str = ""

    @property
    def disturbance(self) -> bool:
        """Whether it belongs to the sample of disturbances, not to the starts next to known motions."""
        return self.kind in ("kick", "start")

    @property
    def speed(self) -> float:
        """Size of a kick, speed in the fixed frame of another start, in ``c_r Ω``: the largest of several coordinates."""
        return float(np.max(np.abs(self._velocity)))

    @property
    def angle(self) -> float:
        """Direction of this velocity in rad: that of the fastest of several coordinates."""
        return cmath.phase(max(np.atleast_1d(self._velocity).tolist(), key=abs))

    @property
    def _velocity(self) -> complex | np.ndarray:
        """Change of velocity by a kick, the same in both frames; velocity in the fixed frame of another start."""
        carried = 0.0 if self.kind == "kick" else 1j * self.state.position
        return self.state.velocity + carried


@checked
@dataclass(frozen=True)
class DisturbanceSet:
    """The standard set of disturbances, used unless another is given.

    Three in five are velocity kicks of the levitating rotor, uniform over the area of the disc of kick velocities up to
    ``fastest``: each in a ring of its own among rings of equal area, at any place of it.  The rest start within the clearance,
    with positions uniform over its disc and velocities in the fixed frame uniform over the disc up to ``fastest``.  If the
    rotor cannot levitate, all of them are starts of this second kind.  Where the instant of the turn matters each has one of its own.

    Attributes
    ----------
    count : int
    seed : int
        The same seed gives the same set.
    fastest : float
        Largest kick and largest speed of the starts in the fixed frame, in ``c_r Ω``; :meth:`of` takes that of a machine.
    """

    count: Whole = DISTURBANCES
    seed: Seed = 0
    fastest: Positive = FASTEST

    @classmethod
    @checked
    def of(
        cls, machine: Subject, count: Whole = DISTURBANCES, seed: Seed = 0, fastest: float | str | None = None
    ) -> DisturbanceSet:
        """Set for a machine, by default up to its :func:`~carom.parameters.usual_kick`.

        Raises
        ------
        InputError
            ``fastest`` is no speed above 0, or has a unit and the machine has no scales.
        """
        scales = rotor_of(machine).scales
        largest = usual_kick(scales) if fastest is None else own_size("fastest", fastest, "velocity", scales)
        return cls(count, seed, largest)

    def kicks(self, rotor: Rotor) -> int:
        """Number of kicks in the set; they come first."""
        return int(KICKS_SHARE * self.count) if rotor.system.rest_radius < 1.0 else 0

    def starts(self, rotor: Rotor) -> Starts:
        """Starts, arrays of shape (count,); kicks come first, by increasing size."""
        random, kicks = np.random.default_rng(self.seed), self.kicks(rotor)
        rings, angles = np.arange(kicks) + random.random(kicks), 2.0 * math.pi * random.random(kicks)
        sizes = self.fastest * np.sqrt(rings / max(kicks, 1))
        anywhere = AnyState(self.fastest)
        (radii, speeds), (places, directions) = (random.random((self.count - kicks, 2)).T for _ in range(2))
        shares = radii, places, speeds, directions
        values = (coordinate.at(share) for coordinate, share in zip(anywhere.coordinates, shares, strict=True))
        kick, others = VelocityKick(self.fastest), anywhere.starts(rotor, *values)
        if not rotor.depends_on_instant:
            return Starts.joined([kick.starts(rotor, sizes, angles), others])
        instants = INSTANT.at(np.random.default_rng([self.seed, INSTANTS]).random(self.count))
        kicked = kick.starts(rotor, sizes, angles, instant=instants[:kicks])
        return Starts.joined([kicked, others.at(instants[kicks:])])

    def words(self, rotor: Rotor) -> str:
        """Describe the disturbances for a given rotor."""
        kicks = self.kicks(rotor)
        kinds = (kicks, "kicks of the levitating rotor"), (self.count - kicks, "starts anywhere in the clearance")
        parts = [f"{number} {words}" for number, words in kinds if number > 0]
        found = f"{' and '.join(parts)}, at up to {format_quantity(self.fastest, 'velocity', rotor.scales)} in the fixed frame"
        if rotor.depends_on_instant:
            found += f", each {ITS_INSTANT}"
        return f"{self.count} disturbances (seed {self.seed}): {found}"


def starts_at(rotor: Rotor, states: Sequence[State]) -> Starts:
    """States as arrays of starts."""
    positions, velocities = (
        np.array([getattr(state, name) for state in states], complex) for name in ("position", "velocity")
    )
    places = np.abs(positions.reshape(len(states), len(rotor.system.rest)) @ rotor.system.planes.T).max(axis=1)
    begins = np.array([state.time for state in states])
    return Starts(positions, velocities, places >= 0.0, places < 0.0, places >= 1.0 - ON_WALL, begins)


def disturbances_of(
    rotor: Rotor, tried: DisturbanceSet | Plan | Sequence[State | Single]
) -> tuple[list[Start], Starts]:
    """The possible ones of the disturbances, as single starts and as arrays; a plan without any is refused."""
    if isinstance(tried, Sequence):
        states = [start if isinstance(start, State) else start.stages(rotor)[1] for start in tried]
        whole = starts_at(rotor, states)
        kicked = np.array(
            [isinstance(start, Single) and isinstance(start.model, VelocityKick) for start in tried], bool
        )
    elif isinstance(tried, DisturbanceSet):
        whole = tried.starts(rotor)
        kicked = np.arange(tried.count) < tried.kicks(rotor)
    else:
        every = tried.starts(rotor)
        require_start(rotor, every)
        whole = every.some(every.exists)
        kicked = np.full(whole.exists.shape, isinstance(tried.model, VelocityKick | KickPlane))
    each = zip(kicked.tolist(), whole.positions, whole.velocities, whole.begins.tolist(), strict=True)
    return [
        Start("kick" if one else "start", State.of(place, speed, time=begun)) for one, place, speed, begun in each
    ], whole


@checked
def known_starts(machine: Subject, orbits: Sequence[Orbit]) -> tuple[Start, ...]:
    """Starts next to every motion known in closed form, so that none is missed because its basin is small.

    Parameters
    ----------
    orbits : sequence of Orbit
        Virtual ones are left out.

    Returns
    -------
    tuple of Start
        Two next to every admissible orbit and synchronous rub, stable or not, one on each side.  With friction: one in
        rolling at each plane that can roll while the others stay inside.  Where the speed is known from which backward whirl
        is certain to run away to rolling: one in such a whirl just above it.
    """
    rotor, starts = rotor_of(machine), []
    for orbit in orbits:
        if orbit.admissible:
            leaving = orbit.departure
            for change in (-NUDGE, NUDGE) if orbit.stable else (-PUSH, PUSH):
                state = State(leaving.position, (1.0 + change) * leaving.velocity)
                starts.append(Start("orbit", state, f"a start next to {orbit.name}"))
    # Under weight no rub is at rest.
    for rub in find_equilibria(rotor)[1:] if rotor.system.forced is None else ():
        if rub.status == "admissible":
            words = f"a start next to the {'stable' if rub.stable else 'unstable'} {STEADY_WORDS['rub']}"
            speeds = (-NUDGE, NUDGE) if rub.stable else (-PUSH, PUSH)
            starts += [Start("rub", State(rub.position, 1j * speed * rub.position), words) for speed in speeds]
    arrays, runaway = rotor.system.arrays, exact_results(rotor).runaway
    if runaway < math.inf:
        speed = min(1.0 + 1.001 * runaway, float(arrays.surface_speed[0]))
        starts.append(_whirling(rotor, 0, speed, "beyond the runaway speed"))
    for plane in np.flatnonzero(
        (arrays.friction > 0.0) & (np.abs(arrays.mobility) <= 1.0 + ON_WALL).all(axis=0)
    ).tolist():
        at = f" at touchdown bearing {plane + 1}" if len(arrays.rows) > 1 else ""
        starts.append(_whirling(rotor, plane, float(arrays.surface_speed[plane]), f"rolling{at}"))
    return tuple(starts)


def _whirling(rotor: Rotor, plane: int, speed: float, words: str) -> Start:
    """Start in backward whirl at a speed in the co-rotating frame, displaced in the shape of an impulse at a plane until it touches."""
    shape = rotor.system.rates @ rotor.system.arrays.columns[:, plane]
    shape = shape / (rotor.system.planes[plane] @ shape)
    velocity = shape * complex(0.0, -speed)
    start = State(shape, velocity) if len(shape) > 1 else State.of(shape[0], velocity[0])
    return Start("whirl", start, f"a start in backward whirl, {words}")
