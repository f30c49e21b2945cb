"""Patches of states, and the flights that leave them, in the fixed frame turned such that the flight begins on the real axis.

Levitation turns: ``Λ e^{it}`` with ``|Λ| = |U*| = ℓ``.  With the response ``h₁`` of the rotor to an impulse and ``h₀`` to a displacement,
``h₀'' + γh₀' + ω²h₀ = 0``, ``h₀(0) = 1``, ``h₀'(0) = 0``, every flight is

    z(t) = c(t) + V h₁(t) + Λ k(t) .

*From the wall*, at ``z(0) = 1`` with the velocity ``V = a + ib``: ``c = h₀`` and ``k = e^{it} − h₀ − i h₁``.  Its state has the three
coordinates ``a``, ``b``, ``ψ = arg Λ``: turns of the whole plane change nothing.

*From levitation*, disturbed by ``V = v > 0`` along the real axis: ``c = 0`` and ``k = e^{it}``, with the two coordinates ``v`` and ``ψ``, and in place of
``h₁`` the response to the disturbance (:mod:`carom.proofs.starts`).

A patch holds the states ``x₀ + s₁ξ₁ + s₂ξ₂ + s₃ξ₁² + s₄ξ₁ξ₂ + s₅ξ₂² + Σ_g s_g ξ_g``, ``|ξ_g| ≤ 1``: ``ξ₁`` and ``ξ₂`` say where in the cell a kick is, the other spans
hold what earlier impacts have left out, those next to these what the parameters of a box of rotors do, and a rest for each coordinate what the last one has.  A function ``f`` of the state lies in ``f(x₀) + Σ_g f'(X)s_g [−1, 1]`` there, ``X`` the box of the patch
(mean value form).

Flights in double precision say where a proof looks; no claim rests on them.
"""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from flint import acb, arb

from carom.proofs.balls import I, hyperbolic
from carom.proofs.lines import LineNumbers
from carom.proofs.moments import FORM, UNIT, Moment, Wave, Waves
from carom.proofs.sides import Side, responses_by
from carom.proofs.starts import DisturbedStart, KickStart, Plain, Response
from carom.proofs.steady import Rub

PlainWave = tuple[complex, complex, complex]


@dataclass(frozen=True)
class PlainRotor:
    """A rotor in doubles: ``γ``, ``ω²`` and ``ℓ`` of :mod:`carom.proofs.patches`."""

    gamma: float
    stiff: float
    radius: float

    @classmethod
    def of(cls, *balls: arb) -> PlainRotor:
        """The rotor in the middle of balls."""
        return cls(*(float(ball.mid()) for ball in balls))

    def ends(self, side: Side) -> tuple[PlainRotor, PlainRotor]:
        """The rotors at both ends of a parameter, the upper one first."""
        by = [float(ball.mid()) for ball in (side.gamma, side.omega_squared, side.radius)]
        one, other = (
            PlainRotor(self.gamma + sign * by[0], self.stiff + sign * by[1], self.radius + sign * by[2])
            for sign in (1, -1)
        )
        return one, other

    def responses(self, time: float) -> tuple[PlainWave, PlainWave]:
        """``h₀`` and ``h₁`` with their first two derivatives."""
        half, stiff = self.gamma / 2, self.stiff
        root = cmath.sqrt(half * half - stiff) or 1e-9
        fade = cmath.exp(-half * time).real
        h = fade * (cmath.sinh(root * time) / root).real
        dh = fade * cmath.cosh(root * time).real - half * h
        return (dh + 2 * half * h, -stiff * h, -stiff * dh), (h, dh, -2 * half * dh - stiff * h)

    def flight(self, time: float, from_wall: bool, velocity: complex, turn: complex) -> tuple[complex, complex]:
        """Place and rate on the flight with a velocity at the start and a direction of ``Λ``."""
        (c, dc, _), (h, dh, _) = self.responses(time)
        lift, turned = self.radius * turn, cmath.exp(1j * time)
        if not from_wall:
            return velocity * h + lift * turned, velocity * dh + lift * 1j * turned
        place, rate = turned - c - 1j * h, 1j * turned - dc - 1j * dh
        return c + velocity * h + lift * place, dc + velocity * dh + lift * rate


KICK_START = KickStart()


