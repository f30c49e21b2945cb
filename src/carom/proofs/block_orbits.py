"""All orbits with one impact a period for every value of a parameter in a narrow interval.

**All periods.**  ``F₁ > 0`` beyond the bound of :mod:`carom.proofs.periods` and next to zero, where for ``d < 1`` it tends to
``(1 − d)/2`` and for ``d = 1`` the next term decides.  In between, cells on which its sign or the sign of its slope is known tile the periods.  On neighbouring cells
of one sign of slope lies at most one root, as the slopes at consecutive simple roots alternate; the signs at both ends say
whether there is one.

**Stability.**  With the closing conditions the characteristic polynomial of the derivative ``J`` of the impact map is at 1

    det(1 − J) = |det(1 − e^{MT})|² F₁'(T) (Re(q a₁₂) + |q a₁₂|²ṙ),

positive for the orbits ``a`` and ``d`` and negative for ``b`` and ``c``, which have a multiplier above 1 and are unstable, always.
For ``a`` and ``d`` the conditions of Schur and Cohn decide, or ``3 − 2τ + m < 0``: if all multipliers are inside the unit circle,
so are the zeros of the derivative of the characteristic polynomial (Gauss, Lucas), and this is positive.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, arb_series

from carom.proofs.balls import Ball, decided, hull, terms
from carom.proofs.blocks import Block, BlockBranch, BlockOrbitBranch, OpenError, slopes_on
from carom.proofs.courses import NARROWEST, OrbitCourse, period_condition, stays_inside
from carom.proofs.lines import LineNumbers
from carom.proofs.periods import none_beyond, slowest_decay

Along = Callable[[Callable[[OrbitCourse[Any]], Any]], arb]
Cell = tuple[float, float]
_ORDER = 4
"""Order of Taylor's formula on a cell of periods."""
MOST_CELLS = 4000
"""Cells of periods that are tried on a block before it is given up."""
_NARROWEST_PERIODS = 0.004
"""Width of a cell of periods, in ``1/Ω``, at which a block is given up."""


@dataclass(frozen=True)
class OrbitFact:
    """What holds for an orbit on all of a block.

    Attributes
    ----------
    name : str
    admissible, stable : bool or None
        ``None`` where this is not decided.
    reason : str
        Why it is not admissible.
    instability : str
        Why it is not stable.
    period, speed : arb
        Enclosures of ``T`` and ``ṙ``.
    """

    name: str
    admissible: bool | None
    stable: bool | None
    reason: str
    instability: str
    period: arb
    speed: arb

    @property
    def signature(self) -> tuple[object, ...]:
        """What is the same along a stretch of the parameter."""
        return self.name, self.admissible, self.stable, self.reason, self.instability

    @property
    def objection(self) -> str:
        """What is not decided; empty if everything is."""
        if self.stable is None:
            return f"the stability of {self.name} is open"
        return f"it is open whether {self.name} is a motion" if self.admissible is None else ""


# ------------------------------------------------------------------------------------------------ periods


def first_cells(block: Block) -> list[Cell]:
    """Cells that tile all periods at which ``F₁`` may have roots on a block, or on any part of it.

    Raises :class:`OpenError` if nothing bounds these periods, or if ``F₁`` may vanish next to zero.
    """
    start, end = _start(block.whole)[0], _longest(block.whole)
    if end <= start:
        return []
    count = max(4, int((end - start) / 0.5))
    if count > MOST_CELLS:
        raise OpenError(f"the damping is weak: periods up to {end:.4g}/Omega take more than {MOST_CELLS} cells")
    edges = [start + (end - start) * (k / count) ** 1.5 for k in range(count)] + [end]
    return list(itertools.pairwise(edges))


def _longest(n: LineNumbers[arb]) -> float:
    """Period beyond which ``F₁ > 0``."""
    rate = arb(slowest_decay(n).lower())
    if not rate > 0:
        raise OpenError("without damping there are infinitely many periods")
    end = float((1 / rate).upper()) * 1.001
    while not none_beyond(n, arb(end)):
        if end > 1e5:
            raise OpenError("the damping is too weak: the longest period is beyond 100,000/Omega")
        end *= 1.05
    return end


