"""A rotor of two coupled coordinates on the wall, against its equations in many digits."""

import cmath

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from sliding import BACKWARD, FORWARD, ROLLING, SIGN

from carom.core.contact_series import rub_series
from carom.core.flow import displacement, velocity
from carom.core.layout import ORDER, rotor_record, rub_workspace
from carom.core.rub import rest_on_wall
from carom.core.taylor import series_step, sum_series


class CoupledRotor:
    """Two coupled complex coordinates ``q̈ = −Dq̇ − Kq + f + bF`` with contact at ``y = w·q``: four modes, one plane."""

    def __init__(self, seed: int, friction: float, surface_speed: float) -> None:
        random = np.random.default_rng(seed)

        def noise(size):
            return random.normal(size=size) + 1j * random.normal(size=size)

        self.damping = 0.2 * np.eye(2) + 2j * np.eye(2) + 0.1 * noise((2, 2))
        self.stiffness = np.diag([-0.4, 3.0]) + 0.3 * noise((2, 2))
        self.load = 0.5 * noise(2)
        self.row = np.array([1.0, 0.4 + 0.1j])
        self.column = np.array([0.8, 0.3 - 0.2j])
        self.column = self.column / (self.row @ self.column)
        self.friction, self.surface_speed = friction, surface_speed
        rest = np.linalg.solve(self.stiffness, self.load)
        matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-self.stiffness, -self.damping]])
        exponents, vectors = np.linalg.eig(matrix)
        self.rest, self.inverse = rest, np.linalg.inv(vectors)
        self.arrays = rotor_record(
            exponents=exponents,
            driven=np.zeros(4, bool),
            offsets=np.array([self.row @ rest]),
            rows=(self.row @ vectors[:2])[None],
            columns=self.inverse @ np.concatenate([np.zeros(2), self.column])[:, None],
            friction=np.array([friction]),
            restitution=np.array([0.5]),
            surface_speed=np.array([surface_speed]),
        )

    def start(self, angle: float, rate: float) -> np.ndarray:
        """A state on the wall with given rate along it."""
        position = cmath.rect(1.0, angle)
        first = np.array([position - self.row[1] * (0.2 - 0.1j), 0.2 - 0.1j])
        speed = np.array([1j * rate * position - self.row[1] * (-0.1 + 0.3j), -0.1 + 0.3j])
        return np.concatenate([first, speed])

    def amplitudes(self, state: np.ndarray) -> np.ndarray:
        return self.inverse @ (state - np.concatenate([self.rest, np.zeros(2)]))

    def push(self, state: np.ndarray) -> float:
        position, speed = self.row @ state[:2], self.row @ state[2:]
        free = self.row @ (self.load - self.stiffness @ state[:2] - self.damping @ state[2:])
        return float((position.conjugate() * free).real + abs(speed) ** 2)

    def motion(self, _: float, state: np.ndarray, sign: int) -> np.ndarray:
        """Equations of index 1: the multiplier is the force that keeps ``d²|y|²/dt²`` zero."""
        free = self.load - self.stiffness @ state[:2] - self.damping @ state[2:]
        position = self.row @ state[:2]
        if sign == 0:
            force = -(self.surface_speed**2) * position - self.row @ free
        else:
            force = -complex(1.0, sign * self.friction) * self.push(state) * position
        return np.concatenate([state[2:], free + self.column * force])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("phase", [FORWARD, BACKWARD, ROLLING])
def test_a_rotor_of_four_modes_stays_on_the_wall(seed, phase):
    sign = {**SIGN, ROLLING: 0}[phase]
    rotor = CoupledRotor(seed, friction=0.2, surface_speed=3.0)
    state = rotor.start(0.3, {FORWARD: 2.5, BACKWARD: -7.0, ROLLING: -3.0}[phase])
    amplitudes, work, time = rotor.amplitudes(state), rub_workspace(4), 0.0
    for _ in range(12):
        rub_series(rotor.arrays, np.array([phase]), amplitudes, work)
        step = series_step(work)
        push = work.push[0] @ step ** np.arange(ORDER + 1)
        sum_series(work, step, amplitudes)
        rest_on_wall(rotor.arrays, 0, amplitudes, phase == ROLLING)
        time += step
    expected = solve_ivp(rotor.motion, (0.0, time), state, "DOP853", args=(sign,), rtol=1e-13, atol=1e-13).y[:, -1]
    position, speed = displacement(rotor.arrays, 0, amplitudes), velocity(rotor.arrays, 0, amplitudes)
    assert abs(abs(position) - 1.0) < 4e-15
    assert abs((position.conjugate() * speed).real) < 1e-14
    assert position == pytest.approx(rotor.row @ expected[:2], abs=1e-10)
    assert speed == pytest.approx(rotor.row @ expected[2:], abs=1e-9)
    assert np.abs(amplitudes - rotor.amplitudes(expected)).max() < 1e-9
    assert push == pytest.approx(rotor.push(expected), abs=1e-9)
