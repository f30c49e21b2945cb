#!/usr/bin/env python3
"""Check a certificate of ``carom prove`` with a program that shares nothing with carom.

    python check_certificate.py proof.json

It needs Python and python-flint only. It reads the hypotheses, computes the numbers of the equations from them, and decides every
claim again from its statement alone: it uses no evidence of the certificate, only the numbers claimed as starts of Newton's method.
One line is printed for each claim:

    checked        the claim is true
    not covered    this program says nothing about such a claim, or has tried only some values of a parameter, and none contradicts
    claims nothing the certificate leaves it open
    refused        it is false, is written in a way that is not known, is missing or there twice, or could not be confirmed

The exit code is 0 if every claim is checked or claims nothing, 1 if something is refused, and 3 if nothing is refused but claims are left that
are not covered; the last line says so.

How claims are decided. Time is in 1/Omega, length in clearances, and the frame turns with the shaft. Between impacts

    u'' + (gamma + 2i) u' + (omega^2 - 1 + i gamma) u = 0,  u = U - U*,  U* = rho e^(i phi) / (omega^2 - 1 + i gamma),

whose solutions are u = e^(-a t) [(C + a S) u0 + S v0], a = gamma/2 + i, C = cos wt, S = sin wt / w, w^2 = omega^2 - gamma^2/4. At |U| = 1
the radial speed r becomes -d r and the angular speed w becomes w - mu (1 + d) r while the slip s + 1 + w stays forward. Orbits are zeros of
"the flight after impact j ends before impact j + 1", four real equations for each impact, shown by Krawczyk's operator; the derivative of
the map of impacts follows from the same equations by the theorem of implicit functions. Stability is that of Routh and Hurwitz
after lambda = (1 + z)/(1 - z). |U| < 1 between impacts and the number of periods follow from Taylor polynomials with remainders on cells.
"""

from __future__ import annotations

import json
import re
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from flint import arb, arb_series, ctx, fmpq

BITS = 256
ORDER = 10  # of the Taylor polynomials on cells
MOST_CELLS = 20_000


class RefusedError(Exception):
    """A claim, or the whole certificate, is not accepted; the text says why."""


# ------------------------------------------------------------------------------------------- numbers of the hypotheses

PI_POWER = {"deg": 1, "°": 1, "rpm": 1, "r/min": 1, "rev/min": 1, "U/min": 1, "Hz": 1, "kHz": 1, "rev/s": 1}
_METRE = {
    "m": 1,
    "km": 10**3,
    "cm": "1e-2",
    "mm": "1e-3",
    "um": "1e-6",
    "µm": "1e-6",
    "μm": "1e-6",
    "nm": "1e-9",
    "in": "0.0254",
    "inch": "0.0254",
    "mil": "2.54e-5",
}
UNITS = {  # factor, and powers of kg, m, s
    **{name: (Fraction(size), (0, 1, 0)) for name, size in _METRE.items()},
    **{
        name: (Fraction(size), (1, 0, 0))
        for name, size in {"kg": 1, "g": "1e-3", "mg": "1e-6", "t": 1000, "lb": "0.45359237"}.items()
    },
    **{name: (Fraction(size), (0, 0, 1)) for name, size in {"s": 1, "ms": "1e-3", "us": "1e-6", "min": 60}.items()},
    **{name: (Fraction(size), (1, 1, -2)) for name, size in {"N": 1, "kN": 1000, "MN": 10**6, "mN": "1e-3"}.items()},
    **{name: (Fraction(size), (0, 0, 0)) for name, size in {"rad": 1, "mrad": "1e-3", "%": "1e-2"}.items()},
    **{name: (Fraction(1, 180), (0, 0, 0)) for name in ("deg", "°")},
    **{name: (Fraction(1, 30), (0, 0, -1)) for name in ("rpm", "r/min", "rev/min", "U/min")},
    **{name: (Fraction(size), (0, 0, -1)) for name, size in {"Hz": 2, "kHz": 2000, "rev/s": 2}.items()},
}
MACHINE = {  # SI unit of each entry of a [machine] table
    "mass": "kg", "damping": "N s/m", "stiffness": "N/m", "eccentricity": "m", "clearance": "m", "rotor_radius": "m",
    "speed": "rad/s", "unbalance_phase": "rad", "friction": "", "restitution": "",
}  # fmt: skip
DIMENSIONLESS = ("gamma", "omega", "rho", "phi", "mu", "d", "radius_ratio")


class Exact:
    """A rational number times a power of pi."""

    def __init__(self, rational: Fraction | int | str, power: int = 0) -> None:
        self.rational, self.power = Fraction(rational), power if rational else 0

    def __mul__(self, other: Exact) -> Exact:
        return Exact(self.rational * other.rational, self.power + other.power)

    def __truediv__(self, other: Exact) -> Exact:
        return Exact(self.rational / other.rational, self.power - other.power)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Exact) and (self.rational, self.power) == (other.rational, other.power)

    def __hash__(self) -> int:
        return hash((self.rational, self.power))

    def ball(self) -> arb:
        return ball(self.rational) * arb.pi() ** self.power

    @staticmethod
    def read(text: str) -> Exact:
        """From a text such as ``7500/1637 pi^-1``."""
        found = re.fullmatch(r"(-?\d+(?:/\d+)?)(?: pi\^(-?\d+)| (pi))?", text)
        if not found:
            raise RefusedError(f"no exact number: {text!r}")
        return Exact(Fraction(found[1]), int(found[2] or bool(found[3])))


def ball(value: Fraction | float | int) -> arb:
    value = Fraction(value)
    return arb(fmpq(value.numerator, value.denominator))


def decimal_of(text: str) -> Fraction:
    """A rational or decimal number with spaces, apostrophes or commas between thousands."""
    plain = re.sub(
        r"[×x]10([⁺⁻⁰¹²³⁴-⁹]+)", lambda m: "e" + m[1].translate(str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")), text
    )
    plain = re.sub(r"(?<=\d)[  ’',](?=\d{3}(?!\d))", "", plain).strip()
    if not re.fullmatch(r"[+-]?(\d+/\d+|(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?)", plain):
        raise RefusedError(f"no number: {text!r}")
    return Fraction(plain)


def unit_of(text: str) -> tuple[Exact, tuple[int, ...]]:
    """Size in SI units and powers of kg, m and s of a product of units with one division at most."""
    if text in UNITS:
        return Exact(UNITS[text][0], PI_POWER.get(text, 0)), UNITS[text][1]
    size, powers = Exact(1), [0, 0, 0]
    upper, _, lower = text.partition("/")
    for part, sign in ((upper, 1), (lower, -1)):
        for token in re.split(r"[ ·*]+", part.strip("() ")):
            if token in ("", "1"):
                continue
            name, _, exponent = token.replace("²", "^2").partition("^")
            if name not in UNITS:
                raise RefusedError(f"the unit {token!r} is not known to this program")
            for _ in range(int(exponent or 1)):
                one = Exact(UNITS[name][0], PI_POWER.get(name, 0))
                size = size * one if sign > 0 else size / one
                powers = [p + sign * q for p, q in zip(powers, UNITS[name][1], strict=True)]
    return size, tuple(powers)


def quantity(text: str, unit: str) -> Exact:
    """A text of the hypotheses in the SI unit given."""
    if text.startswith("double "):
        return Exact(Fraction(float(text[7:])))
    found = re.fullmatch(r"\s*([+-]?[\d.][\d.,'’ / ]*(?:[eE][+-]?\d+|[×x]10[⁺⁻⁰¹²³⁴-⁹]+)?)\s*([^\d\s].*)?", text)
    if not found:
        raise RefusedError(f"no number with a unit: {text!r}")
    number, written = decimal_of(found[1]), found[2]
    if written is None:
        return Exact(number)
    size, powers = unit_of(written.strip())
    if powers != unit_of(unit)[1]:
        raise RefusedError(f"{text!r} is not in {unit or 'plain numbers'}")
    return Exact(number) * size


def si_values(hypotheses: dict) -> dict[str, Exact]:
    return {name: quantity(text, MACHINE[name]) for name, text in hypotheses["values"].items() if name in MACHINE}


def exact_numbers(hypotheses: dict) -> dict[str, Exact]:
    """The numbers of the equations, from the values and settings as they are written."""
    table, values, settings = hypotheses["table"], hypotheses["values"], hypotheses["settings"]
    wanted = {"machine": set(MACHINE), "dimensionless": set(DIMENSIONLESS)}.get(table)
    if (
        wanted is None
        or set(values) | {"unbalance_phase", "phi"} & wanted != wanted
        or not set(settings) <= set(DIMENSIONLESS)
    ):
        raise RefusedError("the table of hypotheses has entries missing, or some that are not known")
    if table == "machine":
        v = {"unbalance_phase": Exact(0), **si_values(hypotheses)}
        momentum = v["mass"] * v["speed"]
        found = {
            "gamma": v["damping"] / momentum,
            "omega_squared": v["stiffness"] / (momentum * v["speed"]),
            "rho": v["eccentricity"] / v["clearance"],
            "mu": v["friction"],
            "d": v["restitution"],
            "radius_ratio": v["rotor_radius"] / v["clearance"],
            "phi": v["unbalance_phase"],
        }
    else:
        found, settings = {"phi": Exact(0)}, {**values, **settings}
    for name, text in settings.items():
        value = quantity(text, "rad" if name == "phi" else "")
        found["omega_squared" if name == "omega" else name] = value * value if name == "omega" else value
    return found


# ------------------------------------------------------------------------------------------------- complex arithmetic


class Z:
    """A complex number whose parts are balls or power series of balls."""

    __slots__ = ("im", "re")

    def __init__(self, re, im=0) -> None:
        self.re, self.im = re, im

    def __add__(self, o):
        return Z(self.re + o.re, self.im + o.im) if isinstance(o, Z) else Z(self.re + o, self.im)

    def __sub__(self, o):
        return Z(self.re - o.re, self.im - o.im) if isinstance(o, Z) else Z(self.re - o, self.im)

    def __neg__(self):
        return Z(-self.re, -self.im)

    def __mul__(self, o):
        if isinstance(o, Z):
            return Z(self.re * o.re - self.im * o.im, self.re * o.im + self.im * o.re)
        return Z(self.re * o, self.im * o)

    def __truediv__(self, o):
        if isinstance(o, Z):
            size = o.norm()
            return Z((self.re * o.re + self.im * o.im) / size, (self.im * o.re - self.re * o.im) / size)
        return Z(self.re / o, self.im / o)

    def norm(self):
        return self.re * self.re + self.im * self.im

    def conj(self):
        return Z(self.re, -self.im)

    def turned(self):
        """Times i."""
        return Z(-self.im, self.re)


def turn(angle):
    return Z(angle.cos(), angle.sin())


def constant(x):
    """The term of order zero, a ball."""
    return x[0] if isinstance(x, arb_series) else x


def term(x, order: int) -> arb:
    return x[order] if isinstance(x, arb_series) else x if order == 0 else arb(0)


def surely_zero(x) -> bool:
    return constant(x).is_zero() and (not isinstance(x, arb_series) or all(c == 0 for c in x.coeffs()))


# ------------------------------------------------------------------------------------------------------------- machine


class Machine:
    """The numbers of the equations: balls, or power series in a parameter."""

    def __init__(self, gamma, omega_squared, rho, mu, d, radius_ratio, phi=None) -> None:
        self.gamma, self.omega2, self.rho, self.mu, self.d, self.s = gamma, omega_squared, rho, mu, d, radius_ratio
        self.a = Z(gamma / 2, arb(1))
        self.b = Z(omega_squared - 1, gamma)
        self.q = Z(1 + d, mu * (1 + d))
        self.w2 = omega_squared - gamma * gamma / 4
        self.far2 = rho * rho / self.b.norm()  # |U*|^2

    @staticmethod
    def of(exact: dict[str, Exact]) -> Machine:
        machine = Machine(**{name: value.ball() for name, value in exact.items()})
        if (
            4 * exact["omega_squared"].rational == exact["gamma"].rational ** 2
            and 2 * exact["gamma"].power == exact["omega_squared"].power
        ):
            machine.w2 = arb(0)
        return machine

    def waves(self, t):
        """e^(-a t), C and S."""
        shrink = (-(self.a.re * t)).exp()
        swing = Z(t.cos() * shrink, -(t.sin() * shrink))
        if surely_zero(self.w2):
            return swing, 0 * t + 1, t
        if constant(self.w2) > 0:
            w = self.w2.sqrt()
            return swing, (w * t).cos(), (w * t).sin() / w
        if not constant(self.w2) < 0:
            raise RefusedError("could not be shown: too close to critical damping")
        k = (-self.w2).sqrt()
        grow, fall = (k * t).exp(), (-(k * t)).exp()
        return swing, (grow + fall) / 2, (grow - fall) / (2 * k)

    def fly(self, u: Z, v: Z, t) -> tuple[Z, Z]:
        """Deviation from U* and velocity after the time t."""
        e, c, s = self.waves(t)
        return e * ((self.a * s + c) * u + v * s), e * ((-(self.a * s) + c) * v - self.b * s * u)

    def closing(self, t) -> tuple[Z, Z, Z]:
        """det(1 - M), and the numerators of the levers a12 and a22, where M is the flight of length t."""
        e, c, s = self.waves(t)
        return -(e * c * 2) + e * e + 1, e * s, e * (-(self.a * s) + c) - e * e

    def period_function(self, t):
        """|det(1 - M)|^2 F1, which is entire in t."""
        det, _, a22 = self.closing(t)
        return det.norm() + (self.q * a22 * det.conj()).re

    def levers(self, t) -> tuple[Z, Z]:
        det, a12, a22 = self.closing(t)
        return self.q * a12 / det, self.q * a22 / det


# -------------------------------------------------------------------------------------------------- zeros of equations


def series(*coefficients) -> arb_series:
    return arb_series(list(coefficients))


def middle(x: arb) -> arb:
    return x.mid()


def spread(x: arb, radius: arb) -> arb:
    return x + arb(0, radius)


def solve(matrix: list[list], right: list[list]) -> list[list]:
    """X of matrix X = right by Gauss, of balls or series."""
    size, rows = len(matrix), [[*row, *more] for row, more in zip(matrix, right, strict=True)]
    for k in range(size):
        best = max(range(k, size), key=lambda i: float(abs(constant(rows[i][k]).mid())))
        rows[k], rows[best] = rows[best], rows[k]
        if constant(rows[k][k]).contains(0):
            raise RefusedError("could not be shown: equations that cannot be solved")
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(size):
            if i != k:
                factor = rows[i][k]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    return [row[size:] for row in rows]


def identity(size: int) -> list[list]:
    return [[arb(int(i == j)) for j in range(size)] for i in range(size)]


def product(a: list[list], b: list[list]) -> list[list]:
    return [
        [sum((x * y for x, y in zip(row, column, strict=True)), arb(0)) for column in zip(*b, strict=True)] for row in a
    ]


def krawczyk(system, start: list[arb], radius: str = "1e-25") -> list[arb]:
    """The zero next to `start`, enclosed, the only one in a box; `system` gives residuals and their derivative."""
    x = [middle(v) for v in start]
    for _ in range(60):
        residual, slope = system(x)
        step = solve([[middle(v) for v in row] for row in slope], [[middle(v)] for v in residual])
        x = [middle(v - s[0]) for v, s in zip(x, step, strict=True)]
        if not all(v.is_finite() for v in x):
            break
        if all(abs(s[0]) < arb("1e-60") * (1 + abs(v)) for v, s in zip(x, step, strict=True)):
            break
    else:
        raise RefusedError("could not be shown: Newton's method finds no solution next to the numbers claimed")
    box = [spread(v, arb(radius)) for v in x]
    residual, slope = system(x)
    guess = [[middle(v) for v in row] for row in solve([[middle(v) for v in row] for row in slope], identity(len(x)))]
    centre = [v - s[0] for v, s in zip(x, product(guess, [[r] for r in residual]), strict=True)]
    proven = False
    for _ in range(4):
        rest = product(guess, system(box)[1])
        rest = [[(int(i == j)) - v for j, v in enumerate(row)] for i, row in enumerate(rest)]
        image = [
            c + m[0] for c, m in zip(centre, product(rest, [[b - v] for b, v in zip(box, x, strict=True)]), strict=True)
        ]
        if not proven and not all(b.contains_interior(i) for b, i in zip(box, image, strict=True)):
            raise RefusedError("could not be shown: Krawczyk's operator does not shrink the box")
        proven, box = True, [i.intersection(b) for i, b in zip(image, box, strict=True)]
    return box


# ---------------------------------------------------------------------------------------------------- motions and maps


class Orbit:
    """A cycle of states before the impacts: (angle, radial speed, angular speed, time to the next impact) of each.

    Angles are counted from that of the contact-free equilibrium, which lies at |U*|.
    """

    def __init__(self, machine: Machine, states: list[tuple]) -> None:
        self.machine, self.far = machine, machine.far2.sqrt()
        start = [v for state in states for v in state]
        found = krawczyk(self.equations, start)
        self.states = [tuple(found[k : k + 4]) for k in range(0, len(found), 4)]

    def leave(self, state) -> tuple[Z, Z]:
        """Deviation and velocity after the impact, with forward slip."""
        m, place = self.machine, turn(state[0])
        return place - self.far, place * Z(-(m.d * state[1]), state[2] - m.mu * (1 + m.d) * state[1])

    def equations(self, x: list) -> tuple[list, list]:
        count = len(x) // 4
        states, residual, slope = [tuple(x[4 * k : 4 * k + 4]) for k in range(count)], [], []
        for k, state in enumerate(states):
            follow = states[(k + 1) % count]
            gap, own, end = segment(self.machine, self.far, state, follow)
            residual += gap
            for i in range(4):
                row = [arb(0)] * (4 * count)
                for j in range(4):
                    row[4 * k + j] += own[i][j]
                    row[4 * ((k + 1) % count) + j] += end[i][j] if j < 3 else 0
                slope.append(row)
        return residual, slope

    def derivative(self) -> list[list]:
        """Of the map over a period, in angle, radial and angular speed before an impact."""
        total = identity(3)
        for k, state in enumerate(self.states):
            total = product(
                impact_derivative(self.machine, self.far, state, self.states[(k + 1) % len(self.states)]), total
            )
        return total

    def inside(self) -> bool | None:
        """Whether |U| < 1 strictly between the impacts."""
        ends = [self.states[(k + 1) % len(self.states)][1] for k in range(len(self.states))]
        verdicts = [
            stays_inside(self.machine, self.far, *self.leave(s), s[3], s[1], e)
            for s, e in zip(self.states, ends, strict=True)
        ]
        return every(verdicts)

    def outward(self) -> bool | None:
        return every([positive(state[1]) for state in self.states])

    def slips(self) -> list:
        """Slip velocities after the impacts."""
        m = self.machine
        return [m.s + 1 + state[2] - m.mu * (1 + m.d) * state[1] for state in self.states]

    def slip(self) -> bool | None:
        if surely_zero(self.machine.mu):
            return True
        before = [positive(self.machine.s + 1 + state[2]) for state in self.states]
        return every([*before, *(positive(v) for v in self.slips())])

    def admissible(self) -> bool | None:
        return every([self.outward(), self.inside() if self.outward() else None, self.slip()])


def positive(x: arb) -> bool | None:
    return True if x > 0 else False if x <= 0 else None


def every(verdicts: list) -> bool | None:
    return False if False in verdicts else None if None in verdicts else True


def segment(m: Machine, far, state, follow) -> tuple[list, list, list]:
    """Flight after `state` less `follow`, its derivative by `state` and time, and by angle and speeds of `follow`."""
    place, after = turn(state[0]), Z(-(m.d * state[1]), state[2] - m.mu * (1 + m.d) * state[1])
    u, v = place - far, place * after
    end_u, end_v = m.fly(u, v, state[3])
    there, speed = turn(follow[0]), Z(follow[1], follow[2])
    arrives = there * speed
    zero = Z(arb(0), arb(0))
    push = Z(m.a.re * 2, arb(2))
    own = [
        m.fly(place.turned(), v.turned(), state[3]),
        m.fly(zero, place * Z(-m.d, -(m.mu * (1 + m.d))), state[3]),
        m.fly(zero, place.turned(), state[3]),
        (end_v, -(push * end_v) - m.b * end_u),
    ]
    end = [(-there.turned(), -arrives.turned()), (zero, -there), (zero, -there.turned())]

    def rows(columns):
        return [list(row) for row in zip(*[(p.re, p.im, w.re, w.im) for p, w in columns], strict=True)]

    gap_u, gap_v = end_u + far - there, end_v - arrives
    return [gap_u.re, gap_u.im, gap_v.re, gap_v.im], rows(own), rows(end)


def impact_derivative(m: Machine, far, state, follow) -> list[list]:
    """Of the next (angle, radial speed, angular speed) by those of `state`; the time follows by the equations."""
    _, own, end = segment(m, far, state, follow)
    unknown = [[*row, own[i][3]] for i, row in enumerate(end)]
    found = solve(unknown, [[-v for v in row[:3]] for row in own])
    return found[:3]


def invariants(j: list[list]) -> tuple:
    """Trace, sum of the principal minors, determinant."""
    trace = j[0][0] + j[1][1] + j[2][2]
    minors = sum((j[a][a] * j[b][b] - j[a][b] * j[b][a] for a, b in ((0, 1), (0, 2), (1, 2))), arb(0))
    det = sum(
        (j[0][a] * (j[1][b] * j[2][c] - j[1][c] * j[2][b]) for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1))), arb(0)
    )
    return trace, minors, det


