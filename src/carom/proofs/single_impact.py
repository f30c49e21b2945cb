"""Orbits with one impact a period: existence, uniqueness, the course between impacts, slip and stability.

At a root ``T`` of ``F₁`` the radial speed solves ``|q a₁₂|²ṙ² + 2 Re(q a₁₂)ṙ + 1 − |U*|² = 0``.  A positive discriminant
gives two simple solutions, so by the implicit function theorem each orbit is the only one near it.

*Between the impacts* ``R(t) = |U|² − 1`` is analytic with ``R(0) = R(T) = 0``, ``Ṙ(0) = −2dṙ`` and ``Ṙ(T) = 2ṙ``
(:mod:`carom.proofs.courses`).

*Stability.*  With trace ``τ``, sum of principal minors ``m`` and determinant ``D = d²e^{−2γT}`` of the derivative of the impact
map, all multipliers lie inside the unit circle exactly if (Schur, Cohn)

    |D| < 1,      1 − τ + m − D > 0,      1 + τ + m + D > 0,      Π_{j<k}(1 − λⱼλₖ) = 1 − m + D(τ − D) > 0.

If all lie inside or on it, none of these is violated.  So a violated one proves instability.

*Slip.*  No orbit with one impact a period stops its slip, or slips backward.  Let an impact leave no forward slip.  In the fixed frame the rotor then moves along the wall at a speed of ``−s`` or less,
``s = R/c_r``.  While it is inside, stiffness and unbalance push it along that tangent by less than ``ω² + ρ``, so from
``ẍ = −γẋ + …`` for ``γ ≥ 0``

    x(τ) ≤ −b(τ),      b(τ) = s(1 − e^{−γτ})/γ − (ω² + ρ)τ²/2,

a concave function with ``b(0) = 0``.  Let ``b(τ₁) > 1`` for a ``τ₁ ≤ π``.  A longer period would need ``|z| ≥ b(τ₁) > 1``
on the way.  A period ``T ≤ τ₁`` ends where the orbit began in the co-rotating frame, in the fixed frame at
``x(T) = sin T ≥ 0``, while ``x(T) ≤ −b(T) < 0``.  So there is no such orbit.  Without friction no impact stops the slip.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial

from flint import arb, arb_series

from carom.proofs.balls import decided, exact_ends, first, rational, terms
from carom.proofs.block_orbits import inside
from carom.proofs.claims import Claim, Status, claim_of
from carom.proofs.courses import FINEST, OrbitCourse, Return
from carom.proofs.lines import LineNumbers
from carom.proofs.periods import PeriodProof
from carom.proofs.rotor import TOO_LARGE, ProvenRotor

STEPS = 64
"""Times of half a turn at which it is looked."""
STATEMENT = (
    "No periodic motion with one impact a period, inside the clearance in between, has an impact that stops the slip "
    "or that begins with backward slip."
)


def slip_claim(n: LineNumbers[arb], statement: str = STATEMENT) -> Claim:
    """Claim that no orbit with one impact a period stops its slip or slips backward; of one machine, or all that balls hold."""
    if n.mu.is_zero():
        return claim_of("machine", "slip", "There is no friction: slip changes nothing.", 1)
    reason = "the rotor is so small or so strongly held that it may stay inside after such an impact"
    if not n.gamma >= 0:
        reason = "the argument requires non-negative damping"
    shown = any(out_of_clearance(n, Fraction(314 * k, 100 * STEPS)) for k in range(1, STEPS + 1))
    return claim_of("machine", "slip", statement, int(shown), reason=reason, limited=False)


def out_of_clearance(n: LineNumbers[arb], time: Fraction) -> bool:
    """Whether ``b > 1`` at a time of at most half a turn."""
    moment = rational(time)
    if not (time > 0 and moment <= arb.pi() and n.gamma >= 0):
        return False
    # Damping is strongest at the upper end; there e^{−γτ} has its least value.
    gamma = exact_ends(n.gamma)[1]
    way = (1 - (-rational(gamma) * moment).exp()) / rational(gamma) if gamma else moment
    return bool(n.radius_ratio * way - (n.omega_squared + n.rho) * moment * moment / 2 > 1)


def candidates(rotor: ProvenRotor, periods: PeriodProof) -> Iterator[tuple[str, dict[str, OrbitCourse[arb]] | None]]:
    """Both solutions of the closing conditions at each root, or none, or ``None`` where this is undecided, with the names they would have."""
    for root in periods.roots:
        back = Return(rotor.numbers, root.ball)
        letters = "bd" if root.longer else "ac"
        names = [f"B{root.pair},{letter}" for letter in letters]
        found, speeds = None, _radial_speeds(rotor, back)
        if speeds is not None:
            found = {name: OrbitCourse(back, speed) for name, speed in zip(names, speeds, strict=False)}
        yield f"B{root.pair},{'/'.join(letters)}", found


def _radial_speeds(rotor: ProvenRotor, back: Return[arb]) -> list[arb] | None:
    """Both radial speeds, the lower first; empty if there is none, ``None`` if that is undecided."""
    if back.discriminant < 0:
        return []
    if not back.discriminant > 0:
        return None
    if rotor.on_the_wall:
        other = -2 * back.lever.real / back.lever_squared
        return [arb(0), other] if other > 0 else [other, arb(0)]
    return list(back.speeds())


def orbit_claims(rotor: ProvenRotor, name: str, course: OrbitCourse[arb]) -> tuple[list[Claim], Status]:
    """Claims about one orbit, and whether it is a motion of the machine."""
    solution = rotor.claim(
        name,
        "solution",
        "The closing conditions of an orbit with one impact a period and forward slip have a solution with a period and a "
        "radial speed in these intervals; it is simple, so no other is next to it.",
        1,
        period=course.back.period,
        radial_speed=course.speed,
        angular_speed=course.angular_speed,
    )
    outward = rotor.claim(
        name,
        "outward",
        "Its radial speed before the impact is positive: it meets the wall from inside.",
        decided(course.speed) or (-1 if course.speed.is_zero() else 0),
        "its radial speed is not above 0" if course.speed <= 0 else "the sign of its radial speed is open",
    )
    claims = [solution, outward]
    if outward.status == "proven":
        claims += [_inside_claim(rotor, name, course), _slip_claim(rotor, name, course)]
    kinds = {claim.status for claim in claims}
    status: Status = "refuted" if "refuted" in kinds else "undecided" if "undecided" in kinds else "proven"
    claims.append(
        Claim(
            name,
            "admissible",
            "It is a motion of the machine: it meets the wall from inside, stays inside between its impacts, and its slip "
            "stays forward.",
            status,
            "; ".join(claim.reason for claim in claims if claim.status == status and claim.reason),
            limited_by_precision=any(claim.limited_by_precision for claim in claims),
        )
    )
    return [*claims, _stability_claim(rotor, name, course)], status


def _slip_claim(rotor: ProvenRotor, name: str, course: OrbitCourse[arb]) -> Claim:
    """Claim that the slip stays forward throughout the impact."""
    after = course.slip_after
    free = rotor.hypotheses.rational("mu") == (Fraction(0),)
    words = "friction would stop its slip, or its slip is backward"
    return rotor.claim(
        name,
        "slip",
        "Its slip is forward before the impact and after it, or there is no friction.",
        1 if free else decided(after),
        words if after < 0 else "whether its slip stays forward is open",
        slip_after=after,
    )


# ------------------------------------------------------------------------------------------------ between the impacts


def _inside_claim(rotor: ProvenRotor, name: str, course: OrbitCourse[arb]) -> Claim:
    """Claim that the orbit stays inside the wall strictly between its impacts."""
    claim = partial(rotor.claim, name, "inside", "It stays inside the wall, |U| < 1, strictly between its impacts.")
    if rotor.hypotheses.rational("d") == (Fraction(0),):
        # The rotor leaves with no radial speed, and the push decides.
        with terms(3):
            bend = course.height(arb_series([0, 1]))[0][2]
        if bend > 0:
            return claim(-1, "it would stay on the wall: it does not rebound and is pressed outward")
    stays = inside(course, lambda function: first(function(course)), narrowest=FINEST)
    if stays is None:
        reason = "neither could be shown: it comes too close to the wall for the width of the given numbers, or for the search"
        return claim(0, reason)
    return claim(1 if stays else -1, "it would cross the wall between its impacts")


# ------------------------------------------------------------------------------------------------ stability


def _stability_claim(rotor: ProvenRotor, name: str, course: OrbitCourse[arb]) -> Claim:
    """Claim that all multipliers lie inside the unit circle."""
    found = course.invariants
    conserved = rotor.hypotheses.rational("d", "gamma") == (Fraction(1), Fraction(0))
    signs = {words: decided(ball) for words, ball in found.conditions.items()}
    if conserved:
        signs[TOO_LARGE] = -1
    sign = min(signs.values())
    reasons = [words for words, value in signs.items() if value == sign]
    return rotor.claim(
        name,
        "stable",
        "All three multipliers of the impact map at it lie inside the unit circle.",
        sign,
        "; ".join(reasons) if sign < 0 else f"it is open whether {', or whether '.join(reasons)}",
        **found._asdict(),
    )
