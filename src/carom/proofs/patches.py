"""Patches of states, and the flights that leave them, in the fixed frame turned such that the flight begins on the real axis.

Levitation turns: ``Λ e^{it}`` with ``|Λ| = |U*| = ℓ``.  With the response ``h₁`` of the rotor to an impulse and ``h₀`` to a displacement,
``h₀'' + γh₀' + ω²h₀ = 0``, ``h₀(0) = 1``, ``h₀'(0) = 0``, every flight is

    z(t) = c(t) + V h₁(t) + Λ k(t) .

*From the wall*, at ``z(0) = 1`` with the velocity ``V = a + ib``: ``c = h₀`` and ``k = e^{it} − h₀ − i h₁``.  Its state has the three
coordinates ``a``, ``b``, ``ψ = arg Λ``: turns of the whole plane change nothing.

*From levitation*, kicked by ``V = v > 0`` along the real axis: ``c = 0`` and ``k = e^{it}``, with the two coordinates ``v`` and ``ψ``.

A patch holds the states ``x₀ + Σ_g s_g ξ_g``, ``|ξ_g| ≤ 1``: two spans that it inherits from the cell of kicks, and one for each coordinate
that holds all else.  A function ``f`` of the state lies in ``f(x₀) + Σ_g f'(X)s_g [−1, 1]`` there, ``X`` the box of the patch
(mean value form).
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from flint import acb, arb

from carom.proofs.lines import Numbers
from carom.proofs.plain_flights import PlainRotor
from carom.proofs.series import hyperbolic
from carom.proofs.sides import Side, responses_by

UNIT = arb(0, 1)
"""All numbers from −1 to 1."""
OF_KICKS = 2
"""Spans of a cell of kicks; the others are those of the parameters of a box of rotors."""


Wave = tuple[Any, Any, Any]


class Waves(NamedTuple):
    """``c``, ``h₁`` and ``k`` of a flight with their first two derivatives, at a time or on an interval of times."""

    place: Wave
    rate: Wave
    bend: Wave


class Held:
    """What flights need to know of a rotor, or of a box of rotors, at the precision at hand.

    Parameters
    ----------
    numbers : Numbers
        Of all rotors.
    middle : Numbers, optional
        Of the rotor in the middle of the box.
    sides : sequence of Side
        By how much each parameter of the box moves them.

    Attributes
    ----------
    middle : Held
        The rotor in the middle.
    half, split : arb
        ``γ/2`` and ``γ²/4 − ω²``.
    radius, radius_squared, room : arb
        ``ℓ``, ``ℓ²`` and ``1 − ℓ``.
    grip : arb
        ``μ(1 + d)``.
    """

    def __init__(self, numbers: Numbers, middle: Numbers | None = None, sides: Sequence[Side] = ()) -> None:
        self.numbers, self.sides = numbers, sides
        self.middle = self if middle is None else Held(middle)
        self.half, self.split = numbers.gamma / 2, numbers.split
        self.radius = numbers.levitation
        self.radius_squared = self.radius * self.radius
        self.room = 1 - self.radius
        self.grip = numbers.mu * (1 + numbers.d)
        self.plain = PlainRotor.of(numbers.gamma, numbers.omega_squared, self.radius)
        self._ends = [self.plain.ends(side) for side in sides]

    def waves(self, time: Any, from_wall: bool) -> Waves:
        """Waves of flights from the wall or from levitation."""
        n = self.numbers
        even, odd = hyperbolic(self.split, time)
        fade = (-self.half * time).exp()
        h = fade * odd
        dh = fade * (even - self.half * odd)
        d2h = -n.gamma * dh - n.omega_squared * h
        sine, cosine = time.sin_cos()
        turn, way = acb(cosine, sine), acb(-sine, cosine)
        if not from_wall:
            zero = arb(0)
            return Waves((zero, h, turn), (zero, dh, way), (zero, d2h, -turn))
        c, dc = fade * (even + self.half * odd), -n.omega_squared * h
        d2c = -n.omega_squared * dh
        return Waves((c, h, turn - acb(c, h)), (dc, dh, way - acb(dc, dh)), (d2c, d2h, -turn - acb(d2c, d2h)))

    def waves_by(self, time: Any, from_wall: bool) -> list[tuple[Wave, Wave]]:
        """``c``, ``h₁`` and ``k`` and their rates, differentiated by each parameter of the box."""
        found = []
        for c, h, dc, dh in responses_by(self.numbers, self.sides, time) if self.sides else []:
            place, rate = (c, h, -acb(c, h)), (dc, dh, -acb(dc, dh))
            found.append((place, rate) if from_wall else ((arb(0), h, acb(0)), (arb(0), dh, acb(0))))
        return found

    def plain_waves(self, time: float, from_wall: bool) -> tuple[tuple[complex, complex, complex], ...]:
        """Waves of the rotor in the middle in doubles."""
        return self.middle.plain.waves(time, from_wall)

    def plain_by(self, time: float, from_wall: bool, velocity: complex, turn: complex) -> list[tuple[complex, complex]]:
        """By how much place and rate change along each parameter, in doubles; ``turn`` is the direction of ``Λ``."""
        found = []
        for ends in self._ends:
            one, other = (end.flight(time, from_wall, velocity, turn) for end in ends)
            found.append(((one[0] - other[0]) / 2, (one[1] - other[1]) / 2))
        return found


@dataclass(frozen=True)
class Patch:
    """States of one flight each.

    Attributes
    ----------
    centre : list of arb
        Exact numbers: ``v, ψ`` from levitation, ``a, b, ψ`` from the wall.
    spans : list of list of arb
        Exact vectors of the coordinates: two of the cell of kicks, and one for each parameter of the box of rotors.
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
        return [
            x + UNIT * (sum(map(abs, along), rest))
            for x, *along, rest in zip(self.centre, *self.spans, self.rest, strict=True)
        ]


