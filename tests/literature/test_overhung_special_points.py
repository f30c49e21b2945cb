"""Folds and doublings of the overhung rotor in a frictionless ring, found again by an integrator that shares nothing with the package.

SciPy's DOP853 with events at the ring, Newton's method with central differences, and the multipliers of the closed paths.  Where the package
has a point, the same point must be found; published values (Zilli, Williams and Ewins 2015) are of a ring with a smoothed edge.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

ROTOR, POLAR, DAMPING, RING, UNBALANCE = 0.9, 0.143, 0.01, 10.0, 0.9 * 0.353

DOUBLINGS = {
    3.421082: (2.958014, [-0.527498, -0.001088, 0.001988, -0.964173]),
    4.861960: (2.048084, [-0.586634, 0.000062, -0.000177, -1.680712]),
    4.269006: (3.053463, [-0.530079, 0.417701, -1.091027, -1.384557]),
}
FOLDS = {
    6.165797: (2.157537, [0.276710, 0.611636, -6.714301, 3.037608]),
    2.745399: (4.840737, [-0.595346, 0.211800, -0.273120, -0.767709]),
}
"""Speed of each point in docs/theory/walls-that-give-way.md: period and state (place, velocity) in the rotor's own time."""


def flow(speed, state, duration):
    """End of a motion; the ring begins and ends to act at events."""
    y, t = np.array(state, float), 0.0
    inside = np.hypot(*y[:2]) > 1.0
    while True:

        def rates(_, y, inside=inside):
            z, w = complex(*y[:2]), complex(*y[2:])
            a = 1j * speed * (POLAR - 2.0) * w - 2.0 * DAMPING * w + UNBALANCE * speed**2
            a += (speed**2 * (1.0 - POLAR) - 1.0 - 2j * DAMPING * speed) * z
            a -= RING * (1.0 - 1.0 / abs(z)) * z if inside else 0.0
            return [w.real, w.imag, a.real, a.imag]

        def ring(_, y):
            return np.hypot(y[0], y[1]) - 1.0

        ring.terminal, ring.direction = True, -1.0 if inside else 1.0
        found = solve_ivp(rates, (t, duration), y, "DOP853", rtol=1e-11, atol=1e-13, events=ring)
        y, t = found.y[:, -1].copy(), found.t[-1]
        if found.status != 1:
            return y
        inside = not inside
        y[:2] *= (1.0 + (1e-13 if inside else -1e-13)) / np.hypot(*y[:2])


def slopes(speed, y, period, step=1e-6):
    sides = step * np.eye(4)
    return np.array([(flow(speed, y + s, period) - flow(speed, y - s, period)) / (2.0 * step) for s in sides]).T


def close(speed, y, period):
    """Closed path next to a guess, with its derivative: it begins where the radius is least."""
    y = np.array(y, float)
    for _ in range(12):
        end = flow(speed, y, period)
        missing = np.append(end - y, y[:2] @ y[2:])
        derivative = slopes(speed, y, period)
        if np.abs(missing).max() < 1e-9:
            return y, period, derivative
        matrix = np.zeros((5, 5))
        matrix[:4, :4] = derivative - np.eye(4)
        matrix[:4, 4] = (flow(speed, y, period + 1e-6) - flow(speed, y, period - 1e-6)) / 2e-6
        matrix[4, :4] = [*y[2:], *y[:2]]
        change = np.linalg.solve(matrix, -missing)
        y, period = y + change[:4], period + change[4]
    raise AssertionError(f"no closed path at the speed {speed}")


@pytest.mark.parametrize("speed", DOUBLINGS)
def test_doublings(speed):
    period, state = DOUBLINGS[speed]
    values = []
    for there in (speed - 1e-4, speed + 1e-4):
        _, _, derivative = close(there, state, period)
        values.append(np.linalg.det(derivative + np.eye(4)))
    assert values[0] * values[1] < 0.0
    share = values[0] / (values[0] - values[1])
    assert speed - 1e-4 + 2e-4 * share == pytest.approx(speed, abs=2e-6)


@pytest.mark.parametrize("speed", FOLDS)
def test_folds(speed):
    """Beside a fold there are two orbits; the square of the difference of their periods vanishes at it."""
    period, state = FOLDS[speed]
    side = -1.0 if speed > 5.0 else 1.0
    # The direction in which the path may change without opening.
    derivative = slopes(speed, np.array(state), period)
    matrix = np.zeros((5, 5))
    matrix[:4, :4] = derivative - np.eye(4)
    matrix[:4, 4] = (flow(speed, state, period + 1e-6) - flow(speed, state, period - 1e-6)) / 2e-6
    matrix[4, :4] = [*state[2:], *state[:2]]
    free = np.linalg.svd(matrix)[2][-1]
    gaps = []
    for near in (1e-5, 2e-5):
        both = [
            close(speed + side * near, np.array(state) + s * free[:4], period + s * free[4])[1] for s in (0.005, -0.005)
        ]
        gaps.append((both[0] - both[1]) ** 2)
    assert min(gaps) > 1e-10
    assert speed + side * 1e-5 * (1.0 - gaps[0] / (gaps[1] - gaps[0])) == pytest.approx(speed, abs=2e-6)