class Held:
    """What flights need to know of a rotor, or of a box of rotors, at the precision at hand.

    Parameters
    ----------
    numbers : LineNumbers
        Of all rotors.
    start : DisturbedStart
        The disturbance that takes the rotor out of levitation; of a box of rotors a kick.
    middle : LineNumbers, optional
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

    def __init__(
        self,
        numbers: LineNumbers[arb],
        start: DisturbedStart = KICK_START,
        middle: LineNumbers[arb] | None = None,
        sides: Sequence[Side] = (),
    ) -> None:
        self.numbers, self.start, self.sides = numbers, start, sides
        self.middle = self if middle is None else Held(middle)
        self.half, self.split = numbers.gamma / 2, numbers.split
        self.radius = numbers.levitation
        self.radius_squared = self.radius * self.radius
        self.room = 1 - self.radius
        self.grip = numbers.mu * (1 + numbers.d)
        self.plain = PlainRotor.of(numbers.gamma, numbers.omega_squared, self.radius)
        self._ends = [self.plain.ends(side) for side in sides]

    def responses(self, time: arb) -> tuple[Response, Response]:
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
        """The same in doubles, of the rotor in the middle."""
        return self.middle.plain.responses(time)

    @cached_property
    def rub(self) -> Rub:
        """The stable rub; its numbers are not finite where there is none."""
        return Rub.of(self.numbers)

    @cached_property
    def released(self) -> Response:
        """The response to the disturbance when motion becomes free."""
        return self.start.last(self)

    def waves(self, time: arb, from_wall: bool) -> Waves:
        """Waves of flights from the wall or from levitation."""
        sine, cosine = time.sin_cos()
        turn, way = acb(cosine, sine), acb(-sine, cosine)
        if not from_wall:
            zero, (h, dh, d2h) = arb(0), self.start.response(self, time)
            return Waves((zero, h, turn), (zero, dh, way), (zero, d2h, -turn))
        (c, dc, d2c), (h, dh, d2h) = self.responses(time)
        return Waves((c, h, turn - acb(c, h)), (dc, dh, way - acb(dc, dh)), (d2c, d2h, -turn - acb(d2c, d2h)))

    def waves_by(self, time: arb, from_wall: bool) -> list[tuple[Wave, Wave]]:
        """``c``, ``h₁`` and ``k`` and their rates, differentiated by each parameter of the box."""
        found: list[tuple[Wave, Wave]] = []
        for c, h, dc, dh in responses_by(self.numbers, self.sides, time) if self.sides else []:
            place, rate = (c, h, -acb(c, h)), (dc, dh, -acb(dc, dh))
            found.append((place, rate) if from_wall else ((arb(0), h, acb(0)), (arb(0), dh, acb(0))))
        return found

    def plain_by(self, time: float, from_wall: bool, velocity: complex, turn: complex) -> list[tuple[complex, complex]]:
        """By how much place and rate change along each parameter, in doubles; ``turn`` is the direction of ``Λ``."""
        found = []
        for ends in self._ends:
            one, other = (end.flight(time, from_wall, velocity, turn) for end in ends)
            found.append(((one[0] - other[0]) / 2, (one[1] - other[1]) / 2))
        return found

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
        Exact vectors of the coordinates: two for a patch that is straight, else first those by ``ξ₁``, ``ξ₂``, ``ξ₁²``, ``ξ₁ξ₂`` and ``ξ₂²``, then one
        for each parameter of the box of rotors.
    rest : list of arb
        Exact half widths of the coordinates.
    """

    centre: list[arb]
    spans: list[list[arb]]
    rest: list[arb]

    @property
    def from_wall(self) -> bool:
        """Whether its flights begin at the wall."""
        return len(self.centre) > 2

    @cached_property
    def box(self) -> list[arb]:
        """Balls of the coordinates."""
        sizes = list(self.rest)
        for span in self.spans:
            sizes = [size + abs(x) for size, x in zip(sizes, span, strict=True)]
        return [x + UNIT * size for x, size in zip(self.centre, sizes, strict=True)]

    @cached_property
    def directions(self) -> list[list[arb]]:
        """The spans, where only the first two are given with those of second order, and one for each coordinate whose rest is not zero."""
        size = len(self.rest)
        straight = [[arb(0)] * size] * (FORM - len(self.spans))
        rests = [
            [rest if i == j else arb(0) for i in range(size)] for j, rest in enumerate(self.rest) if not rest.is_zero()
        ]
        return [*self.spans, *straight, *rests]


class PatchDeparture:
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
        self.velocity, self.levitation = _parts(held.middle, patch.centre)
        box = patch.centre if alone else patch.box
        self.wide_velocity, self.wide_levitation = _parts(held, box)
        self.wide_turn = _turn(box)
        self.columns = [(_speed(along), along[-1]) for along in patch.directions]
        middle = [float(x) for x in patch.centre]
        self._velocity = complex(*middle[:-1])
        self._turn = cmath.exp(1j * middle[-1])
        self._levitation = held.middle.plain.radius * self._turn
        self._columns = [(complex(v), 1j * self._levitation * float(turn)) for v, turn in self.columns]

    # -------------------------------------------------------------------------------------- balls

    @property
    def busy(self) -> arb:
        """Time from which motion is free."""
        return arb(0) if self.from_wall else self.held.start.lasts

    @property
    def deviation(self) -> tuple[acb, acb]:
        """Place and velocity from levitation, of all states, when motion becomes free."""
        if self.from_wall:
            return 1 - self.wide_levitation, self.wide_velocity - self.wide_levitation * I
        place, rate, _ = self.held.released
        return self.wide_velocity * place, self.wide_velocity * rate

    def at(self, time: arb) -> Moment:
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
        for j, (along, rate) in enumerate(moved, FORM):
            places[j] += 2 * (z.conjugate() * along).real
            rates[j] += 2 * (z.conjugate() * rate + dz.conjugate() * along).real
        return places, rates

    def weights(self, time: float) -> tuple[float, ...]:
        """How much both spans of the cell, and that of each parameter, have to do with ``|z|²`` and its rate at a time."""
        sizes = [abs(place) + abs(rate) for place, rate in zip(*self.plain_spread(time), strict=True)]
        return (*sizes[:2], *sizes[FORM : FORM + len(self.held.sides)])


def _speed(coordinates: list[arb]) -> acb:
    """Velocity of coordinates, or of changes of them."""
    return acb(coordinates[0], coordinates[1] if len(coordinates) > 2 else 0)


def _parts(held: Held, coordinates: list[arb]) -> tuple[acb, acb]:
    return _speed(coordinates), _turn(coordinates) * held.radius


def _turn(coordinates: list[arb]) -> acb:
    """Direction of ``Λ``."""
    sine, cosine = coordinates[-1].sin_cos()
    return acb(cosine, sine)
