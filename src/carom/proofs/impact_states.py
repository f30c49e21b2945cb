"""All states in which motions from inside the clearance may first meet the wall, and whether each is in a trap after its impact.

A motion that starts with ``|z| ≤ 1`` and ``|ż| ≤ V`` meets the wall with ``Q ≤ sup Q`` for every form ``Q`` that does not rise in flight: energy, and those that are listed.  These
states have three coordinates, the angle ``ψ`` of levitation and the velocity ``a + ib``, ``a ≥ 0``.  Boxes of them are halved until each is either out of reach, by one of these
forms, or after the impact in the trap of one form (:mod:`carom.proofs.forms`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb

from carom.proofs.balls import rational
from carom.proofs.evidence import rational_of
from carom.proofs.forms import Form, Surface, angles, energy, highest, level, returns

MOST_BOXES = 50_000
_TURNS = 8
"""Parts of a turn to begin with."""


@dataclass(frozen=True)
class Bounded:
    """A form with a number: a trap ``Q ≤ bound``, or a bound of what arrives."""

    form: Form
    bound: arb


def read_forms(listed: Any) -> list[Form]:
    """Forms of evidence, as balls."""
    return [Form(*(rational(rational_of(text)) for text in texts)) for texts in listed]


def traps_of(wall: Surface, forms: Sequence[Form]) -> list[Bounded] | None:
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


def limits_of(wall: Surface, speed: arb, forms: Sequence[Form]) -> list[Bounded] | None:
    """Bounds of what arrives, that of energy first; ``None`` if a form may rise in flight beyond its core."""
    turns, first = angles(), energy(wall)
    if not all(0 <= form.shift <= 1 and form.falls(wall) for form in forms):
        return None
    limits = [Bounded(first, highest(first, wall, speed, turns))]
    for form in forms:
        core = form.core(wall).upper()
        limits.append(Bounded(form, highest(form, wall, speed, turns).max(core * core).upper()))
    return limits


def _fastest(wall: Surface, energy: Bounded) -> arb:
    """Largest speed at the wall by energy: ``|v − iΛ|² ≤ sup Q − ω²(1 − ℓ)²``."""
    room = 1 - wall.radius
    return (wall.radius + (energy.bound - wall.omega_squared * room * room).max(arb(0)).sqrt()).upper()


class _Plain:
    """Forms and their numbers in doubles, to choose by which form a box is looked at."""

    def __init__(self, wall: Surface, entries: Sequence[Bounded]) -> None:
        self.wall = wall.plain()
        columns = ([float(number.mid()) for number in entry.form] for entry in entries)
        self.forms = Form(*np.array(list(columns)).T)
        self.bounds = np.array([float(entry.bound) for entry in entries])

    def relative(self, turn: tuple[float, float], a: float, b: float) -> np.ndarray:
        """``Q`` of a state over the number, for each form."""
        ratios: np.ndarray = self.forms.size(self.wall, turn, a, b) / self.bounds
        return ratios


Box = tuple[float, float, float, float, float, float]
"""Beginning and width of ``ψ/π``, and of ``a`` and ``b`` as shares of the largest speed: doubles that are halved without rounding."""


def all_trapped(wall: Surface, limits: Sequence[Bounded], traps: Sequence[Bounded]) -> bool:
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

    def __init__(self, wall: Surface, fastest: arb, limits: Sequence[Bounded], traps: Sequence[Bounded]) -> None:
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
        fits = self._trapping.relative(turn, *plain.after(a, b))
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
