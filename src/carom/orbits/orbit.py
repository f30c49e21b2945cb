"""A periodic orbit: the word of its segments, its nodes and durations, its multipliers and margins."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import compress
from typing import Any, ClassVar

import numpy as np

from carom.arguments import Reals, Whole, checked
from carom.core.closing import ALIKE
from carom.core.layout import rub_workspace
from carom.core.margins import contact_margins, least_margins
from carom.models import Rotor, Subject, rotor_of
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.admissibility import departure, why_virtual
from carom.orbits.extremes import Extremes, extremes_of
from carom.orbits.maps import Section
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.shooting import Links, Start, converged, links_of
from carom.orbits.simulated import SimulatedOrbit, same_simulated
from carom.orbits.stability import Multipliers, multipliers_of
from carom.orbits.word import Word
from carom.outcome import CaromError, InputError
from carom.parameters import Scales
from carom.results import Result

SHORTEST = 1e-9
"""Least duration of a segment other than a chatter, in ``1/Ω``."""
OTHER_SLIP = "friction during its chatter would leave another slip"
INTERRUPTED = "its chatter would not be complete before the normal force vanishes"


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
    normal_force : float
        Least normal force at the beginning of lasting contact, in ``m c_r Ω²``; infinite without it.  Where the chatter before is
        interrupted, the signed distance from the onset of lasting contact stands for it.
    cone : float
        Least distance from the limit of friction where rolling begins, while it lasts, and where the slip passes through zero, in
        ``m c_r Ω²``.
    sliding : float
        Least slip velocity at its minima while sliding, and with which a chatter lands, in ``c_r Ω``; where rolling follows, what friction
        could still take away.
    pressing : float
        Least normal force at its minima inside lasting contact, in ``m c_r Ω²``.
    """

    radius: float
    approach: float
    slip: float
    normal_force: float
    cone: float
    sliding: float
    pressing: float

    @property
    def least(self) -> float:
        """The smallest of them."""
        return min(self.radius, self.approach, self.slip, self.normal_force, self.cone, self.sliding, self.pressing)


