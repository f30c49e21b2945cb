"""Levitation, rubs, whirl in lasting contact and harmless kicks for all values of a parameter between two.

The interval is halved until the signs of :mod:`carom.proofs.steady` and of :mod:`carom.proofs.whirl` are decided for all values of a part, or the part is narrow.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import partial
from typing import NamedTuple

from flint import arb

from carom.parameters.terms import set_by
from carom.proofs.balls import Enclosure, decided, enclosure_of, hull, interval
from carom.proofs.claims import Claim, claim_of
from carom.proofs.lines import Line, LineNumbers, claim_of_runs, in_brackets, line_of, runs_along, written
from carom.proofs.rotor import ProvenRotor
from carom.proofs.steady import contact_free_speed, rub_discriminant, rub_force, wall_condition
from carom.proofs.whirl import BACKWARD, drag_sign, rolling_sign

_HALVED = 200
"""Parts of an interval that are halved to enclose the least harmless speed."""
_ROUNDING = 1e-15
"""Of the lower ends in double precision."""


def steady_line_claims(rotor: ProvenRotor, options: Mapping[str, object]) -> list[Claim]:
    """Claims along a parameter: the options ``along``, ``from`` and ``to``, as texts.

    The rotor's own value of the parameter does not matter.
    """
    line = line_of(rotor.hypotheses, str(options["along"]), str(options["from"]), str(options["to"]))
    claims = [
        claim_of_runs(about, kind, f"For all {line.words}, {words}.", runs_along(line, holds))
        for about, kind, words, holds in _KINDS
    ]
    return [*claims, *_kick_claims(line)]


def _holds(sign: int | None) -> bool | None:
    """Whether something holds by a sign; ``None`` where it is 0 or not known."""
    return sign > 0 if sign else None


def _levitates(n: LineNumbers[arb]) -> bool | None:
    return _holds(decided(wall_condition(n)))


def _is_pressed(n: LineNumbers[arb], side: int) -> bool | None:
    exists = _holds(decided(rub_discriminant(n)))
    return _holds(decided(rub_force(n, side))) if exists else exists


def _attracts(n: LineNumbers[arb]) -> bool | None:
    pressed, damped = _is_pressed(n, 1), decided(n.gamma + 2 * n.mu)
    if pressed is False or damped < 0:
        return False
    return True if pressed and damped else None


def _rolls(n: LineNumbers[arb]) -> bool | None:
    return _holds(rolling_sign(n))


def _whirl_is_absent(n: LineNumbers[arb]) -> bool | None:
    return True if drag_sign(n) == 1 else False if rolling_sign(n) == 1 else None


_RUB = "there is a synchronous rub, with two normal forces in balance, and the wall pushes the rotor at the {} of them"
_KINDS: tuple[tuple[str, str, str, Callable[[LineNumbers[arb]], bool | None]], ...] = (
    ("whirl", "rolls", "the rotor can roll on the wall without slip, backward, for ever", _rolls),
    ("whirl", "absent", BACKWARD, _whirl_is_absent),
    ("levitation", "inside", "the contact-free equilibrium lies inside the wall, |U*| < 1", _levitates),
    ("rub 1", "pressed", _RUB.format("larger"), partial(_is_pressed, side=1)),
    (
        "rub 1",
        "attracts sliding",
        "the rub of the larger normal force is a motion of the machine, and small vibrations along the wall decay",
        _attracts,
    ),
    ("rub 2", "pressed", _RUB.format("smaller"), partial(_is_pressed, side=-1)),
)
"""What is claimed along a parameter: of what, its kind, in words, and whether it holds."""


def _kick_claims(line: Line) -> list[Claim]:
    """Claims about harmless kicks: on all of the interval, or on the parts on which a speed is shown."""
    runs = runs_along(line, lambda n: True if contact_free_speed(n) is not None else None)
    words = "the rotor levitates inside the wall, and no kick out of levitation slower than the lower number brings it to the wall"
    shown = partial(claim_of, "kick", sign=1, limited=False)
    if not runs[None]:
        return [shown("harmless", f"For all {line.words}, {words}.", enclosures=_speeds(line, runs[True]))]
    claims = [claim_of_runs("kick", "harmless", f"For all {line.words}, a speed of harmless kicks is shown.", runs)]
    if runs[True]:
        where = " or ".join(in_brackets(written(*run, inward=True)) for run in runs[True])
        statement = f"For all {line.name} in {where}, {words}."
        claims.append(shown("harmless outside of gaps", statement, enclosures=_speeds(line, runs[True])))
    return claims


def _speeds(line: Line, runs: Sequence[tuple[Fraction, Fraction]]) -> dict[str, Enclosure]:
    """Enclosures of the least harmless speed: in m/s for machines, in ``c_r Ω`` where that is the same for all of them."""
    scaled = line.hypotheses.table == "machine"
    found = {}
    if not (scaled and set_by(line.name) in ("speed", "clearance")):
        found["speed"] = enclosure_of(_least(line, runs, scaled=False))
    if scaled:
        found["speed_si"] = enclosure_of(_least(line, runs, scaled=True))
    return found


def _least(line: Line, runs: Sequence[tuple[Fraction, Fraction]], *, scaled: bool) -> arb:
    """Ball of the least harmless speed on intervals on each of which one is shown.

    It is at most the upper end of that of any part, and at least the least of all lower ends; the part with that is halved next.
    """
    parts = [_Part.of(line, *run, scaled) for run in runs]
    above, halved = min(part.most for part in parts), 0
    heapq.heapify(parts)
    # Parts that are wider than those on which it is shown are halved in any case.
    while parts[0].low < parts[0].high and (halved < _HALVED or parts[0].least == -math.inf):
        _, low, high, _ = heapq.heappop(parts)
        middle = (low + high) / 2
        for ends in ((low, middle), (middle, high)):
            heapq.heappush(parts, half := _Part.of(line, *ends, scaled))
            above = min(above, half.most)
        halved += 1
    return hull(parts[0].least, above)


class _Part(NamedTuple):
    """Part of an interval with bounds of the harmless speed on it, in double precision outward."""

    least: float
    low: Fraction
    high: Fraction
    most: float

    @classmethod
    def of(cls, line: Line, low: Fraction, high: Fraction, scaled: bool) -> _Part:
        """The bounds between two values."""
        value = interval(low, high)
        speed = contact_free_speed(line.at(value))
        if speed is None:
            return cls(-math.inf, low, high, math.inf)
        table = line.table(value) if scaled else {}
        speed = speed * table["clearance"] * table["speed"] if scaled else speed
        return cls(float(speed.lower()) * (1 - _ROUNDING), low, high, float(speed.upper()) * (1 + _ROUNDING))
