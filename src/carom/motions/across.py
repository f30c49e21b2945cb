"""Energies and powers of bearings that act differently in two directions: of forces by the conjugates of coordinates and rates."""

from __future__ import annotations

import numpy as np

from carom.models.anisotropic import TURN
from carom.motions.trajectories import Trajectory


class Across:
    """What depends on the direction in a motion, ``−D′Z̄˙ − K′Z̄``; nothing where bearings are alike in both directions.

    The symmetric part of ``K′`` stores the energy ``Re(ZᴴK′Z̄)/2``; the rest of it does circulatory work.
    """

    def __init__(self, trajectory: Trajectory) -> None:
        n, pair = len(trajectory.rotor.system.rest), trajectory.rotor.acting_on_conjugates
        self.begins, self.acts = trajectory.begins, pair is not None
        damping, stiffness = np.zeros((2, n, n)) if pair is None else pair
        self.damping: np.ndarray = damping
        self.stores, self.circulates = 0.5 * (stiffness + stiffness.T), 0.5 * (stiffness - stiffness.T)

    def energy(self, position: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Energy that is stored at coordinates (..., n) in the frame of the rotor at times (...)."""
        return 0.5 * self._form(position, self.stores, position, times)

    def damping_power(self, velocity: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Power of the damping at velocities (..., n) of the fixed frame, seen in that of the rotor."""
        return -self._form(velocity, self.damping, velocity, times)

    def circulatory_power(self, position: np.ndarray, velocity: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Power of circulatory forces."""
        return -self._form(velocity, self.circulates, position, times)

    def _form(self, left: np.ndarray, matrix: np.ndarray, right: np.ndarray, times: np.ndarray) -> np.ndarray:
        if not self.acts:
            return np.zeros(np.shape(times))
        form = np.einsum("...i,ij,...j->...", left.conj(), matrix, right.conj(), optimize=True)
        power: np.ndarray = (form * np.exp(TURN * (self.begins + times))).real
        return power
