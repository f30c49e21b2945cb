"""A periodic orbit: the word of its segments, its nodes and durations, its multipliers and margins."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, TypeVar

import numpy as np

from carom.base.arguments import Reals, Whole, checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.core.closing import EQUAL_IMPACT_RTOL
from carom.core.margins import least_margins
from carom.models import Rotor, Subject, exact_rotor_of
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.admissibility import departure, why_virtual
from carom.orbits.happenings import Extremes, extremes_of
from carom.orbits.maps import Multipliers, Section, multipliers_of
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.shooting import Links, ShootingStart, converged, links_of
from carom.orbits.simulated import SimulatedOrbit, same_simulated
from carom.orbits.word import Word
from carom.parameters import Scales

SHORTEST = 1e-9
"""Least duration of a flight, in ``1/Ω``."""


@dataclass(frozen=True, eq=False, repr=False)
class Margins(Result):
    """How far an orbit is from a change of its word: all are above zero on a motion of the machine.

    Attributes
    ----------
    radius : float
        One minus the square of the largest radius of a maximum between contacts, at any plane; infinite without maxima.
    approach : float
        Least radial speed before an impact, in ``c_r Ω``.
    slip : float
        Least slip velocity left after an impact in its direction; where friction stops the slip, what friction could
        still take away.  In ``c_r Ω``; infinite without impacts or friction.
    """

    radius: float
    approach: float
    slip: float

    @property
    def least(self) -> float:
        """The smallest of them."""
        return min(self.radius, self.approach, self.slip)


@dataclass(frozen=True, eq=False, repr=False)
class Orbit(Result):
    """A periodic motion of the planar rotor in a rigid bearing, in the co-rotating frame, as a word of impacts.

    Attributes
    ----------
    rotor : Rotor
    name : OrbitName or CountedName
        ``"B1,d"`` for one impact a period: pair 1 of the periods; ``a`` and ``c`` have the shorter period of the pair, ``b``
        and ``d`` the longer; ``a`` and ``b`` have the lower radial speed, ``c`` and ``d`` the higher.  Names of orbits with
        backward slip begin with ``R``.  ``"P2,1"`` for the first orbit with two impacts.
    word : Word
    nodes : ndarray of complex, shape (m, 2n)
        Coordinates, then their rates, at the beginning of each segment: just before the impact.
    durations : ndarray, shape (m,)
        Of the segments, in ``1/Ω``.
    multipliers : Multipliers
        The non-trivial Floquet multipliers: ``2N − 1`` for ``N`` modes.
    reason : str
        Why it is not admissible; empty if it is.
    """

    figure: ClassVar[str] = "orbit"
    shown: ClassVar[tuple[str, ...]] = (
        "rotor",
        "name",
        "segments",
        "period",
        "radial_speed",
        "angle",
        "angular_speed",
        "stable",
        "admissible",
        "reason",
    )

    # Not narrower: closed forms read the parameters of a planar rotor and the parts of a name.
    rotor: Any
    name: Any
    word: Word
    nodes: np.ndarray
    durations: np.ndarray
    multipliers: Multipliers
    reason: str

    @classmethod
    @checked
    def from_links(cls, rotor: Rotor, word: Word, links: Links, name: OrbitName | CountedName) -> Orbit:
        """Orbit that multiple shooting has found, with its multipliers and its admissibility checked."""
        return cls(rotor, name, word, *links.start, multipliers_of(links), why_virtual(rotor, word, links.start))

    complete: ClassVar[bool] = True
    leading_plane: ClassVar[int] = 0
    flies: ClassVar[bool] = True
    """Whether it only bounces, without lasting contact."""
    turns: ClassVar[int | None] = None
    """Turns of the shaft in a period where these must be whole: any period is possible here."""

    @property
    def start(self) -> ShootingStart:
        """Nodes and durations."""
        return ShootingStart(self.nodes, self.durations)

    @property
    def period(self) -> float:
        """In ``1/Ω``."""
        return float(self.durations.sum())

    @property
    def segments(self) -> str:
        """The word as text."""
        return str(self.word)

    @property
    def impacts(self) -> int:
        """Impacts per period."""
        return len(self.word)

    @property
    def slip(self) -> int:
        """Direction of the slip after the first impact: 1 forward, −1 backward, 0 if it is stopped."""
        return self.word[0].sense

    @property
    def admissible(self) -> bool:
        """Whether it is a motion of the machine: inside the wall between contacts, with the assumed slip and forces."""
        return not self.reason

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out."""
        return self.multipliers.stable

    @cached_property
    def section(self) -> Section:
        """First node in polar coordinates of its plane."""
        return self.sections[0]

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """All nodes in polar coordinates of their planes."""
        states = zip(*self.rotor.system.at_planes(self._amplitudes, self.word.planes), strict=True)
        return tuple(Section.from_state(complex(position), complex(velocity)) for position, velocity in states)

    @property
    def position(self) -> complex:
        """Position at the first impact, on the unit circle."""
        return self.section.state.position

    @property
    def angle(self) -> float:
        """``θ`` at the first impact in rad."""
        return self.section.angle

    @property
    def radial_speed(self) -> float:
        """``ṙ`` just before the first impact in ``c_r Ω``."""
        return self.section.radial_speed

    @property
    def scales(self) -> Scales | None:
        """Scales of the machine, if it has some."""
        return self.rotor.scales

    @property
    def impulse(self) -> float:
        """Normal impulse of the first impact, in ``m c_r Ω``."""
        place, moving = self.rotor.system.at_plane(self._departures[0], 0)
        rebound = float((np.conj(place) * moving).real / abs(place))
        return float(self.rotor.system.arrays.masses[0]) * (self.radial_speed - rebound)

    @cached_property
    def extremes(self) -> Extremes:
        """Largest radius, depth and force at any touchdown bearing; ``nan`` of an orbit that is no motion."""
        return extremes_of(self.trajectory()) if self.admissible else Extremes(np.nan, np.nan, np.nan)

    @property
    def contacts(self) -> list[tuple[str, int, float, Section]]:
        """Kind, contact plane and time of the beginning of each segment, and the state there."""
        begins = np.concatenate([[0.0], np.cumsum(self.durations)[:-1]]).tolist()
        each = zip(self.word, begins, self.sections, strict=True)
        return [(kind.label, 0, begin, section) for kind, begin, section in each]

    @property
    def impact_speeds(self) -> np.ndarray:
        """``ṙ`` just before each impact, in ``c_r Ω``, shape (n,)."""
        return np.array([section.radial_speed for section in self.sections])

    @property
    def angular_speed(self) -> float:
        """``θ̇`` just before the first impact in ``Ω``."""
        return self.section.angular_speed

    @property
    def departure(self) -> State:
        """State just after the first impact."""
        position, velocity = self.rotor.system.state(self._departures[0])
        return State.of(position, velocity)

    @cached_property
    def _departures(self) -> np.ndarray:
        """Amplitudes just after the beginning of each segment, shape (m, N)."""
        return np.array([departure(self.rotor, *pair) for pair in zip(self.word, self._amplitudes, strict=True)])

    @cached_property
    def _amplitudes(self) -> np.ndarray:
        """Mode amplitudes at the nodes, shape (m, N)."""
        return self.rotor.system.nodes.amplitudes(self.nodes)

    @cached_property
    def links(self) -> Links:
        """Its segments with their exact derivatives."""
        return links_of(self.rotor, self.word, self.start)

    @cached_property
    def margins(self) -> Margins:
        """How far it is from a change of its word."""
        return margins_of(self.links, self.rotor, self.word)

    @checked
    def trajectory(self, periods: float = 1.0) -> Trajectory:
        """Follow an admissible orbit by simulation, from just after the first impact."""
        return simulate(self.rotor, self.departure, periods * self.period)

    @checked
    def path(self, times: Reals, plane: Whole = 0) -> np.ndarray:
        """Position ``U`` at times since the first impact, by the exact flights; for virtual orbits too.

        Parameters
        ----------
        times : array_like
            In ``1/Ω``; the orbit repeats after each period.
        plane : int
            The only touchdown bearing, as of every orbit.
        """
        times = np.mod(times, self.period)
        begins = np.concatenate([[0.0], np.cumsum(self.durations)[:-1]])
        place = np.searchsorted(begins, times, side="right") - 1
        system = self.rotor.system
        amplitudes = system.fly(self._departures[place], times - begins[place])
        position, _ = system.at_plane(amplitudes, plane)
        return position


