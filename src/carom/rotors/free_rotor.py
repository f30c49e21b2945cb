"""What all flexible rotors have in common, however their matrices are made."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import NamedTuple

import numpy as np

from carom.outcome import InputError
from carom.rotors.damping import Damping
from carom.rotors.discs import Disc
from carom.rotors.free_modes import FreeModes, free_modes


class RotorMatrices(NamedTuple):
    """Matrices (n, n) of a displacement and a tilt at each place in turn."""

    mass: np.ndarray
    """kg, kg m, kg m²."""
    stiffness: np.ndarray
    """N/m, N, N m."""
    gyroscopic: np.ndarray
    """kg, kg m, kg m²; it is multiplied by the speed of the shaft."""

    def add_disc(self, disc: Disc, place: int) -> None:
        """Add a disc where the displacement has this number."""
        self.mass[place, place] += disc.mass
        self.mass[place + 1, place + 1] += disc.diametral_inertia
        self.gyroscopic[place + 1, place + 1] += disc.polar_inertia


class FreeRotor(ABC):
    """A rotor free in space, in SI units.

    Coordinates are a complex displacement ``x + iy``, m, and a complex tilt ``dx/ds + i dy/ds`` at each of its places along the shaft in turn; with the
    speed ``Ω`` of the shaft in the fixed frame

        M z̈ + (D − iΩG) ż + K z = f.
    """

    @property
    @abstractmethod
    def matrices(self) -> RotorMatrices:
        """``M``, ``K`` and ``G``."""

    @property
    @abstractmethod
    def own_damping(self) -> Damping | None:
        """What damps each mode by itself; ``None`` if a matrix is given instead."""

    @property
    @abstractmethod
    def places(self) -> np.ndarray:
        """Where its coordinates are, along the shaft, m, shape (N,)."""

    @property
    @abstractmethod
    def node_places(self) -> np.ndarray:
        """Where its nodes are, from node 0 on, m."""

    @abstractmethod
    def displacement_at(self, node: int) -> int:
        """Number of the coordinate that is the displacement of a node."""

    def check_node(self, name: str, node: int) -> None:
        """Refuse a node that the shaft does not have."""
        last = len(self.node_places) - 1
        if node > last:
            end = f"{1e3 * self.node_places[-1]:.6g} mm"
            raise InputError(name, node, f"a node of the shaft: 0 to {last}, its end at {end}")

    @property
    def mass_matrix(self) -> np.ndarray:
        """``M``, shape (n, n): kg, kg m, kg m²."""
        return self.matrices.mass

    @property
    def stiffness_matrix(self) -> np.ndarray:
        """``K``, shape (n, n): N/m, N, N m."""
        return self.matrices.stiffness

    @property
    def gyroscopic_matrix(self) -> np.ndarray:
        """``G``, shape (n, n): kg, kg m, kg m²; it is multiplied by the speed of the shaft."""
        return self.matrices.gyroscopic

    @cached_property
    def damping_rates(self) -> np.ndarray | None:
        """Damping over mass of each free mode, 1/s; ``None`` where damping couples modes."""
        own = self.own_damping
        return None if own is None else np.array([own.rate(each) for each in self.free_modes.frequencies.tolist()])

    @cached_property
    def damping_matrix(self) -> np.ndarray:
        """``D``, shape (n, n): N s/m, N s, N m s."""
        return self.damping_of_modes()

    def damping_of_modes(self) -> np.ndarray:
        """Matrix (n, n) that damps each mode at its rate."""
        pushed = self.mass_matrix @ self.free_modes.shapes
        matrix: np.ndarray = (pushed * self.damping_rates) @ pushed.T
        return matrix

    @cached_property
    def free_modes(self) -> FreeModes:
        """All modes of the rotor at rest, free in space: translation, tilt, and bending from the lowest on."""
        try:
            with np.errstate(divide="raise", over="raise", invalid="raise"):
                return free_modes(self.mass_matrix, self.stiffness_matrix, self.translation, self.tilt)
        except (np.linalg.LinAlgError, FloatingPointError):
            raise self._refused_modes() from None

    def _refused_modes(self) -> InputError:
        """The error of numbers of so different sizes that no modes can be found."""
        allowed = "stiffness and masses of one rotor: with these numbers its modes are lost in rounding"
        return InputError("K", f"from {self.stiffness_matrix.diagonal().min():g} on", allowed)

    @cached_property
    def translation(self) -> np.ndarray:
        """Coordinates of the rotor displaced by 1 m, shape (n,)."""
        return np.tile([1.0, 0.0], len(self.places))

    @cached_property
    def tilt(self) -> np.ndarray:
        """Coordinates of the rigid rotor tilted by 1 about its centre of mass, shape (n,)."""
        return np.stack([self.places - self.centre, np.ones(len(self.places))], axis=1).ravel()

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return float(self.translation @ self.mass_matrix @ self.translation)

    @cached_property
    def centre(self) -> float:
        """Where its centre of mass lies along the shaft, m."""
        along = np.stack([self.places, np.ones(len(self.places))], axis=1).ravel()
        return float(self.translation @ self.mass_matrix @ along / self.mass)

    @property
    def diametral_inertia(self) -> float:
        """Moment of inertia about a diameter through its centre of mass, kg m²."""
        return float(self.tilt @ self.mass_matrix @ self.tilt)

    @property
    def polar_inertia(self) -> float:
        """Moment of inertia about its axis, kg m²."""
        return float(self.tilt @ self.gyroscopic_matrix @ self.tilt)
