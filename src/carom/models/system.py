"""A linear rotor as arrays for the kernels, and the conversion between states and mode amplitudes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from carom.arguments import checked
from carom.core.flow import fly_all
from carom.core.layout import rotor_record
from carom.core.table import flight_table
from carom.core.wall import Wall
from carom.results import Result

TABLES = 32
"""Number of tables kept."""
ROUNDING = 1e-12
"""Share of the sum of moduli below which the sum counts as zero."""


class Contact(NamedTuple):
    """A contact plane and the numbers of its wall: the fields of :func:`~carom.core.layout.rotor_record` for one plane.

    Each access to a field of the record takes as long as a small kernel.
    """

    offset: complex
    row: np.ndarray
    rate_row: np.ndarray
    column: np.ndarray
    wall: Wall

    def local(self, amplitudes: np.ndarray) -> tuple[complex, complex]:
        """Direction of the displacement, and the velocity ``ṙ + iθ̇`` in the frame of the contact."""
        position = complex(amplitudes @ self.row) + self.offset
        position /= abs(position)
        return position, position.conjugate() * complex(amplitudes @ self.rate_row)


@dataclass(frozen=True, eq=False, repr=False)
class System(Result):
    """Modes, contact planes and contact law of a rotor, as arrays for the kernels.

    A state consists of the ``n`` coordinates of the rotor and their rates; for a rotor with one coordinate they are
    plain numbers.  Lengths are in clearances ``c_r``, times in ``1/Ω``, in the frame that turns with the shaft.

    Attributes
    ----------
    arrays : numpy.record
        Of :func:`~carom.core.layout.rotor_record`, with ``N = 2n`` modes and ``P`` contact planes.  Its fields as attributes take four
        times as long as in brackets.
    rest : ndarray of complex, shape (n,)
        Coordinates at the contact-free equilibrium.
    shapes : ndarray of complex, shape (n, N)
        Coordinates per amplitude.
    inverse : ndarray of complex, shape (N, 2n), optional
        Amplitudes per coordinate, then per rate of a coordinate; computed from ``shapes`` by default.
    translation : ndarray of complex, shape (n,), optional
        Change of the coordinates when the rotor as a whole is displaced by one; ones by default.
    """

    arrays: np.record
    rest: np.ndarray
    shapes: np.ndarray
    inverse: np.ndarray | None = None
    translation: np.ndarray | None = None

    @cached_property
    def table(self) -> np.record:
        """Constants of the certified crossing search (:func:`~carom.core.layout.table_record`).

        Rotors with the same modes, such as all with the same damping and stiffness, share them.
        """
        return _table(self.exponents.tobytes(), self.arrays["driven"].tobytes())

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """The contact planes."""
        arrays = self.arrays
        walls = map(Wall, *(arrays[name].tolist() for name in Wall._fields))
        rows = arrays["rows"], arrays["rate_rows"], arrays["columns"].T
        return tuple(map(Contact, arrays["offsets"].tolist(), *rows, walls))

    @cached_property
    def exponents(self) -> np.ndarray:
        """Exponents ``λ`` of free flight, shape (N,)."""
        return np.asarray(self.arrays["exponents"])

    @cached_property
    def generator(self) -> np.ndarray:
        """Matrix ``M`` of free flight ``ċ = M c``, shape (N, N)."""
        return np.diag(self.exponents) + np.diag(self.arrays["driven"][1:].astype(complex), -1)

    @property
    def rates(self) -> np.ndarray:
        """Rates of the coordinates per amplitude, shape (n, N)."""
        return self.basis[len(self.rest) :]

    @cached_property
    def basis(self) -> np.ndarray:
        """Coordinates, then their rates, per amplitude, shape (2n, N)."""
        n = len(self.rest)
        basis = np.empty((2 * n, self.shapes.shape[1]), complex)
        basis[:n], basis[n:] = self.shapes, self.shapes * self.exponents
        basis[n:, :-1] += self.shapes[:, 1:] * self.arrays["driven"][1:]
        return basis

    @cached_property
    def to_modes(self) -> np.ndarray:
        """Amplitudes per coordinate, then per rate of a coordinate, shape (N, 2n)."""
        return np.linalg.inv(self.basis) if self.inverse is None else self.inverse

    @cached_property
    def _whole_rest(self) -> np.ndarray:
        whole = np.zeros(2 * len(self.rest), complex)
        whole[: len(self.rest)] = self.rest
        return whole

    @cached_property
    def coordinates(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """``basis``, ``to_modes`` and the state (2n,) at rest, as the kernels take them."""
        return self.basis, np.ascontiguousarray(self.to_modes), self._whole_rest

    def amplitudes_of(self, states: np.ndarray) -> np.ndarray:
        """Mode amplitudes of states (m, 2n), each the coordinates and then their rates; shape (m, N)."""
        found: np.ndarray = np.einsum("nk,mk->mn", self.to_modes, states - self._whole_rest)
        return found

    def states_of(self, amplitudes: np.ndarray) -> np.ndarray:
        """States of mode amplitudes, the inverse of :meth:`amplitudes_of`."""
        found: np.ndarray = np.einsum("nk,mk->mn", self.basis, amplitudes) + self._whole_rest
        return found

    def amplitudes(self, position: complex | np.ndarray, velocity: complex | np.ndarray) -> np.ndarray:
        """Mode amplitudes of a state, shape (N,).

        Parameters
        ----------
        position, velocity : complex, or ndarray of complex, shape (n,)
            Coordinates and their rates.
        """
        return self.amplitude_change(position - (self.rest if len(self.rest) > 1 else self.rest[0]), velocity)

    def amplitude_change(
        self, position_change: complex | np.ndarray, velocity_change: complex | np.ndarray
    ) -> np.ndarray:
        """Change of the mode amplitudes, shape (N,), that corresponds to a change of state of any size."""
        change = np.array([position_change, velocity_change]).ravel()
        # Not a matrix product: the threads of the linear algebra library cost far more than these few numbers.
        changes: np.ndarray = np.einsum("nk,k->n", self.to_modes, change)
        return changes

    def state(self, amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position and velocity for mode amplitudes of shape (..., N), each of shape (..., n); (...) if ``n = 1``."""
        if len(self.rest) == 1:
            position = np.einsum("...k,k->...", amplitudes, self.shapes[0]) + self.rest[0]
            return position, np.einsum("...k,k->...", amplitudes, self.rates[0])
        position = np.einsum("...k,nk->...n", amplitudes, self.shapes) + self.rest
        return position, np.einsum("...k,nk->...n", amplitudes, self.rates)

    def kicked(self, push: complex | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and their rates, both (..., n), just after the levitating rotor gets velocities (...) as a whole."""
        velocities = np.multiply.outer(push, self.translated)
        return np.broadcast_to(self.rest, velocities.shape), velocities

    def translation_velocity(self, velocities: np.ndarray) -> np.ndarray:
        """Velocities (...) of the rotor as a whole from the rates (..., n) of the coordinates: the inverse of :meth:`kicked`."""
        if self.translation is None:
            return velocities
        moves = self.translation if len(self.rest) > 1 else self.translation[0]
        pushes: np.ndarray = np.dot(velocities, moves.conj()) / np.vdot(moves, moves)
        return pushes

    @property
    def translated(self) -> np.ndarray:
        """Coordinates when the rotor as a whole is displaced by one, shape (n,)."""
        return np.ones(len(self.rest)) if self.translation is None else self.translation

    @cached_property
    def planes(self) -> np.ndarray:
        """Displacement of each contact plane per coordinate, shape (P, n)."""
        planes: np.ndarray = self.arrays["rows"] @ self.to_modes[:, : len(self.rest)]
        return planes

    @property
    def rest_radius(self) -> float:
        """Largest distance of a contact plane from its centre at the contact-free equilibrium: there is levitation below 1."""
        return float(np.abs(self.arrays["offsets"]).max())

    @cached_property
    def planes_translated(self) -> np.ndarray:
        """Distance by which each contact plane moves when the rotor as a whole is displaced by one, shape (P,)."""
        distances: np.ndarray = np.abs(self.planes @ self.translated)
        distances[distances <= ROUNDING * (np.abs(self.planes) @ np.abs(self.translated))] = 0.0
        return distances

    @cached_property
    def base_excitation(self) -> np.ndarray:
        """Rates of change of the amplitudes when all masses are accelerated by one along the translation, shape (N,)."""
        rates: np.ndarray = self.to_modes[:, len(self.rest) :] @ self.translated
        return rates

    @cached_property
    def is_planar(self) -> bool:
        """Whether it is a :func:`second_order_system` inside a rigid wall: lanes and the closing of orbits are made for these."""
        arrays = self.arrays
        return (
            arrays["columns"].tolist() == [[1.0], [0.0]]
            and arrays["rows"].tolist() == [[0.0, 1.0]]
            and bool(arrays["driven"][1])
            and arrays["law"].tolist() == [0]
        )

    def at_planes(self, amplitudes: np.ndarray, planes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Displacement and its rate, shape (m,), for each of the mode amplitudes (m, N) at its own contact plane."""
        arrays = self.arrays
        position = np.einsum("mk,mk->m", amplitudes, arrays["rows"][planes]) + arrays["offsets"][planes]
        return position, np.einsum("mk,mk->m", amplitudes, arrays["rate_rows"][planes])

    def at_plane(self, amplitudes: np.ndarray, plane: int) -> tuple[np.ndarray, np.ndarray]:
        """Displacement of a contact plane and its rate for mode amplitudes of shape (..., N), each of shape (...)."""
        arrays = self.arrays
        position = np.einsum("...k,k->...", amplitudes, arrays["rows"][plane]) + arrays["offsets"][plane]
        return position, np.einsum("...k,k->...", amplitudes, arrays["rate_rows"][plane])

    def fly(self, amplitudes: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Mode amplitudes after free flights, shape (..., N).

        Parameters
        ----------
        amplitudes : ndarray of complex, shape (..., N)
        times : array_like, shape (...)
        """
        times = np.asarray(times, float)
        starts = np.broadcast_to(amplitudes, (*times.shape, amplitudes.shape[-1]))
        flown: np.ndarray = fly_all(self.arrays, starts.reshape(-1, starts.shape[-1]), times.ravel())
        return flown.reshape(starts.shape)


@lru_cache(TABLES)
def _table(exponents: bytes, driven: bytes) -> np.record:
    return flight_table(np.frombuffer(exponents, np.complex128), np.frombuffer(driven, np.int8))


def walls_as_arrays(walls: Sequence[Wall]) -> dict[str, np.ndarray]:
    """The fields of :func:`~carom.core.layout.rotor_record` for the walls at its planes."""
    return dict(zip(Wall._fields, np.array(walls, float).T, strict=True))


@checked
def second_order_system(
    *,
    exponents: tuple[complex, complex],
    equilibrium: complex,
    wall: Wall,
    mass: float = 1.0,
) -> System:
    """System of ``ü + αu̇ + βu = Γ`` with one coordinate ``u``, which is also its displacement at the wall.

    Its two modes are a pair: the driving amplitude ``b = u̇ − λ₊(u − K)``, which decays with ``λ₋``, and the driven
    ``a = u − K``.  So underdamped, critically damped and overdamped rotors are treated alike.

    Parameters
    ----------
    exponents : tuple of complex
        Roots ``λ₋, λ₊`` of ``λ² + αλ + β``, the one with the smaller real part first.
    equilibrium : complex
        ``K = Γ/β``.
    wall : carom.core.wall.Wall
    mass : float
        Effective mass at the wall, in the unit of masses.
    """
    offsets, rows = np.array([equilibrium], np.complex128), np.array([[0.0, 1.0]], np.complex128)
    arrays = rotor_record(
        exponents=np.array(exponents, np.complex128),
        driven=np.array([False, True]),
        offsets=offsets,
        rows=rows,
        columns=np.array([[1.0], [0.0]], np.complex128),
        **walls_as_arrays([wall]),
        masses=np.array([mass]),
    )
    return System(arrays, offsets, rows, np.array([[-exponents[1], 1.0], [1.0, 0.0]], np.complex128))
