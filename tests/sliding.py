"""Motions along the wall of the rotor with one mass: states, series, forces, ends of their phases."""

import cmath
import math

import mpmath
import numpy as np
from machines import PAPER

from carom.base.outcome import Phase
from carom.core.contact_series import rub_series
from carom.core.flow import displacement, velocity
from carom.core.layout import rub_workspace
from carom.core.rub import first_transition, rest_on_wall
from carom.core.taylor import series_step, sum_series
from carom.models import jeffcott
from carom.parameters import Parameters

FLIGHT, FORWARD, BACKWARD, ROLLING = Phase.FLIGHT, Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP, Phase.ROLLING
SIGN = {FORWARD: 1, BACKWARD: -1}


SLENDER = PAPER.replace(radius_ratio=1.2)


def on_wall(parameters, angle, rate):
    """Amplitudes of a state that moves along the wall."""
    position = cmath.rect(1.0, angle)
    amplitudes = jeffcott(parameters).system.amplitudes(position, 1j * rate * position)
    return np.array(amplitudes)


def series_of(parameters, angle, rate, phase):
    rotor = jeffcott(parameters).system.arrays
    work = rub_workspace(2)
    rub_series(rotor, np.array([phase]), on_wall(parameters, angle, rate), work)
    return rotor, work


def polar(rotor, amplitudes):
    """Angle, rate, distance from the wall and radial speed."""
    position, speed = displacement(rotor, 0, amplitudes), velocity(rotor, 0, amplitudes)
    local = position.conjugate() * speed
    return cmath.phase(position), local.imag, abs(position) - 1.0, local.real


def push_of(parameters, angle, rate):
    """Normal force, from Newton's law across the wall."""
    return parameters.rho * math.cos(angle - parameters.phi) + (1 + rate) ** 2 - parameters.omega**2


def pull_of(parameters, angle, rate):
    """Acceleration along the wall without friction."""
    return -parameters.gamma * (1 + rate) - parameters.rho * math.sin(angle - parameters.phi)


def next_event(parameters, angle, rate, phase):
    """Walk to the end of a phase: its time, what follows, whether slip stops, and the amplitudes there."""
    rotor = jeffcott(parameters).system.arrays
    amplitudes, work, time = on_wall(parameters, angle, rate), rub_workspace(2), 0.0
    for _ in range(200):
        rub_series(rotor, np.array([phase]), amplitudes, work)
        step = series_step(work)
        duration, following, slip_stops = first_transition(rotor, 0, phase, step, work)
        sum_series(work, duration, amplitudes)
        rest_on_wall(rotor, 0, amplitudes, phase == ROLLING)
        time += duration
        if duration < step:
            return time, following, slip_stops, amplitudes
    raise AssertionError("the phase does not end")


class ExactSlide:
    """Sliding with 40 digits in the angle and its rate: power series of order 40 from the recurrence of sine and cosine."""

    ORDER = 40

    def __init__(self, parameters: Parameters, angle: float, rate: float, sign: int) -> None:
        self.numbers = {name: mpmath.mpf(getattr(parameters, name)) for name in ("gamma", "omega", "rho", "phi", "mu")}
        self.sign = sign
        self.starts, self.pieces = [mpmath.mpf(0)], [self._expand(mpmath.mpf(angle), mpmath.mpf(rate))]

    def push(self, x, w):
        """Normal force."""
        rho, phi, omega = (self.numbers[name] for name in ("rho", "phi", "omega"))
        return rho * mpmath.cos(x - phi) + (1 + w) ** 2 - omega**2

    def _expand(self, angle, rate):
        gamma, omega, rho, phi, mu = (self.numbers[name] for name in ("gamma", "omega", "rho", "phi", "mu"))
        x, w = [angle], [rate]
        sine, cosine = [mpmath.sin(angle - phi)], [mpmath.cos(angle - phi)]
        for k in range(self.ORDER):
            square = sum(w[j] * w[k - j] for j in range(k + 1))
            push = rho * cosine[k] + square + 2 * w[k] + (1 - omega**2 if k == 0 else 0)
            spin = w[k] + (1 if k == 0 else 0)
            sine.append(sum(cosine[j] * w[k - j] for j in range(k + 1)) / (k + 1))
            cosine.append(-sum(sine[j] * w[k - j] for j in range(k + 1)) / (k + 1))
            x.append(w[k] / (k + 1))
            w.append((-gamma * spin - rho * sine[k] - self.sign * mu * push) / (k + 1))
        return x, w, mpmath.mpf(0.25) / (1 + abs(rate))

    def state(self, time):
        """Angle and rate at a time; the series of this order leave nothing at 25 digits on their steps."""
        while time > self.starts[-1] + self.pieces[-1][2]:
            step = self.pieces[-1][2]
            ends = [_sum(series, step) for series in self.pieces[-1][:2]]
            self.starts.append(self.starts[-1] + step)
            self.pieces.append(self._expand(*ends))
        place = max(0, sum(start <= time for start in self.starts) - 1)
        return [_sum(series, time - self.starts[place]) for series in self.pieces[place][:2]]

    def error(self, time: float, angle: float, rate: float) -> float:
        """Distance of a state from the exact one."""
        x, w = self.state(mpmath.mpf(time))
        return float(abs(mpmath.expj(x) - mpmath.expj(mpmath.mpf(angle))) + abs(w - mpmath.mpf(rate)) / (1 + abs(w)))


def _sum(series, time):
    total = mpmath.mpf(0)
    for coefficient in reversed(series):
        total = total * time + coefficient
    return total
