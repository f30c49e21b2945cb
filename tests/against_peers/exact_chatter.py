"""Chatter in 70 digits: every bounce down to a height of 1e-32 clearances, and what completing it earlier costs.

Flights are sums of exponentials, the next impact comes from Newton's method on ``(|U|² − 1)/t``, impacts obey Newton's
restitution and Coulomb's friction.  A chatter completed at a rebound of speed ``v`` goes on as lasting contact, after an
outward impulse ``v`` with its share of friction.

What that leaves out, for a first height ``h = v²/2N``:

- While the contact slips, the bounces' friction has the same impulse, and the same first moment because radial speed
  integrates to nothing over a bounce.  There remains the excursion ``Ξ = ∫(r − 1) dt = −(4/3) hv/(N(1 − d³))``.  The angular
  momentum ``r²(1 + w)`` gives the angle ``−2(1 + w)Ξ`` for it, and the friction of the normal force, which changes by
  ``2(1 + w)`` times the momentum ``μṙ`` that friction lends meanwhile, another ``−2μ²(1 + w)Ξ``.
- Where every impact stops the slip, the force ``P`` along the wall makes the contact creep by ``Pt²/2`` in every flight of
  time ``t = 2v/N``: by ``4hP/(N(1 − d²))`` in all.
"""

from dataclasses import dataclass

import mpmath as mp

from carom.parameters import Parameters

DIGITS = 70
CONVERGED = mp.mpf(10) ** -25
"""Relative change of a flight time after which the next Newton step is below the digits carried at the lowest bounce."""
ORDER, STEP = 34, mp.mpf("0.05")
STOPPED = mp.mpf(10) ** -50
"""Slip velocity that an impact leaves by rounding where it stops the slip."""


@dataclass(frozen=True)
class Rebound:
    """The first bounce below a height: when, where, how high, and the forces across and along the wall."""

    time: mp.mpf
    angle: mp.mpf
    rate: mp.mpf
    speed: mp.mpf
    height: mp.mpf
    push: mp.mpf
    pull: mp.mpf
    slip: mp.mpf

    @property
    def sticks(self) -> bool:
        """Whether the impact stopped the slip."""
        return abs(self.slip) < STOPPED


