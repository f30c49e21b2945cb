"""Machines to test with, and the equations of a rotor in its clearance written down a second time.

Nothing here shares a formula with the package: the flight goes through matrix exponentials (in double precision or with
mpmath), the impact law through polar coordinates.
"""

from __future__ import annotations

import cmath
import math

import mpmath
import numba
import numpy as np
from scipy.linalg import expm

from carom import Parameters

COMPILED = not numba.config.DISABLE_JIT

PAPER = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
"""The machine of the source paper at a damping in the middle of its range."""


def fewer_without_compiler(count: int, share: float = 0.05) -> int:
    """Size of a test; a share of it where kernels run as plain Python."""
    return count if COMPILED else max(1, round(share * count))


def random_parameters(random: np.random.Generator, **fixed: float) -> Parameters:
    """Parameters all over the range of real machines and beyond; every tenth near critical damping."""
    omega = float(10 ** random.uniform(-1.3, 0.48))
    gamma = float(10 ** random.uniform(-1.7, 0.9))
    if random.random() < 0.1:
        gamma = 2.0 * omega * float(1.0 + random.choice([-1, 1]) * 10 ** random.uniform(-14, -1))
    drawn = {
        "gamma": gamma,
        "omega": omega,
        "rho": float(10 ** random.uniform(-1.5, 0.5)),
        "phi": float(random.uniform(-math.pi, math.pi)),
        "mu": float(random.choice([0.0, random.uniform(0.0, 0.5), random.uniform(0.0, 2.0)])),
        "d": float(random.choice([0.0, 1.0, *random.uniform(0.0, 1.0, 6)])),
        "radius_ratio": float(10 ** random.uniform(-1.5, 2.5)),
    }
    return Parameters(**{**drawn, **fixed})


# ------------------------------------------------------------------------------------------- flight and impact


def flight_matrix(parameters: Parameters) -> np.ndarray:
    """``A`` of ``(U, U̇)' = A (U − U*, U̇)``."""
    gamma, omega = parameters.gamma, parameters.omega
    return np.array([[0.0, 1.0], [-complex(omega**2 - 1.0, gamma), -complex(gamma, 2.0)]])


def rest_position(parameters: Parameters) -> complex:
    """Contact-free equilibrium ``U*``."""
    return cmath.rect(parameters.rho, parameters.phi) / complex(parameters.omega**2 - 1.0, parameters.gamma)


def fly(parameters: Parameters, position: complex, velocity: complex, time: float) -> tuple[complex, complex]:
    """State after a free flight, by the exponential of the matrix."""
    rest = rest_position(parameters)
    change, speed = expm(flight_matrix(parameters) * time) @ np.array([position - rest, velocity])
    return complex(rest + change), complex(speed)


def strike(
    parameters: Parameters, radial: float, angular: float, *, slip: int = 0, limited: bool = True
) -> tuple[float, float]:
    """Radial and angular speed after an impact at ``r = 1``.

    ``slip`` is the direction of the slip, by default that of ``s + 1 + θ̇``; unless ``limited`` friction may reverse it.
    """
    slip_speed = parameters.radius_ratio + 1.0 + angular
    friction = parameters.mu * (1.0 + parameters.d) * radial
    if limited:
        friction = min(friction, abs(slip_speed))
    direction = slip or math.copysign(1.0, slip_speed)
    return -parameters.d * radial, angular - direction * friction


def path(parameters: Parameters, position: complex, velocity: complex, times: np.ndarray) -> np.ndarray:
    """Positions along a free flight at all times, from the eigenvectors of the matrix (distinct eigenvalues)."""
    values, vectors = np.linalg.eig(flight_matrix(parameters))
    rest = rest_position(parameters)
    shares = np.linalg.solve(vectors, np.array([position - rest, velocity]))
    return rest + np.exp(np.multiply.outer(times, values)) @ (vectors[0] * shares)


# ------------------------------------------------------------------------------------------------ many digits


def exact_matrix(parameters: Parameters) -> mpmath.matrix:
    """``A`` with the parameters taken as exact numbers."""
    gamma, omega = mpmath.mpf(parameters.gamma), mpmath.mpf(parameters.omega)
    return mpmath.matrix([[0, 1], [-mpmath.mpc(omega**2 - 1, gamma), -mpmath.mpc(gamma, 2)]])


def exact_return(parameters: Parameters, period: float) -> tuple[mpmath.matrix, mpmath.matrix]:
    """``a(T) = (e^{−AT} − 1)⁻¹ = E(1 − E)⁻¹`` with ``E = e^{AT}``, and its derivative ``AE(1 − E)⁻²``."""
    matrix = exact_matrix(parameters)
    flown = mpmath.expm(matrix * mpmath.mpf(period))
    inverse = (mpmath.eye(2) - flown) ** -1
    return flown * inverse, matrix * flown * inverse * inverse