def multipliers(trace, minors, det) -> tuple[bool | None, set[str]]:
    """Whether all lie inside the unit circle, and what is true of those that do not.

    With lambda = (1 + z)/(1 - z) the characteristic polynomial becomes a cubic in z; all its zeros have a negative real
    part exactly if its coefficients and one product of them are positive.
    """
    at_one, at_minus = 1 - trace + minors - det, 1 + trace + minors + det
    first, second = 3 - trace - minors + 3 * det, 3 + trace - minors - 3 * det
    pairs = first * second - at_one * at_minus  # 8 times the product of 1 - l_j l_k
    true = {
        word
        for word, value in (
            ("a multiplier is above 1", at_one),
            ("a multiplier is below -1", at_minus),
            ("the product of two multipliers is above 1", pairs),
        )
        if value < 0
    }
    if true or ((first < 0 or second < 0) and at_minus > 0):
        return False, true
    return (True if all(v > 0 for v in (at_one, at_minus, first, second, pairs)) else None), true


def horner(coefficients: list, x):
    total = arb(0)
    for c in reversed(coefficients):
        total = total * x + c
    return total


def taylor(function, about: arb, half: arb, cell: arb | None = None) -> list:
    """Coefficients of a series about a point whose last one holds on a cell, by default all points within `half` of it."""
    ctx.cap = ORDER + 1
    narrow, wide = function(about), function((about if cell is None else cell) + arb(0, half))
    return [*[narrow[k] for k in range(ORDER)], wide[ORDER]]


def stays_inside(m: Machine, far, u: Z, v: Z, duration, leaves, arrives) -> bool | None:
    """Whether |U| < 1 strictly between two impacts of radial speeds `leaves` before the first and `arrives` before the last."""
    if arrives < 0 or (leaves < 0 and not surely_zero(m.d)):
        return False
    if not (arrives > 0 and leaves > 0):
        return None

    def height(part):  # as a series in the share of the duration
        place, _ = m.fly(u, v, series(duration * part, duration))
        return (place + far).norm() - 1

    return below(height, 2 if surely_zero(m.d) else 1)


def below(height, first: int = 1, touch: tuple[Fraction, Fraction] | None = None) -> bool | None:
    """Whether a function is negative on (0, 1) that has a zero of the order `first` at 0 and a simple one at 1.

    `touch` is an interval that is left out.
    """
    edges = []
    for at, sign, skip in ((0, 1, first), (1, -1, 1)):
        edge = Fraction(1, 8)
        while True:
            half = ball(edge) / 2
            terms = taylor(height, arb(at), half, at + sign * half)
            signed = [c * sign**k for k, c in enumerate(terms)][skip:]
            if horner(signed, half + arb(0, half)) < 0:
                break
            if signed[0] > 0:
                return False
            edge /= 2
            if edge < Fraction(1, 2**60):
                return None
        edges.append(edge)
    low, high = edges[0], 1 - edges[1]
    stack, work = [(low, high)] if touch is None else [(low, touch[0]), (touch[1], high)], 0
    while stack:
        low, high = stack.pop(0)
        work += 1
        half = ball(high - low) / 2
        terms = taylor(height, ball(low + high) / 2, half)
        if horner(terms, arb(0, half)) < 0:
            continue
        if terms[0] > 0:
            return False
        if work > 3000 or high - low < Fraction(1, 2**70):
            return None
        cut = (low + high) / 2
        stack += [(low, cut), (cut, high)]
    return True


# ------------------------------------------------------------------------------------------------- periods and completeness


def longest_period(m: Machine) -> Fraction:
    """A time beyond which F1 > 0.

    The slower of the two exponents decays with the rate k. |S e^(-at)| <= t e^(-kt), which falls beyond 1/k, and
    |C e^(-at)| <= e^(-kt); |det(1 - M)| >= (1 - e^(-kt))^2.
    """
    half = m.a.re
    rate = half if surely_zero(m.w2) or m.w2 > 0 else half - (-m.w2).sqrt()
    if not rate > 0:
        raise RefusedError("not covered: without damping there is no longest period")
    size, kick, t = m.a.norm().sqrt(), m.q.norm().sqrt(), Fraction(8)
    while True:
        fall = (-(rate * ball(t))).exp()
        bound = kick * (fall * (1 + size * ball(t)) + fall * fall) / ((1 - fall) * (1 - fall))
        if rate * ball(t) > 1 and bound < 1:
            return t
        t = t * 5 / 4
        t = Fraction(int(t) + 1)
        if t > 10**6:
            raise RefusedError("could not be shown: damping too weak")


def first_period(m: Machine) -> Fraction:
    """A time up to which F1 has no zero.

    det(1 - M) = b t^2 + ..., and the numerator of a22 is -b t^2/2 + ...: the terms of |det|^2 F1 below t^4 vanish, and that of t^4 is
    |b|^2 (1 - d)/2.
    """
    skip, edge = 5 if surely_zero(m.d - 1) else 4, Fraction(1, 4)
    while edge > Fraction(1, 2**40):
        half = ball(edge) / 2
        terms = taylor(lambda t: m.period_function(series(t, arb(1))), arb(0), half, half)
        value = horner(terms[skip:], half + arb(0, half))
        if value > 0 or value < 0:
            return edge
        edge /= 2
    raise RefusedError("could not be shown: periods next to zero")


def isolated(
    m: Machine, wide: Machine | None = None, by=None, budget: int = MOST_CELLS
) -> list[tuple[Fraction, Fraction, int]]:
    """Intervals that hold one T > 0 with F1(T) = 0 each, simple, and the sign of its slope; outside them there is none.

    With `wide`, balls that hold the numbers of many machines, it is shown for all of them; `by` gives bounds on a cell of T of
    what the function and its slope change by beside those of `m`.
    """

    def function(t, of=m):
        return of.period_function(series(t, arb(1)))

    every_machine = wide or m
    end = longest_period(every_machine)
    open_cells, stack, work = [], [(first_period(every_machine), end)], 0
    while stack:
        low, high = stack.pop()
        if high - low < 4:
            half, work = ball(high - low) / 2, work + 1
            if work > budget or high - low < Fraction(1, 2**60):
                raise RefusedError(
                    "could not be shown: a double zero of F1, one that is nearly double, or too many cells"
                )
            terms = taylor(function, ball(low + high) / 2, half)
            value = horner(terms, arb(0, half))
            if value.contains(0) is False and by:
                value += by(ball(low + high) / 2 + arb(0, half), 0)
            if value > 0 or value < 0:
                continue
            # The last coefficient bounds f^(n)/n!, so the remainder of the slope is n times it, as here.
            slope = horner([k * c for k, c in enumerate(terms)][1:], arb(0, half))
            if slope.contains(0) is False and by:
                slope += by(ball(low + high) / 2 + arb(0, half), 1)
            if slope > 0 or slope < 0:
                open_cells.append([low, high, 1 if slope > 0 else -1])
                continue
        cut = low + (high - low) * Fraction(61, 128)
        stack += [(cut, high), (low, cut)]
    found = []
    for low, high, sign in joined(open_cells):
        ctx.cap = 2
        ends = [function(ball(at))[0] + (by(ball(at), 0) if by else 0) for at in (low, high)]
        signs = [positive(value) for value in ends]
        if None in signs:
            raise RefusedError("could not be shown: a zero of F1 next to the border of a cell")
        if signs[0] != signs[1]:
            found.append((low, high, sign))
    return found


def joined(cells_of_slopes: list[list]) -> list[list]:
    """Neighbours of one slope as one cell."""
    groups: list[list] = []
    for low, high, sign in cells_of_slopes:
        if groups and groups[-1][1] == low:
            if groups[-1][2] != sign:
                raise RefusedError("could not be shown: the slope of F1 between two cells")
            groups[-1][1] = high
        else:
            groups.append([low, high, sign])
    return groups


def root(m: Machine, low: Fraction, high: Fraction, sign: int) -> arb:
    """The zero of F1 in an interval that holds one."""

    def equation(x):
        ctx.cap = 2
        value = m.period_function(series(x[0], arb(1)))
        return [value[0]], [[value[1]]]

    a, b = low, high
    for _ in range(12):
        cut = (a + b) / 2
        value = equation([ball(cut)])[0][0]
        if not (value > 0 or value < 0):
            break
        a, b = (a, cut) if (value > 0) == (sign > 0) else (cut, b)
    found = krawczyk(equation, [ball((a + b) / 2)])[0]
    if not (found > ball(low) and found < ball(high)):
        raise RefusedError("could not be shown: a zero of F1")
    return found


def start_of(m: Machine, period, speed) -> tuple:
    """State of the orbit with one impact of this period and radial speed."""
    a12, a22 = m.levers(period)
    lean = a12 * speed + 1  # U*/U0
    angle = -arb.atan2(lean.im, lean.re)
    return angle, speed, -(a22.im * speed), period


def single_orbits(m: Machine) -> dict[str, Orbit | None]:
    """All solutions of the closing conditions by their names; none where the radial speeds of a period are not real."""
    found, number = {}, 0
    for low, high, sign in isolated(m):
        period = root(m, low, high, sign)
        number += sign < 0 or not number  # F1 falls at the shorter period of a pair and rises at the longer one
        names = "ac" if sign < 0 else "bd"
        a12, _ = m.levers(period)
        a, b, c = a12.norm(), a12.re, 1 - m.far2
        inner = b * b - a * c
        if inner < 0:
            found[f"B{number},{names[0]}/{names[1]}"] = None
            continue
        if not (inner > 0 and a > 0):
            raise RefusedError("could not be shown: radial speeds of a period that are nearly one")
        for name, sign_of in zip(names, (-1, 1), strict=True):
            orbit = Orbit(m, [start_of(m, period, (-b + sign_of * inner.sqrt()) / a)])
            if not orbit.states[0][3].overlaps(period):
                raise RefusedError("could not be shown: an orbit by two ways")
            found[f"B{number},{name}"] = orbit
    return found


def slip_stays_forward(m: Machine) -> bool | None:
    """Whether no motion with one impact a period can leave it with the slip stopped or backward.

    In the fixed frame let the impact be at z = 1. After it y = Im z starts at 0 with a speed of -s or less, and while |z| < 1
    y'' + gamma y' is below F = omega^2 + rho. So y < -h, h = s (1 - e^(-gamma t))/gamma - F (t - (1 - e^(-gamma t))/gamma)/gamma, which is
    concave. Once h > 1 the rotor is out. A period T before that, T < pi, would end at y = sin T > 0: no.
    """
    force = m.omega2 + m.rho
    for k in range(1, 400):
        t = ball(Fraction(k, 128))
        if m.gamma > 0:
            fall = (1 - (-(m.gamma * t)).exp()) / m.gamma
            depth = m.s * fall - force * (t - fall) / m.gamma
        else:
            depth = m.s * t - force * t * t / 2
        if depth > 1 and m.gamma >= 0:
            return True
    return None


# --------------------------------------------------------------------------------------------- claims about one machine

