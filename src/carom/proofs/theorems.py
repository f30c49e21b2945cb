"""The theorems that can be proven: each is a function of a rotor in ball arithmetic and of evidence.

A theorem never searches outside of :meth:`~carom.proofs.evidence.Evidence.take`, and verifies all that it takes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from carom.proofs import levitation_claims, state_claims
from carom.proofs.claims import Claim, claim_of
from carom.proofs.evidence import Evidence, rational_of
from carom.proofs.families import FAMILIES, KICKS
from carom.proofs.kick_claims import BOX_NOT_CLAIMED, BOX_THEOREM, NOT_CLAIMED, kick_claims, options_of
from carom.proofs.periods import PeriodProof, all_periods
from carom.proofs.points import point_claims
from carom.proofs.ranges import range_claims
from carom.proofs.rotor import ProvenRotor
from carom.proofs.several_impacts import several_impact_claims
from carom.proofs.single_impact import candidates, orbit_claims
from carom.proofs.slip import slip_claim
from carom.proofs.steady import steady_claims
from carom.proofs.steady_lines import steady_line_claims
from carom.proofs.whirl import whirl_claims

Options = Mapping[str, Any]
MOST_PLACES = 4
"""Periods that a reason names."""


@dataclass(frozen=True)
class Theorem:
    """A theorem by its claims and what is not claimed.

    Attributes
    ----------
    claims : callable
        Takes a :class:`~carom.proofs.rotor.ProvenRotor`, or equations of any rotor, :class:`~carom.proofs.evidence.Evidence` and options.
    not_claimed : tuple of str
    options : tuple of str
        Names of its options.
    """

    claims: Callable[[Any, Evidence, Options], list[Claim]]
    not_claimed: tuple[str, ...]
    options: tuple[str, ...]


def _single_impact(rotor: ProvenRotor, evidence: Evidence, options: Options) -> list[Claim]:
    """Equilibria, and all orbits with one impact a period."""
    longest = options.get("longest_period")
    periods = all_periods(rotor, evidence, None if longest is None else rational_of(longest), int(options["cells"]))
    slip = slip_claim(rotor.numbers)
    claims = [*steady_claims(rotor), *whirl_claims(rotor), _periods_claim(rotor, periods), slip]
    admissible, doubts = [], []
    if not periods.complete:
        doubts.append("not all periods are known")
    if slip.status != "proven":
        doubts.append("motions whose impacts stop the slip are not excluded")
    for done, (names, found) in enumerate(candidates(rotor, periods)):
        evidence.tell(0.3 + 0.7 * done / len(periods.roots))
        if not found:
            statement = "The closing conditions of an orbit with one impact a period have solutions at this root of F1."
            known = found is not None
            reason = "its radial speeds are not real" if known else "its two radial speeds may meet in a fold"
            claims.append(rotor.claim(names, "solution", statement, -1 if known else 0, reason))
            doubts += [] if found is not None else [f"it is open whether {names} exist"]
        for name, course in (found or {}).items():
            shown, status = orbit_claims(rotor, name, course)
            claims += shown
            admissible += [name] if status == "proven" else []
            doubts += [f"it is open whether {name} is a motion"] if status == "undecided" else []
    statement = "The machine has no motion with one impact a period that is synchronous with the shaft."
    if admissible:
        names = ", ".join(sorted(admissible, key=lambda name: (len(name), name)))
        statement = (
            f"The machine has exactly these motions with one impact a period, synchronous with the shaft: {names}."
        )
    limited = any(claim.limited_by_precision for claim in claims)
    complete = claim_of(
        "machine", "orbits", statement, 0 if doubts else 1, reason="; ".join(doubts), limited=bool(doubts) and limited
    )
    return [*claims, complete]


def _periods_claim(rotor: ProvenRotor, periods: PeriodProof) -> Claim:
    """Claim that the roots found are all there are."""
    count = len(periods.roots)
    places = list(dict.fromkeys(f"{float(low):.10g}" for low, _ in periods.open))
    more = f" and {len(places) - MOST_PLACES} more periods" if len(places) > MOST_PLACES else ""
    reasons = [f"F1 may have roots next to T = {', '.join(places[:MOST_PLACES])}{more}"] if places else []
    if not periods.none_beyond:
        reasons.append(f"periods beyond {float(periods.end):.6g}/Omega were not looked at")
        if not rotor.numbers.gamma > 0:
            reasons.append("without damping there is no longest period")
    return claim_of(
        "machine",
        "periods",
        f"F1 has exactly {count} root{'' if count == 1 else 's'} T > 0, each of them simple.",
        1 if periods.complete else 0,
        reason="; ".join(reasons),
        limited=bool(periods.open) and rotor.hypotheses.exact and bool(rotor.numbers.gamma > 0),
    )


THEOREMS: Mapping[str, Theorem] = {
    "single-impact orbits": Theorem(
        _single_impact,
        (
            "that there are no orbits with several impacts a period, with impacts and lasting contact, or irregular motions",
            "which disturbances lead to an orbit or to levitation: basins, and recovery from kicks above the contact-free speed",
            "which disturbances end in a rub",
            "which slides and whirls repeat that are not stated, or that there is no whirl that bounces",
        ),
        ("longest_period", "cells"),
    ),
    "orbits of several impacts": Theorem(
        lambda rotor, evidence, options: [
            *_single_impact(rotor, evidence, options),
            *several_impact_claims(rotor, evidence, options),
        ],
        (
            "that there are no other orbits with two or more impacts a period: those listed are what a search found",
            "that there are no orbits with lasting contact or with impacts that stop the slip, and no irregular motions",
            "which disturbances lead to an orbit or to levitation: basins, and recovery from kicks above the contact-free speed",
        ),
        ("longest_period", "cells", "impacts"),
    ),
    "along a parameter": Theorem(
        lambda rotor, evidence, options: [
            *point_claims(rotor, evidence, options),
            *range_claims(rotor, evidence, options),
            *steady_line_claims(rotor, options),
        ],
        (
            "what is said to be open on an interval, but for the points listed there",
            "that there are no other bifurcation points there: those listed are what a search in double precision found",
            "that the orbit at a point has the name it is listed by",
            "that there are no orbits with several impacts a period, with lasting contact, or irregular motions",
            "which disturbances lead to an orbit or to levitation: basins, and recovery from kicks",
        ),
        ("along", "from", "to", "blocks", "narrowest"),
    ),
    **{
        about: Theorem(partial(kick_claims, family), NOT_CLAIMED, options_of(family))
        for about, family in FAMILIES.items()
    },
    BOX_THEOREM: Theorem(partial(kick_claims, KICKS), BOX_NOT_CLAIMED, (*options_of(KICKS), "box")),
    levitation_claims.THEOREM: Theorem(
        levitation_claims.levitation_claims, levitation_claims.NOT_CLAIMED, levitation_claims.OPTIONS
    ),
    state_claims.THEOREM: Theorem(state_claims.state_claims, state_claims.NOT_CLAIMED, state_claims.OPTIONS),
}
"""Theorems by their names in certificates."""