def _start(n: LineNumbers[arb]) -> tuple[float, int]:
    """Period up to which ``F₁`` keeps the sign that it has next to zero, and this sign.

    ``F₁ = (1 − d)/2 + (1 + d)(γ − 2μ)T/12 + …``, and by the series of :func:`~carom.proofs.balls.short_return` the terms from
    the ``k``-th on are at most ``8k x^k/((1 − x)²LT)`` times ``|q|``, ``x = (LT/6)²``.
    """
    base, slope = (1 - n.d) / 2, (1 + n.d) * (n.gamma - 2 * n.mu) / 12
    longest = abs(n.gamma) / 2 + 1 + abs(n.split).sqrt()
    grip, elastic = abs(n.q), base.is_zero()
    time = 0.5
    while time > 1e-9:
        share = (longest * time / 6) ** 2
        rest = grip * 8 * (2 if elastic else 1) * share ** (2 if elastic else 1) / (1 - share) ** 2 / (longest * time)
        if share < 0.3 and (abs(slope) * time > rest if elastic else base > rest):
            return time, decided(slope) if elastic else 1
        time /= 2
    raise OpenError("F1 may vanish next to T = 0")


def _sign_and_slope(block: Block, low: float, high: float) -> tuple[int, int]:
    """Signs of the period condition and of its slope on a cell; 0 where none is shown."""
    period = hull(low, high)
    condition = period_condition(block.whole, period)
    plain = condition(block.whole, period)
    if not plain.is_finite():
        return 0, 0
    if decided(plain):
        return decided(plain), 0
    middle = period.mid()
    late = period - middle
    with terms(_ORDER + 1):
        far = condition(block.whole, arb_series([period, 1]))[_ORDER]
    with terms(_ORDER):
        near = condition(block.whole, arb_series([middle, 1]))
    with terms(2):
        across = condition(block.moving(block.ball), arb_series([middle]))[1]
    rate, value = _ORDER * far, far
    for k in range(_ORDER - 1, 0, -1):
        rate, value = k * near[k] + late * rate, near[k] + late * value
    value = condition(block.centre, middle) + across * block.off + late * value
    return decided(value), decided(rate)


def remaining(block: Block, cells: Sequence[Cell]) -> list[tuple[float, float, int]]:
    """Cells on which the period condition is not shown to differ from zero, with the sign of its slope or 0."""
    left, stack, tried = [], list(reversed(cells)), 0
    while stack:
        tried += 1
        if tried > MOST_CELLS:
            raise OpenError(f"the periods take more than {MOST_CELLS} cells")
        low, high = stack.pop()
        sign, slope = _sign_and_slope(block, low, high)
        if sign:
            continue
        narrow = high - low <= _NARROWEST_PERIODS
        if not slope and high - low <= 16 * _NARROWEST_PERIODS:
            found = slopes_on(block, hull(low, high))
            slope = 0 if found is None else decided(found.rate)
        if slope or narrow:
            left.append((low, high, slope))
            continue
        middle = 0.5 * (low + high)
        stack += [(middle, high), (low, middle)]
    return left


def branches_on(block: Block, cells: Sequence[Cell]) -> list[BlockBranch]:
    """All roots of ``F₁`` in the cells, the period as a function of the parameter.

    Raises :class:`OpenError` if their number is not decided on this block.
    """
    # F₁ starts positive unless d = 1, when T = 0 may be the shorter root of the first pair.
    before_all = _start(block.whole)[1] < 0
    groups: list[tuple[float, float, set[int]]] = []
    for low, high, slope in remaining(block, cells):
        if groups and groups[-1][1] == low:
            groups[-1] = (groups[-1][0], high, groups[-1][2] | {slope})
        else:
            groups.append((low, high, {slope}))
    found = []
    for low, high, slopes in groups:
        before, after = (_sign_and_slope(block, end, end)[0] for end in (low, high))
        if len(slopes) > 1 or 0 in slopes or not (before and after):
            raise OpenError(f"the number of periods next to {0.5 * (low + high):.4g} is open")
        if before != after:
            found.append(BlockBranch(block, low, high, after > 0))
    for count, branch in enumerate(found, before_all):
        if branch.rising is not bool(count % 2):
            raise OpenError("the slopes at the periods do not alternate")
    return found