SINGLE = {  # kind: statement
    "solution": "The closing conditions of an orbit with one impact a period and forward slip have a solution with a period and a radial speed "
    "in these intervals; it is simple, so no other is next to it.",
    "outward": "Its radial speed before the impact is positive: it meets the wall from inside.",
    "inside": "It stays inside the wall, |U| < 1, strictly between its impacts.",
    "slip": "Its slip is forward before the impact and after it, or there is no friction.",
    "admissible": "It is a motion of the machine: it meets the wall from inside, stays inside between its impacts, and its slip stays forward.",
    "stable": "All three multipliers of the impact map at it lie inside the unit circle.",
}
SEVERAL = {
    "exists": r"The closing conditions of a motion with (\d+) impacts a period and forward slip have a solution with these values, the only one in a "
    r"box around it, and it is no shorter orbit run several times\. Angles count from that of the contact-free equilibrium\.",
    "admissible": r"It is a motion of the machine: it stays inside the wall strictly between its impacts, and its slip stays forward\.",
    "stable": r"All three multipliers of the map over a period lie inside the unit circle\.",
}
OUT, CROSSES, STOPS = (
    "its radial speed is not above 0",
    "it would cross the wall between its impacts",
    "friction would stop its slip, or its slip is backward",
)


class Fact:
    """What this program finds: the statement it decides, whether it is true, numbers, and reasons that may stand beside a refusal."""

    def __init__(self, statement: str, true: bool | None, numbers: dict | None = None, reasons=()) -> None:
        self.statement, self.true, self.numbers, self.reasons = statement, true, numbers or {}, set(reasons)


def levitation_facts(m: Machine) -> dict:
    far, inside, damped = m.far2.sqrt(), positive(1 - m.far2), positive(m.gamma)
    true = every([inside, damped if damped else (True if surely_zero(m.gamma) else False if m.gamma < 0 else None)])
    numbers = {}
    if true:
        # A kick of size v moves the rotor by v S(t) e^(-gamma t/2) along its line, most where the derivative C - gamma S/2 first vanishes.
        half = m.gamma / 2
        if surely_zero(m.w2):
            t = 1 / half
        elif m.w2 > 0:
            t = arb.atan2(m.w2.sqrt(), half) / m.w2.sqrt()
        else:
            t = ((-m.w2).sqrt() / half).atanh() / (-m.w2).sqrt()
        numbers["speed"] = (1 - far) / (m.waves(t)[2] * (-(half * t)).exp())
    return {
        ("levitation", "inside"): Fact("The contact-free equilibrium lies inside the wall, |U*| < 1.", inside, {"radius": far}, {"it lies outside the wall"}),
        ("levitation", "stable"): Fact("Contact-free motions decay to the contact-free equilibrium.", damped, {}, {"the damping is not above 0"}),
        ("kick", "harmless"): Fact(
            "The rotor levitates inside the wall, and no kick out of levitation slower than the lower number brings it to the wall.",
            true, numbers, {"it does not levitate inside the wall, or any kick grows"},
        ),
    }  # fmt: skip


def rub_facts(m: Machine) -> dict:
    """Rubs at rest on the wall: N = rho cos x + 1 - omega^2 and 0 = gamma + rho sin x + mu N.

    Without x this is (1 + mu^2) N^2 - 2 (k - mu gamma) N + k^2 + gamma^2 - rho^2 = 0, k = 1 - omega^2. Along the wall disturbances obey
    x'' + (gamma + 2 mu) x' + rho (cos x - mu sin x) x = 0, the last factor being (1 + mu^2) N - k + mu gamma.
    """
    k, square = 1 - m.omega2, 1 + m.mu * m.mu
    middle_force = k - m.mu * m.gamma
    inner = middle_force * middle_force - square * (k * k + m.gamma * m.gamma - m.rho * m.rho)
    exists, found = positive(inner), {}
    for rub, words, sign in (("rub 1", "larger", 1), ("rub 2", "smaller", -1)):
        found[rub, "solution"] = Fact(
            f"The balance of forces of a synchronous rub has two solutions; this is the one with the {words} normal force.",
            exists, {}, {"no rub is in balance, or both are one"},
        )  # fmt: skip
        if not exists:
            continue
        force = (middle_force + sign * inner.sqrt()) / square
        pressed, damped = positive(force), positive(m.gamma + 2 * m.mu)
        reasons = {"it is a saddle along the wall"} if sign < 0 else set()
        if not (pressed and damped):
            reasons.add("it is not pressed on the wall, or sliding is not damped")
        found[rub, "pressed"] = Fact(
            "The wall pushes the rotor there: its normal force is positive.",
            pressed, {"normal_force": force}, {"the wall would have to pull, or does not push"},
        )  # fmt: skip
        found[rub, "attracts sliding"] = Fact(
            "It is a motion of the machine, and small vibrations along the wall decay.",
            every([pressed, damped, sign > 0]),
            {},
            reasons,
        )
    return found


def orbit_facts(name: str, orbit: Orbit) -> dict:
    """Of an orbit with one impact a period."""
    state = orbit.states[0]
    trace, minors, det = invariants(orbit.derivative())
    stable, why = multipliers(trace, minors, det)
    outward, slip = orbit.outward(), orbit.slip()
    inside = orbit.inside()
    failing = [
        word
        for word, verdict in ((OUT, outward), (CROSSES, inside if outward else None), (STOPS, slip))
        if verdict is False
    ]
    truths = {
        "solution": (True, {"period": state[3], "radial_speed": state[1], "angular_speed": state[2]}, ()),
        "outward": (outward, {}, {OUT}),
        "inside": (inside, {}, {CROSSES} if outward else {CROSSES, OUT}),
        "slip": (slip, {"slip_after": orbit.slips()[0]}, {STOPS}),
        "admissible": (every([outward, inside, slip]), {}, {"; ".join(failing), OUT if outward is False else CROSSES}),
        "stable": (stable, {"trace": trace, "minors": minors, "determinant": det}, subsets(why)),
    }
    return {(name, kind): Fact(SINGLE[kind], *truth) for kind, truth in truths.items()}


def subsets(true: set[str]) -> set[str]:
    """All texts that name some of the true words, in any order they are written in."""
    words = [
        w
        for w in ("a multiplier is above 1", "a multiplier is below -1", "the product of two multipliers is above 1")
        if w in true
    ]
    return {"; ".join(w for k, w in enumerate(words) if pick >> k & 1) for pick in range(1, 1 << len(words))}


# ------------------------------------------------------------------------------------------------------- certificates

CLAIM_KEYS = {"about", "kind", "statement", "status", "reason", "enclosures"}
STATUS = {True: "proven", False: "refuted"}


def numbers_of(claim: dict) -> dict[str, tuple[Fraction, Fraction]]:
    """The intervals stated, as rational numbers."""
    found = {}
    for name, pair in claim["enclosures"].items():
        if not (
            isinstance(pair, list)
            and len(pair) == 2
            and all(re.fullmatch(r"-?\d+(\.\d+)?([eE][+-]?\d+)?", v) for v in pair)
        ):
            raise RefusedError(f"no interval: {name}")
        low, high = map(Fraction, pair)
        if low > high:
            raise RefusedError(f"the ends of {name} are in the wrong order")
        found[name] = (low, high)
    return found


def holds(stated: tuple[Fraction, Fraction], true: arb | Fraction) -> None:
    """Refuse an interval without the number that is enclosed by `true`."""
    if isinstance(true, Fraction):
        if not stated[0] <= true <= stated[1]:
            raise RefusedError(f"a number stated is wrong: it is {true}")
        return
    low, high = map(ball, stated)
    if not (true >= low and true <= high):
        apart = true < low or true > high
        raise RefusedError(f"a number stated {'is wrong' if apart else 'could not be confirmed'}: it is {true.str(20)}")


def judge(claim: dict, fact: Fact, matched: bool = True) -> str:
    """Compare a claim with what is found here."""
    if not (claim["statement"] == fact.statement if matched else re.fullmatch(fact.statement, claim["statement"])):
        raise RefusedError("its statement is not known to this program")
    stated = numbers_of(claim)
    if claim["status"] == "undecided":
        return "claims nothing"
    if fact.true is None:
        raise RefusedError("could not be shown by this program")
    if claim["status"] != STATUS[fact.true]:
        raise RefusedError(f"it is {'true' if fact.true else 'false'}")
    if (claim["status"] == "proven" and claim["reason"]) or (
        claim["status"] == "refuted" and claim["reason"] not in fact.reasons
    ):
        raise RefusedError(f"its reason is not: {claim['reason']!r}")
    if set(stated) != set(fact.numbers):
        raise RefusedError(
            f"the numbers stated are {', '.join(stated) or 'none'}, not {', '.join(fact.numbers) or 'none'}"
        )
    for name, interval in stated.items():
        if fact.numbers[name] is not None:  # else it is a box, looked at before, or its scale is not in the statement
            holds(interval, fact.numbers[name])
    return "checked"


class Report:
    """Lines about claims; `refused` counts what is not accepted."""

    def __init__(self) -> None:
        self.lines: list[tuple[str, str, str]] = []

    def add(self, verdict: str, what: str, why: str = "") -> None:
        self.lines.append((verdict, what, why))

    @property
    def refused(self) -> int:
        return sum(verdict == "refused" for verdict, _, _ in self.lines)

    def each(self, claims: list[dict], decide) -> None:
        """Ask `decide` about each claim; what it raises is the reason of a refusal."""
        for claim in claims:
            what = f"{claim['about']}: {claim['kind']}"
            try:
                verdict, _, why = decide(claim).partition("|")
                self.add(verdict, what, why)
            except RefusedError as problem:
                self.add("refused", what, str(problem))
            except (ZeroDivisionError, ValueError, ArithmeticError) as problem:
                self.add("refused", what, f"could not be shown: {problem}")


def loaded(text: str) -> dict:
    """The certificate; names that are there twice are refused."""

    def once(pairs):
        if len({name for name, _ in pairs}) != len(pairs):
            raise RefusedError("an entry of the file is there twice")
        return dict(pairs)

    try:
        document = json.loads(text, object_pairs_hook=once)
    except (ValueError, RecursionError) as problem:
        raise RefusedError(f"no JSON: {problem}") from None
    if not isinstance(document, dict) or document.get("format") != "carom proof 1":
        raise RefusedError("this program reads the format 'carom proof 1' only")
    needed = {"format", "theorem", "options", "hypotheses", "bits", "claims", "not_claimed", "evidence"}
    if set(document) != needed:
        raise RefusedError(f"entries missing, or not known: {', '.join(sorted(set(document) ^ needed))}")
    hypotheses = document["hypotheses"]
    if not isinstance(hypotheses, dict) or set(hypotheses) - {"helpers"} != {"table", "values", "settings", "exact"}:
        raise RefusedError("the hypotheses have entries missing, or some that are not known")
    for name in set(hypotheses) - {"table"}:
        if not isinstance(hypotheses[name], dict) or not all(isinstance(v, str) for v in hypotheses[name].values()):
            raise RefusedError(f"the hypotheses have {name} that are no texts")
    for claim in document["claims"] if isinstance(document["claims"], list) else [None]:
        if (
            not isinstance(claim, dict)
            or not set(claim) >= CLAIM_KEYS
            or not set(claim) <= CLAIM_KEYS | {"interval", "motions"}
        ):
            raise RefusedError("a claim has entries missing, or some that are not known")
        if not all(isinstance(claim[k], str) for k in ("about", "kind", "statement", "status", "reason")):
            raise RefusedError("a claim has texts that are none")
        if claim["status"] not in ("proven", "refuted", "undecided") or not isinstance(claim["enclosures"], dict):
            raise RefusedError(f"a claim has the status {claim['status']!r}")
        if not all(isinstance(p, list) and all(isinstance(v, str) for v in p) for p in claim["enclosures"].values()):
            raise RefusedError("a claim has numbers that are no texts")
    return document


def check(text: str) -> Report:
    """The report about a certificate, given as the text of its file."""
    ctx.prec = BITS
    report, document = Report(), loaded(text)
    hypotheses, claims = document["hypotheses"], document["claims"]
    for key, times in Counter((c["about"], c["kind"]) for c in claims).items():
        if times > 1:
            report.add("refused", f"{key[0]}: {key[1]}", "it is there twice")
    theorem = THEOREMS.get(str(document["theorem"]))
    if theorem is None:
        raise RefusedError(f"the theorem {document['theorem']!r} is not known to this program")
    refuse_unknown(document)
    if any(value.startswith("[") for value in hypotheses["exact"].values()):
        for claim in claims:
            report.add("not covered", f"{claim['about']}: {claim['kind']}", "the hypotheses are a box of machines")
        return report
    if "helpers" in hypotheses:
        for claim in claims:
            report.add("not covered", f"{claim['about']}: {claim['kind']}", "along a term of the machine's file")
        return report
    exact = exact_numbers(hypotheses)
    stated = {name: Exact.read(value) for name, value in hypotheses["exact"].items()}
    wrong = sorted(name for name in set(exact) | set(stated) if exact.get(name) != stated.get(name))
    if wrong:
        raise RefusedError(f"the exact numbers do not follow from the values: {', '.join(wrong)}")
    report.add("checked", "hypotheses: exact numbers")
    theorem(document, exact, report)
    return report


def refuse_missing(facts: dict, claims: list[dict], report: Report) -> None:
    """Of an orbit that meets the wall from outside the course and the slip are not stated."""
    there = {(c["about"], c["kind"]) for c in claims}
    for about, kind in facts:
        untold = kind in ("inside", "slip") and (about, "outward") in facts and facts[about, "outward"].true is False
        if (about, kind) not in there and not untold:
            report.add("refused", f"{about}: {kind}", "it is missing")


def check_machine(document: dict, exact: dict[str, Exact], report: Report) -> None:
    """Claims about equilibria and all orbits with one impact a period, then about those with several."""
    claims, m = document["claims"], Machine.of(exact)
    by_key = {(c["about"], c["kind"]): c for c in claims}
    facts = {**levitation_facts(m), **rub_facts(m)}
    periods, count = by_key.get(("machine", "periods")), None
    orbits: dict[str, Orbit | None] = {}
    problem, open_periods = "", periods is not None and periods["status"] == "undecided"
    try:
        orbits = single_orbits(m)
        count = len({name.split(",")[0] + ("ac" if name[-1] in "ac" else "bd") for name in orbits})
        if open_periods:
            orbits = {name: orbit for name, orbit in orbits.items() if (name, "solution") in by_key}
    except RefusedError as refusal:
        problem = str(refusal)
        orbits = claimed_orbits(m, claims, report)
    for name, orbit in orbits.items():
        if orbit is None:
            facts[name, "solution"] = Fact(
                "The closing conditions of an orbit with one impact a period have solutions at this root of F1.",
                False if count is not None else None, {}, {"its radial speeds are not real"},
            )  # fmt: skip
        else:
            facts |= orbit_facts(name, orbit)
    plural = "root" if count == 1 else "roots"
    facts["machine", "periods"] = Fact(
        f"F1 has exactly {count} {plural} T > 0, each of them simple." if count is not None else r"F1 has exactly .*",
        True if count is not None else None,
    )
    if surely_zero(m.mu):
        facts["machine", "slip"] = Fact("There is no friction: slip changes nothing.", True)
    else:
        facts["machine", "slip"] = Fact(
            "No periodic motion with one impact a period, inside the clearance in between, has an impact that stops the slip or that begins "
            "with backward slip.",
            slip_stays_forward(m),
        )
    known = [facts.get((name, "admissible")) for name in orbits if orbits[name]]
    complete = every(
        [
            facts["machine", "periods"].true,
            facts["machine", "slip"].true,
            *(None if f.true is None else True for f in known),
        ]
    )
    motions = sorted((n for n in orbits if orbits[n] and facts[n, "admissible"].true), key=in_order)
    facts["machine", "orbits"] = Fact(
        f"The machine has exactly these motions with one impact a period, synchronous with the shaft: {', '.join(motions)}."
        if motions
        else "The machine has no motion with one impact a period that is synchronous with the shaft.",
        complete,
    )
    if document["theorem"] == "orbits of several impacts":
        facts |= several_facts(m, claims, report)
    refuse_missing(facts, claims, report)

    def decide(claim: dict) -> str:
        fact = facts.get((claim["about"], claim["kind"]))
        if fact is None:
            if claim["about"] in ("machine", "levitation", "kick") or re.fullmatch(
                r"(rub|orbit) \d+|B\d+,\S+", claim["about"]
            ):
                raise RefusedError("there is no such thing, or no such claim about it")
            return "not covered|this program does not decide such claims"
        if claim["status"] == "undecided":
            return "claims nothing"
        if fact.true is None and problem:
            raise RefusedError(problem)
        return judge(claim, fact)

    report.each(claims, decide)


def in_order(name: str) -> tuple[int, str]:
    return int(name[1:].split(",")[0]), name


