"""Speeds of a rotor at its touchdown bearings: radial, angular, slip, those of the shaft and of races."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.base.outcome import Phase

if TYPE_CHECKING:
    from carom.models import System

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
    surface_speed: Any = system.contacts[plane].wall.surface_speed
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
