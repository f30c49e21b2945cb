"""Bounces and slides around a rub by a general integrator, in polar coordinates of the frame that turns with the shaft."""

from fractions import Fraction

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


class Bouncing:
    """The planar rotor in polar coordinates ``(r, r', x, y)``: flights and impacts, then slides, by a general integrator."""

    def __init__(self, machine):
        at = {name: float(Fraction(value)) for name, value in machine.items()}
        self.gamma, self.rho, self.mu, self.d, self.s = (
            at[name] for name in ("gamma", "rho", "mu", "d", "radius_ratio")
        )
        self.stiffness = at["omega"] ** 2

    def flight(self, _, state):
        r, v, x, y = state
        u, du = r * np.exp(1j * x), (v + 1j * r * y) * np.exp(1j * x)
        pull = self.rho - (self.gamma + 2j) * du - (self.stiffness - 1 + 1j * self.gamma) * u
        turned = pull * np.exp(-1j * x)
        return v, turned.real + r * y * y, y, (turned.imag - 2 * v * y) / r

    def push(self, x, y):
        return self.rho * np.cos(x) + (1 + y) ** 2 - self.stiffness

    def slide(self, _, state):
        x, y = state
        return y, -self.gamma * (1 + y) - self.rho * np.sin(x) - self.mu * self.push(x, y)

    def rub(self):
        """Angle and force of the stable rub, by a search along the angle."""
        angles = np.linspace(-np.pi, np.pi, 2001)
        rates = [self.slide(0, (x, 0.0))[1] for x in angles]
        falls = [k for k in range(2000) if rates[k] > 0 >= rates[k + 1]]
        angle = brentq(lambda x: self.slide(0, (x, 0.0))[1], angles[falls[0]], angles[falls[0] + 1], xtol=1e-15)
        return angle, self.push(angle, 0.0)

    def rest(self, state):
        """State ``(x, y)`` in which bounces lower than rounding end, the time, and the speeds of impacts."""

        def height(_, y):
            return y[0] - 1.0

        height.terminal, height.direction = True, 1
        clock, speeds = 0.0, []
        while True:
            path = solve_ivp(
                self.flight, (0, 100), state, method="DOP853", rtol=1e-12, atol=1e-14, events=height, first_step=1e-6
            )
            assert path.status == 1
            clock, (_, speed, x, y) = clock + path.t[-1], path.y[:, -1]
            speeds.append(speed)
            y -= self.mu * (1 + self.d) * speed
            assert self.s + 1 + y > 0
            if self.d * speed < 1e-6:
                return (x, y - self.mu * self.d * speed), clock, speeds
            state = (1.0, -self.d * speed, x, y)

    def settled(self, state):
        """Least normal force of a slide, and its state after many of its slower times of decay."""
        angle, _ = self.rub()
        drag, stiffness = self.gamma + 2 * self.mu, self.rho * (np.cos(angle) - self.mu * np.sin(angle))
        time = 12 * max(2 / drag, 2 * drag / stiffness)
        path = solve_ivp(self.slide, (0, time), state, method="DOP853", rtol=1e-10, atol=1e-13)
        return self.push(*path.y).min(), path.y[:, -1]
