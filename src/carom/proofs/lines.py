"""Machines that differ in one number or several: their dimensionless numbers as functions of it, for balls and power series.

And the parts of an interval of a parameter on which something holds, does not hold or is open, as a claim and in decimal numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import groupby
from math import ceil, floor
from typing import Any, Generic

from flint import arb, arb_series

from carom.base.outcome import InputError
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, TERM_FIELDS, TERMS, Field
from carom.parameters.fields import unknown_name
from carom.parameters.quantities import read_exact
from carom.parameters.terms import ENTRIES
from carom.proofs.balls import Ball, ComplexBall, Enclosure, I, N, ball_of, exact_ends, hyperbolic, interval
from carom.proofs.claims import Claim, Status
from carom.proofs.hypotheses import NUMBERS, Hypotheses, dimensionless_of


@dataclass(frozen=True)
class LineNumbers(Generic[N]):
    """The numbers of the equations: balls or power series of balls, among which what does not depend on the parameter may be a ball.

    With ``S = −γ − 2i``, ``P = ω² − 1 + iγ`` and the real ``D = S²/4 − P = γ²/4 − ω²``, a flight changes position and velocity
    relative to the contact-free equilibrium by

        [[e − S/2 o, o], [−P o, e + S/2 o]],      e = e^{St/2} cosh(√D t),      o = e^{St/2} sinh(√D t)/√D .
    """

    gamma: N
    omega_squared: N | arb
    rho: N | arb
    mu: N | arb
    d: N | arb
    radius_ratio: N | arb

    @property
    def half(self) -> Any:
        """``S/2``."""
        return self.gamma * -0.5 - I

    @property
    def split(self) -> N:
        """``D``, negative below critical damping."""
        return self.gamma * self.gamma * 0.25 - self.omega_squared

    @property
    def product(self) -> Any:
        """``P``, the stiffness in the co-rotating frame."""
        return self.omega_squared - 1 + self.gamma * I

    @property
    def q(self) -> Any:
        """``(1 + d)(1 + iμ)``: what an impact takes away of the velocity, over its radial speed."""
        return (1 + self.d) * (1 + self.mu * I)

    @property
    def levitation(self: LineNumbers[arb]) -> arb:
        """``|U*|``, of balls."""
        return self.rho / abs(self.product)

    def flight(self, time: Ball) -> tuple[ComplexBall, ComplexBall, ComplexBall]:
        """``e``, ``o`` and ``e^{St/2}`` at a time."""
        even, odd = hyperbolic(self.split, time)
        growth = (self.half * time).exp()
        return even * growth, odd * growth, growth

    def fly(self, away: ComplexBall, velocity: ComplexBall, time: Ball) -> tuple[ComplexBall, ComplexBall]:
        """Distance from the contact-free equilibrium, and velocity, after a time."""
        even, odd, _ = self.flight(time)
        share = odd * self.half
        return (even - share) * away + odd * velocity, (even + share) * velocity - odd * away * self.product


class Machines:
    """Machines that differ in some parameters, the other numbers those of the hypotheses, at the precision of their first use.

    Parameters
    ----------
    hypotheses : Hypotheses
    """

    def __init__(self, hypotheses: Hypotheses) -> None:
        self.hypotheses = hypotheses

    def at(self, moved: Mapping[str, Any]) -> LineNumbers[Any]:
        """Numbers at values of some parameters, by their names: balls or power series."""
        found: dict[str, Any] = dict(self._balls)
        machine = {name: value for name, value in moved.items() if name not in DIMENSIONLESS_FIELDS}
        if machine:
            set_ = {"omega_squared" if name == "omega" else name for name in self.hypotheses.settings} & set(NUMBERS)
            found |= {**dimensionless_of(self.table(machine)), **{name: found[name] for name in set_}}
        found |= {name: value for name, value in moved.items() if name in DIMENSIONLESS_FIELDS and name != "omega"}
        if "omega" in moved:
            found["omega_squared"] = moved["omega"] * moved["omega"]
        for value in moved.values():
            if isinstance(value, arb_series):
                # What does not depend on the parameter is a power series too.
                found["gamma"] = found["gamma"] + value * 0
        return LineNumbers(*(found[name] for name in NUMBERS))

    def table(self, moved: Mapping[str, Any]) -> dict[str, Any]:
        """The machine's table in SI units with other values of some entries: fields, or terms that set them."""
        found: dict[str, Any] = {**self._machine, **{name: value for name, value in moved.items() if name not in TERMS}}
        terms = [name for name in moved if name in TERMS]
        # What sets the mass or the stiffness comes before what needs them.
        for name in sorted(terms, key=lambda name: TERMS[name].sets == "damping"):
            term = TERMS[name]
            found[term.sets] = term.value(moved[name], *(found[need] for need in term.needs))
        return found

    @cached_property
    def _balls(self) -> dict[str, arb]:
        return {name: ball_of(self.hypotheses.numbers[name]) for name in NUMBERS}

    @cached_property
    def _machine(self) -> dict[str, arb]:
        given = {**self.hypotheses.values, **self.hypotheses.helpers}
        return {name: ball_of(read_exact(ENTRIES[name], text)) for name, text in given.items()}


