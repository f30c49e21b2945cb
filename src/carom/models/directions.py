"""Whether a rotor's bearings act differently in two directions, whatever acts on it besides."""

from __future__ import annotations

import numpy as np

from carom.models.linear import LinearRotor
from carom.models.model import Model
from carom.models.stages import Around


def conjugate_of(model: Model) -> np.ndarray | None:
    """Damping and stiffness (2, n, n) in the fixed frame that act on conjugates; ``None`` where bearings are alike in both directions."""
    while isinstance(model, Around):
        model = model.rotor
    if not isinstance(model, LinearRotor) or model.system.mirrored is None:
        return None
    return model.conjugate


def whirl_of(model: Model, force: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Parts (n,) of the whirl that a force (n,) which turns with the shaft excites: what goes with ``e^{it}`` in the fixed frame, and with ``e^{−it}``."""
    mass, damping, gyroscopic, stiffness, _ = model.matrices
    ahead = stiffness - mass + 1j * damping + gyroscopic
    conjugate = conjugate_of(model)
    if conjugate is None:
        return np.linalg.solve(ahead, force), np.zeros(len(force), complex)
    behind = stiffness - mass - 1j * damping - gyroscopic
    by_rates, by_place = conjugate
    matrix = np.block([[ahead, by_place + 1j * by_rates], [(by_place - 1j * by_rates).conj(), behind.conj()]])
    forward, backward = np.split(np.linalg.solve(matrix, np.append(force, np.zeros(len(force)))), 2)
    return forward, backward.conj()
