"""Where motions begin and end: each threshold in closed form, as a condition and as its solutions for a parameter.

The only place in which these formulas are written.  With ``κ = 1 − ω²`` and ``p = ρ√(1 + μ²)``:

*Levitation* ``U* = ρe^{iφ}/(ω² − 1 + iγ)`` (source paper (3.7)) meets the wall on the circle ``κ² + γ² = ρ²`` and is inside
the wall outside of this circle.

*Synchronous rub.*  With ``x = θ − φ`` (:func:`~carom.closed_forms.equilibria.find_equilibria`)

    ρ(sin x + μ cos x) = −(γ + μκ),      N = ρ cos x + κ.

The left side is at most ``p`` in size, so there are two rubs in the strip ``|γ + μκ| < p``, and they meet in a fold on
its edges ``γ + μκ = ±p``, where ``cos x = ∓μ/√(1 + μ²)`` and ``N = κ ∓ ρμ/√(1 + μ²)``.  Without ``x``,

    (1 + μ²)N² − 2(κ − μγ)N + κ² + γ² − ρ² = 0.

The larger root is the rub on which ``ρ(cos x − μ sin x) = (1 + μ²)N − κ + μγ > 0``, so that angles near it are drawn back.
It is pressed on the wall inside the circle, and outside of it where ``κ > μγ`` in the strip.  The line ``κ = μγ`` crosses
the circle at ``±(ρμ, ρ)/√(1 + μ²)``, where the edges of the strip touch it.  So a rub is pressed on the wall in the disc
and in the half of the strip that adjoins it towards larger ``κ``; its force vanishes on the circle, or it ends in a fold.
Sliding next to it is damped at the rate ``γ + 2μ`` (:mod:`carom.closed_forms.absorbing`), and bounces need ``d < 1`` to
die out.  Where levitation meets the wall, a rub with ``N ≈ (1 − |U*|)ρ²/(κ − μγ)`` appears there.

*Backward whirl* at the speed ``w`` in the fixed frame (:mod:`carom.closed_forms.whirl` derives it) gains speed by sliding
where ``μ(w² − ω²) − γw`` exceeds ``p``, at every angle, or zero, on average over a turn.  Rolling, ``w = s``, holds where
``|γ|s + p ≤ μ(s² − ω²)``.  This includes contact: ``s² − ω² ≥ p/μ > ρ``.
"""

from __future__ import annotations

import math
from typing import Literal, get_args

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.models import Edge, Span, Subject, exact_rotor_of
from carom.parameters import Numbers, Parameters

Gain = Literal["gamma", "omega"]
Steady = Literal["contact-free", "rub", "rolling"]
BoundaryKind = Literal["persistence", "non-smooth fold", "degenerate"]
Values = Parameters | Numbers
"""Dimensionless parameters, checked or as plain numbers."""


ZERO, INFINITE = Edge(0.0), Edge(math.inf)
WALL, FOLD, ROLLING = "boundary-equilibrium", "rub-fold", "rolling-limit"
DEGENERATE = 1e-12


def _kappa(at: Values) -> float:
    return (1.0 - at.omega) * (1.0 + at.omega)


def _stiffness_squared(at: Values) -> float:
    """``|ω² − 1 + iγ|²``; the force that a unit displacement in the co-rotating frame takes is its root."""
    return _kappa(at) ** 2 + at.gamma**2


def _leg(hypotenuse: float, leg: float) -> float:
    """Other leg of a right-angled triangle, zero if there is none."""
    return math.sqrt(max((hypotenuse - leg) * (hypotenuse + leg), 0.0))


def largest_excitation(at: Values) -> float:
    """``p = ρ√(1 + μ²)``, the largest force along the wall by the unbalance and the friction due to it."""
    return at.rho * (1.0 + at.mu**2) ** 0.5


# ------------------------------------------------------------------------------------------------ levitation


def wall_condition(at: Values) -> float:
    """``|U*|² − 1``: zero where levitation meets the wall; infinite at an undamped resonance."""
    square = _stiffness_squared(at)
    if square == 0.0:
        return -1.0 if at.rho == 0.0 else math.inf
    return at.rho**2 / square - 1.0


def boundary_balance(at: Values) -> float:
    """``κ − μγ``, which decides what becomes of levitation where it meets the wall (:func:`boundary_kind`)."""
    return _kappa(at) - at.mu * at.gamma


