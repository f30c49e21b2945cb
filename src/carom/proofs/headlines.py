"""A theorem in one sentence with its numbers and units, and the numbers of a claim, for people.

Numbers are rounded down, so that a sentence about all disturbances below a size stays true; but for a part in 1e12, by
which a size that was asked for may differ from its text.
"""

from __future__ import annotations

from decimal import ROUND_FLOOR, Context, Decimal

from carom.base.results import KINDS
from carom.parameters import UNITS, Scales
from carom.parameters.formats import shown_from_si, shown_in
from carom.proofs.claims import Claim, Proof
from carom.proofs.families import FAMILIES, at_most
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.seeds import doubles_of

CHIEF = ("all recover", "recover", "asked never touch", "never touch", "all-single-impact-orbits", "orbits")
"""Kinds of claims that are the theorem, the first that a proof has; the others lead to it."""
_BOUNDS = {"speed": "velocity", "peak": "acceleration", "change": "length"}
"""Kinds of the sizes below which claims hold."""
_KINDS = {**KINDS, **_BOUNDS, "slip_after": "velocity", "least_normal_force": "force", "spare_friction": "force"}
"""Kinds of all numbers that have a unit."""
_NAMES = {"spare_friction": "least friction margin"}
"""What people read for the names of numbers in certificates, where that differs."""
_PERCENT, _BELOW, _ASKED = Decimal(100), Context(prec=4, rounding=ROUND_FLOOR), Context(prec=12)
_NEVER = "in any direction and at any instant of the turn, makes the rotor touch{limits}: it returns to levitation"


def chief_of(proof: Proof) -> Claim | None:
    """The claim that the others lead to; the first of these that is proven, if any is."""
    chiefs = [claim for kind in CHIEF for claim in proof if claim.kind == kind]
    return next((claim for claim in chiefs if claim.status == "proven"), chiefs[0] if chiefs else None)


def headline(proof: Proof) -> str:
    """The theorem with its numbers, or that it is not proven."""
    chief, proven = chief_of(proof), len(proof.with_status("proven"))
    if chief is not None and chief.status == "proven":
        return f"Theorem: {_sentence(chief, proof)}"
    if not proven:
        return "Nothing was proven."
    why = "" if chief is None else f" {chief.about} {chief.kind}: {chief.reason or chief.status}."
    return f"The theorem was not proven; {proven} of {len(proof)} claims were.{why}"


def scales_of(proof: Proof) -> Scales | None:
    """Scales of the one machine that a proof is about, where they are known and its claims do not state SI units themselves."""
    given = proof.hypotheses
    known = isinstance(given, Hypotheses) and given.exact and not {"along", "box"} & set(proof.options)
    return doubles_of(given).scales if known else None


def numbers_of(claim: Claim, scales: Scales | None) -> str:
    """Its numbers: shares in percent, those with a unit in SI units where scales are known, all others with the digits that are proven."""
    named = [(name, name.removesuffix("_si")) for name in claim.enclosures if f"{name}_si" not in claim.enclosures]
    shown = []
    for name, plain in named:
        entry, words = claim.enclosures[name], _NAMES.get(plain, plain.replace("_", " "))
        if any(word in _KINDS for word in plain.split()):  # "B1,d period", "radial_speed 2"
            shown.append(f"{words} {_size(claim, plain, scales)}")
        elif plain.startswith("share_"):
            shown.append(f"{plain.removeprefix('share_')} share {_share(entry.low)} %")
        else:
            shown.append(f"{words} {entry.short}")
    return ", ".join(shown)


def _sentence(claim: Claim, proof: Proof) -> str:
    scales = scales_of(proof)
    below = next((_size(claim, name, scales) for name in _BOUNDS if name in claim.enclosures), "")
    if claim.kind in ("never touch", "asked never touch") and claim.about == "kicks":
        bounded = proof["levitation clear"].enclosures
        limits = " or a magnetic bearing reach a limit" if "limit_1" in bounded else ""
        return f"No kick {'up to' if 'asked' in claim.kind else 'below'} {below}, {_NEVER.format(limits=limits)}."
    if claim.kind == "recover" and claim.about in FAMILIES and "box" not in proof.options:
        family, numbers = FAMILIES[claim.about], claim.enclosures
        largest, impacts = proof.options[family.option], int(numbers["impacts"].low)
        how = f"with {at_most(impacts)}" if impacts else "without touching"
        among = "" if below.startswith("0 ") else f", including all below {below}"
        return (
            f"Of all {family.about} up to {largest}, {_share(numbers['share_proven'].low)} % (by area of the disc of sizes and "
            f"directions) return to levitation {how}{among}."
        )
    shown = numbers_of(claim, scales)
    return f"{claim.statement}{shown and f' ({shown})'}"


def _size(claim: Claim, name: str, scales: Scales | None) -> str:
    """A number with its unit: of a bound the lower end; without scales the digits that are proven."""
    kind = "speed" if claim.kind == "absent below" else next(_KINDS[word] for word in name.split() if word in _KINDS)
    entry, (factor, unit) = claim.enclosures.get(f"{name}_si"), shown_from_si(UNITS[kind][1])
    if entry is None:
        entry, (factor, unit) = claim.enclosures[name], shown_in(kind, scales)
    ends = [_rounded(Decimal(end) * Decimal(factor)) for end in (entry.low, entry.high)]
    shown = entry.short if scales is None else " to ".join(dict.fromkeys(ends))
    text = ends[0] if name in _BOUNDS else shown
    return f"{text}{unit[1:] if unit.startswith('1/') else f' {unit}'}"


def _share(low: str) -> str:
    return _rounded(Decimal(low) * _PERCENT)


def _rounded(number: Decimal) -> str:
    """At most four digits, rounded down, without an exponent; a size that was asked for with its own."""
    asked = _ASKED.plus(number).normalize()
    return f"{asked if len(asked.as_tuple().digits) <= _BELOW.prec else _BELOW.plus(number).normalize():,f}"
