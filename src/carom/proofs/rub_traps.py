"""A region around a stable rub from which no bounce gets out, for states that leave the wall.

With the notation of :mod:`carom.proofs.steady`, the gap ``g = 1 − r`` and ``q = y − μr'``, which impacts do not change,

    V' = −(γ + 2μ)q²e^{2μδ} + r'Φ + g q e^{2μδ}E₂,      Φ = e^{2μδ}(μ(μq² + T(δ)) − qE₁),
    E₁ = 2(1 + y)/r + μ²(2 + q + y),      E₂ = −ρ sin x/r + μ((1 + y)² − ω²).

As ``r' = −g'`` and ``g = 0`` at both ends of a bounce, ``W = V + gΦ`` is ``V`` there, and ``W' ≤ g(Φ' + q e^{2μδ}E₂)``, of third order in
the speed of a bounce, where ``V'`` is of the second.  In the same way ``r''`` does not feed a bounce but by its change:

    ½r'² after a bounce − ½r'² before it = ∫g (r'')' dt.

``docs/theory/proofs.md`` has all steps.  All bounds are taken in ball arithmetic on a box of ``δ``, ``q``, ``y``, ``r'`` and ``g`` that is
shown not to be left.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from flint import acb, arb

from carom.proofs.balls import hull, rational
from carom.proofs.moments import UNIT
from carom.proofs.patches import Held, Patch
from carom.proofs.steady import Rub

REACHES = tuple(Fraction(k, 20) for k in (2, 3, 4, 6, 8, 11, 14, 18))
"""Reaches ``A`` that are tried, in radians: less than π/2."""
_FASTER, _HIGHER = Fraction(11, 10), Fraction(3, 2)
"""Room for the speed at which a bounce lands, and for its height beside that under the force of the rub."""


class TrapBox(NamedTuple):
    """All states of bounces: ``δ``, ``q``, ``y``, ``r'`` and ``g``, and with them ``r``, ``ρ cos x``, ``ρ sin x`` and ``r''``."""

    off: arb
    slide: arb
    turning: arb
    rate: arb
    gap: arb
    radius: arb
    along: arb
    across: arb
    push: arb


