"""No orbit with one impact a period stops its slip, or slips backward.

Let an impact leave no forward slip.  In the fixed frame the rotor then moves along the wall at a speed of ``−s`` or less,
``s = R/c_r``.  While it is inside, stiffness and unbalance push it along that tangent by less than ``ω² + ρ``, so from
``ẍ = −γẋ + …`` for ``γ ≥ 0``

    x(τ) ≤ −b(τ),      b(τ) = s(1 − e^{−γτ})/γ − (ω² + ρ)τ²/2,

a concave function with ``b(0) = 0``.  Let ``b(τ₁) > 1`` for a ``τ₁ ≤ π``.  A longer period would need ``|z| ≥ b(τ₁) > 1``
on the way.  A period ``T ≤ τ₁`` ends where the orbit began in the co-rotating frame, in the fixed frame at
``x(T) = sin T ≥ 0``, while ``x(T) ≤ −b(T) < 0``.  So there is no such orbit.  Without friction no impact stops the slip.
"""

from __future__ import annotations

from fractions import Fraction

from flint import arb

from carom.proofs.balls import exact_ends, rational
from carom.proofs.claims import Claim, claim_of
from carom.proofs.lines import LineNumbers

STEPS = 64
"""Times of half a turn at which it is looked."""
STATEMENT = (
    "No periodic motion with one impact a period, inside the clearance in between, has an impact that stops the slip "
    "or that begins with backward slip."
)


def slip_claim(n: LineNumbers, statement: str = STATEMENT) -> Claim:
    """Claim that no orbit with one impact a period stops its slip or slips backward; of one machine, or all that balls hold."""
    if n.mu.is_zero():
        return claim_of("machine", "slip", "There is no friction: slip changes nothing.", 1)
    reason = "the rotor is so small or so strongly held that it may stay inside after such an impact"
    if not n.gamma >= 0:
        reason = "the argument needs damping that is not negative"
    shown = any(out_of_clearance(n, Fraction(314 * k, 100 * STEPS)) for k in range(1, STEPS + 1))
    return claim_of("machine", "slip", statement, int(shown), reason=reason, limited=False)


def out_of_clearance(n: LineNumbers, time: Fraction) -> bool:
    """Whether ``b > 1`` at a time of at most half a turn."""
    moment = rational(time)
    if not (time > 0 and moment <= arb.pi() and n.gamma >= 0):
        return False
    # Damping is strongest at the upper end; there e^{−γτ} has its least value.
    gamma = exact_ends(n.gamma)[1]
    way = (1 - (-rational(gamma) * moment).exp()) / rational(gamma) if gamma else moment
    return bool(n.radius_ratio * way - (n.omega_squared + n.rho) * moment * moment / 2 > 1)
