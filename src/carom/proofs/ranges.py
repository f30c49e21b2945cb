"""Ranges of a parameter: for every value in an interval these orbits with one impact a period and no others, and what they are.

The interval is cut into blocks.  On each, :mod:`carom.proofs.block_orbits` decides what it can for all of its values; what
remains is open there.  Neighbouring blocks on which the same holds make a stretch: as periods and radial speeds depend continuously on the
parameter and blocks share their ends, an orbit keeps its name along a stretch.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial, reduce
from itertools import groupby, pairwise
from math import floor, log2

from carom.base.progress import Reporter
from carom.proofs.balls import at_precision, enclosure_of, hull, interval
from carom.proofs.block_orbits import OrbitFact, first_cells, orbits_on
from carom.proofs.blocks import Block, OpenError
from carom.proofs.claims import Claim, Evidence, NotShownError, claim_of, rational_of
from carom.proofs.lines import Line, claim_of_runs, in_brackets, line_of, written
from carom.proofs.rotor import ProvenRotor
from carom.proofs.single_impact import slip_claim

DECIDED, OPEN, ENDED = "", "open", "ended"
"""What evidence says of a block: everything is decided there, or something is open, as the search found or because it ended before."""
BITS = 64
"""Precision."""
_FIRST_STEPS = 4
PERIOD = " period"
"""Follows the name of an orbit in the names of the enclosures of its period."""


@dataclass(frozen=True)
class Stretch:
    """Neighbouring blocks on which the same holds.

    Attributes
    ----------
    low, high : Fraction
    facts : tuple of OrbitFact or None
        All orbits, with periods and speeds on all of it; ``None`` if their number is not decided.
    reason : str
        Why something is not decided; empty if everything is.
    """

    low: Fraction
    high: Fraction
    facts: tuple[OrbitFact, ...] | None
    reason: str

    @property
    def inner(self) -> tuple[str, str]:
        """Its ends in decimal numbers, rounded inward where it is proven, else outward."""
        return written(self.low, self.high, inward=not self.reason)

    @property
    def ends(self) -> str:
        """The interval between these."""
        return in_brackets(self.inner)


def range_claims(rotor: ProvenRotor, evidence: Evidence, options: Mapping[str, float | str]) -> list[Claim]:
    """Claims for all values of a parameter between two: the options ``along``, ``from`` and ``to``, as texts.

    The option ``blocks`` is the largest number of blocks, ``narrowest`` the share of the interval at which a block is left open, as
    a text.  The rotor's own value of the parameter does not matter.
    """
    line = line_of(rotor.hypotheses, str(options["along"]), str(options["from"]), str(options["to"]))
    # Widths of the blocks, not bits, limit what is shown: more would only take longer.
    with at_precision(BITS):
        return _claims_along(line, evidence, int(options["blocks"]), rational_of(options["narrowest"]))


def _claims_along(line: Line, evidence: Evidence, most: int, narrowest: Fraction) -> list[Claim]:
    cuts = evidence.take("blocks", lambda: _cuts(line, most, narrowest, evidence))
    stretches = _stretches(_pieces(line, cuts, most, evidence.tell.part(0.5, 1.0)))
    words = f"For all {line.words}, no orbit with one impact a period stops its slip or slips backward."
    slip = slip_claim(line.at(line.ball), words)
    claims = [slip, _all_claim(line, stretches, slip)]
    for name in sorted({fact.name for stretch in stretches for fact in stretch.facts or ()}):
        claims += _orbit_claims(line, name, stretches)
    return [*claims, *(_stretch_claim(line, stretch) for stretch in stretches)]


# ------------------------------------------------------------------------------------------------ blocks


def _cuts(line: Line, most: int, narrowest: Fraction, evidence: Evidence) -> list[list[str]]:
    """Ends of the blocks, and why a block is left open, by a march along the interval."""
    tell = evidence.tell.part(0.0, 0.5)
    low, high = line.ends
    width = high - low
    least = narrowest * width
    place, step, skip, found = low, width / _FIRST_STEPS, least, [[str(low), DECIDED]]
    while place < high or len(found) == 1:
        end = high if place + step * Fraction(21, 20) >= high else _short(place + step, step)
        try:
            _facts(line, place, end, decided=True)
        except OpenError:
            if len(found) < most and step > skip:
                step = max(step / 2, skip)
                continue
            # Where nothing is shown, blocks widen again, so that long open intervals take little work.
            found.append([str(end), OPEN])
            skip *= 2
            place, step = end, skip
        else:
            found.append([str(end), DECIDED])
            place, step, skip = end, min(step * Fraction(3, 2), width / 4), least
        tell(float((place - low) / width) if width else 1.0)
        if place < high and (len(found) > most or evidence.is_late):
            found.append([str(high), ENDED])
            break
    return found


def _short(number: Fraction, step: Fraction) -> Fraction:
    """The number rounded to a multiple of a power of 1/2 that is small beside a step."""
    scale = 2 ** (max(0, -floor(log2(step))) + 8)
    return Fraction(round(number * scale), scale)


def _facts(line: Line, low: Fraction, high: Fraction, *, decided: bool) -> tuple[OrbitFact, ...]:
    """What holds for all orbits on a block; :class:`OpenError` if their number, or on request one of these facts, is not decided."""
    block = Block(line, interval(low, low), interval(high, high))
    try:
        facts = tuple(orbits_on(block, first_cells(block)))
    except (ArithmeticError, ValueError) as problem:
        # Series cannot be divided where their first term may vanish.
        raise OpenError(f"a formula has a pole next to it: {problem}") from None
    for objection in filter(None, (fact.objection for fact in facts if decided)):
        raise OpenError(objection)
    return facts


def _pieces(line: Line, cuts: Sequence[Sequence[str]], most: int, tell: Reporter) -> list[Stretch]:
    """What holds on each block."""
    low, high = line.ends
    ends = [rational_of(end) for end, _ in cuts]
    if ends[0] != low or ends[-1] != high or not 2 <= len(ends) <= most + 3 or any(a > b for a, b in pairwise(ends)):
        raise NotShownError("the blocks of the certificate do not cover the interval")
    if any(known not in (DECIDED, OPEN, ENDED) for _, known in cuts):
        raise NotShownError("a block of the certificate is neither decided nor open")
    found = []
    for before, after, (_, known) in zip(ends, ends[1:], cuts[1:], strict=False):
        facts, reason = None, ""
        try:
            facts = _facts(line, before, after, decided=known == DECIDED)
            reason = next((fact.objection for fact in facts if fact.objection), "")
        except OpenError as problem:
            if known == DECIDED:
                shown = f"the certificate does not show what it claims up to {float(after):.9g}: {problem}"
                raise NotShownError(shown) from None
            reason = str(problem)
        if reason and known == ENDED:
            reason = "the search ended before"
        tell(float((after - low) / (high - low)) if high > low else 1.0)
        found.append(Stretch(before, after, facts, reason))
    return found


def _signature(piece: Stretch) -> tuple[object, ...]:
    return piece.facts and tuple(fact.signature for fact in piece.facts), piece.facts is None, bool(piece.reason)


def _stretches(pieces: Sequence[Stretch]) -> list[Stretch]:
    """Neighbouring blocks of the same signature, put together."""
    found = []
    for _, group in groupby(pieces, key=_signature):
        members = list(group)
        facts = [
            replace(
                same[0],
                period=reduce(hull, (fact.period for fact in same)),
                speed=reduce(hull, (fact.speed for fact in same)),
            )
            for same in zip(*(member.facts or () for member in members), strict=True)
        ]
        reasons = list(dict.fromkeys(member.reason for member in members if member.reason))
        more = f", and {len(reasons) - 1} more" if len(reasons) > 1 else ""
        counted = None if members[0].facts is None else tuple(facts)
        found.append(Stretch(members[0].low, members[-1].high, counted, reasons[0] + more if reasons else ""))
    return found


# ------------------------------------------------------------------------------------------------ claims


def _all_claim(line: Line, stretches: Sequence[Stretch], slip: Claim) -> Claim:
    """Claim about the number of orbits on the whole interval."""
    counted = [stretch.facts for stretch in stretches if stretch.facts is not None]
    names = {fact.name for facts in counted for fact in facts}
    motions = sorted({fact.name for facts in counted for fact in facts if fact.admissible})
    doubts = [
        f"{stretch.ends} is open: {stretch.reason}"
        for stretch in stretches
        if stretch.facts is None or any(fact.admissible is None for fact in stretch.facts)
    ]
    always = all(len(facts) == len(names) for facts in counted) and all(
        fact.admissible in (None, fact.name in motions) for facts in counted for fact in facts
    )
    words = f"exactly these: {', '.join(motions)}" if motions else "none"
    statement = f"For all {line.words}, motions of the machine with one impact a period, synchronous with the shaft, are {words}."
    if not always:
        doubts.append("the motions change along the interval; see the stretches")
    if slip.status != "proven":
        doubts.append("motions whose impacts stop the slip are not excluded")
    return claim_of(
        "machine", "all-single-impact-orbits", statement, 0 if doubts else 1, reason="; ".join(doubts), limited=False
    )


def _orbit_claims(line: Line, name: str, stretches: Sequence[Stretch]) -> list[Claim]:
    """Claims about one orbit on the whole interval, with the longest stretch on which each is shown."""
    kinds: dict[str, tuple[str, Callable[[OrbitFact], bool | None]]] = {
        "exists": ("its closing conditions have a solution", lambda fact: True),
        "admissible": ("it is a motion of the machine", lambda fact: fact.admissible),
        "stable": ("all its multipliers lie inside the unit circle", lambda fact: fact.stable),
    }
    claims = []
    for kind, (words, holds) in kinds.items():
        runs: dict[bool | None, list[tuple[Fraction, Fraction]]] = {True: [], False: [], None: []}
        for value, group in groupby(stretches, key=partial(_shown, name, holds)):
            members = list(group)
            runs[value].append((members[0].low, members[-1].high))
        claims.append(claim_of_runs(name, kind, f"For all {line.words}, {words}.", runs))
    return claims


def _shown(name: str, holds: Callable[[OrbitFact], bool | None], stretch: Stretch) -> bool | None:
    """Whether something holds for an orbit on a stretch; ``None`` if this is open."""
    fact = next((fact for fact in stretch.facts or () if fact.name == name), None)
    return holds(fact) if fact else None if stretch.facts is None else False


def _stretch_claim(line: Line, stretch: Stretch) -> Claim:
    """Claim about everything on one stretch."""
    about = f"{line.name} in {stretch.ends}"
    if stretch.reason:
        statement = "The orbits with one impact a period and what they are do not change."
        return claim_of(about, "orbits", statement, 0, reason=stretch.reason, limited=False)
    shown, enclosures, facts = [], {}, stretch.facts or ()
    for fact in facts:
        motion = "motion of the machine" if fact.admissible else f"no motion ({fact.reason})"
        shown.append(f"{fact.name}: {motion}, {'stable' if fact.stable else f'unstable ({fact.instability})'}")
        enclosures[f"{fact.name}{PERIOD}"] = enclosure_of(fact.period)
        enclosures[f"{fact.name} radial_speed"] = enclosure_of(fact.speed)
    statement = "The closing conditions have exactly these solutions, and each keeps its properties: "
    claim = claim_of(about, "orbits", statement + ("; ".join(shown) or "none"), 1, enclosures=enclosures, limited=False)
    return replace(claim, interval=stretch.inner, motions=tuple(fact.name for fact in facts if fact.admissible))
