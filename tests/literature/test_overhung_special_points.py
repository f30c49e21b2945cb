"""Folds and doublings of the overhung rotor in a frictionless ring, found again by an integrator that shares nothing with the package.

SciPy's DOP853 with events at the ring and exact variational equations: the force of the ring begins at zero, so that derivatives pass its edge
without a jump.  Where the package has a point, its path must be closed and critical; published values (Zilli, Williams and Ewins 2015) are of a ring with a smoothed edge.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

POLAR, DAMPING, RING, UNBALANCE = 0.143, 0.01, 10.0, 0.9 * 0.353

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
    3.3544041104194184: (
        3.0228693476269424,
        [-0.46992211753565943, 0.0020677643619833722, -0.0036727912384240512, -0.8346820690782534],
    ),
    2.745398934885404: (
        4.840736924582527,
        [-0.5358110635317807, 0.1906196909425109, -0.24580763987569265, -0.6909383406027721],
    ),
}
"""Speed of each point in docs/theory/compliant-bearings.md: period and state (place, velocity) in the rotor's own time."""


def real(number):
    """Multiplication by a complex number."""
    return np.array([[number.real, -number.imag], [number.imag, number.real]])


def rates_of(speed, inside):
    """Rates of the state, of its derivative by the start (4, 4) and by the speed (4,), all in one vector."""
    free, by_speed, force = np.zeros((4, 4)), np.zeros((4, 4)), np.zeros(4)
    free[:2, 2:] = np.eye(2)
    free[2:, :2] = real(speed**2 * (1.0 - POLAR) - 1.0 - 2j * DAMPING * speed)
    free[2:, 2:] = real(1j * speed * (POLAR - 2.0) - 2.0 * DAMPING)
    by_speed[2:, :2] = real(2.0 * speed * (1.0 - POLAR) - 2j * DAMPING)
    by_speed[2:, 2:] = real(1j * (POLAR - 2.0) + 0j)
    force[2] = UNBALANCE * speed**2

    def rates(_, y):
        state, slopes, change = y[:4], y[4:20].reshape(4, 4), y[20:]
        rate, matrix = free @ state + force, free.copy()
        if inside:
            radius = np.hypot(*state[:2])
            normal = state[:2] / radius
            rate[2:] -= RING * (1.0 - 1.0 / radius) * state[:2]
            matrix[2:, :2] -= RING * ((1.0 - 1.0 / radius) * np.eye(2) + np.outer(normal, normal) / radius)
        driven = matrix @ change + by_speed @ state
        driven[2] += 2.0 * UNBALANCE * speed
        return np.concatenate([rate, (matrix @ slopes).ravel(), driven])

    return rates


def ring(_, y):
    return np.hypot(y[0], y[1]) - 1.0


def radial(_, y):
    return y[0] * y[2] + y[1] * y[3]


ring.terminal = radial.terminal = True


def flow(speed, state, duration):
    """End of a motion, its derivatives by the start, by the duration and by the speed, and the durations of its contacts.

    Between the extrema of the radius a crossing of the ring cannot be missed, however short the contact is.
    """
    y, t, entered, contacts = np.concatenate([state, np.eye(4).ravel(), np.zeros(4)]), 0.0, 0.0, []
    inside = np.hypot(*state[:2]) > 1.0
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}
    while t < duration:
        rates = rates_of(speed, inside)
        ring.direction = -1.0 if inside else 1.0
        found = solve_ivp(rates, (t, duration), y, events=[ring, radial], **options)
        if found.status == 1 and not len(found.t_events[0]) and (ring(0.0, found.y[:, -1]) > 0.0) != inside:
            found = solve_ivp(rates, (t, found.t[-1]), y, events=ring, **options)
            crossed = found.status == 1
            assert crossed
        else:
            crossed = found.status == 1 and len(found.t_events[0]) > 0
        if found.status == 1 and not crossed:  # beyond the extremum
            found = solve_ivp(rates, (found.t[-1], min(duration, found.t[-1] + 1e-6)), found.y[:, -1], **options)
        y, t = found.y[:, -1].copy(), found.t[-1]
        if crossed:
            contacts += [t - entered] if inside else []
            inside, entered = not inside, t
            y[:2] *= (1.0 + (1e-14 if inside else -1e-14)) / np.hypot(*y[:2])
    return y[:4], y[4:20].reshape(4, 4), rates(0.0, y)[:4], y[20:], contacts


