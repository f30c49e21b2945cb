"""What a shaft whose speed changes does along a motion: its energy, the push of its unbalance, and the work of its drive.

With the speed ``σ``, the direction ``p`` of the unbalance and the friction forces ``F_q`` at the radii ``s_q`` the unbalance pushes with
``F(σ² − iβ)p``, ``Jβ = Σ_q s_q F_q`` (:mod:`carom.core.shaft`).  At an impact the speed jumps by ``Δσ`` and the unbalance gives the impulse
``−iFpΔσ``, which works with the mean of the velocities before and after.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.motions.contacts import presses, shaft_speed
from carom.motions.trajectories import Trajectory


class Spin(NamedTuple):
    """The shaft of a motion with ``n`` events, over the stretches (k, 16) of its energy ledger."""

    energy: np.ndarray
    """``Jσ²/2`` at the start of each segment and at the end, (n + 2,); zeros at constant speed."""
    unbalance: np.ndarray
    """What the force of the unbalance at the nominal speed is multiplied by; complex."""
    drive: np.ndarray
    """Power of the drive's torque in contact."""
    left_out: np.ndarray
    """Power that the torque would have in flight."""
    jolts: np.ndarray
    """Impulse of the unbalance in each event, in that force, (n,); complex."""


def spin_of(trajectory: Trajectory, times: np.ndarray) -> Spin:
    """Spin of the shaft at times (k, 16), with a constant push of the unbalance and no energy where its speed does not change."""
    system = trajectory.rotor.system
    if system.shaft is None:
        still = np.zeros(times.shape)
        events = len(trajectory.segment_starts) - 1
        return Spin(np.zeros(events + 2), np.ones(times.shape, complex), still, still, np.zeros(events, complex))
    shaft, place = system.shaft.shaft, int(system.arrays.shaft[0])
    amplitudes, phases = trajectory.amplitudes_at(times)
    speed, direction = shaft_speed(system, amplitudes), amplitudes[..., place]
    braking = np.zeros(times.shape)
    for plane, radius in enumerate(system.arrays.surface_speed - 1.0):
        braking += radius / shaft.inertia * trajectory.seen_at(plane).forces_of(amplitudes, phases, times)[1]
    held = presses(phases).any(axis=-1)
    torque = shaft.torque * speed
    turns = shaft_speed(system, np.concatenate([trajectory.segment_amplitudes, trajectory.last_amplitudes[None]]))
    jumps = turns[1:-1] - shaft_speed(system, trajectory.arrivals)
    return Spin(
        0.5 * shaft.inertia * turns**2,
        (speed**2 - 1j * braking) * direction,
        np.where(held, torque, 0.0),
        np.where(held, 0.0, torque),
        -1j * jumps * trajectory.arrivals[:, place],
    )