Found = TypeVar("Found", bound=Orbit | SimulatedOrbit)


def margins_of(links: Links, rotor: Rotor, word: Word) -> Margins:
    """How far an orbit is from a change of its word."""
    nodes = rotor.system.nodes.amplitudes(links.start.nodes)
    return Margins(*least_margins(rotor.system.arrays, word.kinds, word.planes, nodes, links.start.durations))


@checked
def orbit_near(
    machine: Subject, word: Word, start: ShootingStart, name: OrbitName | CountedName | None = None
) -> Orbit | None:
    """Orbit of a word next to a start, by Newton's method; ``None`` if it does not converge.

    An orbit that repeats a shorter word becomes the shorter one, and it begins at its fastest impact.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    word : Word
    start : ShootingStart
        Coordinates and rates at the beginning of each segment, and the durations.
    name : OrbitName or CountedName, optional
        By default that of the first orbit with as many impacts.

    Raises
    ------
    InputError
        The rotor is not the planar one in a rigid bearing, or the start does not fit the word.
    """
    rotor = exact_rotor_of(machine)
    shape = len(word), len(rotor.system.nodes.rest)
    if start.nodes.shape != shape or start.durations.shape != shape[:1]:
        raise InputError("start", start.nodes.shape, f"nodes of shape {shape} and {shape[0]} durations")
    links = converged(rotor, word, start)
    if links is None or not lasts(links.start):
        return None
    return orbit_of_links(rotor, word, links, name)