@dataclass(frozen=True)
class Bounces:
    """All bounces around a rub that begin with at most a speed, as long as they stay within a reach.

    Attributes
    ----------
    rub : Rub
    reach : arb
        ``A``.
    speed : arb
        Largest speed ``v`` at which the first bounce leaves the wall.
    """

    rub: Rub
    reach: arb
    speed: arb

    @cached_property
    def level(self) -> arb:
        """``c``."""
        return self.rub.potential(self.reach).min(self.rub.potential(-self.reach))

    @cached_property
    def box(self) -> TrapBox:
        """The states that are allowed."""
        n, rub = self.rub.numbers, self.rub
        slide = (2 * self.level).sqrt() * (n.mu * self.reach).exp()
        landing = rational(_FASTER) * self.speed
        gap = hull(0, rational(_HIGHER) * self.speed * self.speed / (2 * rub.force))
        off, rate, radius = UNIT * self.reach, hull(-self.speed, landing), 1 - gap
        turning = UNIT * (slide + n.mu * landing)
        sine, cosine = off.sin_cos()
        along, across = rub.place
        here, there = along * cosine - across * sine, across * cosine + along * sine
        push = radius * ((1 + turning) ** 2 - n.omega_squared) - n.gamma * rate + here
        return TrapBox(off, UNIT * slide, turning, rate, gap, radius, here, there, push)

    @property
    def _least(self) -> arb:
        """``n₁``."""
        return arb(self.box.push.lower())

    @cached_property
    def _gain(self) -> arb:
        """By which share a bounce may gain in the square of its speed."""
        n, box = self.rub.numbers, self.box
        around = 1 + box.turning
        rise = -2 * around * (n.gamma * box.radius * around + box.across) - box.turning * box.across
        rise = (rise - n.gamma * self._least).upper().max(arb(0))
        bend = abs(6 * around * self._rates[1]).upper()
        ratio = self.speed / self._least
        return 4 * rise * ratio / self._least / 3 + 4 * bend * ratio**3 / 15

    @cached_property
    def _rates(self) -> tuple[arb, arb]:
        """``q'`` and ``y'``."""
        slide = self._still - self.box.rate * self._swing
        return slide, slide + self.rub.numbers.mu * self.box.push

    @cached_property
    def _swing(self) -> arb:
        """``E₁``."""
        mu, box = self.rub.numbers.mu, self.box
        return 2 * (1 + box.turning) / box.radius + mu * mu * (2 + box.slide + box.turning)

    @cached_property
    def _pull(self) -> arb:
        """``E₂``."""
        n, box = self.rub.numbers, self.box
        return n.mu * ((1 + box.turning) ** 2 - n.omega_squared) - box.across / box.radius

    @cached_property
    def _still(self) -> arb:
        """``q'`` without its term by ``r'``."""
        n, box = self.rub.numbers, self.box
        slides = -(n.gamma + 2 * n.mu) * box.slide - n.mu * box.slide * box.slide - self.rub.torque(box.off)
        return slides + box.gap * self._pull

    @cached_property
    def _growth(self) -> tuple[arb, arb, arb, arb]:
        """``Φ``, ``C₀``, ``C₁`` and the rate of ``C₁``."""
        n, box, swing = self.rub.numbers, self.box, self._swing
        mu, radius, turning, slide, around = n.mu, box.radius, box.turning, box.slide, 1 + box.turning
        factor, still, (slide_rate, turning_rate) = (2 * mu * box.off).exp(), self._still, self._rates
        first = factor * (mu * (mu * slide * slide + self.rub.torque(box.off)) - slide * swing)
        turned = still + mu * box.push
        swing_still = 2 * turned / radius + mu * mu * (still + turned)
        by_rate = -2 * swing / radius - 2 * around / radius**2 - 2 * mu * mu * swing
        stiff = self.rub.torque_slope(box.off)
        free = 2 * mu * turning * first + factor * (
            2 * mu * mu * slide * still
            + mu * stiff * turning
            - still * swing
            - slide * swing_still
            + slide * self._pull
        )
        fast = factor * (swing * swing - 2 * mu * mu * slide * swing - slide * by_rate)
        swing_rate = swing_still + box.rate * by_rate
        bend = -2 * swing_rate * (1 / radius + mu * mu) + 2 * box.rate * (swing + 2 * around / radius) / radius**2
        bend = bend - 2 * turning_rate / radius**2
        fast_rate = 2 * mu * turning * fast + factor * (
            2 * swing * swing_rate
            - 2 * mu * mu * (slide_rate * swing + slide * swing_rate)
            - slide_rate * by_rate
            - slide * bend
        )
        return first, free, fast, fast_rate

    @cached_property
    def rise(self) -> arb:
        """By how much ``V`` rises at most, from the first bounce on."""
        first, free, fast, fast_rate = self._growth
        least, v, fall = self._least, self.speed, (self.rub.numbers.d**2 * (1 + self._gain)).sqrt()
        height = v * v / (2 * least)
        areas = 2 * v**3 / least**2 / 3 / (1 - fall**3)
        squares = 4 * v**5 / least**3 / 15 / (1 - fall**5)
        here = height * abs(first).upper() + height * height * abs(fast).upper() / 2
        return free.upper().max(arb(0)) * areas + abs(fast_rate).upper() / 2 * squares + here

    def holds(self) -> bool:
        """Whether no bounce leaves the box as long as ``V < c``, slip stays forward, and bounces decay."""
        n, box, least = self.rub.numbers, self.box, self._least
        return bool(
            self.rub.torque(self.reach) > 0
            and self.rub.torque(-self.reach) < 0
            and least > 0
            and self.speed * self.speed / (2 * least) < box.gap.upper()
            and box.gap.upper() < 1
            and 1 + self._gain < rational(_FASTER * _FASTER)
            and n.d**2 * (1 + self._gain) < 1
            and box.turning.upper() < n.radius_ratio + 1
        )

    def takes(self, off: arb, slide: arb) -> bool:
        """Whether bounces that begin with ``δ`` and ``q`` in these balls stay in the region."""
        ends = [self.rub.potential(arb(end)) for end in (off.lower(), off.upper())]
        start = slide * slide * (2 * self.rub.numbers.mu * off).exp() / 2 + ends[0].max(ends[1])
        return bool(abs(off) < self.reach and self.holds() and start.upper() + self.rise < self.level)


def ends_in_rub(held: Held, patch: Patch) -> bool:
    """Whether all states of a patch, which leave the wall after an impact, are shown to decay to the stable rub."""
    rate, turning, angle = patch.box
    rub, speed = held.rub, arb((-rate).upper())
    sine, cosine = angle.sin_cos()
    along, across = rub.place
    # From the direction of the unbalance the rotor is at x = −ψ − arg P.
    turned = acb(cosine, -sine) / (held.numbers.product * acb(along, across))
    if not (turned.real > 0 and speed > 0):
        return False
    off, slide = turned.log().imag, turning - 1 - held.numbers.mu * rate
    return any(Bounces(rub, rational(reach), speed).takes(off, slide) for reach in REACHES)