def equations(x):
    """What vanishes on a closed path that begins where the radius is least, and its derivative, by state, period and speed; and that of the flow."""
    end, slopes, rate, by_speed, contacts = flow(x[5], x[:4], x[4])
    values, matrix = np.append(end - x[:4], radial(0.0, x)), np.zeros((5, 6))
    matrix[:4] = np.column_stack([slopes - np.eye(4), rate, by_speed])
    matrix[4, :4] = [*x[2:4], *x[:2]]
    return values, matrix, slopes, contacts


def on_branch(guess, normal):
    """The point of the family in the plane through a guess."""
    x = guess.copy()
    for _ in range(10):
        values, matrix, *_ = equations(x)
        change = np.linalg.solve(np.vstack([matrix, normal]), -np.append(values, normal @ (x - guess)))
        x = x + change
        if np.abs(change).max() < 1e-11:
            return x
    raise AssertionError("no closed path")


def fold_of(slopes):
    """Product of ``1 − μ`` over the non-trivial multipliers."""
    apart = np.eye(4) - slopes
    return sum(np.linalg.det(np.delete(np.delete(apart, i, 0), i, 1)) for i in range(4))


@pytest.mark.parametrize("speed", [*DOUBLINGS, *FOLDS])
def test_folds_and_doublings(speed):
    """At a doubling a multiplier of minus one; at a fold the family turns back, within 1e-8 of the speed, as a multiplier passes one."""
    period, state = (DOUBLINGS | FOLDS)[speed]
    x = np.array([*state, period, speed])
    values, matrix, slopes, _ = equations(x)
    assert np.abs(values).max() < 2e-9  # what closes an orbit in the package
    assert np.linalg.det(slopes) == pytest.approx(np.exp(-4.0 * DAMPING * period), rel=1e-9)  # Liouville
    if speed in DOUBLINGS:
        assert np.abs(np.linalg.eigvals(slopes) + 1.0).min() < 1e-5
        return
    tangent = np.linalg.svd(matrix)[2][-1]
    sides = [on_branch(x + step * tangent, tangent) for step in (-4e-7, 4e-7)]
    ahead, folds = [], []
    for side in sides:
        _, matrix, slopes, _ = equations(side)
        direction = np.linalg.svd(matrix)[2][-1]
        ahead.append(direction[5] * np.sign(direction @ tangent))
        folds.append(fold_of(slopes))
    assert ahead[0] * ahead[1] < 0.0
    assert folds[0] * folds[1] < 0.0
    assert max(abs(side[5] - speed) for side in sides) < 1e-8


@pytest.mark.parametrize(
    ("speed", "shortest", "away"), [(3.3544041104194184, 2.4e-3, 4e-6), (2.745398934885404, 1.12e-2, 6e-5)]
)
def test_two_folds_are_those_of_a_short_contact(speed, shortest, away):
    """Next to the fold the contact ends in a grazing; with and without it the multipliers are the same there, and one is well above one."""
    period, state = FOLDS[speed]
    x = np.array([*state, period, speed])
    _, matrix, _, contacts = equations(x)
    assert min(contacts) == pytest.approx(shortest, rel=0.01)
    tangent = np.linalg.svd(matrix)[2][-1]
    towards = min(
        (on_branch(x + step * tangent, tangent) for step in (-4e-7, 4e-7)), key=lambda at: min(equations(at)[3])
    )
    beyond = on_branch(x + away / 4e-7 * (towards - x), tangent)
    _, _, slopes, fewer = equations(beyond)
    assert len(fewer) == len(contacts) - 1
    assert np.abs(np.linalg.eigvals(slopes)).max() > 1.15
