"""Levitation, rubs and harmless kicks for all values of a parameter between two.

As in :mod:`carom.proofs.whirl_lines` the interval is halved until the signs of :mod:`carom.proofs.steady` are decided for all values of a part.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import partial
from typing import Any

from carom.parameters.terms import set_by
from carom.proofs.balls import Enclosure, decided, enclosure_of, interval
from carom.proofs.claims import Claim, claim_of
from carom.proofs.lines import Line, Numbers, line_of
from carom.proofs.rotor import Rotor
from carom.proofs.runs import claim_of_runs, in_brackets, runs_along, written
from carom.proofs.series import hull
from carom.proofs.steady import harmless_speed, rub_discriminant, rub_force, wall_condition

_HALVED = 200
"""Parts of an interval that are halved to enclose the least harmless speed."""
_ROUNDING = 1e-15
"""Of the lower ends in double precision."""


def steady_line_claims(rotor: Rotor, options: Mapping[str, Any]) -> list[Claim]:
    """Claims along a parameter: the options ``along``, ``from`` and ``to``, as texts.

    The rotor's own value of the parameter does not matter.
    """
    line = line_of(rotor.hypotheses, str(options["along"]), str(options["from"]), str(options["to"]))
    kinds: dict[tuple[str, str], tuple[str, Callable[[Numbers], bool | None]]] = {
        ("levitation", "inside"): ("the contact-free equilibrium lies inside the wall, |U*| < 1", _levitates),
        ("rub 1", "pressed"): (_words("larger"), partial(_is_pressed, side=1)),
        ("rub 1", "attracts sliding"): (
            "the rub of the larger normal force is a motion of the machine, and small disturbances along the wall die out",
            _attracts,
        ),
        ("rub 2", "pressed"): (_words("smaller"), partial(_is_pressed, side=-1)),
    }
    claims = [
        claim_of_runs(about, kind, f"For all {line.words}, {words}.", runs_along(line, holds))
        for (about, kind), (words, holds) in kinds.items()
    ]
    return [*claims, *_kick_claims(line)]


def _words(which: str) -> str:
    return f"there is a synchronous rub, with two normal forces in balance, and the wall pushes the rotor at the {which} of them"


def _levitates(n: Numbers) -> bool | None:
    sign = decided(wall_condition(n))
    return sign > 0 if sign else None


def _is_pressed(n: Numbers, side: int) -> bool | None:
    exists = decided(rub_discriminant(n))
    if exists < 1:
        return False if exists else None
    sign = decided(rub_force(n, side))
    return sign > 0 if sign else None


def _attracts(n: Numbers) -> bool | None:
    pressed, damped = _is_pressed(n, 1), decided(n.gamma + 2 * n.mu)
    if pressed is False or damped < 0:
        return False
    return True if pressed and damped else None


def _kick_claims(line: Line) -> list[Claim]:
    """Claims about harmless kicks: on all of the interval, or on the parts on which a speed is shown."""
    runs = runs_along(line, lambda n: True if harmless_speed(n) is not None else None)
    words = "the rotor levitates inside the wall, and no kick out of levitation slower than the lower number brings it to the wall"
    if not runs[None]:
        return [
            claim_of(
                "kick",
                "harmless",
                f"For all {line.words}, {words}.",
                1,
                enclosures=_speeds(line, runs[True]),
                limited=False,
            )
        ]
    claims = [claim_of_runs("kick", "harmless", f"For all {line.words}, a speed of harmless kicks is shown.", runs)]
    if runs[True]:
        where = " or ".join(in_brackets(written(*run, inward=True)) for run in runs[True])
        statement = f"For all {line.name} in {where}, {words}."
        claims.append(
            claim_of(
                "kick", "harmless outside of gaps", statement, 1, enclosures=_speeds(line, runs[True]), limited=False
            )
        )
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


def _least(line: Line, runs: Sequence[tuple[Fraction, Fraction]], *, scaled: bool) -> Any:
    """Ball of the least harmless speed on intervals on each of which one is shown.

    It is at most the upper end of that of any part, and at least the least of all lower ends; the part with that is halved next.
    """
    parts = [_Part(line, *run, scaled) for run in runs]
    above, halved = min(part.most for part in parts), 0
    heapq.heapify(parts)
    # Parts that are wider than those on which it is shown are halved in any case.
    while parts[0].low < parts[0].high and (halved < _HALVED or parts[0].least == -math.inf):
        for half in heapq.heappop(parts).halves():
            above = min(above, half.most)
            heapq.heappush(parts, half)
        halved += 1
    return hull(parts[0].least, above)


class _Part:
    """Part of an interval with bounds of the harmless speed on it, in double precision outward."""

    def __init__(self, line: Line, low: Fraction, high: Fraction, scaled: bool) -> None:
        self.line, self.low, self.high, self.scaled = line, low, high, scaled
        value = interval(low, high)
        speed = harmless_speed(line.at(value))
        self.least, self.most = -math.inf, math.inf
        if speed is not None:
            table = line.table(value) if scaled else {}
            speed = speed * table["clearance"] * table["speed"] if scaled else speed
            self.least, self.most = float(speed.lower()) * (1 - _ROUNDING), float(speed.upper()) * (1 + _ROUNDING)

    def __lt__(self, other: _Part) -> bool:
        """Whether the least speed on it may be the smaller one."""
        return (self.least, self.low) < (other.least, other.low)

    def halves(self) -> list[_Part]:
        """Both halves."""
        middle = (self.low + self.high) / 2
        return [_Part(self.line, *ends, self.scaled) for ends in ((self.low, middle), (middle, self.high))]
