"""How a rotor moves at its touchdown bearings: its speeds, those of the shaft and of races, and the course there with forces and slip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.base.outcome import Phase
from carom.motions.tables import LogTable, column

if TYPE_CHECKING:
    from carom.models import System
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales


PRESSING = (Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP, Phase.ROLLING)
"""Phases in which a wall presses on the rotor."""


def presses(phases: np.ndarray) -> np.ndarray:
    """Whether a wall presses on the rotor in each phase."""
    return np.isin(phases, PRESSING)


def is_compliant(system: System, plane: int) -> bool:
    """Whether the touchdown bearing at a plane is compliant."""
    return system.contacts[plane].wall.stiffness > 0.0


def slip_velocity(system: System, plane: int, amplitudes: np.ndarray) -> np.ndarray:
    """Slip velocity (...) of the contact point at a plane in amplitudes (..., N), ``v = s + r(1 + θ̇) − q``.

    On a rigid wall ``r`` is one.  The surface of a race that turns has the speed ``q``.  A shaft whose speed changes has ``sσ`` in
    place of ``s``.
    """
    surface_speed: float | np.ndarray = system.contacts[plane].wall.surface_speed
    if system.shaft is not None:
        surface_speed += (surface_speed - 1.0) * (shaft_speed(system, amplitudes) - 1.0)
    position, velocity = system.at_plane(amplitudes, plane)
    along: np.ndarray = (position.conj() * velocity).imag
    if is_compliant(system, plane):
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


def polar(position: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, radial and angular speed of states on the wall."""
    local = position.conj() * velocity / np.abs(position)
    return np.angle(position), local.real, local.imag / np.abs(position)


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


@dataclass(frozen=True, eq=False, repr=False)
class ContactHistory(LogTable):
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
    friction_force: np.ndarray = column("force", "friction force on the rotor, positive in the sense of rotation")
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