def lasts(solution: ShootingStart) -> bool:
    """Whether each flight of a solution lasts."""
    return bool((solution.durations >= SHORTEST).all())


def orbit_of_links(rotor: Rotor, word: Word, links: Links, name: OrbitName | CountedName | None = None) -> Orbit:
    """Orbit from converged equations, as short as it is and beginning at its fastest impact."""
    nodes, durations = links.start
    count = shortest(word, nodes)
    once = Word(word[:count])
    first = beginning(rotor, once, nodes[:count])
    kept, start = once.turned(first), ShootingStart(nodes[:count], durations[:count]).turned(first)
    return Orbit.from_links(rotor, kept, links_of(rotor, kept, start), name or CountedName(len(kept), 1))


def shortest(word: Word, nodes: np.ndarray) -> int:
    """Number of segments after which an orbit repeats."""
    for k in range(word.least, len(word), word.least):
        apart = np.abs(nodes - np.roll(nodes, -k, axis=0)).max()
        if len(word) % k == 0 and apart <= EQUAL_IMPACT_RTOL * (1.0 + np.abs(nodes).max()):
            return k
    return len(word)


def beginning(rotor: Rotor, word: Word, nodes: np.ndarray) -> int:
    """Segment with which an orbit begins: that of the fastest impact."""
    positions, velocities = rotor.system.at_planes(rotor.system.nodes.amplitudes(nodes), word.planes)
    return int(np.argmax((positions.conj() * velocities).real))


def same_orbit(first: Orbit | SimulatedOrbit, second: Orbit | SimulatedOrbit) -> bool:
    """Whether two orbits are the same, wherever they begin."""
    if isinstance(first, Orbit) and isinstance(second, Orbit):
        turns = (first.start.turned(places).nodes for places in first.word.turns_to(second.word))
        return any(np.abs(nodes - second.nodes).max() <= 1e2 * EQUAL_IMPACT_RTOL for nodes in turns)
    return isinstance(first, SimulatedOrbit) and isinstance(second, SimulatedOrbit) and same_simulated(first, second)


def numbered(orbit: Found, number: int) -> Found:
    """The same orbit with its number among those of its kind."""
    return replace(orbit, name=replace(orbit.name, number=number))


def all_numbered(orbits: Iterable[Found]) -> list[Found]:
    """Orbits in the order of lists, those with few impacts and a short period first, each with its number."""
    counts, named = Counter[str](), list[Found]()
    for orbit in sorted(orbits, key=lambda each: (each.impacts, each.period)):
        counts[kind := str(numbered(orbit, 0).name)] += 1
        named.append(numbered(orbit, counts[kind]))
    return named
