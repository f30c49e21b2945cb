"""Load on the touchdown bearing: impacts and lasting contacts of a motion, with impulses, forces and works."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import Field, dataclass, field
from inspect import cleandoc
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from carom.base.outcome import Phase
from carom.base.results import Result, flags
from carom.core.friction import rebound
from carom.parameters import UNITS

if TYPE_CHECKING:
    import xarray

    from carom.models import System
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales

UNLIKE = 1e-9
"""Difference of radial speeds, relative to one plus the speed, above which an impact was not by Newton's restitution; impulses
below that are too small to tell."""


AT_WALL = 1e-9
"""Distance from its wall up to which a plane may have been struck together with another (:data:`carom.core.joint.ONE_INSTANT`), with
a margin for the rounding of states: of a plane that was not struck the equations give none but a rounding error."""
NONE, ROUNDING = 1e-12, 1e-14
"""Impulse, relative to the largest in the event and to the terms of velocities, below which a plane at its wall was not struck."""

NUMBERED = "touchdown bearing, counted from 1"
"""What a table says of the column that names the bearing: people count from 1, indices of arrays (``plane``) count from 0."""

PRESSING = (Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP, Phase.ROLLING)
"""Phases in which a wall presses on the rotor."""


@dataclass(frozen=True)
class LastingContact:
    """A stretch of contact without bounces.

    Attributes
    ----------
    phase : Phase
        ``FORWARD_SLIP``, ``BACKWARD_SLIP`` or ``ROLLING``.
    start, end : float
        Times in ``1/Ω``.
    """

    phase: Phase
    start: float
    end: float

    @property
    def kind(self) -> str:
        """``"slide"`` or ``"roll"``."""
        return "roll" if self.phase is Phase.ROLLING else "slide"


def column(quantity: str, words: str) -> Any:
    """Field of a table: a property of :class:`~carom.parameters.Scales`, or a unit where it needs none; and words."""
    return field(metadata={"quantity": quantity, "words": words})


def in_units(
    dimension: str, values: np.ndarray, quantity: str, words: str, scales: Scales | None
) -> tuple[str, np.ndarray, dict[str, str]]:
    """Variable of a dataset with its unit and words; in SI if the machine is known."""
    unit, si = _units(quantity)
    if scales and unit != si:
        values, unit = values * getattr(scales, quantity), si
    return dimension, values, {"units": unit, "long_name": words}


class Table(Result):
    """Table of columns with units, all along one dimension.

    A column is a field made by :func:`column`, which docstring and dataset are made from.  Arrays are in
    the units of the equations; a table knows the scales of its machine, if these are known.
    """

    dimension: ClassVar[str]
    columns: ClassVar[dict[str, Mapping[str, str]]] = {}
    scales: Scales | None

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        fields = {name: value.metadata for name, value in vars(cls).items() if isinstance(value, Field)}
        cls.columns = {name: metadata for name, metadata in fields.items() if metadata}
        entries = []
        for name, one in cls.columns.items():
            unit = "" if one["quantity"] == "1" else f", in ``{_units(one['quantity'])[0]}``"
            entries.append(f"{name} : ndarray\n    {one['words'][0].upper()}{one['words'][1:]}{unit}.")
        cls.__doc__ = "\n".join([cleandoc(cls.__doc__ or ""), "", "Attributes", "----------", *entries])

    def __len__(self) -> int:
        return len(getattr(self, next(iter(self.columns))))

    def kind_of(self, name: str) -> str:
        """What the metadata say."""
        quantity = self.columns[name]["quantity"] if name in self.columns else ""
        return "angle" if quantity == "rad" else quantity if quantity in UNITS else ""

    def to_dataset(self) -> xarray.Dataset:
        """Table with units and long names as attributes; in SI if the machine is known."""
        import xarray

        columns = self.columns.items()
        dataset = xarray.Dataset(
            {name: in_units(self.dimension, getattr(self, name), **one, scales=self.scales) for name, one in columns}
        )
        if "phase" in dataset:
            del dataset["phase"].attrs["units"]
            dataset["phase"].attrs |= phase_flags(Phase)
        return dataset


def _units(quantity: str) -> tuple[str, str]:
    """Unit of the equations and SI unit; the same for a column without scale."""
    return UNITS.get(quantity, (quantity, quantity))


@dataclass(frozen=True, eq=False, repr=False)
class ContactLog(Table):
    """Impacts of a motion, one entry per impact, in chronological order; all arrays have shape (n,).

    Of a plane struck alone, the normal impulse is ``m_p (1 + d) ṙ`` with the effective mass ``m_p = 1/(W M⁻¹ Wᴴ)`` of the plane, which
    is the whole mass for the planar rotor.  Of planes struck in one instant it is that of the joint solution
    (:mod:`carom.core.joint`), and each plane has an entry.  The slip velocity of the contact point is ``v = s + 1 + θ̇``.  The work on the contact point
    follows from the mean of the velocities before and after; that of the drive is the kinetic energy gained without it, which a shaft whose
    speed changes gives from its own.
    """

    time: np.ndarray = column("time", "time of impact")
    touchdown_bearing: np.ndarray = column("1", NUMBERED)
    angle: np.ndarray = column("rad", "angle of impact in the co-rotating frame")
    radial_speed: np.ndarray = column("velocity", "radial speed before impact")
    angular_speed: np.ndarray = column("speed", "angular speed before impact, co-rotating frame")
    radial_speed_after: np.ndarray = column("velocity", "radial speed after impact")
    angular_speed_after: np.ndarray = column("speed", "angular speed after impact, co-rotating frame")
    normal_impulse: np.ndarray = column("impulse", "normal impulse of the bearing on the rotor, inward")
    tangential_impulse: np.ndarray = column("impulse", "friction impulse on the rotor, along growing angle")
    slip_before: np.ndarray = column("velocity", "slip velocity before impact")
    slip_after: np.ndarray = column("velocity", "slip velocity after impact")
    sticks: np.ndarray = column("1", "whether friction stopped the slip")
    by_poisson: np.ndarray = column("1", "whether Poisson's restitution took the place of Newton's")
    contact_work: np.ndarray = column("energy", "work on the contact point, never positive in the sum over the planes")
    drive_work: np.ndarray = column("energy", "work of the shaft through friction")
    scales: Scales | None = None

    dimension: ClassVar[str] = "impact"

    @classmethod
    def of(cls, motion: Trajectory, blows: Blows) -> ContactLog:
        """Log of impacts of a motion from their impulses."""
        before, after = motion.arrivals[blows.events], motion.segment_amplitudes[1:][blows.events]
        system, planes = motion.rotor.system, blows.planes
        arrays = system.arrays
        angle, radial, angular = polar(*system.at_planes(before, planes))
        _, radial_after, angular_after = polar(*system.at_planes(after, planes))
        spin, spin_after = (shaft_speed(system, each) for each in (before, after))
        surface_speed, mass = arrays.surface_speed[planes], arrays.masses[planes]
        radius = surface_speed - 1.0
        normal, tangential = -mass * blows.impulses.real, mass * blows.impulses.imag
        slip, slip_after = np.zeros((2, len(planes)))
        for plane in np.unique(planes).tolist():
            here = planes == plane
            slip[here], slip_after[here] = (slip_velocity(system, plane, each[here]) for each in (before, after))
        normal_work = -0.5 * normal * (radial + radial_after)
        newton = np.zeros(len(planes))
        for plane, contact in enumerate(system.contacts):
            newton[planes == plane] = rebound(np.maximum(radial[planes == plane], 0.0), contact.wall)
        unlike = np.abs(radial_after + newton) > UNLIKE * (1.0 + radial)
        return cls(
            time=motion.segment_starts[1:][blows.events],
            touchdown_bearing=planes + 1,
            angle=angle,
            radial_speed=radial,
            angular_speed=angular,
            radial_speed_after=radial_after,
            angular_speed_after=angular_after,
            normal_impulse=normal,
            tangential_impulse=tangential,
            slip_before=slip,
            slip_after=slip_after,
            sticks=arrays.friction[planes] * normal >= np.abs(mass * slip_after - tangential),
            by_poisson=np.isin(blows.events, blows.events[unlike & (-blows.impulses.real > UNLIKE)]),
            contact_work=normal_work + 0.5 * tangential * (slip + slip_after),
            drive_work=-radius * (0.5 * (spin + spin_after)) * tangential,
            scales=motion.scales,
        )


@dataclass(frozen=True, eq=False, repr=False)
class ContactHistory(Table):
    """Course of a motion at its plane, with the forces and the slip of lasting contact, at chosen times; all arrays have shape (n,).

    In flight, and where a plane has parted from its wall, forces, slip and powers are zero.  Phases are those of
    :class:`~carom.base.outcome.Phase`.  The slip velocity of the contact point is ``v = s + r(1 + θ̇)`` at the radius ``r``, which is one on a
    rigid wall, less the speed of the race's surface if that turns; the power of friction is ``F v`` and that of the drive ``−F s``.  In a compliant
    wall the gap is negative: the depth.
    """

    time: np.ndarray = column("time", "time")
    phase: np.ndarray = column("1", "kind of motion")
    angle: np.ndarray = column("rad", "angle in the co-rotating frame")
    gap: np.ndarray = column("length", "distance from the wall")
    normal_force: np.ndarray = column("force", "normal force of the bearing on the rotor, inward")
    friction_force: np.ndarray = column("force", "friction force of the bearing on the rotor, along growing angle")
    slip: np.ndarray = column("velocity", "slip velocity")
    friction_power: np.ndarray = column("power", "power of friction on the contact point, never positive")
    drive_power: np.ndarray = column("power", "power of the shaft's drive through friction")
    x: np.ndarray = column("length", "position along x, co-rotating frame")
    y: np.ndarray = column("length", "position along y, co-rotating frame")
    velocity_x: np.ndarray = column("velocity", "velocity along x, co-rotating frame")
    velocity_y: np.ndarray = column("velocity", "velocity along y, co-rotating frame")
    scales: Scales | None = None

    dimension: ClassVar[str] = "time"

    @classmethod
    def of(cls, motion: Trajectory, times: np.ndarray) -> ContactHistory:
        """History of a motion at its plane."""
        system, plane = motion.rotor.system, motion.plane
        amplitudes, every = motion.amplitudes_at(times)
        phases, (position, velocity) = every[..., plane], system.at_plane(amplitudes, plane)
        normal, friction = motion.forces_of(amplitudes, every, times)
        slip = np.where(presses(phases), slip_velocity(system, plane, amplitudes), 0.0)
        return cls(
            time=times,
            phase=phases,
            angle=np.angle(position),
            gap=1.0 - np.abs(position),
            normal_force=normal,
            friction_force=friction,
            slip=slip,
            friction_power=friction * slip,
            drive_power=(1.0 - float(system.arrays.surface_speed[plane])) * shaft_speed(system, amplitudes) * friction,
            x=position.real,
            y=position.imag,
            velocity_x=velocity.real,
            velocity_y=velocity.imag,
            scales=motion.scales,
        )


def presses(phases: np.ndarray) -> np.ndarray:
    """Whether a wall presses on the rotor in each phase."""
    return np.isin(phases, PRESSING)


def yields(system: System, plane: int) -> bool:
    """Whether the wall at a plane is compliant."""
    return system.contacts[plane].wall.stiffness > 0.0


def slip_velocity(system: System, plane: int, amplitudes: np.ndarray) -> np.ndarray:
    """Slip velocity (...) of the contact point at a plane in amplitudes (..., N), ``v = s + r(1 + θ̇) − q``.

    On a rigid wall ``r`` is one.  The surface of a race that turns has the speed ``q``.  A shaft whose speed changes has ``sσ`` in
    place of ``s``.
    """
    surface_speed: Any = system.contacts[plane].wall.surface_speed
    if system.shaft is not None:
        surface_speed += (surface_speed - 1.0) * (shaft_speed(system, amplitudes) - 1.0)
    position, velocity = system.at_plane(amplitudes, plane)
    along: np.ndarray = (position.conj() * velocity).imag
    if yields(system, plane):
        radius = np.abs(position)
        along = (radius - 1.0) + along / radius
    slip: np.ndarray = surface_speed + along - race_speed(system, plane, amplitudes)
    return slip


def shaft_speed(system: System, amplitudes: np.ndarray) -> np.ndarray:
    """Speed (...) of the shaft in amplitudes (..., N), in ``Ω``; one unless it changes."""
    if system.shaft is None:
        return np.ones(amplitudes.shape[:-1])
    return amplitudes[..., int(system.arrays.shaft[0]) + 1].real


def shaft_lead(system: System, amplitudes: np.ndarray) -> np.ndarray:
    """Angle (...) in rad by which the shaft is ahead of the frame in amplitudes (..., N); zero unless its speed changes."""
    if system.shaft is None:
        return np.zeros(amplitudes.shape[:-1])
    lead: np.ndarray = np.angle(amplitudes[..., int(system.arrays.shaft[0])])
    return lead


def race_speed(system: System, plane: int, amplitudes: np.ndarray) -> np.ndarray:
    """Speed (...) of the surface of the race at a plane in amplitudes (..., N), in the fixed frame; zero of one that does not turn."""
    mode = int(system.arrays.race[plane])
    return amplitudes[..., mode].real if mode >= 0 else np.zeros(amplitudes.shape[:-1])


def phase_flags(phases: Iterable[Phase]) -> dict[str, Any]:
    """Attributes that give the meaning of phase numbers, by the CF conventions."""
    kinds = list(phases)
    return flags(np.array(kinds, np.int8), (phase.label for phase in kinds))


def polar(position: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, radial and angular speed of states on the wall."""
    local = position.conj() * velocity / np.abs(position)
    return np.angle(position), local.real, local.imag / np.abs(position)


