"""How a disturbance of a size takes a rotor out of levitation: as a response of the rotor, times that size.

Let the real axis lie along the disturbance, of size ``v > 0``.  In the fixed frame every flight is then

    z(t) = v H(t) + Λ e^{it},

and with the responses ``h₀`` to a displacement and ``h₁`` to an impulse:

*Kick.*  ``H = h₁``, ``v`` the change of velocity.

*Pulse.*  A half-sine pulse of duration ``T`` with the change of velocity ``v``: ``Ḧ + γḢ + ω²H = (ν/2) sin νt`` until ``T``, ``ν = π/T``.  So

    H = Im(G(e^{iνt} − h₀ − iν h₁)),      G = (ν/2)/(ω² − ν² + iγν),

and free motion with ``H(T)`` and ``Ḣ(T)`` afterwards.  An impact during the pulse is not followed.

*Step.*  The unbalance jumps.  Levitation before was ``(Λ + v)e^{it}``, which is the start: ``H = h₀ + i h₁``, ``v = |Δρ|/|ω² − 1 + iγ|``.
"""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any

from flint import acb, arb

from carom.proofs.balls import I, hull

if TYPE_CHECKING:
    from carom.proofs.patches import Held


Response = tuple[Any, Any, Any]
"""A response with its first two derivatives."""
Plain = tuple[complex, complex, complex]


class DisturbedStart:
    """A disturbance of the unit size; by default one that changes the state at once."""

    @property
    def lasts(self) -> arb:
        """Ball of the time from which motion is free."""
        return arb(0)

    def last(self, held: Held) -> Response:
        """``H`` when motion becomes free."""
        return self.response(held, self.lasts)

    def response(self, held: Held, time: arb) -> Response:
        """``H`` at a time or on an interval of times."""
        raise NotImplementedError

    def plain_response(self, held: Held, time: float) -> Plain:
        """``H`` in doubles."""
        raise NotImplementedError


class KickStart(DisturbedStart):
    """A kick, which changes the velocity at once."""

    def response(self, held: Held, time: arb) -> Response:
        """``h₁``."""
        return held.responses(time)[1]

    def plain_response(self, held: Held, time: float) -> Plain:
        """The same in doubles."""
        return held.plain_responses(time)[1]


class Step(DisturbedStart):
    """A step of the unbalance, which changes the levitation about which the rotor moves."""

    def response(self, held: Held, time: arb) -> Response:
        """``h₀ + i h₁``."""
        c, h = held.responses(time)
        return acb(c[0], h[0]), acb(c[1], h[1]), acb(c[2], h[2])

    def plain_response(self, held: Held, time: float) -> Plain:
        """The same in doubles."""
        c, h = held.plain_responses(time)
        return c[0] + 1j * h[0], c[1] + 1j * h[1], c[2] + 1j * h[2]


class Pulse(DisturbedStart):
    """A half-sine pulse of the acceleration of the base.

    Parameters
    ----------
    duration : arb
        ``T``, in ``1/Ω``.
    """

    def __init__(self, duration: arb) -> None:
        self._duration, self._nu = duration, arb.pi() / duration
        self._plain = float(duration.mid()), math.pi / float(duration.mid())

    @property
    def lasts(self) -> arb:
        """``T``."""
        return self._duration

    def response(self, held: Held, time: arb) -> Response:
        """That of the pulse, of free motion after it, or both together on an interval that holds its end."""
        begin, end = arb(time.lower()), arb(time.upper())
        if end <= self.lasts:
            return self._during(held, time)
        if begin >= self.lasts:
            return _freely(held, held.released, time - self.lasts)
        during = self._during(held, hull(begin, self.lasts.upper()))
        after = _freely(held, held.released, hull(0, (end - self.lasts).upper()))
        return hull(during[0], after[0]), hull(during[1], after[1]), hull(during[2], after[2])

    def last(self, held: Held) -> Response:
        """``H(T)``."""
        return self._during(held, self.lasts)

    def _during(self, held: Held, time: arb) -> Response:
        n, nu = held.numbers, self._nu
        gain = nu / 2 / (n.omega_squared - nu * nu + n.gamma * nu * I)
        (c, dc, _), (h, dh, _) = held.responses(time)
        sine, cosine = (nu * time).sin_cos()
        place = (gain * acb(cosine - c, sine - nu * h)).imag
        rate = (gain * acb(-nu * sine - dc, nu * cosine - nu * dh)).imag
        return place, rate, nu / 2 * sine - n.gamma * rate - n.omega_squared * place

    def plain_response(self, held: Held, time: float) -> Plain:
        """The same in doubles."""
        duration, nu = self._plain
        gamma, stiff = (float(x.mid()) for x in (held.numbers.gamma, held.numbers.omega_squared))
        gain = nu / 2 / (stiff - nu * nu + 1j * gamma * nu)
        during = min(time, duration)
        (c, dc, _), (h, dh, _) = held.plain_responses(during)
        turn = cmath.exp(1j * nu * during)
        place, rate = (gain * (turn - c - 1j * nu * h)).imag, (gain * (1j * nu * (turn - dh) - dc)).imag
        if time <= duration:
            return place, rate, nu / 2 * turn.imag - gamma * rate - stiff * place
        displaced, moved = held.plain_responses(time - duration)
        after = [place * one + rate * other for one, other in zip(displaced, moved, strict=True)]
        return after[0], after[1], after[2]


def _freely(held: Held, state: Response, time: arb) -> Response:
    """Free motion from a place and a rate."""
    c, h = held.responses(time)
    place, rate, _ = state
    return place * c[0] + rate * h[0], place * c[1] + rate * h[1], place * c[2] + rate * h[2]
