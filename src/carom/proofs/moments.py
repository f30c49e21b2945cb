"""All flights of a patch at a time or on an interval of times, as mean value forms.

These are numbers that depend on a few unknowns between −1 and 1, which arithmetic carries along.

A form holds its value where all unknowns vanish, balls of its derivatives on their whole range, and a ball of all its values.
What two forms have in common is not lost in a product or a difference, as it is with balls alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeVar, cast

from flint import acb, arb

if TYPE_CHECKING:
    from carom.proofs.patches import PatchDeparture


NOTHING = cast("MeanValueForm", 0)
"""Exactly zero: what is multiplied by it costs nothing."""
UNIT = arb(0, 1)
"""All numbers from −1 to 1."""


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
        near = at + size * UNIT
        self.every = near if every is None or not near.overlaps(every) else near.intersection(every)

    def __add__(self, other: MeanValueForm | arb | int) -> MeanValueForm:
        if other is NOTHING:
            return self
        if isinstance(other, MeanValueForm):
            by = [one + two for one, two in zip(self.by, other.by, strict=True)]
            return MeanValueForm(self.at + other.at, by, self.every + other.every)
        return MeanValueForm(self.at + other, self.by, self.every + other)

    def __neg__(self) -> MeanValueForm:
        return MeanValueForm(-self.at, [-slope for slope in self.by], -self.every)

    def __sub__(self, other: MeanValueForm | arb | int) -> MeanValueForm:
        return self + (-other)

    def __rsub__(self, other: arb | int) -> MeanValueForm:
        return -self + other

    def __mul__(self, other: MeanValueForm | arb | int) -> MeanValueForm:
        if other is NOTHING:
            return NOTHING
        if isinstance(other, MeanValueForm):
            one, two = self.every, other.every
            by = [a * two + b * one for a, b in zip(self.by, other.by, strict=True)]
            return MeanValueForm(self.at * other.at, by, one * two)
        return MeanValueForm(self.at * other, [slope * other for slope in self.by], self.every * other)

    def __truediv__(self, other: MeanValueForm | arb | int) -> MeanValueForm:
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

    def __init__(self, real: MeanValueForm, imag: MeanValueForm) -> None:
        self.real, self.imag = real, imag

    def __add__(self, other: Pair) -> Pair:
        return Pair(self.real + other.real, self.imag + other.imag)

    def __neg__(self) -> Pair:
        return Pair(-self.real, -self.imag)

    def __sub__(self, other: Pair) -> Pair:
        return Pair(self.real - other.real, self.imag - other.imag)

    def __mul__(self, other: Pair | MeanValueForm | arb) -> Pair:
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


FORM = 5
"""Spans by where in the cell a kick is, those of first and second order; then come those of the parameters of a box of rotors."""
Wave = tuple[arb | acb, arb | acb, acb]
Real = TypeVar("Real", arb, MeanValueForm)
Part = TypeVar("Part", covariant=True)


class Complex(Protocol[Part]):
    """What has a real and an imaginary part: a ball, or a pair of forms."""

    @property
    def real(self) -> Part:
        """Real part."""

    @property
    def imag(self) -> Part:
        """Imaginary part."""


class Waves(NamedTuple):
    """``c``, ``h₁`` and ``k`` of a flight with their first two derivatives, at a time or on an interval of times."""

    place: Wave
    rate: Wave
    bend: Wave


class Moment:
    """All flights of a patch at a time or on an interval of times.

    With ``z = p + q``, ``p = c + V h₁`` and ``q = Λk``, nothing but products of ``p`` and ``q`` depends on ``ψ`` in ``|z|²`` and its rates:
    ``|q|² = ℓ²|k|²``.  All are evaluated so that this is not lost in the width of ``Λ``.
    """

    def __init__(self, departure: PatchDeparture, time: arb) -> None:
        self.departure, self.time = departure, time
        self.waves = departure.held.waves(time, departure.from_wall)

    @property
    def parts(self) -> tuple[list[acb], list[acb], list[acb]]:
        """``p``, ``q`` and ``k`` with their first two derivatives."""
        return self._p, self._q, [wave[2] for wave in self.waves]

    @cached_property
    def _middle(self) -> Waves:
        """Waves of the rotor in the middle of the box."""
        held = self.departure.held
        return self.waves if held.middle is held else held.middle.waves(self.time, self.departure.from_wall)

    def centre(self, order: int) -> acb:
        """Place (0) or rate (1) on the flight of the centre."""
        d, wave = self.departure, self._middle[order]
        return wave[0] + d.velocity * wave[1] + d.levitation * wave[2]

    @cached_property
    def _p(self) -> list[acb]:
        return [wave[0] + self.departure.wide_velocity * wave[1] for wave in self.waves]

    @cached_property
    def _q(self) -> list[acb]:
        return [self.departure.wide_levitation * wave[2] for wave in self.waves]

    @cached_property
    def wide(self) -> list[acb]:
        """``z``, ``ż`` and ``z̈`` of all flights."""
        return [p + q for p, q in zip(self._p, self._q, strict=True)]

    def _products(self, one: int, other: int) -> arb:
        """``Re(z̄ w)`` of two of them."""
        (p, q), (u, w) = ((self._p[j], self._q[j]) for j in (one, other))
        turning = dot(self.waves[one][2], self.waves[other][2])
        return dot(p, u) + dot(p, w) + dot(q, u) + self.departure.held.radius_squared * turning

    @cached_property
    def slope(self) -> arb:
        """``Re(z̄ż)`` on all flights, as wide as the patch and the times are."""
        return self._products(0, 1)

    @cached_property
    def _moved(self) -> list[tuple[acb, acb, arb]]:
        """``z`` and its rate differentiated along the columns, but for the turn of ``Λ`` along them, which comes third."""
        h, dh = self.waves.place[1], self.waves.rate[1]
        found = [(v * h, v * dh, turn) for v, turn in self.departure.columns]
        for j, (place, rate) in enumerate(self._by_parameters(), FORM):
            along, drift, turn = found[j]
            found[j] = (along + place, drift + rate, turn)
        return found

    def _by_parameters(self) -> Iterator[tuple[acb, ...]]:
        """Place and rate differentiated along each parameter, the state at the start kept."""
        d = self.departure
        for waves, side in zip(d.held.waves_by(self.time, d.from_wall), d.held.sides, strict=True):
            lift = d.wide_turn * side.radius
            yield tuple(
                by[0] + d.wide_velocity * by[1] + d.wide_levitation * by[2] + lift * wave[2]
                for by, wave in zip(waves, self.waves[:2], strict=True)
            )

    @cached_property
    def height_along(self) -> list[arb]:
        """``|z|²/2`` differentiated along the columns."""
        z, turned = self.wide[0], cross(self._p[0], self._q[0])
        return [dot(z, along) - turned * turn for along, _, turn in self._moved]

    @cached_property
    def height(self) -> arb:
        """``|z|²`` of all flights, a mean value form."""
        z = self.centre(0)
        return dot(z, z) + spread(self.height_along) * 2

    @cached_property
    def rise_along(self) -> list[arb]:
        """``Re(z̄ż)`` differentiated along the columns."""
        (p, dp, _), (q, dq, _), (z, dz, _) = self._p, self._q, self.wide
        turned = cross(p, dq) + cross(dp, q)
        return [dot(dz, along) + dot(z, rate) - turned * turn for along, rate, turn in self._moved]

    @cached_property
    def rise(self) -> arb:
        """The rate of ``|z|²`` on all flights, a mean value form."""
        centre = dot(self.centre(0), self.centre(1))
        return (centre + spread(self.rise_along)) * 2

    @cached_property
    def curve(self) -> arb:
        """The second derivative of ``|z|²`` on all flights."""
        return (self._products(1, 1) + self._products(0, 2)) * 2

    @cached_property
    def twist_along(self) -> list[arb]:
        """``Im(z̄ż)`` differentiated along the columns."""
        (p, dp, _), (q, dq, _), (z, dz, _) = self._p, self._q, self.wide
        turned = dot(p, dq) - dot(dp, q)
        return [cross(along, dz) + cross(z, rate) + turned * turn for along, rate, turn in self._moved]

    def angle_along(self, square: arb) -> list[arb]:
        """``ψ − arg z`` differentiated along the columns, from a ball of ``|z|²``."""
        z, turned = self.wide[0], dot(self.wide[0], self._p[0])
        return [(turned * turn - cross(z, along)) / square for along, _, turn in self._moved]


def dot(one: Complex[Real], other: Complex[Real]) -> Real:
    """``Re(z̄ w)``."""
    return one.real * other.real + one.imag * other.imag


def cross(one: Complex[Real], other: Complex[Real]) -> Real:
    """``Im(z̄ w)``."""
    return one.real * other.imag - one.imag * other.real


def spread(columns: list[arb]) -> arb:
    """All sums of numbers of the columns, each with a factor from −1 to 1."""
    return UNIT * sum(map(abs, columns), arb(0))