def boundary_kind(at: Values) -> BoundaryKind:
    """Whether levitation that reaches the wall turns into a stable rub (persistence) or vanishes with an unstable one."""
    balance = boundary_balance(at)
    if abs(balance) <= DEGENERATE:
        return "degenerate"
    return "non-smooth fold" if balance > 0.0 else "persistence"


def _levitation_ranges(at: Values, gain: Gain) -> tuple[Span, ...]:
    if gain == "gamma":
        half = _leg(at.rho, _kappa(at))
        return (Span(Edge(half, WALL) if half > 0.0 else ZERO, INFINITE),)
    half = _leg(at.rho, at.gamma)
    if half == 0.0:
        return (Span(ZERO, INFINITE),)
    above = Span(Edge(math.sqrt(1.0 + half), WALL), INFINITE)
    return (Span(ZERO, Edge(math.sqrt(1.0 - half), WALL)), above) if half < 1.0 else (above,)


# ------------------------------------------------------------------------------------------------ synchronous rub


def rub_fold_condition(at: Values) -> float:
    """``p² − (γ + μκ)²``: zero where the two synchronous rubs meet, negative where there are none."""
    excitation, need = largest_excitation(at), at.gamma + at.mu * _kappa(at)
    return (excitation - need) * (excitation + need)


def _rub_fold_force(at: Values, edge: float = 1.0) -> float:
    """Normal force ``N = κ ∓ ρμ/√(1 + μ²)`` of the rubs that meet on the edge ``γ + μκ = ±p`` with the sign of ``edge``."""
    return _kappa(at) - math.copysign(at.rho * at.mu / math.hypot(1.0, at.mu), edge)


def happens_to_rubs(at: Values) -> bool:
    """Whether the wall pushes the rubs that meet at a fold; otherwise it happens to no motion of the machine."""
    return _rub_fold_force(at, at.gamma + at.mu * _kappa(at)) > 0.0


def has_stable_rub(at: Values) -> bool:
    """Whether a stable synchronous rub, pressed on the wall, exists; for either sign of the damping."""
    strip = boundary_balance(at) > 0.0 and rub_fold_condition(at) > 0.0
    return (strip or wall_condition(at) > 0.0) and at.gamma + 2.0 * at.mu > 0.0 and at.d < 1.0


@checked
def rub_limit(machine: Subject) -> float:
    """Damping up to which a stable synchronous rub exists, with the other parameters unchanged.

    The rub ends in a fold, ``γ = p − μκ``, if it is pressed on the wall there; otherwise its force vanishes on the circle
    ``κ² + γ² = ρ²`` (derived in :mod:`carom.closed_forms.thresholds`).  Above the limit there is no stable rub; for positive
    damping below it there always is one, unless the restitution is one.  The limit is not positive if there is no rub with
    positive damping.

    See Also
    --------
    carom.find_equilibria : the rubs themselves

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> print(f"{cm.closed_forms.rub_limit(machine):.7f}")
    0.3700060
    """
    return _rub_end(exact_rotor_of(machine).parameters).value


def _rub_end(at: Values) -> Edge:
    if _rub_fold_force(at) >= 0.0:
        return Edge(largest_excitation(at) - at.mu * _kappa(at), FOLD)
    return Edge(_leg(at.rho, _kappa(at)), WALL)


def _rub_ranges(at: Values, gain: Gain) -> tuple[Span, ...]:
    if gain == "gamma":
        end = _rub_end(at)
        return (Span(ZERO, end),) if end.value > 0.0 else ()
    excitation, touch, half = largest_excitation(at), at.rho / math.hypot(1.0, at.mu), _leg(at.rho, at.gamma)
    # Ends of the range of κ; the soft one is the upper one.
    if at.mu == 0.0:
        soft, stiff = (math.inf if half > 0.0 else 0.0, FOLD), (-half, WALL)
    else:
        soft = ((excitation - at.gamma) / at.mu, FOLD) if at.gamma <= touch else (half, WALL)
        stiff = (-half, WALL) if at.gamma >= -touch else (-(excitation + at.gamma) / at.mu, FOLD)
    if not stiff[0] < min(soft[0], 1.0):
        return ()
    low = Edge(math.sqrt(1.0 - soft[0]), soft[1]) if soft[0] < 1.0 else ZERO
    return (Span(low, Edge(math.sqrt(1.0 - stiff[0]), stiff[1])),)


# ------------------------------------------------------------------------------------------------ backward whirl


