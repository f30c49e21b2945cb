"""Disturbances of the levitating rotor: kicks and shocks."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.disturbances.base_motion import BaseMotion
from carom.disturbances.coordinates import Coordinate, Starts, angle_coordinate, complex_of
from carom.disturbances.model import FASTEST, Disturbance
from carom.disturbances.response_spectra import BaseCourse
from carom.disturbances.single import Echo, Part, Single, angles_words
from carom.parameters.formats import format_angle, format_quantity
from carom.parameters.requirement import SHOCK_DURATION

if TYPE_CHECKING:
    from carom.models import Rotor, Subject
    from carom.motions.starts import State
    from carom.parameters import Scales

LONGEST_SHOCK = 1e4
"""Longest duration, in ``1/Ω``: every pulse is followed to its end, over at most some 1600 turns of the shaft."""
MOST_PULSES = 100
"""Most pulses of a series."""


@dataclass(frozen=True)
class VelocityKick(Disturbance):
    """A kick to the levitating rotor that changes its velocity at once.

    Attributes
    ----------
    fastest : float
        Largest change of velocity, in ``c_r Ω``.  Directions are angles in the co-rotating frame, as those of
        :func:`carom.kick`.

    See Also
    --------
    carom.disturbances.KickPlane : by components
    carom.kick : a single one
    carom.closed_forms.contact_free_kick : size up to which contact is impossible

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> print(f"{kicks.fastest:.4f}")
    0.7756
    """

    fastest: float = FASTEST
    kind: ClassVar[str] = "kick"
    noun: ClassVar[str] = "kicks"
    measured_in: ClassVar[dict[str, str]] = {"fastest": "velocity"}
    parts: ClassVar = (Part("speed", "SPEED", "velocity", optional=False), Part("direction", "ANGLE", "angle", 0.0))
    example: ClassVar = "'50 mm/s,30 deg'"

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Size and direction."""
        size = Coordinate("speed", "size of the kick", 0.0, self.fastest, "velocity", over_disc=True)
        return size, angle_coordinate("direction", "direction of the kick")

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """Levitation with the velocity changed."""
        speed, direction = values
        velocity = complex_of(speed * np.cos(direction), speed * np.sin(direction))
        return levitating_at(rotor, velocity, instant)

    def apply(self, machine: Subject, *values: float | str, instant: float | str = 0.0) -> tuple[Rotor, State]:
        """See :meth:`carom.disturbances.Disturbance.apply`."""
        from carom.models import rotor_of
        from carom.motions.starts import levitating

        rotor = rotor_of(machine)
        radius = rotor.system.rest_radius
        if radius > 1.0 and rotor.system.forced is None:  # with weight the kick itself says so
            words = f"needs levitation, but |U*| = {radius:.6g} is outside the wall"
            raise InputError("kick", radius, words)
        speed, direction, begun = self.whole(values, instant, rotor.scales)
        return rotor, levitating(rotor, cmath.rect(speed, direction), begun)

    def echo(self, rotor: Rotor, *values: float) -> Echo:
        """See :meth:`carom.disturbances.Disturbance.echo`."""
        speed, angle = values
        size = f"{format_quantity(speed, 'velocity', rotor.scales)} at {format_angle(angle)}"
        sizes = {"speed": (speed, "velocity"), "angle": (angle, "")}
        return Echo(self.kind, f"Kick: {size}; {angles_words(rotor.unbalance_phase)}", sizes)


@checked
def kick(speed: float | str, angle: float | str = 0.0, instant: float | str = 0.0) -> Single:
    """Velocity kick out of the contact-free equilibrium.

    Parameters
    ----------
    speed : float or str
        In ``c_r Ω``, or text with a unit, such as ``"50 mm/s"``.
    angle : float or str
        Its direction in the co-rotating frame, from its real axis: in rad, or text with a unit, such as ``"30 deg"``.
    instant : float or str
        Angle by which the shaft has turned when it comes, the same way: it matters under weight, with limits of the magnetic bearings,
        and where bearings are anisotropic.

    See Also
    --------
    carom.State : any start
    carom.disturbances.VelocityKick : kicks of all sizes and directions

    Examples
    --------
    >>> import carom as cm
    >>> cm.kick("50 mm/s", "30 deg").values
    ('50 mm/s', '30 deg')
    """
    return Single(VelocityKick(), (speed, angle), instant)


