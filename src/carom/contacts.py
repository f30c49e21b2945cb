"""What the touchdown bearing gets: impacts and lasting contacts of a motion, with impulses and works."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.outcome import Phase
from carom.rotors import Rotor

if TYPE_CHECKING:
    import xarray

    from carom.parameters import Scales

__all__ = ["ContactLog", "LastingContact", "polar"]


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


@dataclass(frozen=True, eq=False)
class ContactLog:
    """Impacts of a motion, one entry each, in the order of time.

    All arrays have shape (n,).  Lengths are in ``c_r``, times in ``1/Ω``, impulses in ``m c_r Ω``, energies in
    ``m c_r² Ω²``, in the co-rotating frame.

    Attributes
    ----------
    time, angle : ndarray
        Time and angle ``θ`` of the impact.
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
        Work of the impulse on the contact point (mean velocity of before and after), never positive.
    drive_work : ndarray
        Work that the shaft's drive feeds in through friction: kinetic energy gained minus ``contact_work``.
    """

    time: np.ndarray
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

    @classmethod
    def from_states(
        cls,
        rotor: Rotor,
        times: np.ndarray,
        before: tuple[np.ndarray, np.ndarray],
        after: tuple[np.ndarray, np.ndarray],
    ) -> ContactLog:
        """Log of impacts from positions and velocities just before and just after, each of shape (n,)."""
        angle, radial, angular = polar(*before)
        _, radial_after, angular_after = polar(*after)
        drive = float(rotor.arrays.drive[0])
        normal = radial - radial_after
        tangential = angular_after - angular
        slip, slip_after = drive + angular, drive + angular_after
        normal_work = -0.5 * normal * (radial + radial_after)
        return cls(
            time=times,
            angle=angle,
            radial_speed=radial,
            angular_speed=angular,
            radial_speed_after=radial_after,
            angular_speed_after=angular_after,
            normal_impulse=normal,
            tangential_impulse=tangential,
            slip_before=slip,
            slip_after=slip_after,
            sticks=rotor.arrays.friction[0] * normal >= np.abs(slip),
            contact_work=normal_work + 0.5 * tangential * (slip + slip_after),
            drive_work=-(drive - 1.0) * tangential,
        )

    def __len__(self) -> int:
        return len(self.time)

    def in_si(self, scales: Scales) -> dict[str, tuple[np.ndarray, str]]:
        """Columns with their SI units: name to (values, unit)."""
        return {
            name: (getattr(self, name) * (getattr(scales, scale) if scale else 1), unit)
            for name, (scale, unit, _) in _COLUMNS.items()
        }

    def to_dataset(self, scales: Scales | None = None) -> xarray.Dataset:
        """Table with units and long names as attributes; in SI if scales are given."""
        import xarray

        si = self.in_si(scales) if scales else {}
        columns = {}
        for name, (scale, _, words) in _COLUMNS.items():
            values, unit = si.get(name, (getattr(self, name), _DIMENSIONLESS_UNITS.get(scale, "1")))
            columns[name] = ("impact", values, {"units": unit, "long_name": words})
        return xarray.Dataset(columns)


_COLUMNS = {
    "time": ("time", "s", "time of impact"),
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

_DIMENSIONLESS_UNITS = {
    "": "1",
    "time": "1/Omega",
    "velocity": "c_r Omega",
    "speed": "Omega",
    "impulse": "m c_r Omega",
    "energy": "m c_r^2 Omega^2",
}


def polar(position: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, radial and angular speed of states on the wall."""
    local = position.conj() * velocity / np.abs(position)
    return np.angle(position), local.real, local.imag / np.abs(position)
