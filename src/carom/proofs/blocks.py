"""Orbits with one impact a period on an interval of a parameter, by the mean value form.

On an interval with middle ``m`` and half width ``h`` a function of the parameter is enclosed by
``f(m) + (f'(m) + ½f''(ξ)h)h``, where the last derivative holds for every ``ξ`` of the interval.  The period ``T`` is such a
function, with ``T' = −F_p/F_T`` and ``T'' = −(F_TT T'² + 2F_Tp T' + F_pp)/F_T``, and with it everything else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeVar

from flint import arb, arb_series

from carom.base.outcome import CaromError
from carom.proofs.balls import hull, narrower, terms
from carom.proofs.courses import OrbitCourse, Return, period_condition
from carom.proofs.lines import Line, LineNumbers

_Known = TypeVar("_Known")


class OpenError(CaromError):
    """Something is not decided on a block; on a narrower one it may be."""


@dataclass(frozen=True)
class Block:
    """An interval of the parameter.

    Attributes
    ----------
    line : Line
    low, high : arb
        Exact.
    """

    line: Line
    low: arb
    high: arb

    @cached_property
    def ball(self) -> arb:
        """All its values."""
        return hull(self.low, self.high)

    @cached_property
    def middle(self) -> arb:
        """Exact value in the middle."""
        return self.ball.mid()

    @cached_property
    def off(self) -> arb:
        """Distance from the middle."""
        return self.ball - self.middle

    @cached_property
    def whole(self) -> LineNumbers[arb]:
        """Numbers on all of it."""
        return self.line.at(self.ball)

    @cached_property
    def centre(self) -> LineNumbers[arb]:
        """Numbers in its middle."""
        return self.line.at(self.middle)

    def moving(self, about: arb) -> LineNumbers[arb_series]:
        """Numbers as power series of the parameter about a ball."""
        return self.line.at(arb_series([about, 1]))


class Slopes(NamedTuple):
    """How a root of the period condition moves.

    Attributes
    ----------
    slope, bend : arb
        ``T'`` and ``½T''`` on the block.
    rate : arb
        Derivative of the condition by the period.
    """

    slope: arb
    bend: arb
    rate: arb


def slopes_on(block: Block, period: arb) -> Slopes | None:
    """Motion of roots of the period condition in a range of periods; ``None`` where they may be double."""
    rate, push, (along, across, mixed) = _rates(block, period)
    if not rate.is_finite() or rate.contains(0):
        return None
    slope = -push / rate
    return Slopes(slope, -(along * slope * slope + mixed * slope + across) / rate, rate)


def _bounded(slopes: Slopes | None) -> Slopes:
    if slopes is None:
        raise OpenError("the period may change without bound")
    return slopes


def _rates(block: Block, period: arb) -> tuple[arb, arb, tuple[arb, arb, arb]]:
    """First derivatives of the period condition by period and parameter, and ½F_TT, ½F_pp and F_Tp."""
    condition, middle = period_condition(block.whole, period), period.mid()
    with terms(3):
        moving, steady = block.moving(block.ball), arb_series([period])
        along = condition(block.whole, arb_series([period, 1]))[2]
        across = condition(moving, steady)[2]
        mixed = condition(moving, arb_series([period, 1]))[2] - along - across
    with terms(2):
        rate = condition(block.centre, arb_series([middle, 1]))[1]
        push = condition(block.moving(block.middle), middle)[1]
    late = period - middle
    return (
        rate + 2 * along * late + mixed * block.off,
        push + mixed * late + 2 * across * block.off,
        (along, across, mixed),
    )


def enclosed(block: Block, near: _Known, far: _Known, function: Callable[[_Known], arb_series]) -> tuple[arb, arb, arb]:
    """Value, slope and half of the second derivative of a function on a block.

    It is one of something known as series of two terms in the middle, and of three on the block.
    """
    with terms(2):
        about = function(near)
    with terms(3):
        everywhere = function(far)
    bend = everywhere[2]
    value = narrower(about[0] + (about[1] + bend * block.off) * block.off, everywhere[0])
    return value, narrower(everywhere[1], about[1] + 2 * bend * block.off), bend


class BlockBranch:
    """A simple root of ``F₁`` on a block.

    Parameters
    ----------
    block : Block
    low, high : float
        Periods between which it is the only root, for every value of the parameter.
    rising : bool
        Whether ``F₁`` rises there.

    Attributes
    ----------
    period : arb
    near, far : Return
        As power series in the middle of the block, and on all of it.
    plain : Return
        On all of it, as balls.

    Raises
    ------
    OpenError
        Its slope is not bounded.
    """

    def __init__(self, block: Block, low: float, high: float, rising: bool) -> None:
        self.block, self.rising = block, rising
        central = self._root_at_centre(low, high)
        period = self._wider(central, low, high)
        found = _bounded(slopes_on(block, period))
        for _ in range(40):
            moved = narrower(period, central + found.slope * block.off)
            settled = moved.rad() >= 0.95 * period.rad()
            period = moved
            found = _bounded(slopes_on(block, period))
            if settled:
                break
        self.period = period
        at_centre = _bounded(slopes_on(Block(block.line, block.middle, block.middle), central))
        slope = narrower(found.slope, at_centre.slope + 2 * found.bend * block.off)
        with terms(3):
            self.far = Return(block.moving(block.ball), arb_series([period, slope, found.bend]))
        with terms(2):
            self.near = Return(block.moving(block.middle), arb_series([central, at_centre.slope]))
        self.plain = Return(block.whole, period)

    def along(self, function: Callable[[Return[arb_series]], arb_series]) -> arb:
        """Enclosure of a function of the returns on the block."""
        return enclosed(self.block, self.near, self.far, function)[0]

    def _root_at_centre(self, low: float, high: float) -> arb:
        """The root in the middle of the block, by bisection and by interval Newton steps."""
        numbers, period = self.block.centre, hull(low, high)
        condition = period_condition(numbers, period)
        for _ in range(200):
            middle = period.mid()
            value = condition(numbers, middle)
            with terms(2):
                rate = condition(numbers, arb_series([period, 1]))[1]
            if rate.is_finite() and not rate.contains(0):
                narrow = narrower(period, middle - value / rate)
            elif value > 0 or value < 0:
                left = (value > 0) is self.rising
                narrow = hull(period.lower(), middle) if left else hull(middle, period.upper())
            else:
                raise OpenError("a period is too close to a double root for the precision")
            if narrow.rad() >= 0.9 * period.rad():
                return narrow
            period = narrow
        return period

    def _wider(self, central: arb, low: float, high: float) -> arb:
        """Periods between which the root stays on the block, by signs of the condition."""
        block, middle = self.block, central.mid()
        start = slopes_on(Block(block.line, block.middle, block.middle), central)
        slope = abs(start.slope).mid() if start else arb(1)
        reach = (slope * block.off.rad() * 1.5 + central.rad() * 4 + arb(2) ** -60).mid()
        ends = []
        for side, limit in ((-1, low), (1, high)):
            step = reach
            while True:
                end = (middle + side * step).mid()
                if not low < end < high:
                    end = arb(limit)
                    break
                value = value_on(block, end)
                if (value > 0 or value < 0) and ((value > 0) is self.rising) is (side > 0):
                    break
                step = step * 2
            ends.append(end)
        return hull(*ends)


def value_on(block: Block, period: arb) -> arb:
    """The period condition at one period, on all of a block."""
    condition = period_condition(block.whole, period)
    near, far = block.moving(block.middle), block.moving(block.ball)
    return enclosed(block, near, far, lambda numbers: condition(numbers, period))[0]


class BlockOrbitBranch:
    """An orbit on a block.

    Parameters
    ----------
    branch : BlockBranch
        Branch of its period, with a positive discriminant.
    faster : bool
        Whether it has the higher of both radial speeds.

    Attributes
    ----------
    speed : arb
        ``ṙ`` before the impact.
    plain : OrbitCourse
        On all of the block, as balls.
    """

    def __init__(self, branch: BlockBranch, faster: bool) -> None:
        self.branch, block = branch, branch.block
        found = enclosed(block, branch.near, branch.far, lambda back: back.speeds()[faster])
        self.speed = found[0]
        with terms(2):
            self.near = OrbitCourse(branch.near, branch.near.speeds()[faster])
        with terms(3):
            self.far = OrbitCourse(branch.far, arb_series(list(found)))
        self.plain = OrbitCourse(branch.plain, self.speed)

    def along(self, function: Callable[[OrbitCourse[arb_series]], arb_series]) -> arb:
        """Enclosure of a function of the orbit on the block."""
        return enclosed(self.branch.block, self.near, self.far, function)[0]