@dataclass(frozen=True)
class KickPlane(Disturbance):
    """The same kick, given by its outward and tangential parts as seen from the centre of the bearing.

    Attributes
    ----------
    fastest : float
        Largest change of velocity, in ``c_r Ω``: a disc in the plane of both parts.
    """

    fastest: float = FASTEST
    kind: ClassVar[str] = "kick-plane"
    noun: ClassVar[str] = "kicks"
    measured_in: ClassVar[dict[str, str]] = {"fastest": "velocity"}

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Radial and tangential part."""
        return (
            Coordinate("radial_speed", "kick outward", -self.fastest, self.fastest, "velocity"),
            Coordinate("tangential_speed", "kick in the sense of rotation", -self.fastest, self.fastest, "velocity"),
        )

    @property
    def size(self) -> Coordinate:
        """Size of the kick."""
        return VelocityKick(self.fastest).coordinates[0]

    def drawn(self, shares: np.ndarray) -> tuple[np.ndarray, ...]:
        """Both parts, uniform over the disc."""
        speed, direction = VelocityKick(self.fastest).drawn(shares)
        return speed * np.cos(direction), speed * np.sin(direction)

    def within(self, radial: np.ndarray, tangential: np.ndarray) -> np.ndarray:
        """Whether kicks are no larger than the largest, but for rounding."""
        return np.asarray(np.hypot(radial, tangential) <= self.fastest * (1.0 + 1e-12))

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """Levitation with the velocity changed; there is no start beyond the largest kick."""
        radial, tangential = values
        outward = outward_from(rotor)
        velocity = complex_of(
            outward.real * radial - outward.imag * tangential, outward.imag * radial + outward.real * tangential
        )
        kicked = levitating_at(rotor, velocity, instant)
        return kicked._replace(exists=kicked.exists & self.within(radial, tangential))


@dataclass(frozen=True)
class BaseShock(BaseMotion):
    """The housing and its bearings are accelerated by ``a(t) = â sin(πt/T)`` along a line for a time ``T``.

    The motion of the levitating rotor relative to the housing is followed exactly through the pulse, contacts included
    (:mod:`carom.disturbances.shocks`); the start is the state at its end, but for the speeds of a race and of the shaft, which then are
    those before the pulse (:meth:`apply` keeps them).  Directions are those of the acceleration in the fixed
    frame, measured from the real axis of the co-rotating frame at the instant when the pulse begins.

    Attributes
    ----------
    peak : float
        Largest peak acceleration ``â``, in ``c_r Ω²``.
    duration : float
        ``T``, in ``1/Ω``.
    pulses : int
        How many such pulses come one after another, all along one line in the fixed frame.
    pause : float
        Time from the end of a pulse to the beginning of the next, in ``1/Ω``.

    See Also
    --------
    carom.closed_forms.contact_free_shock : peak up to which contact is impossible
    carom.disturbances.VelocityKick, carom.disturbances.BladeLoss : other disturbances

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> shock = cm.BaseShock.of(machine, "10 g", "11 ms")
    >>> [coordinate.name for coordinate in shock.coordinates]
    ['peak_acceleration', 'direction']
    """

    peak: float
    duration: float
    pulses: int = 1
    pause: float = 0.0
    kind: ClassVar[str] = "shock"
    noun: ClassVar[str] = "shocks"
    measured_in: ClassVar[dict[str, str]] = {"peak": "acceleration", "duration": "time", "pause": "time"}
    parts: ClassVar = (
        Part("peak", "PEAK", "acceleration", optional=False),
        Part("duration", "DURATION", "time", SHOCK_DURATION),
        Part("direction", "ANGLE", "angle", 0.0),
        Part("pulses", "PULSES", "count"),
        Part("pause", "PAUSE", "time"),
    )
    example: ClassVar = "'5 g,11 ms,30 deg'"

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.duration > LONGEST_SHOCK:
            raise InputError("duration", self.duration, f"at most {LONGEST_SHOCK:g}, in 1/Omega: a shock is short")
        if not 1 <= self.pulses <= MOST_PULSES or int(self.pulses) != self.pulses:
            raise InputError("pulses", self.pulses, f"a whole number from 1 to {MOST_PULSES}")
        if not 0.0 <= self.pause <= LONGEST_SHOCK:
            raise InputError("pause", self.pause, f"from 0 to {LONGEST_SHOCK:g}, in 1/Omega")

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Peak acceleration and direction."""
        peak = Coordinate("peak_acceleration", "peak acceleration of the base", 0.0, self.peak, "acceleration", True)
        return peak, angle_coordinate("direction", "direction of the shock")

    def course(self, size: float, angle: float = 0.0, begun: float = 0.0) -> BaseCourse:
        """See ``BaseMotion.course``; the angle counts from the axes that turn with the shaft, at its beginning."""
        durations = np.array([self.duration, self.pause] * self.pulses)[:-1]
        shakes = np.arange(len(durations)) % 2 == 0
        turns = shakes * math.pi / self.duration
        course = BaseCourse(durations, 0j * turns, cmath.rect(size, angle + begun) * turns, turns)
        return BaseCourse(*(part[durations > 0.0] for part in course))

    def echo(self, rotor: Rotor, *values: float) -> Echo:
        """See :meth:`carom.disturbances.Disturbance.echo`."""
        (peak, angle), scales = values, rotor.scales
        size = f"{format_quantity(peak, 'acceleration', scales)} for {format_quantity(self.duration, 'time', scales)} at {format_angle(angle)}"
        counted = angles_words(rotor.unbalance_phase, " at the instant the shock begins")
        sizes = {"peak": (peak, "acceleration"), "duration": (self.duration, "time"), "angle": (angle, "")}
        if self.pulses > 1:
            size += f", {self.pulses} pulses with pauses of {format_quantity(self.pause, 'time', scales)}"
            sizes |= {"pulses": (self.pulses, ""), "pause": (self.pause, "time")}
        return Echo(self.kind, f"Base shock: half-sine, {size}; {counted}; times count from its start", sizes)

    def up_to_words(self, before: float | None, scales: Scales | None) -> str:
        """See :meth:`carom.disturbances.Disturbance.up_to_words`."""
        several = f", {self.pulses} pulses" if self.pulses > 1 else ""
        return f"{super().up_to_words(before, scales)} for {format_quantity(self.duration, 'time', scales)}{several}"

    def release(self, machine: Subject, direction: float = 0.0, instant: float = 0.0) -> State:
        """Return the state at the end of one shock of the largest peak, for :func:`carom.simulate`.

        Contacts during the pulse are part of it.

        Parameters
        ----------
        machine : Machine, Case, Parameters or model
        direction : float
            Of the acceleration, rad.

        Raises
        ------
        InputError
            The rotor cannot levitate inside the wall, or its motion ends during the pulse, as where it grazes the wall undecidedly.
        """
        return Disturbance.apply(self, machine, direction, instant=instant)[1]


def outward_from(machine: Subject) -> complex:
    """Direction from the bearing centre to the levitating rotor; that of the unbalance if the rotor is centred."""
    from carom.models import rotor_of

    rotor = rotor_of(machine)
    rest = complex(rotor.system.arrays.offsets[0])
    return rest / abs(rest) if rest else cmath.rect(1.0, rotor.unbalance_phase)


def levitating_at(rotor: Rotor, pushes: np.ndarray | float, instants: np.ndarray | float) -> Starts:
    """Starts of the levitating rotor at instants of the turn, with the velocity of the rotor as a whole changed by pushes."""
    velocities, begins = np.broadcast_arrays(pushes, np.asarray(instants, float))
    positions, velocities = rotor.system.kicked(velocities, begins)
    if len(rotor.system.rest) == 1:
        positions, velocities = positions[..., 0], velocities[..., 0]
    none = np.zeros(begins.shape, bool)
    return Starts(positions, velocities, none | (rotor.system.rest_radius < 1.0), none, none, begins.copy())
