"""Disturbances as an engineer names them, and the starts they give a rotor.

A *model* says what happens to the rotor and with which coordinates it varies (size and direction of a kick, say).  A
*plan* says which of these are tried: a :class:`Grid` of cells, each represented by its middle, or a seeded
:class:`Sample` with every coordinate even over its range.  Both give :class:`Starts`: states in the co-rotating frame,
from which the motion is free.

=======================  =====================================================================================
:class:`VelocityKick`    a blow: the velocity changes at once, by a size and in a direction
:class:`KickPlane`       the same by radial and tangential parts, seen from the bearing centre
:class:`BaseShock`       the housing is accelerated by a half-sine pulse (peak, duration, direction)
:class:`UnbalanceStep`   the unbalance becomes what it is now, from another size and phase
:class:`ContactRelease`  levitation is switched on with the rotor on the touchdown bearing
:class:`StateSlice`      any position, at a given velocity
:class:`AnyState`        any position and any velocity
=======================  =====================================================================================

Numbers are dimensionless, as everywhere behind the door: lengths in clearances, times in ``1/Ω``.  The constructors
``in_si`` take SI numbers and the scales of a machine.
"""

from __future__ import annotations

import cmath
import dataclasses
import math
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple, Self, TypeAlias

import numpy as np

from carom.outcome import InputError
from carom.parameters import Scales
from carom.rotors import Rotor
from carom.shocks import states_after_shocks

__all__ = [
    "GRAVITY",
    "AnyState",
    "BaseShock",
    "ContactRelease",
    "Coordinate",
    "Disturbance",
    "Grid",
    "KickPlane",
    "Plan",
    "Sample",
    "Starts",
    "StateSlice",
    "UnbalanceStep",
    "VelocityKick",
    "disturbances",
]

FASTEST = 2.0
"""Default largest speed in ``c_r Ω``: twice that of a whirl that fills the clearance."""
GRAVITY = 9.80665
"""Standard acceleration of free fall, m/s²."""
TURN = 2.0 * math.pi

Release = Literal["fixed", "rotating", "rolling"]


@dataclass(frozen=True)
class Coordinate:
    """One coordinate of a disturbance and its range.

    Attributes
    ----------
    name, words : str
    low, high : float
        Dimensionless, or rad.
    scale : str
        Property of :class:`~carom.parameters.Scales` that turns it into SI; empty for angles.
    unit : str
        SI unit.
    over_disc : bool
        A radius: even over the area of a disc, not over the radius.
    periodic : bool
        An angle all round.
    """

    name: str
    words: str
    low: float
    high: float
    scale: str = ""
    unit: str = "rad"
    over_disc: bool = False
    periodic: bool = False

    def at(self, shares: np.ndarray) -> np.ndarray:
        """Values that have these shares of the range, 0 to 1, below them."""
        return self.high * np.sqrt(shares) if self.over_disc else self.low + (self.high - self.low) * shares

    def edges(self, cells: int) -> np.ndarray:
        """Ends of cells of equal weight, shape (cells + 1,)."""
        return self.at(np.arange(cells + 1) / cells)

    def middles(self, cells: int) -> np.ndarray:
        """Middles, by weight, of cells of equal weight, shape (cells,)."""
        return self.at((np.arange(cells) + 0.5) / cells)

    def si(self, scales: Scales) -> float:
        """How many SI units one unit of it is."""
        return float(getattr(scales, self.scale)) if self.scale else 1.0


def _angle(name: str, words: str) -> Coordinate:
    return Coordinate(name, words, 0.0, TURN, periodic=True)


def _speed(name: str, words: str, low: float, high: float, over_disc: bool = False) -> Coordinate:
    return Coordinate(name, words, low, high, "velocity", "m/s", over_disc)


def _length(name: str, words: str, low: float, high: float, over_disc: bool = False) -> Coordinate:
    return Coordinate(name, words, low, high, "length", "m", over_disc)


