"""Numbers that depend on a few unknowns between −1 and 1: mean value forms that arithmetic carries along.

A form holds its value where all unknowns vanish, balls of its derivatives on their whole range, and a ball of all its values.
What two forms have in common is not lost in a product or a difference, as it is with balls alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from flint import arb

NOTHING = 0
"""Exactly zero: what is multiplied by it costs nothing."""
_UNIT = arb(0, 1)


class MeanValueForm:
    """A real number that depends on unknowns.

    Parameters
    ----------
    at : arb
        Where all unknowns vanish.
    by : sequence of arb
        Its derivatives, for all values of the unknowns.
    every : arb, optional
        All its values, if something better is known than what follows.
    """

    __slots__ = ("at", "by", "every")

    def __init__(self, at: arb, by: Sequence[arb], every: arb | None = None) -> None:
        self.at, self.by = at, by
        size = arb(0)
        for slope in by:
            size = size + abs(slope)
        near = at + size * _UNIT
        self.every = near if every is None or not near.overlaps(every) else near.intersection(every)

    def __add__(self, other: Any) -> MeanValueForm:
        if other is NOTHING:
            return self
        if isinstance(other, MeanValueForm):
            by = [one + two for one, two in zip(self.by, other.by, strict=True)]
            return MeanValueForm(self.at + other.at, by, self.every + other.every)
        return MeanValueForm(self.at + other, self.by, self.every + other)

    def __neg__(self) -> MeanValueForm:
        return MeanValueForm(-self.at, [-slope for slope in self.by], -self.every)

    def __sub__(self, other: Any) -> MeanValueForm:
        return self + (-other)

    def __rsub__(self, other: Any) -> MeanValueForm:
        return -self + other

    def __mul__(self, other: Any) -> Any:
        if other is NOTHING:
            return NOTHING
        if isinstance(other, MeanValueForm):
            one, two = self.every, other.every
            by = [a * two + b * one for a, b in zip(self.by, other.by, strict=True)]
            return MeanValueForm(self.at * other.at, by, one * two)
        return MeanValueForm(self.at * other, [slope * other for slope in self.by], self.every * other)

    def __truediv__(self, other: Any) -> MeanValueForm:
        if isinstance(other, MeanValueForm):
            return self * other.through(1 / other.at, 1 / other.every, -1 / (other.every * other.every))
        return self * (1 / arb(other))

    __radd__, __rmul__ = __add__, __mul__

    def through(self, at: arb, every: arb, slope: arb) -> MeanValueForm:
        """A function of it, by its value at the centre, its values and its slopes."""
        return MeanValueForm(at, [x * slope for x in self.by], every)


class Pair:
    """A complex number whose parts are forms."""

    __slots__ = ("imag", "real")

    def __init__(self, real: Any, imag: Any) -> None:
        self.real, self.imag = real, imag

    def __add__(self, other: Pair) -> Pair:
        return Pair(self.real + other.real, self.imag + other.imag)

    def __neg__(self) -> Pair:
        return Pair(-self.real, -self.imag)

    def __sub__(self, other: Pair) -> Pair:
        return Pair(self.real - other.real, self.imag - other.imag)

    def __mul__(self, other: Any) -> Pair:
        if isinstance(other, Pair):
            return Pair(
                self.real * other.real - self.imag * other.imag, self.real * other.imag + self.imag * other.real
            )
        return Pair(self.real * other, self.imag * other)

    __rmul__ = __mul__

    @property
    def turned(self) -> Pair:
        """``i`` times it."""
        return Pair(-self.imag, self.real)

    @property
    def conjugate(self) -> Pair:
        """Its complex conjugate."""
        return Pair(self.real, -self.imag)
