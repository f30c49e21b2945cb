"""Quadratic forms of the distance from a point next to levitation, which fall in flight, and the sets in which contact does not raise them either.

With ``u = z − σΛe^{it}`` in the fixed frame, a share ``0 ≤ σ ≤ 1`` of levitation, ``g = α − iβ`` and ``k > |g|²``,

    Q = |u̇|² + 2 Re(g ū u̇) + k|u|² = |ξ|² + (k − |g|²)|u|²,      ξ = u̇ + ḡu .

*Flight.*  ``Q̇/2 = −(γ − α)|u̇|² − αω²|u|² + Re((k − ω² − γg) ū u̇) + Re(ξ̄(1 − σ)ρe^{it}) ≤ −δQ + (1 − σ)ρ√Q`` if

    γ − α > δ,      αω² > δk,      |k − ω² − (γ − 2δ)g|² < 4(γ − α − δ)(αω² − δk).

So ``Q`` falls to its *core*, ``((1 − σ)ρ/δ)²``, which is zero for ``σ = 1``.

*Contact.*  Turn the plane such that the rotor touches at ``z = 1``, with ``Λ = ℓe^{iψ}`` and the velocity ``v = a + ib``.  There ``ξ = v − v₀`` with
``v₀ = a₀ + ib₀ = −ḡ + (i + ḡ)σΛ``.  An impact takes ``(1 + iτ)p``, ``p = (1 + d)a``, from the velocity, with ``|τ| ≤ μ`` whether slip goes on, stops, or is backward.  It changes
``Q`` by

    −2p(−a₀ + τ(b − b₀) + ea),      e = 1 − ½(1 + d)(1 + τ²),

and lasting contact of any kind by the same with ``a = 0`` and ``p = N dt``.  Where ``h = −a₀ > 0``, that is no rise for all ``a ≥ 0`` with

    |ξ|² ≤ K h²,      K = 1 + 1/μ² if e ≥ 0 for τ = μ, else (1 − e)²/(e² + μ²) with that e.

*Trap.*  So no motion leaves the set ``Q ≤ C`` if ``C`` is above the core and ``C < (k − |g|²)|1 − σΛ|² + K max(h, 0)²`` at all angles ``ψ``; in it ``Q`` falls to the core.  With a larger ``σ``
``√Q`` is larger by ``(σ' − σ)ℓ√(|i + ḡ|² + k − |g|²)`` at most; if that is in the trap of ``σ'``, and so on up to ``σ = 1``, motions in the trap return to levitation.

*All states.*  A motion that starts with ``|z| ≤ 1`` and ``|ż| ≤ V`` meets the wall with ``Q ≤ sup Q`` for every form ``Q`` that does not rise in flight: energy, and those that are listed.  These
states have three coordinates, the angle ``ψ`` of levitation and the velocity ``a + ib``, ``a ≥ 0``.  Boxes of them are halved until each is either out of reach, by one of these
forms, or after the impact in the trap of one form.

The formulas of forms serve balls as well as arrays of doubles.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Generic, TypeVar, cast

import numpy as np
from flint import arb

from carom.proofs.balls import rational
from carom.proofs.claims import rational_of
from carom.proofs.lines import LineNumbers

PARTS, FEW = 1024, 512
"""Parts of a turn on which something is shown of all angles, and where it need not be sharp."""
STEP = Fraction(1, 20)
"""Of the share of levitation, from one trap to the next."""
_SLIPPERY = 1e-3
"""Friction that a bound for less of it assumes: without any, ``K`` would be infinite."""
_Number = TypeVar("_Number", arb, np.ndarray)
_BELOW = 1 - 2.0**-20


@dataclass(frozen=True)
class Surface(Generic[_Number]):
    """The numbers of a rotor at its wall, as balls or as doubles.

    Attributes
    ----------
    gamma, omega_squared, rho, d, ratio : number
        As of the rotor; ``ratio`` is ``s = R/c_r``.
    radius : number
        ``ℓ``.
    grip : number
        ``μ(1 + d)``.
    hold : number
        ``K``.
    """

    gamma: _Number
    omega_squared: _Number
    rho: _Number
    d: _Number
    ratio: _Number
    radius: _Number
    grip: _Number
    hold: _Number

    @classmethod
    def of(cls, n: LineNumbers[arb]) -> Surface[arb]:
        """The wall of a rotor whose numbers are balls."""
        friction = n.mu.max(arb(_SLIPPERY))
        e = 1 - (1 + n.d) * (1 + n.mu * n.mu) / 2
        if e >= 0:
            hold = 1 + 1 / (friction * friction)
        else:
            e = e.min(arb(0))
            hold = (1 - e) * (1 - e) / (e * e + friction * friction)
        return Surface(n.gamma, n.omega_squared, n.rho, n.d, n.radius_ratio, n.levitation, n.mu * (1 + n.d), hold)

    def plain(self: Surface[arb]) -> Surface[np.ndarray]:
        """The same in doubles."""
        return cast("Surface[np.ndarray]", Surface(*(float(number.mid()) for number in vars(self).values())))

    def after(self, a: _Number, b: _Number) -> tuple[_Number, _Number]:
        """Velocity after an impact, in all cases of slip."""
        slip: Any = self.ratio + b
        most: Any = self.grip * a
        taken = slip.min(most).max(-most) if isinstance(slip, arb) else np.clip(slip, -most, most)
        return -self.d * a, b - taken


@dataclass(frozen=True)
class Form(Generic[_Number]):
    """A form by ``α``, ``β``, ``k``, ``σ`` and ``δ``: balls, or arrays of doubles for many forms at once."""

    alpha: _Number
    beta: _Number
    stiffness: _Number
    shift: _Number
    rate: _Number

    def __iter__(self) -> Iterator[_Number]:
        return iter(vars(self).values())

    @property
    def rest(self) -> _Number:
        """``k − |g|²``."""
        return self.stiffness - self.alpha * self.alpha - self.beta * self.beta

    def slacks(self, wall: Surface[_Number]) -> tuple[_Number, _Number, _Number]:
        """Three numbers that are positive if ``Q`` falls in flight at the rate ``δ``."""
        drag = wall.gamma - self.alpha - self.rate
        hold = self.alpha * wall.omega_squared - self.rate * self.stiffness
        left = wall.gamma - 2 * self.rate
        real, turning = self.stiffness - wall.omega_squared - left * self.alpha, left * self.beta
        return drag, hold, 4 * drag * hold - real * real - turning * turning

    def falls(self: Form[arb], wall: Surface[arb]) -> bool:
        """Whether it falls in flight, of balls."""
        return bool(self.rate > 0 and self.rest > 0 and all(slack > 0 for slack in self.slacks(wall)))

    def core(self, wall: Surface[_Number]) -> _Number:
        """Root of what it falls to, ``(1 − σ)ρ/δ``."""
        return (1 - self.shift) * wall.rho / self.rate

    def step(self, wall: Surface[_Number]) -> _Number:
        """By how much its root may grow over a whole ``σ``."""
        ahead = 1 + self.beta
        return wall.radius * (self.alpha * self.alpha + ahead * ahead + self.rest) ** 0.5

    def centre(self, wall: Surface[_Number], sine: _Number, cosine: _Number) -> tuple[_Number, _Number]:
        """``a₀`` and ``b₀`` at an angle ``ψ``."""
        ahead, radius = 1 + self.beta, wall.radius * self.shift
        return (
            radius * (self.alpha * cosine - ahead * sine) - self.alpha,
            radius * (self.alpha * sine + ahead * cosine) - self.beta,
        )

    def away(self, wall: Surface[_Number], cosine: _Number) -> _Number:
        """``(k − |g|²)|1 − σΛ|²``."""
        radius = wall.radius * self.shift
        return self.rest * (1 + radius * radius - 2 * radius * cosine)

    def size(self, wall: Surface[_Number], turn: tuple[_Number, _Number], a: _Number, b: _Number) -> _Number:
        """``Q`` at the wall; ``turn`` holds sine and cosine of ``ψ``."""
        radial, along = self.centre(wall, *turn)
        x, y = a - radial, b - along
        return x * x + y * y + self.away(wall, turn[1])


def energy(wall: Surface[arb]) -> Form[arb]:
    """The form ``|u̇|² + ω²|u|²`` about levitation, which never rises in flight; of balls."""
    return Form(arb(0), arb(0), wall.omega_squared, arb(1), arb(0))


def angles(parts: int = PARTS) -> list[tuple[arb, arb]]:
    """Sines and cosines of the parts of a turn, as balls."""
    width = arb.pi() / parts
    return [(width * (2 * k + arb(0, 1))).sin_cos() for k in range(parts)]


def level(form: Form[arb], wall: Surface[arb], turns: list[tuple[arb, arb]]) -> arb:
    """A level ``C`` that contact does not let a form leave, as a ball without radius."""
    bounds = []
    for sine, cosine in turns:
        inward = (-form.centre(wall, sine, cosine)[0]).lower().max(arb(0))
        bounds.append((form.away(wall, cosine) + wall.hold * inward * inward).lower())
    return (min(bounds) * _BELOW).lower()


def returns(form: Form[arb], wall: Surface[arb]) -> bool:
    """Whether motions that reach the core of a form return to levitation, by traps of larger and larger ``σ``."""
    turns, growth = angles(FEW), form.step(wall)
    while form.shift < 1:
        ahead = form.shift + arb(STEP.numerator) / STEP.denominator
        later = replace(form, shift=ahead if ahead < 1 else arb(1))
        root = form.core(wall) + (later.shift - form.shift) * growth
        bound = level(later, wall, turns)
        if not (bound > 0 and root.max(later.core(wall)) < bound.sqrt()):
            return False
        form = later
    return bool(form.shift == 1)


def highest(form: Form[arb], wall: Surface[arb], speed: arb, turns: list[tuple[arb, arb]]) -> arb:
    """A bound of a form over all states ``|z| ≤ 1``, ``|ż| ≤ speed``.

    The form is convex in ``(z, ż)``, so its largest value is at ``|z| = 1`` and ``|ż| = speed``, at most ``(speed + |v₀|)² + (k − |g|²)|1 − σΛ|²``.
    """
    most = arb(0)
    for sine, cosine in turns:
        a, b = form.centre(wall, sine, cosine)
        reach = speed + (a * a + b * b).sqrt()
        most = most.max((reach * reach + form.away(wall, cosine)).upper())
    return most.upper()


MOST_BOXES = 50_000
_TURNS = 8
"""Parts of a turn to begin with."""


@dataclass(frozen=True)
class Bounded:
    """A form with a number: a trap ``Q ≤ bound``, or a bound of what arrives."""

    form: Form[arb]
    bound: arb


def read_forms(listed: Iterable[Iterable[str]]) -> list[Form[arb]]:
    """Forms of evidence, as balls."""
    return [Form(*(rational(rational_of(text)) for text in texts)) for texts in listed]


def traps_of(wall: Surface[arb], forms: Sequence[Form[arb]]) -> list[Bounded] | None:
    """The traps of forms; ``None`` if there are none, or motions in one of them need not return."""
    turns, traps = angles(), []
    for form in forms:
        if not (0 <= form.shift <= 1 and form.falls(wall) and returns(form, wall)):
            return None
        trap, core = Bounded(form, level(form, wall, turns)), form.core(wall)
        if not trap.bound > core * core:
            return None
        traps.append(trap)
    return traps or None


def limits_of(wall: Surface[arb], speed: arb, forms: Sequence[Form[arb]]) -> list[Bounded] | None:
    """Bounds of what arrives, that of energy first; ``None`` if a form may rise in flight beyond its core."""
    turns, first = angles(), energy(wall)
    if not all(0 <= form.shift <= 1 and form.falls(wall) for form in forms):
        return None
    limits = [Bounded(first, highest(first, wall, speed, turns))]
    for form in forms:
        core = form.core(wall).upper()
        limits.append(Bounded(form, highest(form, wall, speed, turns).max(core * core).upper()))
    return limits


def _fastest(wall: Surface[arb], energy: Bounded) -> arb:
    """Largest speed at the wall by energy: ``|v − iΛ|² ≤ sup Q − ω²(1 − ℓ)²``."""
    room = 1 - wall.radius
    return (wall.radius + (energy.bound - wall.omega_squared * room * room).max(arb(0)).sqrt()).upper()


class _Plain:
    """Forms and their numbers in doubles, to choose by which form a box is looked at."""

    def __init__(self, wall: Surface[arb], entries: Sequence[Bounded]) -> None:
        self.wall = wall.plain()
        columns = ([float(number.mid()) for number in entry.form] for entry in entries)
        self.forms = Form(*np.array(list(columns)).T)
        self.bounds = np.array([float(entry.bound) for entry in entries])

    def relative(self, turn: tuple[float, float], a: np.ndarray | float, b: np.ndarray | float) -> np.ndarray:
        """``Q`` of a state over the number, for each form."""
        ratios: np.ndarray = self.forms.size(self.wall, turn, a, b) / self.bounds
        return ratios


Box = tuple[float, float, float, float, float, float]
"""Beginning and width of ``ψ/π``, and of ``a`` and ``b`` as shares of the largest speed: doubles that are halved without rounding."""


def all_trapped(wall: Surface[arb], limits: Sequence[Bounded], traps: Sequence[Bounded]) -> bool:
    """Whether all states that arrive are in a trap after their impact."""
    cover = _Cover(wall, _fastest(wall, limits[0]), limits, traps)
    ahead: list[Box] = [(2.0 * k / _TURNS, 2.0 / _TURNS, 0.0, 1.0, -1.0, 2.0) for k in range(_TURNS)]
    for _ in range(MOST_BOXES):
        if not ahead:
            return True
        box = ahead.pop()
        settled = cover.settles(box)
        if settled is None:
            return False
        ahead += () if settled else cover.halves(box)
    return False


class _Cover:
    """What decides boxes of states that arrive."""

    def __init__(self, wall: Surface[arb], fastest: arb, limits: Sequence[Bounded], traps: Sequence[Bounded]) -> None:
        self._wall, self._fastest, self._speed = wall, fastest, float(fastest)
        self._limits, self._traps = limits, traps
        self._arriving, self._trapping = _Plain(wall, limits), _Plain(wall, traps)
        self._scales = (np.pi * float(wall.radius.mid()), 1.0, 1.0)

    def settles(self, box: Box) -> bool | None:
        """Whether no state of a box arrives, or all are in one trap after their impact; ``None`` if that in its middle seems to be lost."""
        at, wide, slow, more, back, along = box
        middle, plain = np.pi * (at + wide / 2), self._arriving.wall
        turn = (float(np.sin(middle)), float(np.cos(middle)))
        a, b = (slow + more / 2) * self._speed, (back + along / 2) * self._speed
        sides = (arb.pi() * _ball(at, wide)).sin_cos()
        balls = _ball(slow, more) * self._fastest, _ball(back, along) * self._fastest
        excess = self._arriving.relative(turn, a, b)
        limit = self._limits[int(np.argmax(excess))]
        if excess.max() > 1 and limit.form.size(self._wall, sides, *balls) > limit.bound:
            return True
        fits = self._trapping.relative(turn, *plain.after(np.asarray(a), np.asarray(b)))
        if excess.max() <= 1 <= fits.min():
            return None
        trap = self._traps[int(np.argmin(fits))]
        return bool(trap.form.size(self._wall, sides, *self._wall.after(*balls)) < trap.bound)

    def halves(self, box: Box) -> tuple[Box, Box]:
        """Both halves of a box, in the coordinate in which it is the widest."""
        place = 2 * int(np.argmax([scale * width for scale, width in zip(self._scales, box[1::2], strict=True)]))
        one, other = list(box), list(box)
        half = box[place + 1] / 2
        one[place + 1] = other[place + 1] = half
        other[place] += half
        return tuple(one), tuple(other)  # type: ignore[return-value]


def _ball(begin: float, width: float) -> arb:
    return arb(begin).union(arb(begin + width))
