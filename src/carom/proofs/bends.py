"""Second derivatives of the state at which flights reach the wall, by the coordinates of the state in which they begin.

With ``h = |z|²/2``, the crossing time ``t(x)`` has ``h(x, t(x)) = 1/2``, so that with indices for partial derivatives

    t_i = −h_i/h_t,      t_ij = −(h_ij + h_it t_j + h_jt t_i + h_tt t_i t_j)/h_t,
    F_;ij = F_ij + F_it t_j + F_jt t_i + F_tt t_i t_j + F_t t_ij

for ``F = a, b, ψ⁺``: ``Re(z̄ż)``, ``Im(z̄ż)`` and ``ψ + t − arg z``.  ``z = p + q`` as in :class:`~carom.proofs.patches.Moment`: along a velocity ``w``
``p`` changes by ``w h₁``, along ``ψ`` ``q`` by ``iq``, and nothing depends on ``ψ`` but products of ``p`` and ``q``.  Where ``|z| = 1``,
``(arg z)_αβ = Im(z̄z_αβ − z̄z_α z̄z_β)``.

All are evaluated as mean value forms, also by the crossing time, which hangs together with the state: balls of both would hold
states that are nowhere near the wall at that time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import combinations_with_replacement
from math import comb
from typing import Any

from flint import arb

from carom.proofs.moments import NOTHING, MeanValueForm, Pair, cross, dot
from carom.proofs.patches import Held, PatchDeparture
from carom.proofs.starts import Response

Jet = list[Pair]
"""A function of time with its derivatives."""
Squares = dict[tuple[int, int], MeanValueForm]
"""Second derivatives by pairs of coordinates, the first index the smaller."""
_REFINEMENTS = 2
"""How often what is known of the crossing times is made sharper."""


def second_derivatives(departure: PatchDeparture, time: arb, window: arb) -> tuple[Squares, Squares, Squares]:
    """Those of ``a``, ``b`` and ``ψ⁺`` for all flights, from the time at which the centre crosses and times in which all do.

    The unknowns of the forms are those of the two spans of the cell, one for each coordinate that holds all other columns, and one for what
    crossing times differ from a linear function of these.
    """
    columns = _few(departure.patch.directions)
    slopes: list[arb] = [arb(0)] * len(columns)
    apart = arb((window - time).abs_upper())
    for _ in range(_REFINEMENTS):
        late = _Bends(departure, columns, MeanValueForm(time, [*slopes, apart], window), 2).late()
        slopes, apart = [], arb(0)
        for column in columns:
            slope = arb(0)
            for x, y in zip(late, column, strict=True):
                slope = slope + x.every * y
            slopes.append(arb(slope.mid()))
            apart = apart + arb(slope.rad())
    return _Bends(departure, columns, MeanValueForm(time, [*slopes, apart], window), 4).totals()


def bent(columns: list[list[arb]], squares: Squares) -> list[arb]:
    """Second-order terms in the centre by the two spans ``s`` and ``t``: ``½ F(s, s)``, ``F(s, t)`` and ``½ F(t, t)``."""
    return _bent(columns, {pair: value.at for pair, value in squares.items()})


def remainder(columns: list[list[arb]], squares: Squares) -> arb:
    """Bound of the second-order term of a mean value form, less what :func:`bent` gives.

    Of all columns but the two spans the sums of their moduli are taken.
    """
    total = _sum(_bent(columns, {pair: value.every - value.at for pair, value in squares.items()}))
    size = len(columns[0])
    few = [_sum(column[m] for column in columns[:2]) for m in range(size)]
    all_ = [_sum(column[m] for column in columns) for m in range(size)]
    for (m, n), value in squares.items():
        left = all_[m] * all_[n] - few[m] * few[n]
        total = total + abs(value.every) * (left / 2 if m == n else left)
    return total.upper()


def _bent(columns: list[list[arb]], squares: dict[tuple[int, int], arb]) -> list[arb]:
    one, other = columns[:2]
    return [_applied(squares, one, one) / 2, _applied(squares, one, other), _applied(squares, other, other) / 2]


def _applied(squares: dict[tuple[int, int], arb], one: list[arb], other: list[arb]) -> arb:
    total = arb(0)
    for (m, n), value in squares.items():
        total = total + value * (one[m] * other[n] if m == n else one[m] * other[n] + one[n] * other[m])
    return total


def _sum(numbers: Iterable[arb]) -> arb:
    return sum(map(abs, numbers), arb(0))


def _few(columns: list[list[arb]]) -> list[list[arb]]:
    """The two spans of the cell, and one for each coordinate that holds all others."""
    size, found = len(columns[0]), columns[:2]
    for j in range(size):
        rest = _sum(column[j] for column in columns[2:])
        if not rest.is_zero():
            found.append([rest if m == j else arb(0) for m in range(size)])
    return found


class _Bends:
    """The partial derivatives that are needed, ``t`` being the coordinate after the last one.

    Parameters
    ----------
    departure : PatchDeparture
    columns : list of list of arb
        The coordinates of the state differentiated by the unknowns, but the last one.
    time : MeanValueForm
    orders : int
        How many derivatives by time are taken, the function itself counted.
    """

    def __init__(self, departure: PatchDeparture, columns: list[list[arb]], time: MeanValueForm, orders: int) -> None:
        held, patch = departure.held, departure.patch
        self.size, self.ell = len(patch.centre), held.radius_squared
        state = [MeanValueForm(x, [*(column[m] for column in columns), arb(0)]) for m, x in enumerate(patch.centre)]
        velocity = Pair(state[0], state[1] if departure.from_wall else NOTHING)
        levitation, turn = _turning(state[-1]) * held.radius, _turning(time)
        still, moving = _responses(departure, time, orders)
        self.moved = [moving, [x.turned for x in moving]][: self.size - 1]
        self.p, self.q, self.k = [], [], []
        for c, h in zip(still, moving, strict=True):
            self.k.append(turn - c - h.turned if departure.from_wall else turn)
            self.p.append(velocity * h + c)
            self.q.append(levitation * self.k[-1])
            turn = turn.turned
        self.turned = [x.turned for x in self.q]
        self.z = [one + other for one, other in zip(self.p, self.q, strict=True)]

    def _along(self, i: int) -> Jet:
        """``z`` differentiated by a coordinate."""
        return self.moved[i] if i < self.size - 1 else self.turned

    def _by(self, i: int) -> tuple[Jet, Jet]:
        """``z`` differentiated by a coordinate, and what it is multiplied with."""
        return (self.moved[i], self.z) if i < self.size - 1 else (self.turned, self.p)

    def late(self) -> list[MeanValueForm]:
        """``t_i``."""
        rate = self._height(1)
        return [-_product(dot, *self._by(i), 0) / rate for i in range(self.size)]

    def _height(self, order: int) -> MeanValueForm:
        """A derivative of ``h``."""
        own = (_product(dot, self.p, self.p, order) + _product(dot, self.k, self.k, order) * self.ell) / 2
        return own + _product(dot, self.p, self.q, order)

    def _height_by_both(self, i: int, j: int) -> list[MeanValueForm]:
        """``h_ij`` with one derivative, ``i ≤ j``."""
        if i == self.size - 1:
            return [-_product(dot, self.p, self.q, m) for m in range(2)]
        return [_product(dot, self.moved[i], self._along(j), m) for m in range(2)]

    def _twist_by(self, i: int) -> list[MeanValueForm]:
        """``Im(z̄ż)`` differentiated by a coordinate, with one derivative."""
        one, other = self._by(i)
        return [cross(one[0], other[m + 1]) + cross(other[0], one[m + 1]) for m in range(2)]

    def _twist_by_both(self, i: int, j: int) -> MeanValueForm:
        """The same by two coordinates, ``i ≤ j``."""
        if i == self.size - 1:
            return -cross(self.p[0], self.q[1]) - cross(self.q[0], self.p[1])
        one, other = self.moved[i], self._along(j)
        return cross(one[0], other[1]) + cross(other[0], one[1])

    def totals(self) -> tuple[Squares, Squares, Squares]:
        """``F_;ij`` for the three coordinates at the wall."""
        z, coordinates = self.z, range(self.size)
        h = [NOTHING, *(self._height(m) for m in (1, 2, 3))]
        h_i = [[_product(dot, *self._by(i), m) for m in range(3)] for i in coordinates]
        b_i, late = [self._twist_by(i) for i in coordinates], [-x[0] / h[1] for x in h_i]
        b_t, b_tt = cross(z[0], z[2]), cross(z[1], z[2]) + cross(z[0], z[3])
        back = z[0].conjugate
        turns, drift = [back * self._along(i)[0] for i in coordinates], back * z[1]
        rates = [(back * self._along(i)[1] - turns[i] * drift).imag for i in coordinates]
        c_t, c_tt = 1 - drift.imag, (drift * drift - back * z[2]).imag
        found: tuple[Squares, Squares, Squares] = ({}, {}, {})
        for i, j in combinations_with_replacement(coordinates, 2):
            h_ij, s, t = self._height_by_both(i, j), late[i], late[j]
            later = -(h_ij[0] + h_i[i][1] * t + h_i[j][1] * s + h[2] * s * t) / h[1]
            found[0][i, j] = h_ij[1] + h_i[i][2] * t + h_i[j][2] * s + h[3] * s * t + h[2] * later
            found[1][i, j] = self._twist_by_both(i, j) + b_i[i][1] * t + b_i[j][1] * s + b_tt * s * t + b_t * later
            bend = (turns[i] * turns[j]).imag
            if i == self.size - 1:
                bend = bend + (back * self.q[0]).imag
            found[2][i, j] = bend - rates[i] * t - rates[j] * s + c_tt * s * t + c_t * later
        return found


def _turning(angle: MeanValueForm) -> Pair:
    """``e^{iα}``."""
    (sine, cosine), (every_sine, every_cosine) = angle.at.sin_cos(), angle.every.sin_cos()
    return Pair(
        angle.through(cosine, every_cosine, -every_sine),
        angle.through(sine, every_sine, every_cosine),
    )


def _responses(departure: PatchDeparture, time: MeanValueForm, orders: int) -> tuple[list[Pair], list[Pair]]:
    """``c`` and ``h₁``, or what stands for it, with their derivatives."""
    held = departure.held

    def of(moment: arb) -> tuple[Response, Response]:
        if departure.from_wall:
            return held.responses(moment)
        return (arb(0),) * 3, held.start.response(held, moment)

    both = []
    for at, every in zip(of(time.at), of(time.every), strict=True):
        first, jets = _freely(held, at, orders), _freely(held, every, orders + 1)
        both.append([_through(time, first[m], jets[m], jets[m + 1]) for m in range(orders)])
    return both[0], both[1]


def _freely(held: Held, jet: Response, orders: int) -> list[Any]:
    """More derivatives of a free motion."""
    found, n = list(jet), held.numbers
    while len(found) < orders:
        found.append(-n.gamma * found[-1] - n.omega_squared * found[-2])
    return found


def _through(time: MeanValueForm, at: arb, every: arb, slope: arb) -> Pair:
    """A real or complex function of time."""
    if isinstance(at, arb):
        return Pair(time.through(at, every, slope), NOTHING)
    return Pair(time.through(at.real, every.real, slope.real), time.through(at.imag, every.imag, slope.imag))


def _product(product: Callable[[Pair, Pair], MeanValueForm], one: Jet, other: Jet, order: int) -> MeanValueForm:
    """A derivative of a bilinear product."""
    total = product(one[0], other[order])
    for m in range(1, order + 1):
        total = total + product(one[m], other[order - m]) * comb(order, m)
    return total
