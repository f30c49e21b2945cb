"""The same bounces by general-purpose programs, as a careful user would write them."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp


def scipy_bounces(parameters, start, until, most_impacts, rtol=1e-10):
    """Impacts of a motion by ``solve_ivp`` with a terminal event; returns their number."""
    stiffness = complex(parameters.omega**2 - 1.0, parameters.gamma)
    force = parameters.rho * np.exp(1j * parameters.phi)
    reset = (1.0 + parameters.d) * complex(1.0, parameters.mu)

    def rate(_, state):
        u, v = complex(state[0], state[1]), complex(state[2], state[3])
        a = force - (parameters.gamma + 2j) * v - stiffness * u
        return [v.real, v.imag, a.real, a.imag]

    def wall(_, state):
        return state[0] ** 2 + state[1] ** 2 - 1.0

    wall.terminal, wall.direction = True, 1
    time, state, impacts = 0.0, [start[0].real, start[0].imag, start[1].real, start[1].imag], 0
    while time < until and impacts < most_impacts:
        flight = solve_ivp(rate, (time, until), state, method="DOP853", events=wall, rtol=rtol, atol=rtol)
        time, state = flight.t[-1], flight.y[:, -1]
        if flight.status != 1:
            break
        u, v = complex(state[0], state[1]), complex(state[2], state[3])
        u /= abs(u)
        v -= reset * (u.conjugate() * v).real * u
        state = [u.real, u.imag, v.real, v.imag]
        impacts += 1
    return impacts


class HeyokaBounces:
    """Impacts by heyoka's adaptive Taylor integrator with a terminal event; compiled once."""

    def __init__(self, parameters):
        import heyoka as hy

        x, y, p, q = hy.make_vars("x", "y", "p", "q")
        gamma, k = parameters.gamma, parameters.omega**2 - 1.0
        force = parameters.rho * np.exp(1j * parameters.phi)
        system = [
            (x, p),
            (y, q),
            (p, force.real - gamma * p + 2.0 * q - k * x + gamma * y),
            (q, force.imag - gamma * q - 2.0 * p - k * y - gamma * x),
        ]
        event = hy.t_event(x * x + y * y - 1.0, direction=hy.event_direction.positive)
        self.integrator = hy.taylor_adaptive(system, [0.0] * 4, t_events=[event])
        self.reset = (1.0 + parameters.d) * complex(1.0, parameters.mu)

    def __call__(self, start, until, most_impacts):
        run = self.integrator
        run.time = 0.0
        run.state[:] = [start[0].real, start[0].imag, start[1].real, start[1].imag]
        run.reset_cooldowns()
        impacts = 0
        while impacts < most_impacts:
            outcome = run.propagate_until(until)[0]
            if int(outcome.value) != -1:
                break
            u, v = complex(*run.state[:2]), complex(*run.state[2:])
            u /= abs(u)
            v -= self.reset * (u.conjugate() * v).real * u
            run.state[:] = [u.real, u.imag, v.real, v.imag]
            impacts += 1
        return impacts
