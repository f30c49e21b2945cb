"""Patches of states, and the flights that leave them, in the fixed frame turned such that the flight begins on the real axis.

Levitation turns: ``Λ e^{it}`` with ``|Λ| = |U*| = ℓ``.  With the response ``h₁`` of the rotor to an impulse and ``h₀`` to a displacement,
``h₀'' + γh₀' + ω²h₀ = 0``, ``h₀(0) = 1``, ``h₀'(0) = 0``, every flight is

    z(t) = c(t) + V h₁(t) + Λ k(t) .

*From the wall*, at ``z(0) = 1`` with the velocity ``V = a + ib``: ``c = h₀`` and ``k = e^{it} − h₀ − i h₁``.  Its state has the three
coordinates ``a``, ``b``, ``ψ = arg Λ``: turns of the whole plane change nothing.

*From levitation*, disturbed by ``V = v > 0`` along the real axis: ``c = 0`` and ``k = e^{it}``, with the two coordinates ``v`` and ``ψ``, and in place of
``h₁`` the response to the disturbance (:mod:`carom.proofs.starts`).

A patch holds the states ``x₀ + s₁ξ₁ + s₂ξ₂ + s₃ξ₁² + s₄ξ₁ξ₂ + s₅ξ₂² + Σ_g s_g ξ_g``, ``|ξ_g| ≤ 1``: ``ξ₁`` and ``ξ₂`` say where in the cell a kick is, the other spans
hold what earlier impacts have left out, and a rest for each coordinate what the last one has.  A function ``f`` of the state lies in ``f(x₀) + Σ_g f'(X)s_g [−1, 1]`` there, ``X`` the box of the patch
(mean value form).
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from flint import acb, arb

from carom.proofs.lines import Numbers
from carom.proofs.rub_balls import Rub
from carom.proofs.series import I, hyperbolic
from carom.proofs.starts import Blow, Plain, Response, Start

UNIT = arb(0, 1)
"""All numbers from −1 to 1."""
FORM = 5
"""Spans by where in the cell a kick is, those of first and second order."""


BLOW = Blow()
Wave = tuple[Any, Any, Any]


class Waves(NamedTuple):
    """``c``, ``h₁`` and ``k`` of a flight with their first two derivatives, at a time or on an interval of times."""

    place: Wave
    rate: Wave
    bend: Wave


class Held:
    """What flights need to know of a rotor, at the precision at hand.

    Parameters
    ----------
    numbers : Numbers
    start : Start
        The disturbance that takes the rotor out of levitation.

    Attributes
    ----------
    half, split : arb
        ``γ/2`` and ``γ²/4 − ω²``.
    radius, radius_squared, room : arb
        ``ℓ``, ``ℓ²`` and ``1 − ℓ``.
    grip : arb
        ``μ(1 + d)``.
    """

    def __init__(self, numbers: Numbers, start: Start = BLOW) -> None:
        self.numbers, self.start = numbers, start
        self.half, self.split = numbers.gamma / 2, numbers.split
        self.radius = numbers.levitation
        self.radius_squared = self.radius * self.radius
        self.room = 1 - self.radius
        self.grip = numbers.mu * (1 + numbers.d)
        self._plain = tuple(float(x.mid()) for x in (self.half, self.split, numbers.omega_squared))

    def responses(self, time: Any) -> tuple[Response, Response]:
        """``h₀`` and ``h₁``."""
        n = self.numbers
        even, odd = hyperbolic(self.split, time)
        fade = (-self.half * time).exp()
        h = fade * odd
        dh = fade * (even - self.half * odd)
        d2h = -n.gamma * dh - n.omega_squared * h
        c, dc = fade * (even + self.half * odd), -n.omega_squared * h
        return (c, dc, -n.omega_squared * dh), (h, dh, d2h)

    def plain_responses(self, time: float) -> tuple[Plain, Plain]:
        """The same in doubles."""
        half, split, stiff = self._plain
        root = cmath.sqrt(split) or 1e-9
        fade = cmath.exp(-half * time).real
        h = fade * (cmath.sinh(root * time) / root).real
        dh = fade * cmath.cosh(root * time).real - half * h
        return (dh + 2 * half * h, -stiff * h, -stiff * dh), (h, dh, -2 * half * dh - stiff * h)

    @cached_property
    def rub(self) -> Rub:
        """The stable rub; its numbers are not finite where there is none."""
        return Rub.of(self.numbers)

    @cached_property
    def released(self) -> Response:
        """The response to the disturbance when motion becomes free."""
        return self.start.last(self)

    def waves(self, time: Any, from_wall: bool) -> Waves:
        """Waves of flights from the wall or from levitation."""
        sine, cosine = time.sin_cos()
        turn, way = acb(cosine, sine), acb(-sine, cosine)
        if not from_wall:
            zero, (h, dh, d2h) = arb(0), self.start.response(self, time)
            return Waves((zero, h, turn), (zero, dh, way), (zero, d2h, -turn))
        (c, dc, d2c), (h, dh, d2h) = self.responses(time)
        return Waves((c, h, turn - acb(c, h)), (dc, dh, way - acb(dc, dh)), (d2c, d2h, -turn - acb(d2c, d2h)))

    def plain_waves(self, time: float, from_wall: bool) -> tuple[tuple[complex, complex, complex], ...]:
        """The same in doubles."""
        turn = cmath.exp(1j * time)
        if not from_wall:
            h, dh, d2h = self.start.plain_response(self, time)
            return (0, h, turn), (0, dh, 1j * turn), (0, d2h, -turn)
        (c, dc, d2c), (h, dh, d2h) = self.plain_responses(time)
        return (
            (c, h, turn - c - 1j * h),
            (dc, dh, 1j * turn - dc - 1j * dh),
            (d2c, d2h, -turn - d2c - 1j * d2h),
        )


@dataclass(frozen=True)
class Patch:
    """States of one flight each.

    Attributes
    ----------
    centre : list of arb
        Exact numbers: ``v, ψ`` from levitation, ``a, b, ψ`` from the wall.
    spans : list of list of arb
        Exact vectors of the coordinates: two for a patch that is straight, else first those by ``ξ₁``, ``ξ₂``, ``ξ₁²``, ``ξ₁ξ₂`` and ``ξ₂²``.
    rest : list of arb
        Exact half widths of the coordinates.
    """

    centre: list[Any]
    spans: list[list[Any]]
    rest: list[Any]

    @property
    def from_wall(self) -> bool:
        """Whether its flights begin at the wall."""
        return len(self.centre) > 2

    @cached_property
    def box(self) -> list[Any]:
        """Balls of the coordinates."""
        sizes = list(self.rest)
        for span in self.spans:
            sizes = [size + abs(x) for size, x in zip(sizes, span, strict=True)]
        return [x + UNIT * size for x, size in zip(self.centre, sizes, strict=True)]

    @cached_property
    def directions(self) -> list[list[Any]]:
        """The spans, where only the first two are given with those of second order, and one for each coordinate whose rest is not zero."""
        size = len(self.rest)
        straight = [[arb(0)] * size] * (FORM - len(self.spans))
        rests = [
            [rest if i == j else arb(0) for i in range(size)] for j, rest in enumerate(self.rest) if not rest.is_zero()
        ]
        return [*self.spans, *straight, *rests]


class Departure:
    """The flights of a patch.

    Parameters
    ----------
    held : Held
    patch : Patch
    alone : bool
        Whether only the flight of the centre is meant, with its derivatives along the same columns.

    Attributes
    ----------
    velocity, levitation : acb
        ``V`` and ``Λ`` of the centre.
    wide_velocity, wide_levitation : acb
        Those of all states.
    columns : list of pairs
        ``V`` and ``ψ`` differentiated along the spans and then along what holds the rest; exact.
    """

    def __init__(self, held: Held, patch: Patch, *, alone: bool = False) -> None:
        self.held, self.patch, self.from_wall = held, patch, patch.from_wall
        self.velocity, self.levitation = _parts(held, patch.centre)
        self.wide_velocity, self.wide_levitation = _parts(held, patch.centre if alone else patch.box)
        self.columns = [(_speed(along), along[-1]) for along in patch.directions]
        middle = [float(x) for x in patch.centre]
        self._velocity = complex(*middle[:-1])
        self._levitation = float(held.radius.mid()) * cmath.exp(1j * middle[-1])
        self._columns = [(complex(v), 1j * self._levitation * float(turn)) for v, turn in self.columns]

    # -------------------------------------------------------------------------------------- balls

    @property
    def busy(self) -> Any:
        """Time from which motion is free."""
        return arb(0) if self.from_wall else self.held.start.lasts

    @property
    def deviation(self) -> tuple[Any, Any]:
        """Place and velocity from levitation, of all states, when motion becomes free."""
        if self.from_wall:
            return 1 - self.wide_levitation, self.wide_velocity - self.wide_levitation * I
        place, rate, _ = self.held.released
        return self.wide_velocity * place, self.wide_velocity * rate

    def at(self, time: Any) -> Moment:
        """The flights at a time, as mean value forms."""
        return Moment(self, self.held.waves(time, self.from_wall))

    # -------------------------------------------------------------------------------------- doubles

    def plain(self, time: float) -> tuple[float, float, float]:
        """``|z|²`` and its first two derivatives on the flight of the centre, in doubles."""
        z, dz, d2z = (
            c + self._velocity * h + self._levitation * k for c, h, k in self.held.plain_waves(time, self.from_wall)
        )
        return (
            abs(z) ** 2,
            2 * (z.conjugate() * dz).real,
            2 * (abs(dz) ** 2 + (z.conjugate() * d2z).real),
        )

    def plain_spread(self, time: float) -> tuple[list[float], list[float]]:
        """By how much ``|z|²`` and its rate change along each column, in doubles."""
        (c, h, k), (dc, dh, dk), _ = self.held.plain_waves(time, self.from_wall)
        z, dz = (
            c + self._velocity * h + self._levitation * k,
            dc + self._velocity * dh + self._levitation * dk,
        )
        places, rates = [], []
        for v, lift in self._columns:
            along, rate = v * h + lift * k, v * dh + lift * dk
            places.append(2 * (z.conjugate() * along).real)
            rates.append(2 * (z.conjugate() * rate + dz.conjugate() * along).real)
        return places, rates

    def weights(self, time: float) -> tuple[float, float]:
        """How much each span has to do with ``|z|²`` and its rate at a time."""
        places, rates = self.plain_spread(time)
        return abs(places[0]) + abs(rates[0]), abs(places[1]) + abs(rates[1])


def _speed(coordinates: list[Any]) -> Any:
    """Velocity of coordinates, or of changes of them."""
    return acb(coordinates[0], coordinates[1] if len(coordinates) > 2 else 0)


def _parts(held: Held, coordinates: list[Any]) -> tuple[Any, Any]:
    sine, cosine = coordinates[-1].sin_cos()
    return _speed(coordinates), acb(held.radius * cosine, held.radius * sine)


class Moment:
    """All flights of a patch at a time or on an interval of times.

    With ``z = p + q``, ``p = c + V h₁`` and ``q = Λk``, nothing but products of ``p`` and ``q`` depends on ``ψ`` in ``|z|²`` and its rates:
    ``|q|² = ℓ²|k|²``.  All are evaluated so that this is not lost in the width of ``Λ``.
    """

    def __init__(self, departure: Departure, waves: Waves) -> None:
        self.departure, self.waves = departure, waves

    @property
    def parts(self) -> tuple[list[Any], list[Any], list[Any]]:
        """``p``, ``q`` and ``k`` with their first two derivatives."""
        return self._p, self._q, [wave[2] for wave in self.waves]

    def centre(self, wave: Wave) -> Any:
        """Place or rate on the flight of the centre."""
        d = self.departure
        return wave[0] + d.velocity * wave[1] + d.levitation * wave[2]

    @cached_property
    def _p(self) -> list[Any]:
        return [wave[0] + self.departure.wide_velocity * wave[1] for wave in self.waves]

    @cached_property
    def _q(self) -> list[Any]:
        return [self.departure.wide_levitation * wave[2] for wave in self.waves]

    @cached_property
    def wide(self) -> list[Any]:
        """``z``, ``ż`` and ``z̈`` of all flights."""
        return [p + q for p, q in zip(self._p, self._q, strict=True)]

    def _products(self, one: int, other: int) -> Any:
        """``Re(z̄ w)`` of two of them."""
        (p, q), (u, w) = ((self._p[j], self._q[j]) for j in (one, other))
        turning = dot(self.waves[one][2], self.waves[other][2])
        return dot(p, u) + dot(p, w) + dot(q, u) + self.departure.held.radius_squared * turning

    @cached_property
    def slope(self) -> Any:
        """``Re(z̄ż)`` on all flights, as wide as the patch and the times are."""
        return self._products(0, 1)

    @cached_property
    def _moved(self) -> list[tuple[Any, Any, Any]]:
        """``V h₁`` and its rate differentiated along the columns, and the turn of ``Λ`` along them."""
        h, dh = self.waves.place[1], self.waves.rate[1]
        return [(v * h, v * dh, turn) for v, turn in self.departure.columns]

    @cached_property
    def height_along(self) -> list[Any]:
        """``|z|²/2`` differentiated along the columns."""
        z, turned = self.wide[0], cross(self._p[0], self._q[0])
        return [dot(z, along) - turned * turn for along, _, turn in self._moved]

    @cached_property
    def height(self) -> Any:
        """``|z|²`` of all flights, a mean value form."""
        z = self.centre(self.waves.place)
        return dot(z, z) + spread(self.height_along) * 2

    @cached_property
    def rise_along(self) -> list[Any]:
        """``Re(z̄ż)`` differentiated along the columns."""
        (p, dp, _), (q, dq, _), (z, dz, _) = self._p, self._q, self.wide
        turned = cross(p, dq) + cross(dp, q)
        return [dot(dz, along) + dot(z, rate) - turned * turn for along, rate, turn in self._moved]

    @cached_property
    def rise(self) -> Any:
        """The rate of ``|z|²`` on all flights, a mean value form."""
        centre = dot(self.centre(self.waves.place), self.centre(self.waves.rate))
        return (centre + spread(self.rise_along)) * 2

    @cached_property
    def curve(self) -> Any:
        """The second derivative of ``|z|²`` on all flights."""
        return (self._products(1, 1) + self._products(0, 2)) * 2

    @cached_property
    def twist_along(self) -> list[Any]:
        """``Im(z̄ż)`` differentiated along the columns."""
        (p, dp, _), (q, dq, _), (z, dz, _) = self._p, self._q, self.wide
        turned = dot(p, dq) - dot(dp, q)
        return [cross(along, dz) + cross(z, rate) + turned * turn for along, rate, turn in self._moved]

    def angle_along(self, square: Any) -> list[Any]:
        """``ψ − arg z`` differentiated along the columns, from a ball of ``|z|²``."""
        z, turned = self.wide[0], dot(self.wide[0], self._p[0])
        return [(turned * turn - cross(z, along)) / square for along, _, turn in self._moved]


def dot(one: Any, other: Any) -> Any:
    """``Re(z̄ w)``."""
    return one.real * other.real + one.imag * other.imag


def cross(one: Any, other: Any) -> Any:
    """``Im(z̄ w)``."""
    return one.real * other.imag - one.imag * other.real


def spread(columns: list[Any]) -> Any:
    """All sums of numbers of the columns, each with a factor from −1 to 1."""
    total: Any = arb(0)
    for column in columns:
        total = total + abs(column)
    return UNIT * total
