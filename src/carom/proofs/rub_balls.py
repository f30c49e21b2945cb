"""A ball around a stable synchronous rub from which all motions decay to it, sliding or bouncing.

With ``δ = x − x*``, ``y = θ̇``, ``k = 2μ`` and ``T(δ) = K sin δ − (γ + μκ)(cos δ − 1)`` a slide obeys ``y' = −(γ + k)y − μy² − T``, and

    V = ½y²e^{kδ} + Π(δ),      Π = ∫₀^δ T(ξ)e^{kξ}dξ,      V' = −(γ + k)y²e^{kδ}.

Let ``T(A) > 0 > T(−A)`` with ``A ≤ π/2``, and ``c`` be the less of ``Π(±A)``.  Where ``V < c`` and ``|δ| ≤ A`` no slide gets out, and
``|y| ≤ Q = √(2c)e^{μA}``.

*Bounces.*  In flight, with the gap ``g = 1 − r``, ``q = y − μr'`` is continuous at impacts and

    r'' = r((1 + y)² − ω²) − γr' + ρ cos x,
    q' = S(δ, q) − 2(1 + y)r'/r − gρ sin x/r − μ(μr'(2 + y + q) − g((1 + y)² − ω²)),

``S`` the right side of the slide.  As long as ``(1 − ε)N* ≤ r'' ≤ (1 + ε)N*``, which are ``n₁`` and ``n₂``, a bounce of speed ``v``
is at most ``v²/(2n₁)`` high and ``2v/n₁`` long, and the next one has at most the speed ``λv``, ``λ² = d²n₂/n₁ < 1``.  So all bounces
end in a finite time, and ``∫|r'| ≤ v²/(n₁(1 − λ²))``, ``∫g ≤ v³/(n₁²(1 − λ³))``; together they raise ``V(δ, q)`` by no more than
``C₁∫|r'| + C₂∫g`` with the constants of :class:`Trap`.  ``docs/theory/proofs.md`` has all steps.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import floor, log2
from typing import Any

from flint import arb

from carom.proofs.balls import enclosure_of_fraction, enclosures_of, rational
from carom.proofs.claims import Claim, claim_of
from carom.proofs.evidence import Evidence, NotShownError, rational_of
from carom.proofs.lines import Numbers
from carom.proofs.rotor import Rotor
from carom.proofs.steady import rub_balance, rub_discriminant

WIDEST = Fraction(3, 2)
"""Largest reach, in radians: less than π/2."""
BITS_OF_SIZE = 8
"""Significant bits of sizes, about."""
_SIZES_TRIED, _SLIDE_SPREAD = 150, Fraction(15, 16)
_SIZES = ("reach", "angle", "rate", "radial_speed", "gap")


@dataclass(frozen=True)
class Rub:
    """The stable rub: numbers of the machine, its normal force ``N*`` and its stiffness ``K`` along the wall."""

    numbers: Numbers
    force: Any
    stiffness: Any

    @classmethod
    def of(cls, n: Numbers) -> Rub:
        """That of the larger normal force."""
        root = rub_discriminant(n).sqrt()
        return cls(n, (rub_balance(n) + root) / (1 + n.mu * n.mu), root)

    @property
    def exists(self) -> bool:
        """Whether there is one that presses on the wall."""
        return bool(self.stiffness > 0 and self.force > 0)

    def torque(self, off: Any) -> Any:
        """``T(δ)``."""
        return self.stiffness * off.sin() - self._push * (off.cos() - 1)

    def torque_slope(self, off: Any) -> Any:
        """``T'(δ)``."""
        return self.stiffness * off.cos() + self._push * off.sin()

    @property
    def place(self) -> tuple[Any, Any]:
        """``ρ cos x*`` and ``ρ sin x*``."""
        n = self.numbers
        return self.force - 1 + n.omega_squared, -n.gamma - n.mu * self.force

    def potential(self, off: Any) -> Any:
        """``Π(δ)``."""
        rate = 2 * self.numbers.mu
        growth, below = (rate * off).exp(), 1 + rate * rate
        sine = (growth * (rate * off.sin() - off.cos()) + 1) / below
        cosine = (growth * (rate * off.cos() + off.sin()) - rate) / below
        whole = off if rate.is_zero() else (rate * off).expm1() / rate
        return self.stiffness * sine - self._push * (cosine - whole)

    @property
    def _push(self) -> Any:
        n = self.numbers
        return n.gamma + n.mu * (1 - n.omega_squared)

    def turn_of_force(self, reach: Any) -> Any:
        """Largest ``ρ|cos x − cos x*|`` for ``|δ|`` up to a reach of at most π/2."""
        along, across = self.place
        return abs(along) * (1 - reach.cos()) + abs(across) * reach.sin()