class Starts(NamedTuple):
    """Starts of free motion in the co-rotating frame; arrays of one shape.

    Attributes
    ----------
    positions, velocities : ndarray of complex
    exists : ndarray of bool
        Whether the disturbance is possible: the start lies inside the wall, the rotor could levitate before it.
    undecided : ndarray of bool
        The disturbance itself grazes the wall, and double precision cannot decide what follows.
    """

    positions: np.ndarray
    velocities: np.ndarray
    exists: np.ndarray
    undecided: np.ndarray

    @classmethod
    def of(cls, positions: np.ndarray | complex, velocities: np.ndarray | complex, exists: np.ndarray | bool) -> Starts:
        """Give all arrays one shape."""
        places, speeds, there = np.broadcast_arrays(np.asarray(positions, complex), velocities, exists)
        return cls(places, speeds.astype(complex), there, np.zeros(places.shape, bool))


@dataclass(frozen=True)
class Disturbance:
    """What happens to a rotor; see :mod:`carom.disturbances` for the models."""

    kind: ClassVar[str] = ""
    measured_in: ClassVar[dict[str, str]] = {}

    def __post_init__(self) -> None:
        for name, scale in self.measured_in.items():
            value = getattr(self, name)
            if not (np.isfinite(value) and abs(value) > 0.0):
                raise InputError(name, value, f"a finite number other than 0, in the unit of {scale} of the equations")
            if name in _SIZES and value < 0.0:
                raise InputError(name, value, "a size, above 0")

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """What it varies with."""
        raise NotImplementedError

    def starts(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """Starts of free motion.

        Parameters
        ----------
        rotor : Rotor
        *values : ndarray
            One array for each coordinate; they are broadcast against each other.
        """
        raise NotImplementedError

    def rescaled(self, before: Scales | None, after: Scales | None) -> Self:
        """Return the same disturbance in SI units for a machine with other scales."""
        if before is None or after is None or before == after:
            return self
        changes = {
            name: getattr(self, name) * (getattr(before, scale) / getattr(after, scale))
            for name, scale in self.measured_in.items()
        }
        return dataclasses.replace(self, **changes)

    def describe(self) -> dict[str, object]:
        """Its kind and its numbers."""
        return {"kind": self.kind, **dataclasses.asdict(self)}


_SIZES = ("fastest", "peak", "duration", "largest")


@dataclass(frozen=True)
class VelocityKick(Disturbance):
    """A blow to the levitating rotor that changes its velocity at once.

    Attributes
    ----------
    fastest : float
        Largest change of velocity, in ``c_r Ω``.  Directions are angles in the co-rotating frame, as those of
        :func:`~carom.trajectories.kick`.
    """

    fastest: float = FASTEST
    kind: ClassVar[str] = "kick"
    measured_in: ClassVar[dict[str, str]] = {"fastest": "velocity"}

    @classmethod
    def in_si(cls, scales: Scales, metres_per_second: float) -> VelocityKick:
        """With the largest change of velocity in m/s."""
        return cls(metres_per_second / scales.velocity)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Size and direction."""
        return _speed("speed", "size of the kick", 0.0, self.fastest), _angle("direction", "direction of the kick")

    def starts(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """Levitation with the velocity changed."""
        speed, direction = values
        velocity = _complex(speed * np.cos(direction), speed * np.sin(direction))
        return Starts.of(rotor.equilibrium, velocity, _levitates(rotor))


@dataclass(frozen=True)
class KickPlane(Disturbance):
    """The same blow, by its parts outward and along the whirl, as seen from the centre of the bearing.

    Attributes
    ----------
    fastest : float
        Largest part, in ``c_r Ω``.
    """

    fastest: float = FASTEST
    kind: ClassVar[str] = "kick-plane"
    measured_in: ClassVar[dict[str, str]] = {"fastest": "velocity"}

    @classmethod
    def in_si(cls, scales: Scales, metres_per_second: float) -> KickPlane:
        """With the largest part in m/s."""
        return cls(metres_per_second / scales.velocity)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Radial and tangential part."""
        return (
            _speed("radial_speed", "kick outward", -self.fastest, self.fastest),
            _speed("tangential_speed", "kick in the sense of rotation", -self.fastest, self.fastest),
        )

    def starts(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """Levitation with the velocity changed."""
        radial, tangential = values
        outward = outward_from(rotor)
        velocity = _complex(
            outward.real * radial - outward.imag * tangential, outward.imag * radial + outward.real * tangential
        )
        return Starts.of(rotor.equilibrium, velocity, _levitates(rotor))


@dataclass(frozen=True)
class BaseShock(Disturbance):
    """The housing, bearings and all, is accelerated by ``a(t) = â sin(πt/T)`` along a line for a time ``T``.

    The motion of the levitating rotor relative to the housing is followed exactly through the pulse, contacts included
    (:mod:`carom.shocks`); the start is the state at its end.  Directions are those of the acceleration in the fixed
    frame, measured from the real axis of the co-rotating frame at the instant when the pulse begins.

    Attributes
    ----------
    peak : float
        Largest peak acceleration ``â``, in ``c_r Ω²``.
    duration : float
        ``T``, in ``1/Ω``.
    """

    peak: float
    duration: float
    kind: ClassVar[str] = "shock"
    measured_in: ClassVar[dict[str, str]] = {"peak": "acceleration", "duration": "time"}

    @classmethod
    def in_si(cls, scales: Scales, g: float, milliseconds: float) -> BaseShock:
        """With the largest peak in standard gravities and the duration in ms."""
        return cls(g * GRAVITY / scales.acceleration, 1e-3 * milliseconds / scales.time)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Peak acceleration and direction."""
        peak = Coordinate("peak_acceleration", "peak acceleration of the base", 0.0, self.peak, "acceleration", "m/s^2")
        return peak, _angle("direction", "direction of the shock")

    @property
    def velocity_change(self) -> float:
        """Of the housing through the largest pulse, ``2âT/π``, in ``c_r Ω``."""
        return 2.0 * self.peak * self.duration / math.pi

    def starts(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """State at the end of the pulse."""
        peaks, directions = np.broadcast_arrays(*values)
        if not _levitates(rotor):
            return Starts.of(np.zeros(peaks.shape, complex), 0j, False)
        positions, velocities, undecided = states_after_shocks(rotor, peaks, self.duration, directions)
        return Starts(positions, velocities, np.ones(peaks.shape, bool), undecided)


@dataclass(frozen=True)
class UnbalanceStep(Disturbance):
    """The unbalance jumps to that of the machine: a lost blade, a shifted sleeve.

    The rotor whirled without contact with an eccentricity of another size and phase; its position and velocity are then
    those of the start in the machine as it is.

    Attributes
    ----------
    largest : float
        Largest eccentricity before, in clearances.  Phases are relative to the unbalance after the step.
    """

    largest: float
    kind: ClassVar[str] = "unbalance"
    measured_in: ClassVar[dict[str, str]] = {"largest": "length"}

    @classmethod
    def in_si(cls, scales: Scales, metres: float) -> UnbalanceStep:
        """With the largest eccentricity before in m."""
        return cls(metres / scales.length)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Eccentricity and phase before the step."""
        return (
            _length("eccentricity_before", "eccentricity before the step", 0.0, self.largest),
            _angle("phase_before", "phase of the unbalance before the step, relative to that after it"),
        )

    def starts(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """Levitation with the old unbalance."""
        eccentricity, phase = values
        numbers = rotor.parameters
        response = cmath.rect(1.0, numbers.phi) / complex(numbers.omega**2 - 1.0, numbers.gamma)
        cosine, sine = eccentricity * np.cos(phase), eccentricity * np.sin(phase)
        positions = _complex(
            response.real * cosine - response.imag * sine, response.imag * cosine + response.real * sine
        )
        return _inside(positions, np.zeros(positions.shape, complex))


@dataclass(frozen=True)
class ContactRelease(Disturbance):
    """Levitation is switched on with the rotor on the wall, anywhere round it.

    Attributes
    ----------
    motion : {"fixed", "rotating", "rolling"}
        The rotor centre is at rest, whirls in step with the shaft, or rolls round the bearing without slip.
    """

    motion: Release = "fixed"
    kind: ClassVar[str] = "release"

    def __post_init__(self) -> None:
        if self.motion not in ("fixed", "rotating", "rolling"):
            raise InputError("motion", self.motion, 'one of "fixed", "rotating", "rolling"')

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Angle of the place on the wall."""
        return (_angle("angle", "place on the wall"),)

    def starts(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """On the wall, moving along it."""
        (angle,) = values
        cosine, sine = np.cos(angle), np.sin(angle)
        whirl = {"fixed": 0.0, "rotating": 1.0, "rolling": -rotor.parameters.radius_ratio}[self.motion]
        return Starts.of(_complex(cosine, sine), _complex(-(whirl - 1.0) * sine, (whirl - 1.0) * cosine), True)


@dataclass(frozen=True)
class StateSlice(Disturbance):
    """Any position inside the wall, at one velocity in the co-rotating frame.

    Attributes
    ----------
    velocity : complex
        ``U̇`` in ``c_r Ω``.
    """

    velocity: complex = 0j
    kind: ClassVar[str] = "slice"

    def __post_init__(self) -> None:
        if not cmath.isfinite(self.velocity):
            raise InputError("velocity", self.velocity, "finite numbers")

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Both components of the position."""
        return _length("x", "position Re U", -1.0, 1.0), _length("y", "position Im U", -1.0, 1.0)

    def rescaled(self, before: Scales | None, after: Scales | None) -> StateSlice:
        """Return the same velocity in SI units for a machine with other scales."""
        if before is None or after is None:
            return self
        return StateSlice(self.velocity * (before.velocity / after.velocity))

    def starts(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """All positions inside the wall."""
        x, y = np.broadcast_arrays(*values)
        positions = _complex(x, y)
        return _inside(positions, np.full(positions.shape, self.velocity))

    def describe(self) -> dict[str, object]:
        """Its kind and its numbers."""
        return {"kind": self.kind, "velocity": [self.velocity.real, self.velocity.imag]}


@dataclass(frozen=True)
class AnyState(Disturbance):
    """Any position inside the wall and any velocity up to a speed in the co-rotating frame, both even over their discs.

    Attributes
    ----------
    fastest : float
        In ``c_r Ω``.
    """

    fastest: float = FASTEST
    kind: ClassVar[str] = "state"
    measured_in: ClassVar[dict[str, str]] = {"fastest": "velocity"}

    @classmethod
    def in_si(cls, scales: Scales, metres_per_second: float) -> AnyState:
        """With the largest speed in m/s."""
        return cls(metres_per_second / scales.velocity)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Position and velocity, both by size and angle."""
        return (
            _length("radius", "distance from the centre of the bearing", 0.0, 1.0, over_disc=True),
            _angle("angle", "angle of the position"),
            _speed("speed", "speed in the co-rotating frame", 0.0, self.fastest, over_disc=True),
            _angle("direction", "direction of the velocity"),
        )

    def starts(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """All of them."""
        radius, angle, speed, direction = np.broadcast_arrays(*values)
        return Starts.of(
            _complex(radius * np.cos(angle), radius * np.sin(angle)),
            _complex(speed * np.cos(direction), speed * np.sin(direction)),
            True,
        )


@dataclass(frozen=True)
class Grid:
    """Every coordinate in equal cells, each represented by its middle.

    Attributes
    ----------
    model : Disturbance
    shape : tuple of int
        Cells along each coordinate.
    """

    model: Disturbance
    shape: tuple[int, ...]

    def __post_init__(self) -> None:
        names = [coordinate.name for coordinate in self.model.coordinates]
        if len(self.shape) != len(names) or any(cells < 1 for cells in self.shape):
            given = "x".join(map(str, self.shape)) or None
            raise InputError("grid", given, f"numbers of cells, one for each of {', '.join(names)}")

    @property
    def count(self) -> int:
        """Number of cells."""
        return math.prod(self.shape)

    def values(self) -> tuple[np.ndarray, ...]:
        """Middles of the cells along each coordinate, one-dimensional."""
        return tuple(
            coordinate.middles(cells) for coordinate, cells in zip(self.model.coordinates, self.shape, strict=True)
        )

    def starts(self, rotor: Rotor) -> Starts:
        """Starts, arrays of the shape of the grid."""
        return self.model.starts(rotor, *np.meshgrid(*self.values(), indexing="ij"))

    def rescaled(self, before: Scales | None, after: Scales | None) -> Grid:
        """Return the same grid in SI units for a machine with other scales."""
        return Grid(self.model.rescaled(before, after), self.shape)


@dataclass(frozen=True)
class Sample:
    """A seeded sample, even over every coordinate; a longer one of the same seed begins with the shorter.

    Attributes
    ----------
    model : Disturbance
    count : int
    seed : int
    """

    model: Disturbance
    count: int
    seed: int = 0

    def __post_init__(self) -> None:
        if self.count < 1:
            raise InputError("starts", self.count, "a whole number of at least 1")
        if self.seed < 0:
            raise InputError("seed", self.seed, "a whole number of at least 0")

    def values(self) -> tuple[np.ndarray, ...]:
        """Value of each coordinate at each start, shape (count,)."""
        axes = self.model.coordinates
        shares = np.random.default_rng(self.seed).random((self.count, len(axes)))
        return tuple(coordinate.at(share) for coordinate, share in zip(axes, shares.T, strict=True))

    def starts(self, rotor: Rotor) -> Starts:
        """Starts, arrays of shape (count,)."""
        return self.model.starts(rotor, *self.values())

    def rescaled(self, before: Scales | None, after: Scales | None) -> Sample:
        """Return the same sample in SI units for a machine with other scales."""
        return Sample(self.model.rescaled(before, after), self.count, self.seed)


Plan: TypeAlias = Grid | Sample


def disturbances(radial: int = 100, tangential: int = 100, fastest: float = FASTEST) -> Grid:
    """Grid of velocity kicks out of levitation, by their radial and tangential parts.

    Parameters
    ----------
    radial, tangential : int
        Numbers of cells.
    fastest : float
        Largest part, in ``c_r Ω``.
    """
    return Grid(KickPlane(fastest), (radial, tangential))


def outward_from(rotor: Rotor) -> complex:
    """Direction from the centre of the bearing to the levitating rotor; the heavy side where it is in the centre."""
    rest = rotor.equilibrium
    return rest / abs(rest) if rest else cmath.rect(1.0, rotor.parameters.phi)


def _levitates(rotor: Rotor) -> bool:
    return abs(rotor.equilibrium) < 1.0


def _inside(positions: np.ndarray, velocities: np.ndarray) -> Starts:
    """Starts inside the wall; those outside do not exist."""
    inside = positions.real**2 + positions.imag**2 <= 1.0
    return Starts.of(np.where(inside, positions, 0.0), velocities, inside)


def _complex(real: np.ndarray, imaginary: np.ndarray) -> np.ndarray:
    """Complex numbers from their parts.

    Products are taken of real numbers only: the last bit of complex ones depends on their place in the array.
    """
    values = np.empty(np.broadcast(real, imaginary).shape, complex)
    values.real, values.imag = real, imaginary
    return values
