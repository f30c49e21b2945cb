"""Steady whirl in lasting contact: rolling, what leads to it, and speeds of the shaft at which there is none.

On the wall, with ``x = θ − φ``, the whirl ``W = 1 + θ̇``, ``w = −W`` and the forward slip ``s + W``,

    N = ρ cos x + W² − ω²,      W' = −γW − ρ sin x + F,      F = −μN (slip forward), μN (backward), |F| ≤ μN (none).

Write ``A = s² − ω²`` and ``p = ρ√(1 + μ²)``, which is the largest value of ``ρ(sin x + μ cos x)``.

*Rolling* has ``W = −s`` and passes all angles, so it needs ``A > ρ`` and ``|ρ sin x − γs| ≤ μN`` at all of them:
``μA ≥ |γ|s + p``.

*Slides.*  In backward whirl with forward slip ``w' = μ(w² − ω²) − γw + ρ(sin x + μ cos x)`` is at least ``−h(w) − p``,
``h(w) = γw − μ(w² − ω²)``.  Let ``−h(w_c) = p`` at the larger root: beyond ``w_c`` every slide gains speed.

*None.*  ``docs/theory/proofs.md`` shows: with ``γ ≥ 0`` and ``γs > μA`` no motion on the wall that whirls backward all the time
repeats after a turn.  At ``ν`` times the speed of the shaft ``γ`` is ``γ/ν`` and ``ω²`` is ``ω²/ν²``: the condition becomes
``ν < (γ + √(γ² + 4μ²ω²))/(2μs)``, for any unbalance.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, cast

from flint import arb

from carom.parameters import MACHINE_FIELDS
from carom.parameters.quantities import read_exact
from carom.proofs.balls import ball_of, decided, enclosures_of
from carom.proofs.claims import Claim, claim_of
from carom.proofs.lines import LineNumbers
from carom.proofs.rotor import ProvenRotor

_NAMES = ("gamma", "omega_squared", "rho", "mu", "radius_ratio")
BACKWARD = "no motion that is pressed on the wall and whirls backward all the time repeats after a turn"


def whirl_claims(rotor: ProvenRotor) -> list[Claim]:
    """Claims about rolling and its absence."""
    exact = exact_numbers(rotor)
    rolls = _rolling_claim(rotor, exact)
    return [
        rolls,
        _attraction_claim(rotor, exact),
        _absence_claim(rotor, exact, rolls.status == "proven"),
        _below_claim(rotor, exact),
    ]


def exact_numbers(rotor: ProvenRotor) -> LineNumbers[arb]:
    """The numbers as fractions, if all that count here are rational; else as balls."""
    given = rotor.hypotheses.rational(*_NAMES)
    if given is None:
        return rotor.numbers
    gamma, stiffness, rho, mu, ratio = given
    return cast("LineNumbers[arb]", LineNumbers(gamma, stiffness, rho, mu, Fraction(0), ratio))


def sign_of(value: arb | Fraction) -> int | None:
    """Sign of a fraction or of all numbers of a ball; ``None`` if it is not decided."""
    if isinstance(value, Fraction):
        return (value > 0) - (value < 0)
    return 0 if value.is_zero() else decided(value) or None


def rolling_force(n: LineNumbers[arb]) -> arb:
    """``A = s² − ω²``, the mean normal force of rolling."""
    return n.radius_ratio * n.radius_ratio - n.omega_squared


def excitation_of(n: LineNumbers[arb]) -> arb:
    """``p = ρ√(1 + μ²)`` as a ball."""
    return n.rho * (1 + n.mu * n.mu).sqrt()


def _against_pull(value: arb | Fraction, n: Any) -> int | None:
    """Sign of a value less ``p``, exactly for fractions."""
    if isinstance(value, Fraction):
        return -1 if value < 0 else sign_of(value * value - n.rho * n.rho * (1 + n.mu * n.mu))
    return sign_of(value - excitation_of(n))


def rolling_signs(n: LineNumbers[arb]) -> tuple[int | None, int | None]:
    """Signs of ``A − ρ`` and of ``μA − |γ|s − p``: rolling is pressed, and held."""
    force = rolling_force(n)
    return sign_of(force - n.rho), _against_pull(n.mu * force - abs(n.gamma) * n.radius_ratio, n)


def rolling_sign(n: LineNumbers[arb]) -> int | None:
    """1 if rolling lasts, −1 if it does not."""
    pressed, held = rolling_signs(n)
    if pressed in (0, -1) or held == -1:
        return -1
    return 1 if pressed == 1 and held in (0, 1) else None


def drag_sign(n: LineNumbers[arb]) -> int | None:
    """1 if ``γ ≥ 0`` and ``γs > μA``: no backward whirl on the wall repeats; else −1."""
    damping, excess = sign_of(n.gamma), sign_of(n.gamma * n.radius_ratio - n.mu * rolling_force(n))
    if damping == -1 or excess in (0, -1):
        return -1
    not_negative = damping in (0, 1) or bool(n.gamma >= 0)
    return 1 if not_negative and excess == 1 else None


def _claim(rotor: ProvenRotor, kind: str, statement: str, sign: int | None, reason: str = "", **balls: arb) -> Claim:
    """Claim about whirl.  More bits may decide it where the sign is ``None``."""
    limited = rotor.hypotheses.exact and sign is None
    shown = reason or ("the sign of a condition is open" if sign is None else "")
    numbers = enclosures_of(**balls) if sign == 1 else {}
    return claim_of("whirl", kind, statement, sign or 0, reason=shown, enclosures=numbers, limited=limited)


def _rolling_claim(rotor: ProvenRotor, exact: LineNumbers[arb]) -> Claim:
    n, sign = rotor.numbers, rolling_sign(exact)
    pressed, _ = rolling_signs(exact)
    reason = "the wall would have to pull" if pressed in (0, -1) else "friction is too weak"
    force = rolling_force(n)
    return _claim(
        rotor,
        "rolls",
        "The rotor can roll on the wall without slip, backward, for ever: at every angle the wall pushes and friction holds it.",
        sign,
        reason if sign == -1 else "",
        speed=n.radius_ratio,
        least_normal_force=force - n.rho,
        spare_friction=n.mu * force - abs(n.gamma) * n.radius_ratio - excitation_of(n),
    )


def _attraction_claim(rotor: ProvenRotor, exact: LineNumbers[arb]) -> Claim:
    """Faster than ``w_c`` slides gain speed; faster than rolling they lose it, at a rate that rolling bounds."""
    n, (_, held), rolls = rotor.numbers, rolling_signs(exact), rolling_sign(exact)
    speed = attracting_speed(n)
    sign = rolls if rolls != 1 else 1 if held == 1 and speed < n.radius_ratio else 0 if held == 0 else None
    reasons = {-1: "it cannot roll for ever", 0: "friction just suffices for rolling"}
    return _claim(
        rotor,
        "attracts sliding",
        "Every motion on the wall in backward whirl faster than the upper end of speed stays pressed and after a finite time rolls for ever.",
        sign,
        reasons.get(sign, "") if sign is not None else "",
        speed=speed,
    )


def attracting_speed(n: LineNumbers[arb]) -> arb:
    """Speed of backward whirl from which on slides gain speed and contact is kept, as a ball."""
    speed = sustaining_speed(n, excitation_of(n))
    # With damping that is not negative contact asks for no more.
    return speed if n.gamma >= 0 else speed.max((n.omega_squared + n.rho).sqrt())


def sustaining_speed(n: LineNumbers[arb], excitation: arb | int) -> arb:
    """Larger root ``w`` of ``μ(w² − ω²) − γw = excitation``, as a ball."""
    return (n.gamma + (n.gamma * n.gamma + 4 * n.mu * (n.mu * n.omega_squared + excitation)).sqrt()) / (2 * n.mu)


def _absence_claim(rotor: ProvenRotor, exact: LineNumbers[arb], rolls: bool) -> Claim:
    statement = f"Dry-friction whirl in lasting contact is absent: {BACKWARD}."
    if rolls:
        return _claim(rotor, "absent", statement, -1, "the rotor can roll")
    sign = drag_sign(exact)
    reason = "the damping is too weak to suppress all backward whirl" if sign == -1 else ""
    return _claim(rotor, "absent", statement, 0 if sign == -1 else sign, reason)


def _below_claim(rotor: ProvenRotor, exact: LineNumbers[arb]) -> Claim:
    """Claim for all speeds of the shaft below a share of the present one; for all speeds without friction."""
    n, damping, friction = rotor.numbers, sign_of(exact.gamma), sign_of(exact.mu)
    words = "With its damping and stiffness, at every speed of the shaft"
    below = f"{words} below the lower end of share times the present one, {BACKWARD}."
    if damping == -1:
        return _claim(rotor, "absent below", below, 0, "the argument requires non-negative damping")
    if damping == 0 and friction == 0:
        return _claim(rotor, "absent below", below, 0, "there is neither damping nor friction")
    if friction == 0:
        return _claim(rotor, "absent below", f"{words} {BACKWARD}.", 1)
    share = sustaining_speed(n, 0) / n.radius_ratio
    numbers, given = {"share": share}, rotor.hypotheses
    if given.table == "machine":
        numbers["speed_si"] = share * ball_of(read_exact(MACHINE_FIELDS["speed"], given.values["speed"]))
    shown = n.gamma >= 0 and share.is_finite() and share > 0
    return _claim(rotor, "absent below", below, 1 if shown else None, "", **numbers)
