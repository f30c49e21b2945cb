"""Parts of an interval of a parameter on which something holds, does not hold or is open, as a claim and in decimal numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import groupby
from math import ceil, floor

from carom.proofs.balls import Enclosure, interval
from carom.proofs.claims import Claim, Status
from carom.proofs.lines import Line, LineNumbers

Runs = Mapping[bool | None, Sequence[tuple[Fraction, Fraction]]]
"""Parts on which something holds, on which the contrary does, and on which it is open (``None``)."""

_HALVINGS = 12
"""How often a part is halved before it is left open."""


def runs_along(line: Line, holds: Callable[[LineNumbers], bool | None]) -> Runs:
    """Parts of a line by what holds on them, neighbours put together: it is halved until that is decided for all values of a part."""
    runs: dict[bool | None, list[tuple[Fraction, Fraction]]] = {True: [], False: [], None: []}
    for value, group in groupby(_parts(line, holds, *line.ends, _HALVINGS), key=lambda part: part[0]):
        parts = list(group)
        runs[value].append((parts[0][1], parts[-1][2]))
    return runs


def _parts(
    line: Line, holds: Callable[[LineNumbers], bool | None], low: Fraction, high: Fraction, halvings: int
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