class Departure:
    """The flights of a patch.

    Attributes
    ----------
    velocity, levitation : acb
        ``V`` and ``Λ`` of the centre.
    wide_velocity, wide_levitation : acb
        Those of all states.
    columns : list of pairs
        ``V`` and ``ψ`` differentiated along the spans and then along what holds the rest; exact.
    """

    def __init__(self, held: Held, patch: Patch) -> None:
        self.held, self.patch, self.from_wall = held, patch, patch.from_wall
        self.velocity, self.levitation = _parts(held.middle, patch.centre)
        self.wide_velocity, self.wide_levitation = _parts(held, patch.box)
        self.wide_turn = _turn(patch.box)
        directions = [*patch.spans]
        for j, rest in enumerate(patch.rest):
            if not rest.is_zero():
                directions.append([rest if i == j else arb(0) for i in range(len(patch.rest))])
        self.columns = [(_speed(along), along[-1]) for along in directions]
        middle = [float(x) for x in patch.centre]
        self._velocity = complex(*middle[:-1])
        self._turn = cmath.exp(1j * middle[-1])
        self._levitation = held.middle.plain.radius * self._turn
        self._columns = [(complex(v), 1j * self._levitation * float(turn)) for v, turn in self.columns]

    # -------------------------------------------------------------------------------------- balls

    def at(self, time: Any) -> Moment:
        """The flights at a time, as mean value forms."""
        return Moment(self, time)

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
        moved = self.held.plain_by(time, self.from_wall, self._velocity, self._turn)
        for j, (along, rate) in enumerate(moved, OF_KICKS):
            places[j] += 2 * (z.conjugate() * along).real
            rates[j] += 2 * (z.conjugate() * rate + dz.conjugate() * along).real
        return places, rates

    def weights(self, time: float) -> tuple[float, ...]:
        """How much each span has to do with ``|z|²`` and its rate at a time."""
        columns = zip(*self.plain_spread(time), strict=True)
        return tuple(abs(place) + abs(rate) for place, rate in columns)[: len(self.patch.spans)]


def _speed(coordinates: list[Any]) -> Any:
    """Velocity of coordinates, or of changes of them."""
    return acb(coordinates[0], coordinates[1] if len(coordinates) > 2 else 0)


def _parts(held: Held, coordinates: list[Any]) -> tuple[Any, Any]:
    return _speed(coordinates), _turn(coordinates) * held.radius


def _turn(coordinates: list[Any]) -> Any:
    """Direction of ``Λ``."""
    sine, cosine = coordinates[-1].sin_cos()
    return acb(cosine, sine)


