"""Slip that stops or turns at an impact: no orbit of it where the answer says that slip runs on."""

import cmath

import numpy as np
from compilation import sized
from machines import (
    PAPER,
    flight_matrix,
    path,
    random_parameters,
    rest_position,
    strike,
)
from scipy.linalg import expm
from scipy.optimize import brentq

from carom import State, find_orbits, simulate
from carom.models import jeffcott
from carom.parameters import Parameters


def flight_return(parameters: Parameters, period: float) -> np.ndarray:
    """``a(T) = E(1 − E)⁻¹`` with ``E = e^{AT}``."""
    flown = expm(flight_matrix(parameters) * period)
    back: np.ndarray = flown @ np.linalg.inv(np.eye(2) - flown)
    return back


def stopped_slip_orbit(parameters: Parameters, period: float) -> tuple[complex, float, float] | None:
    """Orbit of a given period whose impacts, at ``U = 1``, stop the slip: the ``U*`` it needs, ``ṙ`` and ``θ̇``.

    With the impulse ``J = (1 + d)ṙ + iv`` the return needs ``ṙ + iθ̇ = −a₂₂J``, linear in ``ṙ`` and ``v``, and ``U* = 1 + a₁₂J``.
    """
    back = flight_return(parameters, period)
    surface_speed, restored = parameters.radius_ratio + 1.0, 1.0 + parameters.d
    alpha, beta = back[1, 1].real, back[1, 1].imag
    radial, slip = np.linalg.solve(
        [[1.0 + restored * alpha, -beta], [restored * beta, 1.0 + alpha]], [0.0, surface_speed]
    )
    if radial <= 0.0 or parameters.mu * restored * radial < abs(slip):
        return None
    return 1.0 + back[0, 1] * complex(restored * radial, slip), radial, slip - surface_speed


def backward_slip_orbit(
    parameters: Parameters, period: float, radial: float
) -> tuple[Parameters, complex, float] | None:
    """Orbit of a given period and radial speed whose slip runs backward: the machine and ``U*`` it needs, and ``θ̇``.

    The friction is chosen to make the period a root of ``F₁``, the rotor radius to make the slip backward.
    """
    back = flight_return(parameters, period)
    restored = 1.0 + parameters.d
    friction = -(1.0 / restored + back[1, 1].real) / back[1, 1].imag
    factor = restored * complex(1.0, -friction)
    angular = -(factor * back[1, 1]).imag * radial
    ratio = 0.9 * (-1.0 - angular - friction * restored * radial)
    if not 0.0 < friction <= 10.0 or ratio <= 0.001:
        return None
    return parameters.replace(mu=friction, radius_ratio=ratio), 1.0 + factor * back[0, 1] * radial, angular


def stays_inside(parameters: Parameters, rest: complex, velocity: complex, period: float) -> bool:
    """Whether a flight from ``U = 1`` about this rest position keeps inside the wall until its end."""
    times = np.linspace(0.0, period, 300)[1:-1]
    change = path(parameters.replace(rho=0.0), 1.0 - rest, velocity, times)
    return bool((np.abs(rest + change) < 1.0).all())


def assert_not_claimed(parameters: Parameters, rest: complex) -> None:
    """The rotor whose unbalance makes this the rest position is not said to keep its slip forward."""
    stiffness = complex(parameters.omega**2 - 1.0, parameters.gamma)
    machine = parameters.replace(rho=abs(rest * stiffness), phi=cmath.phase(rest * stiffness))
    assert not find_orbits(jeffcott(machine), longest_period=0.1).slip_stays_forward, machine


def test_no_rotor_said_to_keep_its_slip_forward_can_have_it_stopped():
    """Such orbits exist for rotors about as small as their clearance; none may contradict the proof."""
    random = np.random.default_rng(14)
    ratios = []
    count = sized(1000, 1000, 2500)
    for _ in range(count):
        parameters = random_parameters(
            random, radius_ratio=float(10 ** random.uniform(-1.5, 1.0)), d=random.uniform(0, 1)
        )
        period = float(random.uniform(0.05, 12.0))
        orbit = stopped_slip_orbit(parameters, period)
        if orbit is None or abs(parameters.gamma - 2.0 * parameters.omega) < 1e-3:
            continue
        rest, radial, _ = orbit
        after = complex(-parameters.d * radial, -parameters.radius_ratio - 1.0)
        if stays_inside(parameters, rest, after, period):
            ratios.append(parameters.radius_ratio)
            assert_not_claimed(parameters, rest)
    assert len(ratios) >= 0.02 * count
    # The scan comes to rotors larger than their clearance.
    assert max(ratios) > 1.0


def test_no_rotor_said_to_keep_its_slip_forward_can_have_it_reversed():
    """Admissible orbits with backward slip are rare: far above resonance, nearly lossless, tiny rotors."""
    random = np.random.default_rng(15)
    count = 0
    for _ in range(1000):
        parameters = PAPER.replace(
            gamma=float(10 ** random.uniform(-2.3, -1.0)), omega=random.uniform(0.1, 0.25), d=random.uniform(0.99, 1.0)
        )
        period, radial = random.uniform(8.5, 9.3), random.uniform(0.1, 0.3)
        orbit = backward_slip_orbit(parameters, period, radial)
        if orbit is None:
            continue
        machine, rest, angular = orbit
        after = complex(*strike(machine, radial, angular, slip=-1, limited=False))
        if stays_inside(machine, rest, after, period):
            count += 1
            assert_not_claimed(machine, rest)
    assert count >= 10


def test_an_orbit_with_stopped_slip_exists_where_the_argument_leaves_room_for_it():
    """The paper's machine with a rotor of 0.3 clearances: its motion strikes, sticks and repeats, stably."""
    parameters = PAPER.replace(radius_ratio=0.3)

    def mismatch(period: float) -> float:
        orbit = stopped_slip_orbit(parameters, period)
        assert orbit is not None
        return abs(orbit[0]) - abs(rest_position(parameters))

    period = brentq(mismatch, 2.6, 2.7, xtol=1e-14)
    rest, radial, angular = stopped_slip_orbit(parameters, period)
    position = rest_position(parameters) / rest
    rotor = jeffcott(parameters)
    assert not find_orbits(rotor).slip_stays_forward
    motion = simulate(
        rotor, State(position, complex(-parameters.d * radial, -parameters.radius_ratio - 1.0) * position), 30.0
    )
    contacts = motion.contacts
    assert contacts.sticks.all()
    np.testing.assert_allclose(np.diff(contacts.time), period, rtol=1e-9)
    np.testing.assert_allclose(contacts.radial_speed, radial, rtol=1e-9)
    np.testing.assert_allclose(contacts.angular_speed, angular, rtol=1e-9)