@dataclass(frozen=True)
class Trap:
    """The region ``V < c`` of a reach around a rub, and what bounces of a speed do in it.

    Attributes
    ----------
    rub : Rub
    reach, speed : arb
        ``A``, and the speed ``v`` of the first bounce, or what its gap is worth in speed; zero for slides.
    spread : arb
        ``ε``, by how much ``r''`` may differ from ``N*``, as a share of it.
    """

    rub: Rub
    reach: Any
    speed: Any
    spread: Any

    @property
    def level(self) -> Any:
        """``c``."""
        return self.rub.potential(self.reach).min(self.rub.potential(-self.reach))

    @property
    def least_force(self) -> Any:
        """``n₁``."""
        return (1 - self.spread) * self.rub.force

    @property
    def _growth(self) -> Any:
        return (2 * self.rub.numbers.mu * self.reach).exp()

    @property
    def _slide(self) -> Any:
        """``Q``."""
        return (2 * self.level * self._growth).sqrt()

    @property
    def _landing(self) -> Any:
        """Largest radial speed."""
        return self.speed * ((1 + self.spread) / (1 - self.spread)).sqrt()

    @property
    def _turning(self) -> Any:
        """``Y``, the largest ``|θ̇|``."""
        return self._slide + self.rub.numbers.mu * self._landing

    @property
    def _height(self) -> Any:
        return self.speed * self.speed / (2 * self.least_force)

    @property
    def _swirl(self) -> Any:
        """Bound of ``|(1 + y)² − ω²|``."""
        return abs(1 - self.rub.numbers.omega_squared) + 2 * self._turning + self._turning * self._turning

    def holds(self) -> bool:
        """Whether no slide gets out, ``r''`` keeps to its range, slip stays forward and bounces die out."""
        n, turning = self.rub.numbers, self._turning
        change = self.rub.turn_of_force(self.reach) + 2 * turning + turning * turning
        change += self._height * self._swirl + abs(n.gamma) * self._landing
        return bool(
            self.rub.torque(self.reach) > 0
            and self.rub.torque(-self.reach) < 0
            and change < self.spread * self.rub.force
            and turning < n.radius_ratio + 1
            and (self.slides or (self._height < 1 and self._decay < 1))
        )

    @property
    def slides(self) -> bool:
        """Whether there is no bounce."""
        return bool(self.speed.is_zero())

    @property
    def _decay(self) -> Any:
        """``λ``."""
        return self.rub.numbers.d * ((1 + self.spread) / (1 - self.spread)).sqrt()

    @property
    def rise(self) -> Any:
        """By how much all bounces together raise ``V`` at most."""
        if self.slides:
            return arb(0)
        n, turning, slide, radius = self.rub.numbers, self._turning, self._slide, 1 - self._height
        pull, growth = n.rho * (1 + n.mu * n.mu).sqrt(), self._growth
        by_speed = 2 * (1 + turning) / radius + n.mu * n.mu * (2 + turning + slide)
        by_gap = n.rho / radius + n.mu * self._swirl
        first = growth * (n.mu * (n.mu * slide * slide + pull * self.reach) + slide * by_speed)
        way = self.speed * self.speed / (self.least_force * (1 - self._decay**2))
        gaps = self.speed**3 / (self.least_force**2 * (1 - self._decay**3))
        return first * way + growth * slide * by_gap * gaps

    def takes(self, angle: Any, rate: Any) -> bool:
        """Whether all states of such sizes stay in the region."""
        n = self.rub.numbers
        fast = rate + n.mu * self.speed
        start = fast * fast * (2 * n.mu * angle).exp() / 2 + self.rub.potential(angle).max(self.rub.potential(-angle))
        return bool(angle < self.reach and start + self.rise < self.level)


_BALL = (
    "Every state {} whose angle differs by at most angle from that of the rub of the larger normal force, and whose angular speed in the "
    "co-rotating frame is at most rate, {} and decays to the rub; the wall pushes all the time by more than the lower end of least_normal_force."
)
_SLIDES = _BALL.format("on the wall without radial speed", "stays on the wall")
_BOUNCES = _BALL.format(
    "with a gap to the wall of at most gap and a radial speed of at most radial_speed,",
    "stops bouncing after a finite time, stays on the wall from then on",
).replace("the wall pushes all the time", "then the wall pushes")


