"""Load on the touchdown bearing: impacts and lasting contacts of a motion, with impulses, forces and works."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from carom.outcome import Phase
from carom.parameters import UNITS
from carom.results import Result

if TYPE_CHECKING:
    import xarray

    from carom.models import Model
    from carom.parameters import Scales


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


class Table(Result):
    """Table of columns with units, all along one dimension.

    ``columns`` maps the name of each column to the property of :class:`~carom.parameters.Scales` that converts it to SI
    units (empty if there is none), the SI unit and a description.  Arrays are in the units of the equations; a table
    knows the scales of its machine, if these are known.
    """

    dimension: ClassVar[str]
    columns: ClassVar[dict[str, tuple[str, str, str]]]
    scales: Scales | None

    def to_dataset(self) -> xarray.Dataset:
        """Table with units and long names as attributes; in SI if the machine is known."""
        import xarray

        columns = {}
        for name, (scale, unit, words) in self.columns.items():
            values = getattr(self, name)
            if scale and self.scales:
                values = values * getattr(self.scales, scale)
            elif scale:
                unit = UNITS[scale][0]
            columns[name] = (self.dimension, values, {"units": unit, "long_name": words})
        return xarray.Dataset(columns)


@dataclass(frozen=True, eq=False, repr=False)
class ContactLog(Table):
    """Impacts of a motion, one entry per impact, in chronological order.

    All arrays have shape (n,).  Lengths are in ``c_r``, times in ``1/Ω``, impulses in ``m c_r Ω``, energies in
    ``m c_r² Ω²``, in the co-rotating frame.  Here ``m`` is the mass that an impulse at the contact plane moves, and
    ``c_r`` the clearance there.

    Attributes
    ----------
    time, angle : ndarray
        Time and angle ``θ`` of the impact.
    plane : ndarray of int
        Contact plane of the impact.
    radial_speed, angular_speed : ndarray
        ``ṙ`` and ``θ̇`` just before it.
    radial_speed_after, angular_speed_after : ndarray
        ``ṙ`` and ``θ̇`` just after it.
    normal_impulse, tangential_impulse : ndarray
        Impulse of the bearing on the rotor: inward, and along growing ``θ`` (against the slip).
    slip_before, slip_after : ndarray
        Slip velocity ``v = s + 1 + θ̇`` of the contact point.
    sticks : ndarray of bool
        Whether friction stopped the slip.
    contact_work : ndarray
        Work of the impulse on the contact point (from the mean of the velocities before and after), never positive.
    drive_work : ndarray
        Work that the shaft's drive supplies through friction: kinetic energy gained minus ``contact_work``.
    """

    time: np.ndarray
    plane: np.ndarray
    angle: np.ndarray
    radial_speed: np.ndarray
    angular_speed: np.ndarray
    radial_speed_after: np.ndarray
    angular_speed_after: np.ndarray
    normal_impulse: np.ndarray
    tangential_impulse: np.ndarray
    slip_before: np.ndarray
    slip_after: np.ndarray
    sticks: np.ndarray
    contact_work: np.ndarray
    drive_work: np.ndarray
    scales: Scales | None = None

    dimension: ClassVar[str] = "impact"
    columns: ClassVar[dict[str, tuple[str, str, str]]] = {
        "time": ("time", "s", "time of impact"),
        "plane": ("", "1", "contact plane"),
        "angle": ("", "rad", "angle of impact in the co-rotating frame"),
        "radial_speed": ("velocity", "m/s", "radial speed before impact"),
        "angular_speed": ("speed", "rad/s", "angular speed before impact, co-rotating frame"),
        "radial_speed_after": ("velocity", "m/s", "radial speed after impact"),
        "angular_speed_after": ("speed", "rad/s", "angular speed after impact, co-rotating frame"),
        "normal_impulse": ("impulse", "N s", "normal impulse of the bearing on the rotor"),
        "tangential_impulse": ("impulse", "N s", "friction impulse of the bearing on the rotor"),
        "slip_before": ("velocity", "m/s", "slip velocity before impact"),
        "slip_after": ("velocity", "m/s", "slip velocity after impact"),
        "sticks": ("", "1", "whether friction stopped the slip"),
        "contact_work": ("energy", "J", "work of the impact on the contact point"),
        "drive_work": ("energy", "J", "work of the shaft's drive through friction"),
    }

    @classmethod
    def from_states(
        cls,
        rotor: Model,
        times: np.ndarray,
        planes: np.ndarray,
        before: tuple[np.ndarray, np.ndarray],
        after: tuple[np.ndarray, np.ndarray],
    ) -> ContactLog:
        """Log of impacts at given planes from their positions and velocities just before and just after, shape (n,)."""
        angle, radial, angular = polar(*before)
        _, radial_after, angular_after = polar(*after)
        arrays = rotor.system.arrays
        drive = arrays.drive[planes]
        normal = radial - radial_after
        tangential = angular_after - angular
        slip, slip_after = drive + angular, drive + angular_after
        normal_work = -0.5 * normal * (radial + radial_after)
        return cls(
            time=times,
            plane=planes,
            angle=angle,
            radial_speed=radial,
            angular_speed=angular,
            radial_speed_after=radial_after,
            angular_speed_after=angular_after,
            normal_impulse=normal,
            tangential_impulse=tangential,
            slip_before=slip,
            slip_after=slip_after,
            sticks=arrays.friction[planes] * normal >= np.abs(slip),
            contact_work=normal_work + 0.5 * tangential * (slip + slip_after),
            drive_work=-(drive - 1.0) * tangential,
            scales=rotor.scales,
        )

    def __len__(self) -> int:
        return len(self.time)


@dataclass(frozen=True, eq=False, repr=False)
class ContactHistory(Table):
    """Forces and slip of lasting contact at chosen times.

    All arrays have shape (n,).  Times are in ``1/Ω``, forces in ``m c_r Ω²``, speeds in ``c_r Ω``, powers in ``m c_r² Ω³``,
    lengths in ``c_r``.  In flight forces, slip and powers are zero.

    Attributes
    ----------
    time, angle : ndarray
        Time and angle ``θ`` of the rotor in the co-rotating frame.
    phase : ndarray of int
        :class:`~carom.outcome.Phase`.
    gap : ndarray
        Distance from the wall, ``1 − |U|``.
    normal_force, friction_force : ndarray
        Force of the bearing on the rotor: inward, and along growing ``θ``.
    slip : ndarray
        Slip velocity ``v = s + 1 + θ̇`` of the contact point.
    friction_power : ndarray
        Power of friction on the contact point, ``F v``: never positive, lost as heat.
    drive_power : ndarray
        Power that the shaft's drive supplies through friction, ``−F s``.
    """

    time: np.ndarray
    phase: np.ndarray
    angle: np.ndarray
    gap: np.ndarray
    normal_force: np.ndarray
    friction_force: np.ndarray
    slip: np.ndarray
    friction_power: np.ndarray
    drive_power: np.ndarray
    scales: Scales | None = None

    dimension: ClassVar[str] = "time"
    columns: ClassVar[dict[str, tuple[str, str, str]]] = {
        "time": ("time", "s", "time"),
        "phase": ("", "1", "kind of motion"),
        "angle": ("", "rad", "angle in the co-rotating frame"),
        "gap": ("length", "m", "distance from the wall"),
        "normal_force": ("force", "N", "normal force of the bearing on the rotor"),
        "friction_force": ("force", "N", "friction force of the bearing on the rotor, along growing angle"),
        "slip": ("velocity", "m/s", "slip velocity"),
        "friction_power": ("power", "W", "power of friction on the contact point"),
        "drive_power": ("power", "W", "power of the shaft's drive through friction"),
    }

    @classmethod
    def from_states(
        cls,
        rotor: Model,
        plane: int,
        times: np.ndarray,
        phases: np.ndarray,
        state: tuple[np.ndarray, np.ndarray],
        forces: tuple[np.ndarray, np.ndarray],
    ) -> ContactHistory:
        """History at a plane from positions and velocities, and normal and friction forces, each of shape (n,)."""
        position, velocity = state
        drive = float(rotor.system.arrays.drive[plane])
        normal, friction = forces
        slip = np.where(phases == Phase.FLIGHT, 0.0, drive + (position.conj() * velocity).imag)
        return cls(
            time=times,
            phase=phases,
            angle=np.angle(position),
            gap=1.0 - np.abs(position),
            normal_force=normal,
            friction_force=friction,
            slip=slip,
            friction_power=friction * slip,
            drive_power=-(drive - 1.0) * friction,
            scales=rotor.scales,
        )

    def to_dataset(self) -> xarray.Dataset:
        """Table with units and long names as attributes; in SI if the machine is known."""
        dataset = super().to_dataset()
        del dataset["phase"].attrs["units"]
        dataset["phase"].attrs |= phase_flags(Phase)
        return dataset


def phase_flags(phases: Iterable[Phase]) -> dict[str, Any]:
    """Attributes that give the meaning of phase numbers, by the CF conventions."""
    kinds = list(phases)
    return {
        "flag_values": np.array(kinds, np.int8),
        "flag_meanings": " ".join(phase.label.replace("-", "_") for phase in kinds),
    }


def polar(position: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, radial and angular speed of states on the wall."""
    local = position.conj() * velocity / np.abs(position)
    return np.angle(position), local.real, local.imag / np.abs(position)