class Blows(NamedTuple):
    """Impulses at planes; arrays of shape (k,)."""

    events: np.ndarray
    """Number of the event."""
    planes: np.ndarray
    """Contact plane."""
    impulses: np.ndarray
    """Impulse on the rotor per effective mass of the plane, ``−P + iF``: outward, and along growing angle.  Complex."""

    def at(self, plane: int) -> Blows:
        """Those at one plane."""
        here = self.planes == plane
        return Blows(*(part[here] for part in self))


def blows_of(motion: Trajectory, events: np.ndarray) -> Blows:
    """Impulses that have changed the amplitudes of a rotor in some events, by their numbers, shape (n,).

    Of a plane struck alone the impulse is the change of its own velocity.  Where others are at their walls too, the impulses
    follow from the changes of velocity at all of these: ``Δu_p = Σ_q A_pq π_q`` (:mod:`carom.core.joint`), less those by the unbalance of
    a shaft whose speed jumps.  Of planes that always
    move alike only the sum of their impulses counts, which is given to them in equal parts.
    """
    system, planes = motion.rotor.system, motion.event_planes[events]
    lasting = motion.segment_phases[events] != Phase.FLIGHT
    before, after = motion.arrivals[events], motion.segment_amplitudes[events + 1]
    arrays, places, count = system.arrays, np.arange(len(events)), lasting.shape[1]
    pushed = (before, _without_jolt(system, before, after))
    states = [[system.at_planes(each, np.full(len(events), p)) for p in range(count)] for each in pushed]
    position = np.stack([place for place, _ in states[0]], axis=-1)
    normal = position / np.abs(position)
    speeds = [
        np.stack([radial + 1j * along for _, radial, along in (polar(*at) for at in each)], axis=-1) for each in states
    ]
    changes = speeds[1] - speeds[0]
    at_wall = (lasting | (np.abs(position) >= 1.0 - AT_WALL)) & (arrays.stiffness == 0.0)
    at_wall[places, planes] = True
    impulses = np.where(at_wall, changes, 0.0)
    for event in np.flatnonzero(at_wall.sum(axis=1) > 1):
        here = np.flatnonzero(at_wall[event])
        couplings = normal[event, here].conj()[:, None] * arrays.mobility[np.ix_(here, here)] * normal[event, here]
        impulses[event, here] = np.linalg.lstsq(couplings, changes[event, here])[0]
    sizes, terms = np.abs(impulses), np.abs(before) @ np.abs(arrays.rate_rows).T
    struck = sizes > NONE * sizes.max(axis=1, initial=0.0, keepdims=True) + ROUNDING * terms
    struck[places, planes] |= ~struck.any(axis=1)
    rows, columns = np.nonzero(struck)
    return Blows(events[rows], columns, impulses[rows, columns])


def _without_jolt(system: System, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Amplitudes after events without the impulse of the unbalance, which moves the rotor as the speed of its shaft jumps."""
    if system.shaft is None:
        return after
    direction = before[:, int(system.arrays.shaft[0]), None]
    jump = shaft_speed(system, after) - shaft_speed(system, before)
    freed: np.ndarray = after + 1j * jump[:, None] * direction * system.arrays.unbalance
    return freed