def sustaining_speed(at: Values, excitation: float = 0.0) -> float:
    """Larger root ``w`` of ``μ(w² − ω²) − γw = excitation``, above which sliding feeds backward whirl; infinite without friction.

    With :func:`largest_excitation` it suffices at every angle; with zero on average over a turn.
    """
    gamma, mu = at.gamma, at.mu
    if mu == 0.0:
        return math.inf
    gain = 2.0 * mu * at.omega * at.omega + 2.0 * excitation
    root = math.sqrt(gamma * gamma + 2.0 * mu * gain)
    # The form without cancellation for either sign of the damping.
    return (gamma + root) / (2.0 * mu) if gamma >= 0.0 else gain / (root - gamma)


def mean_rolling_force(at: Values) -> float:
    """Normal force of rolling averaged over a turn, ``s² − ω²``; over the turn it varies by ``±ρ``."""
    return (at.radius_ratio - at.omega) * (at.radius_ratio + at.omega)


def rolling_condition(at: Values) -> float:
    """``μ(s² − ω²) − |γ|s − p``: not negative where friction can hold rolling at every angle."""
    return at.mu * mean_rolling_force(at) - abs(at.gamma) * at.radius_ratio - largest_excitation(at)


def rolling_damping(at: Values) -> float:
    """Largest ``γ = (μ(s² − ω²) − p)/s`` with which rolling holds; not positive if friction is too weak for any."""
    return (at.mu * mean_rolling_force(at) - largest_excitation(at)) / at.radius_ratio


def whirl_damping(at: Values) -> float:
    """``γ = μ(s² − ω²)/s``, beyond which no backward whirl in lasting contact sustains itself."""
    return at.mu * mean_rolling_force(at) / at.radius_ratio


def rolling_stiffness(at: Values) -> float:
    """Largest ``ω = √(s² − (|γ|s + p)/μ)`` with which rolling holds; 0 if it holds for none."""
    speed = at.radius_ratio
    need = abs(at.gamma) * speed + largest_excitation(at)
    return math.sqrt(max(speed * speed - need / at.mu, 0.0)) if at.mu > 0.0 else 0.0


def rolling_friction(at: Values) -> float:
    """Least ``μ`` with which rolling holds; infinite if the rotor would leave the wall.

    The root ``μ = (AB + ρ√(A² + B² − ρ²))/(A² − ρ²)`` of :func:`rolling_condition` with ``A = s² − ω²``, ``B = |γ|s``.
    """
    force, drag = mean_rolling_force(at), abs(at.gamma) * at.radius_ratio
    if force <= at.rho:
        return math.inf
    square = (force - at.rho) * (force + at.rho)
    return (force * drag + at.rho * math.sqrt(square + drag * drag)) / square


def _rolling_ranges(at: Values, gain: Gain) -> tuple[Span, ...]:
    limit = rolling_damping(at) if gain == "gamma" else rolling_stiffness(at)
    return (Span(ZERO, Edge(limit, ROLLING)),) if limit > 0.0 else ()


def ranges_of(motion: Steady, at: Values, gain: Gain) -> tuple[Span, ...]:
    """Values from zero on of one gain for which a steady motion exists, the other parameters unchanged; in ascending order.

    The motion is levitation inside the wall, a synchronous rub that is pressed on the wall, or rolling that holds at every
    angle.
    """
    if gain not in get_args(Gain):
        raise InputError("gain", gain, "one of: gamma, omega")
    kinds = {"contact-free": _levitation_ranges, "rub": _rub_ranges, "rolling": _rolling_ranges}
    return kinds[motion](at, gain)


def largest_response(gamma: float, omega: float) -> float:
    """Largest deviation from levitation after a kick of speed 1, in ``c_r``.

    In the fixed frame the deviation from the levitation whirl obeys ``ü + γu̇ + ω²u = 0``, whose coefficients are real: a kick
    moves the rotor along its own direction.  For ``γ < 2ω`` the largest deviation ``g = e^{−γτ/2}/ω`` is that of the first
    turning point ``τ = arctan(2w/γ)/w``, ``w = √(ω² − γ²/4)``; above critical damping the hyperbolic form holds.
    """
    half = gamma / 2.0
    square = (omega - half) * (omega + half)
    if abs(square) <= 1e-12 * omega**2:
        moment = 1.0 / half
    elif square > 0.0:
        moment = math.atan2(math.sqrt(square), half) / math.sqrt(square)
    else:
        rate = math.sqrt(-square)
        moment = math.log((half + rate) ** 2 / omega**2) / (2.0 * rate)
    return math.exp(-half * moment) / omega