# ------------------------------------------------------------------------------------------------ orbits


def orbits_on(block: Block, cells: Sequence[Cell]) -> list[OrbitFact]:
    """All orbits on a block, with what holds for each on all of it; :class:`OpenError` if their number is not decided."""
    branches, found = branches_on(block, cells), []
    for count, branch in enumerate(branches, bool(branches) and branches[0].rising):
        discriminant = branch.along(lambda back: back.discriminant)
        if discriminant < 0:
            continue
        if not (discriminant > 0 and branch.far.discriminant[0] > 0):
            raise OpenError("two radial speeds of one period may meet")
        for faster in (False, True):
            name = f"B{count // 2 + 1},{'abcd'[branch.rising + 2 * faster]}"
            found.append(_fact(name, BlockOrbitBranch(branch, faster), branch.rising is faster))
    return found


def _fact(name: str, orbit: BlockOrbitBranch, positive: bool) -> OrbitFact:
    """What holds for an orbit; ``positive`` says whether ``det(1 − J)`` is."""
    instability, reason = instability_of(orbit, positive), why_virtual(orbit)
    admissible, stable = (None if why is None else not why for why in (reason, instability))
    return OrbitFact(name, admissible, stable, reason or "", instability or "", orbit.branch.period, orbit.speed)


def instability_of(orbit: BlockOrbitBranch, positive: bool) -> str | None:
    """Why an orbit is unstable; empty if it is stable, ``None`` if this is open.

    ``positive`` says whether ``det(1 − J)`` is positive.
    """
    if not positive:
        return "a multiplier is above 1"
    if orbit.along(lambda course: course.invariants.slope_at_one) < 0:
        return "two multipliers are outside the unit circle"
    flip = orbit.along(lambda course: course.invariants.at_minus_one)
    if flip < 0:
        return "a multiplier is below -1"
    torus = orbit.along(lambda course: course.invariants.of_pairs)
    if torus < 0:
        return "the product of two multipliers is above 1"
    if flip > 0 and torus > 0 and orbit.branch.along(lambda back: back.determinant) < 1:
        return ""
    return None


def why_virtual(orbit: BlockOrbitBranch) -> str | None:
    """Why an orbit is not a motion of the machine; empty if it is one, ``None`` if this is open."""
    if orbit.speed < 0:
        return "it would meet the wall from outside"
    if not orbit.speed > 0:
        return None
    slip = orbit.along(lambda course: course.slip_after)
    if slip < 0 and orbit.branch.block.whole.mu > 0:
        return "friction would stop its slip, or its slip is backward"
    stays = inside(orbit.plain, orbit.along)
    if stays is None or not (slip > 0 or orbit.branch.block.whole.mu.is_zero()):
        return "it would cross the wall between its impacts" if stays is False else None
    return "" if stays else "it would cross the wall between its impacts"


# ------------------------------------------------------------------------------------------------ between the impacts


def inside(
    plain: OrbitCourse[arb], along: Along, touch: arb | None = None, narrowest: float = NARROWEST
) -> bool | None:
    """Whether an orbit with ``ṙ > 0`` stays inside the wall between its impacts; ``None`` if this is open.

    ``(|U|² − 1)/ṙ`` vanishes at both impacts, with the rates ``−2d`` after the first and ``2`` before the second.  The function
    ``along`` gives narrower values of functions of the orbit than ``plain``, its balls.  At the time ``touch``, if given, it
    is allowed to touch the wall without radial speed.
    """

    def narrow(time: arb, backward: bool) -> arb:
        return along(lambda course: course.height(arb_series([time]), backward)[0])

    def height(time: Ball, backward: bool) -> Ball:
        return plain.height(time, backward)[0]

    return stays_inside(height, narrow, plain.back.period, (2 * plain.back.numbers.d, arb(2)), touch, narrowest)