class Moment:
    """All flights of a patch at a time or on an interval of times.

    With ``z = p + q``, ``p = c + V h₁`` and ``q = Λk``, nothing but products of ``p`` and ``q`` depends on ``ψ`` in ``|z|²`` and its rates:
    ``|q|² = ℓ²|k|²``.  All are evaluated so that this is not lost in the width of ``Λ``.
    """

    def __init__(self, departure: Departure, time: Any) -> None:
        self.departure, self.time = departure, time
        self.waves = departure.held.waves(time, departure.from_wall)

    @cached_property
    def _middle(self) -> Waves:
        """Waves of the rotor in the middle of the box."""
        held = self.departure.held
        return self.waves if held.middle is held else held.middle.waves(self.time, self.departure.from_wall)

    def centre(self, order: int) -> Any:
        """Place (0) or rate (1) on the flight of the centre."""
        d, wave = self.departure, self._middle[order]
        return wave[0] + d.velocity * wave[1] + d.levitation * wave[2]

    @cached_property
    def _moved(self) -> list[tuple[Any, Any]]:
        """Place and rate differentiated along each parameter, the state at the start kept."""
        d, found = self.departure, []
        for waves, side in zip(d.held.waves_by(self.time, d.from_wall), d.held.sides, strict=True):
            lift = d.wide_turn * side.radius
            found.append(
                tuple(
                    by[0] + d.wide_velocity * by[1] + d.wide_levitation * by[2] + lift * wave[2]
                    for by, wave in zip(waves, self.waves[:2], strict=True)
                )
            )
        return found

    def _with_moves(self, columns: list[Any], moves: Iterable[Any]) -> list[Any]:
        """Derivatives along the columns, with what parameters do by themselves."""
        for j, move in enumerate(moves, OF_KICKS):
            columns[j] = columns[j] + move
        return columns

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
    def height_along(self) -> list[Any]:
        """``|z|²/2`` differentiated along the columns."""
        turned, h = cross(self._p[0], self._q[0]), self.waves.place[1]
        columns = [dot(self.wide[0], v) * h - turned * turn for v, turn in self.departure.columns]
        return self._with_moves(columns, (dot(self.wide[0], place) for place, _ in self._moved))

    @cached_property
    def height(self) -> Any:
        """``|z|²`` of all flights, a mean value form."""
        z = self.centre(0)
        return dot(z, z) + spread(self.height_along) * 2

    @cached_property
    def rise_along(self) -> list[Any]:
        """``Re(z̄ż)`` differentiated along the columns."""
        (p, dp, _), (q, dq, _), (z, dz, _) = self._p, self._q, self.wide
        turned, h, dh = cross(p, dq) + cross(dp, q), self.waves.place[1], self.waves.rate[1]
        columns = [dot(dz, v) * h + dot(z, v) * dh - turned * turn for v, turn in self.departure.columns]
        return self._with_moves(columns, (dot(dz, place) + dot(z, rate) for place, rate in self._moved))

    @cached_property
    def rise(self) -> Any:
        """The rate of ``|z|²`` on all flights, a mean value form."""
        centre = dot(self.centre(0), self.centre(1))
        return (centre + spread(self.rise_along)) * 2

    @cached_property
    def curve(self) -> Any:
        """The second derivative of ``|z|²`` on all flights."""
        return (self._products(1, 1) + self._products(0, 2)) * 2

    @cached_property
    def twist_along(self) -> list[Any]:
        """``Im(z̄ż)`` differentiated along the columns."""
        (p, dp, _), (q, dq, _), (z, dz, _) = self._p, self._q, self.wide
        turned, h, dh = dot(p, dq) - dot(dp, q), self.waves.place[1], self.waves.rate[1]
        columns = [cross(v, dz) * h + cross(z, v) * dh + turned * turn for v, turn in self.departure.columns]
        return self._with_moves(columns, (cross(place, dz) + cross(z, rate) for place, rate in self._moved))

    def angle_along(self, square: Any) -> list[Any]:
        """``ψ − arg z`` differentiated along the columns, from a ball of ``|z|²``."""
        z, h = self.wide[0], self.waves.place[1]
        turned = dot(z, self._p[0])
        columns = [(turned * turn - cross(z, v) * h) / square for v, turn in self.departure.columns]
        return self._with_moves(columns, (-cross(z, place) / square for place, _ in self._moved))


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
