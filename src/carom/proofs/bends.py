"""Second derivatives of the state at which flights reach the wall, by the coordinates of the state in which they begin.

With ``h = |z|²/2``, the crossing time ``t(x)`` has ``h(x, t(x)) = 1/2``, so that with indices for partial derivatives

    t_i = −h_i/h_t,      t_ij = −(h_ij + h_it t_j + h_jt t_i + h_tt t_i t_j)/h_t,
    F_;ij = F_ij + F_it t_j + F_jt t_i + F_tt t_i t_j + F_t t_ij

for ``F = a, b, ψ⁺``: ``Re(z̄ż)``, ``Im(z̄ż)`` and ``ψ + t − arg z``.  ``z = p + q`` as in :class:`~carom.proofs.patches.Moment`: along a velocity ``w``
``p`` changes by ``w h₁``, along ``ψ`` ``q`` by ``iq``, and nothing depends on ``ψ`` but products of ``p`` and ``q``.  Where ``|z| = 1``,
``(arg z)_αβ = Im(z̄z_αβ − z̄z_α z̄z_β)``.

Free motion has ``p''' = −γp'' − ω²p'`` and, with ``k = e^{it}`` less free motion, ``k''' = −γk'' − ω²k' + iP e^{it}``.
"""

from __future__ import annotations

from itertools import combinations_with_replacement
from math import comb
from typing import Any

from flint import acb, arb

from carom.proofs.patches import Moment, cross, dot
from carom.proofs.series import I

Jet = list[Any]
"""A function of time with its derivatives."""
Squares = dict[tuple[int, int], Any]
"""Second derivatives by pairs of coordinates, the first index the smaller."""


def second_derivatives(moment: Moment, turn: Any) -> tuple[Squares, Squares, Squares]:
    """Those of ``a``, ``b`` and ``ψ⁺`` for all flights and times of a moment, with ``e^{it}`` at these times."""
    return _Bends(moment, turn).totals()


def remainders(columns: list[list[Any]], main: int, squares: Squares) -> Any:
    """Bound of the second-order term of a mean value form: half the sum of ``|s_g' F s_h|`` over all pairs of columns.

    For the columns after the first ``main`` ones the sums of their moduli are taken.
    """
    total: Any = arb(0)
    for j, one in enumerate(columns[:main]):
        for k, other in enumerate(columns[: j + 1]):
            term: Any = arb(0)
            for (m, n), value in squares.items():
                both = one[m] * other[n] if m == n else one[m] * other[n] + one[n] * other[m]
                term = term + value * both
            total = total + (abs(term) / 2 if j == k else abs(term))
    size = len(columns[0])
    few = [_sum(column[m] for column in columns[:main]) for m in range(size)]
    all_ = [_sum(column[m] for column in columns) for m in range(size)]
    for (m, n), value in squares.items():
        left = all_[m] * all_[n] - few[m] * few[n]
        total = total + abs(value) * (left / 2 if m == n else left)
    return total.upper()


def _sum(numbers: Any) -> Any:
    total: Any = arb(0)
    for number in numbers:
        total = total + abs(number)
    return total


class _Bends:
    """The partial derivatives that are needed, ``t`` being the coordinate after the last one."""

    def __init__(self, moment: Moment, turn: Any) -> None:
        departure = moment.departure
        held, n = departure.held, departure.held.numbers
        p, q, k = moment.parts
        self.p = [*p, -n.gamma * p[2] - n.omega_squared * p[1]]
        k3 = -n.gamma * k[2] - n.omega_squared * k[1] + I * n.product * turn
        self.q = [*q, departure.wide_levitation * k3]
        self.k, self.ell = [*k, k3], held.radius_squared
        self.z = [one + other for one, other in zip(self.p, self.q, strict=True)]
        self.h = [wave[1] for wave in moment.waves]
        self.size = len(departure.patch.centre)
        speeds = (acb(1), I)[: self.size - 1]
        self.moved = [[w * x for x in self.h] for w in speeds]
        self.turned = [I * x for x in self.q]

    def _along(self, i: int) -> Jet:
        """``z`` differentiated by a coordinate."""
        return self.moved[i] if i < self.size - 1 else self.turned

    def height(self) -> Jet:
        """``h`` with three derivatives."""
        return [_product(dot, self.p, self.p, m) / 2 + _product(dot, self.p, self.q, m) + self.ell * _product(dot, self.k, self.k, m) / 2 for m in range(4)]

    def height_by(self, i: int) -> Jet:
        """``h_i`` with two derivatives."""
        one, other = (self.moved[i], self.z) if i < self.size - 1 else (self.turned, self.p)
        return [_product(dot, one, other, m) for m in range(3)]

    def height_by_both(self, i: int, j: int) -> Jet:
        """``h_ij`` with one derivative, ``i ≤ j``."""
        if i == self.size - 1:
            return [-_product(dot, self.p, self.q, m) for m in range(2)]
        return [_product(dot, self.moved[i], self._along(j), m) for m in range(2)]

    def twist_by(self, i: int) -> Jet:
        """``Im(z̄ż)`` differentiated by a coordinate, with one derivative."""
        one, other = (self.moved[i], self.z) if i < self.size - 1 else (self.turned, self.p)
        return [cross(one[0], other[1]) + cross(other[0], one[1]), cross(one[0], other[2]) + cross(other[0], one[2])]

    def twist_by_both(self, i: int, j: int) -> Any:
        """The same by two coordinates, ``i ≤ j``."""
        if i == self.size - 1:
            return -cross(self.p[0], self.q[1]) - cross(self.q[0], self.p[1])
        one, other = self.moved[i], self._along(j)
        return cross(one[0], other[1]) + cross(other[0], one[1])

    def totals(self) -> tuple[Squares, Squares, Squares]:
        """``F_;ij`` for the three coordinates at the wall."""
        z, h = self.z, self.height()
        coordinates = range(self.size)
        h_i, b_i = [self.height_by(i) for i in coordinates], [self.twist_by(i) for i in coordinates]
        late = [-x[0] / h[1] for x in h_i]
        b_t, b_tt = cross(z[0], z[2]), cross(z[1], z[2]) + cross(z[0], z[3])
        back = acb(z[0].real, -z[0].imag)
        turns = [back * self._along(i)[0] for i in coordinates]
        rates = [(back * self._along(i)[1] - turns[i] * back * z[1]).imag for i in coordinates]
        c_t, c_tt = 1 - cross(z[0], z[1]), -(back * z[2] - (back * z[1]) ** 2).imag
        found: tuple[Squares, Squares, Squares] = ({}, {}, {})
        for i, j in combinations_with_replacement(coordinates, 2):
            h_ij, s, t = self.height_by_both(i, j), late[i], late[j]
            later = -(h_ij[0] + h_i[i][1] * t + h_i[j][1] * s + h[2] * s * t) / h[1]
            found[0][i, j] = h_ij[1] + h_i[i][2] * t + h_i[j][2] * s + h[3] * s * t + h[2] * later
            found[1][i, j] = self.twist_by_both(i, j) + b_i[i][1] * t + b_i[j][1] * s + b_tt * s * t + b_t * later
            bend = (back * -self.q[0] if i == self.size - 1 else arb(0)) - turns[i] * turns[j]
            found[2][i, j] = -bend.imag - rates[i] * t - rates[j] * s + c_tt * s * t + c_t * later
        return found


def _product(product: Any, one: Jet, other: Jet, order: int) -> Any:
    """A derivative of a bilinear product."""
    total: Any = arb(0)
    for m in range(order + 1):
        total = total + comb(order, m) * product(one[m], other[order - m])
    return total