def claimed_orbits(m: Machine, claims: list[dict], report: Report) -> dict[str, Orbit | None]:
    """Orbits next to the numbers claimed, where not all periods are known; two names of one orbit are refused."""
    found: dict[str, Orbit | None] = {}
    for claim in claims:
        if claim["kind"] != "solution" or not claim["about"].startswith("B"):
            continue
        stated = numbers_of(claim)
        if claim["status"] != "proven":
            found[claim["about"]] = None
            continue
        period, speed = (
            ball(sum(stated[name]) / 2) if name in stated else arb(1) for name in ("period", "radial_speed")
        )
        try:
            found[claim["about"]] = orbit = Orbit(m, [start_of(m, period, speed)])
        except RefusedError as problem:
            report.add("refused", f"{claim['about']}: solution", str(problem))
            continue
        for other, known in found.items():
            if known is not None and known is not orbit and same(known.states, orbit.states):
                report.add("refused", claim["about"], f"it is {other}, listed twice")
    return found


def same(a: list[tuple], b: list[tuple]) -> bool:
    """Whether two lists of states may be one cycle, read from another impact on."""
    if len(a) != len(b):
        return False

    def apart(p: tuple, q: tuple) -> bool:
        angle = (p[0] - q[0]) / 2  # the same up to whole turns where its sine vanishes
        return not (angle.sin().contains(0) and all(x.overlaps(y) for x, y in zip(p[1:], q[1:], strict=True)))

    return any(not any(apart(a[k], b[(k + shift) % len(b)]) for k in range(len(a))) for shift in range(len(a)))