@dataclass(frozen=True, eq=False, repr=False)
class Orbit(Result):
    """A periodic motion of the planar rotor in a rigid bearing, in the co-rotating frame, as a word of segments.

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
        start = links.start
        if (links.landings < 0.0).any():
            reason = INTERRUPTED
        else:
            reason = OTHER_SLIP if (links.slips < 0.0).any() else why_virtual(rotor, word, start)
        return cls(rotor, name, word, *start, multipliers_of(links), reason)

    complete: ClassVar[bool] = True
    turns: ClassVar[int | None] = None
    """Turns of the shaft in a period where these must be whole: any period is possible here."""

    @property
    def start(self) -> Start:
        """Nodes and durations."""
        return Start(self.nodes, self.durations)

    @property
    def period(self) -> float:
        """In ``1/Ω``."""
        return float(self.durations.sum())

    @property
    def segments(self) -> str:
        """The word as text."""
        return str(self.word)

    @property
    def flies(self) -> bool:
        """Whether it only bounces, without lasting contact."""
        return self.word.flies

    @property
    def impacts(self) -> int:
        """Impacts per period."""
        return self.word.impacts

    @property
    def slip(self) -> int:
        """Direction of the slip after the first impact: 1 forward, −1 backward, 0 if it is stopped."""
        first = self.word[0].kind
        return first.sense if first.is_impact else 0

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
        """Scales of what is told of the plane of the first segment: lengths there are in its own clearance."""
        return self.rotor.system.scales_at(self.word[0].plane, self.rotor.scales)

    @property
    def impulse(self) -> float:
        """Normal impulse of the first impact, in ``m c_r Ω``."""
        plane = self.word[0].plane
        place, moving = self.rotor.system.at_plane(self._departures[0], plane)
        rebound = float((np.conj(place) * moving).real / abs(place))
        return float(self.rotor.system.arrays.masses[plane]) * (self.radial_speed - rebound)

    @cached_property
    def extremes(self) -> Extremes:
        """Largest radius, depth and force at any touchdown bearing; ``nan`` of an orbit that is no motion."""
        return extremes_of(self.trajectory()) if self.admissible else Extremes(np.nan, np.nan, np.nan)

    @property
    def contacts(self) -> list[tuple[str, int, float, Section]]:
        """Kind, contact plane and time of the beginning of each segment, and the state there."""
        begins = np.concatenate([[0.0], np.cumsum(self.durations)[:-1]]).tolist()
        each = zip(self.word, begins, self.sections, strict=True)
        return [(segment.kind.label, segment.plane, begin, section) for segment, begin, section in each]

    @property
    def impact_speeds(self) -> np.ndarray:
        """``ṙ`` just before each impact, in ``c_r Ω``, shape (n,)."""
        return np.array([section.radial_speed for section in compress(self.sections, self.word.arrives)])

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
    def path(self, times: Reals, plane: Whole | None = None) -> np.ndarray:
        """Position ``U`` at times since the first impact, by the exact flights; for virtual orbits too.

        Parameters
        ----------
        times : array_like
            In ``1/Ω``; the orbit repeats after each period.
        plane : int, optional
            The displacement at this contact plane, in its clearance, instead of the coordinates.

        Raises
        ------
        InputError
            No such plane.
        CaromError
            The orbit has lasting contact; follow its :meth:`trajectory`.
        """
        if not self.word.flies:
            raise CaromError("an orbit with lasting contact has no closed path; follow its trajectory()")
        planes = len(self.rotor.system.contacts)
        if plane is not None and plane >= planes:
            raise InputError("plane", plane, f"a contact plane, from 0 to {planes - 1}")
        times = np.mod(times, self.period)
        begins = np.concatenate([[0.0], np.cumsum(self.durations)[:-1]])
        place = np.searchsorted(begins, times, side="right") - 1
        system = self.rotor.system
        amplitudes = system.fly(self._departures[place], times - begins[place])
        position, _ = system.state(amplitudes) if plane is None else system.at_plane(amplitudes, plane)
        return position


def margins_of(links: Links, rotor: Rotor, word: Word) -> Margins:
    """How far an orbit is from a change of its word."""
    nodes = rotor.system.nodes.amplitudes(links.start.nodes)
    at = word.kinds, word.planes, nodes, links.start.durations, links.landings
    radius, approach, speed, force, cone = least_margins(rotor.system.arrays, *at)
    if word.flies:
        return Margins(radius, approach, speed, force, cone, np.inf, np.inf)
    rub = rub_workspace(nodes.shape[1], len(rotor.system.contacts))
    push, slip, rolling = contact_margins(rotor.system.arrays, *at[:-1], rub)
    sliding = min(slip, float(links.slips.min()))
    return Margins(radius, approach, speed, force, min(cone, rolling), sliding, push)


@checked
def orbit_near(machine: Subject, word: Word, start: Start, name: OrbitName | CountedName | None = None) -> Orbit | None:
    """Orbit of a word next to a start, by Newton's method; ``None`` if it does not converge.

    An orbit that repeats a shorter word becomes the shorter one, and it begins at its fastest impact.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    word : Word
    start : Start
        Coordinates and rates at the beginning of each segment, and the durations.
    name : OrbitName or CountedName, optional
        By default that of the first orbit with as many impacts.

    Raises
    ------
    InputError
        The rotor is compliant, heavy or has else what words do not know, or the start does not fit the word and the rotor, or the word its wall.
    """
    rotor = rotor_of(machine)
    _refuse_without_words(rotor)
    shape = len(word), len(rotor.system.nodes.rest)
    if start.nodes.shape != shape or start.durations.shape != shape[:1]:
        raise InputError("start", start.nodes.shape, f"nodes of shape {shape} and {shape[0]} durations")
    word.refuse_elsewhere(rotor.system)
    links = converged(rotor, word, start)
    if links is None or not lasts(word, links.start):
        return None
    return orbit_of_links(rotor, word, links, name)


def _refuse_without_words(rotor: Rotor) -> None:
    """Refuse a rotor of which segments are not known: those in compliant walls, and under forces of the fixed frame."""
    system = rotor.system
    if system.why_not_periodic is not None:
        raise InputError("machine", *system.why_not_periodic)
    if system.forced is not None or system.arrays["stiffness"].any():
        given = "weight" if system.forced is not None else "a compliant touchdown bearing"
        raise InputError(
            "machine", given, "rigid touchdown bearings without weight: other orbits are found by carom.find_orbits"
        )


def lasts(word: Word, solution: Start) -> bool:
    """Whether each segment of a solution lasts; a chatter that does not rebound at all takes no time."""
    return bool((solution.durations >= np.where(word.lands, 0.0, SHORTEST)).all())


def orbit_of_links(rotor: Rotor, word: Word, links: Links, name: OrbitName | CountedName | None = None) -> Orbit:
    """Orbit from converged equations, as short as it is and beginning at its fastest impact."""
    nodes, durations = links.start
    count = shortest(word, nodes)
    once = Word(word[:count])
    first = beginning(rotor, once, nodes[:count])
    kept, start = once.turned(first), Start(nodes[:count], durations[:count]).turned(first)
    return Orbit.from_links(rotor, kept, links_of(rotor, kept, start), name or CountedName(kept.impacts, 1))


def shortest(word: Word, nodes: np.ndarray) -> int:
    """Number of segments after which an orbit repeats."""
    for k in range(word.least, len(word), word.least):
        apart = np.abs(nodes - np.roll(nodes, -k, axis=0)).max()
        if len(word) % k == 0 and apart <= ALIKE * (1.0 + np.abs(nodes).max()):
            return k
    return len(word)


def beginning(rotor: Rotor, word: Word, nodes: np.ndarray) -> int:
    """Segment with which an orbit begins: that of the fastest arrival at a wall; without any, the first flight."""
    flights = np.flatnonzero(word.arrives).tolist()
    if not flights:
        return next((i for i, segment in enumerate(word) if segment.kind.flies), 0)
    positions, velocities = rotor.system.at_planes(rotor.system.nodes.amplitudes(nodes[flights]), word.planes[flights])
    return flights[int(np.argmax((positions.conj() * velocities).real))]


def same_orbit(first: Orbit | SimulatedOrbit, second: Orbit | SimulatedOrbit) -> bool:
    """Whether two orbits are the same, wherever they begin."""
    if isinstance(first, SimulatedOrbit) or isinstance(second, SimulatedOrbit):
        return (
            isinstance(first, SimulatedOrbit) and isinstance(second, SimulatedOrbit) and same_simulated(first, second)
        )
    turns = (first.start.turned(places).nodes for places in first.word.turns_to(second.word))
    return any(np.abs(nodes - second.nodes).max() <= 1e2 * ALIKE for nodes in turns)
