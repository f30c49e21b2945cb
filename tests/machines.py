"""Machines to test with, and the equations of a rotor in its clearance written down a second time.

Nothing here shares a formula with the package: the flight goes through matrix exponentials (in double precision or with
mpmath), the impact law through polar coordinates.
"""

import cmath
import math
from pathlib import Path

import mpmath
import numpy as np
from scipy.linalg import expm

from carom.parameters import Machine, Parameters, Scales

PAPER = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
"""The machine of the source paper at a damping in the middle of its range."""
SCALES = Scales(50.0, 0.7e-3, 184.2)
"""Those of the machine of the examples."""
DECIMAL = {
    "gamma": "0.1",
    "omega": "0.76",
    "rho": "3/7",
    "phi": "0.21",
    "mu": "0.15",
    "d": "0.95",
    "radius_ratio": "400/7",
}
"""The same by the exact numbers of the paper."""


def machine_of(parameters: Parameters, scales: Scales | None = None) -> Machine:
    """The machine that has these numbers."""
    return REAL.replace(**vars(scales or parameters.scales), **parameters.as_dict())


def dimensionless(text: str) -> dict[str, str]:
    """A machine by its exact numbers in the order of their names."""
    return dict(zip(DECIMAL, text.split(), strict=True))


REAL = Machine(
    mass="50 kg",
    damping="1400 N s/m",
    stiffness="9.8e5 N/m",
    eccentricity="0.3 mm",
    clearance="0.7 mm",
    rotor_radius="40 mm",
    speed="184.2 rad/s",
    unbalance_phase="0.21 rad",
    friction=0.15,
    restitution=0.95,
)
"""The machine of the examples."""
LIGHT = Machine(
    mass="20 kg",
    damping="3000 N s/m",
    stiffness="8e6 N/m",
    eccentricity="5 um",
    clearance="0.2 mm",
    rotor_radius="30 mm",
    speed="9000 rpm",
    unbalance_phase=0.4,
    friction=0.15,
    restitution=0.9,
)
"""A compressor whose critical speed lies below its speed."""


def machine_file(name: str) -> Path:
    """Path of a machine file of the tests; those of all kinds of machines are in ``tests/machines``."""
    return Path(__file__).with_name("machine_files") / f"{name}.toml"


def machine_text(name: str) -> str:
    """What such a file says."""
    return machine_file(name).read_text(encoding="utf-8")


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


class ExactMotion:
    """Free flight with many digits, from the eigenvalues; for distinct ones."""

    def __init__(self, parameters: Parameters) -> None:
        gamma, omega = mpmath.mpf(parameters.gamma), mpmath.mpf(parameters.omega)
        root = mpmath.sqrt(mpmath.mpc(gamma**2 - 4 * omega**2, 0))
        self.parameters = parameters
        self.upper, self.lower = (-gamma - mpmath.mpc(0, 2) + root) / 2, (-gamma - mpmath.mpc(0, 2) - root) / 2
        self.rest = (
            mpmath.mpf(parameters.rho) * mpmath.expj(mpmath.mpf(parameters.phi)) / mpmath.mpc(omega**2 - 1, gamma)
        )

    def fly(self, position: mpmath.mpc, velocity: mpmath.mpc, time: mpmath.mpf) -> tuple[mpmath.mpc, mpmath.mpc]:
        """State after a flight."""
        change = position - self.rest
        first = (velocity - self.lower * change) / (self.upper - self.lower)
        parts = first * mpmath.exp(self.upper * time), (change - first) * mpmath.exp(self.lower * time)
        return self.rest + sum(parts), self.upper * parts[0] + self.lower * parts[1]

    def next_section(self, section: tuple, slip: int, duration: float) -> tuple:
        """From ``(θ, ṙ, θ̇)`` before an impact with unlimited friction to those at the wall after about ``duration``."""
        angle, radial, angular = section
        parameters = self.parameters
        friction = mpmath.mpf(parameters.mu) * (1 + mpmath.mpf(parameters.d)) * radial
        start = mpmath.expj(angle)
        after = mpmath.mpc(-mpmath.mpf(parameters.d) * radial, angular - slip * friction) * start
        time = mpmath.mpf(duration)
        for _ in range(60):
            position, velocity = self.fly(start, after, time)
            step = (abs(position) ** 2 - 1) / (2 * (mpmath.conj(position) * velocity).real)
            time -= step
            if abs(step) < mpmath.mpf(10) ** (-0.6 * mpmath.mp.dps):
                break
        position, velocity = self.fly(start, after, time)
        local = mpmath.conj(position) * velocity
        return mpmath.arg(position * mpmath.expj(-angle)) + angle, local.real, local.imag

    def jacobian(self, section: tuple[float, float, float], slip: int, duration: float) -> np.ndarray:
        """Derivative of :meth:`next_section` by central differences, exact to many more digits than a double."""
        step = mpmath.mpf(10) ** (-mpmath.mp.dps // 3)
        columns = []
        for k in range(3):
            ends = []
            for sign in (1, -1):
                moved = [mpmath.mpf(value) for value in section]
                moved[k] += sign * step
                ends.append(self.next_section(tuple(moved), slip, duration))
            columns.append([float((high - low) / (2 * step)) for high, low in zip(*ends, strict=True)])
        return np.array(columns).T
