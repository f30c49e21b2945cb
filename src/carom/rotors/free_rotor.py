"""What all flexible rotors have in common, however their matrices are made, and their modes without bearings."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import Field
from carom.parameters.formats import number
from carom.rotors.shaft_parts import Damping, Disc, read_parts


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


class RotorMatrices(NamedTuple):
    """Matrices (n, n) of a displacement and a tilt at each place in turn."""

    mass: np.ndarray
    """kg, kg m, kg m²."""
    stiffness: np.ndarray
    """N/m, N, N m."""
    gyroscopic: np.ndarray
    """kg, kg m, kg m²; it is multiplied by the speed of the shaft."""


class FreeRotor(ABC):
    """A rotor free in space, or held at a point about which it tilts, in SI units.

    In its complex coordinates, with the speed ``Ω`` of the shaft in the fixed frame,

        M z̈ + (D − iΩG) ż + D_i (ż − iΩz) + K z = f.
    """

    mass: float
    """kg."""
    polar_inertia: float
    """Moment of inertia about its axis, kg m²."""
    diametral_inertia: float
    """Moment of inertia about a diameter through its centre of mass, kg m²."""
    centre: float
    """Where its centre of mass lies along the shaft, m."""
    bends: ClassVar[bool] = True
    """Whether it bends: then a rigid wall would have no answer that stays as modes are added."""
    fields: ClassVar[Mapping[str, Field]] = {}
    """Its own numbers that can be varied, by name."""
    translations: int = 1
    """How many of its free motions are translations, which come first."""
    damping_rates: np.ndarray | None
    """Damping over mass of each free mode, 1/s; ``None`` where damping couples modes."""
    damping_matrix: np.ndarray
    """``D``, shape (n, n): N s/m, N s, N m s."""
    internal_rates: np.ndarray | None = None
    """As ``damping_rates``, of the damping ``D_i`` that turns with the shaft; ``None`` without such damping."""
    axial_stiffness: np.ndarray | None = None
    """Stiffness by axial forces, shape (n, n); ``None`` without any.  It is no part of ``K``: it resists a tilt as a whole, as what holds a rotor does."""
    free_modes: FreeModes
    """All modes of the rotor at rest, free in space: translation, tilt, and bending from the lowest on."""
    words: str
    """What it is, in a line."""
    entries: Mapping[str, Any] | None
    """What ``[rotor]`` of a machine file states of it, beside its damping; ``None`` where no file holds its matrices."""

    matrices: RotorMatrices
    """``M``, ``K`` and ``G``."""
    places: np.ndarray
    """Places along the shaft whose displacements are stated, m, shape (N,)."""
    node_places: np.ndarray
    """Where its nodes are, from node 0 on, m."""

    def place_of(self, node: int) -> int:
        """Number of the place of a node."""
        return node

    @abstractmethod
    def row_at(self, node: int) -> np.ndarray:
        """Displacement at a node per coordinate, shape (n,)."""

    @abstractmethod
    def tilt_at(self, node: int) -> np.ndarray:
        """Tilt at a node per coordinate, shape (n,)."""

    @abstractmethod
    def displacements(self, shapes: np.ndarray) -> np.ndarray:
        """Displacements at all places, shape (N, v), of shapes (n, v)."""

    def by_modes(self, rates: np.ndarray | None) -> np.ndarray:
        """Matrix (n, n) of a damping over mass of each free mode, 1/s."""
        pushed = self.matrices.mass @ self.free_modes.shapes
        matrix: np.ndarray = pushed * rates @ pushed.T
        return matrix

    def check_node(self, name: str, node: int) -> None:
        """Refuse a node that the shaft does not have."""
        last = len(self.node_places) - 1
        if node > last:
            end = f"{1e3 * self.node_places[-1]:.6g} mm"
            raise InputError(name, node, f"a node of the shaft: 0 to {last}, its end at {end}")

    def carried(self, shapes: np.ndarray) -> np.ndarray:
        """Shares (v,) of shapes with unit modal mass, the first of which is the translation, when the rotor is displaced by 1 m: how all its masses fall."""
        return np.append(np.sqrt(self.mass), np.zeros(shapes.shape[1] - 1))


class BendingRotor(FreeRotor):
    """A rotor with a complex displacement ``x + iy``, m, and a complex tilt ``dx/ds + i dy/ds`` at each of its places in turn as coordinates."""

    damping: Damping | np.ndarray
    internal: Damping | None
    discs: Sequence[Disc]

    def _with_discs(self, *matrices: np.ndarray) -> RotorMatrices:
        """``M``, ``K`` and ``G`` of the shaft and what is put on it, read-only."""
        found = RotorMatrices(*(each.copy() for each in matrices))
        for disc in self.discs:
            displacement = 2 * self.place_of(disc.node)
            tilt = displacement + 1
            found.mass[displacement, displacement] += disc.mass
            found.mass[tilt, tilt] += disc.diametral_inertia
            found.gyroscopic[tilt, tilt] += disc.polar_inertia
        for each in found:
            each.flags.writeable = False
        return found

    def _read_discs(self) -> None:
        """Refuse discs of another kind, or at a node that the shaft does not have."""
        read_parts(self, "discs", Disc)
        for disc in self.discs:
            self.check_node("disc node", disc.node)

    @property
    def own_damping(self) -> Damping | None:
        """What damps each mode by itself; ``None`` if a matrix is given instead."""
        return self.damping if isinstance(self.damping, Damping) else None

    def row_at(self, node: int) -> np.ndarray:
        """Displacement at a node per coordinate, shape (n,)."""
        row = np.zeros(len(self.matrices.mass))
        row[2 * self.place_of(node)] = 1.0
        return row

    def tilt_at(self, node: int) -> np.ndarray:
        """Tilt at a node per coordinate, shape (n,)."""
        return np.roll(self.row_at(node), 1)

    def displacements(self, shapes: np.ndarray) -> np.ndarray:
        """Displacements at all places, shape (N, v), of shapes (n, v)."""
        return shapes[::2]

    @property
    def words(self) -> str:  # type: ignore[override]
        """What it is, in a line."""
        return f"{number(self.mass)} kg, {number(float(1e3 * self.node_places[-1]))} mm long"

    @cached_property
    def damping_rates(self) -> np.ndarray | None:  # type: ignore[override]
        """Damping over mass of each free mode, 1/s; ``None`` where damping couples modes."""
        return self._rates(self.own_damping)

    @cached_property
    def damping_matrix(self) -> np.ndarray:  # type: ignore[override]
        """``D``, shape (n, n): N s/m, N s, N m s."""
        if not isinstance(self.damping, Damping):
            return self.damping
        return self.by_modes(self.damping_rates)

    @cached_property
    def internal_rates(self) -> np.ndarray | None:  # type: ignore[override]
        """Damping over mass of each free mode that turns with the shaft, 1/s."""
        return self._rates(self.internal)

    def _rates(self, own: Damping | None) -> np.ndarray | None:
        return None if own is None else np.array([own.rate(each) for each in self.free_modes.frequencies.tolist()])

    def _check_internal(self) -> None:
        """Refuse internal damping of another kind, and that of the rotor as a whole, which does not bend then."""
        own: object = self.internal
        if not isinstance(own, Damping | None) or (own and vars(own).get("of_mass")):
            allowed = "carom.rotors.ModalDamping, or ProportionalDamping of the stiffness alone: only what bends has internal damping"
            raise InputError("internal", shown(own), allowed)

    @cached_property
    def free_modes(self) -> FreeModes:  # type: ignore[override]
        """All modes of the rotor at rest, free in space: translation, tilt, and bending from the lowest on."""
        try:
            with np.errstate(divide="raise", over="raise", invalid="raise"):
                return free_modes(self.matrices.mass, self.matrices.stiffness, self.translation, self.tilt)
        except (np.linalg.LinAlgError, FloatingPointError):
            raise self._refused_modes() from None

    def _refused_modes(self) -> InputError:
        """The error of numbers of so different sizes that no modes can be found."""
        allowed = "stiffness and masses of one rotor: with these numbers its modes are lost in rounding"
        return InputError("K", f"from {self.matrices.stiffness.diagonal().min():g} on", allowed)

    @cached_property
    def translation(self) -> np.ndarray:
        """Coordinates of the rotor displaced by 1 m, shape (n,)."""
        return np.tile([1.0, 0.0], len(self.places))

    @cached_property
    def tilt(self) -> np.ndarray:
        """Coordinates of the rigid rotor tilted by 1 about its centre of mass, shape (n,)."""
        return np.stack([self.places - self.centre, np.ones(len(self.places))], axis=1).ravel()

    @property
    def mass(self) -> float:  # type: ignore[override]
        """Mass, kg."""
        return float(self.translation @ self.matrices.mass @ self.translation)

    @cached_property
    def centre(self) -> float:  # type: ignore[override]
        """Where its centre of mass lies along the shaft, m."""
        along = np.stack([self.places, np.ones(len(self.places))], axis=1).ravel()
        return float(self.translation @ self.matrices.mass @ along / self.mass)

    @property
    def diametral_inertia(self) -> float:  # type: ignore[override]
        """Moment of inertia about a diameter through its centre of mass, kg m²."""
        return float(self.tilt @ self.matrices.mass @ self.tilt)

    @property
    def polar_inertia(self) -> float:  # type: ignore[override]
        """Moment of inertia about its axis, kg m²."""
        return float(self.tilt @ self.matrices.gyroscopic @ self.tilt)