class ExactRotor:
    """The planar rotor with its parameters as exact numbers."""

    def __init__(self, parameters: Parameters, **exact: mp.mpf) -> None:
        for name, value in {**parameters.as_dict(), **exact}.items():
            setattr(self, name, mp.mpf(value))
        split = mp.sqrt(mp.mpc(self.gamma**2 - 4 * self.omega**2))
        self.exponents = [(-self.gamma - 2j + sign * split) / 2 for sign in (1, -1)]
        self.force = self.rho * mp.expj(self.phi)
        self.rest = self.force / mp.mpc(self.omega**2 - 1, self.gamma)

    def rebound(self, time: mp.mpf, position: mp.mpc, velocity: mp.mpc) -> Rebound:
        """What there is to know about a state on the wall."""
        local = mp.conj(position) * velocity
        free = self.force - mp.mpc(self.gamma, 2) * velocity - mp.mpc(self.omega**2 - 1, self.gamma) * position
        force = mp.conj(position) * free
        push = force.real + abs(velocity) ** 2
        height, slip = local.real**2 / (2 * push), self.radius_ratio + 1 + local.imag
        # Seen along the wall, ṙ = 0: without the Coriolis force of the radial speed.
        pull = force.imag + 2 * (1 + local.imag) * local.real
        return Rebound(time, mp.arg(position), local.imag, -local.real, height, push, pull, slip)

    def bounce(self, position: mp.mpc, velocity: mp.mpc, about: float | None = None) -> tuple[mp.mpf, mp.mpc, mp.mpc]:
        """Duration of a flight from the wall to the wall, by default a low one, and the state after the impact."""
        upper, lower = self.exponents
        share = (velocity - lower * (position - self.rest)) / (upper - lower)
        time, step = mp.mpf(about) if about else self._low_flight(position, velocity), mp.inf
        while abs(step) > CONVERGED * time:
            first = share * mp.exp(upper * time)
            second = (position - self.rest - share) * mp.exp(lower * time)
            place, speed = self.rest + first + second, upper * first + lower * second
            mean = (abs(place) ** 2 - 1) / time
            step = -mean * time / (2 * (mp.conj(place) * speed).real - mean)
            time += step
        return time, place / abs(place), self.strike(place / abs(place), speed)

    def _low_flight(self, position: mp.mpc, velocity: mp.mpc) -> mp.mpf:
        """Duration of a low flight, which the normal force turns back."""
        rebound = self.rebound(mp.mpf(0), position, velocity)
        return 2 * rebound.speed / rebound.push

    def strike(self, position: mp.mpc, velocity: mp.mpc) -> mp.mpc:
        """Velocity after an impact."""
        local = mp.conj(position) * velocity
        slip, normal = self.radius_ratio + 1 + local.imag, (1 + self.d) * local.real
        return velocity - position * mp.mpc(normal, mp.sign(slip) * min(self.mu * normal, abs(slip)))

    def chatter(self, position: mp.mpc, velocity: mp.mpc, heights: list[mp.mpf]) -> list[Rebound]:
        """The first rebound below each of the heights, which fall."""
        time, found = mp.mpf(0), []
        while len(found) < len(heights):
            rebound = self.rebound(time, position, velocity)
            if 0 < rebound.height <= heights[len(found)]:
                found.append(rebound)
                continue
            duration, position, velocity = self.bounce(position, velocity)
            time += duration
        return found

    def completed(self, rebound: Rebound, until: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
        """Angle and rate at a later time of a contact that lasts from a rebound on, all slipping or all rolling."""
        if rebound.sticks:
            return rebound.angle + rebound.rate * (until - rebound.time), rebound.rate
        rate = rebound.rate + mp.sign(rebound.slip) * min(self.mu * rebound.speed, abs(rebound.slip))
        return self.slide(rebound.angle, rate, mp.sign(rebound.slip), until - rebound.time)

    def slide(self, angle: mp.mpf, rate: mp.mpf, sign: int, time: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
        """Slide along the wall by Taylor series of ``x``, ``w``, ``sin(x − φ)`` and ``cos(x − φ)``."""
        while time > 0:
            step = min(time, STEP)
            x, w, sine, cosine = [angle], [rate], [mp.sin(angle - self.phi)], [mp.cos(angle - self.phi)]
            for k in range(ORDER):
                one = 1 if k == 0 else 0
                square = mp.fsum(w[j] * w[k - j] for j in range(k + 1))
                push = self.rho * cosine[k] + one + 2 * w[k] + square - self.omega**2 * one
                bend = -self.gamma * (one + w[k]) - self.rho * sine[k] - sign * self.mu * push
                x.append(w[k] / (k + 1))
                w.append(bend / (k + 1))
                sine.append(mp.fsum(j * x[j] * cosine[k + 1 - j] for j in range(1, k + 2)) / (k + 1))
                cosine.append(-mp.fsum(j * x[j] * sine[k + 1 - j] for j in range(1, k + 2)) / (k + 1))
            angle, rate = _sum(x, step), _sum(w, step)
            time -= step
        return angle, rate

    def predicted_error(self, rebound: Rebound) -> mp.mpf:
        """Leading term of the angle that completing at a rebound leaves out (see above)."""
        if rebound.sticks:
            return 4 * rebound.height * rebound.pull / (rebound.push * (1 - self.d**2))
        excursion = -4 * rebound.height * rebound.speed / (3 * rebound.push * (1 - self.d**3))
        return -2 * (1 + rebound.rate) * (1 + self.mu**2) * excursion


def _sum(series: list[mp.mpf], time: mp.mpf) -> mp.mpf:
    total = mp.mpf(0)
    for coefficient in reversed(series):
        total = total * time + coefficient
    return total
