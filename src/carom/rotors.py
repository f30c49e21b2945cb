"""Rotors: from parameters to the arrays that the kernels see."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from carom.core.flow import fly_all
from carom.core.layout import rotor_record
from carom.core.planar import planar_exponents
from carom.core.table import flight_table
from carom.outcome import InputError
from carom.parameters import Parameters, Scales

if TYPE_CHECKING:
    from carom.parameters import Machine

__all__ = ["LinearRotor", "Rotor", "generator_of", "jeffcott", "second_order_record"]


class LinearRotor(Protocol):
    """What the conditions of periodic orbits need to know of a rotor."""

    @property
    def arrays(self) -> np.record:
        """Modes, contact planes and contact law (:func:`~carom.core.layout.rotor_record`)."""

    @property
    def generator(self) -> np.ndarray:
        """Matrix ``M`` of free flight ``ċ = M c``, shape (N, N)."""


@dataclass(frozen=True, eq=False)
class Rotor:
    """The planar rotor inside a circular clearance, ready for the kernels: two modes that are a pair, one contact plane.

    Lengths are in clearances ``c_r``, times in ``1/Ω``, in the frame that turns with the shaft.  The kernels take any number of
    modes and planes; what is found out about a rotor in Python holds for this one, so there is no other.

    Attributes
    ----------
    arrays : numpy.record
        Modes, contact plane and contact law (:func:`~carom.core.layout.rotor_record`).
    parameters : Parameters
        The dimensionless parameters it was made from.

    Raises
    ------
    InputError
        The arrays are those of another rotor.
    """

    arrays: np.record
    parameters: Parameters

    def __post_init__(self) -> None:
        arrays = self.arrays
        planes, modes = arrays.rows.shape
        pair = (modes, planes) == (2, 1) and tuple(arrays.driven) == (0, 1)
        if not pair or tuple(arrays.rows[0]) != (0.0, 1.0) or tuple(arrays.columns[:, 0]) != (1.0, 0.0):
            given = f"{modes} modes and {planes} contact planes"
            given += ", not as of a planar rotor" if (modes, planes) == (2, 1) else ""
            raise InputError(
                "rotor", given, "2 modes that are a pair and 1 contact plane are handled, as carom.jeffcott makes them"
            )

    @cached_property
    def table(self) -> np.record:
        """Constants of the certified crossing search (:func:`~carom.core.layout.table_record`)."""
        return flight_table(self.arrays.exponents, self.arrays.driven)

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that turn results into SI units, if known."""
        return self.parameters.scales

    @property
    def equilibrium(self) -> complex:
        """Contact-free equilibrium position ``U*``; it may lie outside the clearance."""
        return complex(self.arrays.offsets[0])

    @property
    def eigenvalues(self) -> np.ndarray:
        """Exponents ``λ`` of free flight, shape (2,)."""
        return self.arrays.exponents

    @property
    def generator(self) -> np.ndarray:
        """Matrix ``M`` of free flight ``ċ = M c``, shape (2, 2)."""
        return generator_of(self.arrays)

    def amplitudes(self, position: complex, velocity: complex) -> np.ndarray:
        """Mode amplitudes of a state.

        Parameters
        ----------
        position, velocity : complex
            ``U`` and ``U̇`` in the co-rotating frame.

        Returns
        -------
        ndarray of complex, shape (2,)
            The driving amplitude ``b = U̇ − λ₊(U − U*)``, which decays with ``λ₋``, and the driven ``a = U − U*``.
        """
        return self.amplitude_change(position - self.equilibrium, velocity)

    def amplitude_change(self, position_change: complex, velocity_change: complex) -> np.ndarray:
        """Change of the mode amplitudes, shape (2,), that goes with a small or large change of state."""
        return np.array([velocity_change - self.arrays.exponents[1] * position_change, position_change], complex)

    def state(self, amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position and velocity of mode amplitudes, shape (..., 2), each of shape (...)."""
        # Not a matrix product: threads of the linear algebra library cost far more than these few numbers a state.
        position = np.einsum("...k,k->...", amplitudes, self.arrays.rows[0]) + self.arrays.offsets[0]
        return position, np.einsum("...k,k->...", amplitudes, self.arrays.rate_rows[0])

    def fly(self, amplitudes: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Mode amplitudes after free flights.

        Parameters
        ----------
        amplitudes : ndarray of complex, shape (..., N)
        times : array_like, shape (...)

        Returns
        -------
        ndarray of complex, shape (..., N)
        """
        times = np.asarray(times, float)
        starts = np.broadcast_to(amplitudes, (*times.shape, amplitudes.shape[-1]))
        flown: np.ndarray = fly_all(self.arrays, starts.reshape(-1, starts.shape[-1]), times.ravel())
        return flown.reshape(starts.shape)


def jeffcott(machine: Parameters | Machine) -> Rotor:
    """Rigid rotor on a linear isotropic bearing inside a circular clearance (Föppl–Jeffcott rotor).

    In the co-rotating frame ``Ü + (γ + 2i)U̇ + (ω² − 1 + iγ)U = ρe^{iφ}`` [1]_ (2.13), with the exponents
    ``λ± = (−γ − 2i ± √(γ² − 4ω²))/2``.  The two modes are a pair (see :func:`~carom.core.layout.rotor_record`), so any
    damping is treated alike: underdamped, critical and overdamped.

    Parameters
    ----------
    machine : Parameters or Machine

    Returns
    -------
    Rotor

    References
    ----------
    .. [1] Mora, Budd, Glendinning, Keogh, "Non-smooth Hopf-type bifurcations arising from impact–friction contact
       events in rotating machinery", Proc. R. Soc. A 470 (2014).
    """
    parameters = machine if isinstance(machine, Parameters) else machine.parameters
    gamma, omega = parameters.gamma, parameters.omega
    arrays = second_order_record(
        exponents=planar_exponents(gamma, omega),
        # The sum makes a negative zero, the quotient of a balanced rotor, plain zero.
        equilibrium=cmath.rect(parameters.rho, parameters.phi) / complex(omega**2 - 1.0, gamma) + 0j,
        friction=parameters.mu,
        restitution=parameters.d,
        drive=parameters.radius_ratio + 1.0,
    )
    return Rotor(arrays, parameters)


def second_order_record(
    *,
    exponents: tuple[complex, complex],
    equilibrium: complex,
    friction: float,
    restitution: float,
    drive: float,
) -> np.record:
    """Arrays of ``ü + αu̇ + βu = Γ``, whose displacement at the wall is ``u`` itself.

    Parameters
    ----------
    exponents : tuple of complex
        Roots ``λ₋, λ₊`` of ``λ² + αλ + β``, the one with the smaller real part first.
    equilibrium : complex
        ``Γ/β``.
    friction, restitution, drive : float
        As in :func:`~carom.core.layout.rotor_record`.
    """
    return rotor_record(
        exponents=np.array(exponents, np.complex128),
        driven=np.array([False, True]),
        offsets=np.array([equilibrium], np.complex128),
        rows=np.array([[0.0, 1.0]], np.complex128),
        columns=np.array([[1.0], [0.0]], np.complex128),
        friction=np.array([friction]),
        restitution=np.array([restitution]),
        drive=np.array([drive]),
    )


def generator_of(arrays: np.record) -> np.ndarray:
    """Matrix ``M`` of free flight ``ċ = M c`` of these modes, shape (N, N)."""
    return np.diag(arrays.exponents) + np.diag(arrays.driven[1:].astype(complex), -1)
