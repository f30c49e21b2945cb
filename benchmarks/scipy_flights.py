"""Flights by SciPy: what benchmarks compare those of carom with."""

import numpy as np
from against_peers.bouncing import Flight, stiffness_and_force
from scipy.integrate import solve_ivp

from carom.parameters import Parameters


class ScipyFlights:
    """Explicit Runge–Kutta of order 8 (Dormand and Prince); the event is a root of its dense output, by Brent's method.

    Parameters
    ----------
    parameters : Parameters
    rtol : float
        Relative and absolute tolerance.
    """

    def __init__(self, parameters: Parameters, rtol: float) -> None:
        stiffness, force = stiffness_and_force(parameters)
        damping = complex(parameters.gamma, 2.0)
        self.settings = {"method": "DOP853", "rtol": rtol, "atol": rtol}

        def rate(_, state):
            return np.array([state[1], force - damping * state[1] - stiffness * state[0]])

        def wall(_, state):
            return state[0].real ** 2 + state[0].imag ** 2 - 1.0

        wall.terminal, wall.direction = True, 1
        self.rate, self.wall = rate, wall

    def __call__(self, position: complex, velocity: complex, horizon: float) -> Flight:
        """Fly from a state to the wall or to the horizon."""
        start = np.array([position, velocity], complex)
        flight = solve_ivp(self.rate, (0.0, horizon), start, events=self.wall, **self.settings)
        time, state = flight.t[-1], flight.y[:, -1]
        return Flight(flight.status == 1, float(time), complex(state[0]), complex(state[1]), len(flight.t) + 1)
