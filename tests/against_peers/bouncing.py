"""Peers for flights and bounces: general-purpose integrators with a terminal event at the wall.

They integrate ``Ü = ρe^{iφ} − (γ + 2i)U̇ − (ω² − 1 + iγ)U`` as it stands and take the impact law from polar coordinates
(:func:`machines.strike`); carom evaluates the exact flight from its modes, so nothing is shared but the physics.

Errors are carried along: what an integrator may add in one flight, and what the impacts make of it later.
"""

import cmath
from functools import cache
from time import process_time
from typing import NamedTuple

import numpy as np
from machines import flight_matrix, rest_position, strike
from scipy.linalg import expm

from carom.models import Rotor
from carom.parameters import Parameters

EPSILON = np.finfo(float).eps


class Flight(NamedTuple):
    """End of a flight: whether it is at the wall, when and in which state, and after how many steps."""

    hit: bool
    duration: float
    position: complex
    velocity: complex
    steps: int


class Impact(NamedTuple):
    """An impact: its time, the state just before it, and the flight that led there."""

    time: float
    position: complex
    velocity: complex
    flight: Flight


def stiffness_and_force(parameters: Parameters) -> tuple[complex, complex]:
    """``ω² − 1 + iγ`` and ``ρe^{iφ}``."""
    return complex(parameters.omega**2 - 1.0, parameters.gamma), cmath.rect(parameters.rho, parameters.phi)


@cache
def _heyoka_integrator():
    import heyoka as hy

    x, y, p, q = hy.make_vars("x", "y", "p", "q")
    gamma, real, imag, push, pull = (hy.par[i] for i in range(5))
    system = [
        (x, p),
        (y, q),
        (p, push - gamma * p + 2.0 * q - real * x + imag * y),
        (q, pull - gamma * q - 2.0 * p - real * y - imag * x),
    ]
    # By default an event is ignored for a while after it has happened, and low bounces with it; its direction will do.
    event = hy.t_event(x * x + y * y - 1.0, direction=hy.event_direction.positive, cooldown=1e-12)
    return hy.taylor_adaptive(system, [0.0] * 4, t_events=[event])


class HeyokaFlights:
    """Adaptive Taylor integration to machine precision; events are roots of its polynomials (Biscani and Izzo 2021)."""

    # Rounding of a sum of some twenty decreasing terms, and of their recurrences, for states up to size one.
    step_error = 8.0 * EPSILON

    def __init__(self, parameters: Parameters) -> None:
        stiffness, force = stiffness_and_force(parameters)
        self.values = [parameters.gamma, stiffness.real, stiffness.imag, force.real, force.imag]
        self.run = _heyoka_integrator()
        self.seconds = 0.0

    def __call__(self, position: complex, velocity: complex, horizon: float) -> Flight:
        """Fly from a state to the wall or to the horizon; ``seconds`` adds up what the integration alone takes."""
        run = self.run
        if abs(position) > 1.0 - EPSILON:
            # On the wall a root of the event at the start may hide the next one.
            position *= 1.0 - 4.0 * EPSILON
        run.pars[:] = self.values
        run.time = 0.0
        run.state[:] = position.real, position.imag, velocity.real, velocity.imag
        run.reset_cooldowns()
        begin = process_time()
        outcome, _, _, steps, *_ = run.propagate_until(horizon)
        self.seconds += process_time() - begin
        x, y, p, q = run.state
        # heyoka numbers terminal events −1, −2, …
        return Flight(int(outcome) == -1, run.time, complex(x, y), complex(p, q), steps)


def bounces(
    peer, parameters: Parameters, position: complex, velocity: complex, until: float, most: int
) -> tuple[list[Impact], Flight]:
    """Impacts of a motion until a time or a number of them is reached, and the last flight."""
    time, found = 0.0, []
    while True:
        flight = peer(position, velocity, until - time)
        time += flight.duration
        if not flight.hit:
            return found, flight
        found.append(Impact(time, flight.position, flight.velocity, flight))
        if len(found) == most:
            return found, flight
        normal = flight.position / abs(flight.position)
        local = normal.conjugate() * flight.velocity
        position, velocity = normal, normal * complex(*strike(parameters, local.real, local.imag))


# ---------------------------------------------------------------------------------------------------- errors


