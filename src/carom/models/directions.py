"""Whether a rotor's bearings act differently in two directions, whatever acts on it besides."""

from __future__ import annotations

import numpy as np

from carom.models.rotor import Rotor


def whirl_of(model: Rotor, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parts (n,) of the whirl that a force (n,) which turns with the shaft excites: what goes with ``e^{it}`` in the fixed frame, and with ``e^{−it}``."""
    mass, damping, gyroscopic, stiffness, _ = model.matrices
    ahead = stiffness - mass + 1j * damping + gyroscopic
    conjugate = model.acting_on_conjugates
    if conjugate is None:
        return np.linalg.solve(ahead, force), np.zeros(len(force), complex)
    behind = stiffness - mass - 1j * damping - gyroscopic
    by_rates, by_place = conjugate
    matrix = np.block([[ahead, by_place + 1j * by_rates], [(by_place - 1j * by_rates).conj(), behind.conj()]])
    forward, backward = np.split(np.linalg.solve(matrix, np.append(force, np.zeros(len(force)))), 2)
    return forward, backward.conj()
