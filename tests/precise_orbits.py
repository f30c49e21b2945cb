"""Orbits with one impact a period in arithmetic of fifty digits, without a formula of the package."""

from fractions import Fraction

import mpmath
import numpy as np
from machines import ExactMotion, exact_return

from carom.parameters import Parameters


def number(text: str | Fraction) -> mpmath.mpf:
    """A decimal number or a fraction with all digits at hand."""
    exact = Fraction(text)
    return mpmath.mpf(exact.numerator) / exact.denominator


class PreciseOrbit:
    """Orbit of forward slip next to a period and a radial speed.

    Attributes
    ----------
    period, radial, angular : mpf
    position : mpc
        At the impact.
    """

    def __init__(self, parameters: Parameters, period: float, radial: float) -> None:
        self.parameters, self.motion = parameters, ExactMotion(parameters)
        q = (1 + mpmath.mpf(parameters.d)) * mpmath.mpc(1, mpmath.mpf(parameters.mu))
        self.period = mpmath.findroot(lambda time: 1 + (q * exact_return(parameters, time)[0][1, 1]).real, period)
        back, _ = exact_return(parameters, self.period)
        lever, turn = q * back[0, 1], q * back[1, 1]
        rest = self.motion.rest
        self.radial = mpmath.findroot(lambda speed: abs(1 + lever * speed) ** 2 - abs(rest) ** 2, radial)
        self.angular = -turn.imag * self.radial
        self.position = rest / (1 + lever * self.radial)
        friction = mpmath.mpf(parameters.mu) * (1 + mpmath.mpf(parameters.d)) * self.radial
        self.after = mpmath.mpc(-mpmath.mpf(parameters.d) * self.radial, self.angular - friction) * self.position

    def radius(self, time: mpmath.mpf) -> mpmath.mpf:
        """``|U|`` at a time after the impact."""
        return abs(self.motion.fly(self.position, self.after, mpmath.mpf(time))[0])

    def top(self, near: float) -> mpmath.mpf:
        """Maximum of the radius next to a time."""

        def outward(time: mpmath.mpf) -> mpmath.mpf:
            position, velocity = self.motion.fly(self.position, self.after, time)
            return (mpmath.conj(position) * velocity).real

        return self.radius(mpmath.findroot(outward, near))

    def jacobian(self) -> np.ndarray:
        """Derivative of the impact map by differences."""
        section = (mpmath.arg(self.position), self.radial, self.angular)
        return self.motion.jacobian(section, 1, self.period)