def several_facts(m: Machine, claims: list[dict], report: Report) -> dict:
    """Of the orbits with several impacts that are claimed."""
    facts, found = {}, {}
    for claim in claims:
        about = claim["about"]
        if not re.fullmatch(r"orbit \d+", about) or claim["kind"] != "exists":
            continue
        stated, match = numbers_of(claim), re.fullmatch(SEVERAL["exists"], claim["statement"])
        if not match:
            report.add("refused", f"{about}: exists", "its statement is not known to this program")
            continue
        impacts = int(match[1])
        names = [
            f"{name} {k + 1}" for k in range(impacts) for name in ("angle", "radial_speed", "angular_speed", "duration")
        ]
        if set(stated) != {"period", *names} or impacts < 2:
            report.add("refused", f"{about}: exists", "its numbers are not those of such an orbit")
            continue
        flat = [ball(sum(stated[name]) / 2) for name in names]
        try:
            orbit = Orbit(m, [tuple(flat[k : k + 4]) for k in range(0, len(flat), 4)])
        except RefusedError as problem:
            report.add("refused", f"{about}: exists", str(problem))
            continue
        true = dict(zip(names, [v for state in orbit.states for v in state], strict=True))
        true["period"] = sum((state[3] for state in orbit.states), arb(0))
        shorter = any(
            same(orbit.states[:k] * (impacts // k), orbit.states) and repeats(orbit.states, k)
            for k in range(1, impacts)
            if impacts % k == 0
        )
        positive_times = every([positive(state[3]) for state in orbit.states])
        facts[about, "exists"] = Fact(claim["statement"], positive_times if not shorter else None, true)
        stable, why = multipliers(*invariants(orbit.derivative()))
        outward, inside, slip = orbit.outward(), orbit.inside(), orbit.slip()
        failing = [
            word
            for word, verdict in ((OUT, outward), (CROSSES, inside if outward else None), (STOPS, slip))
            if verdict is False
        ]
        reasons = {"; ".join(failing), OUT if outward is False else CROSSES}
        facts[about, "admissible"] = Fact(plain(SEVERAL["admissible"]), every([outward, inside, slip]), {}, reasons)
        facts[about, "stable"] = Fact(plain(SEVERAL["stable"]), stable, {}, subsets(why))
        for other, known in found.items():
            if same(known.states, orbit.states):
                report.add("refused", about, f"it is {other}, listed twice")
        found[about] = orbit
    return facts


def repeats(states: list[tuple], k: int) -> bool:
    """Whether the states may be the first k over and over."""
    return all(all(x.overlaps(y) for x, y in zip(states[j], states[j % k], strict=True)) for j in range(len(states)))


def plain(pattern: str) -> str:
    return pattern.replace("\\", "")


# -------------------------------------------------------------------------------------------- points along a parameter

POINTS = {  # kind: statement, numbers in the order of the unknowns
    "fold": ("two periods of orbits meet: F1 = 0 and dF1/dT = 0", ("period", "value")),
    "period-doubling": ("an orbit has a multiplier -1", ("period", "radial_speed", "value")),
    "neimark-sacker": (
        "the product of two multipliers of an orbit is 1",
        ("period", "radial_speed", "value"),
    ),
    "grazing": (
        "an orbit touches the wall between its impacts without radial speed",
        ("touch", "period", "radial_speed", "value"),
    ),
    "non-smooth-hopf": ("an orbit shrinks into the equilibrium on the wall, |U*| = 1", ("period", "value")),
    "boundary-equilibrium": ("the contact-free equilibrium is on the wall, |U*| = 1", ("value",)),
    "rub-fold": ("the two synchronous rubs meet", ("value",)),
}
ZERO = Z(arb(0), arb(0))


class Along:
    """The machine as a function of one of its parameters."""

    def __init__(self, hypotheses: dict, exact: dict[str, Exact], name: str) -> None:
        self.name, self.numbers = name, {key: value.ball() for key, value in exact.items()}
        self.known: dict[tuple[Fraction, Fraction], list] = {}  # cells of F1 on blocks
        self.si = {}
        if name not in DIMENSIONLESS:
            if hypotheses["table"] != "machine" or name not in MACHINE or hypotheses["settings"]:
                raise RefusedError("not covered|along such a parameter")
            self.si = {key: value.ball() for key, value in si_values(hypotheses).items()}

    def at(self, p) -> Machine:
        n = dict(self.numbers)
        if self.si:
            v = {**self.si, self.name: p}
            momentum = v["mass"] * v["speed"]
            n["gamma"], n["omega_squared"] = v["damping"] / momentum, v["stiffness"] / (momentum * v["speed"])
            n["rho"], n["radius_ratio"] = v["eccentricity"] / v["clearance"], v["rotor_radius"] / v["clearance"]
            n["mu"], n["d"] = v["friction"], v["restitution"]
        elif self.name == "omega":
            n["omega_squared"] = p * p
        else:
            n[self.name] = p
        return Machine(**n)


def course(m: Machine, period, speed) -> tuple[Z, tuple]:
    """U* and the state of an orbit with one impact in the frame in which the impact is at 1."""
    a12, a22 = m.levers(period)
    return a12 * speed + 1, (arb(0), speed, -(a22.im * speed), period)


def lift(m: Machine, period, speed, t) -> tuple[Z, Z]:
    """(U - 1)/speed a time t after the impact at 1, and its rate; regular where the speed vanishes."""
    a12, a22 = m.levers(period)
    u, v = m.fly(-a12, Z(-m.d, -a22.im - m.mu * (1 + m.d)), t)
    return u + a12, v


def rise(m: Machine, period, speed, t):
    """(|U|^2 - 1)/speed."""
    g, _ = lift(m, period, speed, t)
    return 2 * g.re + speed * g.norm()


def orbit_invariants(m: Machine, period, speed) -> tuple:
    """Of the derivative of the impact map; the delay is measured in 1/speed, so that they are regular where the speed vanishes."""
    a12, a22 = m.levers(period)
    far, state = course(m, period, speed)
    _, own, end = segment(m, far, state, state)
    push = a22 * Z(m.a.re * 2, arb(2)) + m.b * a12  # the acceleration on impact; the velocity is -a22
    late = (-a22.re, -a22.im, push.re, push.im)
    found = solve([[*row, t] for row, t in zip(end, late, strict=True)], [[-v for v in row[:3]] for row in own])
    return invariants(found[:3])


def speed_condition(m: Machine, period, speed):
    a12, _ = m.levers(period)
    return (a12 * speed + 1).norm() - m.far2


def residuals(kind: str, along: Along, x: list) -> list:
    """The equations of a point, in the order of POINTS; a fold has its own."""
    m = along.at(x[-1])
    if kind == "boundary-equilibrium":
        return [wall_condition(m)]
    if kind == "rub-fold":
        force = m.gamma + m.mu * (1 - m.omega2)
        return [m.rho * m.rho * (1 + m.mu * m.mu) - force * force]
    if kind == "non-smooth-hopf":
        return [1 + m.levers(x[0])[1].re, wall_condition(m)]
    period, speed = x[-3], x[-2]
    found = [1 + m.levers(period)[1].re, speed_condition(m, period, speed)]
    if kind == "grazing":
        g, rate = lift(m, period, speed, x[0])
        return [*found, 2 * g.re + speed * g.norm(), rate.re + speed * (g.re * rate.re + g.im * rate.im)]
    trace, minors, det = orbit_invariants(m, period, speed)
    return [*found, 1 + trace + minors + det if kind == "period-doubling" else 1 - minors + trace * det - det * det]


def wall_condition(m: Machine):
    k = 1 - m.omega2
    return k * k + m.gamma * m.gamma - m.rho * m.rho


def linearised(kind: str, along: Along, x: list) -> tuple[list, list]:
    """Residuals and their derivative, by power series in each unknown."""
    if kind == "fold":
        of = partials(along, x)
        return [of[0, 0], of[1, 0]], [[of[1, 0], of[0, 1]], [of[2, 0], of[1, 1]]]
    ctx.cap = 2
    columns = [
        residuals(kind, along, [series(v, arb(1)) if j == i else v for j, v in enumerate(x)]) for i in range(len(x))
    ]
    return [constant(v) for v in columns[0]], [
        list(row) for row in zip(*[[term(v, 1) for v in column] for column in columns], strict=True)
    ]


def partials(along: Along, x: list) -> dict[tuple[int, int], arb]:
    """Derivatives of F1 by period and parameter up to the third order, the mixed ones from those along diagonals."""
    size = ball(Fraction(float(abs(x[1].mid())) or 1.0))  # of a step of the parameter beside one of the period

    def terms(by_period: int, by_value: int) -> list:
        ctx.cap = 4
        period, value = series(x[0], arb(by_period)), series(x[1], size * by_value)
        found = 1 + along.at(value if by_value else x[1]).levers(period if by_period else x[0])[1].re
        return [term(found, k) * (1, 1, 2, 6)[k] for k in range(4)]

    t, p, both, across = terms(1, 0), terms(0, 1), terms(1, 1), terms(1, -1)
    found = {
        (0, 0): t[0], (1, 0): t[1], (0, 1): p[1],
        (2, 0): t[2], (0, 2): p[2], (1, 1): (both[2] - across[2]) / 4,
        (3, 0): t[3], (2, 1): (both[3] - across[3] - 2 * p[3]) / 6, (1, 2): (both[3] + across[3] - 2 * t[3]) / 6,
    }  # fmt: skip
    return {(i, j): value / size**j for (i, j), value in found.items()}


def slopes_on(kind: str, along: Along, cell: list[arb]) -> list:
    """The derivative of the equations on a cell; where F1 alone has a long way to cancel, by the mean value theorem."""
    if kind not in ("fold", "non-smooth-hopf"):
        return linearised(kind, along, cell)[1]
    middles = [v.mid() for v in cell]
    centre, wide = partials(along, middles), partials(along, cell)
    dt, dp = (v - c for v, c in zip(cell, middles, strict=True))

    def near(i: int, j: int):
        return centre[i, j] + wide[i + 1, j] * dt + wide[i, j + 1] * dp

    first = [near(1, 0), near(0, 1)]
    return [first, [near(2, 0), near(1, 1)]] if kind == "fold" else [first, linearised(kind, along, cell)[1][1]]


def only_zero(kind: str, along: Along, box: list[arb]) -> list[arb]:
    """The only zero of the equations in a box; at most one is there, as guess * derivative is near 1 on all of it.

    The second equation of a non-smooth Hopf point holds the value alone, so that two slopes without a zero are enough.
    """

    def system(x):
        return linearised(kind, along, x)

    found = krawczyk(system, [b.mid() for b in box])
    if not all(b.contains_interior(f) for b, f in zip(box, found, strict=True)):
        raise RefusedError("the zero of the equations is not in the box that is given")
    guess = solve([[v.mid() for v in row] for row in system(found)[1]], identity(len(box)))
    guess = [[v.mid() for v in row] for row in guess]
    for pieces in (1, 2, 4, 16) if len(box) < 3 else (1, 2, 4):
        hull = None
        for cell in cells(box, pieces):
            slope = slopes_on(kind, along, cell)
            hull = (
                slope
                if hull is None
                else [[a.union(b) for a, b in zip(r, s, strict=True)] for r, s in zip(hull, slope, strict=True)]
            )
        if kind == "non-smooth-hopf" and not hull[0][0].contains(0) and not hull[1][1].contains(0):
            return found
        rest = [[int(i == j) - v for j, v in enumerate(row)] for i, row in enumerate(product(guess, hull))]
        widths = [b.rad() for b in box]
        if all(
            sum((abs(v) * w for v, w in zip(row, widths, strict=True)), arb(0)) < width
            for row, width in zip(rest, widths, strict=True)
        ):
            return found
    raise RefusedError("could not be shown: that it is the only one in its box")


def cells(box: list[arb], pieces: int):
    """The box cut into equal cells along each axis."""
    if not box:
        yield []
        return
    half = box[0].rad() / pieces
    for k in range(pieces):
        first = box[0].mid() + half * (2 * k + 1 - pieces) + arb(0, half.upper() * arb("1.0000001"))
        for others in cells(box[1:], pieces):
            yield [first, *others]


def point_facts(kind: str, label: str, along: Along, claim: dict) -> dict[str, Fact]:
    """What is true of a point next to the numbers claimed, by the second part of the kind of the claim."""
    words, names = POINTS[kind]
    stated = numbers_of(claim)
    if set(stated) != {*names, *(f"{name} box" for name in names)}:
        raise RefusedError("its numbers are not those of such a point")
    box = []
    for name in names:
        low, high = stated[f"{name} box"]
        if not low < stated[name][0] <= stated[name][1] < high:
            raise RefusedError(f"the {name} is not in its box")
        box.append(ball((low + high) / 2) + arb(0, ball((high - low) / 2)))
    x = only_zero(kind, along, box)
    numbers = dict(zip(names, x, strict=True)) | {f"{name} box": None for name in names}
    start = f"Along {along.name}, "
    facts = {
        "": Fact(
            f"{start}{words}, at exactly one point of the box that is given, and there at these values.", True, numbers
        )
    }
    _, slopes = linearised(kind, along, x)
    m = along.at(x[-1])
    if kind == "fold":
        facts |= fold_facts(label, along, m, x, slopes)
    elif kind in ("boundary-equilibrium", "rub-fold"):
        slope = slopes[0][0]
        facts["transversal"] = Fact(
            f"The condition vanishes with this slope by {along.name}, which is not zero.",
            not slope.contains(0) or None,
            {"slope": slope},
        )
        if kind == "boundary-equilibrium":
            facts |= boundary_facts(m)
    elif kind == "non-smooth-hopf":
        facts |= hopf_facts(along, m, x)
    elif kind == "grazing":
        facts |= grazing_facts(along, m, x, slopes)
    else:
        facts |= multiplier_facts(kind, along, m, x, slopes)
    return facts


def is_motion(m: Machine, period, speed, touch=None) -> bool | None:
    """Whether an orbit with one impact meets the wall from inside, stays inside and keeps its slip forward."""

    def height(part):
        return rise(m, period, speed, series(period * part, period))

    state = course(m, period, speed)[1]
    slip = [m.s + 1 + state[2], m.s + 1 + state[2] - m.mu * (1 + m.d) * speed]
    slips = [True] if surely_zero(m.mu) else [positive(v) for v in slip]
    return every([positive(speed), below(height, 2 if surely_zero(m.d) else 1, touch), *slips])


MOTION = "The orbit there is a motion of the machine: inside the wall between the impacts."
NO_MOTION = {CROSSES, OUT, STOPS, "it would meet the wall from outside"}


def fold_facts(label: str, along: Along, m: Machine, x: list, slopes: list) -> dict[str, Fact]:
    curvature, slope = slopes[1][0], slopes[0][1]
    if curvature.contains(0) or slope.contains(0):
        raise RefusedError("could not be shown: that the fold is quadratic")
    exist, none = ("smaller", "larger") if curvature * slope > 0 else ("larger", "smaller")
    a12, _ = m.levers(x[0])
    a, b, c = a12.norm(), a12.re, 1 - m.far2
    inner = b * b - a * c
    motion = None
    if inner > 0:
        motion = is_motion(m, x[0], (-b + (inner.sqrt() if label[-1] in "cd" else -inner.sqrt())) / a)
    return {
        "transversal": Fact(
            f"It is a quadratic fold: d2F1/dT2 and the derivative of F1 by {along.name} are not zero. Both periods exist for {exist} values of "
            f"{along.name} next to it, and none for {none} ones.",
            True,
            {"curvature": curvature, "slope": slope},
        ),
        "motion": Fact(MOTION, motion, {}, NO_MOTION),
    }


def boundary_facts(m: Machine) -> dict[str, Fact]:
    """At N = 0 the rub next to it has N = rho^2 gap/(k - mu gamma), and is the saddle if that is positive."""
    balance = 1 - m.omega2 - m.mu * m.gamma
    words = {
        "non-smooth fold": "It is a non-smooth fold: a synchronous rub, a saddle along the wall, exists on the side where the rotor levitates.",
        "persistence": "It is persistence: a synchronous rub pressed on the wall exists where the contact-free equilibrium is outside.",
    }
    true = {"non-smooth fold": positive(balance), "persistence": positive(-balance)}
    return {name: Fact(words[name], true[name], {"balance": balance}) for name in words}


def hopf_facts(along: Along, m: Machine, x: list) -> dict[str, Fact]:
    ctx.cap = 2
    reach = m.levers(x[0])[0].re
    slope = term(along.at(series(x[-1], arb(1))).far2, 1) / (2 * reach)

    def height(part):
        return rise(m, x[0], arb(0), series(x[0] * part, x[0]))

    words = "It is {}: next to it the small cycle has a positive radial speed where the contact-free equilibrium is {} the wall, as Re(q a12) has this sign."
    return {
        "transversal": Fact(
            f"Its radial speed grows from zero by {along.name} with this slope, not zero.",
            not slope.contains(0) or None,
            {"speed_slope": slope, "reach": reach},
        ),
        "subcritical": Fact(words.format("subcritical", "inside"), positive(-reach)),
        "supercritical": Fact(words.format("supercritical", "outside"), positive(reach)),
        "motion": Fact(
            "The small cycles next to it are motions of the machine: inside the wall between the impacts.",
            below(height, 2 if surely_zero(m.d) else 1),
            {},
            NO_MOTION | {"they would cross the wall between their impacts"},
        ),
    }


def slope_along(x: list, equations: list, condition: list):
    """Total derivative by the last unknown of a function with these derivatives, on the curve of the equations."""
    others = [row[:-1] for row in equations]
    follow = solve(others, [[-row[-1]] for row in equations])
    return condition[-1] + sum((c * f[0] for c, f in zip(condition, follow, strict=False)), arb(0))


def grazing_facts(along: Along, m: Machine, x: list, slopes: list) -> dict[str, Fact]:
    touch, period, speed, _ = x
    slope = slope_along(
        x, [slopes[0][1:], slopes[1][1:]], slopes[2][1:]
    )  # the touch is a maximum: its move adds nothing
    share = float(touch.mid()) / float(period.mid())
    gap, near = Fraction(1, 64), None
    while gap > Fraction(1, 2**20):
        low, high = Fraction(int(share * 2**24), 2**24) - gap, Fraction(int(share * 2**24), 2**24) + gap
        ctx.cap = 3
        cell = period * (ball((low + high) / 2) + arb(0, ball(gap)))
        if rise(m, period, speed, series(cell, arb(1)))[2] < 0 and low > 0 and high < 1:
            near = (low, high)
            break
        gap /= 2
    maximum = near is not None and cell.contains_interior(touch)
    return {
        "transversal": Fact(
            f"The touch is a maximum of the radius, whose height (|U|^2 - 1)/radial speed grows by {along.name} with this slope, not zero.",
            (maximum and not slope.contains(0)) or None,
            {"slope": slope},
        ),
        "motion": Fact(
            "The orbit there is a motion of the machine: inside the wall between the impacts, but for the touch.",
            is_motion(m, period, speed, near) if maximum else None,
            {},
            NO_MOTION,
        ),
    }


def multiplier_facts(kind: str, along: Along, m: Machine, x: list, slopes: list) -> dict[str, Fact]:
    period, speed, _ = x
    slope = slope_along(x, slopes[:2], slopes[2])
    trace, _, det = orbit_invariants(m, period, speed)
    facts = {
        "transversal": Fact(
            f"Along the branch of the orbit, the test function vanishes with this slope by {along.name}, which is not zero.",
            not slope.contains(0) or None,
            {"slope": slope},
        ),
        "motion": Fact(MOTION, is_motion(m, period, speed), {}, NO_MOTION),
    }
    if kind == "neimark-sacker":
        total = trace - det  # the product of the pair is 1, so that the third one is the determinant
        strong = [total.contains(k) for k in (-1, 0)]
        facts["complex"] = Fact(
            "A conjugate pair of multipliers lies on the unit circle, with this sum; it is at no resonance 1:1, 1:2, 1:3 or 1:4.",
            True if abs(total) < 2 and not any(strong) else None,
            {"pair_sum": total},
        )
    return facts


# ----------------------------------------------------------------------------------------------- intervals of a parameter

MOST_BLOCKS = 3000
MOVES, MEETS = "motion of the machine", "it would meet the wall from outside"
TWO = "two multipliers are outside the unit circle"


class OpenError(Exception):
    """A block of the parameter is too wide."""


class Block:
    """An orbit with one impact for all values of a parameter in a block: functions of it as Taylor polynomials of two terms and a remainder."""

    def __init__(
        self, along: Along, low: Fraction, high: Fraction, cell: tuple[Fraction, Fraction, int], upper: bool
    ) -> None:
        self.along, self.half = along, ball(high - low) / 2
        self.centre = ball(low + high) / 2
        centre = along.at(self.centre)
        period = root(centre, *cell)
        self.narrow = self.branch(self.centre, period, period, upper)
        width = abs(term(self.narrow[1], 1)) * self.half * 2 + arb("1e-30")
        wide = period + arb(0, width.upper())
        self.wide = self.branch(self.centre + arb(0, self.half), wide, wide, upper)
        if not wide.contains_interior(period + term(self.wide[1], 1) * arb(0, self.half)):
            raise OpenError
        self.period, self.speed = self.over(lambda m, t, r: t), self.over(lambda m, t, r: r)

    def branch(self, value: arb, period: arb, about: arb, upper: bool) -> tuple:
        """Machine, period and radial speed as series in the parameter."""
        ctx.cap = 2
        slope = self.along.at(value).period_function(series(about, arb(1)))[1]
        if slope.contains(0):
            raise OpenError
        ctx.cap = 3
        m, terms = self.along.at(series(value, arb(1))), [period]
        for k in (1, 2):
            terms.append(-term(m.period_function(series(*terms)), k) / slope)
        t = series(*terms)
        a12, _ = m.levers(t)
        a, b, c = a12.norm(), a12.re, 1 - m.far2
        inner = b * b - a * c
        if not constant(inner) > 0:
            raise OpenError
        return m, t, (-b + (inner.sqrt() if upper else -inner.sqrt())) / a

    def over(self, function) -> arb:
        """The values of a function of machine, period and radial speed on the block."""
        return self.over_each(lambda m, t, r: (function(m, t, r),))[0]

    def over_each(self, functions) -> list[arb]:
        ctx.cap = 3
        near, far, away = functions(*self.narrow), functions(*self.wide), arb(0, self.half)
        return [term(n, 0) + term(n, 1) * away + term(f, 2) * away * away for n, f in zip(near, far, strict=True)]

    def slope(self, function) -> arb:
        ctx.cap = 3
        return term(function(*self.narrow), 1) + 2 * term(function(*self.wide), 2) * arb(0, self.half)

    def rises(self, part: arb) -> arb:
        """(|U|^2 - 1)/speed at a share of the period."""
        return self.over(lambda m, t, r: rise(m, t, r, t * part))

    def inside(self) -> bool | None:
        """Whether the path is inside between impacts that meet the wall from inside, for all values; None where it differs or is open."""
        narrow, wide = (balls_of(v) for v in (self.narrow, self.wide))

        def height(numbers):
            m, t, r = numbers
            return lambda part: rise(m, t, r, series(t * part, t))

        first, edges = 2 if surely_zero(narrow[0].d) else 1, []
        for at, sign, skip in ((0, 1, first), (1, -1, 1)):
            edge = Fraction(1, 8)
            while True:
                half = ball(edge) / 2
                terms = taylor(height(wide), arb(at), half, at + sign * half)
                if horner([c * sign**k for k, c in enumerate(terms)][skip:], half + arb(0, half)) < 0:
                    break
                edge /= 2
                if edge < Fraction(1, 2**12):
                    raise OpenError
            edges.append(edge)
        stack, work = [(edges[0], 1 - edges[1])], 0
        while stack:
            low, high = stack.pop(0)
            middle_part, half = ball(low + high) / 2, ball(high - low) / 2
            terms, cell, away = taylor(height(narrow), middle_part, half), middle_part + arb(0, half), arb(0, self.half)
            ctx.cap = 3
            near, far = (rise(m, t, r, t * cell) for m, t, r in (self.narrow, self.wide))
            if horner(terms, arb(0, half)) + term(near, 1) * away + term(far, 2) * away * away < 0:
                continue
            if terms[0] > 0 and self.rises(middle_part) > 0:
                return False
            work += 1
            if work > 40:
                raise OpenError
            cut = (low + high) / 2
            stack += [(low, cut), (cut, high)]
        return True

    def slip(self) -> bool:
        after = self.over(lambda m, t, r: m.s + 1 - m.levers(t)[1].im * r - m.mu * (1 + m.d) * r)
        before = self.over(lambda m, t, r: m.s + 1 - m.levers(t)[1].im * r)
        if not (surely_zero(self.narrow[0].mu) or (after > 0 and before > 0)):
            raise OpenError
        return True

    def margins(self) -> list[arb]:
        """Four numbers whose signs say where the multipliers are; the second one is det(1 + J)."""
        return self.over_each(margins_of)

    def stability(self) -> set[str]:
        """What may be said of the multipliers."""
        at_one, at_minus, second, pairs = self.margins()
        true = {
            f"unstable ({word})"
            for word, shown in (
                ("a multiplier is above 1", at_one < 0),
                ("a multiplier is below -1", at_minus < 0),
                ("the product of two multipliers is above 1", pairs < 0),
                (TWO, at_one > 0 and at_minus > 0 and pairs < 0),
            )
            if shown
        }
        if all(v > 0 for v in (at_one, at_minus, second, pairs)):
            true = {"stable"}
        if not true:
            raise OpenError
        return true

    def course(self) -> str:
        if self.speed < 0:
            return f"no motion ({MEETS})"
        if not self.speed > 0:
            raise OpenError
        if self.inside():
            self.slip()
            return MOVES
        return f"no motion ({CROSSES})"


def margins_of(m: Machine, period, speed) -> tuple:
    trace, minors, det = orbit_invariants(m, period, speed)
    return (
        1 - trace + minors - det,
        1 + trace + minors + det,
        3 + trace - minors - 3 * det,
        1 - minors + trace * det - det * det,
    )


def balls_of(branch: tuple) -> tuple:
    """The terms of order zero of a branch: balls that hold all its values."""
    m, t, r = branch
    plain_machine = Machine(*(constant(v) for v in (m.gamma, m.omega2, m.rho, m.mu, m.d, m.s)))
    return plain_machine, constant(t), constant(r)


def isolated_on(along: Along, low: Fraction, high: Fraction) -> list:
    """The cells of F1 for all values of a block."""
    if (low, high) in along.known:
        return along.known[low, high]
    centre, half = ball(low + high) / 2, ball(high - low) / 2
    block = centre + arb(0, half)
    size = ball(Fraction(float(abs(centre.mid())) or 1.0))

    def change(cell: arb, order: int) -> arb:
        """By the mean value theorem; the mixed derivative from those along both diagonals."""
        keep, away = ctx.cap, arb(0, half)
        ctx.cap = 3
        if order == 0:
            slope = term(along.at(series(block, arb(1))).period_function(cell), 1)
        else:
            up, down = (
                term(along.at(series(block, sign * size)).period_function(series(cell, arb(1))), 2) for sign in (1, -1)
            )
            slope = (up - down) / 2 / size
        ctx.cap = keep
        return slope * away

    along.known[low, high] = isolated(along.at(centre), along.at(block), change, 600)
    return along.known[low, high]


def parts(statement: str) -> dict[str, tuple[str, str]]:
    """What a claim about a stretch says of each orbit: its course and its stability."""
    found: dict[str, tuple[str, str]] = {}
    start = "The closing conditions have exactly these solutions, and each keeps its properties: "
    if not statement.startswith(start):
        raise RefusedError("its statement is not known to this program")
    listed = statement[len(start) :]
    for text in [] if listed == "none" else listed.split("; "):
        match = re.fullmatch(rf"(B\d+,[a-d]): ({MOVES}|no motion \([^()]*\)), (stable|unstable \([^()]*\))", text)
        if not match or match[1] in found:
            raise RefusedError(f"not known to this program: {text!r}")
        found[match[1]] = (match[2], match[3])
    return found


def stretch(along: Along, low: Fraction, high: Fraction, judge_block, most: int = MOST_BLOCKS) -> None:
    """Ask `judge_block` on blocks that cover an interval, narrower ones where it raises OpenError."""
    stack, work = [(low, high)], 0
    while stack:
        a, b = stack.pop()
        work += 1
        if work > most:
            raise RefusedError("could not be shown: too many blocks")
        try:
            judge_block(a, b)
        except (OpenError, ZeroDivisionError) as problem:
            words = f"{problem} " if str(problem) else ""
        except RefusedError as problem:
            if not str(problem).startswith("could not"):
                raise
            words = ""
        else:
            continue
        if b - a < (high - low) / 2**24:
            raise RefusedError(f"could not be shown: {words}next to {along.name} = {float(a):.8g}")
        stack += [((a + b) / 2, b), (a, (a + b) / 2)]


def named(cells_found: list) -> dict[str, tuple[tuple, bool]]:
    """Names of the orbits on cells of F1, and whether they have the higher radial speed."""
    found, number = {}, 0
    for cell in cells_found:
        number += cell[2] < 0 or not number
        for letter in "ac" if cell[2] < 0 else "bd":
            found[f"B{number},{letter}"] = (cell, letter in "cd")
    return found


def no_speeds(along: Along, low: Fraction, high: Fraction, cell: tuple[Fraction, Fraction, int]) -> bool:
    """Whether the radial speeds at a period are not real, for all values of a block."""
    half, centre = ball(high - low) / 2, ball(low + high) / 2
    period = root(along.at(centre), *cell)

    def rate(value: arb, about: arb) -> arb:
        ctx.cap = 2
        by_value = term(along.at(series(value, arb(1))).period_function(about), 1)
        return -by_value / along.at(value).period_function(series(about, arb(1)))[1]

    wide = period + arb(0, (abs(rate(centre, period)) * half * 2 + arb("1e-30")).upper())
    block = centre + arb(0, half)
    if not wide.contains_interior(period + rate(block, wide) * arb(0, half)):
        raise OpenError
    m = along.at(block)
    a12, _ = m.levers(wide)
    return bool(a12.re * a12.re - a12.norm() * (1 - m.far2) < 0)


def differs(found: tuple[str, set[str]], said: tuple[str, str], name: str) -> None:
    """Refuse what is said of an orbit on a block, if it is false, or leave it open."""
    goes, may = found
    if goes != said[0] or (said[1] == "stable") != ("stable" in may):
        raise RefusedError(f"it is false: {name} is {goes}, {' or '.join(sorted(may))}")
    if said[1] not in may:
        raise OpenError


def check_stretch(along: Along, claim: dict) -> str:
    """The list of all orbits for an interval, with what each of them is."""
    said, stated = parts(claim["statement"]), numbers_of(claim)
    low, high = (decimal_of(v) for v in claim["interval"])
    if set(stated) != {f"{name} {what}" for name in said for what in ("period", "radial_speed")}:
        raise RefusedError("its numbers are not those of such an interval")
    if claim["motions"] != [name for name, (course_of, _) in said.items() if course_of == MOVES]:
        raise RefusedError("its list of motions does not follow from its statement")
    periods: list = []

    def count(a: Fraction, b: Fraction) -> None:
        names = named(isolated_on(along, a, b))
        for name in set(names) - set(said):
            if not no_speeds(along, a, b, names[name][0]):
                raise OpenError
        if set(said) - set(names):
            raise RefusedError("it is false: there are not so many periods")
        periods.append((a, b, names))

    def each(a: Fraction, b: Fraction) -> None:
        names = next(n for p, q, n in periods if p <= a and b <= q)
        for name, (course_of, stable) in said.items():
            block = Block(along, a, b, *names[name])
            differs((block.course(), block.stability()), (course_of, stable), name)
            for what, true in (("period", block.period), ("radial_speed", block.speed)):
                start, end = map(ball, stated[f"{name} {what}"])
                if true < start or true > end:
                    raise RefusedError(f"a number stated is wrong: {name} {what}")
                if not (true >= start and true <= end):
                    raise OpenError

    stretch(along, low, high, count)
    for a, b, _ in list(periods) if said else []:
        stretch(along, a, b, each)
    return "checked"


def one(verdicts: set):
    """The verdict of a set that holds one."""
    return next(iter(verdicts)) if len(verdicts) == 1 else None


def check_slip_on(along: Along, low: Fraction, high: Fraction) -> bool:
    def each(a: Fraction, b: Fraction) -> None:
        if not slip_stays_forward(along.at(ball(a + b) / 2 + arb(0, ball(b - a) / 2))):
            raise OpenError

    stretch(along, low, high, each)
    return True


class Intervals:
    """Claims about intervals of a parameter: those about stretches are shown, the others follow from them."""

    def __init__(self, along: Along, options: dict, claims: list[dict]) -> None:
        unit = "" if along.name in DIMENSIONLESS else MACHINE[along.name]
        ends = [quantity(options[key], unit) for key in ("from", "to")]
        if any(end.power for end in ends):
            raise RefusedError("not covered|ends of the interval that hold pi")
        self.along, self.low, self.high = along, ends[0].rational, ends[1].rational
        self.words = f"For all {options['from']} <= {along.name} <= {options['to']}, "
        self.listed, self.trusted = [], True
        for claim in claims:
            if claim["kind"] == "orbits" and claim["about"].startswith(f"{along.name} in ["):
                a, b = (
                    decimal_of(v) for v in re.fullmatch(rf"{along.name} in \[(\S+), (\S+)\]", claim["about"]).groups()
                )
                shown = claim["status"] == "proven"
                if shown and (claim.get("interval") is None or [decimal_of(v) for v in claim["interval"]] != [a, b]):
                    raise RefusedError("an interval has other ends in its name")
                self.listed.append(
                    (a, b, parts(claim["statement"]) if shown else None, claim["about"].partition(" in ")[2])
                )
        edges = [a for a, _, _, _ in self.listed] + [self.high]
        if (
            not self.listed
            or self.listed[0][0] != self.low
            or any(b != e for (_, b, _, _), e in zip(self.listed, edges[1:], strict=True))
        ):
            raise RefusedError("the stretches do not cover the interval in order")

    def refuse_missing(self, claims: list[dict], report: Report) -> None:
        """Refuse what is not stated of the machine, or of an orbit that a stretch has."""
        there = {(c["about"], c["kind"]) for c in claims}
        names = {name for _, _, said, _ in self.listed for name in said or {}}
        wanted = {(name, kind) for name in names for kind in ("exists", "admissible", "stable")}
        for about, kind in sorted(wanted | {("machine", "slip"), ("machine", "all-single-impact-orbits")}):
            if (about, kind) not in there:
                report.add("refused", f"{about}: {kind}", "it is missing")

    def tried(self, low: Fraction, high: Fraction, wanted: dict[str, str]) -> dict[str, set]:
        """What is found of orbits on a stretch that is left open, by their names; all of them for the name "all"."""
        found: dict[str, set] = {name: set() for name in wanted}

        def each(a: Fraction, b: Fraction) -> None:
            names = named(isolated_on(self.along, a, b))
            for name, kind in wanted.items():
                if name == "all":
                    real = [n for n in names if not no_speeds(self.along, a, b, names[n][0])]
                    courses = {n: Block(self.along, a, b, *names[n]).course() for n in real}
                    found[name].add(tuple(sorted((n for n, v in courses.items() if v == MOVES), key=in_order)))
                elif name in names:
                    block = Block(self.along, a, b, *names[name])
                    good = {
                        "exists": lambda of: True,
                        "admissible": lambda of: of.course() == MOVES,
                        "stable": lambda of: of.stability() == {"stable"},
                    }
                    found[name].add(good[kind](block))
                else:
                    found[name].add(False)

        try:
            stretch(self.along, low, high, each, 40)
        except RefusedError:
            return {name: {None} for name in wanted}
        return found

    def follows(self, claim: dict) -> str:
        """A claim about the whole interval, from what is stated on the stretches."""
        about, kind, stated = claim["about"], claim["kind"], numbers_of(claim)
        if (about, kind) == ("machine", "all-single-impact-orbits"):
            lists = set()
            for low, high, said, _ in self.listed:
                if said is None:
                    lists |= self.tried(low, high, {"all": ""})["all"]
                else:
                    lists.add(tuple(sorted((n for n, v in said.items() if v[0] == MOVES), key=in_order)))
            if one(lists) is None:
                raise RefusedError("it does not follow from the stretches")
            names = ", ".join(next(iter(lists)))
            text = f"{self.words}motions of the machine with one impact a period, synchronous with the shaft, are {f'exactly these: {names}' if names else 'none'}."
            return judge(claim, Fact(text, True))
        texts = {
            "exists": "its closing conditions have a solution.",
            "admissible": "it is a motion of the machine.",
            "stable": "all its multipliers lie inside the unit circle.",
        }
        good = {"exists": lambda v: True, "admissible": lambda v: v[0] == MOVES, "stable": lambda v: v[1] == "stable"}[
            kind
        ]
        verdicts = [
            one(self.tried(a, b, {about: kind})[about]) if said is None else about in said and good(said[about])
            for a, b, said, _ in self.listed
        ]
        true = every(verdicts)
        if all(end in stated for end in ("from", "to")):
            a, b = stated.pop("from")[0], stated.pop("to")[1]
            inner = [v for (p, q, _, _), v in zip(self.listed, verdicts, strict=True) if p < b and q > a]
            if not a < b or not all(inner) or not inner:
                raise RefusedError("between the numbers stated it is not shown")
        if stated or claim["statement"] != self.words + texts[kind] or claim["status"] != STATUS.get(true):
            raise RefusedError("it does not follow from the stretches")
        if (claim["reason"] == "") != (true is True):
            raise RefusedError("its reason does not follow from the stretches")
        for word, verdict in (("shown on", True), ("the contrary on", False), ("open on", None)):
            given = re.search(rf"{word} ([^;]*)", claim["reason"])
            spans = (
                [tuple(decimal_of(v) for v in pair) for pair in re.findall(r"\[(\S+), (\S+)\]", given[1])]
                if given
                else []
            )
            for a, b in spans:
                inner = [v for (p, q, _, _), v in zip(self.listed, verdicts, strict=True) if p < b and q > a]
                if any(v is not verdict for v in inner):
                    raise RefusedError("its reason does not follow from the stretches")
        return "checked"


def decide_interval(claim: dict, intervals: Intervals | None, along: Along) -> str:
    about, kind = claim["about"], claim["kind"]
    if intervals is None:
        return "not covered|an interval of this parameter"
    if (about, kind) == ("machine", "slip"):
        text = f"{intervals.words}no orbit with one impact a period stops its slip or slips backward."
        return judge(claim, Fact(text, check_slip_on(along, intervals.low, intervals.high)))
    if (about, kind) == ("machine", "all-single-impact-orbits") or (
        re.fullmatch(r"B\d+,[a-d]", about) and kind in ("exists", "admissible", "stable")
    ):
        return intervals.follows(claim)
    stretch_of = re.fullmatch(rf"{along.name} in \[\S+, \S+\]", about)
    if stretch_of and kind == "orbits" and claim["status"] == "proven" and claim["reason"] == "":
        return check_stretch(along, claim)
    return "not covered|this program does not decide such claims"


def points_of(along: Along, claims: list[dict], report: Report) -> dict[tuple[str, str], dict[str, Fact] | str]:
    """What is true of each point that is claimed, or the reason to refuse it; one zero listed twice is refused."""
    points: dict[tuple[str, str], dict[str, Fact] | str] = {}
    zeros: list[tuple[tuple, list]] = []
    for claim in claims:
        label = re.fullmatch(r"of (\S+)(?: \(\d+\))?", claim["kind"])
        if claim["about"] not in POINTS or not label or claim["status"] == "undecided":
            continue
        key = (claim["about"], claim["kind"])
        try:
            points[key] = facts = point_facts(claim["about"], label[1], along, claim)
        except RefusedError as problem:
            points[key] = str(problem)
            continue
        # At a fold, and where orbits are born at the wall, two orbits of one pair of names share the numbers.
        sort = (claim["about"], label[1][-1] if claim["about"] in ("fold", "non-smooth-hopf") else "")
        values = [v for v in facts[""].numbers.values() if v is not None]
        if any(k == sort and all(x.overlaps(y) for x, y in zip(v, values, strict=True)) for k, v in zeros):
            report.add("refused", f"{key[0]}: {key[1]}", "this zero is listed twice")
        zeros.append((sort, values))
        if (key[0], f"{key[1]} transversal") not in {(c["about"], c["kind"]) for c in claims}:
            report.add("refused", f"{key[0]}: {key[1]} transversal", "it is missing")
    return points


def check_along(document: dict, exact: dict[str, Exact], report: Report) -> None:
    """Claims about points and intervals of a parameter."""
    options, claims = document["options"], document["claims"]
    along = Along(document["hypotheses"], exact, options["along"])
    try:
        intervals = Intervals(along, options, claims)
        intervals.refuse_missing(claims, report)
    except RefusedError as problem:
        if not str(problem).startswith("not covered"):
            raise
        intervals = None
    points = points_of(along, claims, report)

    def decide(claim: dict) -> str:
        about, kind = claim["about"], claim["kind"]
        if claim["status"] == "undecided":
            return "claims nothing"
        if about not in POINTS:
            return decide_interval(claim, intervals, along)
        for (of, first), facts in points.items():
            if of == about and (kind == first or kind.startswith(f"{first} ")):
                if isinstance(facts, str):
                    raise RefusedError(facts)
                fact = facts.get(kind[len(first) :].strip())
                return judge(claim, fact) if fact else "not covered|this program does not decide such claims"
        raise RefusedError("the point itself is missing")

    report.each(claims, decide)


# ----------------------------------------------------------------------------------------------------------------- kicks

MOST_FLIGHTS = 300
MOST_PARTS = 600  # of cells
MOST_LOST, MOST_BOUNCES = 30, 20  # of refuted cells


def leaves_of(letters: str, parameters: int = 0) -> list[tuple]:
    """The cells of a tree: letter, both ends of speeds as shares of the largest, of angles as shares of a turn, of parameters as shares."""
    found, stack = [], [(Fraction(0), Fraction(1)) * (2 + parameters)]
    for letter in letters:
        if not stack:
            raise RefusedError("the tree of cells has letters left over")
        ends = stack.pop()
        place = 2 * "vapqu"[: 2 + parameters].find(letter)
        if place >= 0:
            cut = (ends[place] + ends[place + 1]) / 2
            stack += [(*ends[:place], cut, *ends[place + 1 :]), (*ends[: place + 1], cut, *ends[place + 2 :])]
        elif re.fullmatch("[0-9A-Zb-uw-z]", letter):
            found.append((letter, *ends))
        else:
            raise RefusedError("the tree of cells has a letter that is not known")
    if stack:
        raise RefusedError("the tree of cells ends early")
    return found


def impacts_of(letter: str) -> int | None:
    """The number of impacts of a closed cell, none of an open one."""
    return int(letter, 36) if letter.isdigit() or letter.isupper() else None


def kicked(m: Machine, speed: arb, direction: Z) -> tuple[Z, Z]:
    """Deviation and velocity after a kick."""
    return ZERO, direction * speed


def stepped(m: Machine, change: arb, direction: Z) -> tuple[Z, Z]:
    """Deviation and velocity after the eccentricity has changed: before, the rotor levitated elsewhere."""
    return direction * (change / m.b.norm().sqrt()), ZERO


def shaken(lasts: arb):
    """The same after a half-sine push of a peak, of this duration."""

    def start(m: Machine, peak: arb, direction: Z) -> tuple[Z, Z]:
        # x'' + gamma x' + omega^2 x = sin(nu t): the part that goes on, less free motion with its place and rate at the start.
        nu = arb.pi() / lasts
        stiff, drag = m.omega2 - nu * nu, m.gamma * nu
        size = stiff * stiff + drag * drag
        at, rate = -drag / size, nu * stiff / size
        u, v = Z(-at), Z(-rate) + Z(at).turned()
        u, v = m.fly(u, v, lasts)
        place, speed = turn(lasts) * u, turn(lasts) * (v + u.turned())  # in the fixed frame, real
        place, speed = (place.re - at) * peak, (speed.re - rate) * peak
        back = turn(-lasts)
        return direction * back * place, direction * back * Z(speed, -place)

    return start


def impacts_after(m: Machine, u: Z, v: Z, most: int) -> int | None:
    """How many impacts there are until no flight reaches the wall; None where this is not decided."""
    far = m.far2.sqrt()
    room = m.omega2 * (1 - far) * (1 - far)
    for count in range(most + 2):
        start, skip = arb(0), 0 if count == 0 else 1
        while True:
            place, rate = m.fly(u, v, start)
            energy = (rate + place.turned()).norm() + m.omega2 * place.norm()  # in the fixed frame it never rises
            if energy < room:
                return count
            step = next_zero(lambda t, a=u, b=v: (m.fly(a, b, t)[0] + far).norm() - 1, start, skip)
            if step is None:
                return None
            start, crossed = step
            if crossed:
                break
            skip = 0
        u, v = m.fly(u, v, start)
        place = u + far
        rate = v * place.conj()  # r + i w times |U|^2 = 1
        slip, bite = m.s + 1 + rate.im, m.mu * (1 + m.d) * rate.re
        if not rate.re > 0:
            return None
        if slip > bite:
            change = bite
        elif slip < -bite:
            change = -bite
        elif abs(slip) < bite:
            change = slip
        else:
            return None
        v = place * Z(-(m.d * rate.re), rate.im - change)
    return most + 1


def next_zero(height, start: arb, skip: int) -> tuple[arb, bool] | None:
    """The first zero after `start`, or a later time up to which there is none; with `skip` there is one at the start itself."""
    length = Fraction(1, 2)
    while length > Fraction(1, 2**40):
        half = ball(length) / 2
        terms = taylor(lambda t: height(series(t, arb(1))), start, half, start + half)
        span = half + arb(0, half)
        if horner(terms[skip:], span) < 0:
            return start + ball(length), False
        slope = horner([k * c for k, c in enumerate(terms)][1:], span)
        if slope > 0 and not skip and horner(terms, ball(length)) > 0 and terms[0] < 0:

            def equation(x):
                ctx.cap = 2
                value = height(series(x[0], arb(1)))
                return [value[0]], [[value[1]]]

            return krawczyk(equation, [start + half], "1e-15")[0], True
        length /= 2
    return None


def kicks_followed(m: Machine, scaled: Exact, cells_of: list, start) -> int:
    """How many in the middle of cells are seen to return; one that has more impacts than its cell may have is refused."""
    closed = [cell for cell in cells_of if impacts_of(cell[0]) is not None]
    closed.sort(key=lambda cell: (cell[1] ** 2 - cell[2] ** 2) * (cell[4] - cell[3]))
    flown = 0
    for letter, low, high, first, last in closed[:MOST_FLIGHTS]:
        bound = impacts_of(letter) or 0
        speed, angle = (scaled * Exact((low + high) / 2)).ball(), 2 * arb.pi() * ball((first + last) / 2)
        try:
            found = impacts_after(m, *start(m, speed, turn(angle)), bound)
        except RefusedError:
            found = None
        flown += found is not None
        if found is not None and found > bound:
            raise RefusedError(f"the one in the middle of a cell has more than {bound} impacts")
    return flown


def lost_followed(m: Machine, scaled: Exact, cells_of: list, start) -> int:
    """How many in the middle of refuted cells are seen to strike on; one that returns is refused."""
    lost = sorted(
        (cell for cell in cells_of if cell[0] == "r"),
        key=lambda cell: (cell[1] ** 2 - cell[2] ** 2) * (cell[4] - cell[3]),
    )
    flown = 0
    for _, low, high, first, last in lost[:MOST_LOST]:
        size, angle = (scaled * Exact((low + high) / 2)).ball(), 2 * arb.pi() * ball((first + last) / 2)
        try:
            found = impacts_after(m, *start(m, size, turn(angle)), MOST_BOUNCES)
        except RefusedError:
            found = None
        flown += found is not None
        if found is not None and found <= MOST_BOUNCES:
            raise RefusedError(f"the one in the middle of a refuted cell returns after {found} impacts")
    return flown


class Spread:
    """A number that depends on two shares in [-1, 1]: its value at the centre, all its values, and its derivatives by the shares."""

    __slots__ = ("all", "at", "by")

    def __init__(self, at: arb, by: tuple | None = None, every_value: arb | None = None) -> None:
        self.at, self.by = at, by or (arb(0), arb(0))
        near = at + self.by[0] * arb(0, 1) + self.by[1] * arb(0, 1)
        self.all = near if every_value is None else meet(near, every_value)

    def __add__(self, o):
        if not isinstance(o, Spread):
            return Spread(self.at + o, self.by, self.all + o)
        return Spread(self.at + o.at, (self.by[0] + o.by[0], self.by[1] + o.by[1]), self.all + o.all)

    def __neg__(self):
        return Spread(-self.at, (-self.by[0], -self.by[1]), -self.all)

    def __sub__(self, o):
        return self + (-o)

    def __rsub__(self, o):
        return -self + o

    def __mul__(self, o):
        if not isinstance(o, Spread):
            return Spread(self.at * o, (self.by[0] * o, self.by[1] * o), self.all * o)
        by = tuple(a * o.all + b * self.all for a, b in zip(self.by, o.by, strict=True))
        return Spread(self.at * o.at, by, self.all * o.all)

    __radd__, __rmul__ = __add__, __mul__

    def chain(self, at: arb, every_value: arb, slope: arb):
        return Spread(at, (self.by[0] * slope, self.by[1] * slope), every_value)

    def cos(self):
        return self.chain(self.at.cos(), self.all.cos(), -self.all.sin())

    def sin(self):
        return self.chain(self.at.sin(), self.all.sin(), self.all.cos())

    def exp(self):
        return self.chain(self.at.exp(), self.all.exp(), self.all.exp())

    def __truediv__(self, o):
        if not isinstance(o, Spread):
            return self * (1 / o)
        inverse = o.chain(1 / o.at, 1 / o.all, -1 / (o.all * o.all))
        return self * inverse


def meet(a: arb, b: arb) -> arb:
    try:
        return a.intersection(b)
    except ValueError:
        return b


class Levitating:
    """Flights in the fixed frame, z = u + L e^(it), whose displacement and impulse have the real responses h0 and h1."""

    def __init__(self, m: Machine) -> None:
        self.m, self.far, self.half = m, m.far2.sqrt(), m.gamma / 2
        self.room = m.omega2 * (1 - self.far) * (1 - self.far)

    def place(self, state: tuple, t) -> tuple[Z, Z, Z]:
        """z, its rate, and L e^(it)."""
        u, v, lag = state
        shrink = (-(t * self.half)).exp()
        if self.m.w2 > 0:
            w = self.m.w2.sqrt()
            c, s = (t * w).cos(), (t * w).sin() * (1 / w)
        else:
            raise RefusedError("could not be shown: strong damping")
        h0, h1 = shrink * (c + s * self.half), shrink * s
        r0, r1 = -(shrink * s * self.m.omega2), shrink * (c - s * self.half)
        now = lag * Z(t.cos(), t.sin())
        return u * h0 + v * h1 + now, u * r0 + v * r1 + now.turned(), now

    def goes(self, state: tuple, impacts: int, struck: bool) -> bool:
        """Whether all states of a cell come back with at most so many impacts."""
        step, t = Fraction(1, 4), Fraction(0)
        while t < 400:
            z, rate, now = self.place(state, Spread(ball(t)))
            u, v = z - now, rate - now.turned()
            energy = v.norm() + u.norm() * self.m.omega2
            if (energy.all if isinstance(energy, Spread) else energy) < self.room:
                return True
            tried = self.inside(state, t, step, struck and t == 0)
            if tried:
                t += step
                step = min(step * 2, Fraction(4))
                continue
            if step > Fraction(1, 8):
                step /= 2
                continue
            strike = self.strike(state, t)
            if strike is not None:
                return impacts > 0 and self.goes(strike, impacts - 1, True)
            if step < Fraction(1, 16):
                brush = self.brush(state, t)
                if brush is not None:
                    if impacts == 0 or not self.goes(brush[1], impacts - 1, True):
                        return False
                    t, step = brush[0], Fraction(1, 4)
                    continue
            step /= 2
            if step < Fraction(1, 2**9):
                return False
        return False

    def inside(self, state: tuple, t: Fraction, step: Fraction, leaves: bool) -> bool:
        """Whether |z| < 1 on an interval of time for all states; it begins at the wall if the flights leave it."""
        half = ball(step) / 2
        middle_at = ball(t) + half
        wide = Spread(middle_at + arb(0, half))
        slope = self.climb(state, wide)
        if leaves:  # it begins with a slope of zero or less, and a falling one keeps it so
            return bool(slope < 0) or bool(self.bend(state, wide) < 0)
        return bool(self.height(state, middle_at) + slope * arb(0, half) < 0)

    def height(self, state: tuple, t) -> arb:
        """|z|^2 - 1 of all states at a time."""
        return (self.place(state, Spread(t))[0].norm() - 1).all

    def climb(self, state: tuple, t: Spread) -> arb:
        """The rate of |z|^2."""
        z, rate, _ = self.place(state, t)
        return 2 * (z.re * rate.re + z.im * rate.im).all

    def crossing(self, state: tuple, t: Fraction) -> arb | None:
        """About when the flight in the middle of a cell crosses the wall."""
        x = ball(t)
        for _ in range(30):
            slope = self.climb(state, Spread(x))
            if slope.contains(0):
                return None
            x = (x - self.height(state, x) / slope).mid()
        return x if x > ball(t) and x < ball(t) + 2 else None

    def strike(self, state: tuple, t: Fraction):
        """The state after the impact, if all flights cross the wall next after t."""
        centre = tuple(Z(Spread(v.re.at), Spread(v.im.at)) for v in state)
        x = self.crossing(centre, t)
        if x is None:
            return None
        near = [x + arb("1e-18") * sign for sign in (-1, 1)]
        if not (self.height(centre, near[0]) < 0 and self.height(centre, near[1]) > 0):
            return None
        x = near[0].union(near[1])
        size = self.place(state, Spread(x))[0].norm()
        width = (abs(size.by[0]) + abs(size.by[1])) / abs(self.climb(centre, Spread(x))) * arb("1.3")
        first, last = (
            Fraction(float((x - width).lower())) - Fraction(1, 2**40),
            Fraction(float((x + width).upper())) + Fraction(1, 2**40),
        )
        box = Spread(ball(first + last) / 2 + arb(0, ball(last - first) / 2))
        z, rate, _ = self.place(state, box)
        climb = 2 * (z.re * rate.re + z.im * rate.im).all
        # Each flight crosses once in the box of times, which holds the derivative of that time by the shares.
        if not (climb > 0 and self.height(state, ball(last)) > 0):
            return None
        if first > t and not (self.height(state, ball(first)) < 0 and self.clear(state, t, first)):
            return None
        by = tuple(-g / climb for g in z.norm().by)
        return self.after(state, Spread(x, by, box.all), None)

    def after(self, state: tuple, t: Spread, radial: Spread | None):
        """The state after an impact at this time, in the plane turned so that it is at 1."""
        z, rate, now = self.place(state, t)
        rate, now, m = rate * z.conj(), now * z.conj(), self.m
        if radial is None:
            radial = rate.re
            if not radial.all > 0:
                return None
        bite = radial * (m.mu * (1 + m.d))
        if not (rate.im - bite).all + m.s > 0:
            return None
        return -now + 1, Z(-(radial * m.d), rate.im - bite) - now.turned(), now

    def clear(self, state: tuple, low: Fraction, high: Fraction) -> bool:
        """Whether |z| < 1 on an interval of time."""
        stack = [(low, high)]
        while stack:
            a, b = stack.pop()
            if self.inside(state, a, b - a, False):
                continue
            if b - a < (high - low) / 2**12:
                return False
            stack += [(a, (a + b) / 2), ((a + b) / 2, b)]
        return True

    def bend(self, state: tuple, t) -> arb:
        """The second derivative of |z|^2."""
        z, rate, now = self.place(state, t)
        push = -(rate - now.turned()) * self.m.gamma - (z - now) * self.m.omega2 - now
        return 2 * (rate.norm() + z.re * push.re + z.im * push.im).all

    def brush(self, state: tuple, t: Fraction):
        """A time after a graze, and the states of the flights that touch, after their impact.

        While |z|^2 is concave, less than 1 at the ends, and falls from a time on, a flight touches before that time first; it then rises by at
        least (2a)^2/(2C), a the radial speed and C the bound of the second derivative.
        """
        x = ball(t)
        centre = tuple(Z(Spread(v.re.at), Spread(v.im.at)) for v in state)
        for _ in range(12):
            bend = self.bend(centre, Spread(x))
            if not bend < 0:
                return None
            x = (x - self.climb(centre, Spread(x)) / bend).mid()
        if not (x > ball(t) and x < ball(t) + 2):
            return None
        top = Fraction(float(x))
        climb = self.climb(state, Spread(ball(top)))
        falls = top + Fraction(float((abs(climb) / abs(bend) * arb("1.4")).upper())) + Fraction(1, 2**20)
        end = max(2 * top - t, falls + Fraction(1, 2**20))
        bend = self.bend(state, Spread(ball(t + end) / 2 + arb(0, ball(end - t) / 2)))
        if not (bend < 0 and self.climb(state, Spread(ball(falls))) < 0 and self.height(state, ball(end)) < 0):
            return None
        highest = abs(
            self.height(state, ball(top)) + abs(climb) * ball(falls - t)
        )  # a concave function is below its tangent at the top
        most = (abs(bend).upper() * highest.upper() / 2).sqrt().upper()
        touched = self.after(
            state, Spread(ball(t + falls) / 2 + arb(0, ball(falls - t) / 2)), Spread(most / 2 + arb(0, most / 2))
        )
        return None if touched is None else (end, touched)


def kick_state(levitating: Levitating, speeds: tuple, angles: tuple) -> tuple:
    """The kicks of a cell along the real axis, levitation being turned instead."""
    v = Spread(speeds[0], (speeds[1], arb(0)))
    a = Spread(angles[0], (arb(0), angles[1]))
    zero = Spread(arb(0))
    return Z(zero, zero), Z(v, zero), Z(a.cos() * levitating.far, -(a.sin() * levitating.far))


def share_followed(m: Machine, scaled: Exact, cells_of: list) -> Fraction:
    """The share of the disc whose kicks are all followed and come back in time: cells, the largest first, and parts of them."""
    flights, shown = Levitating(m), Fraction(0)
    stack = [(*cell, 0) for cell in cells_of if impacts_of(cell[0]) is not None]
    stack.sort(key=lambda cell: (cell[2] ** 2 - cell[1] ** 2) * (cell[4] - cell[3]))
    largest, keep = scaled.ball(), ctx.prec
    ctx.prec = 96
    for _ in range(MOST_PARTS):
        if not stack:
            break
        letter, low, high, first, last, depth = stack.pop()
        speeds = (largest * ball((low + high) / 2), largest * ball((high - low) / 2))
        angles = (2 * arb.pi() * ball((first + last) / 2), 2 * arb.pi() * ball((last - first) / 2))
        try:
            if flights.goes(kick_state(flights, speeds, angles), impacts_of(letter) or 0, False):
                shown += (high * high - low * low) * (last - first)
                continue
        except (RefusedError, ZeroDivisionError):
            pass
        if depth == 8:
            continue
        middle_speed, middle_angle = (low + high) / 2, (first + last) / 2
        if speeds[1] > angles[1] * flights.far * m.omega2.sqrt():
            parts = [(low, middle_speed, first, last), (middle_speed, high, first, last)]
        else:
            parts = [(low, high, first, middle_angle), (low, high, middle_angle, last)]
        stack += [(letter, *part, depth + 1) for part in parts]
    ctx.prec = keep
    return shown


class Kind(NamedTuple):
    """What a theorem about discs is about: names, statements up to the largest size, and dimensions."""

    option: str
    size: str
    stated: str
    smaller: str
    units: tuple[str, ...]


DISCS = {
    "kicks": Kind(
        "kicks_up_to",
        "speed",
        "kicks out of levitation, seen in the fixed frame, with velocities in the disc up to",
        "kick slower than the lower end of speed",
        ("m/s",),
    ),
    "shocks": Kind(
        "shocks_up_to",
        "peak",
        "half-sine shocks of the base out of levitation, in any direction, with a peak up to, and a duration of,",
        "shock with a peak below the lower end of peak",
        ("m/s^2",),
    ),
    "unbalance steps": Kind(
        "unbalance_up_to",
        "change",
        "steps to the unbalance of the machine, out of levitation with another one, with changes in the disc up to",
        "step by less than the lower end of change",
        ("m", "kg m"),
    ),
}


def disc_of(kind: Kind, text: str, hypotheses: dict) -> tuple[Exact, Exact, object]:
    """The largest size in SI units and without dimension, and how a size becomes a start."""
    size, _, lasts = text.partition(",")
    physical = hypotheses["table"] == "machine"
    si = si_values(hypotheses) if physical else {}
    scale = {
        "m/s": ("clearance", "speed"),
        "m/s^2": ("clearance", "speed", "speed"),
        "m": ("clearance",),
        "kg m": ("clearance", "mass"),
    }
    units = kind.units if physical else ("",)
    unit = units[-1]
    for other in units[:-1]:
        try:
            quantity(size.strip(), other)
        except RefusedError:
            continue
        unit = other
    size, factor = size.strip(), Exact(1)
    if unit == "m/s^2" and re.fullmatch(r".*[\d ]g", size):
        size, factor = size[:-1].strip() + " m/s^2", Exact("9.80665")
    largest = quantity(size, unit) * factor
    scaled = largest
    for name in scale.get(unit, ()):
        scaled = scaled / si[name]
    if kind.option == "shocks_up_to":
        duration = quantity(lasts.strip(), "s" if physical else "")
        start = shaken((duration * si["speed"] if physical else duration).ball())
    else:
        start = kicked if kind.option == "kicks_up_to" else stepped
    return largest, scaled, start


def areas(cells_of: list) -> dict[str, Fraction]:
    """The shares of the disc whose cells are proven to return, refuted and open."""
    area = dict.fromkeys(("proven", "refuted", "open"), Fraction(0))
    for letter, low, high, first, last in cells_of:
        known = "proven" if impacts_of(letter) is not None else "refuted" if letter == "r" else "open"
        area[known] += (high * high - low * low) * (last - first)
    return area


def check_kicks(document: dict, exact: dict[str, Exact], report: Report) -> None:
    """The shares follow from the cells, and in the middle of each of the largest cells one is followed."""
    options, hypotheses, m = document["options"], document["hypotheses"], Machine.of(exact)
    about, kind = document["theorem"], DISCS[document["theorem"]]
    letters = document["evidence"].get("cells") if isinstance(document["evidence"], dict) else None
    if not isinstance(letters, str):
        raise RefusedError("there is no tree of cells")
    cells_of = leaves_of(letters)
    largest, scaled, start = disc_of(kind, options[kind.option], hypotheses)
    area = areas(cells_of)
    safe = min((low for letter, low, *_ in cells_of if impacts_of(letter) is None), default=Fraction(1))
    most = max((impacts_of(letter) or 0 for letter, *_ in cells_of), default=0)
    numbers = {
        kind.size: (scaled * Exact(safe)).ball(),
        "share_proven": area["proven"],
        "share_refuted": area["refuted"],
        "share_open": area["open"],
        "impacts": Fraction(most),
    }
    if hypotheses["table"] == "machine":
        numbers[f"{kind.size}_si"] = largest.rational * safe
    given = re.escape(f"{kind.stated} {options[kind.option]}")
    patterns = {
        "recover": rf"Of {given}, the share share_proven of the area returns to levitation with at most so many impacts, among them every {kind.smaller}\.",
        "all recover": rf"All {given}, return to levitation with at most (\d+) impacts?\.",
        "do not recover": rf"Of {given}, the share share_refuted of the area never returns to levitation: after bounces the rotor stays on the wall and "
        r"decays to the synchronous rub of the larger normal force\.",
    }

    def decide(claim: dict) -> str:
        pattern = patterns.get(claim["kind"]) if claim["about"] == about else None
        if pattern is None:
            return "not covered|this program does not decide such claims"
        match = re.fullmatch(pattern, claim["statement"])
        if not match:
            raise RefusedError("its statement is not known to this program")
        if claim["kind"] == "all recover":
            stands = "refuted" if area["refuted"] else "undecided" if area["open"] else "proven"
            if claim["status"] != stands or (stands == "proven" and int(match[1]) < most):
                raise RefusedError("it does not follow from the cells")
        if claim["status"] == "undecided":
            return "claims nothing"
        lost = f"{lost_followed(m, scaled, cells_of, start)} in the middle of refuted cells strike on"
        if claim["kind"] == "do not recover":
            if not area["refuted"]:
                raise RefusedError("it does not follow from the cells")
            judge(claim, Fact(claim["statement"], True, {"share_refuted": area["refuted"]}))
            return f"not covered|its share follows from the cells; {lost}"
        if claim["status"] == "refuted":
            return f"not covered|there are refuted cells; {lost}"
        judge(claim, Fact(claim["statement"], True, numbers if claim["kind"] == "recover" else {}))
        flown = kicks_followed(m, scaled, cells_of, start)
        if about != "kicks":
            return f"not covered|its shares follow from the cells; {flown} in the middle of cells return"
        shown = share_followed(m, scaled, cells_of)
        if shown == area["proven"]:
            return "checked"
        return f"not covered|its shares follow from the cells; {flown} kicks in the middle of cells return, and all kicks of {float(shown):.6f} of the disc"

    report.each(document["claims"], decide)
    needed = [(about, given) for given in patterns if given != "do not recover" or area["refuted"]]
    refuse_missing(dict.fromkeys(needed), document["claims"], report)


BOX_KICKS = (
    r"Of kicks out of levitation, seen in the fixed frame, with velocities in the disc up to (.+), and of the values (.+), area of the disc times widths of the "
    r"intervals, the share share_proven returns to levitation with at most so many impacts, among them, for all these values, every kick slower than the "
    r"lower end of speed\."
)
KICKS_TOLD = r"all kicks out of levitation, seen in the fixed frame, with velocities in the disc up to (.+), return to levitation with at most (\d+) impacts?\."
SLOWER = r"every kick out of levitation, seen in the fixed frame, slower than the lower end of speed returns to levitation with at most (\d+) impacts?\."


class Box:
    """Some parameters of a machine, each in an interval, and the cells of kicks and of these."""

    def __init__(self, document: dict, exact: dict[str, Exact]) -> None:
        options, self.hypotheses = document["options"], document["hypotheses"]
        self.exact, self.si = exact, self.hypotheses["table"] == "machine"
        self.entries = options["box"]
        names = [name for name, *_ in self.entries]
        known = {**dict.fromkeys(DIMENSIONLESS, ""), **(MACHINE if self.si else {})}
        if not 1 <= len(names) <= 3 or len(set(names)) < len(names):
            raise RefusedError("its box has no parameter, too many, or one twice")
        if any(name not in known for name in names) or (self.si and self.hypotheses["settings"]):
            raise RefusedError("not covered|along such a parameter")
        if {"phi", "unbalance_phase"} & set(names):
            raise RefusedError("its box has a parameter that changes nothing")
        self.ends = [[quantity(end, known[name]) for end in ends] for name, *ends in self.entries]
        if any(low.power != high.power or low.rational > high.rational for low, high in self.ends):
            raise RefusedError("an interval of its box ends before it begins")
        self.largest = quantity(options["kicks_up_to"], "m/s" if self.si else "")
        self.cells = leaves_of(document["evidence"]["cells"], len(names))

    def width(self, cell: tuple) -> Fraction:
        """The share of the box that a cell has."""
        total = Fraction(1)
        for low, high in zip(cell[5::2], cell[6::2], strict=True):
            total *= high - low
        return total

    def area(self, closed: bool) -> Fraction:
        """The share of disc and box that is proven, or open."""
        chosen = (cell for cell in self.cells if (impacts_of(cell[0]) is not None) == closed)
        return sum(((c[2] ** 2 - c[1] ** 2) * (c[4] - c[3]) * self.width(c) for c in chosen), Fraction(0))

    def at(self, shares: list[Fraction]) -> tuple[Machine, arb]:
        """A machine of the box, and the largest speed for it."""
        values = {
            name: (low.rational + (high.rational - low.rational) * share, low.power or high.power)
            for (name, *_), (low, high), share in zip(self.entries, self.ends, shares, strict=True)
        }
        moved = {name: Exact(*value) for name, value in values.items()}
        hypotheses = {key: dict(value) if isinstance(value, dict) else value for key, value in self.hypotheses.items()}
        if not self.si:
            exact = {**self.exact, **{name: value for name, value in moved.items() if name != "omega"}}
            if "omega" in moved:
                exact["omega_squared"] = moved["omega"] * moved["omega"]
            return Machine.of(exact), self.largest.ball()
        v = {"unbalance_phase": Exact(0), **si_values(hypotheses), **{k: x for k, x in moved.items() if k in MACHINE}}
        momentum = v["mass"] * v["speed"]
        exact = {
            "gamma": v["damping"] / momentum,
            "omega_squared": v["stiffness"] / (momentum * v["speed"]),
            "rho": v["eccentricity"] / v["clearance"],
            "mu": v["friction"],
            "d": v["restitution"],
            "radius_ratio": v["rotor_radius"] / v["clearance"],
            "phi": v["unbalance_phase"],
        } | {k: x for k, x in moved.items() if k in DIMENSIONLESS and k != "omega"}
        if "omega" in moved:
            exact["omega_squared"] = moved["omega"] * moved["omega"]
        return Machine.of(exact), (self.largest / (v["clearance"] * v["speed"])).ball()

    def flown(self) -> int:
        """How many kicks, in the middle of cells and of their machines, are seen to return with at most as many impacts as their cells may have."""
        closed = [cell for cell in self.cells if impacts_of(cell[0]) is not None]
        closed.sort(key=lambda c: (c[1] ** 2 - c[2] ** 2) * (c[4] - c[3]) * self.width(c))
        count = 0
        for letter, low, high, first, last, *ends in closed[:MOST_FLIGHTS]:
            bound = impacts_of(letter) or 0
            m, largest = self.at([(a + b) / 2 for a, b in zip(ends[::2], ends[1::2], strict=True)])
            try:
                direction = turn(2 * arb.pi() * ball((first + last) / 2))
                found = impacts_after(m, *kicked(m, largest * ball((low + high) / 2), direction), bound)
            except RefusedError:
                found = None
            if found is not None and found > bound:
                raise RefusedError(f"the kick in the middle of a cell has more than {bound} impacts")
            count += found is not None
        return count

    def overlapping(self, intervals: list[tuple[Fraction, Fraction]]) -> list[tuple]:
        """Cells that share more than an end with intervals of the first parameter, given in its SI unit."""
        low, high = (end.rational for end in self.ends[0])
        return [
            cell
            for cell in self.cells
            if any(low + (high - low) * cell[5] < b and a < low + (high - low) * cell[6] for a, b in intervals)
        ]


def intervals_of(text: str, name: str) -> list[tuple[Fraction, Fraction]]:
    """Intervals of a parameter in a statement."""
    found = []
    for part in text.split(" or "):
        match = re.fullmatch(rf"{re.escape(name)} in \[(\S+), (\S+)\](?: .+)?", part)
        if not match:
            raise RefusedError("an interval of a statement is not known to this program")
        found.append((Fraction(match[1]), Fraction(match[2])))
    return found


def check_box_kicks(document: dict, exact: dict[str, Exact], report: Report) -> None:
    """The shares, intervals and speeds follow from the cells, and in the middle of each of the largest one kick is followed."""
    try:
        box, text = Box(document, exact), document["options"]["kicks_up_to"]
    except RefusedError as problem:
        verdict, _, why = str(problem).partition("|")
        if not why:
            raise
        report.each(document["claims"], lambda claim: f"{verdict}|{why}")
        return
    words = " and ".join(f"{low} <= {name} <= {high}" for name, low, high in box.entries)
    flown = box.flown()
    why = f"not covered|it follows from the cells; {flown} kicks in the middle of cells return"

    def agrees(cells_of: list[tuple], slower: Fraction, most: str) -> None:
        """All these cells, as far as they hold slower kicks, are closed with at most so many impacts."""
        for cell in cells_of:
            impacts = impacts_of(cell[0])
            if cell[1] < slower and (impacts is None or impacts > int(most)):
                raise RefusedError("it does not follow from the cells")

    def decide(claim: dict) -> str:
        statement, kind, proven = claim["statement"], claim["kind"], claim["status"] == "proven"
        if kind == "recover" and claim["about"] == "kicks":
            match = re.fullmatch(BOX_KICKS, statement)
            if not match or (match[1], match[2]) != (text, words):
                raise RefusedError("its statement is not known to this program")
            safe = min((cell[1] for cell in box.cells if impacts_of(cell[0]) is None), default=Fraction(1))
            most = max((impacts_of(cell[0]) or 0 for cell in box.cells), default=0)
            wanted = {
                "share_proven": box.area(True),
                "share_refuted": Fraction(0),
                "share_open": box.area(False),
                "impacts": Fraction(most),
            }
            wanted |= {"speed_si": box.largest.rational * safe} if box.si else {}
            stated = numbers_of(claim)
            for name, number in wanted.items():
                holds(stated[name], number)
            return why if proven else "claims nothing"
        if not proven:
            return "claims nothing"
        match = re.fullmatch(rf"For all (.+?)[,:] {KICKS_TOLD}", statement)
        if match and match[2] == text and match[1] == words:
            agrees(box.cells, Fraction(1), match[3])
            return why
        slow = re.fullmatch(rf"For all (.+): {SLOWER}", statement)
        if (
            len(box.entries) > 1
            or not (slow or (match and match[2] == text))
            or box.ends[0][0].power
            or box.ends[0][1].power
        ):
            return "not covered|this program does not decide such claims"
        where = intervals_of((slow or match)[1], box.entries[0][0])
        if slow:
            name = "speed_si" if box.si else "speed"
            speed = numbers_of(claim)[name][0] / box.largest.rational
            agrees(box.overlapping(where), speed, slow[2])
        else:
            agrees(box.overlapping(where), Fraction(1), match[3])
        return why

    report.each(document["claims"], decide)


def check_states(document: dict, exact: dict[str, Exact], report: Report) -> None:
    """All states up to a speed are shown by forms, which this program does not know."""
    report.each(
        document["claims"],
        lambda claim: "claims nothing" if claim["status"] == "undecided" else "not covered|all states up to a speed",
    )


THEOREMS = {
    "states": check_states,
    "single-impact orbits": check_machine,
    "orbits of several impacts": check_machine,
    "along a parameter": check_along,
    **dict.fromkeys(DISCS, check_kicks),
    "kicks of a box of machines": check_box_kicks,
}

# What each theorem may claim, as "about: kind"; its options; and what a reader may expect that it does not claim.
_STEADY = "levitation: (inside|stable)", r"rub \d+: (solution|pressed|attracts sliding)"
_WHIRL = ("whirl: (rolls|attracts sliding|absent|absent below)",)
_SINGLE = (
    *_STEADY,
    *_WHIRL,
    "machine: (periods|slip|orbits)",
    "kick: harmless",
    r"B\d+,\S+: (solution|outward|inside|slip|admissible|stable)",
)
_ALONG = (
    "(fold|speed-fold|period-doubling|neimark-sacker|grazing|slip-stop|non-smooth-hopf|boundary-equilibrium|rub-fold): of .+",
    r"\S+ in \[\S+, \S+\]: orbits",
    r"B\d+,[a-d]: (exists|admissible|stable)",
    "machine: (slip|all-single-impact-orbits)",
    "levitation: inside",
    "rub [12]: (pressed|attracts sliding)",
    "whirl: (rolls|absent)",
    "kick: harmless( outside of gaps)?",
)
_KICKS = "(recover|all recover|do not recover)"
_NO_BASINS = (
    "which disturbances lead to an orbit or to levitation: basins, and recovery from kicks above the contact-free speed"
)
_DISC_LEAVES_OUT = (
    "whether the open cases return (the search states why they are open)",
    "that as many impacts occur as stated: these are upper bounds",
    "anything about larger sizes, starts other than levitation, or compliant walls",
)


class Form(NamedTuple):
    """What certificates of a theorem look like."""

    names: tuple[str, ...]
    options: tuple[str, ...]
    not_claimed: tuple[str, ...]


FORMS = {
    "states": Form(
        ("states: (recover|lost|all recover)",),
        ("states_up_to",),
        (
            "that states faster than the speed that is shown do not return, but for those that are named",
            "how many impacts occur, how hard they are, or how long recovery takes",
            "anything about a rotor with weight, of compliant walls, or of a shaft whose speed changes",
        ),
    ),
    "single-impact orbits": Form(
        _SINGLE,
        ("longest_period", "cells"),
        (
            "that there are no orbits with several impacts a period, with impacts and lasting contact, or irregular motions",
            _NO_BASINS,
            "which disturbances end in a rub",
            "whether other sliding or whirling motions repeat, or whether there is whirl with bounces",
        ),
    ),
    "orbits of several impacts": Form(
        (*_SINGLE, r"orbit \d+: (exists|admissible|stable)"),
        ("longest_period", "cells", "impacts"),
        (
            "that there are no other orbits with two or more impacts a period: those listed are what a search found",
            "that there are no orbits with lasting contact or with impacts that stop the slip, and no irregular motions",
            _NO_BASINS,
        ),
    ),
    "along a parameter": Form(
        _ALONG,
        ("along", "from", "to", "blocks", "narrowest"),
        (
            "what is stated as open on an interval, except for the points listed there",
            "that there are no other bifurcation points there: those listed are what a search in double precision found",
            "that the orbit at a point has the name it is listed by",
            "that there are no orbits with several impacts a period, with lasting contact, or irregular motions",
            "which disturbances lead to an orbit or to levitation: basins, and recovery from kicks",
        ),
    ),
    **{
        about: Form((f"{about}: {_KICKS}",), (kind.option, "most_impacts"), _DISC_LEAVES_OUT)
        for about, kind in DISCS.items()
    },
    "kicks of a box of machines": Form(
        (f"kicks: {_KICKS}", "kicks, .+: recover"),
        ("kicks_up_to", "most_impacts", "box"),
        (
            *_DISC_LEAVES_OUT,
            "anything about machines with parameters outside the intervals, or with parameters that vary during the motion",
        ),
    ),
}


def refuse_unknown(document: dict) -> None:
    """Refuse options, claims, and lists of what is not claimed, that certificates of the theorem do not have."""
    form = FORMS[document["theorem"]]
    if not isinstance(document["options"], dict) or sorted(document["options"]) != sorted(form.options):
        raise RefusedError(f"the options must be {', '.join(form.options)}")
    if document["not_claimed"] != list(form.not_claimed):
        raise RefusedError("what it says is not claimed is not what this theorem leaves out")
    for claim in document["claims"]:
        name = f"{claim['about']}: {claim['kind']}"
        if not any(re.fullmatch(known, name) for known in form.names):
            raise RefusedError(f"there is no such claim: {name}")


def main(arguments: list[str]) -> int:
    if len(arguments) != 1 or arguments[0] in ("-h", "--help"):
        print(__doc__)
        return int(len(arguments) != 1)
    try:
        report = check(Path(arguments[0]).read_text(encoding="utf-8"))
    except (RefusedError, OSError, UnicodeDecodeError) as problem:
        print(f"refused: {problem}")
        return 1
    except (TypeError, AttributeError, LookupError, ValueError, ArithmeticError) as problem:
        print(f"refused: it is not written as certificates are ({problem})")
        return 1
    for verdict, what, why in report.lines:
        print(f"{verdict:14} {what}{f' ({why})' if why else ''}")
    counts = Counter(verdict for verdict, _, _ in report.lines)
    print(", ".join(f"{number} {verdict}" for verdict, number in sorted(counts.items())))
    if report.refused:
        print("The certificate is refused.")
        return 1
    if counts["not covered"]:
        print(
            f"Not the whole certificate is confirmed: {counts['not covered']} claims are not covered by this program."
        )
        return 3
    print("Everything that it claims is confirmed.")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
