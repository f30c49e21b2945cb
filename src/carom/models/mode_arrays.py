"""The modes and contact planes of a rotor as arrays for the kernels, and what follows from these alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from carom.base.results import Result
from carom.core.flow import fly_all
from carom.core.table import flight_table
from carom.core.wall import Wall

TABLES = 32
"""Number of tables kept."""
STEADY, TURN = -1j, -2j
"""Exponents of a force that is constant in the fixed frame, and of the turn ``τ`` of anisotropic bearings (:mod:`carom.models.linear_system`)."""
EQUAL = 1e-12
"""Distance of exponents, relative to one plus their size, below which they are one number."""


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
class ModeArrays(Result):
    """Modes and contact planes of a rotor, as arrays for the kernels: free flight, and where the planes are.

    Attributes
    ----------
    arrays : numpy.record
        Of :func:`~carom.core.layout.rotor_record`, with ``N`` modes, ``2n`` of them free, and ``P`` contact planes.  Its fields as
        attributes take four times as long as in brackets.
    """

    arrays: np.record

    @cached_property
    def table(self) -> np.record:
        """Constants of the certified crossing search (:func:`~carom.core.table.flight_table`).

        Rotors with the same modes, such as all with the same damping and stiffness, share them.
        """
        return _table(self.arrays["exponents"].tobytes(), self.arrays["driven"].tobytes())

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """The contact planes."""
        arrays = self.arrays
        walls = map(Wall, *(arrays[name].tolist() for name in Wall._fields))
        rows = arrays["rows"], arrays["rate_rows"], arrays["columns"].T
        return tuple(map(Contact, arrays["offsets"].tolist(), *rows, walls))

    @property
    def modes(self) -> int:
        """Number ``N`` of amplitudes."""
        return len(self.arrays["exponents"])

    @property
    def limits(self) -> int:
        """Number of quantities of controllers that have limits."""
        return len(self.arrays["limit_bounds"])

    @cached_property
    def free(self) -> np.ndarray:
        """Which modes are free, shape (N,)."""
        return np.asarray(self.arrays["free"], bool)

    @cached_property
    def exponents(self) -> np.ndarray:
        """Exponents ``λ`` of the free modes, shape (2n,)."""
        exponents = np.asarray(self.arrays["exponents"])
        return exponents if self.free.all() else exponents[self.free]

    @property
    def decay(self) -> float:
        """Rate at which the slowest free mode decays, in ``Ω``; negative if one grows."""
        return -float(self.exponents.real.max())

    @cached_property
    def generator(self) -> np.ndarray:
        """Matrix ``M`` of flight ``ċ = M c``, shape (N, N)."""
        return np.diag(self.arrays["exponents"]) + np.diag(self.arrays["driven"][1:].astype(complex), -1)

    @property
    def _steady(self) -> np.ndarray:
        """Which modes do not change in the fixed frame, shape (N,)."""
        steady: np.ndarray = np.abs(self.arrays["exponents"] - STEADY) <= EQUAL
        return steady

    @cached_property
    def is_planar(self) -> bool:
        """Whether it is a :func:`second_order_system` inside a rigid wall: lanes and the closing of orbits are made for these."""
        arrays = self.arrays
        return (
            arrays["columns"].tolist() == [[1.0], [0.0]]
            and arrays["rows"].tolist() == [[0.0, 1.0]]
            and bool(arrays["driven"][1])
            and arrays["law"].tolist() == [0]
            and not self.limits
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
