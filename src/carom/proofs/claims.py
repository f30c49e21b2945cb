"""Claims and proofs: what is proven, refuted or undecided, from which hypotheses."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from textwrap import wrap
from typing import Any, ClassVar, Literal, get_args

from carom.base.arguments import checked
from carom.base.files import write_whole
from carom.base.results import WIDEST, Members
from carom.parameters.terms import set_by
from carom.proofs.balls import Enclosure

FORMAT = "carom proof 1"
Status = Literal["proven", "refuted", "undecided"]
_MOST_NAMED = 10
"""Undecided claims that the short text form names."""


@dataclass(frozen=True)
class Claim:
    """One statement about every machine that fulfils the hypotheses.

    Attributes
    ----------
    about : str
        The motion, such as ``"B1,d"``, or the subject.
    kind : str
        What is stated of it in one or two words, such as ``"stable"``.
    statement : str
        The statement in full.
    status : {"proven", "refuted", "undecided"}
        Refuted: the contrary is proven.
    reason : str
        Why it is undecided, or what refutes it.
    enclosures : mapping of str to Enclosure
        Numbers that belong to it.
    interval : tuple of str
        Ends of the interval of a parameter on which it holds; empty for a claim about one machine.
    motions : tuple of str
        Orbits of the interval that are motions of the machine.
    limited_by_precision : bool
        Whether it is undecided only because of the number of bits computed with.
    """

    about: str
    kind: str
    statement: str
    status: Status
    reason: str = ""
    enclosures: Mapping[str, Enclosure] = field(default_factory=dict)
    interval: tuple[str, ...] = ()
    motions: tuple[str, ...] = ()
    limited_by_precision: bool = False

    @property
    def name(self) -> str:
        """The subject and what is stated: ``"B1,d stable"``."""
        return f"{self.about} {self.kind}"

    def document(self) -> dict[str, Any]:
        """As plain data for JSON."""
        ends = {name: [entry.low, entry.high] for name, entry in self.enclosures.items()}
        words = {"about": self.about, "kind": self.kind, "statement": self.statement, "status": self.status}
        where = {"interval": list(self.interval), "motions": list(self.motions)} if self.interval else {}
        return {**words, "reason": self.reason, "enclosures": ends, **where}


def claim_of(
    about: str,
    kind: str,
    statement: str,
    sign: int,
    *,
    reason: str = "",
    enclosures: Mapping[str, Enclosure] | None = None,
    limited: bool = True,
) -> Claim:
    """Claim that is proven, refuted or undecided where a sign is 1, −1 or 0.

    The reason is kept unless the claim is proven.  ``limited`` says whether more bits may decide an undecided claim.
    """
    status: Status = "proven" if sign > 0 else "refuted" if sign < 0 else "undecided"
    shown = "" if sign > 0 else reason
    return Claim(about, kind, statement, status, shown, enclosures or {}, limited_by_precision=limited and sign == 0)


@dataclass(frozen=True, eq=False, repr=False)
class Proof(Members[Claim]):
    """Claims about a machine with the evidence that decides them.

    Look a claim up by index or by name, ``proof["B1,d stable"]``.

    Attributes
    ----------
    theorem : str
        Which claims were looked at, such as ``"single-impact orbits"``.
    hypotheses : Hypotheses or StatedEquations
    options : mapping
        Limits of the theorem.
    claims : tuple of Claim
    bits : int
        Precision of the ball arithmetic.
    not_claimed : tuple of str
        What a reader may expect and is not claimed.
    evidence : mapping
        Plain data from which :func:`~carom.proofs.check` decides the claims again without any search.
    """

    called: ClassVar[str] = "claim"

    theorem: str
    # Not narrower: who reads the numbers of a planar rotor knows by the theorem that they are there.
    hypotheses: Any
    options: Mapping[str, Any]
    claims: tuple[Claim, ...]
    bits: int
    not_claimed: tuple[str, ...]
    evidence: Mapping[str, Any]

    @property
    def members(self) -> tuple[Claim, ...]:  # type: ignore[override]  # a field would be in the certificate twice
        """The claims."""
        return self.claims

    @checked
    def with_status(self, status: Status) -> tuple[Claim, ...]:
        """Claims of one status."""
        return tuple(claim for claim in self.claims if claim.status == status)

    @property
    def assumed(self) -> dict[str, str]:
        """Each number that is assumed as it was given; of parameters along which something is proven, their intervals."""
        along, box = self.options.get("along"), self.options.get("box", ())
        entries = [(along, self.options["from"], self.options["to"])] if along is not None else box
        # Their own values in the machine file are not assumed, nor what they stand for.
        moved = {name: f"{start} to {stop}" for name, start, stop in entries}
        given = {**self.hypotheses.values, **self.hypotheses.settings, **self.hypotheses.helpers}
        return {name: text for name, text in given.items() if name not in map(set_by, moved)} | moved

    def rows(self) -> list[tuple[str, str]]:
        """Each claim with its status, and the reason where it is not proven."""
        shown = [(claim.name, ": ".join(filter(None, (claim.status, claim.reason)))) for claim in self.claims]
        return [*shown, ("precision", f"{self.bits} bits")]

    def brief_rows(self) -> list[tuple[str, str]]:
        """The theorem, the machine, how many claims have each status, and which are undecided."""
        counts = [(status, len(self.with_status(status))) for status in get_args(Status)]
        first, *more = wrap(", ".join(f"{name} {text}" for name, text in self.assumed.items()), WIDEST)
        open_ = [claim.name for claim in self.with_status("undecided")]
        rest = len(open_) - _MOST_NAMED
        return [
            ("theorem", self.theorem),
            ("machine", first),
            *(("", words) for words in more),
            ("claims", ", ".join(f"{count} {status}" for status, count in counts)),
            *(("undecided", name) for name in open_[:_MOST_NAMED]),
            *([("", f"and {rest} more; rows() has all")] if rest > 0 else []),
        ]

    def document(self) -> dict[str, Any]:
        """The certificate: plain data for JSON, which :func:`~carom.proofs.check` verifies."""
        return {
            "format": FORMAT,
            "theorem": self.theorem,
            "options": dict(self.options),
            "hypotheses": self.hypotheses.document(),
            "bits": self.bits,
            "claims": [claim.document() for claim in self.claims],
            "not_claimed": list(self.not_claimed),
            "evidence": dict(self.evidence),
        }

    @checked
    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the certificate to a file."""
        write_whole(Path(path), json.dumps(self.document(), indent=1, ensure_ascii=False).encode())
