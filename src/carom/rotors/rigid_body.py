"""A rigid rotor: four degrees of freedom, or two where it tilts about a fixed point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from carom.base.outcome import InputError, Problems, shown
from carom.parameters import MACHINE_FIELDS, Field, read_quantity
from carom.parameters.fields import by_name, length_field
from carom.parameters.tables import read_entries
from carom.rotors.free_rotor import FreeModes, FreeRotor, RotorMatrices
from carom.rotors.shaft_parts import check_inertias, inertia_field

RIGID_FIELDS: Mapping[str, Field] = by_name(
    MACHINE_FIELDS["mass"],
    inertia_field("polar_inertia", "I_p", "inertia of the rotor about its axis", '"0.01 kg m^2"'),
    inertia_field("diametral_inertia", "I_t", "inertia of the rotor about a diameter", '"0.15 kg m^2"', zero=False),
    length_field("pivot", "", "fixed point about which the rotor tilts, from its centre of mass", -1e3, 1e3, '"-250 mm"'),
)  # fmt: skip
"""Numbers of the rotor."""
POSITION = length_field("position", "", "place along the shaft, from the centre of mass", -1e3, 1e3, '"-120 mm"')


@dataclass(frozen=True, eq=False)
class RigidRotor(FreeRotor):
    """A rotor that does not bend, free in space or held at one point.

    With its centre of mass at the complex displacement ``z`` and its complex tilt ``θ``, and forces ``f_j`` at the stations ``l_j``, whose
    displacements are ``z + l_j θ``,

        m z̈ = Σ f_j,      I_t θ̈ − iΩ I_p θ̇ = Σ l_j f_j.

    Held at a point ``p`` it only tilts, ``z = −p θ``, and its inertia is that about this point, ``I_t + m p²``.

    Parameters
    ----------
    mass : float or str
        kg.
    polar_inertia, diametral_inertia : float or str
        Moments of inertia about the axis, and about a diameter through the centre of mass, kg m².
    stations : sequence of float or str
        Its nodes: where bearings, sensors, touchdown bearings and unbalances are, m along the shaft from the centre of mass, increasing.
    pivot : float or str, optional
        A fixed point about which the rotor tilts, m along the shaft from the centre of mass; by default it is free.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, the polar inertia is more than twice the diametral one, or a station is at the fixed point.
    """

    mass: float
    polar_inertia: float
    diametral_inertia: float
    stations: Sequence[float]
    pivot: float | None = None

    bends = False
    centre = 0.0
    fields = RIGID_FIELDS

    def __post_init__(self) -> None:
        read_entries(self, RIGID_FIELDS)
        check_inertias(self.polar_inertia, self.diametral_inertia)
        given: Any = self.stations
        problems = Problems()
        listed = [problems.attempt(read_quantity, POSITION, each) for each in np.atleast_1d(given).tolist()]
        problems.raise_all()
        if not listed or any(np.diff(np.array(listed)) <= 0.0):
            raise InputError("stations", shown(given), "places along the shaft from the centre of mass, increasing")
        if self.pivot is not None and self.pivot in listed:
            raise InputError("position", self.pivot, "a place off the pivot, where the rotor does not move")
        object.__setattr__(self, "stations", tuple(listed))

    @cached_property
    def matrices(self) -> RotorMatrices:  # type: ignore[override]
        """``M``, ``K`` and ``G`` of displacement and tilt, or of the tilt alone."""
        if self.pivot is None:
            inertias = np.array([self.mass, self.diametral_inertia]), np.array([0.0, self.polar_inertia])
        else:
            inertias = np.array([self.diametral_inertia + self.mass * self.pivot**2]), np.array([self.polar_inertia])
        return RotorMatrices(np.diag(inertias[0]), np.zeros((len(inertias[0]),) * 2), np.diag(inertias[1]))

    damping_rates = None

    @property
    def entries(self) -> Mapping[str, Any]:  # type: ignore[override]
        """Its numbers that are stated."""
        return {name: getattr(self, name) for name in RIGID_FIELDS if getattr(self, name) is not None}

    @cached_property
    def damping_matrix(self) -> np.ndarray:  # type: ignore[override]
        """Zeros: what damps it are its bearings."""
        return np.zeros_like(self.matrices.mass)

    @cached_property
    def free_modes(self) -> FreeModes:  # type: ignore[override]
        """Translation and tilt, or the tilt alone."""
        sizes = self.matrices.mass.diagonal()
        return FreeModes(np.zeros(len(sizes)), np.diag(1.0 / np.sqrt(sizes)))

    @cached_property
    def places(self) -> np.ndarray:  # type: ignore[override]
        """Where its stations, its centre of mass and its fixed point are, m."""
        return np.unique([*self.stations, 0.0, *([] if self.pivot is None else [self.pivot])])

    @cached_property
    def node_places(self) -> np.ndarray:  # type: ignore[override]
        """Its stations, m."""
        return np.array(self.stations)

    def place_of(self, node: int) -> int:
        """Number of the place of a station."""
        return int(np.searchsorted(self.places, self.stations[node]))

    def rows(self, along: np.ndarray) -> np.ndarray:
        """Displacement at places (k,) per coordinate, shape (k, n)."""
        if self.pivot is not None:
            return np.asarray(along - self.pivot)[:, None]
        return np.stack([np.ones(len(along)), along], axis=1)

    def row_at(self, node: int) -> np.ndarray:
        """Displacement at a station per coordinate."""
        row: np.ndarray = self.rows(self.node_places[node : node + 1])[0]
        return row

    def tilt_at(self, node: int) -> np.ndarray:
        """Tilt per coordinate, the same at all stations."""
        return np.eye(len(self.matrices.mass))[-1]

    def displacements(self, shapes: np.ndarray) -> np.ndarray:
        """Displacements at all places, shape (N, v), of shapes (n, v)."""
        return self.rows(self.places) @ shapes

    def carried(self, shapes: np.ndarray) -> np.ndarray:
        """See ``FreeRotor.carried``: of a rotor held at a point, what a force on all its masses does to the tilt."""
        return super().carried(shapes) if self.pivot is None else -self.mass * self.pivot * shapes[0]

    @property
    def translations(self) -> int:  # type: ignore[override]
        """How many of its free motions are translations."""
        return int(self.pivot is None)

    @property
    def words(self) -> str:  # type: ignore[override]
        """What it is, in a line."""
        held = "" if self.pivot is None else f", tilting about a point at {1e3 * self.pivot:.6g} mm"
        return f"rigid, {self.mass:.6g} kg, inertias {self.polar_inertia:.6g} kg m^2 (polar) and {self.diametral_inertia:.6g} kg m^2{held}"