@dataclass(frozen=True)
class Line:
    """All machines whose parameter lies in an interval, the other numbers those of the hypotheses, at the precision of their first use.

    Attributes
    ----------
    hypotheses : Hypotheses
    name : str
        Dimensionless, physical, or a term of the machine's file.
    start, stop : str
        Ends of the interval as they were given.
    """

    hypotheses: Hypotheses
    name: str
    start: str
    stop: str

    @property
    def field(self) -> Field:
        """Field of the parameter."""
        return DIMENSIONLESS_FIELDS.get(self.name) or ENTRIES[self.name]

    @cached_property
    def ends(self) -> tuple[Fraction, Fraction]:
        """Both ends; rounded outward where they are multiples of a power of π."""
        start, stop = read_exact(self.field, self.start), read_exact(self.field, self.stop)
        low = start.low if not start.turns else exact_ends(ball_of(start))[0]
        return low, stop.high if not stop.turns else exact_ends(ball_of(stop))[1]

    @property
    def ball(self) -> arb:
        """Ball of all values."""
        return interval(*self.ends)

    @property
    def words(self) -> str:
        """The interval in words."""
        return f"{self.start} <= {self.name} <= {self.stop}"

    def at(self, value: N) -> LineNumbers[N]:
        """Numbers at a value of the parameter: a ball or a power series."""
        return self._machines.at({self.name: value})

    def table(self, value: arb) -> dict[str, arb]:
        """The machine's table in SI units at a value of the parameter; that of the file for a dimensionless one."""
        return self._machines.table({} if self.name in DIMENSIONLESS_FIELDS else {self.name: value})

    @cached_property
    def _machines(self) -> Machines:
        return Machines(self.hypotheses)


def line_of(hypotheses: Hypotheses, name: str, start: str, stop: str) -> Line:
    """Machines along one parameter, dimensionless or of the machine's table, between two ends given as text.

    The hypotheses' own value of the parameter does not matter.  A parameter that is unknown or changes nothing is refused, and so
    is an empty interval.
    """
    known = {**DIMENSIONLESS_FIELDS, **({**MACHINE_FIELDS, **TERM_FIELDS} if hypotheses.table == "machine" else {})}
    if name not in known:
        raise unknown_name(name, f"{start} to {stop}", known, "parameter")
    if name in TERMS:
        missing = [need for need in TERMS[name].needs if need not in {**hypotheses.values, **hypotheses.helpers}]
        if missing:
            allowed = f"is {TERMS[name].sets} = {TERMS[name].formula}; the machine file gives no {', '.join(missing)}"
            raise InputError("parameter", name, allowed)
    if name in ("phi", "unbalance_phase"):
        raise InputError("parameter", name, "only turns motions: no claim depends on it")
    for end in (start, stop):
        if end.strip().startswith("["):
            raise InputError(name, end, "an end must be one number")
    line = Line(hypotheses, name, start, stop)
    low, high = line.ends
    if not low <= high:
        raise InputError(name, f"{start} to {stop}", "the interval must begin below its end")
    return line


Runs = Mapping[bool | None, Sequence[tuple[Fraction, Fraction]]]
"""Parts on which something holds, on which the contrary does, and on which it is open (``None``)."""

_HALVINGS = 12
"""How often a part is halved before it is left open."""


def runs_along(line: Line, holds: Callable[[LineNumbers[arb]], bool | None]) -> Runs:
    """Parts of a line by what holds on them, neighbours put together: it is halved until that is decided for all values of a part."""
    runs: dict[bool | None, list[tuple[Fraction, Fraction]]] = {True: [], False: [], None: []}
    for value, group in groupby(_parts(line, holds, *line.ends, _HALVINGS), key=lambda part: part[0]):
        parts = list(group)
        runs[value].append((parts[0][1], parts[-1][2]))
    return runs


def _parts(
    line: Line, holds: Callable[[LineNumbers[arb]], bool | None], low: Fraction, high: Fraction, halvings: int
) -> Iterator[tuple[bool | None, Fraction, Fraction]]:
    value = holds(line.at(interval(low, high)))
    if value is not None or not halvings or low == high:
        yield value, low, high
        return
    middle = (low + high) / 2
    yield from _parts(line, holds, low, middle, halvings - 1)
    yield from _parts(line, holds, middle, high, halvings - 1)


def claim_of_runs(about: str, kind: str, statement: str, runs: Runs) -> Claim:
    """Claim about a whole interval, with the longest part on which it is shown."""
    where = {
        value: ", ".join(in_brackets(written(*run, inward=value is not None)) for run in found)
        for value, found in runs.items()
    }
    enclosures: dict[str, Enclosure] = {}
    if runs[True]:
        ends = written(*max(runs[True], key=lambda run: run[1] - run[0]), inward=True)
        enclosures = {
            side: Enclosure(end, end, (Fraction(end),) * 2) for side, end in zip(("from", "to"), ends, strict=True)
        }
    headings = {True: "shown on", False: "the contrary on", None: "open on"}
    reason = "; ".join(f"{stated} {where[value]}" for value, stated in headings.items() if where[value])
    status: Status = "refuted" if runs[False] else "undecided" if runs[None] else "proven"
    return Claim(about, kind, statement, status, "" if status == "proven" else reason, enclosures)


def written(low: Fraction, high: Fraction, *, inward: bool) -> tuple[str, str]:
    """Both ends as decimal numbers, rounded inward or outward."""
    return _decimal(low, inward), _decimal(high, not inward)


def in_brackets(ends: tuple[str, str]) -> str:
    """An interval in words: ``"[0.1, 0.2]"``."""
    return f"[{', '.join(ends)}]"


def _decimal(value: Fraction, upward: bool) -> str:
    """Decimal number of 12 places on one side of a number."""
    scale = 10**12
    scaled = ceil(value * scale) if upward else floor(value * scale)
    whole, places = divmod(abs(scaled), scale)
    return f"{'-' if scaled < 0 else ''}{whole}.{places:012d}".rstrip("0").rstrip(".")
