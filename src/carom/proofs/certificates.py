"""The check of certificates, which trusts no search."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from carom.base.arguments import checked
from carom.base.outcome import CaromError, InputError, printable, shown
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.proofs.balls import Enclosure
from carom.proofs.claims import FORMAT, Claim, Document, Evidence, NotShownError, Proof
from carom.proofs.hypotheses import Hypotheses, StatedEquations
from carom.proofs.proving import MOST_BITS, THEOREMS, proof_at

LARGEST_BYTES = 50_000_000
_DECIMAL = re.compile(r"-?[0-9]{1,100}(?:\.[0-9]{1,100})?(?:E[+-][0-9]{1,4})?")
_WIDEST = 64
"""How many times wider than found here an enclosure may be stated: another version of the arithmetic may give a narrower one."""
_KEYS = ("format", "theorem", "options", "hypotheses", "bits", "claims", "not_claimed", "evidence")


@checked
@shows_progress
def check(source: str | os.PathLike[str] | Document, *, progress: ShowProgress = None) -> Proof:
    """Verify a certificate by itself.

    All inequalities are evaluated again in ball arithmetic, from the numbers of the machine in the certificate and from its
    evidence; nothing is searched.  All words of the claims must come out the same, and all numbers must lie between those stated.

    Parameters
    ----------
    source : path or mapping
        A file, or what :meth:`Proof.document <carom.proofs.Proof.document>` gives.

    Raises
    ------
    InputError
        It cannot be read as a certificate, or it does not show what it claims.
    """
    document, name = (source, "the data given") if isinstance(source, Mapping) else (_read(source), shown(source))
    try:
        proof = _proof_of(document, Reporter.of(progress, "checking the certificate"))
    except (CaromError, ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as problem:
        raise InputError("certificate", name, f"is refused: {printable(str(problem))}") from None
    return proof


def _proof_of(document: Document, tell: Reporter) -> Proof:
    if sorted(document) != sorted(_KEYS) or document["format"] != FORMAT:
        raise NotShownError(f"it must have the format {FORMAT!r} and the keys {', '.join(_KEYS)}")
    theorem, bits = document["theorem"], document["bits"]
    if theorem not in THEOREMS or not isinstance(bits, int) or not 2 <= bits <= MOST_BITS:
        raise NotShownError(f"it must name a known theorem and 2 to {MOST_BITS} bits")
    if sorted(document["options"]) != sorted(THEOREMS[theorem].options):
        raise NotShownError(f"its options must be {', '.join(THEOREMS[theorem].options)}")
    evidence = Evidence(document["evidence"], tell)
    stated = document["hypotheses"].get("table") == StatedEquations.table
    if stated is not (theorem == "levitation"):
        raise NotShownError("its hypotheses are not those of its theorem")
    read = StatedEquations if stated else Hypotheses
    hypotheses = read.from_document(document["hypotheses"])
    proof = proof_at(bits, theorem, hypotheses, dict(document["options"]), evidence)
    tell(1.0)
    found = proof.document()
    for key in _KEYS:
        if key != "claims" and found[key] != document[key]:
            raise NotShownError(f"its {key} are not those that the evidence belongs to")
    return replace(proof, claims=_confirmed(proof.claims, document["claims"]))


def _confirmed(found: Sequence[Claim], given: Sequence[Document]) -> tuple[Claim, ...]:
    """Claims of a certificate whose words are those found and whose numbers enclose those found."""
    if len(found) != len(given):
        raise NotShownError("its claims are not those that the evidence shows")
    claims = []
    for claim, words in zip(found, given, strict=True):
        if {**claim.document(), "enclosures": None} != {**words, "enclosures": None}:
            raise NotShownError(f"its evidence does not show what it claims: {claim.name}")
        stated = words["enclosures"]
        if list(stated) != list(claim.enclosures):
            raise NotShownError(f"its numbers are not those of the claim: {claim.name}")
        held = {name: _held(entry, stated[name], claim.name) for name, entry in claim.enclosures.items()}
        claims.append(replace(claim, enclosures=held))
    return tuple(claims)


def _held(found: Enclosure, stated: Sequence[str], name: str) -> Enclosure:
    """The stated enclosure, if it holds the ball that was found."""
    if len(stated) != 2 or not all(_DECIMAL.fullmatch(end) for end in stated):
        raise NotShownError(f"a number is not a pair of decimal numbers: {name}")
    given = Enclosure(stated[0], stated[1], found.inner)
    if not given.holds(found):
        raise NotShownError(f"a number is not between those stated: {name}")
    if given.width > _WIDEST * found.width:
        raise NotShownError(f"a number is stated much wider than it is known: {name}")
    return given


def _read(path: str | os.PathLike[str]) -> dict[str, object]:
    try:
        with Path(path).open("rb") as file:
            data = file.read(LARGEST_BYTES + 1)
        if len(data) > LARGEST_BYTES:
            raise ValueError("too long")
        document = json.loads(data, object_pairs_hook=_each_once)
        if not isinstance(document, dict):
            raise TypeError("no object")
    except OSError as problem:
        raise InputError("certificate", shown(path), f"cannot be read: {problem.strerror or problem}") from None
    except (RecursionError, TypeError, ValueError):
        raise InputError("certificate", shown(path), "must be a JSON file that carom prove has written") from None
    return document


def _each_once(pairs: list[tuple[str, object]]) -> dict[str, object]:
    """An object of JSON; a duplicate key is refused, as a reader may take the other value."""
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a key twice")
    return found
