"""Branches of the periodic motions of any machine along a parameter, closed on the flow of the simulator (:mod:`carom.orbits.simulated`).

What happens in a period is read anew at every point, so that a branch goes on where an event joins or leaves the period: where a flight
vanishes, two contacts become one, or a limit is met.  A period of any length begins where the radius is least; one of whole turns at its instant.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, pairwise
from typing import ClassVar

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import CaromError, InputError, Phase
from carom.base.results import Result
from carom.bifurcations.points import Bifurcation, kinds_in_a_line
from carom.bifurcations.simulated_family import SimulatedFamily
from carom.continuation import Branch, Equations, SpecialPoint, Steps, continue_branch
from carom.models import Rotor
from carom.models.axes import Axis, Ends, axis, interval_around
from carom.orbits.closing import multipliers_from, newton
from carom.orbits.flow import Flow, FlowBudget
from carom.orbits.happenings import happenings, word_of
from carom.orbits.names import CountedName
from carom.orbits.simulated import SimulatedOrbit

STEPS = Steps(
    first=0.01, largest=0.2, smallest=1e-6, sharpest_turn=0.3, most_points=250, tolerance=1e-10, resolution=1e-8
)
"""Derivatives by differences do not tell places of special points any better."""
MOST_NUMBERS = 40
"""Numbers of a state up to which its branches are followed: each step takes the whole derivative."""
SAMPLES, HALVINGS = 2000, 60
BISECTIONS = 12
JOINS, CHANGES = "grazing", "contact-change"
"""Where an impact at a wall joins or leaves the period, and where anything else that happens in it does."""
OFFSETS_TRIED, ALONG = (2e-3, -2e-3, 1e-2, -1e-2), (0.02, 0.06, 0.15)
"""Changes of the parameter, relative to it, and distances along the direction that alternates, at which a doubled period is sought."""
NEUTRAL, CONTINUUM = 1e-6, "one of a continuum"
"""Singular value of all derivatives of the equations below which a motion is one of a continuum at one value of the parameter; it is no branch then.
Rolling closes after a turn from any angle, where the radius of the rotor is a whole number of clearances."""
TWICE = 1e-4
"""Distance of the halves of a period, from which on it is no shorter one."""


@dataclass(frozen=True, eq=False, repr=False)
class SimulatedBranch(Result):
    """Periodic motions of any machine along a parameter.

    Attributes
    ----------
    axis : Axis
    name : CountedName
    rotor : Rotor
        That of the motion from which it was followed.
    values : ndarray, shape (m,)
        The parameter.
    orbits : tuple of SimulatedOrbit
    special : tuple of Bifurcation
        In the order of the branch.
    stops : tuple of two str
        See :class:`~carom.continuation.Branch`.
    """

    shown: ClassVar[tuple[str, ...]] = ("parameter", "name", "word", "values", "period", "special", "stops")

    axis: Axis
    name: CountedName
    rotor: Rotor
    values: np.ndarray
    orbits: tuple[SimulatedOrbit, ...]
    special: tuple[Bifurcation, ...]
    stops: tuple[str, str]

    def __len__(self) -> int:
        return len(self.values)

    def line_of(self, name: str, value: object) -> str:
        """Special points are stated by their kinds."""
        return kinds_in_a_line(self.special) if name == "special" else super().line_of(name, value)

    @property
    def parameter(self) -> str:
        """Name of the parameter."""
        return self.axis.name

    @property
    def names(self) -> tuple[object, ...]:
        """Name of each orbit."""
        return (self.name,) * len(self)

    @cached_property
    def impacts(self) -> int:
        """Impacts in a period of the first orbit."""
        return self.orbits[0].impacts

    @property
    def word(self) -> str:
        """What happens in a period of the first orbit."""
        return self.orbits[0].segments

    @property
    def period(self) -> np.ndarray:
        """Periods in ``1/Ω``, shape (m,)."""
        return np.array([orbit.period for orbit in self.orbits])

    @property
    def radial_speed(self) -> np.ndarray:
        """``ṙ`` of the fastest impact in ``c_r Ω``, shape (m,)."""
        return np.array([orbit.radial_speed for orbit in self.orbits])

    @property
    def radial_speeds(self) -> np.ndarray:
        """The same, shape (m, 1): how many impacts there are changes along the branch."""
        return self.radial_speed[:, None]

    @property
    def admissible(self) -> np.ndarray:
        """All are motions of the machine; bool, shape (m,)."""
        return np.ones(len(self), bool)

    @property
    def multipliers(self) -> np.ndarray:
        """Non-trivial multipliers, complex, shape (m, k)."""
        return np.array([orbit.multipliers.values for orbit in self.orbits])

    @property
    def stable(self) -> np.ndarray:
        """Which orbits have all multipliers inside the unit circle, bool, shape (m,)."""
        return np.array([orbit.stable for orbit in self.orbits])

    def passes(self, orbit: SimulatedOrbit, value: float) -> bool:
        """Whether the branch passes through an orbit at a value of the parameter, as its period and speed tell."""
        for i, (left, right) in enumerate(pairwise(self.values.tolist())):
            if min(left, right) <= value <= max(left, right) and left != right:
                share = (value - left) / (right - left)
                period, speed = (
                    (1.0 - share) * each[i] + share * each[i + 1] for each in (self.period, self.radial_speed)
                )
                off = abs(orbit.period - period) / period, abs(orbit.radial_speed - speed) / (1.0 + abs(speed))
                if max(off) < ON_BRANCH:
                    return True
        return False


ON_BRANCH = 5e-3
"""Relative distance of period and speed from those interpolated on a branch, within which an orbit is one of it."""


def begun_at_least_radius(orbit: SimulatedOrbit) -> SimulatedOrbit:
    """The same orbit, beginning where the radius is least: there a free period is distinguished from its delays, even in contact all the time."""
    motion = orbit.motion
    seen = motion.seen_at(orbit.leading_plane)
    times = np.linspace(0.0, motion.time, SAMPLES)
    radii = np.abs(seen.at_plane(times)[0])
    place = int(np.argmin(radii[1:-1])) + 1
    low, high = float(times[place - 1]), float(times[place + 1])

    def radial(time: float) -> float:
        position, velocity = seen.at_plane(np.array([time]))
        return float((position[0].conjugate() * velocity[0]).real)

    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if radial(middle) < 0.0 else (low, middle)
    flow, vector = Flow.at(motion, 0.5 * (low + high))
    return replace(orbit, start=flow.state(vector), rests=flow.rests)


@checked
def continue_simulated(
    orbit: SimulatedOrbit,
    parameter: str,
    interval: Ends,
    steps: Steps | None = None,
    budget: FlowBudget | None = None,
) -> SimulatedBranch:
    """Continue a periodic motion of any machine along a parameter, through events that join or leave its period.

    A motion that is one of a continuum at one value of the parameter is all of its branch.

    Parameters
    ----------
    orbit : SimulatedOrbit
    parameter : str
    interval : tuple of float or str
    budget : FlowBudget, optional
        What the motions are paid from.

    Raises
    ------
    InputError
        Unknown parameter, an interval without the orbit, or a rotor of very many states.
    """
    along = axis(orbit.rotor, parameter)
    present, limits = interval_around(along, along.value(orbit.rotor), interval)
    if (count := len(Flow.vector(orbit.start))) > MOST_NUMBERS:
        raise InputError("orbit", count, f"a rotor of at most {MOST_NUMBERS} numbers of a state")
    begun = begun_at_least_radius(orbit) if orbit.repeats is None else orbit
    family = SimulatedFamily(begun, along, limits, budget or FlowBudget())
    vector = Flow.vector(begun.start)
    start = np.append(vector, begun.period) if family.free else vector
    scales = np.append(np.ones(len(start)), family.size)
    slopes = family.jacobian(start, present) * scales
    if np.isfinite(slopes).all() and np.linalg.svd(slopes, compute_uv=False)[-1] < NEUTRAL:
        return SimulatedBranch(along, orbit.name, orbit.rotor, np.array([present]), (orbit,), (), (CONTINUUM,) * 2)
    equations = Equations(family.residual, family.jacobian, scales, steps or STEPS)
    branch = continue_branch(equations, start, present, limits, watches=family.watches())
    points = zip(branch.unknowns, branch.parameters.tolist(), strict=True)
    found = [(p, each) for u, p in points if (each := family.orbit_at(u, p, orbit.name)) is not None]
    values, orbits = np.array([p for p, _ in found]), tuple(each for _, each in found)
    special = [point for each in branch.special if (point := _special(family, each, orbit.name)) is not None]
    special += _changes(family, branch, orbit.name)
    special.sort(key=lambda point: point.place)
    return SimulatedBranch(along, orbit.name, orbit.rotor, values, orbits, tuple(special), branch.stops)


def _special(family: SimulatedFamily, point: SpecialPoint, name: CountedName) -> Bifurcation | None:
    orbit = family.orbit_at(point.unknowns, point.parameter, name)
    if orbit is None:
        return None
    if point.kind == "neimark-sacker":
        pairs = list(combinations(orbit.multipliers.values.tolist(), 2))
        if abs(min(pairs, key=lambda pair: abs(pair[0] * pair[1] - 1.0))[0].imag) < 1e-9:
            return None
    return Bifurcation.of(point.kind, orbit, family.along.name, point.parameter, point.place)


def _changes(family: SimulatedFamily, branch: Branch, name: CountedName) -> list[Bifurcation]:
    """Points between which something joins or leaves the period, by bisection on the chord."""
    found = []
    known = [_word_at(family, u, p) for u, p in zip(branch.unknowns, branch.parameters.tolist(), strict=True)]
    for i, (before, after) in enumerate(pairwise(known)):
        if before is None or after is None or before[0] == after[0]:
            continue
        ends = [np.append(branch.unknowns[k], branch.parameters[k]) for k in (i, i + 1)]
        low, high = ends
        for _ in range(BISECTIONS):
            middle = _corrected(family, 0.5 * (low + high))
            if middle is None:
                break
            here = _word_at(family, middle[:-1], float(middle[-1]))
            low, high = (middle, high) if here is not None and here[0] == before[0] else (low, middle)
        orbit = family.orbit_at(low[:-1], float(low[-1]), name)
        if orbit is not None:
            kind = JOINS if before[1] != after[1] else CHANGES
            length = float(np.linalg.norm(ends[1] - ends[0])) or 1.0
            place = i + float(np.linalg.norm(low - ends[0])) / length
            found.append(Bifurcation.of(kind, orbit, family.along.name, float(low[-1]), place))
    return found


def _word_at(family: SimulatedFamily, u: np.ndarray, p: float) -> tuple[str, int] | None:
    """What happens in a period, from its first impact on in the order of the alphabet, and the number of impacts."""
    motion = family.motion(u, p)
    if motion is None:
        return None
    found = happenings(motion)
    turns = [word_of([*found[k:], *found[:k]]) for k in range(len(found))] or [
        str(bool((motion.segment_phases != Phase.FLIGHT).any()))
    ]
    return min(turns), sum(each.begins_contact for each in found)


def _corrected(family: SimulatedFamily, guess: np.ndarray) -> np.ndarray | None:
    """Point of the branch at the parameter of a guess."""
    u, p = guess[:-1], float(guess[-1])
    flow, (vector, period) = family.flow(p), family.split(u)
    found = None if flow is None else newton(flow, vector, period, free=family.free)
    if found is None:
        return None
    return np.concatenate([found[0], [found[1]] if family.free else [], [p]])


@checked
def switch_simulated(point: Bifurcation, interval: Ends, budget: FlowBudget | None = None) -> SimulatedBranch:
    """Branch of twice the period at a period doubling of a periodic motion of any machine.

    Raises
    ------
    CaromError
        No such motion is found beside it.
    """
    orbit: SimulatedOrbit = point.shot
    budget = budget or FlowBudget()
    along = axis(orbit.rotor, point.parameter)
    vector = Flow.vector(orbit.start)
    free = orbit.repeats is None
    slopes = orbit.flow.derivative(vector, orbit.motion)
    values, vectors = np.linalg.eig(slopes)
    direction = vectors[:, int(np.argmin(np.abs(values + 1.0)))].real
    direction = direction / np.abs(direction).max()
    for share in OFFSETS_TRIED:
        flow = Flow(along.move(orbit.rotor, point.value * (1.0 + share)), orbit.start.time, orbit.rests, budget)
        for size in ALONG:
            found = newton(flow, vector + size * direction, 2.0 * orbit.period, free=free)
            if found is None or np.abs(flow.end(found[0], 0.5 * found[1]) - found[0]).max() < TWICE:
                continue
            motion = flow.follow(*found)
            if motion is None:
                continue
            values = multipliers_from(flow.derivative(found[0], motion), free=free)
            doubled = orbit.moved(flow, *found, values, replace(orbit.name, impacts=2 * orbit.impacts, number=1))
            return continue_simulated(doubled, point.parameter, interval, budget=budget)
    raise CaromError("no orbit of twice the period was found beside the period doubling")