def flight_error(rotor: Rotor, peer, position: complex, velocity: complex, steps: int) -> float:
    """What a flight from this state may add to the difference between a peer's state and carom's.

    The peer's errors of each step, stretched by the flight, and the rounding of the terms of the exact flight, which
    carom takes to be sixteen spacings of doubles.
    """
    parameters = rotor.parameters
    rest, growth = rest_position(parameters), flight_growth(parameters)
    size = 1.0 + abs(rest) + growth * float(np.hypot(abs(position - rest), abs(velocity)))
    driving, driven = np.abs(rotor.system.amplitudes(position, velocity))
    upper, lower = rotor.system.exponents[1], rotor.system.exponents[0]
    response = 1.0 / max(abs(upper - lower) / 2.0, np.e * max(-upper.real, 0.0), 1e-3)
    terms = abs(rest) + (1.0 + max(abs(upper), abs(lower))) * (driven + driving * response) + driving
    return float(steps * peer.step_error * size * growth + 16.0 * EPSILON * terms)


@cache
def flight_growth(parameters: Parameters) -> float:
    """Largest factor by which a flight of up to forty units of time stretches a small error of its state."""
    step = expm(0.05 * flight_matrix(parameters))
    flown = [np.eye(2)]
    for _ in range(800):
        flown.append(step @ flown[-1])
    return float(np.linalg.norm(np.array(flown), 2, axis=(1, 2)).max())


def arrival_matrix(parameters: Parameters, position: complex, velocity: complex) -> np.ndarray:
    """Derivative of ``(θ, ṙ, θ̇, t)`` at the wall by the state ``(Re U, Im U, Re V, Im V)`` near there, shape (4, 4).

    A displaced state arrives later by ``τ = −Re(Ū δU)/ṙ`` and moves on in the meantime.
    """
    stiffness, force = stiffness_and_force(parameters)
    acceleration = force - complex(parameters.gamma, 2.0) * velocity - stiffness * position
    local = position.conjugate() * velocity
    columns = []
    for change, rate in ((1.0, 0.0), (1j, 0.0), (0.0, 1.0), (0.0, 1j)):
        late = -(position.conjugate() * change).real / local.real
        turn = (position.conjugate() * (change + velocity * late)).imag
        speed = position.conjugate() * (rate + acceleration * late) - 1j * turn * local
        columns.append((turn, speed.real, speed.imag, late))
    return np.array(columns).T


def bounce_matrix(parameters: Parameters, before: Impact, after: Impact) -> np.ndarray:
    """Derivative of ``(θ, ṙ, θ̇, t)`` at an impact by the same at the impact before, shape (4, 4)."""
    local = before.position.conjugate() * before.velocity
    radial, angular = strike(parameters, local.real, local.imag)
    slip = parameters.radius_ratio + 1.0 + local.imag
    grip = parameters.mu * (1.0 + parameters.d)
    sticks = grip * local.real >= abs(slip)
    # Change of velocity after the impact, in its own frame, for a turn, a radial and an angular change before it.
    speeds = (1j * complex(radial, angular), complex(-parameters.d, 0.0 if sticks else -np.sign(slip) * grip))
    changes = zip((1j, 0j, 0j), (*speeds, 0j if sticks else 1j), strict=True)
    flown = expm(flight_matrix(parameters) * after.flight.duration)
    columns = []
    for change, rate in changes:
        moved, speed = flown @ (np.array([change, rate]) * before.position)
        columns.append((moved.real, moved.imag, speed.real, speed.imag))
    derivative = np.zeros((4, 4))
    derivative[:, :3] = arrival_matrix(parameters, after.position, after.velocity) @ np.array(columns).T
    derivative[3, 3] = 1.0
    return derivative


def error_bounds(rotor: Rotor, peer, start: tuple[complex, complex], found: list[Impact]) -> np.ndarray:
    """First-order bounds of the differences of ``(θ, ṙ, θ̇, t)`` at all impacts, shape (n, 4).

    The error of each flight is taken in the worst direction and carried to each later impact by the derivatives of the
    bounces in between.
    """
    parameters = rotor.parameters
    bounds: list[np.ndarray] = []
    carried: list[np.ndarray] = []
    state = start
    for k, impact in enumerate(found):
        if k:
            bounce = bounce_matrix(parameters, found[k - 1], impact)
            carried = [bounce @ matrix for matrix in carried]
        error = flight_error(rotor, peer, *state, impact.flight.steps)
        carried.append(error * arrival_matrix(parameters, impact.position, impact.velocity))
        bounds.append(sum(np.linalg.norm(matrix, axis=1) for matrix in carried))
        local = impact.position.conjugate() * impact.velocity
        state = impact.position, impact.position * complex(*strike(parameters, local.real, local.imag))
    return np.array(bounds).reshape(-1, 4)
