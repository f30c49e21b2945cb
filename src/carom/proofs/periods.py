"""All roots of ``F₁``: the periods of orbits with one impact a period whose slip stays forward.

**Far out there is none.**  Let ``γ > 0`` and ``r`` be the decay of the slower mode.  With :mod:`carom.proofs.rotor`,
``|f'| ≤ e^{−rT}(1 + |γ/2 + i|T)``, since ``|cosh x| ≤ e^{|Re x|}`` and ``|sinh x / x| ≤ e^{|Re x|}``.  Away from critical
damping ``f' = (λ₊e^{λ₊T} − λ₋e^{λ₋T})/√Δ`` gives ``|f'| ≤ e^{−rT}(|λ₊| + |λ₋|)/|√Δ|`` too.  With ``|δ| ≤ e^{−2rT}`` and
``|D| ≥ (1 − e^{−rT})²``, ``F₁ ≥ 1 − |q|(|f'| + |δ|)/|D|``, and either bound rises with ``T`` where ``rT ≥ 1``.

**Next to zero** ``F₁ = (1 − d)/2 + (1 + d)(γ − 2μ)T/12 + O(T³)`` and ``P = |χ|²T⁴(1 + O(T))F₁``: the first coefficient that
is not zero decides.

**In between** the cells of :mod:`carom.proofs.zeros` tile the interval.  On each, ``P`` keeps its sign or is monotone, and
then its signs at the ends count its zeros.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, floor

from flint import acb, arb, arb_series

from carom.proofs.balls import I, exact_ends, interval, terms
from carom.proofs.claims import Evidence, NotShownError, rational_of
from carom.proofs.courses import entire_condition, numerator_and_gap
from carom.proofs.lines import LineNumbers
from carom.proofs.rotor import ProvenRotor
from carom.proofs.zeros import OPEN, Analytic, CellTree, cells_of, power_of_two_below, runs_of, show

SHORTEST_CELL = 200
"""Binary digits of the length of the cell next to zero at which the search there ends."""


@dataclass(frozen=True)
class Root:
    """A simple root of ``F₁``, alone on its cell.

    Attributes
    ----------
    low, high : Fraction
        Periods between which it lies.
    pair : int
        Number of the pair of roots it belongs to, from 1.
    longer : bool
        Whether it is the longer one of the pair: ``F₁`` rises there.
    """

    low: Fraction
    high: Fraction
    pair: int
    longer: bool

    @property
    def ball(self) -> arb:
        """The period as a ball."""
        return interval(self.low, self.high)


@dataclass(frozen=True)
class PeriodProof:
    """What is known of the roots of ``F₁``.

    Attributes
    ----------
    roots : tuple of Root
        In ascending order.
    end : Fraction
        Period up to which they were looked for.
    none_beyond : bool
        Whether there is provably none beyond.
    open : tuple of (Fraction, Fraction)
        Intervals on which more roots may lie.
    """

    roots: tuple[Root, ...]
    end: Fraction
    none_beyond: bool
    open: tuple[tuple[Fraction, Fraction], ...]

    @property
    def complete(self) -> bool:
        """Whether these are all roots there are."""
        return self.none_beyond and not self.open


def all_periods(rotor: ProvenRotor, evidence: Evidence, longest: Fraction | None, most: int) -> PeriodProof:
    """All roots of ``F₁`` with periods up to ``longest``, or those that could be shown.

    The search ends after ``most`` cells.
    """
    numbers = rotor.numbers

    def series(time: arb, length: int) -> list[arb]:
        with terms(length):
            found = entire_condition(numbers, arb_series([time, 1]))
            return [found[k] for k in range(length)]

    condition = Analytic(series)
    known = evidence.take("no period beyond", lambda: _text(_longest_period(numbers)))
    bound = None if known is None else rational_of(known)
    if bound is not None and not none_beyond(numbers, interval(bound, bound)):
        raise NotShownError(f"the certificate does not show that there is no period beyond {bound}")
    gamma, split = float(numbers.gamma.mid()), float(numbers.split.mid())
    # Of the modulus of the faster exponent.
    width = power_of_two_below(2 / Fraction(abs(gamma) / 2 + abs(complex(split) ** 0.5) + 1.0))
    end = min((limit for limit in (longest, bound) if limit is not None), default=most * width / 4)
    lead = _first_coefficient(rotor)
    first = evidence.take("first cell", lambda: _text(_first_cell(condition, lead, min(width, end))))
    if first is None:
        return PeriodProof((), Fraction(0), False, ((Fraction(0), end),))
    start = rational_of(first)
    sign = condition.sign_next_to_zero(start, lead)
    if not sign:
        raise NotShownError("the certificate does not show the sign of F1 next to 0")
    least = width / 2 ** max(rotor.bits // 2, 20)
    limits = {"width": width, "least": least, "most": most}
    found = evidence.take("cells of F1", lambda: cells_of(condition, start, end, **limits).document())
    cells = CellTree.from_document(found)
    if cells.cuts[0] != start or cells.cuts[-1] > end:
        raise NotShownError("the cells of a certificate do not begin where the first one ends")
    show(condition, cells)
    roots = _roots_on(rotor, condition, cells, sign, evidence)
    return replace(roots, none_beyond=bound is not None and cells.cuts[-1] == bound)


def _text(number: Fraction | None) -> str | None:
    return None if number is None else str(number)


# ------------------------------------------------------------------------------------------------ beyond


def slowest_decay(n: LineNumbers[arb]) -> arb:
    """Rate at which the slower mode of free motion decays."""
    split, half = n.split, n.gamma / 2
    root = split.nonnegative_part().sqrt()
    # On both sides of critical damping only the difference bounds all machines.
    return half if split < 0 else n.omega_squared / (half + root) if split > 0 else half - root


def none_beyond(n: LineNumbers[arb], time: arb) -> bool:
    """Whether the decay keeps ``F₁`` above zero from a period on."""
    split, rate = n.split, slowest_decay(n)
    if not (n.gamma > 0 and rate * time >= 1):
        return False
    slow = (-rate * time).exp()
    swings = [1 + abs(n.half) * time]
    if not split.contains(0):
        root = abs(split).sqrt()
        across = I * root if split < 0 else acb(root)
        swings.append((abs(n.half + across) + abs(n.half - across)) / (2 * root))
    return any(abs(n.q) * (slow * swing + slow * slow) < (1 - slow) * (1 - slow) for swing in swings)


def _longest_period(n: LineNumbers[arb]) -> Fraction | None:
    """A period beyond which there is no root; ``None`` if none is shown."""
    if not (n.gamma > 0 and slowest_decay(n) > 0):
        return None
    end = Fraction(1, 4)
    while not none_beyond(n, interval(end, end)):
        end *= 2
        if end > 2**64:
            return None
    for part in (Fraction(3, 4), Fraction(5, 6), Fraction(9, 10)):
        if none_beyond(n, interval(end * part, end * part)):
            end *= part
    return Fraction(-(-end.numerator * 8 // end.denominator), 8) if end > 1 else end


# ------------------------------------------------------------------------------------------------ next to zero


def _first_coefficient(rotor: ProvenRotor) -> int:
    """Order of the first coefficient of ``P`` about zero that is not known to vanish."""
    given = rotor.hypotheses.rational("gamma", "mu", "d")
    if rotor.hypotheses.rational("d") != (Fraction(1),):
        return 4
    return 7 if given and given[0] == 2 * given[1] else 5


def _first_cell(condition: Analytic, lead: int, width: Fraction) -> Fraction | None:
    """Length of an interval next to zero on which ``F₁`` keeps its sign; ``None`` if none is found."""
    for _ in range(SHORTEST_CELL):
        if condition.sign_next_to_zero(width, lead):
            return width
        width /= 2
    return None


# ------------------------------------------------------------------------------------------------ roots


def _roots_on(rotor: ProvenRotor, condition: Analytic, cells: CellTree, start: int, evidence: Evidence) -> PeriodProof:
    """Roots on the cells; ``start`` is the sign of ``F₁`` before the first one."""
    roots: list[Root] = []
    unclear: list[tuple[Fraction, Fraction]] = []
    # F₁ starts positive unless d = 1, when T = 0 may be the shorter root of the first pair.
    count, zeros = 0 if start > 0 else 1, 0
    for low, high, kind, before, after in runs_of(condition, cells):
        if kind == OPEN or not before or not after:
            unclear.append((low, high))
            # An open interval hides a pair of roots, or none; it counts as a pair.
            count += 2 if before == after else 1
        if kind == OPEN or before == after or not before * after:
            continue
        zeros += 1
        ends = evidence.take(f"root {zeros} of F1", _refined(condition, low, high))
        near, far = (rational_of(text) for text in ends)
        if not (low <= near < far <= high and condition.sign(near) == before and condition.sign(far) == after):
            raise NotShownError(f"the certificate does not show a root of F1 between {near} and {far}")
        period = interval(near, far)
        if rotor.pole_in(period):
            continue
        if not rotor.numbers.gamma > 0 and numerator_and_gap(rotor.numbers, period)[1].contains(0):
            unclear.append((near, far))
        else:
            roots.append(Root(near, far, count // 2 + 1, bool(count % 2)))
        count += 1
    return PeriodProof(tuple(roots), cells.cuts[-1], False, tuple(unclear))


def _refined(condition: Analytic, low: Fraction, high: Fraction) -> Callable[[], list[str]]:
    """Search for a narrow interval with the root that lies between two periods."""

    def search() -> list[str]:
        left, right, before = low, high, condition.sign(low)
        for _ in range(6):
            middle = (left + right) / 2
            sign = condition.sign(middle)
            left, right = (middle, right) if sign == before else (left, middle) if sign else (left, right)
        guess = interval((left + right) / 2, (left + right) / 2)
        for _ in range(20):
            value, slope = condition.series(guess, 2)
            step = value / slope
            guess = (guess - step).mid()
            if step.contains(0):
                break
        reach = exact_ends(abs(step))[1] * 4 + Fraction(1, 10**60)
        middle = exact_ends(guess)[0]
        for _ in range(40):
            scale = Fraction(10) ** (len(str(int(1 / reach))) + 1)
            near, far = floor((middle - reach) * scale) / scale, ceil((middle + reach) * scale) / scale
            if low <= near and far <= high and condition.sign(near) == before and condition.sign(far) == -before:
                return [str(near), str(far)]
            reach *= 2
        return [str(left), str(right)]

    return search
