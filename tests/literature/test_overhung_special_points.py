"""Folds and doublings of the overhung rotor in a frictionless ring, found again by an integrator that shares nothing with the package.

SciPy's DOP853 with events at the ring, and central differences.  Where the package has a point, its path must be closed and critical; published values (Zilli, Williams and Ewins 2015) are of a ring with a smoothed edge.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

ROTOR, POLAR, DAMPING, RING, UNBALANCE = 0.9, 0.143, 0.01, 10.0, 0.9 * 0.353

DOUBLINGS = {
    3.4210824176056382: (
        2.9580143859590224,
        [-0.4747484752251466, -0.0009787758380968166, 0.0017890271802735, -0.8677553050457031],
    ),
    4.861959820878909: (
        2.048084389938681,
        [-0.5279703725394563, 5.571099210489249e-05, -0.00015961258143346453, -1.512640699744904],
    ),
    4.269006290377903: (
        3.0534629049984487,
        [-0.47707150571888507, 0.3759308301617427, -0.9819239486717112, -1.2461014076733545],
    ),
}
FOLDS = {
    6.1657969800387455: (
        2.1575372931545687,
        [0.24903869220108596, 0.5504727920904856, -6.04287077914208, 2.7338474445987253],
    ),
}
"""Speed of each point in docs/theory/walls-that-give-way.md: period and state (place, velocity) in the rotor's own time.

The folds at 3.354404 and 2.745399 lie 1e-5 and 1e-6 beside a grazing, nearer than differences can tell.
"""


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


def bordered(speed, state, period):
    """Derivative of what has to vanish for a closed path that begins where the radius is least, by state and period; and that of the flow."""
    derivative, step = slopes(speed, state, period), 1e-6
    matrix = np.zeros((5, 5))
    matrix[:4, :4] = derivative - np.eye(4)
    matrix[:4, 4] = (flow(speed, state, period + step) - flow(speed, state, period - step)) / (2.0 * step)
    matrix[4, :4] = [*state[2:], *state[:2]]
    return matrix, derivative


@pytest.mark.parametrize("speed", [*DOUBLINGS, *FOLDS])
def test_folds_and_doublings(speed):
    """A multiplier of minus one; or a direction in which the closed path may change at one speed: the equations are singular."""
    period, state = (DOUBLINGS | FOLDS)[speed]
    state = np.array(state)
    assert np.abs(flow(speed, state, period) - state).max() < 1e-8
    matrix, derivative = bordered(speed, state, period)
    singular = np.linalg.svd(matrix)[1]
    if speed in DOUBLINGS:
        assert np.abs(np.linalg.eigvals(derivative) + 1.0).min() < 1e-5
        assert singular[-1] > 1e-2 * singular[-2]
    else:
        assert singular[-1] < 1e-6 * singular[-2]
