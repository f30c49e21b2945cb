"""Levitation and synchronous rubs: existence, place and stability; kicks that never reach the wall.

*Levitation* ``|U*|² = ρ²/((1 − ω²)² + γ²)``, and its small vibrations decay exactly for ``γ > 0``.

*Synchronous rub* (``θ̇ = 0``, forward slip ``s + 1 > 0``): with ``κ = 1 − ω²`` the normal forces are the roots of
``(1 + μ²)N² − 2(κ − μγ)N + κ² + γ² − ρ² = 0``, with a quarter of the discriminant
``ρ²(1 + μ²) − (γ + μκ)²``.  Along the wall a disturbance obeys ``δ̈ + (γ + 2μ)δ̇ + Kδ = 0`` with
``K = (1 + μ²)N − κ + μγ``, the square root of it for the larger ``N`` and its negative for the smaller.

*Harmless kick.*  A kick of speed ``v`` out of levitation moves the rotor in the fixed frame along its own direction by
``v h(t)`` with the real response ``h`` to an impulse, ``ḧ + γḣ + ω²h = 0``, ``h(0) = 0`` and ``ḣ(0) = 1``: at most by ``v h(τ)`` with the
first turning point ``τ = (2/γ) x⁻¹ artanh x``, ``x² = 4D/γ²`` and ``D = γ²/4 − ω²``.  So it stays inside while ``v h(τ) < 1 − |U*|``.

*Next to the synchronous rub of the larger normal force* with ``δ = x − x*``, ``y = θ̇``, ``k = 2μ`` and ``T(δ) = K sin δ − (γ + μκ)(cos δ − 1)`` a slide obeys ``y' = −(γ + k)y − μy² − T``, and

    V = ½y²e^{kδ} + Π(δ),      Π = ∫₀^δ T(ξ)e^{kξ}dξ,      V' = −(γ + k)y²e^{kδ}.

Let ``T(A) > 0 > T(−A)`` with ``A ≤ π/2``, and ``c`` be the less of ``Π(±A)``.  Where ``V < c`` and ``|δ| ≤ A`` no slide gets out, and
``|y| ≤ √(2c)e^{μA}``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from flint import arb

from carom.proofs.balls import decided, hyperbolic, squared
from carom.proofs.claims import Claim, claim_of
from carom.proofs.lines import LineNumbers
from carom.proofs.rotor import ProvenRotor


def steady_claims(rotor: ProvenRotor) -> list[Claim]:
    """Claims about levitation, rubs and kicks."""
    rubs = [claim for name, side in (("rub 1", 1), ("rub 2", -1)) for claim in _claims_of_rub(rotor, name, side)]
    return [*_levitation_claims(rotor), *rubs, _kick_claim(rotor)]


def _levitation_claims(rotor: ProvenRotor) -> list[Claim]:
    radius, damping = rotor.numbers.levitation, rotor.hypotheses.numbers["gamma"]
    inside, reason = decided(1 - radius), "the sign of |U*| - 1 could not be shown"
    if rotor.on_the_wall:
        inside, reason = -1, "it lies on the wall"
    elif inside:
        reason = "it lies outside the wall"
    return [
        rotor.claim(
            "levitation",
            "inside",
            "The contact-free equilibrium lies inside the wall, |U*| < 1.",
            inside,
            reason,
            radius=radius,
        ),
        claim_of(
            "levitation",
            "stable",
            "Contact-free motions decay to the contact-free equilibrium.",
            1 if damping.low > 0 else -1 if damping.high <= 0 else 0,
            reason="the damping is not above 0" if damping.high <= 0 else "the damping may be 0",
            limited=False,
        ),
    ]


def _claims_of_rub(rotor: ProvenRotor, name: str, side: int) -> list[Claim]:
    """Claims about one synchronous rub: that of the larger normal force (1) or of the smaller (−1)."""
    n = rotor.numbers
    square, half = rub_discriminant(n), rub_balance(n)
    sign = _sign_of_square(rotor, square)
    which = "larger" if side > 0 else "smaller"
    exists = rotor.claim(
        name,
        "solution",
        f"The balance of forces of a synchronous rub has two solutions; this is the one with the {which} normal force.",
        sign,
        "no rub is in balance, or both are one" if sign < 0 else "the rubs may meet in a fold",
    )
    if exists.status != "proven":
        return [exists]
    force = rub_force(n, side)
    if half * side < 0 and rotor.on_the_wall:
        force = arb(0)
    pushes = decided(force) or (-1 if force.is_zero() else 0)
    pressed = rotor.claim(
        name,
        "pressed",
        "The wall pushes the rotor there: its normal force is positive.",
        pushes,
        "the wall would have to pull, or does not push" if force <= 0 else "the sign of its normal force is open",
        normal_force=force,
    )
    given = rotor.hypotheses.rational("gamma", "mu")
    damping = -1 if given and given[0] + 2 * given[1] == 0 else decided(n.gamma + 2 * n.mu)
    attracts = rotor.claim(
        name,
        "attracts sliding",
        "It is a motion of the machine, and small vibrations along the wall decay.",
        min(side, damping, pushes),
        "it is a saddle along the wall" if side < 0 else "it is not pressed on the wall, or sliding is not damped",
    )
    return [exists, pressed, attracts]


def wall_condition(n: LineNumbers[arb]) -> arb:
    """``(ω² − 1)² + γ² − ρ²``: zero where ``|U*| = 1``."""
    return squared(n.product) - n.rho * n.rho


def rub_force(n: LineNumbers[arb], side: int) -> arb:
    """Normal force of a rub, the larger (1) or the smaller (−1) root, where the discriminant is positive."""
    root, half = rub_discriminant(n).sqrt(), rub_balance(n)
    # The form without cancellation where there would be some.
    return wall_condition(n) / (half - side * root) if half * side < 0 else (half + side * root) / (1 + n.mu * n.mu)


def rub_discriminant(n: LineNumbers[arb]) -> arb:
    """``ρ²(1 + μ²) − (γ + μκ)²``: a quarter of the discriminant of both rubs."""
    pull = n.gamma + n.mu * (1 - n.omega_squared)
    return n.rho * n.rho * (1 + n.mu * n.mu) - pull * pull


def rub_balance(n: LineNumbers[arb]) -> arb:
    """``κ − μγ``, which decides what becomes of levitation where it meets the wall."""
    return 1 - n.omega_squared - n.mu * n.gamma


def _sign_of_square(rotor: ProvenRotor, square: arb) -> int:
    """Sign of the discriminant; not positive where it is exactly zero."""
    given = rotor.hypotheses.rational("gamma", "omega_squared", "rho", "mu")
    if given is not None:
        gamma, stiffness, rho, mu = given
        if rho**2 * (1 + mu**2) <= (gamma + mu * (1 - stiffness)) ** 2:
            return -1
    return decided(square)


def _kick_claim(rotor: ProvenRotor) -> Claim:
    """Claim that kicks below a speed are harmless; without damping or with it, and refuted where no speed is small enough."""
    statement = "The rotor levitates inside the wall, and no kick out of levitation slower than the lower number brings it to the wall."
    room = 1 - rotor.numbers.levitation
    damping = rotor.hypotheses.numbers["gamma"]
    claim = partial(rotor.claim, "kick", "harmless", statement)
    if rotor.on_the_wall or room < 0 or damping.high < 0:
        return claim(-1, "it does not levitate inside the wall, or any kick grows")
    if not (room > 0 and damping.low >= 0):
        return claim(0, "it may not levitate inside the wall, or a kick may grow")
    speed = contact_free_speed(rotor.numbers)
    if speed is None:
        return claim(0, "the largest response to a kick could not be enclosed")
    return claim(1, speed=speed)


def contact_free_speed(n: LineNumbers[arb]) -> arb | None:
    """Speed below which kicks are harmless; ``None`` where none is shown."""
    room = 1 - n.levitation
    if not (room > 0 and n.gamma >= 0):
        return None
    speed = room / _largest_response(n)
    return speed if speed.is_finite() and speed > 0 else None


def _largest_response(n: LineNumbers[arb]) -> arb:
    """``h(τ)``, the largest value of the response."""
    half, split = n.gamma / 2, n.split
    if split < 0:
        frequency = (-split).sqrt()
        time = arb.atan2(frequency, half) / frequency
    elif split > 0:
        rate = split.sqrt()
        time = ((half + rate) * (half + rate) / n.omega_squared).log() / (2 * rate)
    else:
        time = (split / (half * half)).hypgeom_2f1(arb(1) / 2, arb(1), arb(3) / 2) / half
    return (-half * time).exp() * hyperbolic(split, time)[1]


@dataclass(frozen=True)
class Rub:
    """The stable rub: numbers of the machine, its normal force ``N*`` and its stiffness ``K`` along the wall."""

    numbers: LineNumbers[arb]
    force: arb
    stiffness: arb

    @classmethod
    def of(cls, n: LineNumbers[arb]) -> Rub:
        """That of the larger normal force."""
        root = rub_discriminant(n).sqrt()
        return cls(n, (rub_balance(n) + root) / (1 + n.mu * n.mu), root)

    @property
    def exists(self) -> bool:
        """Whether there is one that presses on the wall."""
        return bool(self.stiffness > 0 and self.force > 0)

    def torque(self, off: arb) -> arb:
        """``T(δ)``."""
        return self.stiffness * off.sin() - self._push * (off.cos() - 1)

    def torque_slope(self, off: arb) -> arb:
        """``T'(δ)``."""
        return self.stiffness * off.cos() + self._push * off.sin()

    @property
    def place(self) -> tuple[arb, arb]:
        """``ρ cos x*`` and ``ρ sin x*``."""
        n = self.numbers
        return self.force - 1 + n.omega_squared, -n.gamma - n.mu * self.force

    def potential(self, off: arb) -> arb:
        """``Π(δ)``."""
        rate = 2 * self.numbers.mu
        growth, below = (rate * off).exp(), 1 + rate * rate
        sine = (growth * (rate * off.sin() - off.cos()) + 1) / below
        cosine = (growth * (rate * off.cos() + off.sin()) - rate) / below
        whole = off if rate.is_zero() else (rate * off).expm1() / rate
        return self.stiffness * sine - self._push * (cosine - whole)

    @property
    def _push(self) -> arb:
        n = self.numbers
        return n.gamma + n.mu * (1 - n.omega_squared)
