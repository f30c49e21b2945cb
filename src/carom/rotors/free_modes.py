"""Modes of a free body: its rigid motions exactly, and those of bending with the lowest to full accuracy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class FreeModes(NamedTuple):
    """Modes with unit modal mass, in the order of their frequencies."""

    frequencies: np.ndarray
    """rad/s, shape (m,); the first two are zero."""
    shapes: np.ndarray
    """Coordinates per mode, shape (n, m); the first two are translation and tilt about the centre of mass."""

    def flexibility(self, row: np.ndarray, kept: int) -> np.ndarray:
        """Coordinates (n,) per force on what a row (n,) measures, as far as the modes beyond the first ``kept`` ones give way."""
        others = self.shapes[:, kept:]
        moved: np.ndarray = others @ ((row @ others) / self.frequencies[kept:] ** 2)
        return moved


def free_modes(mass: np.ndarray, stiffness: np.ndarray, translation: np.ndarray, tilt: np.ndarray) -> FreeModes:
    """Modes ``K z = ω² M z`` of a free body, whose rigid motions are known.

    Stiffness on the rigid motions, ``K + ω₀² M R RᵀM``, changes no other mode and makes ``K`` positive definite.  Then ``1/ω²`` are eigenvalues
    whose largest, the lowest modes, are accurate to rounding, while of ``ω²`` itself the lowest would lose the digits by which the
    highest is larger.  The eigenvalues of the rigid motions are taken out.
    """
    rigid = np.stack([each / np.sqrt(each @ mass @ each) for each in (translation, tilt)], axis=1)
    pushed = mass @ rigid
    # Any size between the frequencies does.
    squared = 1e-3 * float(np.exp(np.mean(np.log(np.diag(stiffness) / np.diag(mass)))))
    root = np.linalg.cholesky(stiffness + squared * pushed @ pushed.T)
    across = np.linalg.solve(root, np.linalg.solve(root, mass).T)
    turned = np.linalg.solve(root, pushed) * np.sqrt(squared)  # the rigid motions there, of unit length
    values, vectors = np.linalg.eigh(0.5 * (across + across.T) - turned @ turned.T / squared)
    values, shapes = values[:1:-1], np.linalg.solve(root.T, vectors[:, :1:-1])
    shapes = np.concatenate([rigid, shapes / np.sqrt(values)], axis=1)
    # The highest are orthogonal to the digits of the lowest: made so to rounding, from the lowest on.
    shapes = np.linalg.solve(np.linalg.cholesky(shapes.T @ mass @ shapes), shapes.T).T
    return FreeModes(frequencies=np.concatenate([np.zeros(2), 1.0 / np.sqrt(values)]), shapes=shapes)