def rub_ball_claims(rotor: Rotor, evidence: Evidence) -> list[Claim]:
    """Claims about the stable rub, which must be proven to attract slides: a ball of slides, and one with bounces if they die out."""
    rub, restitution = Rub.of(rotor.numbers), rotor.hypotheses.numbers["d"].high
    sizes = evidence.take("ball of slides", lambda: _searched(rub, _SLIDE_SPREAD, bounces=False))
    claims = [_claim_of(rotor, rub, _SLIDE_SPREAD, sizes, bounces=False)]
    if restitution < 1:
        spread = bounce_spread(restitution)
        sizes = evidence.take("ball of bounces", lambda: _searched(rub, spread, bounces=True))
        claims.append(_claim_of(rotor, rub, spread, sizes, bounces=True))
    return claims


def bounce_spread(restitution: Fraction) -> Fraction:
    """Share ``ε`` with which ``λ ≤ (1 + d)/2``, at most 1/2."""
    most = ((1 + restitution) / (2 * restitution)) ** 2 if restitution else Fraction(3)
    return min((most - 1) / (most + 1), Fraction(1, 2))


def trap_of(rub: Rub, spread: Fraction, reach: Fraction, radial: Fraction, gap: Fraction) -> Trap:
    """The region whose first bounce has a radial speed and a gap at the beginning."""
    share = rational(spread)
    worth = rational(radial * radial) + 2 * (1 - share) * rub.force * rational(gap)
    return Trap(rub, rational(reach), worth.sqrt(), share)


def _claim_of(rotor: Rotor, rub: Rub, spread: Fraction, sizes: list[str] | None, *, bounces: bool) -> Claim:
    about, kind = "ball at rub 1", "bounces in" if bounces else "slides in"
    statement = _BOUNCES if bounces else _SLIDES
    if sizes is None:
        return claim_of(about, kind, statement, 0, reason="no ball was found", limited=False)
    names = _SIZES if bounces else _SIZES[:3]
    if len(sizes) != len(names):
        raise NotShownError("the certificate has a ball of other sizes")
    given = dict(zip(names, (rational_of(size) for size in sizes), strict=True))
    trap = trap_of(rub, spread, given["reach"], given.get("radial_speed", Fraction(0)), given.get("gap", Fraction(0)))
    kept = min(given.values()) > 0 and given["reach"] <= WIDEST and trap.holds()
    if not (kept and trap.takes(rational(given["angle"]), rational(given["rate"]))):
        raise NotShownError("the certificate has a ball that is not shown to be kept")
    numbers = {name: enclosure_of_fraction(given[name]) for name in names[1:]} | enclosures_of(
        least_normal_force=trap.least_force
    )
    return claim_of(about, kind, statement, 1, enclosures=numbers)


# ------------------------------------------------------------------------------------------------ search


def _searched(rub: Rub, spread: Fraction, *, bounces: bool) -> list[str] | None:
    """Sizes of a ball, in the order of :data:`_SIZES`; without the last two for slides."""
    nothing = Fraction(0)
    reach = next((size for size in _falling(WIDEST) if trap_of(rub, spread, size, nothing, nothing).holds()), None)
    if reach is None:
        return None
    # Bounces need some of the room.
    reach = reach * Fraction(3, 4) if bounces else reach
    swing = Fraction(float(rub.stiffness.sqrt().mid()))
    least = float(((1 - rational(spread)) * rub.force).mid())
    for angle in _falling(reach / 2 if bounces else reach):
        ball = (reach, angle, _short(float(angle * swing)))
        if not bounces:
            if _kept(rub, spread, *ball):
                return [str(size) for size in ball]
            continue
        for speed in _falling(Fraction(1)):
            radial, gap = _short(float(speed) / 2**0.5), _short(float(speed) ** 2 / (4 * least))
            if _kept(rub, spread, *ball, radial, gap):
                return [str(size) for size in (*ball, radial, gap)]
    return None


def _kept(rub: Rub, spread: Fraction, reach: Fraction, angle: Fraction, rate: Fraction, *start: Fraction) -> bool:
    """Whether a ball stays in the region; ``start`` is its radial speed and gap, if it has any."""
    trap = trap_of(rub, spread, reach, *(start or (Fraction(0), Fraction(0))))
    return trap.holds() and trap.takes(rational(angle), rational(rate))


def _falling(largest: Fraction) -> Iterator[Fraction]:
    """Sizes from the largest one down, each about a seventh less."""
    return (_short(float(largest) * 0.86**k) for k in range(_SIZES_TRIED))


def _short(size: float) -> Fraction:
    """A size, rounded down to a few bits."""
    if not size:
        return Fraction(0)
    scale = Fraction(2) ** (BITS_OF_SIZE - floor(log2(size)))
    return floor(Fraction(size) * scale) / scale
