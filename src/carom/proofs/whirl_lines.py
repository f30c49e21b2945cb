"""Rolling, and the absence of backward whirl in lasting contact, for all values of a parameter between two.

The interval is halved until the signs of :mod:`carom.proofs.whirl` are decided for all values of a part, or the part is narrow.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from itertools import groupby
from typing import Any

from carom.proofs.balls import interval
from carom.proofs.claims import Claim
from carom.proofs.lines import Line, Numbers, line_of
from carom.proofs.rotor import Rotor
from carom.proofs.runs import Runs, claim_of_runs
from carom.proofs.whirl import BACKWARD, drag_sign, rolling_sign

_HALVINGS = 12
"""How often a part is halved before it is left open."""


def whirl_line_claims(rotor: Rotor, options: Mapping[str, Any]) -> list[Claim]:
    """Claims along a parameter: the options ``along``, ``from`` and ``to``, as texts.

    The rotor's own value of the parameter does not matter.
    """
    line = line_of(rotor.hypotheses, str(options["along"]), str(options["from"]), str(options["to"]))
    kinds: dict[str, tuple[str, Callable[[Numbers], bool | None]]] = {
        "rolls": ("the rotor can roll on the wall without slip, backward, for ever", _rolls),
        "absent": (BACKWARD, _absent),
    }
    return [
        claim_of_runs("whirl", kind, f"For all {line.words}, {words}.", _runs(line, holds))
        for kind, (words, holds) in kinds.items()
    ]


def _rolls(n: Numbers) -> bool | None:
    sign = rolling_sign(n)
    return sign > 0 if sign else None


def _absent(n: Numbers) -> bool | None:
    if drag_sign(n) == 1:
        return True
    return False if rolling_sign(n) == 1 else None


def _runs(line: Line, holds: Callable[[Numbers], bool | None]) -> Runs:
    """Parts of the line by what holds on them, neighbours put together."""
    runs: dict[bool | None, list[tuple[Fraction, Fraction]]] = {True: [], False: [], None: []}
    for value, group in groupby(_parts(line, holds, *line.ends, _HALVINGS), key=lambda part: part[0]):
        parts = list(group)
        runs[value].append((parts[0][1], parts[-1][2]))
    return runs


def _parts(
    line: Line, holds: Callable[[Numbers], bool | None], low: Fraction, high: Fraction, halvings: int
) -> Iterator[tuple[bool | None, Fraction, Fraction]]:
    value = holds(line.at(interval(low, high)))
    if value is not None or not halvings or low == high:
        yield value, low, high
        return
    middle = (low + high) / 2
    yield from _parts(line, holds, low, middle, halvings - 1)
    yield from _parts(line, holds, middle, high, halvings - 1)
