"""Parts of a box of machines on which something is open: as few boxes as hold them, and what is left outside of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal, localcontext
from fractions import Fraction

from carom.proofs.boxes import Box, Part

Parts = tuple[Part, ...]
MOST_GAPS = 12
"""Boxes that are told; more are put together."""
_DIGITS = 12
_PLAIN = -7, 15
"""Powers of ten of numbers that are written without an exponent."""


def gaps_of(open_parts: Iterable[Parts]) -> list[Parts]:
    """At most :data:`MOST_GAPS` boxes that hold all parts, none inside another, in order."""
    found = _outermost(open_parts)
    while len(found) > MOST_GAPS:
        # The smallest grow until they hold one another.
        deepest = max(sum(n for _, n in parts) for parts in found)
        found = _outermost(_doubled(parts) if sum(n for _, n in parts) == deepest else parts for parts in found)
    return sorted(found, key=lambda parts: [Fraction(k, 2**n) for k, n in parts])


def _outermost(open_parts: Iterable[Parts]) -> set[Parts]:
    """Those that no other one holds, both halves of a box as the box."""
    found: set[Parts] = set()
    for parts in sorted(set(open_parts), key=lambda parts: sum(n for _, n in parts)):
        if not any(_holds(other, parts) for other in found):
            found.add(parts)
    while joined := next(_pairs(found), None):
        one, other, whole = joined
        found = (found - {one, other}) | {whole}
    return found


def _pairs(found: set[Parts]) -> Iterator[tuple[Parts, Parts, Parts]]:
    for parts in found:
        for j, (k, n) in enumerate(parts):
            if n and k % 2 == 0 and (other := (*parts[:j], (k + 1, n), *parts[j + 1 :])) in found:
                yield parts, other, (*parts[:j], (k // 2, n - 1), *parts[j + 1 :])


def _holds(one: Parts, other: Parts) -> bool:
    return all(n <= m and k == place >> (m - n) for (k, n), (place, m) in zip(one, other, strict=True))


def _doubled(parts: Parts) -> Parts:
    """The box of which it is a half, in the parameter in which it is narrowest."""
    j = max(range(len(parts)), key=lambda j: parts[j][1])
    place, halvings = parts[j]
    return (*parts[:j], (place // 2, halvings - 1), *parts[j + 1 :])


def outside(gaps: Sequence[Parts]) -> list[tuple[Fraction, Fraction]]:
    """Intervals between gaps of one parameter, as shares of its interval; they share no end with a gap that is open there."""
    place, found = Fraction(0), []
    for ((k, n),) in gaps:
        if Fraction(k, 2**n) > place:
            found.append((place, Fraction(k, 2**n)))
        place = Fraction(k + 1, 2**n)
    return [*found, (place, Fraction(1))] if place < 1 else found


def told(box: Box, number: int, low: Fraction, high: Fraction, *, inward: bool) -> str:
    """An interval of a parameter, given as shares of its own, in decimal numbers rounded inward or outward, with its unit."""
    start, stop = box.lines[number].ends
    ends = [start + (stop - start) * share for share in (low, high)]
    words = ", ".join(decimal(end, upward=upward) for end, upward in zip(ends, (inward, not inward), strict=True))
    return f"{box.lines[number].name} in [{words}] {box.lines[number].field.unit}".rstrip()


def box_told(box: Box, parts: Parts) -> str:
    """A part of a box, rounded outward."""
    sides = (
        told(box, j, Fraction(k, 2**n), Fraction(k + 1, 2**n), inward=False) for j, (k, n) in enumerate(parts) if n
    )
    return " and ".join(sides)


def decimal(value: Fraction, *, upward: bool) -> str:
    """Decimal number of twelve digits on one side of a number."""
    with localcontext(Context(prec=_DIGITS, rounding=ROUND_CEILING if upward else ROUND_FLOOR)):
        found = (Decimal(value.numerator) / Decimal(value.denominator)).normalize()
    return f"{found:f}" if _PLAIN[0] < found.adjusted() < _PLAIN[1] else str(found)
